//! Costs by simulation, and what searches find, against published and recorded figures.
//!
//! The author's tables lie outside the repository: in the directory that `PRONE_REFERENCE_DIR`
//! names, or in `../shared/reference` beside it. Where they are absent the tests that need them say
//! so and pass; with `PRONE_REQUIRE_REFERENCE=1` they fail.

use std::borrow::Cow;
use std::ops::ControlFlow;
use std::path::PathBuf;

use prone::cost::objective::Objective;
use prone::cost::published::{END, PublishedRules, START};
use prone::gait::{Gait, PhaseDuration};
use prone::regime::Regime;
use prone::torque_map::{self, TorqueMap};
use prone_files::shipped;
use prone_optim::Threads;
use prone_record::search::{Search, SearchEnd, Solver};
use prone_sim::pull::{self, Keep, Start};
use prone_sim::{LoadedRobot, RobotFiles, World};
use prone_study::search::candidates::Depth;
use prone_study::search::chain_rules::{self, ChainRules, Clearance};
use prone_study::search::published::{self, PublishedProblem};
use prone_study::search::pull_cost::PullCosts;
use prone_study::search::pull_terms::{self, PullAim, PullTerms, Share, Source};
use prone_study::search::pull_trial;

fn nao() -> LoadedRobot {
    LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap()
}

fn gait(name: &str) -> Gait {
    shipped::gait(name).unwrap().unwrap()
}

fn seconds(seconds: f64) -> PhaseDuration {
    PhaseDuration::new(seconds).unwrap()
}

/// The set-up of a search by simulation: commands of at most 200° per pull, and no more of the
/// weight on the body than with the published optimum.
fn terms(world: &World, objective: Objective, duration: PhaseDuration) -> PullTerms {
    PullTerms {
        aim: PullAim::Graded(objective),
        source: Source::Dynamics,
        base: gait("nominal"),
        share: Share::Phase,
        rules: ChainRules {
            rate: 200_f64.to_radians(),
            clearance: Clearance::Free,
            stops: Some(chain_rules::widened_stops(world.robot(), &gait("nominal")).unwrap()),
        },
        duration,
        body_share: pull_terms::body_share(world, &gait("optimal"), duration).unwrap(),
        body_share_of: None,
    }
}

/// Torque part of a gait over the nominal one's, and the rules it breaks.
fn ratio(
    world: &World,
    name: &str,
    objective: Objective,
    duration: f64,
) -> (f64, Vec<Cow<'static, str>>) {
    let duration = seconds(duration);
    let costs = PullCosts::new(world, terms(world, objective, duration)).unwrap();
    let cost = |name| costs.cost(&gait(name), Depth::Everything);
    let (nominal, cost) = (cost("nominal").value, cost(name));
    let broken = cost.broken.into_iter().map(|broken| broken.rule);
    (cost.value / nominal, broken.collect())
}

/// A prototype of the same set-up, written independently, has .839 at 3 s and .857 at 5 s
/// with the masses of the V5. Two engines' releases and two programs may differ
/// by one percent.
#[test]
fn reference_the_published_optimum_over_nominal() {
    let loaded = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO_V5)).unwrap();
    let world = World::new(&loaded, Regime::TORQUE_STUDY).unwrap();
    for (duration, prototype) in [(3.0, 0.839), (5.0, 0.857)] {
        let (ratio, broken) = ratio(&world, "optimal", Objective::TORQUE, duration);
        assert!((ratio - prototype).abs() < 0.01, "{ratio} at {duration} s");
        // Its hip passes 200° per pull.
        assert_eq!(broken, ["rate"]);
    }
}

/// A search settles the robot once for all gaits that begin alike: to the same bits as each alone.
#[test]
fn a_pull_from_a_settled_clone_is_the_same_pull() {
    let loaded = nao();
    let world = World::new(&loaded, Regime::TORQUE_STUDY).unwrap();
    let (nominal, duration) = (gait("nominal"), seconds(0.5));
    let alone = pull::run(&world, &nominal, duration, Start::FirstPose, Keep::Rows).unwrap();
    let terms = terms(&world, Objective::TORQUE, duration);
    let norm = Objective::TORQUE.norm(world.robot()).unwrap();
    let costs = PullCosts::new(&world, terms).unwrap();
    let torque = |pull| pull_trial::torque_part(world.robot(), pull, &norm).unwrap();
    for _ in 0..2 {
        assert_eq!(costs.pull(&nominal).unwrap(), alone);
        let cost = costs.cost(&nominal, Depth::Everything);
        assert_eq!(cost.value.to_bits(), torque(&alone).to_bits());
    }
    // One that begins elsewhere is settled there.
    let mut lower = nominal.clone();
    lower.hip = prone::gait::Curve::constant(0.3).unwrap();
    let alone = pull::run(&world, &lower, duration, Start::FirstPose, Keep::Rows).unwrap();
    assert_eq!(costs.pull(&lower).unwrap(), alone);
}

#[test]
fn a_gait_that_breaks_the_rules_ranks_behind_one_that_does_not() {
    let loaded = nao();
    let world = World::new(&loaded, Regime::TORQUE_STUDY).unwrap();
    let duration = seconds(0.5);
    let mut terms = terms(&world, Objective::TORQUE, duration);
    terms.body_share = 0.999;
    let costs = PullCosts::new(&world, terms).unwrap();
    let kept = costs.cost(&gait("nominal"), Depth::UntilBroken);
    assert!(kept.violation == 0.0 && kept.broken.is_empty());
    let mut fast = gait("nominal");
    fast.knee = prone::gait::Curve::through(vec![(0.0, 0.288), (0.5, 1.4), (1.0, 0.288)]).unwrap();
    let fast = costs.cost(&fast, Depth::UntilBroken);
    assert!(fast.value.is_nan() && fast.violation > 1.0);
    assert!(kept.score().beats(&fast.score()));
}

/// `AnklePitch` at the start, whose stops differ by a tenth of a degree left and right, and `ElbowRoll`
/// at the end (docs/gait.md): those joints and no others may go as far in a search from it.
#[test]
fn stops_reach_to_where_the_base_gait_is_clamped() {
    let loaded = nao();
    let world = World::new(&loaded, Regime::TORQUE_STUDY).unwrap();
    let wide = chain_rules::widened_stops(world.robot(), &gait("nominal")).unwrap();
    let stops = world.robot().stops();
    let mut widened = Vec::new();
    for ((joint, stop), wide) in world.robot().joints.iter().zip(stops).zip(wide) {
        let (below, above) = (wide.lower - stop.lower, wide.upper - stop.upper);
        if below != 0.0 || above != 0.0 {
            widened.push((joint.name.as_str(), below.to_degrees(), above.to_degrees()));
        }
    }
    println!("{widened:?}");
    // By how much the lower and the upper stop move, degrees.
    let expected = [
        ("LAnklePitch", -3.85, 0.0),
        ("RAnklePitch", -4.03, 0.0),
        ("LElbowRoll", -1.5, 0.0),
        ("RElbowRoll", 0.0, 1.5),
    ];
    assert_eq!(widened.len(), expected.len());
    for ((joint, below, above), (known, lower, upper)) in widened.into_iter().zip(expected) {
        assert_eq!(joint, known);
        assert!((below - lower).abs() < 0.01, "{joint}: {below}");
        assert!((above - upper).abs() < 0.01, "{joint}: {above}");
    }
}

/// Gaits that ship, each with the ratios that its file states, and by the rules it was found by.
#[test]
fn regression_shipped_gaits_cost_what_their_files_say() {
    let loaded = nao();
    let world = World::new(&loaded, Regime::TORQUE_STUDY).unwrap();
    let weighted = Objective::Torque {
        weights: prone::cost::published::WEIGHTS,
    };
    for (name, objective, most) in [
        ("least-torque", Objective::TORQUE, 0.77),
        ("least-torque-clamped", Objective::TORQUE, 0.75),
        ("least-torque-spline", Objective::TORQUE, 0.71),
        ("least-weighted-torque", weighted, 0.75),
    ] {
        let (ratio, broken) = ratio(&world, name, objective, 3.0);
        assert!(ratio <= most, "{name} at 3 s: {ratio}");
        let clamped = name == "least-torque-clamped";
        let known: &[&str] = if clamped { &["limits"] } else { &[] };
        assert_eq!(broken, known, "{name}");
    }
    // Found at 3 s, they hold at another duration.
    for (name, most) in [("least-torque", 0.78), ("least-torque-clamped", 0.77)] {
        let (ratio, _) = ratio(&world, name, Objective::TORQUE, 5.0);
        println!("{name} at 5 s: {ratio:.4}");
        assert!(ratio <= most, "{name} at 5 s: {ratio}");
    }
}

fn recorded(file: &str) -> Option<TorqueMap> {
    let repository = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder = std::env::var_os("PRONE_REFERENCE_DIR")
        .map_or_else(|| repository.join("../shared/reference"), PathBuf::from);
    let path = folder.join(file);
    match std::fs::read_to_string(&path) {
        Ok(text) => Some(torque_map::parse(&text).unwrap()),
        Err(error) => {
            let required = std::env::var_os("PRONE_REQUIRE_REFERENCE").is_some_and(|v| v == "1");
            assert!(!required, "{}: {error}", path.display());
            eprintln!("skipped: {}: {error}", path.display());
            None
        }
    }
}

/// Best costs known before (`docs/decisions/0007-optimisers.md`): 32001.551 on the table of 5°,
/// 14001.552 on that of 2.5°, and 0.7003 with the hip rule at 13.7 mm and a tolerance of 1e-4 rad.
/// Three seeds of the twenty that were measured there, with the same 100,000 evaluations.
#[test]
fn reference_searches_of_the_published_problem_reach_the_best_known() {
    let lowered = PublishedRules {
        hip_threshold: 0.0137,
        limit_tolerance: 1e-4,
    };
    let loaded = nao();
    for (file, rules, known) in [
        ("torque-table-5deg.csv", PublishedRules::PUBLISHED, 32001.56),
        (
            "torque-table-2.5deg.csv",
            PublishedRules::PUBLISHED,
            14001.56,
        ),
        ("torque-table-2.5deg.csv", lowered, 0.7003 * 1.01),
    ] {
        let Some(map) = recorded(file) else {
            return;
        };
        let problem = PublishedProblem::new(loaded.robot(), &map, rules).unwrap();
        let objective = published::objective(loaded.robot(), &map, rules).unwrap();
        let mut search = Search::new(Solver::DifferentialEvolution, 1, 3, 100_000);
        let end = search.proceed(&Threads(&problem), |_| ControlFlow::Continue(()));
        assert_eq!(end, SearchEnd::Finished);
        for run in search.runs() {
            let best = run.best().unwrap();
            let coefficients = published::coefficients(&best.point).unwrap();
            let cost = objective.price(&coefficients).cost();
            println!("{file}, seed {}: {cost}", run.seed);
            assert!(cost <= known, "{file}, seed {}: {cost}", run.seed);
            let outside = coefficients.outside(published::BOUND);
            let curves = coefficients.0.iter().zip(START).zip(END);
            let mut misses =
                curves.map(|((cubic, start), end)| start + cubic.iter().sum::<f64>() - end);
            assert!(outside == 0.0 && misses.all(|miss| miss.abs() < 1e-9));
        }
    }
}

/// A published gait keeps its price through a gait file's curves: c0 does not count, cubics only.
#[test]
fn published_coefficients_survive_the_way_through_a_gait() {
    let point = [0.1, -0.2, 0.3, -0.4, 0.5, -0.6];
    let coefficients = published::coefficients(&point).unwrap();
    let gait = published::gait("found", &coefficients).unwrap();
    assert_eq!(published::coefficients_of(&gait), Some(coefficients));
    let mut spline = gait;
    spline.knee = prone::gait::Curve::b_spline(3, vec![0.1; 5]).unwrap();
    assert_eq!(published::coefficients_of(&spline), None);
}
