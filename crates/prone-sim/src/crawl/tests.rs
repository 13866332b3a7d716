mod balance;
mod waypoints;

use prone::crawl::{SlopeAware, Straight};
use prone::gait::cycle::CheckedCycle;
use prone::port::{Knot, Segment, Stop as _};
use prone::steering::{HeadingHold, TurnTo};
use prone_files::shipped;

use super::*;
use crate::load::{LoadedRobot, RobotFiles};
use prone::regime::Regime;

fn nao() -> LoadedRobot {
    LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap()
}

fn hold(limit: f64) -> HeadingHold {
    HeadingHold::new(nao().robot().control.steering, limit)
}

fn crawl(world: &World, cycle: &str, cycles: usize, turn: f64) -> Crawl {
    let cycles_of = vec![shipped::cycle(cycle).unwrap().unwrap()];
    let plan = CrawlPlan {
        cycles: cycles_of,
        scale: TimeScale::ONE,
        end: End::Cycles(cycles),
        offsets: None,
        late: None,
        imu_seed: None,
        on_touch: OnTouch::GoOn,
        detail: Detail::Sums,
    };
    run(world, &plan, Straight { turn }).unwrap()
}

/// The cycles of the published study and of the first prototype, which stay as they are.
#[test]
fn regression_cycles_advance_as_far_and_as_low_as_they_did() {
    let world = World::new(&nao(), Regime::LOCOMOTION).unwrap();
    // mm per cycle of the third cycle, highest point in mm: today's, rounded.
    for (name, advance, top) in [
        ("thesis-nominal", 76.1, 226.0),
        ("thesis-optimal", 97.7, 226.0),
        ("hip-10", 113.2, 177.4),
    ] {
        let crawl = crawl(&world, name, 3, 0.0);
        let forward = crawl.cycles[2].advance().forward * 1e3;
        assert!((forward - advance).abs() < 2.0, "{name}: {forward:.1} mm");
        let highest = crawl.tops.highest() * 1e3;
        assert!((highest - top).abs() < 1.0, "{name}: {highest:.1} mm");
    }
}

/// A number in the name of a cycle is the ceiling that it was made for, mm.
#[test]
fn shipped_cycles_keep_below_their_ceilings_advance_and_repeat_themselves() {
    let world = World::new(&nao(), Regime::LOCOMOTION).unwrap();
    let mut wrong = Vec::new();
    for name in shipped::cycle_names() {
        let crawl = crawl(&world, name, 3, 0.0);
        let third = &crawl.cycles[2];
        let forward = third.advance().forward * 1e3;
        if forward < 40.0 {
            wrong.push(format!("{name} advances by {forward:.1} mm"));
        }
        let number = name
            .rsplit_once('-')
            .and_then(|(_, digits)| digits.parse().ok());
        // The number of hip-10 is an angle.
        let ceiling = number.filter(|mm: &f64| *mm > 100.0);
        let highest = crawl.tops.highest() * 1e3;
        if ceiling.is_some_and(|ceiling| highest >= ceiling) {
            wrong.push(format!("{name} is {highest:.1} mm high"));
        }
        let steady = crawl.cycles[1].advance().forward * 1e3;
        // 2 mm, and more of one that goes far.
        if (steady - forward).abs() > f64::max(2.0, 0.015 * forward) {
            wrong.push(format!(
                "{name} advances by {steady:.1} and {forward:.1} mm"
            ));
        }
        // A symmetric gait, and a robot that is symmetric but for 0.18° of its ankles' limits, which
        // cycles that walk on their knees feel most: half a degree a cycle.
        let yaw = third.advance().yaw.to_degrees();
        if yaw.abs() > 0.5 {
            wrong.push(format!("{name} turns by {yaw:.2}°"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Touches are counted, and the forces of the rows are those of the ground on the robot.
#[test]
fn a_low_plate_is_touched_and_the_floor_carries_the_rest() {
    let robot = nao();
    let in_scene = |height| {
        let scene = prone::scene::Scene::under_plate(height, 0.5);
        let world = World::in_scene(&robot, Regime::LOCOMOTION, &scene).unwrap();
        let cycles = vec![shipped::cycle("hip-10").unwrap().unwrap()];
        let plan = CrawlPlan {
            cycles,
            scale: TimeScale::ONE,
            end: End::Cycles(3),
            offsets: None,
            late: None,
            imu_seed: None,
            on_touch: OnTouch::GoOn,
            detail: Detail::Rows,
        };
        run(&world, &plan, hold(0.2)).unwrap()
    };
    let free = in_scene(0.3);
    assert_eq!(free.touches, []);
    let forces = free.rows.iter().flat_map(|row| &row.forces);
    let carried = forces.map(|contact| contact.force.z).sum::<f64>() / free.rows.len() as f64;
    let weight = robot.robot().mass() * prone::statics::GRAVITY;
    // 2 %: forces of single instants, where rows are 20 ms apart.
    assert!(
        (carried / weight - 1.0).abs() < 0.02,
        "{carried} N of {weight} N"
    );

    let low = in_scene(0.13);
    assert!(!low.touches.is_empty());
    for touch in &low.touches {
        assert!(
            touch.count > 0 && touch.seconds > 0.0 && touch.peak > 0.0,
            "{touch:?}"
        );
        assert!(
            (0.0..=low.effort.seconds).contains(&touch.first),
            "{touch:?}"
        );
    }
}

#[test]
fn left_mirrors_right() {
    let robot = nao();
    let world = World::new(&robot, Regime::LOCOMOTION).unwrap();
    let turned = |degrees: f64| {
        let crawl = crawl(&world, "hip-10", 3, degrees.to_radians());
        let last = crawl.cycles[2].advance();
        (last.yaw.to_degrees(), last.forward * 1e3)
    };
    let ((left, there), (right, back)) = (turned(12.0), turned(-12.0));
    assert!(left > 6.0, "{left}° a cycle");
    assert!((left + right).abs() < 0.1 * left, "{left}° and {right}°");
    assert!((there - back).abs() < 0.1 * there, "{there} and {back} mm");
}

/// The slope that each pull feels, rad, and the cycles that were crawled.
fn felt(degrees: f64) -> (Vec<f64>, Vec<String>) {
    let robot = nao();
    let mut scene = prone::scene::Scene::level();
    scene.floor.slope = degrees.to_radians();
    let world = World::in_scene(&robot, Regime::LOCOMOTION, &scene).unwrap();
    let cycles = ["thesis-nominal", "hip-10"].map(|name| shipped::cycle(name).unwrap().unwrap());
    let cycles = cycles.to_vec();
    let plan = CrawlPlan {
        cycles,
        scale: TimeScale::ONE,
        end: End::Cycles(4),
        offsets: None,
        late: None,
        imu_seed: Some(1),
        on_touch: OnTouch::GoOn,
        detail: Detail::Sums,
    };
    let mut pilot = SlopeAware::new(Straight::default(), 4.0_f64.to_radians());
    let crawl = run(&world, &plan, &mut pilot).unwrap();
    let gaits = crawl.cycles.iter().map(|cycle| cycle.gait.clone());
    (pilot.felt().to_vec(), gaits.collect())
}

#[test]
fn a_slope_is_felt_and_only_uphill_the_other_cycle_is_taken() {
    for degrees in [-10.0, 0.0, 10.0] {
        let (slopes, gaits) = felt(degrees);
        for slope in slopes {
            let off = slope.to_degrees() - degrees;
            assert!(off.abs() < 1.5, "{off}° on a slope of {degrees}°");
        }
        let uphill = if degrees > 4.0 {
            "hip-10"
        } else {
            "thesis-nominal"
        };
        // The first cycle is begun before anything is felt.
        assert!(
            gaits[1..].iter().all(|gait| gait == uphill),
            "{degrees}°: {gaits:?}"
        );
    }
}

/// Where friction is 0.5 at the left and 0.9 at the right: how far off the line it ends, m.
fn off_the_line(cycle: &str, pilot: impl Pilot) -> f64 {
    let robot = nao();
    let mut scene = prone::scene::Scene::level();
    scene.floor.friction = Some(prone::scene::SideFriction {
        left: 0.5,
        right: 0.9,
    });
    let world = World::in_scene(&robot, Regime::LOCOMOTION, &scene).unwrap();
    let cycles = vec![shipped::cycle(cycle).unwrap().unwrap()];
    let plan = CrawlPlan {
        cycles,
        scale: TimeScale::ONE,
        end: End::Cycles(25),
        offsets: None,
        late: None,
        imu_seed: None,
        on_touch: OnTouch::GoOn,
        detail: Detail::Sums,
    };
    let crawl = run(&world, &plan, pilot).unwrap();
    crawl.cycles[24].to.y
}

#[test]
fn uneven_ground_is_held_where_open_loop_drifts_away() {
    let limit = shipped::cycle("hip-10")
        .unwrap()
        .unwrap()
        .steering
        .unwrap()
        .limit;
    let open = off_the_line("hip-10", Straight::default());
    assert!(open.abs() > 0.25, "open loop {open} m");
    let held = off_the_line("hip-10", hold(limit));
    assert!(held.abs() < 0.04, "held {held} m");
}

/// On an even floor a held heading has nothing to do: what it does there is to sway.
#[test]
fn a_held_heading_does_not_sway_on_an_even_floor() {
    let world = World::new(&nao(), Regime::LOCOMOTION).unwrap();
    let gains = world.robot().control.steering;
    let cycles = shipped::cycle_names().map(|name| shipped::cycle(name).unwrap().unwrap());
    let steered = cycles.filter_map(|cycle| Some((cycle.steering.clone()?, cycle)));
    let swaying: Vec<String> = steered
        .filter_map(|(steering, cycle)| {
            let name = cycle.name.clone();
            let plan = CrawlPlan {
                cycles: vec![cycle],
                scale: TimeScale::ONE,
                end: End::Cycles(14),
                offsets: None,
                late: None,
                imu_seed: None,
                on_touch: OnTouch::GoOn,
                detail: Detail::Sums,
            };
            let crawl = run(&world, &plan, HeadingHold::of(gains, &steering)).unwrap();
            let aside = crawl.cycles[4..].iter().map(|it| it.to.y.abs());
            let aside = aside.fold(0.0, f64::max);
            let sways = aside > 0.07 || crawl.askew().to_degrees() > 10.0;
            sways.then(|| format!("{name}: {aside:.3} m, {:.1}°", crawl.askew().to_degrees()))
        })
        .collect();
    assert!(swaying.is_empty(), "{swaying:?}");
}

#[test]
fn a_heading_is_reached_without_overshoot() {
    let robot = nao();
    let world = World::new(&robot, Regime::LOCOMOTION).unwrap();
    let cycles = vec![shipped::cycle("hip-10").unwrap().unwrap()];
    let limit = cycles[0].steering.as_ref().unwrap().limit;
    let plan = CrawlPlan {
        cycles,
        scale: TimeScale::ONE,
        end: End::Cycles(16),
        offsets: None,
        late: None,
        imu_seed: None,
        on_touch: OnTouch::GoOn,
        detail: Detail::Sums,
    };
    let heading = 45.0_f64.to_radians();
    let pilot = TurnTo { heading, limit };
    let crawl = run(&world, &plan, pilot).unwrap();
    let yaws = crawl.cycles.iter().map(|cycle| cycle.to.yaw.to_degrees());
    let (most, last) = yaws.fold((0.0_f64, 0.0), |(most, _), yaw| (most.max(yaw), yaw));
    assert!(most < 47.0, "{most}°");
    assert!((last - 45.0).abs() < 2.0, "{last}°");
}

#[test]
fn no_limb_goes_through_another_in_a_shipped_cycle() {
    let robot = nao();
    let world = World::new(&robot, Regime::LOCOMOTION).unwrap();
    let plan = |cycle: &Cycle, turn: f64| {
        CheckedCycle::plan(world.robot(), world.stops(), cycle, turn, TimeScale::ONE).unwrap()
    };
    for name in shipped::cycle_names() {
        let cycle = shipped::cycle(name).unwrap().unwrap();
        let limit = cycle
            .steering
            .as_ref()
            .map_or(0.0, |steering| steering.limit);
        for turn in [0.0, limit] {
            check_limbs(&world, &plan(&cycle, turn)).unwrap();
        }
    }
    let mut crossed = shipped::cycle("hip-10").unwrap().unwrap();
    let roll = &mut crossed.waypoints[0].joints;
    roll.insert("LHipRoll".to_owned(), -0.3);
    let error = check_limbs(&world, &plan(&crossed, 0.0)).unwrap_err();
    assert!(matches!(error, LimbsError::Through { .. }), "{error}");
    assert!(error.to_string().contains("s into the recovery"), "{error}");
}

/// Torque is what the motor's equations say of the position error and the speed before a step and
/// the speed after it, written down here once more.
#[test]
fn identity_applied_torque_is_that_of_the_motors_equations() {
    let robot = nao();
    let world = World::new(&robot, Regime::LOCOMOTION).unwrap();
    let robot = world.robot();
    let placement = Placement {
        posture: JointAngles::zero(robot),
        pitch: std::f64::consts::FRAC_PI_2,
    };
    let mut simulation = Simulation::new(&world, &placement);
    let mut far = JointAngles::zero(robot);
    for joint in robot.chain.left.commanded_joints() {
        far[joint] = 0.3;
    }
    simulation.command(&far);
    let (mut clipped, mut limited) = (0, 0);
    let efficiency = robot.control.gear_efficiency;
    for _ in 0..200 {
        let speeds = simulation.joint_speeds().to_vec();
        let angles = simulation.joint_angles();
        simulation.step();
        for (index, joint) in robot.joints.iter().enumerate() {
            if joint.name.contains("HipYawPitch") {
                continue; // two joints of one motor: another test
            }
            let motor = joint.motor.unwrap();
            let stall = efficiency * motor.stall;
            let loss = stall / motor.no_load_speed.unwrap();
            let error = far.as_slice()[index] - angles.as_slice()[index];
            let wanted = joint.servo_stiffness * error;
            let supplied = wanted.clamp(-stall, stall);
            let (lowest, highest) = (
                loss * speeds[index] - joint.effort_limit,
                loss * speeds[index] + joint.effort_limit,
            );
            let told = supplied.clamp(lowest, highest);
            let torque = told - loss * simulation.joint_speeds()[index];
            let found = simulation.applied_torque()[index];
            assert!((torque - found).abs() < 1e-9, "{}", joint.name);
            clipped += usize::from(wanted.abs() > stall);
            limited += usize::from((told - supplied).abs() > 0.0);
        }
    }
    assert!(clipped > 0 && limited > 0, "{clipped} {limited}");
}

/// One motor turns both hips' yaw-pitch: it is told once, shares its torque evenly, and its limit is
/// that of one motor.
#[test]
fn a_shared_motor_gives_no_more_than_one() {
    let robot = nao();
    let world = World::new(&robot, Regime::LOCOMOTION).unwrap();
    let robot = world.robot();
    let joints = ["LHipYawPitch", "RHipYawPitch"].map(|name| robot.joint(name).unwrap());
    let placement = Placement {
        posture: JointAngles::zero(robot),
        pitch: std::f64::consts::FRAC_PI_2,
    };
    let mut simulation = Simulation::new(&world, &placement);
    let mut far = JointAngles::zero(robot);
    for joint in joints {
        far[joint] = -0.8;
    }
    simulation.command(&far);
    let drives = robot.drives();
    let index = drives.iter().position(|it| it.joints == joints).unwrap();
    let limit = robot.joints[joints[0].0].effort_limit;
    let mut most = 0.0_f64;
    for _ in 0..400 {
        simulation.step();
        let [left, right] = joints.map(|joint| simulation.applied_torque()[joint.0]);
        let sum = simulation.motor_steps()[index].torque;
        assert!((sum - left - right).abs() < 1e-12);
        // The model's coupling lets the joints move apart a little, and with it the back-EMF.
        assert!((left - right).abs() < 0.05 * limit, "{left} {right}");
        most = most.max(sum.abs());
    }
    assert!(
        most > 0.9 * limit && most < 1.05 * limit,
        "{most} N·m of {limit}"
    );
    let reached = simulation.joint_angles();
    assert!(
        joints.iter().all(|joint| reached[*joint] < -0.6),
        "{reached:?}"
    );
}

/// Whatever the next turn is, arms that a waypoint holds stay where the last one has planted them.
#[test]
fn a_changing_turn_leaves_planted_arms_where_they_are() {
    let robot = nao();
    let world = World::new(&robot, Regime::LOCOMOTION).unwrap();
    let mut cycle = shipped::cycle("hip-10").unwrap().unwrap();
    let plan = |cycle: &Cycle, degrees: f64| {
        let turn = f64::to_radians(degrees);
        CheckedCycle::plan(world.robot(), world.stops(), cycle, turn, TimeScale::ONE).unwrap()
    };
    // The first waypoint holds the roll at which a straight pull ends.
    let roll = world.robot().chain.left.shoulder_roll;
    let held = plan(&cycle, 0.0).compression()[roll];
    let name = world.robot().joints[roll.0].name.clone();
    cycle.waypoints[0].joints.insert(name, held);
    for (last, next) in [(12.0, -12.0), (12.0, 0.0), (0.0, 12.0), (12.0, 12.0)] {
        let (previous, cycle) = (plan(&cycle, last), plan(&cycle, next));
        let path = cycle.recovery_after(&previous).unwrap();
        let (_, first) = cycle.recovery_ends()[0];
        let moved = path.at(first)[roll] - previous.compression()[roll];
        assert!(
            moved.abs() < 1e-9,
            "{last}° to {next}°: {}°",
            moved.to_degrees()
        );
    }
}

fn steady(cycles: usize) -> CrawlPlan {
    CrawlPlan {
        cycles: vec![shipped::cycle("hip-10").unwrap().unwrap()],
        scale: TimeScale::ONE,
        end: End::Cycles(cycles),
        offsets: None,
        late: None,
        imu_seed: None,
        on_touch: OnTouch::GoOn,
        detail: Detail::Sums,
    }
}

fn never() -> bool {
    false
}

/// A crawl hands its robot back, so that whatever follows goes on from there: two crawls one after
/// the other are one, to the bit.
#[test]
fn a_crawl_that_goes_on_is_one_crawl() {
    let robot = nao();
    let world = World::new(&robot, Regime::LOCOMOTION).unwrap();
    let at_once = Begin::InExtension { rest: 0.0 };
    let first = crawler(&world, &steady(1), at_once, Straight::default()).unwrap();
    let lying = lie_down(&world, &steady(1), &first).unwrap();
    let (whole, ended) = {
        let two = crawler(&world, &steady(2), at_once, Straight::default()).unwrap();
        proceed(lying.clone(), two, &steady(2), &never).unwrap()
    };
    let (one, between) = proceed(lying, first, &steady(1), &never).unwrap();
    let second = crawler(&world, &steady(1), at_once, Straight::default()).unwrap();
    let (other, last) = proceed(between, second, &steady(1), &never).unwrap();
    assert_eq!(last.simulation().snapshot(), ended.simulation().snapshot());
    assert_eq!(one.cycles[0].to, whole.cycles[0].to);
    assert_eq!(other.cycles[0].to, whole.cycles[1].to);
    assert!(whole.cycles[1].advance().forward > 0.1);
}

/// From a posture that is no extension, on the floor: it goes to the extension, and crawls.
#[test]
fn a_crawl_begins_where_the_robot_lies() {
    let robot = nao();
    let world = World::new(&robot, Regime::LOCOMOTION).unwrap();
    let posture = world.robot().postures["lying-belly"].clone();
    let pitch = std::f64::consts::FRAC_PI_2;
    let mut lying = SimulatedRobot::new(Simulation::new(&world, &Placement { posture, pitch }));
    for _ in 0..400 {
        lying.wait().unwrap();
    }
    let begin = Begin::Lying {
        speed: 0.3,
        rest: 0.5,
    };
    let plan = steady(3);
    let crawler = crawler(&world, &plan, begin, Straight::default()).unwrap();
    let extension = crawler.cycle().extension().clone();
    let (crawl, robot) = proceed(lying, crawler, &plan, &never).unwrap();
    let third = crawl.cycles[2].advance().forward;
    // As from its settled start, within a tenth: it lies beside its line, turned a little.
    assert!((third - 0.118).abs() < 0.0118, "{third} m");
    assert_eq!(robot.commanded(), &extension);
}

/// A robot that follows whole phases by itself crawls as far as one that is told every 10 ms: the
/// set-points lead by 10 ms, which is all that differs.
#[test]
fn segments_crawl_as_far_as_set_points() {
    let robot = nao();
    let world = World::new(&robot, Regime::LOCOMOTION).unwrap();
    let plan = steady(3);
    let begin = Begin::InExtension { rest: 0.0 };
    let points = crawler(&world, &plan, begin, Straight::default()).unwrap();
    let lying = lie_down(&world, &plan, &points).unwrap();
    let program = Program {
        cycles: plan.cycles.clone(),
        scale: plan.scale,
        most_cycles: 3,
        begin,
        timing: Timing::new(world.regime().time_step, Delivery::Segments { every: 0.05 }).unwrap(),
    };
    let stops = world.stops().to_vec();
    let segments = Crawler::new(world.shared_robot(), stops, program, Straight::default()).unwrap();
    let (points, _) = proceed(lying.clone(), points, &plan, &never).unwrap();
    let (segments, _) = proceed(lying, segments, &plan, &never).unwrap();
    let forward = |crawl: &Crawl| crawl.cycles[2].advance().forward;
    let (points, segments) = (forward(&points), forward(&segments));
    assert!(
        (points - segments).abs() < 0.03 * points,
        "{points} and {segments} m"
    );
}

/// A path ends by itself at its last knot, and by a stop where it has come to: the joints keep the
/// last set-point, and a second stop changes nothing.
#[test]
fn a_path_is_stopped_at_its_last_set_point() {
    let robot = nao();
    let world = World::new(&robot, Regime::LOCOMOTION).unwrap();
    let plan = steady(1);
    let begin = Begin::InExtension { rest: 0.0 };
    let crawler = crawler(&world, &plan, begin, Straight::default()).unwrap();
    let mut lying = lie_down(&world, &plan, &crawler).unwrap();
    let from = lying.commanded().clone();
    let to = from.map(|_, angle| angle + 0.1);
    let knot = Knot {
        seconds: 0.5,
        angles: to.clone(),
    };
    let path = JointCommand::Segment(Segment { knots: vec![knot] });
    lying.command(&path).unwrap();
    let mut stopped = lying.clone();
    for _ in 0..400 {
        lying.wait().unwrap();
    }
    assert_eq!(lying.commanded(), &to, "at the last knot");
    for _ in 0..100 {
        stopped.wait().unwrap();
    }
    stopped.stop().unwrap();
    let here = stopped.commanded().clone();
    assert!(here != from && here != to);
    stopped.wait().unwrap();
    stopped.stop().unwrap();
    assert_eq!(stopped.commanded(), &here);
}

/// A calibration error that leads past a stop is stopped there, counted and told.
#[test]
fn calibration_errors_are_stopped_and_counted() {
    let robot = nao();
    let world = World::new(&robot, Regime::LOCOMOTION).unwrap();
    let ankle = world.robot().chain.left.ankle;
    let off = |radians: f64| {
        let mut offsets = JointAngles::zero(world.robot());
        offsets[ankle] = radians;
        let plan = CrawlPlan {
            offsets: Some(offsets),
            ..steady(1)
        };
        run(&world, &plan, Straight::default()).unwrap().stopped
    };
    assert_eq!(off(0.0), [], "exact joints");
    // The low cycle leans on the ankle's lower stop, so that any error downwards is cut.
    let stopped = off(-0.05);
    assert_eq!(stopped.len(), 1);
    assert_eq!(stopped[0].joint, ankle);
    assert!(stopped[0].commands > 10, "{stopped:?}");
    assert!((stopped[0].largest + 0.05).abs() < 1e-9, "{stopped:?}");
}

#[test]
fn a_crawl_is_stopped_at_once() {
    let robot = nao();
    let world = World::new(&robot, Regime::LOCOMOTION).unwrap();
    let looks = std::cell::Cell::new(0);
    let third = || {
        looks.set(looks.get() + 1);
        looks.get() > 3
    };
    let error = run_unless(&third, &world, &steady(9), Straight::default()).unwrap_err();
    assert_eq!(error, CrawlError::Stopped);
    assert_eq!(looks.get(), 4);
}
