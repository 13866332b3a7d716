//! Which way is up, from gyroscopes and accelerometers.
//!
//! An attitude here is the unit vector u that points up, in the root frame: all that gravity tells
//! (the heading stays unknown). With the root turned by the pitch p about +y and then, about the
//! ground's x, by the roll r,
//!
//! ```text
//! u = (−sin p cos r, sin r, cos p cos r)                                         (1)
//! p = atan2(−u_x, u_z),  r = asin u_y                                            (2)
//! ```
//!
//! so p = 0 is upright, p = π/2 lies on the belly (the root pitch of [`crate::mapping`]), and r > 0
//! has the left side up. Pitch is lost where the robot lies on its side, not on its belly.
//!
//! [`AttitudeFilter`] is the explicit complementary filter of Mahony, Hamel and Pflimlin, "Nonlinear
//! complementary filters on the special orthogonal group", IEEE Trans. Automatic Control 53 (2008),
//! for one direction. With the angular velocity Ω and the specific force f of the sensor, both in
//! the root frame:
//!
//! ```text
//! a = f / g                                                                      (3)
//! e = a × û                                                                      (4)
//! dû/dt = −(Ω − b̂ + kP e) × û                                                    (5)
//! db̂/dt = −kI e                                                                  (6)
//! ```
//!
//! Standing still, a is up, and the error decays with s² + kP s + kI = 0 while the bias b̂ is
//! learned (all but its part along u, which does not matter here). (5) is integrated as one turn per
//! step, so that û stays a unit vector.
//!
//! The source has f / |f| in (3), and filters in use leave out readings whose |f| is not near
//! gravity. Both are wrong for a crawl, which drags slowly and slips in jolts: over a movement from
//! rest to rest the mean of f is gravity, but that of its directions is not, and without the jolts
//! the drag is taken for a slope. So f enters linearly and always, and the filter has to see all of
//! it: sampled every control step instead of every engine step, jolts are missed.
//!
//! A floor that rises by s in the direction of travel turns a robot in the same posture by −s about
//! +y: s = p(planned on level ground) − p(measured)                                 (7)

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use crate::statics::GRAVITY;

/// Below this length of u in the sagittal plane pitch is noise: within 6° of lying on a side.
const LEAST_SAGITTAL: f64 = 0.1;

/// How near |f| is to gravity where a robot may be at rest, as a part of it: a sensor's own errors
/// are below 5 %.
const AT_REST: f64 = 0.2;

/// One sample of an inertial unit, along the root's axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImuReading {
    /// Of the root, rad/s.
    pub angular_velocity: DVec3,
    /// Acceleration of the sensor minus gravity, m/s²: at rest it points up.
    pub specific_force: DVec3,
}

/// How a robot is turned, its heading apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attitude {
    up_in_root: DVec3,
}

/// How fast an [`AttitudeFilter`] believes its accelerometers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gains {
    /// kP of equation (5), 1/s.
    pub proportional: f64,
    /// kI of equation (6), 1/s².
    pub integral: f64,
}

impl Gains {
    /// As in the experiments of the source: damping 0.91, settled within 2 % after about 8 s.
    pub const PUBLISHED: Self = Self {
        proportional: 1.0,
        integral: 0.3,
    };
}

/// Estimates the attitude from one reading after another.
#[derive(Debug, Clone, PartialEq)]
pub struct AttitudeFilter {
    gains: Gains,
    attitude: Attitude,
    /// b̂, rad/s.
    gyroscope_bias: DVec3,
}

/// Why there is no attitude.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AttitudeError {
    /// A sensor failed, or a vector has no direction; a filter is as it was before.
    #[error("{what} {value} is no measurement")]
    NotFinite {
        /// Which vector.
        what: &'static str,
        /// What was read.
        value: DVec3,
    },
    /// Time does not go backwards.
    #[error("a time step must be positive and finite, not {step_s} s")]
    TimeStep {
        /// What was given.
        step_s: f64,
    },
    /// Nothing that points up.
    #[error("a specific force of {specific_force:.3} m/s² does not tell which way is up")]
    NotAtRest {
        /// Its size.
        specific_force: f64,
    },
    /// Pitch means nothing there.
    #[error("the robot lies on its side (roll {roll_deg:.1}°) and has no pitch")]
    OnItsSide {
        /// Roll, degrees.
        roll_deg: f64,
    },
}

impl Attitude {
    /// The attitude whose up is along a vector of the root frame, of any length.
    ///
    /// # Errors
    /// [`AttitudeError::NotFinite`] for a vector without a direction.
    pub fn from_up(up_in_root: DVec3) -> Result<Self, AttitudeError> {
        let unit = up_in_root.try_normalize();
        unit.map(|up_in_root| Self { up_in_root })
            .ok_or(AttitudeError::NotFinite {
                what: "up",
                value: up_in_root,
            })
    }

    /// The unit vector that points up, in the root frame.
    pub const fn up(&self) -> DVec3 {
        self.up_in_root
    }

    /// Turn of the root about +y, rad, in (−π, π]: equation (2).
    ///
    /// # Errors
    /// [`AttitudeError::OnItsSide`].
    pub fn pitch(&self) -> Result<f64, AttitudeError> {
        let up = self.up_in_root;
        if up.x.hypot(up.z) < LEAST_SAGITTAL {
            return Err(AttitudeError::OnItsSide {
                roll_deg: self.roll().to_degrees(),
            });
        }
        Ok((-up.x).atan2(up.z))
    }

    /// How far the left side is up, rad, in ±π/2: equation (2).
    pub fn roll(&self) -> f64 {
        // Rounding may leave a unit vector a few 1e-16 too long.
        self.up_in_root.y.clamp(-1.0, 1.0).asin()
    }

    /// Slope of the floor in the direction of travel, rad, uphill positive, where the same posture
    /// has the pitch `planned_pitch` on level ground: equation (7).
    ///
    /// # Errors
    /// [`AttitudeError::OnItsSide`].
    pub fn slope(&self, planned_pitch: f64) -> Result<f64, AttitudeError> {
        let difference = planned_pitch - self.pitch()?;
        Ok(difference - TAU * (difference / TAU).round())
    }
}

impl AttitudeFilter {
    /// A filter that begins with a guess.
    pub const fn new(gains: Gains, start: Attitude) -> Self {
        Self {
            gains,
            attitude: start,
            gyroscope_bias: DVec3::ZERO,
        }
    }

    /// A filter that begins with what a first reading, at rest, says.
    ///
    /// # Errors
    /// [`AttitudeError::NotFinite`] and, where the specific force is not gravity's,
    /// [`AttitudeError::NotAtRest`].
    pub fn aligned(gains: Gains, reading: &ImuReading) -> Result<Self, AttitudeError> {
        check(reading)?;
        let specific_force = reading.specific_force.length();
        if (specific_force - GRAVITY).abs() > AT_REST * GRAVITY {
            return Err(AttitudeError::NotAtRest { specific_force });
        }
        Ok(Self::new(gains, Attitude::from_up(reading.specific_force)?))
    }

    /// Takes in a reading that holds for `time_step`, s: equations (3) to (6).
    ///
    /// # Errors
    /// [`AttitudeError::NotFinite`], [`AttitudeError::TimeStep`]; the estimate is then as it was.
    pub fn update(&mut self, reading: &ImuReading, time_step: f64) -> Result<(), AttitudeError> {
        check(reading)?;
        let forwards = time_step > 0.0 && time_step.is_finite();
        if !forwards {
            return Err(AttitudeError::TimeStep { step_s: time_step });
        }
        let up = self.attitude.up_in_root;
        let error = (reading.specific_force / GRAVITY).cross(up);
        let rate = reading.angular_velocity - self.gyroscope_bias + self.gains.proportional * error;
        let turn = DQuat::from_scaled_axis(-rate * time_step);
        self.attitude.up_in_root = (turn * up).normalize();
        self.gyroscope_bias -= self.gains.integral * error * time_step;
        Ok(())
    }

    /// The estimate now.
    pub const fn attitude(&self) -> Attitude {
        self.attitude
    }
}

fn check(reading: &ImuReading) -> Result<(), AttitudeError> {
    let vectors = [
        ("angular velocity", reading.angular_velocity),
        ("specific force", reading.specific_force),
    ];
    match vectors.into_iter().find(|(_, value)| !value.is_finite()) {
        None => Ok(()),
        Some((what, value)) => Err(AttitudeError::NotFinite { what, value }),
    }
}

#[cfg(test)]
mod tests;
