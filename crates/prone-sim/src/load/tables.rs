//! Joins `robot.toml` with the parts of the model.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use glam::DVec3;

use prone::chain::ClosedChain;
use prone::mapping::{self, MappingError};
use prone::motor::check_speed;
use prone::robot::{
    ChainLayout, ContactGroup, FixedArm, Joint, JointAngles, JointId, Motor, PublishedChain, Range,
    Robot, SideLayout, StudySetup, bounds, check_limbs,
};
use prone_files::FileError;
use prone_files::names::{NameKind, UnknownName};
use prone_files::robot_file::{
    ChainTable, ContactTable, DriveTable, FixedArmTable, MotorTable, Name, Number, PublishedTable,
    RobotFile, SideTable, StudyTable,
};

use super::lookup::Lookup;
use super::model::Parts;
use super::{control, imu, limbs};

impl Lookup<'_> {
    pub(super) fn assemble(&self, table: RobotFile, mut parts: Parts) -> Result<Robot, FileError> {
        self.group_bodies(&table.contacts, &mut parts)?;
        let shared_motors = self.equip_joints(&table.drives, &table.motors, &mut parts)?;
        let coupled_limits = control::coupled_limits(self, &table.coupled_limits, &parts.joints)?;
        let chain = self.chain(&table.chain, &parts)?;
        let study = self.study(&table.study, &table.postures, &parts)?;
        let imu = table.imu.as_ref();
        let imu = imu.map(|imu| imu::read(self, imu, &parts)).transpose()?;
        let standing_height = table
            .standing_height_mm
            .as_ref()
            .map(|mm| self.length(mm, "standing_height_mm", *mm.get_ref()))
            .transpose()?;
        let lying_length_mm = &table.pictures.lying_length_mm;
        let robot = Robot {
            name: table.name.into_inner(),
            standing_height,
            chain,
            study,
            imu,
            control: control::read(self, &table.control)?,
            search: control::search(self, &table.search)?,
            lying_length: self.length(
                lying_length_mm,
                "lying_length_mm",
                *lying_length_mm.get_ref(),
            )?,
            postures: self.postures(&table.postures, &parts.joints)?,
            bodies: parts.bodies,
            joints: parts.joints,
            shared_motors,
            coupled_limits,
            shapes: parts.shapes,
        };
        check_limbs(&robot).map_err(|error| {
            let (place, message) = limbs::misplaced(&error, &table.chain);
            self.error(place, message)
        })?;
        // The chain must be a sagittal one and its arm projectable, or nothing else works.
        mapping::check_kinematics(&robot)
            .map_err(|error| self.error(place_of(&error, &table.chain), error))?;
        Ok(robot)
    }

    fn group_bodies(&self, contacts: &ContactTable, parts: &mut Parts) -> Result<(), FileError> {
        let groups = [
            (ContactGroup::Toe, &contacts.toe),
            (ContactGroup::Elbow, &contacts.elbow),
            (ContactGroup::Torso, &contacts.torso),
            (ContactGroup::Leg, &contacts.leg),
            (ContactGroup::Head, &contacts.head),
            (ContactGroup::Hand, &contacts.hand),
        ];
        let mut seen = vec![false; parts.bodies.len()];
        for (group, names) in groups {
            for name in names {
                let id = self.body(name, &parts.bodies)?;
                if std::mem::replace(&mut seen[id.0], true) {
                    let again = format!("body {} is in [contacts] twice", name.get_ref());
                    return Err(self.error(name, again));
                }
                parts.bodies[id.0].contact_group = group;
            }
        }
        let missing = seen.iter().position(|seen| !seen);
        match (missing, contacts.toe.first()) {
            (None, Some(_)) => Ok(()),
            (None, None) => Err(self.nowhere("[contacts] has no toe")),
            (Some(index), _) => Err(self.nowhere(&format!(
                "body {} of {} is in no group of [contacts]",
                parts.bodies[index].name, self.mjcf
            ))),
        }
    }

    /// An error that belongs to the file as a whole.
    fn nowhere(&self, message: &str) -> FileError {
        FileError {
            file: self.file.to_owned(),
            line: 1,
            column: 1,
            message: message.to_owned(),
        }
    }

    /// Gives every joint its drive; returns the joints that share a motor.
    fn equip_joints(
        &self,
        drives: &[DriveTable],
        motors: &BTreeMap<Name, MotorTable>,
        parts: &mut Parts,
    ) -> Result<Vec<Vec<JointId>>, FileError> {
        let mut seen = vec![false; parts.joints.len()];
        let mut shared = Vec::new();
        for drive in drives {
            if drive.one_motor {
                shared.extend(self.share_motor(drive, parts)?);
            }
            for name in &drive.joints {
                let id = self.joint(name, &parts.joints)?;
                if std::mem::replace(&mut seen[id.0], true) {
                    let again = format!("joint {} is in [[drives]] twice", name.get_ref());
                    return Err(self.error(name, again));
                }
                let joint = &mut parts.joints[id.0];
                let number = |what, value: &Number, largest| {
                    self.positive(value, what, *value.get_ref(), largest)
                };
                joint.effort_limit = number("effort_nm", &drive.effort_nm, bounds::EFFORT)?;
                joint.speed_limit = number("speed_rad_s", &drive.speed_rad_s, bounds::SPEED)?;
                joint.servo_stiffness = number(
                    "servo_stiffness_nm_rad",
                    &drive.servo_stiffness_nm_rad,
                    bounds::STIFFNESS,
                )?;
                joint.motor = self.motor(drive, motors)?;
                check_speed(joint).map_err(|too_fast| self.error(&drive.speed_rad_s, too_fast))?;
            }
        }
        match seen.iter().position(|seen| !seen) {
            None => Ok(shared),
            Some(index) => Err(self.nowhere(&format!(
                "joint {} of {} is in no [[drives]]",
                parts.joints[index].name, self.mjcf
            ))),
        }
    }

    /// The joints of a drive with one motor, in the model's order; nothing of a single joint.
    fn share_motor(
        &self,
        drive: &DriveTable,
        parts: &Parts,
    ) -> Result<Option<Vec<JointId>>, FileError> {
        let mut joints = Vec::new();
        for name in &drive.joints {
            joints.push(self.joint(name, &parts.joints)?);
        }
        let Some(first) = joints.first() else {
            return Ok(None);
        };
        let mut moved = vec![*first];
        while let Some(next) = parts.tied.iter().find_map(|tie| tied_to(&moved, *tie)) {
            moved.push(next);
        }
        let loose = joints.iter().position(|joint| !moved.contains(joint));
        if let Some(index) = loose {
            let message = format!(
                "one_motor: no equality of {} keeps joint {} at the angle of {}",
                self.mjcf,
                drive.joints[index].get_ref(),
                drive.joints[0].get_ref(),
            );
            return Err(self.error(&drive.joints[index], message));
        }
        joints.sort_unstable();
        Ok((joints.len() > 1).then_some(joints))
    }

    fn motor(
        &self,
        drive: &DriveTable,
        motors: &BTreeMap<Name, MotorTable>,
    ) -> Result<Option<Motor>, FileError> {
        let Some(name) = &drive.motor else {
            return Ok(None);
        };
        let mut named = motors.iter();
        let Some((_, motor)) = named.find(|(motor, _)| motor.get_ref() == name.get_ref()) else {
            let known = motors.keys().map(|motor| motor.get_ref().as_str());
            let unknown = UnknownName::new(NameKind::Motor, name.get_ref(), known);
            return Err(self.error(name, unknown.within("[motors]")));
        };
        let Some(ratio) = &drive.ratio else {
            return Err(self.error(name, "a drive with a motor needs its ratio"));
        };
        let ratio = self.positive(ratio, "ratio", *ratio.get_ref(), bounds::RATIO)?;
        let at_joint = |what, millis: &Number| {
            let largest = bounds::SHAFT_TORQUE * 1e3;
            let shaft = self.positive(millis, what, *millis.get_ref(), largest)?;
            Ok::<_, FileError>(shaft * 1e-3 * ratio)
        };
        let no_load_speed = |rpm: &Number| {
            let rpm = self.positive(rpm, "no_load_rpm", *rpm.get_ref(), bounds::SHAFT_SPEED)?;
            Ok::<_, FileError>(rpm * TAU / 60.0 / ratio)
        };
        Ok(Some(Motor {
            ratio,
            nominal: at_joint("nominal_mnm", &motor.nominal_mnm)?,
            stall: at_joint("stall_mnm", &motor.stall_mnm)?,
            no_load_speed: motor.no_load_rpm.as_ref().map(no_load_speed).transpose()?,
        }))
    }

    fn chain(&self, table: &ChainTable, parts: &Parts) -> Result<ChainLayout, FileError> {
        let place = &table.left.toe;
        let (span, arm) = (&table.span_mm, &table.projected_upper_arm_mm);
        let published = table.published.as_ref();
        let fixed_arm = table.fixed_arm.as_ref();
        Ok(ChainLayout {
            left: self.side(&table.left, parts)?,
            right: self.side(&table.right, parts)?,
            span: self.length(span, "span_mm", *span.get_ref())?,
            projected_upper_arm: self.length(arm, "projected_upper_arm_mm", *arm.get_ref())?,
            published: published
                .map(|table| self.published(place, table))
                .transpose()?,
            fixed_arm: fixed_arm
                .map(|table| self.fixed_arm(place, table))
                .transpose()?,
        })
    }

    fn fixed_arm(&self, place: &Name, table: &FixedArmTable) -> Result<FixedArm, FileError> {
        let angle = |degrees| self.angle(place, "every one of forearm_deg", degrees);
        let [upper, lower] = table.forearm_deg;
        Ok(FixedArm {
            shoulder_roll: self.angle(place, "shoulder_roll_deg", table.shoulder_roll_deg)?,
            forearm: [angle(upper)?, angle(lower)?],
        })
    }

    fn published(&self, place: &Name, table: &PublishedTable) -> Result<PublishedChain, FileError> {
        for length in table.links_mm {
            self.length(place, "every one of links_mm", length)?;
        }
        let span = self.length(place, "span_mm", table.span_mm)?;
        let [l1, l2, l3, l4, l5] = table.links_mm.map(|mm| mm * 1e-3);
        Ok(PublishedChain {
            chain: ClosedChain {
                toe_to_ankle: l1,
                ankle_to_knee: l2,
                knee_to_hip: l3,
                hip_to_shoulder: l4,
                shoulder_to_elbow: l5,
                span,
            },
            ankle_offset: self.angle(place, "ankle_offset_deg", table.ankle_offset_deg)?,
            shoulder_roll: self.angle(place, "shoulder_roll_deg", table.shoulder_roll_deg)?,
        })
    }

    fn side(&self, table: &SideTable, parts: &Parts) -> Result<SideLayout, FileError> {
        let direction = DVec3::from_array(table.forearm_direction);
        let is_unit = (direction.length() - 1.0).abs() < bounds::UNIT;
        if !is_unit {
            let message = format!("forearm_direction {direction} is not a unit vector");
            return Err(self.error(&table.elbow, message));
        }
        let joint = |name| self.joint(name, &parts.joints);
        let [upper, lower] = &table.forearm;
        Ok(SideLayout {
            toe: self.site(&table.toe, parts)?.at,
            ankle: joint(&table.ankle)?,
            knee: joint(&table.knee)?,
            hip: joint(&table.hip)?,
            shoulder: joint(&table.shoulder)?,
            shoulder_roll: joint(&table.shoulder_roll)?,
            elbow: self.site(&table.elbow, parts)?.at,
            forearm: [joint(upper)?, joint(lower)?],
            forearm_direction: direction,
        })
    }

    fn study(
        &self,
        table: &StudyTable,
        postures: &BTreeMap<Name, BTreeMap<Name, f64>>,
        parts: &Parts,
    ) -> Result<StudySetup, FileError> {
        let start = &table.start_posture;
        let known = || postures.keys().map(|name| name.get_ref().as_str());
        if !known().any(|name| name == start.get_ref()) {
            let unknown = UnknownName::new(NameKind::Posture, start.get_ref(), known());
            return Err(self.error(start, unknown.within("[postures]")));
        }
        let mut stops = Vec::new();
        for (name, &[lower, upper]) in &table.stops_rad {
            let id = self.joint(name, &parts.joints)?;
            stops.push((id, self.range(name, Range { lower, upper })?));
        }
        Ok(StudySetup {
            start_posture: start.get_ref().clone(),
            stops,
        })
    }

    fn postures(
        &self,
        table: &BTreeMap<Name, BTreeMap<Name, f64>>,
        model_joints: &[Joint],
    ) -> Result<BTreeMap<String, JointAngles>, FileError> {
        let mut postures = BTreeMap::new();
        for (posture, joints) in table {
            let mut angles = JointAngles::from_fn(model_joints.len(), |_| 0.0);
            for (name, &angle) in joints {
                let id = self.joint(name, model_joints)?;
                if angle.is_nan() || angle.abs() > bounds::ANGLE {
                    let joint = name.get_ref();
                    let message = format!("{joint} must be within -2π..2π rad, not {angle}");
                    return Err(self.error(name, message));
                }
                angles[id] = angle;
            }
            postures.insert(posture.get_ref().clone(), angles);
        }
        Ok(postures)
    }
}

/// What a tie adds to joints that move together.
fn tied_to(moved: &[JointId], [one, other]: [JointId; 2]) -> Option<JointId> {
    match (moved.contains(&one), moved.contains(&other)) {
        (true, false) => Some(other),
        (false, true) => Some(one),
        _ => None,
    }
}

/// The name in the file that a refused chain is about.
fn place_of<'a>(error: &MappingError, table: &'a ChainTable) -> &'a Name {
    let MappingError::DoesNotClose { side, point, .. } = error else {
        return &table.left.toe;
    };
    let table = if *side == "left" {
        &table.left
    } else {
        &table.right
    };
    match *point {
        "ankle" => &table.ankle,
        "knee" => &table.knee,
        "hip" => &table.hip,
        "shoulder" => &table.shoulder,
        "elbow" => &table.elbow,
        _ => &table.toe,
    }
}
