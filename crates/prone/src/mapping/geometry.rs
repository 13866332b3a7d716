//! What the mapping reads from a robot's zero pose.

use glam::{DQuat, DVec3};

use crate::chain::ClosedChain;
use crate::robot::mirror::mirrored_axis;
use crate::robot::{JointId, Robot, SideLayout};

/// One side's sagittal chain at zero joint angles, in the root frame.
#[derive(Debug, Clone, PartialEq)]
pub struct SideGeometry {
    /// l1 to l4: toe-ankle, ankle-knee, knee-hip, hip-shoulder, metres.
    pub links: [f64; 4],
    /// Relative angles θ2⁰, θ3⁰, θ4⁰, rad.
    pub zero_angles: [f64; 3],
    /// Absolute angle of hip to shoulder, rad.
    pub trunk_zero: f64,
    /// +1 where the pitch axis is +y, −1 where it is −y: ankle, knee, hip, shoulder.
    pub pitch_signs: [f64; 4],
    /// Unit axis of the shoulder pitch.
    pub shoulder_axis: DVec3,
    /// Unit axis of the shoulder roll.
    pub roll_axis: DVec3,
    /// A point of the roll axis, seen from the shoulder pitch centre, metres.
    pub roll_centre: DVec3,
    /// Sign of the roll that spreads the upper arm outwards.
    pub outward_sign: f64,
    /// Shoulder to elbow, metres.
    pub upper_arm_zero: DVec3,
    /// Unit axes of the two forearm hinges.
    pub forearm_axes: [DVec3; 2],
    /// Unit vector along the forearm.
    pub forearm_zero: DVec3,
}

/// Why a robot's limbs form no sagittal chain.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GeometryError {
    /// A pitch joint does not turn about the robot's left.
    #[error("{joint} turns about {axis}, not about ±y: the chain would leave the sagittal plane")]
    NotSagittal {
        /// The joint's name.
        joint: String,
        /// Its axis in the root frame.
        axis: DVec3,
    },
    /// Two joint centres of the chain coincide.
    #[error("the link from {from} to {to} has no length")]
    NoLength {
        /// Upper or rear end.
        from: &'static str,
        /// The other end.
        to: &'static str,
    },
    /// A hinge of the forearm that cannot change where the forearm points.
    #[error("{joint} does not point the forearm: it turns about {along}")]
    ForearmHinge {
        /// The joint's name.
        joint: String,
        /// What its axis is parallel to.
        along: &'static str,
    },
    /// No roll gives the projected upper arm asked for.
    #[error(
        "no shoulder roll between 0 and 90° projects the upper arm to {asked_mm:.2} mm: it goes from {longest_mm:.2} down to {shortest_mm:.2} mm"
    )]
    UpperArm {
        /// Length asked for, mm.
        asked_mm: f64,
        /// Length without roll, mm.
        longest_mm: f64,
        /// Length at the largest roll, mm.
        shortest_mm: f64,
    },
}

impl SideGeometry {
    /// Reads one side's chain from the robot.
    ///
    /// # Errors
    /// [`GeometryError`] where the limbs form no sagittal chain.
    pub fn from_layout(robot: &Robot, side: &SideLayout) -> Result<Self, GeometryError> {
        let poses = robot.zero_pose();
        let centre = |id: JointId| poses.anchor(&robot.joints[id.0]).metres();
        let axis = |id: JointId| poses.axis(&robot.joints[id.0]);

        let mut pitch_signs = [0.0; 4];
        for (sign, id) in pitch_signs.iter_mut().zip(side.pitch_joints()) {
            let axis = axis(id);
            // 1e-6: rounding of quaternions in a model file, far below any real misalignment.
            if (axis.y.abs() - 1.0).abs() > 1e-6 {
                return Err(GeometryError::NotSagittal {
                    joint: robot.joints[id.0].name.clone(),
                    axis,
                });
            }
            *sign = axis.y.signum();
        }

        let names = ["toe", "ankle", "knee", "hip", "shoulder"];
        let centres = [
            poses.point(side.toe).metres(),
            centre(side.ankle),
            centre(side.knee),
            centre(side.hip),
            centre(side.shoulder),
        ];
        let mut links = [0.0; 4];
        let mut absolute = [0.0; 4];
        for i in 0..4 {
            let link = centres[i + 1] - centres[i];
            links[i] = link.x.hypot(link.z);
            absolute[i] = link.z.atan2(link.x);
            if links[i] < 1e-6 {
                return Err(GeometryError::NoLength {
                    from: names[i],
                    to: names[i + 1],
                });
            }
        }

        let roll_axis = axis(side.shoulder_roll);
        let roll_centre = centre(side.shoulder_roll) - centres[4];
        let upper_arm_zero = poses.point(side.elbow).metres() - centres[4];
        let outward = |roll: f64| {
            rolled(upper_arm_zero, roll_axis, roll_centre, roll).y * centres[4].y.signum()
        };
        let forearm_body = robot.joints[side.forearm[1].0].body;
        let forearm_axes = side.forearm.map(axis);
        let forearm_zero = poses.of(forearm_body).rotate(side.forearm_direction);
        for (along, direction) in [
            ("the forearm itself", forearm_zero),
            ("the axis of the hinge above it", forearm_axes[0]),
        ] {
            if forearm_axes[1].cross(direction).length() < 1e-6 {
                return Err(GeometryError::ForearmHinge {
                    joint: robot.joints[side.forearm[1].0].name.clone(),
                    along,
                });
            }
        }
        Ok(Self {
            links,
            zero_angles: std::array::from_fn(|i| absolute[i + 1] - absolute[i]),
            trunk_zero: absolute[3],
            pitch_signs,
            shoulder_axis: axis(side.shoulder),
            roll_axis,
            roll_centre,
            outward_sign: if outward(0.1) >= outward(-0.1) {
                1.0
            } else {
                -1.0
            },
            upper_arm_zero,
            forearm_axes,
            forearm_zero,
        })
    }

    /// l5 and absolute zero angle of the upper arm, projected on the sagittal plane, for an
    /// outward roll, rad.
    pub fn upper_arm(&self, outward: f64) -> (f64, f64) {
        let roll = self.outward_sign * outward;
        let elbow = rolled(self.upper_arm_zero, self.roll_axis, self.roll_centre, roll);
        (elbow.x.hypot(elbow.z), elbow.z.atan2(elbow.x))
    }

    /// The outward roll, rad, that projects the upper arm to `length` metres.
    ///
    /// # Errors
    /// [`GeometryError::UpperArm`].
    pub fn roll_for(&self, length: f64) -> Result<f64, GeometryError> {
        let (mut low, mut high) = (0.0, std::f64::consts::FRAC_PI_2);
        let projected = |roll| self.upper_arm(roll).0;
        if !(projected(high)..=projected(low)).contains(&length) {
            return Err(GeometryError::UpperArm {
                asked_mm: length * 1e3,
                longest_mm: projected(low) * 1e3,
                shortest_mm: projected(high) * 1e3,
            });
        }
        // 60 halvings reach the resolution of f64.
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if projected(middle) > length {
                low = middle;
            } else {
                high = middle;
            }
        }
        Ok(0.5 * (low + high))
    }

    /// The chain of this side for an outward roll, rad, and a span, metres.
    pub fn closed_chain(&self, span: f64, outward: f64) -> ClosedChain {
        let [toe_to_ankle, ankle_to_knee, knee_to_hip, hip_to_shoulder] = self.links;
        ClosedChain {
            toe_to_ankle,
            ankle_to_knee,
            knee_to_hip,
            hip_to_shoulder,
            shoulder_to_elbow: self.upper_arm(outward).0,
            span,
        }
    }

    /// What the other side's forearm joints are multiplied by in a mirrored pose.
    pub(super) fn mirror_signs(&self, other: &Self) -> [f64; 2] {
        let sign = |i| mirrored_axis(self.forearm_axes[i]).dot(other.forearm_axes[i]);
        [0, 1].map(|i| sign(i).signum())
    }
}

/// `point` turned by `angle`, rad, about the unit `axis` through `centre`.
fn rolled(point: DVec3, axis: DVec3, centre: DVec3, angle: f64) -> DVec3 {
    centre + DQuat::from_axis_angle(axis, angle) * (point - centre)
}
