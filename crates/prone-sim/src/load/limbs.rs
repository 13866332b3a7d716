//! Whether the joints and sites of the chain follow one another along the limbs.
//!
//! A name in the wrong place often still gives some chain. So each joint has one part, lies
//! beyond the one before it on the way from the trunk to toe or forearm, and is on its own side.

use glam::DVec3;

use prone::frames::{Link, Point, Root, Transform};
use prone::robot::{BodyId, JointAngles, JointId, Robot, SideLayout};
use prone_files::robot_file::{ChainTable, Name, SideTable};

/// A name in the wrong place, and why.
pub(super) type Misplaced<'a> = (&'a Name, String);

/// Something of the chain that `robot.toml` names.
struct Part<'a> {
    what: &'static str,
    name: &'a Name,
    body: BodyId,
}

pub(super) fn check<'a>(robot: &Robot, table: &'a ChainTable) -> Result<(), Misplaced<'a>> {
    let sides = [("left", &table.left), ("right", &table.right)];
    check_distinct(&sides)?;
    for ((_, table), layout) in sides.iter().zip(robot.chain.sides()) {
        check_order(robot, &leg(robot, table, layout))?;
        check_order(robot, &arm(robot, table, layout))?;
        check_order(robot, &forearm(robot, table, layout))?;
    }
    check_sides(robot, table)
}

fn joints(table: &SideTable) -> [(&'static str, &Name); 7] {
    [
        ("ankle", &table.ankle),
        ("knee", &table.knee),
        ("hip", &table.hip),
        ("shoulder", &table.shoulder),
        ("shoulder_roll", &table.shoulder_roll),
        ("upper forearm", &table.forearm[0]),
        ("lower forearm", &table.forearm[1]),
    ]
}

fn check_distinct<'a>(sides: &[(&'static str, &'a SideTable); 2]) -> Result<(), Misplaced<'a>> {
    let mut seen: Vec<(&str, &str, &Name)> = Vec::new();
    for (side, table) in sides {
        for (what, name) in joints(table) {
            if let Some((side, what, _)) = seen.iter().find(|(.., other)| *other == name) {
                let message = format!("joint {} is the {side} {what} already", name.get_ref());
                return Err((name, message));
            }
            seen.push((side, what, name));
        }
    }
    Ok(())
}

fn leg<'a>(robot: &Robot, table: &'a SideTable, layout: &SideLayout) -> [Part<'a>; 4] {
    [
        joint(robot, "hip", &table.hip, layout.hip),
        joint(robot, "knee", &table.knee, layout.knee),
        joint(robot, "ankle", &table.ankle, layout.ankle),
        site("toe", &table.toe, layout.toe),
    ]
}

fn arm<'a>(robot: &Robot, table: &'a SideTable, layout: &SideLayout) -> [Part<'a>; 3] {
    let roll = &table.shoulder_roll;
    [
        joint(robot, "shoulder", &table.shoulder, layout.shoulder),
        joint(robot, "shoulder_roll", roll, layout.shoulder_roll),
        site("elbow", &table.elbow, layout.elbow),
    ]
}

fn forearm<'a>(robot: &Robot, table: &'a SideTable, layout: &SideLayout) -> [Part<'a>; 3] {
    let ([upper, lower], ids) = (&table.forearm, layout.forearm);
    let roll = &table.shoulder_roll;
    [
        joint(robot, "shoulder_roll", roll, layout.shoulder_roll),
        joint(robot, "upper forearm joint", upper, ids[0]),
        joint(robot, "lower forearm joint", lower, ids[1]),
    ]
}

fn joint<'a>(robot: &Robot, what: &'static str, name: &'a Name, id: JointId) -> Part<'a> {
    let body = robot.joints[id.0].body;
    Part { what, name, body }
}

fn site<'a>(what: &'static str, name: &'a Name, (body, _): (BodyId, Point<Link>)) -> Part<'a> {
    Part { what, name, body }
}

/// The joints are distinct, so each moves another body; a site may be on the last one's.
fn check_order<'a>(robot: &Robot, parts: &[Part<'a>]) -> Result<(), Misplaced<'a>> {
    for pair in parts.windows(2) {
        let [inner, outer] = pair else { continue };
        if !hangs_on(robot, outer.body, inner.body) {
            let message = format!(
                "{} {} does not hang on {} {}",
                outer.what,
                outer.name.get_ref(),
                inner.what,
                inner.name.get_ref()
            );
            return Err((outer.name, message));
        }
    }
    Ok(())
}

/// Whether `body` is `ancestor` or moves with it.
fn hangs_on(robot: &Robot, body: BodyId, ancestor: BodyId) -> bool {
    let mut next = Some(body);
    while let Some(id) = next {
        if id == ancestor {
            return true;
        }
        next = robot.bodies[id.0].parent;
    }
    false
}

/// y is to the left.
fn check_sides<'a>(robot: &Robot, table: &'a ChainTable) -> Result<(), Misplaced<'a>> {
    let poses = robot.forward_kinematics(
        Transform::<Root, Root>::translation(DVec3::ZERO),
        &JointAngles::zero(robot),
    );
    let sideways = |id: JointId| {
        let joint = &robot.joints[id.0];
        poses.point((joint.body, joint.anchor)).metres().y
    };
    let [left, right] = robot.chain.sides();
    for (left, right, name, other) in [
        (left.hip, right.hip, &table.left.hip, &table.right.hip),
        (
            left.shoulder,
            right.shoulder,
            &table.left.shoulder,
            &table.right.shoulder,
        ),
    ] {
        if sideways(left) <= sideways(right) {
            let (name_text, other) = (name.get_ref(), other.get_ref());
            let message = format!("{name_text} of [chain.left] is not to the left of {other}");
            return Err((name, message));
        }
    }
    Ok(())
}
