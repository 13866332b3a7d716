//! What every robot that loads must be, whatever the loader looks at: a judge of its own.
//!
//! The bounds are wider than the loader's may ever be. Beyond them lies what no robot has.

use std::ops::RangeInclusive;

use prone::regime::Regime;
use prone::robot::{JointAngles, Robot};
use prone_sim::{LoadedRobot, Placement, Simulation, World};

/// Control steps that are simulated, 0.5 s.
const STEPS: usize = 10;

/// What no robot has, as a sentence; `Ok` for a robot that could be.
pub(crate) fn check(loaded: &LoadedRobot) -> Result<(), String> {
    data(loaded.robot())?;
    // A world may be refused with a message; it may not be nonsense.
    let Ok(world) = World::new(loaded, Regime::LOCOMOTION) else {
        return Ok(());
    };
    let rest = JointAngles::from_fn(world.robot().joints.len(), |_| 0.0);
    let mut simulation = Simulation::new(
        &world,
        &Placement {
            posture: rest,
            pitch: 0.0,
        },
    );
    let at = world.at(&simulation.snapshot());
    let model = at.model();
    let engine = [
        ("damping of a joint", model.dof_damping(), 0.0..=1e5),
        ("armature of a joint", model.dof_armature(), 0.0..=1e3),
        (
            "dry friction of a joint",
            model.dof_frictionloss(),
            0.0..=1e5,
        ),
        ("stiffness of a joint", model.jnt_stiffness(), 0.0..=1e6),
        ("gravity compensation", model.body_gravcomp(), 0.0..=0.0),
    ];
    for (what, values, bounds) in engine {
        all_within(what, values, &bounds)?;
    }
    for moments in model.body_inertia().iter().skip(1) {
        let [a, b, c] = *moments;
        all_within("moment of inertia, kg·m²", moments, &(0.0..=1e4))?;
        let slack = 1e-9 + 1e-6 * (a + b + c);
        if a + b + slack < c || b + c + slack < a || c + a + slack < b {
            return Err(format!("no body has the moments of inertia {moments:?}"));
        }
    }
    for _ in 0..STEPS {
        // That it diverges is said.
        if simulation.control_step().is_err() {
            return Ok(());
        }
    }
    all_within(
        "joint angle after half a second",
        simulation.joint_angles().as_slice(),
        &(-1e3..=1e3),
    )
}

/// What the loader hands to everyone.
fn data(robot: &Robot) -> Result<(), String> {
    all_within("mass of the robot, kg", &[robot.mass()], &(0.01..=1e3))?;
    for body in &robot.bodies {
        all_within(
            &format!("mass of {:?}", body.name),
            &[body.mass],
            &(0.0..=1e3),
        )?;
        all_within(
            "centre of mass",
            &body.centre_of_mass.metres().to_array(),
            &(-100.0..=100.0),
        )?;
    }
    for joint in &robot.joints {
        let name = &joint.name;
        let numbers = [
            ("effort", joint.effort_limit, 1e-4..=1e5),
            ("speed", joint.speed_limit, 1e-4..=1e5),
            ("servo stiffness", joint.servo_stiffness, 1e-6..=1e7),
            ("lower stop", joint.range.lower, -100.0..=joint.range.upper),
            ("upper stop", joint.range.upper, -100.0..=100.0),
            ("length of the axis", joint.axis.length(), 0.999..=1.001),
        ];
        for (what, value, bounds) in numbers {
            all_within(&format!("{what} of {name:?}"), &[value], &bounds)?;
        }
        if let Some(motor) = &joint.motor {
            let most = motor.stall;
            all_within(
                &format!("continuous torque of {name:?} beside its stall torque"),
                &[motor.nominal],
                &(1e-9..=most),
            )?;
            all_within(
                &format!("gear ratio of {name:?}"),
                &[motor.ratio],
                &(1e-3..=1e6),
            )?;
        }
    }
    Ok(())
}

fn all_within(what: &str, values: &[f64], bounds: &RangeInclusive<f64>) -> Result<(), String> {
    // A NaN is in no range.
    match values.iter().find(|value| !bounds.contains(value)) {
        Some(value) => Err(format!("{what} is {value:e}, and the robot was loaded")),
        None => Ok(()),
    }
}
