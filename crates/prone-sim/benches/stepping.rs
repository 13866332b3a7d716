//! Simulated steps per second: our control step against a bare loop over the engine's step.
//!
//! Both advance the same model from the same settled position, one control step (20 engine steps) an
//! iteration. The ratio of the two medians is the figure that counts (goal: at least 0.95 of the
//! bare loop's speed); the absolute numbers belong to the machine.

use std::f64::consts::FRAC_PI_2;
use std::sync::OnceLock;

use prone::regime::CONTROL_STEP;
use prone::regime::Regime;
use prone_files::shipped;
use prone_sim::{LoadedRobot, Placement, RobotFiles, Simulation, World};

fn main() {
    divan::main();
}

fn world() -> &'static World {
    static WORLD: OnceLock<World> = OnceLock::new();
    WORLD.get_or_init(|| {
        let robot = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).expect("it ships");
        World::new(&robot, Regime::TORQUE_STUDY).expect("it compiles")
    })
}

/// The robot lying on its belly for two seconds.
fn settled() -> Simulation {
    let posture = world().robot().postures["recorded-start"].clone();
    let mut simulation = Simulation::new(
        world(),
        &Placement {
            posture,
            pitch: FRAC_PI_2,
        },
    );
    for _ in 0..40 {
        simulation.control_step().expect("a resting robot");
    }
    simulation
}

#[divan::bench(sample_count = 300, sample_size = 4)]
fn control_step(bencher: divan::Bencher) {
    let mut simulation = settled();
    bencher.bench_local(|| simulation.control_step().expect("a resting robot"));
}

#[divan::bench(sample_count = 300, sample_size = 4)]
fn reference_bare_engine_loop(bencher: divan::Bencher) {
    let mut data = world().at(&settled().snapshot());
    let steps = Regime::TORQUE_STUDY.steps_in(CONTROL_STEP);
    bencher.bench_local(|| {
        for _ in 0..steps {
            data.step();
        }
    });
}
