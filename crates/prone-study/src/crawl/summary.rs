//! A crawl in figures: `summary.json`, and what `prone crawl run` prints.

use prone::gait::cycle::{CheckedCycle, Cycle, CycleError, TimeScale};
use prone::motor::{Effort, Load, Reason, Verdict};
use prone::robot::{ContactGroup, Robot};
use prone::statics::GRAVITY;
use prone_sim::World;
use prone_sim::crawl::{Crawl, CycleRow, GroundLoad};

use prone::scene::obstacle_name;
use prone_record::crawl_outcome::{OutcomeSummary, SelfCollisionSummary};
use prone_record::crawl_summary::{
    CalibrationStop, CrawlSummary, CycleSummary, GroundSummary, GroupLoad, MotorSummary,
    PlateContact, ReasonSummary, SheetClamp, TopsMm, VerdictSummary,
};

/// Reduces a record to figures. `until_past` says whether the crawl was to end past the obstacles.
///
/// # Errors
/// [`CycleError`] where the cycle cannot be planned on this robot.
pub fn of(
    world: &World,
    cycle: &Cycle,
    scale: TimeScale,
    crawl: &Crawl,
    until_past: Option<super::PastObstacles>,
) -> Result<CrawlSummary, CycleError> {
    let robot = world.robot();
    let checked = CheckedCycle::plan(robot, world.stops(), cycle, 0.0, scale)?;
    let stride_mm = stride(&checked).map(|metres| metres * 1e3);
    let per_cycle = per_cycle(world, &crawl.cycles);
    let (distance_mm, lateral_mm) = per_cycle
        .last()
        .map_or((0.0, 0.0), |last| (last.x_mm, last.y_mm));
    let cycles = per_cycle.len();
    let path_mm = per_cycle.iter().map(|cycle| cycle.advance_mm).sum::<f64>();
    let mm_per_cycle = path_mm / cycles.max(1) as f64;
    let mean =
        |of: fn(&CycleSummary) -> f64| per_cycle.iter().map(of).sum::<f64>() / cycles.max(1) as f64;
    let pull_mm_per_cycle = mean(|cycle| cycle.pull_advance_mm);
    let of_stride = |advance_mm: f64| {
        let forward = stride_mm.filter(|stride| *stride > 0.0);
        forward.map(|stride| advance_mm / stride)
    };
    let effort = &crawl.effort;
    let (peak, peak_joint) = effort.peak_over_limit(robot);
    let metres = (path_mm > 0.0).then_some(path_mm / 1e3);
    let gears = Gears::of(world);
    let joints = motor_summaries(world, gears, effort, metres);
    let (saturated, saturated_joint) = longest_saturated(&joints);
    let (heat_s, work_j) = (effort.heat(robot).ok(), effort.work());
    let weight = world.mass() * GRAVITY;
    // Nothing where that of a motor is not known.
    let winding_loss_j: Option<f64> = joints.iter().map(|joint| joint.winding_loss_j).sum();
    let shoulders = robot
        .chain
        .sides()
        .map(|side| &robot.joints[side.shoulder.0].name);
    let of_shoulders = joints.iter().filter(|it| shoulders.contains(&&it.joint));
    let at_limit = of_shoulders.map(|it| it.saturated_share);
    let contacts = plate_contacts(world, crawl);
    let arrived = until_past.map(|_| crawl.arrived);
    let nearest = crawl.nearest.as_ref().map(|nearest| SelfCollisionSummary {
        shapes: [nearest.shapes.0.clone(), nearest.shapes.1.clone()],
        distance_mm: nearest.distance_m * 1e3,
        time_s: nearest.time,
    });
    let clamps = checked.clamps().iter();
    let stops = crawl.stopped.iter().map(|stopped| CalibrationStop {
        joint: robot.joints[stopped.joint.0].name.clone(),
        commands: stopped.commands,
        largest_deg: stopped.largest.to_degrees(),
    });
    Ok(CrawlSummary {
        gait: cycle.name.clone(),
        robot: robot.name.clone(),
        scene: world.scene().name.clone(),
        cycles,
        outcome: Some(OutcomeSummary::new(
            arrived,
            cycles,
            mm_per_cycle,
            &contacts,
        )),
        arrived,
        distance_mm,
        path_mm,
        time_s: crawl.effort.seconds,
        mm_per_cycle,
        pull_mm_per_cycle,
        recovery_mm_per_cycle: mean(|cycle| cycle.advance_mm - cycle.pull_advance_mm),
        mm_per_s: path_mm / crawl.effort.seconds,
        lateral_mm,
        yaw_deg: per_cycle.iter().map(|cycle| cycle.yaw_deg).sum(),
        plate_contacts: crawl.touches.iter().map(|touch| touch.count).sum(),
        contacts,
        top_mm: TopsMm::from_metres(&crawl.tops),
        width_mm: Some(crawl.sides.width() * 1e3),
        self_collision: nearest,
        stride_mm,
        pull_efficiency: of_stride(pull_mm_per_cycle),
        stride_efficiency: of_stride(mm_per_cycle),
        pull_body_share: mean(|cycle| cycle.body_share),
        recovery_body_share: mean(|cycle| cycle.recovery_body_share),
        peak_torque_over_rated: peak,
        peak_torque_joint: peak_joint,
        demanded_peak_shoulder_nm: world.demanded_of_shoulders(effort),
        saturated_shoulder_share: at_limit.fold(0.0, f64::max),
        saturated_share: saturated,
        saturated_joint,
        heat_s,
        heat_per_metre_s: heat_s.zip(metres).map(|(heat, metres)| heat / metres),
        heat_per_second: heat_s.map(|heat| heat / effort.seconds),
        ground: ground(&crawl.ground, effort.seconds),
        verdict: verdict(robot, gears, effort, crawl.ground.head_peak()),
        work_j,
        cost_of_transport: metres.map(|metres| work_j / (weight * metres)),
        winding_loss_j,
        electrical_cost_of_transport: metres
            .zip(winding_loss_j)
            .map(|(metres, loss)| (work_j + loss) / (weight * metres)),
        joints,
        clamps: clamps
            .map(|clamp| SheetClamp::from_clamp(robot, clamp))
            .collect(),
        calibration_stops: stops.collect(),
        per_cycle,
    })
}

fn plate_contacts(world: &World, crawl: &Crawl) -> Vec<PlateContact> {
    let bodies = &world.robot().bodies;
    let contacts = crawl.touches.iter().map(|touch| PlateContact {
        body: bodies[touch.body.0].name.clone(),
        obstacle: obstacle_name(world.obstacles(), touch.obstacle),
        count: touch.count,
        first_s: touch.first,
        seconds: touch.seconds,
        peak_n: touch.peak,
    });
    contacts.collect()
}

/// Efficiency of the gears in a world.
#[derive(Clone, Copy)]
struct Gears(f64);

impl Gears {
    fn of(world: &World) -> Self {
        Self(world.gear_efficiency())
    }
}

/// What each motor of a robot did, in the order of its drives.
fn motor_summaries(
    world: &World,
    Gears(efficiency): Gears,
    effort: &Effort,
    metres: Option<f64>,
) -> Vec<MotorSummary> {
    let (robot, seconds) = (world.robot(), effort.seconds);
    let pairs = world.drives().iter().zip(&effort.motors);
    let summaries = pairs.map(|(it, did)| {
        let drive = &it.drive;
        let joint = drive.named_after(robot);
        let used = did.motor_use(robot, drive, seconds, efficiency).ok();
        let names = drive
            .joints
            .iter()
            .map(|id| robot.joints[id.0].name.clone());
        MotorSummary {
            joint: joint.name.clone(),
            joints: names.collect(),
            effort_limit_nm: joint.effort_limit,
            nominal_nm: joint.motor.map(|motor| motor.nominal),
            peak_nm: did.peak,
            rms_nm: did.rms(seconds),
            rms_over_nominal: used.map(|it| it.rms_over_nominal),
            demanded_peak_nm: it.demanded(did),
            largest_lag_deg: did.largest_lag.to_degrees(),
            voltage_clipped_share: used.as_ref().map(|_| effort.of_moving(did.supply_clipped)),
            saturated_share: effort.of_moving(did.current_limited),
            planned_speed_over_no_load: used.map(|it| it.planned_over_no_load),
            heat_s: used.map(|it| it.heat),
            heat_per_second: used.map(|it| it.heat / seconds),
            heat_per_metre_s: used.zip(metres).map(|(it, metres)| it.heat / metres),
            work_j: did.work,
            winding_loss_j: used.map(|it| it.winding_loss),
        }
    });
    summaries.collect()
}

fn ground(carried: &GroundLoad, seconds: f64) -> GroundSummary {
    let load = |group: ContactGroup| GroupLoad {
        mean_n: carried.impulse[group as usize] / seconds,
        peak_n: carried.peak[group as usize],
        share_of_time: carried.carried[group as usize] / seconds,
    };
    GroundSummary {
        toe: load(ContactGroup::Toe),
        elbow: load(ContactGroup::Elbow),
        torso: load(ContactGroup::Torso),
        leg: load(ContactGroup::Leg),
        head: load(ContactGroup::Head),
        hand: load(ContactGroup::Hand),
    }
}

fn verdict(
    robot: &Robot,
    Gears(gear_efficiency): Gears,
    effort: &Effort,
    head: f64,
) -> VerdictSummary {
    let load = Load {
        robot,
        gear_efficiency,
        effort,
        head,
    };
    match Verdict::from_load(&load) {
        Ok(Verdict { duty, reasons }) => VerdictSummary {
            duty: Some(duty.name().to_owned()),
            reasons: reasons.into_iter().map(reason).collect(),
            unknown: None,
            gear_efficiency,
        },
        Err(error) => VerdictSummary {
            duty: None,
            reasons: Vec::new(),
            unknown: Some(error.to_string()),
            gear_efficiency,
        },
    }
}

fn reason(reason: Reason) -> ReasonSummary {
    let (continuous, limited) = reason.measure.bounds();
    ReasonSummary {
        measure: reason.measure.name().to_owned(),
        joint: reason.joint,
        value: reason.value,
        continuous,
        limited,
    }
}

/// Advance of the shoulder in the planned chain, m, where there is one.
fn stride(checked: &CheckedCycle) -> Option<f64> {
    let pull = checked.pull()?;
    Some(pull.last().posture.shoulder.x() - pull.first().posture.shoulder.x())
}

/// Longest share of the time at the current limit, and whose it is.
fn longest_saturated(motors: &[MotorSummary]) -> (f64, Option<String>) {
    let mut most = (0.0, None);
    for motor in motors {
        if motor.saturated_share > most.0 {
            most = (motor.saturated_share, Some(motor.joint.clone()));
        }
    }
    most
}

fn per_cycle(world: &World, cycles: &[CycleRow]) -> Vec<CycleSummary> {
    let (robot, gears) = (world.robot(), Gears::of(world));
    let Some(start) = cycles.first().map(|cycle| cycle.from) else {
        return Vec::new();
    };
    let (sin, cos) = start.yaw.sin_cos();
    let rows = cycles.iter().enumerate().map(|(index, row)| {
        let advance = row.advance();
        let (dx, dy) = (row.to.x - start.x, row.to.y - start.y);
        CycleSummary {
            cycle: index + 1,
            turn_command_deg: row.turn.to_degrees(),
            shift_command_deg: row.shift.to_degrees(),
            begin_s: row.begin,
            time_s: row.seconds,
            advance_mm: advance.forward * 1e3,
            pull_advance_mm: row.pull_advance().forward * 1e3,
            left_mm: advance.left * 1e3,
            yaw_deg: advance.yaw.to_degrees(),
            x_mm: (cos * dx + sin * dy) * 1e3,
            y_mm: (cos * dy - sin * dx) * 1e3,
            top_mm: TopsMm::from_metres(&row.tops),
            heat_s: row.effort.heat(robot).ok(),
            work_j: row.effort.work(),
            body_share: row.body_share,
            recovery_body_share: row.recovery_body_share,
            ground: ground(&row.ground, row.seconds),
            verdict: verdict(robot, gears, &row.effort, row.ground.head_peak()),
            joints: motor_summaries(
                world,
                gears,
                &row.effort,
                (advance.forward > 0.0).then_some(advance.forward),
            ),
        }
    });
    rows.collect()
}
