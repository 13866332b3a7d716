//! A build is the same whatever happened on its way.

use std::borrow::Cow;
use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering};

use prone_files::shipped;
use prone_sim::{LoadedRobot, RobotFiles};

use super::*;
use crate::torque_map::NodeGrid;
use prone_record::program::Program;

const PROGRAM: Program = Program {
    version: Cow::Borrowed("0.0.0"),
    commit: Cow::Borrowed("test"),
};

/// Counts, and stops before a row.
struct Counting {
    taken_over: AtomicUsize,
    done: AtomicUsize,
    stop_after: usize,
}

impl Counting {
    fn until(stop_after: usize) -> Self {
        Self {
            taken_over: AtomicUsize::new(0),
            done: AtomicUsize::new(0),
            stop_after,
        }
    }
}

impl Watch for Counting {
    fn progress(&self, progress: &Progress<'_>) {
        match *progress {
            Progress::Measuring { taken_over, .. } => {
                self.taken_over.store(taken_over, Ordering::SeqCst);
            }
            Progress::Done(rows) => {
                self.done.fetch_add(rows, Ordering::SeqCst);
            }
            Progress::Simulating(_)
            | Progress::Drawing
            | Progress::Searching { .. }
            | Progress::Found(..) => {}
        }
    }

    fn stop(&self) -> bool {
        self.done.load(Ordering::SeqCst) >= self.stop_after
    }
}

fn nao() -> LoadedRobot {
    LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap()
}

/// θ3 and α at 10° steps, θ4 −30…180°: the chain does not close at the far end. 924 rows.
fn job(robot: &LoadedRobot) -> Job<'_> {
    let grid = NodeGrid::new(10.0, 180.0).unwrap();
    Job::new(robot, MapSource::Statics, grid, &PROGRAM).unwrap()
}

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.unwrap().install(work)
}

#[test]
fn identity_a_stopped_build_goes_on_and_its_bytes_are_the_same() {
    let home = tempfile::tempdir().unwrap();
    let out = home.path().join("map.csv");
    let path = Work::TorqueMap.beside(&out);
    let robot = nao();
    let job = job(&robot);
    let build = |threads, stop_after, opening| {
        let watch = Counting::until(stop_after);
        let built = on_threads(threads, || run(&job, Some((&out, opening)), &watch));
        (
            built,
            watch.taken_over.into_inner(),
            watch.done.into_inner(),
        )
    };
    let (whole, 0, 924) = build(1, usize::MAX, Opening::Resume) else {
        panic!("all rows are measured");
    };
    let whole = whole.unwrap();
    whole.journal.unwrap().remove().unwrap();

    let (stopped, 0, first) = build(2, 300, Opening::Resume) else {
        panic!("nothing is taken over");
    };
    let stopped = stopped.unwrap_err().to_string();
    assert_eq!(stopped, format!("stopped with {first} of 924 rows done"));
    // Cut off in the middle of a line, as by a kill.
    let journal = fs::read(&path).unwrap();
    fs::write(&path, &journal[..journal.len() - 5]).unwrap();
    let (resumed, taken, done) = build(2, usize::MAX, Opening::Resume);
    assert_eq!((taken, done), (first - 1, 924 - (first - 1)));
    let resumed = resumed.unwrap();
    assert_eq!(resumed.text, whole.text);
    assert_eq!(resumed.summary, whole.summary);
    drop(resumed);

    let (again, 924, 0) = build(1, 0, Opening::Resume) else {
        panic!("all rows are taken over");
    };
    assert_eq!(again.unwrap().text, whole.text);
    let (restarted, 0, 0) = build(1, 0, Opening::Restart) else {
        panic!("no row is taken over");
    };
    assert!(matches!(
        restarted,
        Err(BuildError::Stopped { kept: 0, .. })
    ));
    assert!(!path.exists(), "a journal without rows is removed");
}

#[test]
fn identity_a_built_map_is_read_with_its_masks_and_contacts() {
    let robot = nao();
    let job = job(&robot);
    let watch = Counting::until(usize::MAX);
    let built = run(&job, None, &watch).unwrap();
    let read = torque_map::parse_recorded(&built.text).unwrap();
    let Summary {
        source,
        rows,
        with_torques,
        open,
        failed,
    } = built.summary;
    assert_eq!((source, rows, with_torques + open), ("statics", 924, 924));
    assert!(open > 0 && failed == 0);
    assert_eq!(read.map().masked(Mask::Open), open);
    let weight = robot.robot().mass() * prone::statics::GRAVITY;
    for (row, contacts) in read.map().rows().iter().zip(read.contacts()) {
        assert_eq!(matches!(row, Row::Torques(_)), contacts.is_some());
        if let Some(contacts) = contacts {
            let carried: f64 = contacts.to_array().iter().sum();
            // Four numbers of ten decimals.
            assert!((carried - weight).abs() < 1e-9, "{carried} of {weight} N");
        }
    }
    let comments: Vec<_> = torque_map::comments(&built.text).collect();
    assert_eq!(comments[0], "torque map by prone 0.0.0, commit test");
    let columns = format!("columns: {}", torque_map::COLUMNS.join(","));
    assert_eq!(comments.last(), Some(&columns));
}

/// Both gauges against the sources that the map's documentation names.
#[test]
fn identity_rows_are_what_the_sources_say() {
    let home = tempfile::tempdir().unwrap();
    let robot = nao();
    // 2 × 2 × 2 corners.
    let grid = NodeGrid::new(10.0, -20.0).unwrap();
    let world = World::new(&robot, REGIME).unwrap();
    for source in [MapSource::Statics, MapSource::Simulation] {
        let job = Job::new(&robot, source, grid, &PROGRAM).unwrap();
        let watch = Counting::until(usize::MAX);
        let path = home.path().join("p");
        let built = run(&job, Some((&path, Opening::Restart)), &watch).unwrap();
        let read = torque_map::parse_recorded(&built.text).unwrap();
        for index in [0, 17, 83] {
            let at = grid.grid().node(index);
            let settled = SettledTorques::new(&world, job.mapping.clone());
            let stance = Stance::unsqueezed(SupportRule::AnyShape);
            let stops = robot.robot().study_stops();
            let statics =
                StaticTorques::new(robot.robot().as_ref(), job.mapping.clone(), &stops, stance)
                    .unwrap();
            let expected = match source {
                MapSource::Statics => torque_map::row_of(&statics, at),
                MapSource::Simulation => torque_map::row_of(&settled, at),
            };
            let (expected, found) = (expected.recorded(), read.map().rows()[index].recorded());
            let pairs = expected
                .unwrap()
                .to_array()
                .into_iter()
                .zip(found.unwrap().to_array());
            for (expected, found) in pairs {
                assert!(
                    (expected - found).abs() < 1e-9,
                    "{expected} is not {found} N·m"
                );
            }
        }
    }
}

#[test]
fn limit_a_robot_without_a_published_chain_is_refused() {
    let chain = "[chain.published]";
    let from = shipped::NAO.toml.find(chain).unwrap();
    let to = from + shipped::NAO.toml[from + 1..].find("\n[").unwrap() + 1;
    let mut files = RobotFiles::shipped(&shipped::NAO);
    files.toml = [&shipped::NAO.toml[..from], &shipped::NAO.toml[to..]].concat();
    let robot = LoadedRobot::load(files).unwrap();
    let grid = NodeGrid::new(10.0, 0.0).unwrap();
    let refused = Job::new(&robot, MapSource::Statics, grid, &PROGRAM).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "robot NAO H25 V4 has no published chain, which the mapping `original` needs"
    );
}
