//! What the compiled model of a world says about how it is simulated.

use glam::DVec3;

use crate::engine_numbers::FREE_JOINT_SPEEDS;
use crate::world::World;

/// Options of the engine, as the compiled model holds them.
#[derive(Debug, Clone, PartialEq)]
pub struct EngineOptions {
    /// Name of the integrator in the engine's model files.
    pub integrator: &'static str,
    /// Name of the solver of constraints.
    pub solver: &'static str,
    /// Form of the friction cone.
    pub cone: &'static str,
    /// Most iterations of the solver per step.
    pub iterations: usize,
    /// Improvement of the cost, scaled, below which the solver ends.
    pub tolerance: f64,
    /// Length of a step, s.
    pub time_step: f64,
    /// Ratio of frictional to normal constraint impedance.
    pub impratio: f64,
    /// Acceleration of gravity in the ground frame, m/s².
    pub gravity: DVec3,
    /// Damping of each of the robot's joints, the back-EMF of its motor included, N·m·s/rad.
    pub joint_damping: Vec<f64>,
}

impl World {
    /// How the compiled model is simulated.
    pub fn engine_options(&self) -> EngineOptions {
        let options = self.model.opt();
        EngineOptions {
            integrator: name(&INTEGRATORS, options.integrator),
            solver: name(&SOLVERS, options.solver),
            cone: name(&CONES, options.cone),
            iterations: usize::try_from(options.iterations).unwrap_or(0),
            tolerance: options.tolerance,
            time_step: options.timestep,
            impratio: options.impratio,
            gravity: DVec3::from_array(options.gravity),
            joint_damping: self.model.dof_damping()[FREE_JOINT_SPEEDS..].to_vec(),
        }
    }
}

/// Names in the engine's model files, by the engine's number.
const INTEGRATORS: [&str; 4] = ["Euler", "RK4", "implicit", "implicitfast"];
const SOLVERS: [&str; 3] = ["PGS", "CG", "Newton"];
const CONES: [&str; 2] = ["pyramidal", "elliptic"];

fn name(names: &[&'static str], number: i32) -> &'static str {
    let index = usize::try_from(number).ok();
    let name = index.and_then(|index| names.get(index));
    name.copied().unwrap_or("unknown")
}

#[cfg(test)]
mod tests {
    use prone::regime::Regime;
    use prone::scene::Scene;
    use prone::statics::GRAVITY;
    use prone_files::shipped;

    use super::*;
    use crate::{LoadedRobot, RobotFiles, WorldServo};

    /// What the model says is what the regime, the robot and the scene asked for.
    #[test]
    fn identity_the_compiled_options_are_those_that_were_asked_for() {
        let robot = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
        let slope = 0.1_f64;
        let mut scene = Scene::level();
        scene.floor.slope = slope;
        let regime = Regime {
            time_step: 0.001,
            ..Regime::LOCOMOTION
        };
        let world = World::in_scene(&robot, regime, &scene).unwrap();
        let options = world.engine_options();
        assert_eq!(
            (options.integrator, options.solver, options.cone),
            ("implicitfast", "Newton", "elliptic")
        );
        assert!((options.time_step - 0.001).abs() < 1e-15);
        assert!((options.impratio - regime.impratio).abs() < 1e-15);
        // Uphill is +x, so gravity pulls towards -x.
        let down = DVec3::new(-slope.sin(), 0.0, -slope.cos()) * GRAVITY;
        assert!((options.gravity - down).length() < 1e-12);
        let drives = world.drives().iter();
        for (drive, joint) in drives.flat_map(|it| it.drive.joints.iter().map(move |id| (it, id))) {
            let damping = options.joint_damping[joint.0];
            let WorldServo::Motor(motor) = drive.servo else {
                panic!("the regime has motors");
            };
            let share = motor.back_emf / drive.drive.sharers();
            assert!((damping - share).abs() < 1e-12, "{drive:?}");
        }
    }
}
