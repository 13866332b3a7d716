//! Records made by hand are shown, reported and exported by a program without an engine.

mod made;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use maud::{Markup, html};
use serde_json::json;

use prone::gait::cycle::{CheckedCycle, TimeScale};
use prone_files::cycle_file;
use prone_record::record_info::RecordInfo;
use prone_record::recorded::{Recorded, RecordedModel, compiled_robot};
use prone_report::export::lag::Lags;
use prone_report::export::{key_frames, numpy, ros_log, table, timeline, urdf};
use prone_report::figures::PublishedRange;
use prone_report::report::{
    Arrangement, Folder, Part, Place, Publication, PublishedRun, Report, ReportError, Run, Source,
    Unpublished,
};
use prone_report::view;

fn folder(make: fn(&Path)) -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    make(home.path());
    home
}

fn report(folder: &Path) -> Report {
    let source = Source {
        name: "RUN".to_owned(),
        folder: folder.to_owned(),
    };
    Report::from_folders(&[source], &Unpublished, Arrangement::Runs).unwrap()
}

/// How many messages each topic of an MCAP file has.
fn messages(bytes: &[u8]) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for message in mcap::MessageStream::new(bytes).unwrap() {
        let topic = message.unwrap().channel.topic.clone();
        *counts.entry(topic).or_default() += 1;
    }
    counts
}

fn lines(bytes: Vec<u8>) -> Vec<String> {
    let text = String::from_utf8(bytes).unwrap();
    text.lines().map(str::to_owned).collect()
}

#[test]
fn a_whole_record_is_shown_and_reported() {
    let home = folder(made::whole);
    let run = view::record::read(home.path()).unwrap();
    assert_eq!((run.title(), run.rows()), ("hip-10 · level", 3));
    assert_eq!((run.shortfalls(), run.gaps()), (&[][..], &[][..]));
    let page = view::page(&[&run]).unwrap();
    assert!(page.contains("\"LKneePitch_rad\""));
    // Pictures turn nothing by torques.
    assert!(!page.contains("\"principal\""));
    let report = report(home.path());
    assert_eq!(report.numbers.cards.len(), 1);
    assert_eq!(report.numbers.cards[0].steering, "none");
    assert_eq!(report.numbers.replayed, ["RUN"]);
    assert_eq!(
        (
            report.numbers.shortfalls.len(),
            report.numbers.unrecorded.len()
        ),
        (0, 0)
    );
    for said in [
        "implicitfast, Newton, elliptic",
        "the manufacturer's",
        "Replay",
    ] {
        assert!(report.html.contains(said), "{said}");
    }
    assert!(
        report
            .numbers
            .figures
            .iter()
            .any(|figure| figure.stem == "fig-31-hip-10-angles")
    );
}

/// A report of one's own runs is of them: it is called after them, leads to them, and has neither
/// numbers of a publication nor places for figures that no run has.
#[test]
fn a_report_by_run_mentions_nothing_but_the_runs() {
    let home = folder(made::whole);
    let source = |name: &str| Source {
        name: name.to_owned(),
        folder: home.path().to_owned(),
    };
    let report =
        |arrangement| Report::from_folders(&[source("RUN")], &Chapter::new(), arrangement).unwrap();
    let (own, chapter) = (report(Arrangement::Runs), report(Arrangement::Chapter));
    assert!(own.html.contains("<h1>hip-10 · level</h1>"));
    assert!(
        own.html
            .contains("<title>hip-10 · level: report of prone</title>")
    );
    assert!(chapter.html.contains("<h1>A chapter</h1>"));
    assert_eq!(
        (own.numbers.missing.len(), chapter.numbers.missing.len()),
        (0, 1)
    );
    assert_eq!(chapter.numbers.chapter_figures(), 1);
    for said in [
        "class=\"place\"",
        "Figure 31. ",
        "What is published of it.",
        "What was crawled.",
        "is the book",
        "obtained by eye",
    ] {
        assert!(chapter.html.contains(said), "{said}");
        assert!(!own.html.contains(said), "{said}");
    }
    let figure = "<figure id=\"fig-31-hip-10-angles\">";
    assert_eq!(own.html.matches(figure).count(), 1);
    for link in [
        "section-replay",
        "section-card",
        "section-run-1",
        "section-conditions",
    ] {
        for part in [format!("href=\"#{link}\""), format!("id=\"{link}\"")] {
            assert_eq!(own.html.matches(&part).count(), 1, "{part}");
        }
    }
    assert!(!chapter.html.contains("<nav"));
}

/// A publication of two figures, one of which a crawl has.
struct Chapter([Part; 1]);

impl Chapter {
    fn new() -> Self {
        let place = |number: &str| Place {
            number: number.to_owned(),
            shows: "angles".to_owned(),
            command: None,
            published: Some("What is published of it.".to_owned()),
        };
        Self([Part {
            title: "A section".to_owned(),
            lead: "What is in it.".to_owned(),
            places: vec![place("31"), place("32")],
        }])
    }
}

impl Publication for Chapter {
    fn title(&self) -> &'static str {
        "A chapter"
    }

    fn name(&self) -> Option<&str> {
        Some("the book")
    }

    fn crawled(&self) -> Option<&str> {
        Some("What was crawled.")
    }

    fn parts(&self) -> &[Part] {
        &self.0
    }

    fn joint_range(&self, _: &str) -> Option<PublishedRange> {
        Some(PublishedRange {
            angles: (-1.0, 1.0),
            obtained: "Band: obtained by eye.",
        })
    }
}

/// What the page says of a record is what the record says of its origin.
#[test]
fn a_record_of_a_robot_is_not_called_a_simulation() {
    let home = folder(made::driven);
    let report = report(home.path());
    assert_eq!(report.numbers.cards.len(), 1);
    let page = report.html.split("srcdoc=").next().unwrap();
    let after = report.html.rsplit("</iframe>").next().unwrap();
    assert!(page.contains("Not simulated: RUN (the robot nao.local)."));
    for said in [
        "RUN was not simulated: the robot nao.local.",
        "a crawl with hip-10. Source: the robot nao.local.",
    ] {
        assert!(after.contains(said), "{said}");
    }
    for wrong in [
        "No robot",
        "is the thesis",
        "by simulation",
        "ours, simulated",
        "symmetric model",
    ] {
        assert!(!page.contains(wrong) && !after.contains(wrong), "{wrong}");
    }
    for wrong in ["measured, ours", "Ours: simulation", "records that it made"] {
        assert!(!after.contains(wrong), "{wrong}");
    }
    // Of a simulation it says that, and nothing of a publication that it is not held against.
    let home = folder(made::whole);
    let simulated = self::report(home.path()).html;
    for said in [
        "Ours, by simulation in the contact regime locomotion (friction 0.7, ",
        "No robot took part.",
        "Ours: simulation, one value per 20 ms.",
    ] {
        assert!(simulated.contains(said), "{said}");
    }
    for published in ["is the thesis", "published robot"] {
        assert!(!simulated.contains(published), "{published}");
    }
}

/// The conditions of a search are read from its plan, wherever that has them.
#[test]
fn a_search_says_its_robot_solver_seed_and_budget() {
    let home = tempfile::tempdir().unwrap();
    let robot = json!({
        "name": "NAO H25 V4", "family": "nao", "version": "v4", "folder": "robots", "sha256": "0f",
    });
    let run = json!({
        "program": "prone", "version": env!("CARGO_PKG_VERSION"), "commit": "c", "engine": "e",
        "command": "optimize", "solver": "cma-es", "seed": 7, "runs": 1, "budget": 60,
        "pricing": {
            "aim": {
                "objective": "torque", "weights": null, "per": "phase", "duration_s": 3.0,
                "rate_deg_per_phase": null, "clearance": "none", "limits": "base",
                "body_share_of": null, "body_share_percent": null, "regime": "torque-study",
                "start": "settled",
            },
            "source": "statics", "from": "nominal", "mapping": "original", "arm": "fixed",
            "robot": robot,
        },
        "form": "cubic", "ends": "free", "name": "found", "confirm_durations_s": [1.0],
    });
    let line = json!({"form": "polynomial", "coefficients_rad": [0.1]});
    let result = json!({
        "gait": "found", "curves": {"knee": line, "hip": line, "upper_arm": line}, "cost": null,
        "torque": null, "violations": 0.5, "unit": "N²·m²·s", "seed": 7, "evaluations": 60,
        "complete": true, "compared": [], "verdicts": [], "broken": [], "variables": 12, "runs": [],
        "refused": [],
    });
    let points = ["toe", "ankle", "knee", "hip", "shoulder", "elbow"];
    let points = points
        .map(|point| format!(",{point}_x_mm,{point}_z_mm"))
        .concat();
    for (file, text) in [
        ("run.json", run.to_string()),
        ("result.json", result.to_string()),
        (
            "history.csv",
            "seed,generation,best_violation,best_torque,mean_violation,mean_torque,\
             mean_feasible_torque\n7,1,0.5,inf,0.6,,\n"
                .to_owned(),
        ),
        (
            "confirmation.csv",
            "regime,gait,duration_s,ratio\n".to_owned(),
        ),
        (
            "chains.csv",
            format!("gait,s,theta3_deg,theta4_deg,alpha_deg{points}\n"),
        ),
    ] {
        fs::write(home.path().join(file), text).unwrap();
    }
    let html = report(home.path()).html;
    for said in [
        "<dt>robot</dt><dd>NAO H25 V4</dd><dt>its family</dt><dd>nao</dd>",
        "<dt>solver</dt><dd>cma-es</dd><dt>seed</dt><dd>7</dd><dt>budget, evaluations</dt><dd>60</dd>",
        "Text without a source is about NAO H25 V4.",
        "60 evaluations: no cost, violations 0.5000.",
    ] {
        assert!(html.contains(said), "{said}");
    }
}

/// A publication whose results have records within them.
struct Study;

impl Publication for Study {
    fn title(&self) -> &'static str {
        "A study"
    }

    fn read(&self, folder: &Folder) -> Option<Result<Run, ReportError>> {
        let own = folder.head.command == "reproduce";
        own.then(|| Ok(Run::published(folder, Box::new(Self))))
    }
}

impl PublishedRun for Study {
    fn title(&self) -> &'static str {
        "A study"
    }

    fn results(&self) -> Markup {
        html! {}
    }

    fn tables_after(&self, _: &str) -> Markup {
        html! {}
    }

    fn sections(&self) -> Markup {
        html! {}
    }
}

#[test]
fn a_folder_is_taken_once_however_often_it_is_named() {
    let home = tempfile::tempdir().unwrap();
    let crawl = home.path().join("crawls/a");
    fs::create_dir_all(&crawl).unwrap();
    made::whole(&crawl);
    let version = env!("CARGO_PKG_VERSION");
    let run = format!(
        r#"{{"program": "prone", "version": "{version}", "commit": "c", "command": "reproduce"}}"#
    );
    fs::write(home.path().join("run.json"), run).unwrap();
    let source = |name: &str, folder: &Path| Source {
        name: name.to_owned(),
        folder: folder.to_owned(),
    };
    let folders = |sources: &[Source]| -> Vec<String> {
        let report = Report::from_folders(sources, &Study, Arrangement::Chapter).unwrap();
        assert_eq!(report.numbers.cards.len(), 1);
        let runs = report.numbers.runs.into_iter();
        runs.map(|run| run.folder).collect()
    };
    let study = source("STUDY", home.path());
    assert_eq!(
        folders(std::slice::from_ref(&study)),
        ["STUDY", "STUDY/crawls/a"]
    );
    // One that is named is called as it was named, wherever it stands among the names.
    let again = home.path().join("crawls/../crawls/a");
    let own = [source("A", &crawl), study, source("B", &again)];
    assert_eq!(folders(&own), ["A", "STUDY"]);
    let [a, study, b] = own;
    assert_eq!(folders(&[study, b, a]), ["STUDY", "B"]);
}

#[test]
fn a_whole_record_is_exported_with_its_robot() {
    let home = folder(made::whole);
    let record = Recorded::read(home.path()).unwrap();
    let joints = record.joints.len();
    assert_eq!(lines(table::csv(&record).unwrap()).len(), 1 + 3 * joints);
    assert!(numpy::archive(&record).unwrap().starts_with(b"PK"));
    let counts = messages(&ros_log::log(&record, None).unwrap().bytes);
    let topics: Vec<&str> = counts.keys().map(String::as_str).collect();
    let contact = format!("/contacts/{}/floor", record.bodies[1].name);
    assert_eq!(
        topics,
        [&contact, "/joint_commands", "/joint_states", "/tf"]
    );
    assert!(counts.values().all(|count| *count == 3), "{counts:?}");
    // Without the tables and without the engine.
    let info = RecordInfo::read(home.path()).unwrap();
    let compiled = compiled_robot(home.path(), &info).unwrap();
    let robot = compiled.robot();
    let model = RecordedModel::read(home.path()).unwrap();
    let text = urdf::from_record(robot, &model).unwrap();
    assert_eq!(text.matches("<link ").count(), robot.bodies.len());
    assert_eq!(text.matches("type=\"revolute\"").count(), joints);
    // A capsule is three solids that are drawn and collide, an ellipsoid is drawn, as spheres, a box
    // collides.
    assert_eq!(text.matches("<visual>").count(), 3 + 37);
    assert_eq!(text.matches("<collision>").count(), 4);
    let cycle = cycle_file::parse("hip-10.toml", &info.gait.text.unwrap()).unwrap();
    let scale = TimeScale::new(info.options.time_scale().unwrap()).unwrap();
    let checked = CheckedCycle::plan(robot, &robot.stops(), &cycle, 0.0, scale).unwrap();
    let frames = key_frames::from_cycle(&checked, key_frames::TICK).unwrap();
    let lags = Lags::of(robot, &record);
    assert!(
        key_frames::json(robot, &checked, &frames, &lags)
            .unwrap()
            .starts_with(b"{")
    );
    let behind = lags.sentence("the simulation").unwrap();
    let timeline = timeline::xar(robot, checked.name(), &frames, &lags, &behind);
    assert!(timeline.contains("LKneePitch") && timeline.contains(&behind));
    // As fast as the cycle itself, and no faster than a slower joint allows.
    frames.check_speeds(robot).unwrap();
    let mut slow = robot.clone();
    slow.joints[0].speed_limit = 0.0;
    let too_fast = frames.check_speeds(&slow).unwrap_err();
    assert_eq!(too_fast.joint, slow.joints[0].name);
}

/// Names that a robot's files would not pass, as records may hold them.
#[test]
fn a_urdf_has_one_name_for_each_link_and_joint() {
    let home = folder(made::whole);
    let info = RecordInfo::read(home.path()).unwrap();
    let compiled = compiled_robot(home.path(), &info).unwrap();
    let mut model = RecordedModel::read(home.path()).unwrap();
    let mut robot = compiled.into_robot();
    let text = urdf::from_record(&robot, &model).unwrap();
    assert!(text.contains("<mujoco><compiler fusestatic=\"false\"/></mujoco>"));
    assert_eq!(text.matches("<mimic ").count(), 1);
    assert!(urdf::shifted_link(&robot).is_none());
    // A body that is fixed and weighs nothing, and a hinge with the name that its joint would get.
    let last = robot.bodies.len() - 1;
    robot.bodies[last].joint = None;
    robot.bodies[last].mass = 0.0;
    robot.joints[0].name = format!("{}_fixed", robot.bodies[last].name);
    let text = urdf::from_record(&robot, &model).unwrap();
    let fixed = format!("<joint name=\"{}_\" type=\"fixed\">", robot.joints[0].name);
    assert_eq!(text.matches(&fixed).count(), 1, "{fixed}");
    // A link that does not say what it weighs is 1 kg to Bullet.
    assert_eq!(
        text.matches("<mass ").count(),
        text.matches("<link ").count()
    );
    robot.joints[1].name = robot.joints[2].name.clone();
    let said = urdf::from_record(&robot, &model).unwrap_err().to_string();
    assert!(
        said.contains("two joints of the robot are called"),
        "{said}"
    );
    for bodies in [0, 1] {
        robot.bodies[bodies].name = String::new();
        model.bodies[bodies].name = String::new();
    }
    let said = urdf::from_record(&robot, &model).unwrap_err().to_string();
    assert!(
        said.contains("one of the links of the robot has no name"),
        "{said}"
    );
}

#[test]
fn a_compiled_robot_of_other_files_is_refused() {
    let home = folder(made::whole);
    let mut info = RecordInfo::read(home.path()).unwrap();
    info.robot.sha256 = "0".repeat(64);
    let said = compiled_robot(home.path(), &info).unwrap_err().to_string();
    assert!(
        said.contains("robot.compiled.json: it was compiled from files with the hash"),
        "{said}"
    );
}

/// Missing channels, uneven times: all that there is is shown, and what is not is said.
#[test]
fn a_sparse_record_is_shown_and_reported_as_far_as_it_goes() {
    let home = folder(made::sparse);
    let run = view::record::read(home.path()).unwrap();
    assert_eq!((run.rows(), run.shortfalls()), (3, &[][..]));
    let gaps = run.gaps();
    let first = made::nao().robot().joints[0].name.clone();
    for said in [
        "the pose of the root was not recorded",
        &format!("the angle of {first} was not recorded"),
        "the command of the joints was not recorded",
        "contacts were not recorded",
        "the replay leaves the robot's root where it is, at the origin",
        "joints without an angle cannot be replayed: the page draws them at zero",
    ] {
        assert!(gaps.iter().any(|gap| gap == said), "{said}: {gaps:?}");
    }
    let page = view::page(&[&run]).unwrap();
    assert!(page.contains("the robot nao.local"));
    let report = report(home.path());
    assert_eq!(report.numbers.cards.len(), 0);
    assert_eq!(report.numbers.shortfalls, [""; 0]);
    let unrecorded = &report.numbers.unrecorded;
    assert!(
        unrecorded.contains(&"RUN/contacts were not recorded".to_owned()),
        "{unrecorded:?}"
    );
    for said in [
        "What was not recorded",
        "no summary.json: there is no report card",
        "NAOqi 2.1",
        "unknown",
    ] {
        assert!(report.html.contains(said), "{said}");
    }
}

#[test]
fn a_sparse_record_is_exported_as_far_as_it_goes() {
    let home = folder(made::sparse);
    let record = Recorded::read(home.path()).unwrap();
    let joints = record.joints.len();
    assert_eq!(joints, made::nao().robot().joints.len());
    let table = lines(table::csv(&record).unwrap());
    assert_eq!(table.len(), 1 + 3 * joints);
    // No command; 0.021 - 0.013 rad in as many seconds; a torque.
    let joint = &record.joints[0];
    assert_eq!(table[1], format!("0.0130,{joint},,0.013000,1.0000,0.50000"));
    let unseen = record.joints.last().unwrap();
    assert_eq!(table[joints], format!("0.0130,{unseen},,,,"));
    let archive = numpy::archive(&record).unwrap();
    assert!(
        archive
            .windows(8)
            .any(|bytes| bytes == f64::NAN.to_le_bytes())
    );
    let counts = messages(&ros_log::log(&record, None).unwrap().bytes);
    let expected = [("/joint_states".to_owned(), 3), ("/tf".to_owned(), 3)];
    assert_eq!(counts, BTreeMap::from(expected));
}
