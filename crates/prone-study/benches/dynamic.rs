//! One evaluation of a search by simulation, on one core: a pull of 3 s.
//!
//! `looked_up` is the reference in the same run: the same gait priced by the statics.

use prone::cost::graded::Norm;
use prone::gait::{Curve, Gait, PhaseDuration};
use prone::mapping::Mapping;
use prone::regime::Regime;
use prone::statics::{Stance, StaticTorques, SupportRule};
use prone_files::shipped;
use prone_sim::{LoadedRobot, RobotFiles, World};
use prone_study::optimize::dynamic::{DynamicPricing, DynamicSetup};
use prone_study::optimize::pricing::{Pricing, Share};
use prone_study::optimize::rules::{ChainRules, Clearance};
use prone_study::optimize::static_pricing::StaticPricing;

const NORM: Norm = Norm::SquaredTorque { weights: [1.0; 4] };
const RULES: ChainRules = ChainRules {
    rate: f64::INFINITY,
    clearance: Clearance::Free,
    stops: None,
};

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

fn duration() -> PhaseDuration {
    PhaseDuration::new(3.0).expect("a phase")
}

fn setup() -> DynamicSetup {
    DynamicSetup {
        norm: NORM,
        share: Share::Phase,
        rules: RULES,
        duration: duration(),
        body_share: 1.0,
    }
}

/// A gait that begins where all of a search do: settled once for all.
#[divan::bench(sample_count = 20)]
fn simulated(bencher: divan::Bencher) {
    let world = world();
    let pricing = DynamicPricing::new(&world, &nominal(), setup()).expect("maps");
    let gait = nominal();
    bencher.bench_local(|| pricing.price(divan::black_box(&gait)));
}

/// A gait that begins elsewhere, as with free ends: settled for itself.
#[divan::bench(sample_count = 20)]
fn simulated_from_elsewhere(bencher: divan::Bencher) {
    let world = world();
    let pricing = DynamicPricing::new(&world, &nominal(), setup()).expect("maps");
    let gait = Gait {
        hip: Curve::constant(0.35).expect("finite"),
        ..nominal()
    };
    bencher.bench_local(|| pricing.price(divan::black_box(&gait)));
}

#[divan::bench]
fn looked_up(bencher: divan::Bencher) {
    let world = world();
    let gait = nominal();
    let mapping = Mapping::new(world.robot(), gait.mapping, gait.arm).expect("maps");
    let stance = Stance::unsqueezed(SupportRule::ElbowNotHand);
    let statics =
        StaticTorques::new(world.robot(), mapping, world.stops(), stance).expect("mirrored");
    let pricing = StaticPricing::new(
        world.robot(),
        &gait,
        statics,
        NORM,
        Share::Phase,
        RULES,
        duration(),
    )
    .expect("maps");
    bencher.bench_local(|| pricing.price(divan::black_box(&gait)));
}
