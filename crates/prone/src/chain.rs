//! The closed five-link chain from toe to elbow, in the sagittal plane.
//!
//! x forward, z up, origin at the toe contact; angles from +x towards +z, each link's relative to
//! the one before. With link lengths l1…l5 and the toe-elbow distance `d_e` (Bell 2015, the
//! *Projected Profile* gait):
//!
//! ```text
//! Σ l_i cos(θ1+…+θi) = d_e                                        (1)
//! Σ l_i sin(θ1+…+θi) = 0                                          (2)
//! θ1+…+θ5 = α                                                     (3)
//! ```
//!
//! Given the [`GaitParameters`] (θ3, θ4, α), with x̂ = `d_e` − l5 cos α, ẑ = −l5 sin α (the
//! shoulder), K1 = l2 + l3 cos θ3 + l4 cos(θ3+θ4) and K2 = −l3 sin θ3 − l4 sin(θ3+θ4):
//!
//! ```text
//! 2 l1 K1 cos θ2 + 2 l1 K2 sin θ2 = x̂² + ẑ² − l1² − K1² − K2²     (4)
//! K3 = l1 + K1 cos θ2 + K2 sin θ2,   K4 = K2 cos θ2 − K1 sin θ2
//! θ1 = atan2(K4 x̂ + K3 ẑ, K3 x̂ − K4 ẑ),   θ5 = α − θ1 − θ2 − θ3 − θ4
//! ```
//!
//! **Which root of (4).** θ3 and θ4 make shin, thigh and trunk one rigid piece, so toe, ankle and
//! shoulder form a triangle with three known sides: the two roots are its two mirror images in
//! the line from toe to shoulder. That line hardly rises, so one image has the leg above it and
//! the other below the floor. The ankle is above the line exactly when K4 > 0. With
//! ψ = atan2(K2, K1), K4 = −√(K1²+K2²) sin(θ2 − ψ), so the wanted root is θ2 = ψ − arccos(·).

use crate::frames::{Ground, Point};

/// Link lengths of the closed chain and the distance it spans, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosedChain {
    /// l1: toe contact to ankle.
    pub toe_to_ankle: f64,
    /// l2: ankle to knee.
    pub ankle_to_knee: f64,
    /// l3: knee to hip.
    pub knee_to_hip: f64,
    /// l4: hip to shoulder.
    pub hip_to_shoulder: f64,
    /// l5: shoulder to elbow, projected on the sagittal plane.
    pub shoulder_to_elbow: f64,
    /// `d_e`: toe contact to elbow, along the ground.
    pub span: f64,
}

/// The three angles that steer the closed chain, radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GaitParameters {
    /// θ3, the thigh relative to the shin.
    pub knee: f64,
    /// θ4, the trunk relative to the thigh.
    pub hip: f64,
    /// α, the upper arm's absolute angle, shoulder to elbow; negative, as it points down.
    pub upper_arm: f64,
}

/// Relative angles of the chain from toe to elbow, radians.
///
/// Not joint angles of a robot: [`crate::mapping`] makes those.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChainAngles {
    /// θ1, the toe-ankle line against the ground; passive.
    pub toe: f64,
    /// θ2.
    pub ankle: f64,
    /// θ3.
    pub knee: f64,
    /// θ4.
    pub hip: f64,
    /// θ5.
    pub shoulder: f64,
}

/// Joint centres of a closed chain in the sagittal plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChainPosture {
    /// The toe contact: the origin.
    pub toe: Point<Ground>,
    /// Ankle centre.
    pub ankle: Point<Ground>,
    /// Knee centre.
    pub knee: Point<Ground>,
    /// Hip centre.
    pub hip: Point<Ground>,
    /// Shoulder centre.
    pub shoulder: Point<Ground>,
    /// The elbow; on the ground where the chain closes.
    pub elbow: Point<Ground>,
}

/// Why a chain does not close.
///
/// The leg is too short or too long to reach the shoulder that the arm asks for; NaN input ends
/// here too.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "the chain cannot close: its leg would need an ankle angle of cosine {cosine:.4}, outside -1..1"
)]
pub struct ClosureError {
    /// The cosine of (θ2 − ψ) that equation (4) asks for.
    pub cosine: f64,
}

impl ChainAngles {
    /// From θ1 to θ5.
    pub const fn from_array([toe, ankle, knee, hip, shoulder]: [f64; 5]) -> Self {
        Self {
            toe,
            ankle,
            knee,
            hip,
            shoulder,
        }
    }

    /// θ1 to θ5.
    pub const fn to_array(self) -> [f64; 5] {
        [self.toe, self.ankle, self.knee, self.hip, self.shoulder]
    }

    /// The gait parameters of these angles: the inverse of [`ClosedChain::close`].
    pub fn gait_parameters(&self) -> GaitParameters {
        GaitParameters {
            knee: self.knee,
            hip: self.hip,
            upper_arm: self.trunk() + self.shoulder,
        }
    }

    /// θ1+…+θ4, the trunk's absolute angle, hip to shoulder.
    pub fn trunk(&self) -> f64 {
        self.toe + self.ankle + self.knee + self.hip
    }
}

impl ClosedChain {
    /// The lengths l1…l5 in order, metres.
    pub const fn links(&self) -> [f64; 5] {
        [
            self.toe_to_ankle,
            self.ankle_to_knee,
            self.knee_to_hip,
            self.hip_to_shoulder,
            self.shoulder_to_elbow,
        ]
    }

    /// Solves equations (1) to (4) for the root with the leg above the ground.
    ///
    /// # Errors
    /// [`ClosureError`] where no posture satisfies (1) to (3).
    #[inline]
    pub fn close(&self, parameters: GaitParameters) -> Result<ChainAngles, ClosureError> {
        let [l1, l2, l3, l4, l5] = self.links();
        let (sin_knee, cos_knee) = parameters.knee.sin_cos();
        let (sin_trunk, cos_trunk) = (parameters.knee + parameters.hip).sin_cos();
        let (sin_arm, cos_arm) = parameters.upper_arm.sin_cos();

        let x_hat = self.span - l5 * cos_arm;
        let z_hat = -l5 * sin_arm;
        let k1 = l2 + l3 * cos_knee + l4 * cos_trunk;
        let k2 = -l3 * sin_knee - l4 * sin_trunk;

        let rigid_squared = k1 * k1 + k2 * k2;
        let rigid = rigid_squared.sqrt();
        let cosine = (x_hat * x_hat + z_hat * z_hat - l1 * l1 - rigid_squared) / (2.0 * l1 * rigid);
        if !(-1.0..=1.0).contains(&cosine) {
            return Err(ClosureError { cosine });
        }
        let ankle = k2.atan2(k1) - cosine.acos();

        // With θ2 − ψ = −arccos(c): K1 cos θ2 + K2 sin θ2 = √(K1²+K2²) c, and K4 > 0.
        let k3 = l1 + rigid * cosine;
        let k4 = rigid * (1.0 - cosine * cosine).sqrt();
        let toe = (k4 * x_hat + k3 * z_hat).atan2(k3 * x_hat - k4 * z_hat);

        let GaitParameters { knee, hip, .. } = parameters;
        let shoulder = parameters.upper_arm - toe - ankle - knee - hip;
        Ok(ChainAngles::from_array([toe, ankle, knee, hip, shoulder]))
    }

    /// Joint centres for given angles, whether or not they close the chain.
    pub fn posture(&self, angles: &ChainAngles) -> ChainPosture {
        let toe = Point::ORIGIN;
        let mut points = [toe; 5];
        let (mut x, mut z, mut absolute) = (0.0, 0.0, 0.0);
        for ((point, length), angle) in points.iter_mut().zip(self.links()).zip(angles.to_array()) {
            absolute += angle;
            x += length * absolute.cos();
            z += length * absolute.sin();
            *point = Point::sagittal(x, z);
        }
        let [ankle, knee, hip, shoulder, elbow] = points;
        ChainPosture {
            toe,
            ankle,
            knee,
            hip,
            shoulder,
            elbow,
        }
    }
}

impl ChainPosture {
    /// Toe to elbow, in order along the chain.
    pub const fn points(&self) -> [Point<Ground>; 6] {
        [
            self.toe,
            self.ankle,
            self.knee,
            self.hip,
            self.shoulder,
            self.elbow,
        ]
    }
}

#[cfg(test)]
mod tests;
