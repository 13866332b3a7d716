//! From a robot to its document.
//!
//! Every struct is taken apart by all its fields, so that a field that the domain gains does not
//! compile until it is written too.

use glam::DQuat;

use prone::chain::ClosedChain;
use prone::frames::{Frame, Link, Point, Transform};
use prone::robot::{
    Body, BodyId, ChainLayout, ContactGroup, Control, FixedArm, Imu, Joint, JointAngles, JointId,
    Motor, PublishedChain, Range, Robot, SearchSetup, SensorNoise, ServoLaw, Shape, SideLayout,
    Solid, SteeringGains, StudySetup,
};

use super::document::{
    BodyDocument, ChainDocument, ContactGroupName, ControlDocument, FixedArmDocument, ImuDocument,
    JointDocument, MotorDocument, NoiseDocument, PointDocument, PoseDocument, PostureDocument,
    PublishedDocument, RobotDocument, SearchDocument, ShapeDocument, SideDocument, SolidDocument,
    SteeringDocument, StopDocument, StudyDocument,
};

impl RobotDocument {
    /// Writes a robot down, every number as it is.
    ///
    /// # Panics
    /// Where the robot's bodies and joints refer to ones that it has not.
    pub fn from_robot(robot: &Robot) -> Self {
        let Robot {
            name,
            standing_height,
            bodies,
            joints,
            shapes,
            chain,
            postures,
            study,
            imu,
            control,
            search,
            lying_length,
        } = robot;
        let names = Names { bodies, joints };
        Self {
            name: name.clone(),
            standing_height_m: *standing_height,
            bodies: bodies.iter().map(|it| names.body_document(it)).collect(),
            joints: joints.iter().map(|it| names.joint_document(it)).collect(),
            shapes: shapes.iter().map(|it| names.shape(it)).collect(),
            chain: names.chain(chain),
            postures: postures.iter().map(posture).collect(),
            study: names.study(study),
            imu: imu.as_ref().map(imu_document),
            control: control_document(control),
            search: search_document(search),
            lying_length_m: *lying_length,
        }
    }
}

/// What bodies and joints are called.
struct Names<'a> {
    bodies: &'a [Body],
    joints: &'a [Joint],
}

impl Names<'_> {
    fn body(&self, BodyId(index): BodyId) -> String {
        self.bodies[index].name.clone()
    }

    fn joint(&self, JointId(index): JointId) -> String {
        self.joints[index].name.clone()
    }

    fn body_document(&self, body: &Body) -> BodyDocument {
        let Body {
            name,
            parent,
            parent_from_body,
            joint,
            mass,
            centre_of_mass,
            contact_group,
            is_head,
        } = body;
        BodyDocument {
            name: name.clone(),
            parent: parent.map(|id| self.body(id)),
            parent_from_body: pose(parent_from_body),
            joint: joint.map(|id| self.joint(id)),
            mass_kg: *mass,
            centre_of_mass_m: centre_of_mass.metres().to_array(),
            contact_group: match contact_group {
                ContactGroup::Toe => ContactGroupName::Toe,
                ContactGroup::Elbow => ContactGroupName::Elbow,
                ContactGroup::Torso => ContactGroupName::Torso,
                ContactGroup::Leg => ContactGroupName::Leg,
            },
            is_head: *is_head,
        }
    }

    fn joint_document(&self, joint: &Joint) -> JointDocument {
        let Joint {
            name,
            body,
            axis,
            anchor,
            range,
            effort_limit,
            speed_limit,
            servo_gain,
            motor,
        } = joint;
        JointDocument {
            name: name.clone(),
            body: self.body(*body),
            axis: axis.to_array(),
            anchor_m: anchor.metres().to_array(),
            range_rad: range_document(range),
            effort_limit_nm: *effort_limit,
            speed_limit_rad_s: *speed_limit,
            servo_gain_nms: *servo_gain,
            motor: motor.as_ref().map(motor_document),
        }
    }

    fn shape(&self, shape: &Shape) -> ShapeDocument {
        let Shape {
            name,
            body,
            link_from_geom,
            solid,
        } = shape;
        ShapeDocument {
            name: name.clone(),
            body: self.body(*body),
            link_from_geom: pose(link_from_geom),
            solid: solid_document(*solid),
        }
    }

    fn chain(&self, chain: &ChainLayout) -> ChainDocument {
        let ChainLayout {
            left,
            right,
            span,
            projected_upper_arm,
            published,
            fixed_arm,
        } = chain;
        ChainDocument {
            left: self.side(left),
            right: self.side(right),
            span_m: *span,
            projected_upper_arm_m: *projected_upper_arm,
            published: published.as_ref().map(published_document),
            fixed_arm: fixed_arm.as_ref().map(fixed_arm_document),
        }
    }

    fn side(&self, side: &SideLayout) -> SideDocument {
        let SideLayout {
            toe,
            ankle,
            knee,
            hip,
            shoulder,
            shoulder_roll,
            elbow,
            forearm,
            forearm_direction,
        } = side;
        SideDocument {
            toe: self.point(*toe),
            ankle: self.joint(*ankle),
            knee: self.joint(*knee),
            hip: self.joint(*hip),
            shoulder: self.joint(*shoulder),
            shoulder_roll: self.joint(*shoulder_roll),
            elbow: self.point(*elbow),
            forearm: forearm.map(|id| self.joint(id)),
            forearm_direction: forearm_direction.to_array(),
        }
    }

    fn point(&self, (body, point): (BodyId, Point<Link>)) -> PointDocument {
        PointDocument {
            body: self.body(body),
            position_m: point.metres().to_array(),
        }
    }

    fn study(&self, study: &StudySetup) -> StudyDocument {
        let StudySetup {
            start_posture,
            stops,
        } = study;
        let stops = stops.iter().map(|(joint, range)| StopDocument {
            joint: self.joint(*joint),
            range_rad: range_document(range),
        });
        StudyDocument {
            start_posture: start_posture.clone(),
            stops: stops.collect(),
        }
    }
}

fn pose<A: Frame, B: Frame>(pose: &Transform<A, B>) -> PoseDocument {
    let DQuat { x, y, z, w } = pose.rotation();
    PoseDocument {
        position_m: pose.origin().metres().to_array(),
        quaternion_wxyz: [w, x, y, z],
    }
}

const fn range_document(range: &Range) -> [f64; 2] {
    let Range { lower, upper } = *range;
    [lower, upper]
}

const fn motor_document(motor: &Motor) -> MotorDocument {
    let Motor {
        ratio,
        nominal,
        stall,
        no_load_speed,
    } = *motor;
    MotorDocument {
        ratio,
        nominal_nm: nominal,
        stall_nm: stall,
        no_load_speed_rad_s: no_load_speed,
    }
}

const fn solid_document(solid: Solid) -> SolidDocument {
    match solid {
        Solid::Sphere { radius } => SolidDocument::Sphere { radius_m: radius },
        Solid::Capsule {
            radius,
            half_length,
        } => SolidDocument::Capsule {
            radius_m: radius,
            half_length_m: half_length,
        },
        Solid::Ellipsoid { half_axes } => SolidDocument::Ellipsoid {
            half_axes_m: half_axes.to_array(),
        },
        Solid::Cylinder {
            radius,
            half_length,
        } => SolidDocument::Cylinder {
            radius_m: radius,
            half_length_m: half_length,
        },
        Solid::Cuboid { half_edges } => SolidDocument::Cuboid {
            half_edges_m: half_edges.to_array(),
        },
    }
}

const fn published_document(published: &PublishedChain) -> PublishedDocument {
    let PublishedChain {
        chain:
            ClosedChain {
                toe_to_ankle,
                ankle_to_knee,
                knee_to_hip,
                hip_to_shoulder,
                shoulder_to_elbow,
                span,
            },
        ankle_offset,
        shoulder_roll,
    } = *published;
    PublishedDocument {
        links_m: [
            toe_to_ankle,
            ankle_to_knee,
            knee_to_hip,
            hip_to_shoulder,
            shoulder_to_elbow,
        ],
        span_m: span,
        ankle_offset_rad: ankle_offset,
        shoulder_roll_rad: shoulder_roll,
    }
}

const fn fixed_arm_document(fixed: &FixedArm) -> FixedArmDocument {
    let FixedArm {
        shoulder_roll,
        forearm,
    } = *fixed;
    FixedArmDocument {
        shoulder_roll_rad: shoulder_roll,
        forearm_rad: forearm,
    }
}

fn posture((name, angles): (&String, &JointAngles)) -> PostureDocument {
    PostureDocument {
        name: name.clone(),
        angles_rad: angles.as_slice().to_vec(),
    }
}

fn imu_document(imu: &Imu) -> ImuDocument {
    let Imu {
        site,
        root_from_sensor,
        accelerometer,
        gyroscope,
    } = imu;
    ImuDocument {
        site: site.clone(),
        root_from_sensor: pose(root_from_sensor),
        accelerometer_m_s2: noise(accelerometer),
        gyroscope_rad_s: noise(gyroscope),
    }
}

const fn noise(noise: &SensorNoise) -> NoiseDocument {
    let SensorNoise {
        standard_deviation,
        bias_bound,
    } = *noise;
    NoiseDocument {
        standard_deviation,
        bias_bound,
    }
}

const fn control_document(control: &Control) -> ControlDocument {
    let Control {
        command_step,
        servo: ServoLaw { rate, speed },
        stiff_servo_gain,
        steering:
            SteeringGains {
                yaw,
                lateral,
                lateral_sum,
            },
        uphill,
    } = *control;
    ControlDocument {
        command_step_s: command_step,
        servo_rate_per_s: rate,
        servo_speed_rad_s: speed,
        stiff_servo_gain_nms: stiff_servo_gain,
        steering: SteeringDocument {
            yaw,
            lateral_rad_m: lateral,
            lateral_sum_rad_m: lateral_sum,
        },
        uphill_rad: uphill,
    }
}

const fn search_document(search: &SearchSetup) -> SearchDocument {
    let SearchSetup {
        least_advance,
        upper_arm,
    } = *search;
    SearchDocument {
        least_advance_m: least_advance,
        upper_arm_rad: range_document(&upper_arm),
    }
}
