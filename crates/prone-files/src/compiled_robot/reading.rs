//! From a document to a robot: names become places, numbers keep to the bounds of the text formats,
//! and the chain is one that can crawl.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

use glam::DVec3;

use prone::frames::{Link, Transform};
use prone::mapping;
use prone::robot::{
    Body, BodyId, ContactGroup, Imu, Joint, JointAngles, JointId, Motor, Robot, SensorNoise, Shape,
    Solid, StudySetup, bounds, check_limbs,
};

use super::document::{
    BodyDocument, ContactGroupName, ImuDocument, JointDocument, MotorDocument, NoiseDocument,
    PostureDocument, RobotDocument, ShapeDocument, SolidDocument, StudyDocument,
};
use super::names::Names;
use super::place::{Place, Violation};
use super::{chain, control};

/// More bodies, and so more joints, than any robot has.
const MOST_BODIES: usize = 10_000;
/// More shapes than any robot has.
const MOST_SHAPES: usize = 10_000;
/// More postures than anybody lists.
const MOST_POSTURES: usize = 1_000;

impl RobotDocument {
    /// The robot, checked: what loads can crawl.
    ///
    /// # Errors
    /// [`Violation`], the first one, with its place below `root`, the key that this document has in
    /// the text around it.
    pub fn robot(&self, root: &'static str) -> Result<Robot, Violation> {
        let Self {
            name,
            standing_height_m,
            bodies,
            joints,
            shapes,
            chain,
            postures,
            study,
            imu,
            control,
            search,
            lying_length_m,
        } = self;
        let place = Place::root(root);
        let [body_place, joint_place, shape_place, posture_place] =
            ["bodies", "joints", "shapes", "postures"].map(|key| place.key(key));
        body_place.count(bodies.len(), MOST_BODIES)?;
        joint_place.count(joints.len(), MOST_BODIES)?;
        shape_place.count(shapes.len(), MOST_SHAPES)?;
        posture_place.count(postures.len(), MOST_POSTURES)?;
        check_distinct(body_place, bodies.iter().map(|it| it.name.as_str()))?;
        check_distinct(joint_place, joints.iter().map(|it| it.name.as_str()))?;
        check_distinct(shape_place, shapes.iter().map(|it| it.name.as_str()))?;
        check_distinct(posture_place, postures.iter().map(|it| it.name.as_str()))?;

        let names = Names::of(bodies, joints);
        let height_place = place.key("standing_height_m");
        let robot = Robot {
            name: place.key("name").name(name)?,
            standing_height: standing_height_m
                .map(|height| height_place.positive(height, bounds::LENGTH))
                .transpose()?,
            bodies: each(body_place, bodies, |place, index, it| {
                body(place, index, it, &names)
            })?,
            joints: each(joint_place, joints, |place, _, it| joint(place, it, &names))?,
            shapes: each(shape_place, shapes, |place, _, it| shape(place, it, &names))?,
            chain: chain::read(place.key("chain"), chain, &names)?,
            postures: read_postures(posture_place, postures, joints.len())?,
            study: read_study(place.key("study"), study, &names)?,
            imu: imu
                .as_ref()
                .map(|imu| read_imu(place.key("imu"), imu))
                .transpose()?,
            control: control::read(place.key("control"), control)?,
            search: control::read_search(place.key("search"), search)?,
            lying_length: place
                .key("lying_length_m")
                .positive(*lying_length_m, bounds::LENGTH)?,
        };
        check_whole(place, &robot)?;
        Ok(robot)
    }
}

/// The elements of an array, each with its place.
fn each<D, T>(
    place: Place<'_>,
    documents: &[D],
    read: impl Fn(Place<'_>, usize, &D) -> Result<T, Violation>,
) -> Result<Vec<T>, Violation> {
    let documents = documents.iter().enumerate();
    documents
        .map(|(index, document)| read(place.index(index), index, document))
        .collect()
}

fn check_distinct<'a>(
    place: Place<'_>,
    names: impl Iterator<Item = &'a str>,
) -> Result<(), Violation> {
    let mut seen = BTreeSet::new();
    for (index, name) in names.enumerate() {
        if !seen.insert(name) {
            let place = place.index(index);
            let place = place.key("name");
            return Err(place.violation(format!("{name:?} is there twice")));
        }
    }
    Ok(())
}

fn body(
    place: Place<'_>,
    index: usize,
    document: &BodyDocument,
    names: &Names<'_>,
) -> Result<Body, Violation> {
    let BodyDocument {
        name,
        parent,
        parent_from_body,
        joint,
        mass_kg,
        centre_of_mass_m,
        contact_group,
        is_head,
    } = document;
    let parent_place = place.key("parent");
    let parent = match parent {
        None if index == 0 => None,
        None => return Err(parent_place.violation("only the first body is the root")),
        Some(name) => Some(parent_of(parent_place, name, index, names)?),
    };
    let pose = place
        .key("parent_from_body")
        .pose::<Link, Link>(parent_from_body)?;
    if parent.is_none() && pose != Transform::translation(DVec3::ZERO) {
        let place = place.key("parent_from_body");
        return Err(place.violation("the root has no parent to be moved or turned in"));
    }
    let joint_place = place.key("joint");
    let joint = match joint {
        None => None,
        Some(joint) if parent.is_none() => {
            return Err(
                joint_place.violation(format!("the root floats and is not moved by {joint:?}"))
            );
        }
        Some(joint) => Some(names.joint_that_moves(joint_place, joint, name)?),
    };
    Ok(Body {
        name: place.key("name").name(name)?,
        parent,
        parent_from_body: pose,
        joint,
        mass: place.key("mass_kg").within(*mass_kg, 0.0..=bounds::MASS)?,
        centre_of_mass: place.key("centre_of_mass_m").point(*centre_of_mass_m)?,
        contact_group: match contact_group {
            ContactGroupName::Toe => ContactGroup::Toe,
            ContactGroupName::Elbow => ContactGroup::Elbow,
            ContactGroupName::Torso => ContactGroup::Torso,
            ContactGroupName::Leg => ContactGroup::Leg,
        },
        is_head: *is_head,
    })
}

/// Parents come before their children, so there is no circle.
fn parent_of(
    place: Place<'_>,
    name: &str,
    child: usize,
    names: &Names<'_>,
) -> Result<BodyId, Violation> {
    let parent = names.body(place, name)?;
    if parent.0 < child {
        return Ok(parent);
    }
    Err(place.violation(format!("{name:?} does not come before its child")))
}

fn joint(
    place: Place<'_>,
    document: &JointDocument,
    names: &Names<'_>,
) -> Result<Joint, Violation> {
    let JointDocument {
        name,
        body,
        axis,
        anchor_m,
        range_rad,
        effort_limit_nm,
        speed_limit_rad_s,
        servo_gain_nms,
        motor,
    } = document;
    let motor_place = place.key("motor");
    let motor = motor
        .as_ref()
        .map(|motor| read_motor(motor_place, motor))
        .transpose()?;
    Ok(Joint {
        name: place.key("name").name(name)?,
        body: names.body_moved_by(place.key("body"), body, name)?,
        axis: place.key("axis").direction(*axis)?,
        anchor: place.key("anchor_m").point(*anchor_m)?,
        range: place.key("range_rad").range(*range_rad, bounds::NUMBER)?,
        effort_limit: place
            .key("effort_limit_nm")
            .positive(*effort_limit_nm, bounds::EFFORT)?,
        speed_limit: place
            .key("speed_limit_rad_s")
            .positive(*speed_limit_rad_s, bounds::SPEED)?,
        servo_gain: place
            .key("servo_gain_nms")
            .positive(*servo_gain_nms, bounds::GAIN)?,
        motor,
    })
}

/// The bounds are those of the motor's shaft, behind the gear.
fn read_motor(place: Place<'_>, document: &MotorDocument) -> Result<Motor, Violation> {
    let MotorDocument {
        ratio,
        nominal_nm,
        stall_nm,
        no_load_speed_rad_s,
    } = document;
    let ratio = place.key("ratio").positive(*ratio, bounds::RATIO)?;
    let torque = bounds::SHAFT_TORQUE * ratio;
    let speed = bounds::SHAFT_SPEED * TAU / 60.0 / ratio;
    let speed_place = place.key("no_load_speed_rad_s");
    Ok(Motor {
        ratio,
        nominal: place.key("nominal_nm").positive(*nominal_nm, torque)?,
        stall: place.key("stall_nm").positive(*stall_nm, torque)?,
        no_load_speed: no_load_speed_rad_s
            .map(|value| speed_place.positive(value, speed))
            .transpose()?,
    })
}

fn shape(
    place: Place<'_>,
    document: &ShapeDocument,
    names: &Names<'_>,
) -> Result<Shape, Violation> {
    let ShapeDocument {
        name,
        body,
        link_from_geom,
        solid,
    } = document;
    Ok(Shape {
        name: place.key("name").name(name)?,
        body: names.body(place.key("body"), body)?,
        link_from_geom: place.key("link_from_geom").pose(link_from_geom)?,
        solid: read_solid(place.key("solid"), solid)?,
    })
}

fn read_solid(place: Place<'_>, document: &SolidDocument) -> Result<Solid, Violation> {
    let length = |place: Place<'_>, key, value: &f64| {
        let place = place.key(key);
        place.positive(*value, bounds::LENGTH)
    };
    Ok(match document {
        SolidDocument::Sphere { radius_m } => Solid::Sphere {
            radius: length(place.key("sphere"), "radius_m", radius_m)?,
        },
        SolidDocument::Capsule {
            radius_m,
            half_length_m,
        } => Solid::Capsule {
            radius: length(place.key("capsule"), "radius_m", radius_m)?,
            half_length: length(place.key("capsule"), "half_length_m", half_length_m)?,
        },
        SolidDocument::Ellipsoid { half_axes_m } => Solid::Ellipsoid {
            half_axes: place
                .key("ellipsoid")
                .key("half_axes_m")
                .lengths(*half_axes_m)?,
        },
        SolidDocument::Cylinder {
            radius_m,
            half_length_m,
        } => Solid::Cylinder {
            radius: length(place.key("cylinder"), "radius_m", radius_m)?,
            half_length: length(place.key("cylinder"), "half_length_m", half_length_m)?,
        },
        SolidDocument::Cuboid { half_edges_m } => Solid::Cuboid {
            half_edges: place
                .key("cuboid")
                .key("half_edges_m")
                .lengths(*half_edges_m)?,
        },
    })
}

fn read_postures(
    place: Place<'_>,
    documents: &[PostureDocument],
    joints: usize,
) -> Result<BTreeMap<String, JointAngles>, Violation> {
    let postures = each(place, documents, |place, _, document| {
        let PostureDocument { name, angles_rad } = document;
        let angles_place = place.key("angles_rad");
        if angles_rad.len() != joints {
            let given = angles_rad.len();
            return Err(angles_place.violation(format!("{given} angles for {joints} joints")));
        }
        let name = place.key("name").name(name)?;
        let angles = JointAngles::try_from_fn(joints, |JointId(index)| {
            angles_place.index(index).angle(angles_rad[index])
        })?;
        Ok((name, angles))
    })?;
    Ok(postures.into_iter().collect())
}

fn read_study(
    place: Place<'_>,
    document: &StudyDocument,
    names: &Names<'_>,
) -> Result<StudySetup, Violation> {
    let StudyDocument {
        start_posture,
        stops,
    } = document;
    let stops_place = place.key("stops");
    let mut moved = BTreeSet::new();
    for (index, stop) in stops.iter().enumerate() {
        if !moved.insert(&stop.joint) {
            let place = stops_place.index(index);
            let place = place.key("joint");
            return Err(place.violation(format!("{:?} is there twice", stop.joint)));
        }
    }
    Ok(StudySetup {
        start_posture: start_posture.clone(),
        stops: each(stops_place, stops, |place, _, stop| {
            let joint = names.joint(place.key("joint"), &stop.joint)?;
            let range = place.key("range_rad");
            Ok((joint, range.range(stop.range_rad, bounds::ANGLE)?))
        })?,
    })
}

fn read_imu(place: Place<'_>, document: &ImuDocument) -> Result<Imu, Violation> {
    let ImuDocument {
        site,
        root_from_sensor,
        accelerometer_m_s2,
        gyroscope_rad_s,
    } = document;
    Ok(Imu {
        site: place.key("site").name(site)?,
        root_from_sensor: place.key("root_from_sensor").pose(root_from_sensor)?,
        accelerometer: read_noise(
            place.key("accelerometer_m_s2"),
            accelerometer_m_s2,
            bounds::ACCELERATION,
        )?,
        gyroscope: read_noise(
            place.key("gyroscope_rad_s"),
            gyroscope_rad_s,
            bounds::TURN_RATE,
        )?,
    })
}

fn read_noise(
    place: Place<'_>,
    document: &NoiseDocument,
    largest: f64,
) -> Result<SensorNoise, Violation> {
    let NoiseDocument {
        standard_deviation,
        bias_bound,
    } = *document;
    let deviation = place.key("standard_deviation");
    Ok(SensorNoise {
        standard_deviation: deviation.within(standard_deviation, 0.0..=largest)?,
        bias_bound: place.key("bias_bound").within(bias_bound, 0.0..=largest)?,
    })
}

/// What the parts say together.
fn check_whole(place: Place<'_>, robot: &Robot) -> Result<(), Violation> {
    let bodies = place.key("bodies");
    if robot.bodies.is_empty() {
        return Err(bodies.violation("a robot has a body"));
    }
    let mass = robot.mass();
    if mass.is_nan() || mass <= 0.0 {
        return Err(bodies.violation("the robot has no mass"));
    }
    let is_toe = |body: &Body| body.contact_group == ContactGroup::Toe;
    if !robot.bodies.iter().any(is_toe) {
        return Err(bodies.violation("no contact_group is toe"));
    }
    if robot.shapes.is_empty() {
        let shapes = place.key("shapes");
        return Err(shapes.violation("nothing can touch the floor"));
    }
    let start = &robot.study.start_posture;
    if !robot.postures.contains_key(start) {
        let study = place.key("study");
        let place = study.key("start_posture");
        return Err(place.violation(format!("{start:?} is none of the postures")));
    }
    let chain = place.key("chain");
    check_limbs(robot).map_err(|error| chain.violation(error))?;
    // The chain must be a sagittal one and its arm projectable, or nothing else works.
    mapping::check_kinematics(robot).map_err(|error| chain.violation(error))
}
