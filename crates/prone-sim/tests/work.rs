//! Work of a motor is what it lifts, and not what it lets down: m g h, by the law.

use prone::motor::{Commands, MotorEffort};
use prone::regime::Regime;
use prone::robot::{BodyId, JointAngles, JointId, Robot};
use prone::statics::GRAVITY;
use prone_files::shipped;
use prone_sim::{LoadedRobot, Placement, RobotFiles, Simulation, World};

/// Shoulder pitch of arms that point obliquely towards the feet, rad.
const LOW: f64 = 1.2;
/// Shoulder pitch of arms that point up, rad.
const HIGH: f64 = 0.1;

/// How long an arm takes, s: so slowly that moving it takes next to nothing.
const SECONDS: f64 = 8.0;

/// A robot that lies on its back and moves its arms, which nothing else carries.
struct Lying {
    simulation: Simulation,
    robot: Robot,
    shoulders: [JointId; 2],
    /// What the motors of both shoulders have done.
    effort: MotorEffort,
}

impl Lying {
    fn new() -> Self {
        let loaded = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
        let world = World::new(&loaded, Regime::LOCOMOTION).unwrap();
        let robot = Robot::clone(loaded.robot());
        let shoulders = robot.chain.sides().map(|side| side.shoulder);
        let mut posture = JointAngles::zero(&robot);
        for shoulder in shoulders {
            posture[shoulder] = LOW;
        }
        let placement = Placement {
            posture,
            pitch: -std::f64::consts::FRAC_PI_2,
        };
        let mut lying = Self {
            simulation: Simulation::new(&world, &placement),
            robot,
            shoulders,
            effort: MotorEffort::default(),
        };
        lying.turn_shoulders(LOW, LOW, 2.0);
        lying.effort = MotorEffort::default();
        lying
    }

    /// Commands both shoulders from an angle to another.
    fn turn_shoulders(&mut self, from: f64, to: f64, seconds: f64) {
        let begin = self.simulation.time();
        loop {
            let share = (self.simulation.time() - begin) / seconds;
            if share >= 1.0 {
                return;
            }
            let mut posture = JointAngles::zero(&self.robot);
            for shoulder in self.shoulders {
                posture[shoulder] = from + share * (to - from);
            }
            self.simulation.command(&posture);
            self.simulation.step();
            let drives = self.robot.drives();
            for (drive, step) in drives.iter().zip(self.simulation.motor_steps()) {
                if self.shoulders.contains(&drive.joints[0]) {
                    self.effort
                        .add_step(step, self.simulation.time_step(), Commands::Move);
                }
            }
        }
    }

    /// Σ m g z of what hangs on the shoulders, J.
    fn energy(&self) -> f64 {
        let poses = self.simulation.body_poses();
        let mut energy = 0.0;
        for (index, body) in self.robot.bodies.iter().enumerate() {
            let mut above = Some(BodyId(index));
            while let Some(id) = above {
                let joint = self.robot.bodies[id.0].joint;
                if joint.is_some_and(|joint| self.shoulders.contains(&joint)) {
                    let centre = poses.point((BodyId(index), body.centre_of_mass));
                    energy += body.mass * GRAVITY * centre.z();
                }
                above = self.robot.bodies[id.0].parent;
            }
        }
        energy
    }
}

#[test]
fn identity_an_arm_is_lifted_by_work_and_let_down_without_any() {
    let mut robot = Lying::new();
    let low = robot.energy();
    robot.turn_shoulders(LOW, HIGH, SECONDS);
    let lifted = robot.energy() - low;
    let work = robot.effort.work;
    // Two arms of half a kilogramme each, by some centimetres.
    assert!(lifted > 0.2, "{lifted} J");
    // Within 0.5 %: speeding up takes a little, and the trunk gives way on soft ground.
    assert!(
        (work / lifted - 1.0).abs() < 0.005,
        "{work} J of work lift by {lifted} J"
    );
    robot.turn_shoulders(HIGH, LOW, SECONDS);
    let left = robot.energy() - low;
    // Servos lag behind by as much both ways.
    assert!(left.abs() < 0.02 * lifted, "{left} J are left");
    let more = robot.effort.work - work;
    assert!(more < 0.005 * work, "{more} J of work let {lifted} J down");
}
