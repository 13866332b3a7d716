//! Tests of what is listed, and of the figures beside it.

use std::fs;
use std::sync::atomic::{AtomicBool, Ordering};

use super::*;
use crate::watch::Unwatched;

fn nao() -> RobotFiles {
    RobotFiles::shipped(shipped::default_robot().unwrap())
}

/// The NAO without its family, with two cycles of its own: one as it ships under another name, one
/// that names a joint which no robot has.
fn with_own_gaits() -> (tempfile::TempDir, RobotFiles) {
    let home = tempfile::tempdir().unwrap();
    let robot = shipped::default_robot().unwrap();
    let toml = robot.toml.replacen("family = \"nao\"\n", "", 1);
    fs::write(home.path().join("robot.toml"), toml).unwrap();
    fs::write(home.path().join("robot.xml"), robot.mjcf).unwrap();
    let gaits = home.path().join("gaits");
    fs::create_dir(&gaits).unwrap();
    let low = shipped::gait_file("low-175").unwrap().text;
    fs::write(gaits.join("mine.toml"), low.as_bytes()).unwrap();
    let wrong = low.replace("LHipPitch", "LHipPich");
    fs::write(gaits.join("wrong.toml"), wrong).unwrap();
    let files = RobotFiles::read(home.path()).unwrap();
    (home, files)
}

fn named<'l>(listed: &'l [Listed], name: &str) -> &'l Listed {
    listed.iter().find(|it| it.name == name).unwrap()
}

#[test]
fn all_that_ships_is_listed_once() {
    let listed = list(&nao(), None).unwrap();
    let names = |kind: ListedKind| -> Vec<&str> {
        let of_kind = listed.iter().filter(|it| it.kind == kind);
        of_kind.map(|it| it.name.as_str()).collect()
    };
    let shipped_pulls: Vec<&str> = shipped::gait_names().collect();
    assert_eq!(names(ListedKind::Gait), shipped_pulls);
    let shipped_cycles: Vec<&str> = shipped::cycle_names().collect();
    assert_eq!(names(ListedKind::Cycle), shipped_cycles);
    let shipped_scenes: Vec<&str> = shipped::scene_names().collect();
    assert_eq!(names(ListedKind::Scene), shipped_scenes);
    let shipped_robots: Vec<String> = shipped::robot_names().collect();
    assert_eq!(names(ListedKind::Robot), shipped_robots);
    for it in &listed {
        assert!(!it.description.is_empty(), "{}", it.name);
        assert_eq!((it.origin, &it.refused), (Origin::Shipped, &None), "{it:?}");
        assert_eq!(it.cycle.is_some(), it.kind == ListedKind::Cycle, "{it:?}");
    }
}

/// A name's figures are those of a crawl by the same name, and no others.
#[test]
fn identity_figures_are_those_of_a_crawl() {
    let (_home, robot) = with_own_gaits();
    let mut listed = list(&robot, Some("here")).unwrap();
    listed.retain(|it| ["mine", "wrong", "gentle", "here"].contains(&it.name.as_str()));
    let session = Session::default();
    measure(&mut listed, &robot, &session, &Unwatched).unwrap();
    let mine = named(&listed, "mine");
    assert_eq!(mine.origin, Origin::Own);
    let text = robot.gaits.find("mine").unwrap().unwrap();
    let experiment = CrawlExperiment {
        ending: Ending::Cycles(CYCLES),
        ..CrawlExperiment::new(
            RobotText::from_files(&robot),
            TextFile::new(&text.file, &text.text),
        )
    };
    let crawled = session.run(&Experiment::Crawl(Box::new(experiment)), &Unwatched);
    let Outcome::Crawl(crawled) = crawled.unwrap() else {
        panic!("a crawl gives a crawl");
    };
    let summary = &crawled.summary;
    let figures = mine.figures.as_ref().unwrap();
    assert_eq!(figures.mm_per_s.to_bits(), summary.mm_per_s.to_bits());
    assert_eq!(figures.heat_per_metre_s, summary.heat_per_metre_s);
    assert_eq!(figures.verdict, summary.verdict.duty);
    let tops = summary.top_mm;
    for top in [tops.head, tops.trunk, tops.arms, tops.legs, tops.feet] {
        assert!(top <= figures.height_mm, "{tops:?}");
    }
    let wrong = named(&listed, "wrong");
    assert_eq!(wrong.figures, None);
    let refused = wrong.refused.as_ref().unwrap();
    assert!(
        refused.ends_with("no joint LHipPich; did you mean \"LHipPitch\"?"),
        "{refused}"
    );
    let cycles = listed.iter().filter(|it| it.kind == ListedKind::Cycle);
    let cycles: Vec<&Listed> = cycles.collect();
    assert_eq!(cycles.last().unwrap().name, "wrong");
    let heights = cycles.iter().filter_map(|it| it.figures.as_ref());
    assert!(heights.map(|it| it.height_mm).is_sorted());
    assert_eq!(named(&listed, "here").origin, Origin::Own);
}

#[test]
fn limit_a_file_that_is_no_gait_is_listed_with_what_is_wrong() {
    let (home, robot) = with_own_gaits();
    fs::write(home.path().join("gaits/broken.toml"), "name =").unwrap();
    let listed = list(&robot, None).unwrap();
    let refused = named(&listed, "broken").refused.as_ref().unwrap();
    assert!(refused.contains("broken.toml:1:"), "{refused}");
}

#[test]
fn a_list_is_stopped_before_all_is_crawled() {
    struct AfterTheFirst(AtomicBool);
    impl Watch for AfterTheFirst {
        fn stop(&self) -> bool {
            self.0.load(Ordering::Relaxed)
        }
        fn progress(&self, progress: &Progress<'_>) {
            let done = matches!(progress, Progress::Done(_));
            self.0.fetch_or(done, Ordering::Relaxed);
        }
    }
    let mut listed = list(&nao(), None).unwrap();
    let session = Session {
        threads: Some(1),
        ..Session::default()
    };
    let watch = AfterTheFirst(AtomicBool::new(false));
    let stopped = measure(&mut listed, &nao(), &session, &watch);
    assert!(matches!(
        stopped,
        Err(CatalogueError::Run(RunError::Stopped))
    ));
    assert_eq!(listed.iter().filter(|it| it.figures.is_some()).count(), 1);
}
