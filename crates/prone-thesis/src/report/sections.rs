//! The sections with tables. Each number says whose it is.

use maud::{Markup, html};

use crate::prose::{Numbers, Prose};
use crate::published;
use crate::run_info::RunInfo;
use crate::summary::{CostRow, RatioRow, Summary};
use crate::table_crawl::TableExperiment;
use prone_record::contact_story::ContactStory;
use prone_record::program::RobotInfo;
use prone_record::pulls::JOINTS;
use prone_report::report::curve_tables::with_minus;
use prone_report::report::html_table::{optional, percent, table};

/// From this duration on the unknown start pose of the recordings no longer decides the cost.
const START_POSE_FORGOTTEN_S: f64 = 3.0;

pub(crate) fn results(summary: &Summary) -> Markup {
    let long = |duration_s: f64| duration_s >= START_POSE_FORGOTTEN_S;
    let ratios = || summary.ratios.iter().filter(|row| long(row.duration_s));
    let costs = summary.costs.iter().filter(|row| long(row.duration_s));
    let apart = costs.filter_map(|row| Some(row.relative_difference?.abs()));
    let agreement = summary.agreement.iter().filter(|row| long(row.duration_s));
    let rms = agreement.map(|row| row.rms_nm);
    let strides = summary.stride.chain_mm.iter();
    let (gaits, strides): (Vec<&str>, Vec<String>) = strides
        .map(|(gait, stride)| (gait.as_str(), format!("{stride:.1}")))
        .unzip();
    html! {
        section {
            h2 { "In short" }
            ul.cards {
                li {
                    strong { (span(ratios().map(|row| row.ours), percent)) }
                    span {
                        "cost of the optimal gait over the nominal one, ours, from 3 s on; published: "
                        (span(ratios().filter_map(|row| row.published), percent))
                    }
                }
                li {
                    strong { (span(apart, percent)) }
                    span { "our costs away from the published ones, from 3 s on" }
                }
                li {
                    strong { (span(rms, |value| format!("{value:.2}\u{a0}N·m"))) }
                    span { "RMS between our torques and the published recordings, by joint, from 3 s on, last 80 % of the phase" }
                }
                li {
                    strong { (strides.join(", ")) "\u{a0}mm" }
                    span { "advance of the shoulder per pull in the planned chain, " (gaits.join(", ")) }
                }
            }
        }
    }
}

pub(crate) fn contacts(summary: &Summary, numbers: &Numbers) -> Markup {
    html! {
        section {
            h2 { "Which part carries the body when" }
            @if summary.robot.as_ref().is_some_and(|robot| robot.sunk_mm > 0.0) {
                p { (numbers.fill(&Prose::shipped().contacts)) }
            }
            @for story in &summary.contacts { (contact_table(story)) }
        }
    }
}

fn contact_table(story: &ContactStory) -> Markup {
    let caption = html! {
        strong { (story.gait) } ", " (story.duration_s) " s: "
        @match story.carried_from_percent {
            Some(percent) => { "toes and elbows carry from " (format!("{percent:.0}")) " % of the phase on" }
            None => { "toes and elbows never carry to the end" }
        }
        "; torso and legs take " (format!("{:.0}", story.body_share_percent))
        " % of the force over the whole phase."
    };
    let tenths = story.tenths_percent.iter().enumerate();
    html! {
        (table(caption, &["phase", "toes", "elbows and hands", "torso", "legs"], tenths.map(|(tenth, shares)| html! {
            td { (tenth * 10) "–" (tenth * 10 + 10) " %" }
            @for share in shares { td { (bar(*share)) (format!("{share:.0} %")) } }
        })))
    }
}

fn bar(percent: f64) -> Markup {
    html! { span.band style=(format!("width:{:.2}em", percent * 0.03)) {} }
}

pub(crate) fn costs(summary: &Summary) -> Markup {
    let caption = "∫ (τ²ankle + τ²knee + τ²hip + τ²shoulder) dt of one side, N²·m²·s. Ours: \
                   simulation of this run, trapezoid rule over 50 ms means, first value held back \
                   to 0. Published: values behind Figure 45. Below 3 s the unknown start pose of \
                   the recordings decides the cost: reported, not tuned.";
    let of = |robot: &RobotInfo, mass_kg: f64| format!("{}, {mass_kg:.3} kg. ", robot.name);
    let study_of = summary.study_of.as_ref().zip(summary.robot.as_ref());
    let study_of = study_of.map(|(robot, numbers)| of(robot, numbers.mass_kg));
    html! {
        section {
            h2 { "Costs, ours beside published" }
            @if let (Some(study_of), Some(beside)) = (&study_of, &summary.beside) {
                p {
                    "The published torques are those of one version of the robot, and the study is of \
                     that version: " (study_of) "The same pulls of the version that crawls are below: "
                    (of(&beside.robot, beside.mass_kg))
                }
            }
            (cost_table(&html! { (study_of.unwrap_or_default()) (caption) }, &summary.costs, &summary.ratios))
            @if let Some(beside) = &summary.beside {
                (cost_table(
                    &html! { (of(&beside.robot, beside.mass_kg)) "The same, from the same run." },
                    &beside.costs,
                    &beside.ratios,
                ))
            }
        }
    }
}

fn cost_table(caption: &Markup, costs: &[CostRow], ratios: &[RatioRow]) -> Markup {
    let of = |gait: &'static str| costs.iter().filter(move |row| row.gait == gait);
    let rows = of(published::NOMINAL).zip(of(published::OPTIMAL));
    table(
        caption,
        &[
            "duration",
            "nominal, ours",
            "published",
            "difference",
            "optimal, ours",
            "published",
            "difference",
            "ratio, ours",
            "published",
        ],
        rows.map(|(nominal, optimal)| {
            html! {
                td { (nominal.duration_s) " s" }
                @for row in [nominal, optimal] { (cost_cells(row)) }
                (ratio_cells(ratios, nominal.duration_s))
            }
        }),
    )
}

/// What the chain's internal squeeze does, ours beside published.
pub(crate) fn squeeze(summary: &Summary) -> Markup {
    let known = summary.squeeze.iter().filter(|it| it.published.is_some());
    let caption = "Squeeze in newtons a side, positive where the ground presses toes and elbows \
                   together. Ours: measured at the contacts of this run. Published: fitted to the \
                   recorded torques, one number to four torques in each tenth of the pull, with our \
                   postures and our robot, so that it also holds what masses differ by. Rate: mean of \
                   Στ², N²·m², over the tenths of the pull in which toes and elbows carry. RMS: \
                   published less ours over the four joints, as it is and with the squeeze made equal.";
    let ratios =
        "Optimal over nominal by that rate, as it is and with each pull's squeeze taken out.";
    let number = |value: f64, decimals| with_minus(value, decimals);
    html! {
        @if !summary.squeeze.is_empty() {
            section {
                h2 { "Squeeze between toes and elbows" }
                p {
                    "Weight leaves open how hard the ground presses toes and elbows together; friction \
                     decides it, and it changes every torque. A newton more a side adds −z N·m at ankle, \
                     knee and hip and +z at the shoulder, z being the height of the joint in metres. \
                     Where the published runs had another squeeze than ours, costs differ without any \
                     difference between the gaits."
                }
                (table(caption, &[
                    "pull", "squeeze, ours", "published", "rate per newton",
                    "rate, ours", "without squeeze", "rate, published", "without squeeze",
                    "RMS, N·m", "with equal squeeze",
                ], known.map(|it| html! {
                    td { (it.gait) ", " (it.duration_s) " s" }
                    td { (number(it.ours.squeeze_n, 2)) }
                    td { (optional(it.published.map(|it| it.squeeze_n), |it| number(it, 2))) }
                    td { (number(it.effect_percent, 0)) " %" }
                    @for squeezed in [Some(it.ours), it.published] {
                        td { (optional(squeezed.map(|it| it.rate_n2m2), |it| format!("{it:.3}"))) }
                        td { (optional(squeezed.map(|it| it.rate_without_n2m2), |it| format!("{it:.3}"))) }
                    }
                    @for rms in [it.rms_nm, it.rms_with_its_squeeze_nm] {
                        td { (optional(rms, |rms| format!("{rms:.3}"))) }
                    }
                })))
                (table(ratios, &[
                    "duration", "ours", "without squeeze", "published", "without squeeze",
                ], summary.squeeze_ratios.iter().filter(|row| row.published.is_some()).map(|row| html! {
                    td { (row.duration_s) " s" }
                    @for ratio in [Some(row.ours), Some(row.ours_without), row.published, row.published_without] {
                        td { (optional(ratio, |ratio| format!("{ratio:.3}"))) }
                    }
                })))
            }
        }
    }
}

fn cost_cells(row: &CostRow) -> Markup {
    html! {
        td { (format!("{:.3}", row.cost_n2m2s)) }
        td { (optional(row.published_n2m2s, |cost| format!("{cost:.3}"))) }
        td { (optional(row.relative_difference, |value| format!("{:+.1} %", value * 100.0))) }
    }
}

fn ratio_cells(ratios: &[RatioRow], duration_s: f64) -> Markup {
    let mut ratios = ratios.iter();
    let row = ratios.find(|row| (row.duration_s - duration_s).abs() < 1e-9);
    html! {
        td { (optional(row.map(|row| row.ours), |ratio| format!("{ratio:.3}"))) }
        td { (optional(row.and_then(|row| row.published), |ratio| format!("{ratio:.3}"))) }
    }
}

pub(crate) fn agreement(summary: &Summary) -> Markup {
    html! {
        section {
            h2 { "Agreement with the published recordings" }
            p {
                "Our torques against the published recordings, both as means over tenths of the \
                 phase, from 20 % on. A correlation says little where a curve is nearly flat, as \
                 the optimal gait's hip torque is; the RMS holds everywhere."
            }
            div.scroll { table {
                caption { "RMS in N·m and correlation by joint, our simulation against the recordings." }
                thead {
                    tr {
                        th scope="col" rowspan="2" { "pull" }
                        @for joint in JOINTS { th scope="colgroup" colspan="2" { (joint) } }
                    }
                    tr { @for _ in JOINTS { th scope="col" { "RMS" } th scope="col" { "corr." } } }
                }
                tbody {
                    @for joints in summary.agreement.chunks(JOINTS.len()) {
                        tr {
                            @if let Some(first) = joints.first() {
                                td { (first.gait) ", " (first.duration_s) " s" }
                            }
                            @for row in joints {
                                td { (format!("{:.3}", row.rms_nm)) }
                                td { (optional(row.correlation, |value| format!("{value:.3}"))) }
                            }
                        }
                    }
                }
            } }
        }
    }
}

pub(crate) fn stride(summary: &Summary, numbers: &Numbers) -> Markup {
    let [first, second] = summary.stride.published_robot_mm_per_cycle;
    let caption = numbers.fill(&Prose::shipped().stride);
    html! {
        section {
            h2 { "Stride and heights" }
            p {
                "The planned chain carries the shoulder "
                @for (index, (gait, stride)) in summary.stride.chain_mm.iter().enumerate() {
                    @if index > 0 { " and " }
                    (format!("{stride:.1} mm")) " (" (gait) ")"
                }
                " forward per pull. Published for the real robot over whole crawl cycles: "
                (format!("{first:.1}")) " and " (format!("{second:.1} mm per cycle.")) " The ankle's highest point: "
                @for (index, peak) in summary.ankle_peak.iter().enumerate() {
                    @if index > 0 { "; " }
                    (format!("{:.1} mm at {:.0} % of the phase", peak.height_mm, peak.at_percent))
                    " (" (peak.gait) ", planned chain"
                    @if let Some(published) = &peak.published_mm { "; published: " (published) " mm" }
                    ")"
                }
                "."
            }
            (table(caption, &["pull", "advance", "to the left", "highest point", "head"], summary.runs.iter().map(|run| html! {
                td { (run.gait) ", " (run.duration_s) " s" }
                @for value in [run.advance_mm, run.lateral_mm, run.top_mm, run.head_top_mm] {
                    // A rounded zero has no sign.
                    td { (format!("{:.1} mm", (value * 10.0).round() / 10.0 + 0.0)) }
                }
            })))
        }
    }
}

pub(crate) fn table_crawl(summary: &Summary, info: &RunInfo) -> Markup {
    let caption = "Two experiments, ours in simulation beside the published ones on the robot.";
    html! {
        @if let Some(first) = summary.table.first() {
            p {
                "Pull, recovery, pull: the cycle " (first.ours.gait) " with the published poses, in \
                 the scene " (first.ours.scene)
                @if let Some(table) = &info.options.table {
                    ", contact regime " (table.regime) " (friction " (table.friction) ", the \
                     manufacturer's effort and joint limits on)"
                }
                ". Published: " (first.published_obtained)
                ". Ours: " (first.ours_obtained) ". Of the table only the height of its panels, \
                 200 mm, is published; the other sizes are assumed."
                @if let Some(robot) = Prose::shipped().of_robot(info.robot.family.as_deref()) {
                    @if !first.ours.contacts.is_empty() { " " (robot.table) }
                }
            }
        }
        (table(caption, &[
            "cycles", "distance, ours", "published", "time, ours", "published",
            "per cycle, ours", "published", "speed, ours", "published", "touched, ours",
        ], summary.table.iter().map(|TableExperiment { ours, published, .. }| html! {
            td { (published.cycles) }
            td { (format!("{:.1} mm", ours.distance_mm)) }
            td { (format!("{:.1} mm", published.distance_mm)) }
            td { (format!("{:.1} s", ours.time_s)) }
            td { (format!("{:.0} s", published.time_s)) }
            td { (format!("{:.1} mm", ours.mm_per_cycle)) }
            td { (format!("{:.1} mm", published.mm_per_cycle())) }
            td { (format!("{:.1} mm/s", ours.mm_per_s)) }
            td { (format!("{:.1} mm/s", published.distance_mm / published.time_s)) }
            td {
                @if ours.contacts.is_empty() { "nothing" }
                @for (index, contact) in ours.contacts.iter().enumerate() {
                    @if index > 0 { "; " }
                    (contact.obstacle) " with " (contact.body)
                    (format!(" for {:.1} s, up to {:.0} N", contact.seconds, contact.peak_n))
                }
            }
        })))
    }
}

pub(crate) fn clamps(summary: &Summary, numbers: &Numbers, family: Option<&str>) -> Markup {
    let prose = Prose::shipped();
    html! {
        section {
            h2 { "Joints at their limits" }
            p {
                @if summary.clamps.is_empty() { "No joint is asked for more than its limits." }
                @else { (prose.clamps) }
                @if let Some(robot) = prose.of_robot(family) { " " (numbers.fill(&robot.clamps)) }
            }
            (table("Planned gait, sampled every 1 % of the phase; ours.", &[
                "gait", "joint", "samples", "phase", "largest cut",
            ], summary.clamps.iter().map(|clamp| html! {
                td { (clamp.gait) }
                td { (clamp.joint) }
                td { (clamp.samples) " of " (clamp.of_samples) }
                td { (format!("{:.0}–{:.0} %", clamp.from_percent, clamp.to_percent)) }
                td { (format!("{:+.2}°", clamp.largest_deg)) }
            })))
        }
    }
}

pub(crate) fn mappings(summary: &Summary, numbers: &Numbers) -> Markup {
    html! {
        section {
            h2 { "What the mapping changes" }
            @if summary.robot.as_ref().is_some_and(|robot| robot.published.is_some()) {
                p { (numbers.fill(&Prose::shipped().mappings)) }
            }
            (table("Cost of the same gait under both mappings, ours, N²·m²·s.", &[
                "gait", "duration", "original", "exact", "ratio",
            ], summary.mappings.iter().map(|row| html! {
                td { (row.gait) }
                td { (row.duration_s) " s" }
                td { (format!("{:.3}", row.own_n2m2s)) }
                td { (format!("{:.3}", row.exact_n2m2s)) }
                td { (format!("{:.3}", row.exact_n2m2s / row.own_n2m2s)) }
            })))
        }
    }
}

/// What is known to differ from the original, of the robot that it had.
pub(crate) fn differences(numbers: &Numbers, family: Option<&str>) -> Markup {
    html! {
        @if let Some(robot) = Prose::shipped().of_robot(family) {
            section {
                h2 { "Known differences" }
                ul { @for sentence in &robot.differences { li { (numbers.fill(sentence)) } } }
            }
        }
    }
}

/// Under which conditions a reproduction was made: entries of a list.
pub(crate) fn study_facts(info: &RunInfo) -> Markup {
    let (options, robot) = (&info.options, &info.robot);
    let durations: Vec<String> = options.durations_s.iter().map(f64::to_string).collect();
    html! {
        @for gait in &options.gaits {
            dt { "gait " (gait.name) }
            dd { (gait.description) "; mapping " (gait.mapping) ", arms " (gait.arm) }
        }
        dt { "durations" } dd { (durations.join(", ")) " s" }
        dt { "robot" } dd { (robot.name) ", version " (robot.version_name()) ", " (robot.folder) ", SHA-256 " (robot.sha256) }
        @if let Some(robot) = &info.crawler {
            dt { "robot that crawls" }
            dd { (robot.name) ", version " (robot.version_name()) ", " (robot.folder) ", SHA-256 " (robot.sha256) }
        }
        dt { "time step" } dd { (options.time_step_s * 1e3) " ms" }
        dt { "contact regime" } dd { (options.regime) ": friction " (options.friction) ", impratio " (options.impratio) }
        dt { "servo" } dd {
            "speed command " (options.servo_rate_per_s) " /s × error, at most ±" (options.servo_speed_rad_s)
            " rad/s; commands change every " (options.control_step_s * 1e3) " ms; torque limit " (options.effort_limit)
        }
        dt { "joint stops" } dd { (options.stops) }
        @if let Some(table) = &options.table {
            dt { "cycle " (table.gait) }
            dd {
                (table.description) "; scene " (table.scene) ", contact regime "
                (table.regime) ": friction " (table.friction) ", impratio " (table.impratio)
            }
        }
        dt { "start" } dd { "posture " (options.start_posture) ", laid on the belly, held for " (options.settle_s) " s" }
    }
}

/// Smallest to largest.
fn span(values: impl Iterator<Item = f64>, show: impl Fn(f64) -> String) -> String {
    let values: Vec<f64> = values.collect();
    let low = values.iter().copied().min_by(f64::total_cmp);
    let high = values.iter().copied().max_by(f64::total_cmp);
    match low.zip(high).map(|(low, high)| (show(low), show(high))) {
        None => "no pull of 3 s or more".to_owned(),
        Some((low, high)) if low == high => low,
        Some((low, high)) => format!("{low} to {high}"),
    }
}
