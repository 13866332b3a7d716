//! A crawl in figures: `summary.json`, and what `prone crawl run` prints.

use serde::{Deserialize, Serialize};

use prone::gait::cycle::{CheckedCycle, Cycle, CycleError, TimeScale};
use prone::robot::{BodyPart, Robot, Tops};
use prone::statics::GRAVITY;
use prone_sim::World;
use prone_sim::crawl::{Crawl, CycleRow, Touch};

use super::joints::{self, JointSummary};
use super::obstacle_name;
use crate::gait_sheet::SheetClamp;

/// What came out of a crawl.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CrawlSummary {
    /// The cycle's name.
    pub gait: String,
    /// The robot's name.
    pub robot: String,
    /// The scene's name.
    pub scene: String,
    /// How many cycles were crawled.
    pub cycles: usize,
    /// Whether it got past the obstacles, where that was asked for.
    pub arrived: Option<bool>,
    /// Displacement of the root along the heading of the start, mm.
    pub distance_mm: f64,
    /// How far it came along its own heading: sum of the cycles' advances, mm. Where it turns, that
    /// is more than the distance.
    pub path_mm: f64,
    /// How long it took, settling apart, s.
    pub time_s: f64,
    /// Path over cycles, mm.
    pub mm_per_cycle: f64,
    /// What of that the pulls made, mm: mean of the cycles' own advances.
    pub pull_mm_per_cycle: f64,
    /// What the recoveries made, mm.
    pub recovery_mm_per_cycle: f64,
    /// Path over time, mm/s.
    pub mm_per_s: f64,
    /// Displacement to the left of the line of the start, mm.
    pub lateral_mm: f64,
    /// Change of heading, degrees, positive to the left.
    pub yaw_deg: f64,
    /// How often a part of the robot met a plate, its legs or a panel.
    pub plate_contacts: usize,
    /// The same by part of the robot and obstacle.
    pub contacts: Vec<PlateContact>,
    /// Highest points above the floor, mm.
    pub top_mm: TopsMm,
    /// Advance of the shoulder in the planned closed chain, mm.
    pub stride_mm: f64,
    /// Advance of a pull over that stride; nothing where the plan does not lead forward.
    pub pull_efficiency: Option<f64>,
    /// Advance per cycle over that stride: above 1 where recoveries advance too; nothing where the
    /// plan does not lead forward.
    pub stride_efficiency: Option<f64>,
    /// Share of the ground's force on trunk and legs during pulls, mean of the cycles.
    pub pull_body_share: f64,
    /// The same during recoveries.
    pub recovery_body_share: f64,
    /// Largest actuator torque over the manufacturer's effort limit.
    pub peak_torque_over_rated: f64,
    /// Whose that is.
    pub peak_torque_joint: String,
    /// Largest torque that a servo of a shoulder's pitch demanded, before its limit, N·m.
    pub demanded_peak_shoulder_nm: f64,
    /// Share of the time in which the servo of a shoulder's pitch demanded more than the effort
    /// limit, of the side where it is larger.
    pub saturated_shoulder_share: f64,
    /// Share of the time in which a servo demanded more than the effort limit, of the joint where
    /// it is largest.
    pub saturated_share: f64,
    /// Which joint that is, if any servo ever demanded so much.
    pub saturated_joint: Option<String>,
    /// ∫ Σ (τ / nominal torque)² dt, s.
    pub heat_s: f64,
    /// The same per metre of path, s/m; nothing where it did not come forward.
    pub heat_per_metre_s: Option<f64>,
    /// Positive mechanical work of the motors, J.
    pub work_j: f64,
    /// That work over weight times path; nothing where it did not come forward.
    pub cost_of_transport: Option<f64>,
    /// What the windings of the motors lost, J: an estimate; nothing where a motor is not known.
    pub winding_loss_j: Option<f64>,
    /// Work and winding loss over weight times path: an estimate, in which gears lose nothing
    /// and what is braked is not given back.
    pub electrical_cost_of_transport: Option<f64>,
    /// What each motor did.
    pub joints: Vec<JointSummary>,
    /// Joints stopped at their limits in the plan without a turn.
    pub clamps: Vec<SheetClamp>,
    /// Joints whose calibration error led commands past their limits, where they were stopped.
    #[serde(default)]
    pub calibration_stops: Vec<CalibrationStop>,
    /// One entry per cycle.
    pub per_cycle: Vec<CycleSummary>,
}

/// A joint whose calibration error led commands past its limit, where it was stopped.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CalibrationStop {
    /// Name of the joint.
    pub joint: String,
    /// How many commands, those that held the start posture included.
    pub commands: usize,
    /// Largest amount cut off, degrees, negative at the lower limit.
    pub largest_deg: f64,
}

/// A part of the robot that met an obstacle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlateContact {
    /// The part, by its name in the model.
    pub body: String,
    /// Kind and number of the obstacle.
    pub obstacle: String,
    /// How often they met.
    pub count: usize,
    /// When first, s since the first pull began.
    pub first_s: f64,
    /// How long in all, s.
    pub seconds: f64,
    /// Largest normal force, N.
    pub peak_n: f64,
}

/// Highest points by part of the body, mm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TopsMm {
    /// Neck and head.
    pub head: f64,
    /// Trunk and pelvis.
    pub trunk: f64,
    /// Shoulders to hands.
    pub arms: f64,
    /// Thighs and shins.
    pub legs: f64,
    /// From the ankles on.
    pub feet: f64,
}

/// One cycle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CycleSummary {
    /// From 1.
    pub cycle: usize,
    /// The turn command of its pull, degrees.
    pub turn_command_deg: f64,
    /// When it began, s.
    pub begin_s: f64,
    /// How long it lasted, s.
    pub time_s: f64,
    /// Along the heading with which it began, mm.
    pub advance_mm: f64,
    /// What of that the pull made, mm.
    pub pull_advance_mm: f64,
    /// To the left of that, mm.
    pub left_mm: f64,
    /// Change of heading, degrees.
    pub yaw_deg: f64,
    /// Where it ended along the heading of the start, mm.
    pub x_mm: f64,
    /// Where it ended to the left of the line of the start, mm.
    pub y_mm: f64,
    /// Highest points.
    pub top_mm: TopsMm,
    /// ∫ Σ (τ / nominal torque)² dt, s.
    pub heat_s: f64,
    /// Positive mechanical work, J.
    pub work_j: f64,
    /// Share of the ground's force on trunk and legs during the pull.
    pub body_share: f64,
    /// The same during the recovery.
    pub recovery_body_share: f64,
}

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
    let joints = joints::of(robot, &crawl.effort);
    let winding_loss_j = joints::winding_loss(&joints);
    let shoulders = robot.chain.sides().map(|side| side.shoulder);
    let shoulders = shoulders.map(|joint| crawl.effort.joints[joint.0]);
    let demanded = shoulders.map(|shoulder| shoulder.demanded_peak);
    let over = shoulders.map(|shoulder| shoulder.saturated / crawl.effort.seconds);
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
        contacts: contacts(world, &crawl.touches),
        top_mm: TopsMm::of(&crawl.tops),
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
        clamps: clamps(robot, &checked),
        calibration_stops: calibration_stops(robot, crawl),
        per_cycle,
    })
}

fn calibration_stops(robot: &Robot, crawl: &Crawl) -> Vec<CalibrationStop> {
    let stopped = crawl.stopped.iter().map(|stopped| CalibrationStop {
        joint: robot.joints[stopped.joint.0].name.clone(),
        commands: stopped.commands,
        largest_deg: stopped.largest.to_degrees(),
    });
    stopped.collect()
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

fn contacts(world: &World, touches: &[Touch]) -> Vec<PlateContact> {
    let contacts = touches.iter().map(|touch| PlateContact {
        body: world.robot().bodies[touch.body.0].name.clone(),
        obstacle: obstacle_name(world.obstacles(), touch.obstacle),
        count: touch.count,
        first_s: touch.first,
        seconds: touch.seconds,
        peak_n: touch.peak,
    });
    contacts.collect()
}

fn clamps(robot: &Robot, checked: &CheckedCycle) -> Vec<SheetClamp> {
    let clamps = checked.clamps().iter().map(|clamp| SheetClamp {
        joint: robot.joints[clamp.joint.0].name.clone(),
        samples: clamp.samples,
        from_percent: clamp.from * 100.0,
        to_percent: clamp.to * 100.0,
        largest_deg: clamp.largest.to_degrees(),
    });
    clamps.collect()
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
            top_mm: TopsMm::of(&row.tops),
            heat_s: row.effort.heat(robot),
            work_j: row.effort.work(),
            body_share: row.body_share,
            recovery_body_share: row.recovery_body_share,
        }
    });
    rows.collect()
}

impl TopsMm {
    fn of(tops: &Tops) -> Self {
        let of = |part: BodyPart| tops.0[part as usize] * 1e3;
        Self {
            head: of(BodyPart::Head),
            trunk: of(BodyPart::Trunk),
            arms: of(BodyPart::Arms),
            legs: of(BodyPart::Legs),
            feet: of(BodyPart::Feet),
        }
    }

    /// In the order of [`BodyPart::ALL`].
    pub const fn to_array(self) -> [f64; 5] {
        [self.head, self.trunk, self.arms, self.legs, self.feet]
    }

    /// Of all parts.
    pub fn highest(self) -> f64 {
        self.to_array()
            .into_iter()
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// The part that reaches highest, and how high, mm.
    pub fn highest_part(self) -> (BodyPart, f64) {
        let parts = BodyPart::ALL.into_iter().zip(self.to_array());
        parts
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or((BodyPart::Trunk, f64::NEG_INFINITY))
    }
}
