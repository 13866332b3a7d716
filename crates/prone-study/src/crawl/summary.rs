//! A crawl in figures: `summary.json`, and what `prone crawl run` prints.

use prone::gait::cycle::{CheckedCycle, Cycle, CycleError, TimeScale};
use prone::robot::Robot;
use prone::statics::GRAVITY;
use prone_sim::World;
use prone_sim::crawl::{Crawl, CycleRow, Effort};

use prone::scene::obstacle_name;
use prone_record::crawl_summary::{
    CalibrationStop, CrawlSummary, CycleSummary, JointSummary, PlateContact, SheetClamp, TopsMm,
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
    let stride_mm = stride(&checked) * 1e3;
    let per_cycle = per_cycle(robot, &crawl.cycles);
    let (distance_mm, lateral_mm) = per_cycle
        .last()
        .map_or((0.0, 0.0), |last| (last.x_mm, last.y_mm));
    let cycles = per_cycle.len();
    let path_mm = per_cycle.iter().map(|cycle| cycle.advance_mm).sum::<f64>();
    let mm_per_cycle = path_mm / cycles.max(1) as f64;
    let mean =
        |of: fn(&CycleSummary) -> f64| per_cycle.iter().map(of).sum::<f64>() / cycles.max(1) as f64;
    let pull_mm_per_cycle = mean(|cycle| cycle.pull_advance_mm);
    let of_stride = |advance_mm: f64| (stride_mm > 0.0).then(|| advance_mm / stride_mm);
    let (peak, peak_joint) = crawl.effort.peak_over_limit(robot);
    let (saturated, saturated_joint) = longest_saturated(crawl);
    let metres = (path_mm > 0.0).then_some(path_mm / 1e3);
    let (heat_s, work_j) = (crawl.effort.heat(robot), crawl.effort.work());
    let weight = robot.mass() * GRAVITY;
    let joints = joint_summaries(robot, &crawl.effort);
    // Nothing where that of a joint is not known.
    let winding_loss_j: Option<f64> = joints.iter().map(|joint| joint.winding_loss_j).sum();
    let shoulders = robot.chain.sides().map(|side| side.shoulder);
    let shoulders = shoulders.map(|joint| crawl.effort.joints[joint.0]);
    let demanded = shoulders.map(|shoulder| shoulder.demanded_peak);
    let over = shoulders.map(|shoulder| shoulder.saturated / crawl.effort.seconds);
    let contacts = crawl.touches.iter().map(|touch| PlateContact {
        body: robot.bodies[touch.body.0].name.clone(),
        obstacle: obstacle_name(world.obstacles(), touch.obstacle),
        count: touch.count,
        first_s: touch.first,
        seconds: touch.seconds,
        peak_n: touch.peak,
    });
    let clamps = checked.clamps().iter();
    let stops = crawl.stopped.iter().map(|stopped| CalibrationStop {
        joint: robot.joints[stopped.joint.0].name.clone(),
        commands: stopped.commands,
        largest_deg: stopped.largest.to_degrees(),
    });
    Ok(CrawlSummary {
        gait: cycle.pull.name.clone(),
        robot: robot.name.clone(),
        scene: world.scene().name.clone(),
        cycles,
        arrived: until_past.map(|_| crawl.arrived),
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
        contacts: contacts.collect(),
        top_mm: TopsMm::from_metres(&crawl.tops),
        stride_mm,
        pull_efficiency: of_stride(pull_mm_per_cycle),
        stride_efficiency: of_stride(mm_per_cycle),
        pull_body_share: mean(|cycle| cycle.body_share),
        recovery_body_share: mean(|cycle| cycle.recovery_body_share),
        peak_torque_over_rated: peak,
        peak_torque_joint: robot.joints[peak_joint.0].name.clone(),
        demanded_peak_shoulder_nm: demanded[0].max(demanded[1]),
        saturated_shoulder_share: over[0].max(over[1]),
        saturated_share: saturated,
        saturated_joint: saturated_joint.map(|joint| robot.joints[joint].name.clone()),
        heat_s,
        heat_per_metre_s: metres.map(|metres| heat_s / metres),
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

/// What each motor of a robot did, in the order of its joints.
fn joint_summaries(robot: &Robot, effort: &Effort) -> Vec<JointSummary> {
    let pairs = robot.joints.iter().zip(&effort.joints);
    let summaries = pairs.map(|(joint, did)| JointSummary {
        joint: joint.name.clone(),
        effort_limit_nm: joint.effort_limit,
        nominal_nm: joint.motor.map(|motor| motor.nominal),
        peak_nm: did.peak,
        rms_nm: (did.square / effort.seconds).sqrt(),
        demanded_peak_nm: did.demanded_peak,
        saturated_share: did.saturated / effort.seconds,
        heat_s: joint
            .motor
            .map(|motor| did.square / (motor.nominal * motor.nominal)),
        work_j: did.work,
        winding_loss_j: joint
            .motor
            .and_then(|motor| motor.winding_loss())
            .map(|watts_per_square| did.square * watts_per_square),
    });
    summaries.collect()
}

/// Advance of the shoulder in the planned chain, m.
fn stride(checked: &CheckedCycle) -> f64 {
    let samples = checked.pull().samples();
    let x = |index: usize| samples[index].posture.shoulder.x();
    x(samples.len() - 1) - x(0)
}

fn longest_saturated(crawl: &Crawl) -> (f64, Option<usize>) {
    let mut most = (0.0, None);
    for (index, joint) in crawl.effort.joints.iter().enumerate() {
        let share = joint.saturated / crawl.effort.seconds;
        if share > most.0 {
            most = (share, Some(index));
        }
    }
    most
}

fn per_cycle(robot: &Robot, cycles: &[CycleRow]) -> Vec<CycleSummary> {
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
            begin_s: row.begin,
            time_s: row.seconds,
            advance_mm: advance.forward * 1e3,
            pull_advance_mm: row.pull_advance().forward * 1e3,
            left_mm: advance.left * 1e3,
            yaw_deg: advance.yaw.to_degrees(),
            x_mm: (cos * dx + sin * dy) * 1e3,
            y_mm: (cos * dy - sin * dx) * 1e3,
            top_mm: TopsMm::from_metres(&row.tops),
            heat_s: row.effort.heat(robot),
            work_j: row.effort.work(),
            body_share: row.body_share,
            recovery_body_share: row.recovery_body_share,
        }
    });
    rows.collect()
}
