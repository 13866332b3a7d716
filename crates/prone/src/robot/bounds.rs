//! Bounds on a robot's numbers: far from any robot, near enough to find a wrong unit.
//!
//! Whatever makes a [`super::Robot`] of a file keeps to them.

/// Largest length and coordinate, m.
pub const LENGTH: f64 = 10.0;
/// Largest mass of a body, kg.
pub const MASS: f64 = 1e3;
/// Largest moment of inertia of a body, kg·m²: the largest mass at the largest length.
pub const INERTIA: f64 = MASS * LENGTH * LENGTH;
/// Largest angle of a posture, an offset or a moved stop, rad: a turn.
pub const ANGLE: f64 = std::f64::consts::TAU;
/// Largest effort limit of a joint, N·m.
pub const EFFORT: f64 = 1e3;
/// Largest speed limit of a joint, rad/s.
pub const SPEED: f64 = 1e3;
/// Largest stiffness of a servo, N·m/rad.
pub const STIFFNESS: f64 = 1e5;
/// Longest time between two commands, s.
pub const COMMAND_STEP: f64 = 1.0;
/// Efficiencies of gears: from worm gears to no loss at all.
pub const GEAR_EFFICIENCY: (f64, f64) = (0.05, 1.0);
/// Largest gain of steering, without unit or in rad/m.
pub const STEERING: f64 = 100.0;
/// Largest slope above which another cycle is taken, rad: a wall.
pub const SLOPE: f64 = std::f64::consts::FRAC_PI_2;
/// Largest gear ratio.
pub const RATIO: f64 = 1e5;
/// Largest noise and bias of an accelerometer, m/s²: what a saturated part reads, 10 g.
pub const ACCELERATION: f64 = 100.0;
/// Largest noise and bias of a gyroscope, rad/s.
pub const TURN_RATE: f64 = 10.0;
/// Largest torque of a motor at its shaft, N·m.
pub const SHAFT_TORQUE: f64 = 1e3;
/// Largest speed of a motor's shaft, turns per minute.
pub const SHAFT_SPEED: f64 = 1e6;
/// How far the length of a unit vector or quaternion may be from one: what six digits leave over.
pub const UNIT: f64 = 1e-6;
/// Largest number in a model's text, whatever its unit.
pub const NUMBER: f64 = 1e9;
/// Farthest stop of a joint, rad: two turns, more than any cable takes.
pub const STOP: f64 = 2.0 * std::f64::consts::TAU;
/// Least and largest mass of a robot, kg: from a toy's to a small car's.
pub const TOTAL_MASS: (f64, f64) = (0.05, 500.0);
/// Largest density, kg/m³: that of osmium.
pub const DENSITY: f64 = 23_000.0;
/// Largest inertia of a rotor behind its gear, kg·m².
pub const ARMATURE: f64 = 100.0;
/// Largest damping of a joint, N·m·s/rad: at its largest effort it moves by 1 rad/s.
pub const DAMPING: f64 = EFFORT;
