//! What holds for every figure: well-formed, deterministic, complete, whatever the records lack.

use prone::torque_map::{Axis, Grid, JointTorques, Mask, Row, TorqueMap};

use super::*;
use prone_record::pulls::{ChainSample, PullRow};

const ALL_S: [f64; 10] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0];

#[test]
fn no_file_of_a_figure_is_a_path_or_hides_something() {
    assert_eq!(file_stem("fig-24-low_175-angles"), "fig-24-low_175-angles");
    assert_eq!(
        file_stem("torque-map-theta3+05.00deg"),
        "torque-map-theta3+05.00deg"
    );
    assert_eq!(file_stem("fig-../../x\u{1b}\u{202e}ü"), "fig-..-..-x---");
    assert_eq!(file_stem(&"a".repeat(5_000_000)).len(), LONGEST_STEM);
}

/// Gaits as a publication has them.
const NUMBERED: [GaitNumbers; 2] = [
    GaitNumbers {
        gait: "nominal",
        chain: "26",
        frames: "27",
        torque_by_duration: "36",
        torque_over_time: "38",
        transient: "40",
        torque_over_cycle: "42",
        published_divergence_s: 0.25,
    },
    GaitNumbers {
        gait: "optimal",
        chain: "34",
        frames: "35",
        torque_by_duration: "37",
        torque_over_time: "39",
        transient: "41",
        torque_over_cycle: "43",
        published_divergence_s: 0.175,
    },
];

fn drawn(
    chains: &[ChainRecord],
    pulls: &[PullRecord],
    costs: &[CostRecord],
) -> Result<Vec<Figure>, FigureError> {
    study_figures(&NUMBERED, chains, pulls, costs)
}

fn pull(gait: &str, duration_s: f64) -> PullRecord {
    let row = |step: u32| {
        let cycle = f64::from(step) / 20.0;
        PullRow {
            time_s: cycle * duration_s,
            cycle_percent: 100.0 * cycle,
            torque_nm: [0.1, -0.4, 0.8, -0.2].map(|torque| torque * (cycle + 0.3).sin()),
            command_rad: [0.0; 7],
            angle_rad: [0.0; 7],
            contact_n: [0.0; 4],
            top_mm: 0.0,
            head_top_mm: 0.0,
            squeeze_n: 0.0,
        }
    };
    PullRecord {
        gait: gait.to_owned(),
        duration_s,
        rows: (1..=20).map(row).collect(),
    }
}

fn chain(gait: &str) -> ChainRecord {
    let sample = |step: u32| {
        let s = f64::from(step) / 10.0;
        let ahead = 60.0 * s;
        ChainSample {
            s,
            parameters_deg: [16.5, 27.5, -30.0 - 60.0 * s],
            points_mm: [
                (0.0, 0.0),
                (ahead - 13.0, 103.0),
                (ahead + 71.0, 45.0),
                (ahead + 166.0, 14.0),
                (ahead + 352.0, 45.0),
                (430.0, 0.0),
            ],
        }
    };
    ChainRecord {
        gait: gait.to_owned(),
        samples: (0..=10).map(sample).collect(),
    }
}

/// A map whose torques reach `largest`, N·m, with every fifth row masked.
fn map(largest: f64) -> TorqueMap {
    let axis = |low, high, nodes| Axis::new(low, high, nodes).unwrap();
    let grid = Grid {
        knee: axis(-0.1, 0.8, 3),
        hip: axis(-0.5, 0.5, 7),
        upper_arm: axis(-1.6, -0.5, 5),
    };
    let rows = (0..grid.len()).map(|index| {
        let share = index as f64 / (grid.len() - 1) as f64;
        if index % 5 == 0 {
            Row::Masked {
                mask: Mask::Open,
                recorded: None,
            }
        } else {
            let torques = [share, -0.5 * share, 0.0, 0.1].map(|torque| largest * torque);
            Row::Torques(JointTorques::from_array(torques))
        }
    });
    TorqueMap::new(grid, rows.collect()).unwrap()
}

fn draw(durations_s: &[f64], gaits: &[&str]) -> Vec<Figure> {
    let each = || {
        gaits
            .iter()
            .flat_map(|gait| durations_s.iter().map(move |d| (*gait, *d)))
    };
    let pulls: Vec<PullRecord> = each().map(|(gait, d)| pull(gait, d)).collect();
    let costs: Vec<CostRecord> = each()
        .map(|(gait, duration_s)| CostRecord {
            gait: gait.to_owned(),
            duration_s,
            cost_n2m2s: 1.1 * duration_s,
            published_n2m2s: (gait != "ours").then_some(1.2 * duration_s),
        })
        .collect();
    let chains: Vec<ChainRecord> = gaits.iter().map(|gait| chain(gait)).collect();
    drawn(&chains, &pulls, &costs).unwrap()
}

fn stems(figures: &[Figure]) -> Vec<&str> {
    figures.iter().map(|figure| figure.stem.as_str()).collect()
}

fn panels(figure: &Figure) -> usize {
    figure.svg.matches("<clipPath").count()
}

#[test]
fn all_records_give_all_figures() {
    let expected = [
        "fig-25-gait-parameters",
        "fig-26-nominal-chain",
        "fig-34-optimal-chain",
        "fig-36-nominal-torque-by-duration",
        "fig-37-optimal-torque-by-duration",
        "fig-38-nominal-torque-over-time",
        "fig-39-optimal-torque-over-time",
        "fig-40-nominal-transient",
        "fig-41-optimal-transient",
        "fig-42-nominal-torque-over-cycle",
        "fig-43-optimal-torque-over-cycle",
        "fig-44-nominal-against-optimal",
        "fig-45-left-cost",
        "fig-45-right-cost-ratio",
    ];
    assert_eq!(stems(&draw(&ALL_S, &["nominal", "optimal"])), expected);
}

#[test]
fn fewer_durations_give_fewer_panels() {
    for (durations_s, by_duration, compared) in [
        (&ALL_S[..], 6, 12),
        (&[1.0, 2.0, 5.0][..], 3, 12),
        (&[5.0][..], 1, 4),
    ] {
        let figures = draw(durations_s, &["nominal", "optimal"]);
        let panels_of = |number| {
            panels(
                figures
                    .iter()
                    .find(|figure| figure.number == number)
                    .unwrap(),
            )
        };
        assert_eq!(panels_of("36"), by_duration, "{durations_s:?}");
        assert_eq!(panels_of("38"), 4, "{durations_s:?}");
        assert_eq!(panels_of("44"), compared, "{durations_s:?}");
    }
}

#[test]
fn a_missing_gait_leaves_its_figures_out() {
    let figures = draw(&[1.0], &["optimal", "ours"]);
    assert!(stems(&figures).iter().all(|stem| !stem.contains("nominal")));
    assert!(figures.iter().all(|figure| figure.number != "44"));
    let parameters = &figures[0].svg;
    assert!(parameters.contains("ours gait"));
    assert!(drawn(&[], &[], &[]).unwrap().is_empty());
    assert!(
        draw(&[], &["nominal"])
            .iter()
            .all(|figure| ["25", "26"].contains(&figure.number))
    );
}

#[test]
fn records_without_rows_or_samples_are_passed_over() {
    let pull = PullRecord {
        rows: Vec::new(),
        ..pull("nominal", 1.0)
    };
    let chain = ChainRecord {
        samples: Vec::new(),
        ..chain("nominal")
    };
    assert!(drawn(&[chain], &[pull], &[]).unwrap().is_empty());
    let mut single = self::chain("nominal");
    single.samples.truncate(1);
    assert_eq!(drawn(&[single], &[], &[]).unwrap().len(), 2);
}

#[test]
fn same_records_give_same_bytes() {
    let (first, second) = (
        draw(&[1.0, 5.0], &["nominal"]),
        draw(&[1.0, 5.0], &["nominal"]),
    );
    assert_eq!(first, second);
    assert_eq!(first[0].png(1.0).unwrap(), second[0].png(1.0).unwrap());
}

#[test]
fn every_svg_is_well_formed_and_finite() {
    for figure in draw(&ALL_S, &["nominal", "optimal", "ours"]) {
        let tree = resvg::usvg::Tree::from_str(&figure.svg, &resvg::usvg::Options::default());
        assert!(tree.is_ok(), "{}", figure.stem);
        assert!(
            !figure.svg.contains("NaN") && !figure.svg.contains("inf\""),
            "{}",
            figure.stem
        );
        assert!(!figure.title.is_empty() && !figure.caption.is_empty() && !figure.alt.is_empty());
    }
}

#[test]
fn no_text_leaves_the_sheet() {
    let mut figures = draw(&ALL_S, &["nominal", "optimal", "ours"]);
    figures.extend(torque_map_figures(&map(-12.5), &[0, 2]).unwrap());
    for figure in figures {
        let options = resvg::usvg::Options {
            fontdb: font::database(),
            ..resvg::usvg::Options::default()
        };
        let tree = resvg::usvg::Tree::from_str(&figure.svg, &options).unwrap();
        let (drawn, sheet) = (tree.root().abs_bounding_box(), tree.size());
        // The paper itself reaches the edges exactly; more would be cut off.
        assert!(
            drawn.left() >= 0.0 && drawn.top() >= 0.0,
            "{}: {drawn:?}",
            figure.stem
        );
        assert!(
            drawn.right() <= sheet.width() + 0.01,
            "{}: {drawn:?}",
            figure.stem
        );
        assert!(
            drawn.bottom() <= sheet.height() + 0.01,
            "{}: {drawn:?}",
            figure.stem
        );
    }
}

#[test]
fn png_has_ink_and_its_size_follows_the_scale() {
    let figure = &draw(&[5.0], &["nominal"])[0];
    let read = |scale| {
        let png = figure.png(scale).unwrap();
        resvg::tiny_skia::Pixmap::decode_png(&png).unwrap()
    };
    let (single, double) = (read(1.0), read(2.0));
    assert_eq!(double.width(), 2 * single.width());
    let dark = single
        .pixels()
        .iter()
        .filter(|pixel| pixel.red() < 128)
        .count();
    // Titles, frames and curves: a percent of the paper at least.
    assert!(dark * 100 > single.pixels().len(), "{dark} dark pixels");
}

#[test]
fn senseless_scales_are_refused() {
    let figure = &draw(&[5.0], &["nominal"])[0];
    for scale in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e6] {
        assert!(
            matches!(figure.png(scale), Err(FigureError::Scale { .. })),
            "{scale}"
        );
    }
}

#[test]
fn numbers_no_axis_can_show_are_named() {
    let mut broken = pull("nominal", 5.0);
    broken.rows[7].torque_nm[1] = f64::NAN;
    let error = drawn(&[], &[broken], &[]).unwrap_err().to_string();
    assert_eq!(
        error,
        "fig-36-nominal-torque-by-duration, panel 5 s: NaN cannot be drawn"
    );
    let mut huge = chain("nominal");
    huge.samples[3].parameters_deg[0] = 2e9;
    let error = drawn(&[huge], &[], &[]).unwrap_err().to_string();
    assert_eq!(
        error,
        "fig-25-gait-parameters, panel θ3 (knee): 2000000000 cannot be drawn"
    );
}

#[test]
fn slices_of_a_map_have_a_panel_per_joint_and_hatch_what_is_masked() {
    let figures = torque_map_figures(&map(1.2), &[2, 0, 3]).unwrap();
    assert_eq!(
        stems(&figures),
        ["torque-map-theta3+45.84deg", "torque-map-theta3-05.73deg"],
        "a slice beyond the map is left out"
    );
    let svg = &figures[0].svg;
    assert_eq!(panels(&figures[0]), 4);
    assert!(svg.contains("joint torque, N·m") && svg.contains("no torques: 7 of 35 rows"));
    let grey = "fill=\"#e0e0e0\"";
    assert_eq!(svg.matches(grey).count(), 4 * 7 + 1, "cells, and the key");
    assert!(!svg.contains("NaN"));
    let full = torque_map_figures(&map(0.0), &[1]).unwrap();
    assert!(!full[0].svg.contains("NaN"), "a map of zeros has a scale");
    assert!(torque_map_figures(&map(1e12), &[0]).is_err());
}
