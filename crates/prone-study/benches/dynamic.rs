//! One evaluation of a search by simulation, on one core: a pull of 3 s.
//!
//! `looked_up` is the reference in the same run: the same gait by the statics.

use prone::cost::objective::Objective;
use prone::gait::{Curve, Gait, PhaseDuration};
use prone::regime::Regime;
use prone_files::shipped;
use prone_sim::{LoadedRobot, RobotFiles, World};
use prone_study::search::candidates::Depth;
use prone_study::search::chain_rules::ChainRules;
use prone_study::search::pull_cost::PullCosts;
use prone_study::search::pull_terms::{PullAim, PullTerms, Share, Source};

fn main() {
    divan::main();
}

fn world() -> World {
    let robot = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).expect("ships");
    World::new(&robot, Regime::TORQUE_STUDY).expect("compiles")
}

fn nominal() -> Gait {
    shipped::gait("nominal").expect("ships").expect("parses")
}

fn costs(world: &World, source: Source) -> PullCosts {
    let terms = PullTerms {
        aim: PullAim::Graded(Objective::TORQUE),
        source,
        base: nominal(),
        share: Share::Phase,
        rules: ChainRules::FREE,
        duration: PhaseDuration::new(3.0).expect("a phase"),
        body_share: 1.0,
        body_share_of: None,
    };
    PullCosts::new(world, terms).expect("maps")
}

fn bench(bencher: divan::Bencher, source: Source, gait: &Gait) {
    let costs = costs(&world(), source);
    bencher.bench_local(|| costs.cost(divan::black_box(gait), Depth::UntilBroken));
}

/// A gait that begins where all of a search do: settled once for all.
#[divan::bench(sample_count = 20)]
fn simulated(bencher: divan::Bencher) {
    bench(bencher, Source::Dynamics, &nominal());
}

/// A gait that begins elsewhere, as with free ends: settled for itself.
#[divan::bench(sample_count = 20)]
fn simulated_from_elsewhere(bencher: divan::Bencher) {
    let gait = Gait {
        hip: Curve::constant(0.35).expect("finite"),
        ..nominal()
    };
    bench(bencher, Source::Dynamics, &gait);
}

#[divan::bench]
fn looked_up(bencher: divan::Bencher) {
    bench(bencher, Source::Statics, &nominal());
}
