//! One way to crawl a cycle, and what the cycle comes to in it.

use prone::gait::cycle::Cycle;
use prone::motor::{Effort, Verdict};
use prone::robot::BodyPart;
use prone::statics::GRAVITY;
use prone_sim::crawl::{self, Crawl, CrawlError, CrawlPlan, Detail, End, OnTouch};

use super::setting::Setting;
use prone_record::frontier::SettingKind;

/// What a cycle came to in one setting; the last cycle of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// What the setting changes.
    pub setting: SettingKind,
    /// Advance along the heading, m.
    pub advance: f64,
    /// How long it took, s.
    pub seconds: f64,
    /// Highest point of all cycles, m, and of which part of the body.
    pub top: (f64, BodyPart),
    /// ∫ Σ (τ / nominal torque)² dt per metre, s/m; NaN where a motor is not known.
    pub heat_per_metre: f64,
    /// Duty: √(∫ τ² dt / time) over what the gear passes on of the nominal torque, and the joint that
    /// the motor is named after, of the motor with the largest; NaN where a motor is not known.
    pub duty: (f64, String),
    /// Largest torque over the effort limit, and whose.
    pub peak_over_limit: (f64, String),
    /// Largest torque that the position error of a shoulder's pitch asks for before any limit, N·m.
    pub demanded_shoulder: f64,
    /// Largest mean force on the head over 20 ms in all cycles, N.
    pub head: f64,
    /// Weight of the robot, N.
    pub weight: f64,
    /// Share of the weight on trunk, head and legs in the pull.
    pub body_share: f64,
    /// Change of heading, rad.
    pub yaw: f64,
    /// Farthest from the line of the start at the end of a cycle, m.
    pub drift: f64,
    /// Whether the motors of a robot could do it; nothing where one is not known.
    pub verdict: Option<Verdict>,
}

impl Trial {
    /// Speed, m/s; 0 of what took no time.
    pub fn speed(&self) -> f64 {
        if self.seconds > 0.0 {
            self.advance / self.seconds
        } else {
            0.0
        }
    }
}

/// Crawls a cycle in one setting.
pub fn try_out(setting: &Setting, cycle: &Cycle) -> Result<Trial, CrawlError> {
    try_out_unless(&|| false, setting, cycle)
}

/// The same, ended at once where `stopped` says so, whatever has come of it by then.
pub fn try_out_unless(
    stopped: &dyn Fn() -> bool,
    setting: &Setting,
    cycle: &Cycle,
) -> Result<Trial, CrawlError> {
    let mut cycle = cycle.clone();
    if let (Some(pull), Some(duration)) = (&mut cycle.pull, setting.spec.pull) {
        pull.duration = duration;
    }
    let pilot = setting.pilot(&cycle);
    let plan = CrawlPlan {
        cycles: vec![cycle],
        scale: setting.spec.scale,
        end: End::Cycles(setting.spec.cycles),
        offsets: setting.spec.offsets.clone(),
        late: setting.spec.late,
        imu_seed: None,
        on_touch: OnTouch::GoOn,
        detail: Detail::Sums,
    };
    let crawl = crawl::run_unless(stopped, &setting.world, &plan, pilot)?;
    Ok(measured(setting, &crawl))
}

fn measured(setting: &Setting, crawl: &Crawl) -> Trial {
    let robot = setting.world.robot();
    let Some(last) = crawl.cycles.last() else {
        return nothing(setting, crawl);
    };
    let advance = last.advance();
    Trial {
        setting: setting.spec.kind,
        advance: advance.forward,
        seconds: last.seconds,
        top: (crawl.tops.highest(), crawl.tops.part()),
        heat_per_metre: per_metre(last.effort.heat(robot).unwrap_or(f64::NAN), advance.forward),
        duty: duty(setting, &last.effort),
        peak_over_limit: last.effort.peak_over_limit(robot),
        demanded_shoulder: setting.world.demanded_of_shoulders(&last.effort),
        head: crawl.ground.head_peak(),
        weight: weight(setting),
        body_share: last.body_share,
        yaw: advance.yaw,
        drift: crawl.drift(),
        verdict: setting.verdict(crawl),
    }
}

/// The motor with the largest duty.
fn duty(setting: &Setting, effort: &Effort) -> (f64, String) {
    let robot = setting.world.robot();
    let efficiency = setting.world.gear_efficiency();
    let motors = effort.by_drive(robot).into_iter().map(|(drive, motor)| {
        let used = motor.motor_use(robot, &drive, effort.seconds, efficiency);
        let duty = used.map_or(f64::NAN, |used| used.rms_over_nominal);
        (duty, drive.named_after(robot).name.clone())
    });
    // NaN of either sign is above all numbers.
    let worst = motors.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    worst.unwrap_or((f64::NAN, String::new()))
}

fn weight(setting: &Setting) -> f64 {
    setting.world.mass() * GRAVITY
}

/// A cost per metre; of what does not advance, infinite.
fn per_metre(cost: f64, advance: f64) -> f64 {
    if advance > 0.0 {
        cost / advance
    } else {
        f64::INFINITY
    }
}

/// What a crawl comes to that ended before its first cycle did.
fn nothing(setting: &Setting, crawl: &Crawl) -> Trial {
    Trial {
        setting: setting.spec.kind,
        advance: 0.0,
        seconds: 0.0,
        top: (f64::INFINITY, crawl.tops.part()),
        heat_per_metre: f64::INFINITY,
        duty: (f64::INFINITY, String::new()),
        peak_over_limit: (0.0, String::new()),
        demanded_shoulder: 0.0,
        head: 0.0,
        weight: weight(setting),
        body_share: 0.0,
        yaw: 0.0,
        drift: 0.0,
        verdict: None,
    }
}
