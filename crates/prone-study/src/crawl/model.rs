//! What a replay needs to draw robot and scene, and a robot's URDF its bodies and shapes:
//! `model.json`.

use glam::{DQuat, DVec3};
use serde_json::{Value, json};

use prone::frames::{Link, Point};
use prone::robot::{BodyId, Robot, SideLayout};
use prone_sim::World;

use prone::scene::obstacle_name;

/// Describes bodies, shapes and obstacles of a world in metres; rotations are quaternions, real part
/// first.
pub(super) fn describe(world: &World) -> Value {
    let robot = world.robot();
    json!({
        "units": {
            "length": "m",
            "angle": "rad",
            "quaternion": "w, x, y, z",
            "axes": "x forward, y left, z up; z = 0 is the floor",
        },
        "robot": robot.name,
        "mass_kg": robot.mass(),
        "bodies": robot.bodies.iter().zip(world.inertia_views()).map(|(body, inertia)| {
            let pose = &body.parent_from_body;
            json!({
                "name": body.name,
                "parent": body.parent.map(|BodyId(parent)| parent),
                "position": pose.origin().metres().to_array(),
                "quaternion": real_first(pose.rotation()),
                "joint": body.joint.map(|joint| {
                    let joint = &robot.joints[joint.0];
                    json!({
                        "name": joint.name,
                        "axis": joint.axis.to_array(),
                        "anchor": joint.anchor.metres().to_array(),
                        "range": [joint.range.lower, joint.range.upper],
                    })
                }),
                "mass": body.mass,
                "inertia": {
                    "principal": inertia.principal.to_array(),
                    "quaternion": real_first(inertia.rotation),
                },
                "centre_of_mass": body.centre_of_mass.metres().to_array(),
                "contact_group": body.contact_group.name(),
                "head": body.is_head(),
            })
        }).collect::<Vec<_>>(),
        "shapes": world.shape_views().into_iter().map(|shape| json!({
            "body": shape.body.0,
            "type": shape.kind,
            "size": shape.size,
            "position": shape.position.to_array(),
            "quaternion": real_first(shape.rotation),
            "rgba": shape.colour,
            "group": shape.group,
            "collides": shape.collides,
        })).collect::<Vec<_>>(),
        "chain": {
            "left": side(robot, &robot.chain.left),
            "right": side(robot, &robot.chain.right),
        },
        "obstacles": world.obstacles().iter().enumerate().map(|(index, obstacle)| json!({
            "name": obstacle_name(world.obstacles(), index),
            "kind": obstacle.kind.name(),
            "half_edges": obstacle.half_edges.to_array(),
            "position": obstacle.ground_from_box.origin().metres().to_array(),
            "quaternion": real_first(obstacle.ground_from_box.rotation()),
        })).collect::<Vec<_>>(),
        "marker": world.scene().marker.map(|marker| json!({
            "position": marker.position.metres().to_array(),
            "radius": marker.radius,
            "facing": marker.facing,
        })),
        "rough": world.scene().floor.roughness.as_ref().map(|rough| {
            let heights = rough.heights();
            json!({
                "from_x": rough.from_x,
                "length": rough.length,
                "width": rough.width,
                "rows": heights.rows,
                "columns": heights.columns,
                "heights": heights.metres,
            })
        }),
        "slope": world.scene().floor.slope,
    })
}

/// Joints and points of a side's chain, toe to elbow.
fn side(robot: &Robot, side: &SideLayout) -> Value {
    let name = |joint: prone::robot::JointId| robot.joints[joint.0].name.clone();
    let site = |(body, point): (BodyId, Point<Link>)| {
        let at: DVec3 = point.metres();
        json!({ "body": body.0, "position": at.to_array() })
    };
    json!({
        "toe": site(side.toe),
        "ankle": name(side.ankle),
        "knee": name(side.knee),
        "hip": name(side.hip),
        "shoulder": name(side.shoulder),
        "shoulder_roll": name(side.shoulder_roll),
        "elbow": site(side.elbow),
        "forearm": side.forearm.map(name),
    })
}

const fn real_first(turn: DQuat) -> [f64; 4] {
    [turn.w, turn.x, turn.y, turn.z]
}
