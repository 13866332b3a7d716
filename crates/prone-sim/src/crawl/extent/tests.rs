use prone::frames::Transform;
use prone::gait::cycle::TimeScale;
use prone::regime::Regime;
use prone_files::shipped;

use super::*;
use crate::crawl::{CrawlPlan, Detail, End, OnTouch, run};
use crate::{LoadedRobot, RobotFiles};

fn nao() -> World {
    let loaded = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
    World::new(&loaded, Regime::LOCOMOTION).unwrap()
}

/// On its belly with its head ahead, turned to the left by an angle, rad, and moved.
fn prone_root(yaw: f64, place: DVec3) -> Transform<Ground, Root> {
    let lying = glam::DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2);
    let turned = glam::DQuat::from_rotation_z(yaw) * lying;
    Transform::<Ground, Root>::new(turned, place)
}

/// With every joint at zero the upper arms are 98 mm from the middle, their shapes 12 mm further
/// out, and 27 mm thick; elbows and hands are nearer, at 98 + 15 + 29 mm: 142 mm a side.
#[test]
fn limit_the_width_of_the_zero_posture() {
    let world = nao();
    let robot = world.robot();
    let zero = JointAngles::zero(robot);
    for (yaw, place) in [
        (0.0, DVec3::ZERO),
        (0.7, DVec3::new(3.0, -2.0, 0.1)),
        (-2.0, DVec3::new(-1.0, 5.0, 0.0)),
    ] {
        let root = prone_root(yaw, place);
        let poses = robot.forward_kinematics(root, &zero);
        let sides = Sides::from_poses(robot, &poses, &root);
        for side in [sides.left, sides.right] {
            assert!((side - 0.142).abs() < 1e-9, "{yaw}: {sides:?}");
        }
    }
}

/// An arm that is spread widens its own side alone.
#[test]
fn limit_a_spread_arm_widens_its_side() {
    let world = nao();
    let robot = world.robot();
    let mut posture = JointAngles::zero(robot);
    posture[robot.joint("LShoulderRoll").unwrap()] = 1.0;
    let root = prone_root(0.3, DVec3::new(1.0, 1.0, 0.0));
    let poses = robot.forward_kinematics(root, &posture);
    let sides = Sides::from_poses(robot, &poses, &root);
    assert!(sides.left > 0.25, "{sides:?}");
    assert!((sides.right - 0.142).abs() < 1e-9, "{sides:?}");
    let mut widest = Sides::NONE;
    widest.widen(sides);
    widest.widen(Sides {
        left: 0.0,
        right: 0.2,
    });
    assert!((widest.width() - sides.left - 0.2).abs() < 1e-12);
}

#[test]
fn identity_a_crawl_and_its_rows_say_the_same() {
    let world = nao();
    let plan = CrawlPlan {
        cycles: vec![shipped::cycle("hip-10").unwrap().unwrap()],
        scale: TimeScale::ONE,
        end: End::Cycles(1),
        on_touch: OnTouch::GoOn,
        offsets: None,
        late: None,
        imu_seed: None,
        detail: Detail::Rows,
    };
    let crawl = run(&world, &plan, prone::crawl::Straight::default()).unwrap();
    let mut collision = SelfCollision::new(&world).unwrap();
    let rows = collision.scan(crawl.rows.iter().map(|row| &row.angles));
    let rows = rows.unwrap();
    let nearest = crawl.nearest.unwrap();
    assert_eq!(nearest.shapes, rows.shapes);
    assert!((nearest.distance_m - rows.distance_m).abs() < 1e-12);
    assert!((nearest.time - crawl.rows[rows.index].time).abs() < 1e-12);
    let robot = world.robot();
    let mut sides = Sides::NONE;
    for row in &crawl.rows {
        let poses = robot.forward_kinematics(row.ground_from_root, &row.angles);
        sides.widen(Sides::from_poses(robot, &poses, &row.ground_from_root));
    }
    // Poses of the engine and of this program's own kinematics.
    assert!((sides.width() - crawl.sides.width()).abs() < 1e-9);
}
