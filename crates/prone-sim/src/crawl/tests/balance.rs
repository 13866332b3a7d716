//! Physics that a crawl has to keep whatever it does: energy, momentum, and the engine's step.

use glam::DVec3;
use rayon::prelude::*;

use prone::crawl::{Crawler, Event, Halt, Straight, Watch, drive};
use prone::gait::PhaseDuration;
use prone::regime::{CONTROL_STEP, MotorServo, Regime};
use prone::robot::ContactGroup;
use prone::statics::GRAVITY;
use prone_files::shipped;

use super::super::*;
use crate::engine_numbers::FREE_JOINT_SPEEDS;
use crate::{LoadedRobot, RobotFiles, World, WorldDrive, WorldServo, pull};

/// What motors and constraints did over the last cycle, and what the body had before and after it.
#[derive(Debug, Clone, Default)]
struct Audit {
    /// Speeds after the last step.
    before: Vec<f64>,
    /// Centre of mass after the last two steps, m.
    centre: [DVec3; 2],
    /// When the cycle began: energy, J, and velocity of the centre of mass, m/s.
    began: Option<(f64, DVec3)>,
    /// Work of the motors, and of contacts, stops and couplings, J.
    motors: f64,
    constraints: f64,
    /// What of the motors' work was positive, J.
    positive: f64,
    /// Impulse of the world on the robot, N·s, and how long it lasted, s.
    impulse: DVec3,
    seconds: f64,
    /// After the cycle: energy left over, J; force left over, N.
    left: Option<(f64, DVec3)>,
}

impl Audit {
    fn velocity(&self, simulation: &Simulation) -> DVec3 {
        (self.centre[1] - self.centre[0]) / simulation.time_step()
    }

    /// After each engine step.
    fn step(&mut self, simulation: &Simulation) {
        let after = simulation.data.qvel().to_vec();
        let dt = simulation.time_step();
        self.centre = [
            self.centre[1],
            simulation
                .world()
                .centre_of_mass(&simulation.snapshot())
                .metres(),
        ];
        if self.began.is_some() {
            // What the engine's constraints did over the step, at the speed in its middle.
            let forces = simulation.data.qfrc_constraint().iter();
            let speeds = self.before.iter().zip(&after);
            let power = forces
                .zip(speeds)
                .map(|(f, (a, b))| f * f64::midpoint(*a, *b));
            self.constraints += power.sum::<f64>() * dt;
            // What joints are damped by besides their motors acts at the speed after the step.
            let own = own_damping(simulation.world());
            let speeds = self.before.iter().zip(&after).skip(FREE_JOINT_SPEEDS);
            let lost = own.iter().zip(speeds);
            let lost = lost.map(|(d, (a, b))| d * b * f64::midpoint(*a, *b));
            self.constraints -= lost.sum::<f64>() * dt;
            for motor in simulation.motor_steps() {
                self.motors += motor.power * dt;
                self.positive += motor.power.max(0.0) * dt;
            }
            for contact in simulation.contact_forces() {
                self.impulse += contact.force * dt;
            }
            self.seconds += dt;
        }
        self.before = after;
    }

    fn begin(&mut self, simulation: &Simulation) {
        *self = Self {
            began: Some((energy(simulation), self.velocity(simulation))),
            before: std::mem::take(&mut self.before),
            centre: self.centre,
            ..Self::default()
        };
    }

    fn end(&mut self, simulation: &Simulation) {
        let Some((energy_before, velocity_before)) = self.began.take() else {
            return;
        };
        let gained = energy(simulation) - energy_before;
        let mass = simulation.world().mass();
        let momentum = mass * (self.velocity(simulation) - velocity_before) / self.seconds;
        let weight = DVec3::new(0.0, 0.0, mass * GRAVITY);
        let force = self.impulse / self.seconds;
        self.left = Some((
            gained - self.motors - self.constraints,
            force - weight - momentum,
        ));
    }
}

/// Damping of the joints by the model itself, N·m·s/rad.
fn own_damping(world: &World) -> Vec<f64> {
    let mut damping = world.engine_options().joint_damping;
    for WorldDrive { drive, servo } in world.drives() {
        if let WorldServo::Motor(motor) = servo {
            for joint in &drive.joints {
                damping[joint.0] -= motor.back_emf / drive.sharers();
            }
        }
    }
    damping
}

/// Kinetic and potential energy, J. The engine works it out in data of its own, as looking must not
/// change what is looked at.
fn energy(simulation: &Simulation) -> f64 {
    let mut data = simulation.data.clone();
    data.forward();
    data.energy_pos();
    data.energy_vel();
    data.energy().iter().sum()
}

impl Watch<SimulatedRobot, Straight> for Audit {
    fn before(
        &mut self,
        _: &SimulatedRobot,
        _: &Crawler<Straight>,
        _: &prone::port::Senses,
    ) -> Option<Halt> {
        None
    }

    fn ticked(
        &mut self,
        robot: &SimulatedRobot,
        crawler: &Crawler<Straight>,
        _: &prone::port::JointCommand,
    ) {
        for event in crawler.events() {
            match event {
                // The first cycle begins at rest: the second one is looked at.
                Event::CycleBegan => self.begin(robot.simulation()),
                Event::CycleEnded => self.end(robot.simulation()),
                Event::PhaseEnded(_) | Event::Ended(_) => {}
            }
        }
    }

    fn waited(&mut self, robot: &SimulatedRobot, _: &Crawler<Straight>) {
        self.step(robot.simulation());
    }
}

fn nao() -> LoadedRobot {
    LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap()
}

fn plan(gait: &str, cycles: usize) -> CrawlPlan {
    CrawlPlan {
        cycles: vec![shipped::cycle(gait).unwrap().unwrap()],
        scale: TimeScale::ONE,
        end: End::Cycles(cycles),
        offsets: None,
        late: None,
        imu_seed: None,
        on_touch: OnTouch::GoOn,
        detail: Detail::Rows,
    }
}

/// The robot's own motors behind gears with 1° of play.
const LOOSE: MotorServo = MotorServo {
    backlash: 0.0175,
    ..MotorServo::ROBOT
};

/// The second cycle of a crawl, audited.
fn audited(world: &World, gait: &str) -> Audit {
    let plan = plan(gait, 2);
    let begin = Begin::InExtension { rest: 0.0 };
    let mut crawler = crawler(world, &plan, begin, Straight { turn: 0.0 }).unwrap();
    let mut robot = lie_down(world, &plan, &crawler).unwrap();
    let mut audit = Audit::default();
    drive(&mut robot, &mut crawler, &mut audit).unwrap();
    audit
}

/// Energy that comes from motors and constraints is there afterwards, and the world's forces are
/// weight and change of momentum: in every regime that crawls.
#[test]
fn identity_energy_closes_and_forces_balance_over_a_cycle() {
    let robot = nao();
    let steps = [0.0025, 0.001];
    let servos = [
        MotorServo::SOFT,
        MotorServo::ROBOT,
        MotorServo::STIFF,
        LOOSE,
    ];
    let gaits = ["thesis-nominal", "thesis-optimal", "hip-10", "low-150"];
    let mut cases = Vec::new();
    for time_step in steps {
        for servo in servos {
            cases.extend(gaits.map(|gait| (time_step, servo, gait)));
        }
    }
    cases.into_par_iter().for_each(|(time_step, servo, gait)| {
        let regime = Regime {
            time_step,
            ..Regime::LOCOMOTION.with_motors(servo)
        };
        let world = World::new(&robot, regime).unwrap();
        let audit = audited(&world, gait);
        let case = format!(
            "{gait}, {} × K, {} rad of play, {} ms",
            servo.stiffness_factor,
            servo.backlash,
            time_step * 1e3
        );
        let (energy, force) = audit.left.unwrap();
        let share = energy / audit.positive;
        assert!(audit.positive > 3.0, "{case}: {audit:?}");
        assert!(
            share.abs() < 0.005,
            "{case}: {share:.5} of the work is lost"
        );
        // Torques that were reported and not applied would leave a tenth of the work over.
        let weight = robot.robot().mass() * GRAVITY;
        assert!(
            force.abs().max_element() < 0.01 * weight,
            "{case}: {force} N are left over"
        );
    });
}

/// A robot that is heavier or lighter than its model says, too: its weight is that of the world.
#[test]
fn identity_energy_closes_and_forces_balance_with_other_masses() {
    for mass_factor in [0.9, 1.1] {
        let regime = Regime {
            mass_factor,
            ..Regime::LOCOMOTION.with_motors(LOOSE)
        };
        let world = World::new(&nao(), regime).unwrap();
        let audit = audited(&world, "thesis-nominal");
        let (energy, force) = audit.left.unwrap();
        let share = energy / audit.positive;
        assert!(share.abs() < 0.005, "× {mass_factor}: {share:.5}");
        let weight = world.mass() * GRAVITY;
        assert!(
            force.abs().max_element() < 0.01 * weight,
            "× {mass_factor}: {force} N are left over"
        );
    }
}

/// A model may damp its joints itself. That is not the motor's torque: energy closes where it is
/// counted apart, and the motors do more.
#[test]
fn identity_a_models_own_damping_is_not_the_motors() {
    let mut files = RobotFiles::shipped(&shipped::NAO);
    let joint = r#"<joint armature=".005"/>"#;
    assert!(files.mjcf.contains(joint));
    files.mjcf = files
        .mjcf
        .replacen(joint, r#"<joint armature=".005" damping=".3"/>"#, 1);
    let damped = LoadedRobot::load(files).unwrap();
    let [damped, free] = [damped, nao()].map(|robot| {
        let world = World::new(&robot, Regime::LOCOMOTION).unwrap();
        audited(&world, "thesis-nominal")
    });
    let (energy, _) = damped.left.unwrap();
    let share = energy / damped.positive;
    assert!(share.abs() < 0.005, "{share:.5} of the work is lost");
    assert!(damped.positive > 1.05 * free.positive);
}

/// The servos of the study, too, over a pull of the published gait.
#[test]
fn identity_energy_closes_and_forces_balance_over_a_pull() {
    let robot = nao();
    let gait = shipped::gait("nominal").unwrap().unwrap();
    let duration = PhaseDuration::new(3.0).unwrap();
    for regime in [Regime::TORQUE_STUDY, Regime::TABLE] {
        let world = World::new(&robot, regime).unwrap();
        let trajectory = pull::plan(&world, &gait, duration).unwrap();
        let placement = pull::placement(&world, &trajectory, pull::Start::Recorded).unwrap();
        let mut simulation = pull::settle(&world, &placement).unwrap();
        let mut audit = Audit::default();
        audit.step(&simulation);
        audit.step(&simulation);
        audit.begin(&simulation);
        for sample in trajectory.samples() {
            simulation.command(&sample.joints);
            for _ in 0..regime.steps_in(CONTROL_STEP) {
                simulation.step();
                audit.step(&simulation);
            }
        }
        audit.end(&simulation);
        let (energy, force) = audit.left.unwrap();
        let share = energy / audit.positive;
        assert!(share.abs() < 0.005, "{}: {share:.5}", regime.name);
        let weight = robot.robot().mass() * GRAVITY;
        assert!(
            force.abs().max_element() < 0.01 * weight,
            "{}: {force} N are left over",
            regime.name
        );
    }
}

/// What the record holds gives the summary back: work and heat of rows add up to those of the crawl,
/// and mean forces of rows balance the weight.
#[test]
fn identity_rows_add_up_to_the_crawl() {
    let loaded = nao();
    let robot = loaded.robot();
    for (gait, scale) in [("hip-10", 1.0), ("thesis-nominal", 1.37)] {
        let world = World::new(&loaded, Regime::LOCOMOTION).unwrap();
        let plan = CrawlPlan {
            scale: TimeScale::new(scale).unwrap(),
            ..plan(gait, 2)
        };
        let crawl = run(&world, &plan, Straight { turn: 0.0 }).unwrap();
        let mut sum = Effort::none(robot);
        let mut impulse = DVec3::ZERO;
        for row in &crawl.rows {
            sum.add(&row.effort);
            let force: DVec3 = row.forces.iter().map(|it| it.force).sum();
            impulse += force * row.effort.seconds;
        }
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b.abs().max(1.0);
        assert!(near(sum.seconds, crawl.effort.seconds), "{gait}");
        assert!(near(sum.work(), crawl.effort.work()), "{gait}");
        let (rows, whole) = (sum.heat(robot).unwrap(), crawl.effort.heat(robot).unwrap());
        assert!(near(rows, whole), "{gait}: {rows} {whole}");
        for group in 0..ContactGroup::COUNT {
            let cycles: f64 = crawl.cycles.iter().map(|it| it.ground.impulse[group]).sum();
            let rows = crawl
                .rows
                .iter()
                .map(|it| it.contact[group] * it.effort.seconds);
            let (rows, whole) = (rows.sum::<f64>(), crawl.ground.impulse[group]);
            assert!(
                near(cycles, whole) && near(rows, whole),
                "{gait}: {rows} {cycles} {whole}"
            );
        }
        // A controller that was cut had asked for more than the supply gives, and the other way round.
        assert!(near(crawl.effort.moving, crawl.effort.seconds), "{gait}");
        let mut cut = 0;
        for row in &crawl.rows {
            for (it, did) in world.drives().iter().zip(&row.effort.motors) {
                let WorldServo::Motor(motor) = it.servo else {
                    panic!("{:?}", it.servo);
                };
                let asked_for_more = it.demanded(did) > motor.supply_torque;
                assert_eq!(did.supply_clipped > 0.0, asked_for_more, "{gait}");
                cut += usize::from(asked_for_more);
            }
        }
        assert!(cut > 0, "{gait}");
        let last = crawl.rows.last().unwrap();
        assert!(near(last.time, crawl.effort.seconds), "{gait}");
        // From rest to an extension that is nearly at rest, over seconds: 1 % of the weight.
        let weight = robot.mass() * GRAVITY;
        let force = impulse / sum.seconds - DVec3::new(0.0, 0.0, weight);
        assert!(force.abs().max_element() < 0.01 * weight, "{gait}: {force}");
    }
}

/// Heat per path, work and advance of three cycles at one engine step.
struct Measured {
    heat: f64,
    work: f64,
    advance: f64,
}

fn measured(robot: &LoadedRobot, gait: &str, servo: MotorServo, time_step: f64) -> Measured {
    let regime = Regime {
        time_step,
        ..Regime::LOCOMOTION.with_motors(servo)
    };
    let world = World::new(robot, regime).unwrap();
    let plan = CrawlPlan {
        detail: Detail::Sums,
        ..plan(gait, 3)
    };
    let crawl = run(&world, &plan, Straight { turn: 0.0 }).unwrap();
    let path: f64 = crawl.cycles.iter().map(|it| it.advance().forward).sum();
    Measured {
        heat: crawl.effort.heat(robot.robot()).unwrap() / path,
        work: crawl.effort.work(),
        advance: path,
    }
}

/// A step five times finer changes nothing that is printed.
#[test]
fn identity_a_finer_step_changes_nothing() {
    let robot = nao();
    let gaits = ["thesis-nominal", "thesis-optimal", "hip-10", "low-150"];
    let normal = gaits.map(|gait| (gait, MotorServo::ROBOT, 0.05, 0.03));
    let stiff = gaits.map(|gait| (gait, MotorServo::STIFF, 0.10, 0.04));
    let cases: Vec<_> = normal.into_iter().chain(stiff).collect();
    let off = cases.into_par_iter().map(|(gait, servo, efforts, way)| {
        let [coarse, fine] =
            [0.0025, 0.0005].map(|time_step| measured(&robot, gait, servo, time_step));
        let over = |a: f64, b: f64| a / b - 1.0;
        let case = format!("{gait}, {} × K", servo.stiffness_factor);
        let found = [
            over(coarse.heat, fine.heat),
            over(coarse.work, fine.work),
            over(coarse.advance, fine.advance),
        ];
        let [heat, work, advance] = found;
        let within = heat.abs() < efforts && work.abs() < efforts && advance.abs() < way;
        (!within).then(|| format!("{case}: heat, work, advance {found:.4?}"))
    });
    let off: Vec<String> = off.flatten().collect();
    assert!(off.is_empty(), "{}", off.join("\n"));
}
