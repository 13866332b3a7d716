//! What a valid model lacks to be a crawling robot.

use mujoco_rs::prelude::*;

/// Why a model that the engine accepts is not a robot here.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ModelProblem {
    /// There is not exactly one body in the world, or it does not float.
    #[error("the world must hold exactly one body, with a free joint; {found}")]
    Root {
        /// What was found instead.
        found: String,
    },
    /// A body moves by more than one joint, or by one that is no hinge.
    #[error("body {body} must be fixed or move by one hinge")]
    NotHinged {
        /// The body's name.
        body: String,
    },
    /// A hinge without limits.
    #[error("joint {joint} has no range")]
    Unlimited {
        /// The joint's name.
        joint: String,
    },
    /// A hinge whose zero is not the model's zero pose.
    #[error(
        "joint {joint} has ref {reference} rad; it must be 0: the zero pose is the standing one"
    )]
    Reference {
        /// The joint's name.
        joint: String,
        /// Its angle in the model's initial pose, rad.
        reference: f64,
    },
    /// A hinge that changes what its servo does.
    #[error("joint {joint} has {setting}; what servos do is set by the program, from robot.toml")]
    ServoSetting {
        /// The joint's name.
        joint: String,
        /// The attribute.
        setting: &'static str,
    },
    /// A body or joint without a name.
    #[error("{kind} number {index} has no name")]
    Nameless {
        /// `body` or `joint`.
        kind: &'static str,
        /// Its index in the model.
        index: usize,
    },
    /// A colliding shape of a kind whose extent is not known.
    #[error("geom {geom}: only spheres, capsules, ellipsoids, cylinders and boxes may collide")]
    Shape {
        /// The geom's name.
        geom: String,
    },
    /// Nothing of the robot touches the floor.
    #[error("no geom can touch the floor: none has conaffinity 1 or contype 1")]
    NoShape,
    /// The floor is the program's.
    #[error("geom {geom} belongs to the world; the floor is added by the program")]
    WorldGeom {
        /// The geom's name.
        geom: String,
    },
    /// A constraint that holds the robot up.
    #[error("equality {equality} ties the robot to the world")]
    WorldEquality {
        /// The constraint's name.
        equality: String,
    },
    /// A body that would fall through the floor.
    #[error("exclude {exclude} keeps a body from touching the world")]
    WorldExclude {
        /// The exclusion's name.
        exclude: String,
    },
    /// A number that no robot has.
    #[error("{kind} {name}: {what} {value} {unit} is outside -{largest}..{largest} {unit}")]
    OutOfBounds {
        /// `body`, `joint`, `geom` or `site`.
        kind: &'static str,
        /// Its name.
        name: String,
        /// What is too large.
        what: &'static str,
        /// The number.
        value: f64,
        /// The bound on its size.
        largest: f64,
        /// The unit of both.
        unit: &'static str,
    },
}

/// How a problem calls something of the model: by its name, or by its number where it has none.
pub(super) fn label(model: &MjModel, kind: MjtObjBase, index: usize) -> String {
    model
        .id_to_name(kind, index)
        .map_or_else(|| format!("number {index}"), str::to_owned)
}
