//! `prone report` on results that the program makes.
//!
//! Whether the page is valid HTML is asked of `html-validate`, a package of viewer/ (`npm ci`). A test
//! whose package is missing says that it skipped; with `PRONE_REQUIRE_VALIDATOR=1` it fails. The same
//! holds of the browser and `PRONE_REQUIRE_BROWSER`.

mod folder;
mod program;
mod reporting;
mod short_crawl;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use serde_json::Value;
use tempfile::TempDir;

use folder::files;
use reporting::{results, succeeded, text};

/// What the page of a report may weigh.
const LARGEST_PAGE: usize = 6_000_000;

/// How scripts say that what they need is not there.
const NOT_THERE: i32 = 77;

/// Figures that need a robot.
const OF_A_ROBOT: [&str; 4] = ["29", "30", "32", "33"];

/// Slices of a coarse torque map, made once.
fn maps() -> &'static str {
    static MAPS: OnceLock<(TempDir, String)> = OnceLock::new();
    let (_, folder) = MAPS.get_or_init(|| {
        let home = tempfile::tempdir().unwrap();
        let at = |name: &str| home.path().join(name).display().to_string();
        let (map, maps) = (at("map.csv"), at("maps"));
        let coarse = ["--step-deg", "10", "--theta4-max-deg", "10"];
        let build = ["torque-map", "build", "--source", "statics", "--out", &map];
        succeeded(&[&build[..], &coarse].concat());
        succeeded(&["torque-map", "plot", &map, "--out", &maps]);
        (home, maps)
    });
    folder
}

/// All results.
fn everything() -> [&'static str; 4] {
    let made = results();
    [&made.reproduction, &made.crawl, &made.search, maps()]
}

/// The chapter, filled by all results, made once.
fn report() -> &'static Path {
    static REPORT: OnceLock<(TempDir, PathBuf)> = OnceLock::new();
    let (_, folder) = REPORT.get_or_init(|| {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("report");
        let out = ["--chapter", "--out", folder.to_str().unwrap()];
        succeeded(&[&["report"], &everything()[..], &out].concat());
        (home, folder)
    });
    folder
}

/// The report of all results by run, made once, and what was said of it.
fn by_run() -> (&'static Path, &'static str) {
    static REPORT: OnceLock<(TempDir, PathBuf, String)> = OnceLock::new();
    let (_, folder, said) = REPORT.get_or_init(|| {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("report");
        let out = ["--out", folder.to_str().unwrap()];
        let said = succeeded(&[&["report"], &everything()[..], &out].concat());
        (home, folder, said)
    });
    (folder, said)
}

fn json(file: impl AsRef<Path>) -> Value {
    serde_json::from_str(&text(file)).unwrap()
}

fn numbers() -> Value {
    json(report().join("report.json"))
}

/// Every element of a name, as it stands in the page.
fn elements<'a>(page: &'a str, name: &str) -> Vec<&'a str> {
    let open = format!("<{name} ");
    let parts = page.split(&open[..]).skip(1);
    parts.map(|part| part.split('>').next().unwrap()).collect()
}

#[test]
fn every_figure_of_the_chapter_is_there_or_says_what_makes_it() {
    let page = text(report().join("report.html"));
    assert!(page.len() <= LARGEST_PAGE, "{} bytes", page.len());
    let numbers = numbers();
    let missing = numbers["missing"].as_array().unwrap();
    let of_a_robot: Vec<&str> = missing
        .iter()
        .filter_map(|it| it["number"].as_str())
        .collect();
    assert_eq!(of_a_robot, OF_A_ROBOT);
    for number in OF_A_ROBOT {
        assert!(page.contains(&format!("id=\"place-{number}\"")), "{number}");
    }
    let figures = numbers["figures"].as_array().unwrap();
    for figure in figures {
        let stem = figure["stem"].as_str().unwrap();
        assert!(page.contains(&format!("<figure id=\"{stem}\">")), "{stem}");
        for kind in ["svg", "png"] {
            let file = report().join(format!("figures/{stem}.{kind}"));
            assert!(file.is_file(), "{}", file.display());
        }
    }
    for number in 22..=45 {
        let number = number.to_string();
        let there = figures.iter().any(|figure| figure["number"] == number[..]);
        assert_ne!(there, OF_A_ROBOT.contains(&&number[..]), "Figure {number}");
    }
    let stems: Vec<&str> = figures
        .iter()
        .filter_map(|it| it["stem"].as_str())
        .collect();
    assert!(
        stems
            .iter()
            .any(|stem| stem.starts_with("torque-map-theta3"))
    );
    assert!(stems.contains(&"confirmation"));
    let files = files(report());
    let pictures = files
        .keys()
        .filter(|file| file.starts_with("figures"))
        .count();
    assert_eq!(pictures, 2 * figures.len(), "no file without a figure");
}

#[test]
fn own_runs_come_first_and_nothing_is_said_of_figures_that_no_run_has() {
    let (folder, said) = by_run();
    assert!(
        !said.contains("no figure") && !said.contains("chapter"),
        "{said}"
    );
    let numbers = json(folder.join("report.json"));
    assert_eq!(numbers["missing"].as_array().unwrap().len(), 0);
    let page = text(folder.join("report.html"));
    for wrong in [
        "class=\"place\"",
        "Not among these runs",
        "Comes with a robot",
    ] {
        assert!(!page.contains(wrong), "{wrong}");
    }
    // It is called after what it holds: the runs of one's own, then the study.
    let heading = page.split("<h1>").nth(1).unwrap();
    let heading = heading.split("</h1>").next().unwrap();
    assert!(heading.starts_with("hip-10 · under-plate, "), "{heading}");
    assert!(heading.ends_with(" and 2 more"), "{heading}");
    let at = |sought: &str| page.find(sought).unwrap_or_else(|| panic!("{sought}"));
    let order = [
        "<nav ",
        "<iframe ",
        "<h2>Report card</h2>",
        "<figure id=\"fig-31-hip-10-angles\">",
        "<figure id=\"confirmation\">",
        "<h2>The Projected Profile crawl</h2>",
        "<figure id=\"fig-36-nominal-torque-by-duration\">",
        "<h2>What was run</h2>",
    ];
    assert!(order.windows(2).all(|two| at(two[0]) < at(two[1])));
    // Each figure is there once, one's own without a number and without what is published.
    for figure in numbers["figures"].as_array().unwrap() {
        let stem = figure["stem"].as_str().unwrap();
        assert_eq!(
            page.matches(&format!("<figure id=\"{stem}\">")).count(),
            1,
            "{stem}"
        );
    }
    let (own, study) = page.split_at(at("<h2>The Projected Profile crawl</h2>"));
    for published in ["<strong>Figure ", "Published, on the robot", "Published:"] {
        assert!(!own.contains(published), "{published}");
        assert!(study.contains(published), "{published}");
    }
    assert!(!own.contains("range on the crawling robot, published"));
    assert!(text(report().join("report.html")).contains("range on the crawling robot, published"));
    // Every link of the contents leads somewhere.
    let contents = page.split("<nav ").nth(1).unwrap();
    let contents = contents.split("</nav>").next().unwrap();
    let links: Vec<&str> = contents.split("href=\"#").skip(1).collect();
    assert!(links.len() >= 9, "{contents}");
    for link in links {
        let place = link.split('"').next().unwrap();
        assert_eq!(
            page.matches(&format!(" id=\"{place}\"")).count(),
            1,
            "{place}"
        );
    }
}

#[test]
fn a_page_loads_nothing_and_says_what_it_shows() {
    let page = text(report().join("report.html"));
    let shown = page.split("srcdoc=\"").next().unwrap();
    for name in ["src=\"", "href=\"", "url("] {
        for found in page.split(name).skip(1) {
            let own = found.starts_with("data:") || found.starts_with('#');
            assert!(own, "{name}{}", &found[..60.min(found.len())]);
        }
    }
    assert!(!shown.contains("<script"));
    let images = elements(&page, "img");
    assert!(images.len() >= 5, "{}", images.len());
    let drawings = elements(&page, "div");
    let drawings = drawings.iter().filter(|div| div.contains("role=\"img\""));
    let frames = elements(&page, "iframe");
    assert_eq!(frames.len(), 1);
    assert!(frames[0].contains("sandbox=\"allow-scripts\""));
    // The study is of the scene's robot, the crawl of the V4.
    let about =
        "Text without a source is about NAO of the recording scene (approximation) and NAO H25 V4.";
    assert!(page.contains(about));
    // The crawl that was named, and in the report of a reproduction one gait beside the other.
    assert!(frames[0].contains("title=\"Replay: hip-10 · under-plate\""));
    let own = text(Path::new(&results().reproduction).join("report.html"));
    let title = "title=\"Replay: nominal · level beside optimal · level\"";
    assert!(elements(&own, "iframe")[0].contains(title));
    let said = images.iter().map(|image| (*image, "alt=\""));
    let said = said.chain(drawings.map(|div| (*div, "aria-label=\"")));
    for (element, attribute) in said.chain([(frames[0], "title=\"")]) {
        let words = element.split(attribute).nth(1).unwrap();
        let words = words.split('"').next().unwrap();
        assert!(words.len() > 15, "{attribute}{words}");
    }
}

#[test]
fn what_a_card_says_is_in_the_record() {
    let numbers = numbers();
    let card = &numbers["cards"][0];
    assert_eq!(card["run"], results().crawl[..]);
    let summary = json(Path::new(&results().crawl).join("summary.json"));
    let number = |value: &Value| value.as_f64().unwrap();
    for (ours, recorded) in [
        ("speed_mm_s", "mm_per_s"),
        ("path_mm", "path_mm"),
        ("time_s", "time_s"),
        ("cost_of_transport_mechanical", "cost_of_transport"),
        (
            "cost_of_transport_electrical_estimated",
            "electrical_cost_of_transport",
        ),
        ("heat_per_metre_s", "heat_per_metre_s"),
        ("stride_efficiency", "stride_efficiency"),
    ] {
        let (ours, recorded) = (number(&card[ours]), number(&summary[recorded]));
        assert!(
            ours.total_cmp(&recorded).is_eq(),
            "{recorded} is not {ours}"
        );
    }
    // The manufacturer says that the NAO is 574 mm high.
    let heights = number(&card["standing_heights_per_s"]);
    assert!((heights * 574.0 - number(&summary["mm_per_s"])).abs() < 1e-9);
    let tops = summary["top_mm"].as_object().unwrap().values();
    let highest = tops.map(number).fold(0.0, f64::max);
    assert!((number(&card["lowest_passage_mm"]) - highest).abs() < 1e-12);
    let joints = card["joints"].as_array().unwrap();
    let shares = joints.iter().map(|joint| number(&joint["heat_share"]));
    let all = shares.sum::<f64>() + number(&card["other_joints_heat_share"]);
    assert!((all - 1.0).abs() < 1e-9, "{all}");
    let page = text(report().join("report.html"));
    assert!(page.contains(&format!("{:.1} mm/s", number(&summary["mm_per_s"]))));
}

/// Rows of `rows.csv` are means over 20 ms: peaks are higher, and root mean squares a little.
#[test]
fn identity_the_joints_of_a_card_are_those_of_the_rows() {
    let rows = text(Path::new(&results().crawl).join("rows.csv"));
    let mut lines = rows.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().unwrap();
    let rows: Vec<_> = lines.collect();
    let numbers = numbers();
    let joints = numbers["cards"][0]["joints"].as_array().unwrap();
    assert!(joints.len() > 5);
    for joint in joints {
        let name = joint["joint"].as_str().unwrap();
        let column = format!("{name}_nm");
        let column = header.iter().position(|known| **known == column).unwrap();
        let torques = rows.iter().map(|row| row[column].parse::<f64>().unwrap());
        let (squares, peak) = torques.fold((0.0, 0.0_f64), |(squares, peak), torque| {
            (squares + torque * torque, peak.max(torque.abs()))
        });
        let rms = (squares / rows.len() as f64).sqrt();
        let ours = |key: &str| joint[key].as_f64().unwrap();
        assert!(ours("peak_nm") >= peak - 1e-5, "{name}");
        // The mean of squares is never below the square of means. Stiff neck and wrist chatter within
        // 20 ms; knees and shoulders do not.
        let ratio = ours("rms_nm") / rms;
        let steady = name.contains("Knee") || name.contains("ShoulderPitch");
        let most = if steady { 1.1 } else { f64::INFINITY };
        assert!((0.999..most).contains(&ratio), "{name}: {ratio}");
        // Of the nominal torque the gears pass on 0.6.
        let over = ours("rms_nm") / (0.6 * ours("nominal_nm"));
        assert!((over - ours("rms_over_nominal")).abs() < 1e-12);
    }
}

/// Motors of the NAO's legs: stall 68 mN·m, 8,300 turns a minute without load, ratio 130.85.
#[test]
fn reference_winding_loss_is_that_of_the_manufacturer_s_motor() {
    let summary = json(Path::new(&results().crawl).join("summary.json"));
    let joints = summary["joints"].as_array().unwrap();
    let knee = joints
        .iter()
        .find(|joint| joint["joint"] == "RKneePitch")
        .unwrap();
    let number = |key: &str| knee[key].as_f64().unwrap();
    let square = number("rms_nm").powi(2) * summary["time_s"].as_f64().unwrap();
    let no_load = 8300.0 * std::f64::consts::TAU / 60.0;
    let expected = square / 130.85_f64.powi(2) * no_load / 0.068;
    assert!((number("winding_loss_j") / expected - 1.0).abs() < 1e-9);
    let all: f64 = joints
        .iter()
        .map(|joint| joint["winding_loss_j"].as_f64().unwrap())
        .sum();
    let electrical = summary["electrical_cost_of_transport"].as_f64().unwrap();
    let mechanical = summary["cost_of_transport"].as_f64().unwrap();
    let work = summary["work_j"].as_f64().unwrap();
    assert!((electrical / mechanical - (work + all) / work).abs() < 1e-9);
}

#[test]
fn the_report_of_a_reproduction_is_the_one_in_it() {
    let home = tempfile::tempdir().unwrap();
    let page = home.path().join("page.html");
    let reproduction = &results().reproduction;
    let out = ["--chapter", "--out", page.to_str().unwrap()];
    succeeded(&[&["report", reproduction][..], &out].concat());
    let own = text(Path::new(reproduction).join("report.html"));
    assert!(own == text(page).replace(&reproduction[..], "this folder"));
    // Costs and both parameter tables are in it, ours beside published.
    for said in [
        "Table 2. Gait parameters, nominal.",
        "−30.0° to −90.0°",
        "Table 3. Gait parameters, optimal.",
        "−1.98980",
        "1.552",
    ] {
        assert!(own.contains(said), "{said}");
    }
    let costs = text(Path::new(reproduction).join("costs.csv"));
    let first = costs.lines().nth(1).unwrap().split(',').nth(2).unwrap();
    let first: f64 = first.parse().unwrap();
    assert!(own.contains(&format!("<td>{first:.3}</td>")), "{first}");
}

#[test]
fn the_same_on_any_number_of_threads() {
    let home = tempfile::tempdir().unwrap();
    let mut made = Vec::new();
    for threads in ["1", "3"] {
        let out = home.path().join("report").display().to_string();
        let more = ["--out", &out, "--threads", threads];
        succeeded(&[&["report"], &everything()[..], &more].concat());
        made.push(files(Path::new(&out)));
    }
    assert!(made[0] == made[1]);
}

/// A script of viewer/; whether what it needs is there.
fn script(name: &str, arguments: &[&Path], required: &str) -> bool {
    let viewer = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../viewer");
    let ran = Command::new("node")
        .arg(viewer.join(name))
        .args(arguments)
        .output();
    let missing = match &ran {
        Err(_) => true,
        Ok(ran) => ran.status.code() == Some(NOT_THERE),
    };
    if missing {
        let required = std::env::var_os(required).is_some();
        assert!(!required, "{name} lacks what it needs, and it is required");
        eprintln!("skipped: {name} lacks what it needs");
        return false;
    }
    let ran = ran.unwrap();
    println!("{}", String::from_utf8_lossy(&ran.stdout));
    let message = String::from_utf8_lossy(&ran.stderr);
    assert!(ran.status.success(), "{message}");
    true
}

#[test]
fn a_validator_has_no_complaint() {
    let (page, other) = (report().join("report.html"), by_run().0.join("report.html"));
    if script(
        "test/validate.mjs",
        &[&page, &other],
        "PRONE_REQUIRE_VALIDATOR",
    ) {
        // It would have one.
        let broken = text(&page).replacen("</main>", "<p id=\"place-29\"><div></p></main>", 1);
        let home = tempfile::tempdir().unwrap();
        let file = home.path().join("broken.html");
        fs::write(&file, broken).unwrap();
        let viewer = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../viewer");
        let ran = Command::new("node")
            .arg(viewer.join("test/validate.mjs"))
            .arg(file)
            .output()
            .unwrap();
        let message = String::from_utf8(ran.stderr).unwrap();
        assert_eq!(ran.status.code(), Some(1), "{message}");
        assert!(message.contains("no-dup-id"), "{message}");
    }
}

#[test]
fn a_browser_shows_page_and_replay() {
    let pages = [("report", by_run().0), ("chapter", report())];
    for (name, folder) in pages {
        let pictures: PathBuf = [env!("CARGO_TARGET_TMPDIR"), name].iter().collect();
        let page = folder.join("report.html");
        script(
            "test/report.mjs",
            &[&page, &pictures],
            "PRONE_REQUIRE_BROWSER",
        );
    }
}
