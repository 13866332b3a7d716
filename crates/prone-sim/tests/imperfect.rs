//! A robot that is not as its model says: other masses, play in its gears, commands that are late.

use prone::crawl::Straight;
use prone::gait::cycle::TimeScale;
use prone::regime::{MotorServo, Regime};
use prone::robot::{JointAngles, JointId};
use prone_files::shipped;
use prone_sim::crawl::{self, Crawl, CrawlPlan, Detail, End};
use prone_sim::driven::LateCommands;
use prone_sim::{LoadedRobot, Placement, RobotFiles, Simulation, World, WorldServo};
use rayon::prelude::*;

/// Play of the gears, rad: 1°.
const PLAY: f64 = std::f64::consts::PI / 180.0;

fn nao() -> LoadedRobot {
    LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap()
}

fn with_play(backlash: f64) -> Regime {
    Regime::LOCOMOTION.with_motors(MotorServo {
        backlash,
        ..MotorServo::ROBOT
    })
}

fn with_masses(mass_factor: f64) -> Regime {
    Regime {
        mass_factor,
        ..Regime::LOCOMOTION
    }
}

/// The robot on its back, after it was told for some seconds to hold its shoulders at an angle, rad.
fn on_its_back(regime: Regime, shoulder: f64) -> Simulation {
    let loaded = nao();
    let world = World::new(&loaded, regime).unwrap();
    let robot = loaded.robot();
    let mut posture = JointAngles::zero(robot);
    for side in robot.chain.sides() {
        posture[side.shoulder] = shoulder;
    }
    let placement = Placement {
        posture: posture.clone(),
        pitch: -std::f64::consts::FRAC_PI_2,
    };
    let mut simulation = Simulation::new(&world, &placement);
    simulation.command(&posture);
    for _ in 0..2400 {
        simulation.step();
    }
    simulation
}

fn left_shoulder(simulation: &Simulation) -> JointId {
    simulation.robot().chain.left.shoulder
}

/// An arm that nothing else carries sinks by half the play, beyond what its servo gives way by under
/// the same torque.
#[test]
fn identity_an_arm_sinks_by_half_the_play_and_what_its_servo_gives_way() {
    for play in [0.0, PLAY, 3.0 * PLAY] {
        let told = 0.9;
        let simulation = on_its_back(with_play(play), told);
        let shoulder = left_shoulder(&simulation);
        let drives = simulation.world().drives();
        let drive = drives.iter().find(|it| it.drive.joints == [shoulder]);
        let WorldServo::Motor(motor) = drive.unwrap().servo else {
            panic!("the regime has motors");
        };
        let torque = simulation.applied_torque()[shoulder.0];
        assert!(torque.abs() > 0.1, "{torque} N·m carry the arm");
        let sunk = told - simulation.joint_angles()[shoulder];
        let expected = torque / motor.stiffness + torque.signum() * play / 2.0;
        // Settled: the arm still moves by less than this.
        assert!(
            (sunk - expected).abs() < 1e-5,
            "play of {play} rad: {sunk}, not {expected} rad"
        );
    }
}

/// A wrist that nothing turns rests where it is within half the play, and no torque holds it there;
/// outside, it is taken back to the edge of the play.
#[test]
fn a_joint_without_load_rests_within_half_the_play() {
    let wrist = |play, begin: f64| {
        let loaded = nao();
        let world = World::new(&loaded, with_play(play)).unwrap();
        let wrist = loaded.robot().joint("LWristYaw").unwrap();
        let told = JointAngles::zero(loaded.robot());
        let mut posture = told.clone();
        posture[wrist] = begin;
        let placement = Placement {
            posture,
            pitch: -std::f64::consts::FRAC_PI_2,
        };
        let mut simulation = Simulation::new(&world, &placement);
        simulation.command(&told);
        for _ in 0..1200 {
            simulation.step();
        }
        let angle = simulation.joint_angles()[wrist];
        (angle, simulation.applied_torque()[wrist.0])
    };
    let (within, torque) = wrist(PLAY, 0.4 * PLAY);
    assert!(within > 0.3 * PLAY && within < 0.5 * PLAY, "{within} rad");
    assert!(torque.abs() < 1e-4, "{torque} N·m");
    let (back, _) = wrist(PLAY, 3.0 * PLAY);
    assert!(back.abs() < 0.51 * PLAY, "{back} rad");
    let (tight, _) = wrist(0.0, 0.4 * PLAY);
    assert!(tight.abs() < 0.02 * PLAY, "{tight} rad");
}

/// Masses and moments of inertia are multiplied; armature, and the robot that is planned with, are not.
#[test]
fn identity_masses_are_multiplied() {
    let loaded = nao();
    let plain = World::new(&loaded, Regime::LOCOMOTION).unwrap();
    for factor in [0.9, 1.1] {
        let world = World::new(&loaded, with_masses(factor)).unwrap();
        assert_eq!(world.robot(), plain.robot());
        assert!((world.mass() / plain.mass() - factor).abs() < 1e-12);
        let at = Snapshots::new(&world, &plain);
        assert!((at.weight[0] / at.weight[1] - factor).abs() < 1e-9);
        // Kinetic energy of the same speed, which armature has no part in, of the whole robot.
        assert!((at.kinetic[0] / at.kinetic[1] - factor).abs() < 1e-9);
    }
}

/// Potential energy per height, N, and kinetic energy of a turn, J, of two worlds.
struct Snapshots {
    weight: [f64; 2],
    kinetic: [f64; 2],
}

impl Snapshots {
    fn new(one: &World, other: &World) -> Self {
        let both = [one, other].map(|world| {
            let placement = Placement {
                posture: JointAngles::zero(world.robot()),
                pitch: 0.0,
            };
            let simulation = Simulation::new(world, &placement);
            let mut data = world.at(&simulation.snapshot());
            data.energy_pos();
            let low = data.energy()[0];
            data.qpos_mut()[2] += 1.0;
            data.forward();
            data.energy_pos();
            let weight = data.energy()[0] - low;
            data.qvel_mut()[3..6].copy_from_slice(&[0.3, 0.5, 0.7]);
            data.forward();
            data.energy_vel();
            (weight, data.energy()[1])
        });
        Self {
            weight: both.map(|it| it.0),
            kinetic: both.map(|it| it.1),
        }
    }
}

fn crawl(regime: Regime, late: Option<LateCommands>) -> Crawl {
    let world = World::new(&nao(), regime).unwrap();
    let plan = CrawlPlan {
        cycles: vec![shipped::cycle("thesis-nominal").unwrap().unwrap()],
        scale: TimeScale::ONE,
        end: End::Cycles(2),
        offsets: None,
        late,
        imu_seed: None,
        detail: Detail::Rows,
    };
    crawl::run(&world, &plan, Straight::default()).unwrap()
}

/// Every command that reaches the servos was given before, in the order in which they arrive: up to
/// the bound and the robot's own 10 ms between two commands, of which each second one is taken.
#[test]
fn identity_late_commands_are_those_that_were_given_and_late_by_no_more_than_the_bound() {
    const OWN: f64 = 0.01;
    let late = LateCommands {
        every: 0.02,
        at_most: 0.02,
        seed: 3,
    };
    let (prompt, tardy) = (
        crawl(Regime::LOCOMOTION, None),
        crawl(Regime::LOCOMOTION, Some(late)),
    );
    let mut from = 0;
    let mut delays = Vec::new();
    // The first one is the extension, in which it was told to rest before the crawl began.
    for (arrived, posture) in tardy.commands.iter().skip(1) {
        let given = prompt.commands[from..]
            .iter()
            .position(|(_, it)| it == posture);
        let given = from + given.expect("it was given, and after the one before");
        from = given;
        delays.push(arrived - prompt.commands[given].0);
    }
    assert!(delays.len() > prompt.commands.len() / 3);
    let (least, most) = delays.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), it| {
        (a.min(*it), b.max(*it))
    });
    assert!(least > -1e-9 && least < 0.003, "{least} s");
    assert!(most > 0.017 && most < 0.02 + OWN + 1e-9, "{most} s");
}

/// The same seed gives the same crawl on any number of threads, and what is wrong with a robot
/// changes it.
#[test]
fn imperfect_robots_crawl_the_same_on_any_number_of_threads() {
    let late = LateCommands {
        every: 0.02,
        at_most: 0.02,
        seed: 1,
    };
    let cases = [
        (Regime::LOCOMOTION, None),
        (Regime::LOCOMOTION, Some(late)),
        (Regime::LOCOMOTION, Some(LateCommands { seed: 2, ..late })),
        (with_play(PLAY), None),
        (with_masses(1.1), None),
    ];
    let alone = cases.map(|(regime, late)| crawl(regime, late));
    let together: Vec<Crawl> = cases.par_iter().map(|(r, late)| crawl(*r, *late)).collect();
    assert!(alone.iter().eq(&together));
    for (index, one) in alone.iter().enumerate() {
        for other in &alone[..index] {
            assert_ne!(one.cycles, other.cycles);
        }
    }
}
