//! What may be typed about the cost of pulls: `prone cost` and `prone optimize` take the same.

use clap::ValueEnum;

use prone::gait::PhaseDuration;
use prone_record::experiment::ClearanceChoice;

use super::named::RobotArg;

/// What is minimised, and by what it is measured.
#[derive(Debug, clap::Args)]
pub(crate) struct PullTermsArgs {
    /// What a gait costs
    #[arg(long, value_enum)]
    pub(crate) objective: ObjectiveName,
    /// Where torques come from: `dynamics` (each pull simulated, regime torque-study, from its own
    /// first pose), `statics` (the static solver), a torque map's CSV file, or `cycle` (whole cycles
    /// simulated, regime locomotion)
    #[arg(long, value_name = "FILE|statics|dynamics|cycle")]
    pub(crate) source: Option<String>,
    /// torque: weights of ankle, knee, hip, shoulder [default: 1,1,1,1]
    #[arg(
        long,
        value_name = "W,W,W,W",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub(crate) weights: Option<Vec<f64>>,
    /// torque, heat: per phase, or per metre of planned advance [default: phase]
    #[arg(long, value_enum)]
    pub(crate) per: Option<PerName>,
    /// Duration of the pull, s [default: 3]
    #[arg(long, value_name = "S", value_parser = super::phase_duration, allow_negative_numbers = true)]
    pub(crate) duration: Option<PhaseDuration>,
    /// Fastest command of ankle, knee, hip and shoulder, degrees per pull, or `none` [default: 200]
    #[arg(long, value_name = "DEG|none", value_parser = rate, allow_negative_numbers = true)]
    pub(crate) rate_deg_per_phase: Option<f64>,
    /// What stays above the floor in the plan: `none`, `hip:MM` (the hip's centre), `body:MM` (trunk
    /// and legs by their shapes) or `base` (the hip, no lower than in the gait of --from)
    /// [default: none with dynamics, else base]
    #[arg(long, value_name = "RULE", value_parser = clearance)]
    pub(crate) clearance: Option<ClearanceChoice>,
    /// How far past its stop a joint may be commanded in the plan: `base` (nowhere further than in
    /// the gait of --from) or `none` (no rule: it is clamped) [default: base]
    #[arg(long, value_enum)]
    pub(crate) limits: Option<LimitsName>,
    /// dynamics: trunk, head and legs carry no larger share of the weight than in this gait
    /// [default: that of the robot's [defaults], of the NAO optimal; the gait of --from where the robot
    /// cannot follow it]
    #[arg(long, value_name = "GAIT")]
    pub(crate) body_share_of: Option<String>,
    /// published: least height of the hip's centre, mm [default: 40]
    #[arg(long, value_name = "MM", value_parser = not_negative, allow_negative_numbers = true)]
    pub(crate) hip_threshold_mm: Option<f64>,
    /// published: how far outside the table's limits an angle may lie, rad [default: 0]
    #[arg(long, value_name = "RAD", value_parser = not_negative, allow_negative_numbers = true)]
    pub(crate) limit_tolerance_rad: Option<f64>,
    /// Gait whose mapping, arms and ends of the pull hold: a name or a file [default: that of
    /// the robot's [defaults], of the NAO nominal; for
    /// the cost of a gait of another mapping or other arms, that gait itself]
    #[arg(long, value_name = "GAIT")]
    pub(crate) from: Option<String>,
    #[command(flatten)]
    pub(crate) robot: RobotArg,
}

/// An objective's name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ObjectiveName {
    /// The published cost, to the digit: 1000 per violated sample, plus weighted squared torque
    Published,
    /// ∫ Σ w τ² dt, N²·m²·s
    Torque,
    /// Largest torque over the manufacturer's effort limit; of cycles the largest that a shoulder's
    /// servo demands, before the limit cuts it, N·m
    Peak,
    /// ∫ Σ (τ/nominal torque)² dt, s: what warms the motors; of cycles per metre, s/m
    Heat,
    /// Of cycles: ∫ Σ (τ/nominal torque)² dt per second: how fast the motors warm
    HeatRate,
    /// Of cycles: the largest advance per cycle, mm
    Advance,
    /// Of cycles: the largest speed, mm/s
    Speed,
    /// Of cycles: the least duty, RMS torque of the worst motor over its nominal torque
    Duty,
    /// Of cycles: the lowest highest point, mm
    Height,
}

/// What a cost is divided by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum PerName {
    /// One pull
    Phase,
    /// One metre
    Metre,
}

/// A rule for joint limits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum LimitsName {
    /// No further past a stop than the base gait
    Base,
    /// No rule
    None,
}

/// Slowest command that is worth a search, degrees per pull: nothing moves below it.
const SLOWEST_DEG: f64 = 0.001;

fn finite(text: &str) -> Result<f64, String> {
    let number: f64 = text.trim().parse().map_err(|_| "not a number".to_owned())?;
    if number.is_finite() {
        Ok(number)
    } else {
        Err("not a finite number".to_owned())
    }
}

fn not_negative(text: &str) -> Result<f64, String> {
    let number = finite(text)?;
    if number >= 0.0 {
        Ok(number)
    } else {
        Err("it is negative".to_owned())
    }
}

fn rate(text: &str) -> Result<f64, String> {
    if text == "none" {
        return Ok(f64::INFINITY);
    }
    let degrees = finite(text)?;
    if degrees >= SLOWEST_DEG {
        Ok(degrees)
    } else {
        Err(format!("a rate is at least {SLOWEST_DEG}"))
    }
}

fn clearance(text: &str) -> Result<ClearanceChoice, String> {
    let height = |text: &str| {
        let mm = finite(text)?;
        if mm > 0.0 {
            Ok(mm)
        } else {
            Err("a clearance is greater than zero".to_owned())
        }
    };
    match text.split_once(':') {
        None if text == "none" => Ok(ClearanceChoice::None),
        None if text == "base" => Ok(ClearanceChoice::Base),
        Some(("hip", mm)) => height(mm).map(ClearanceChoice::HipMm),
        Some(("body", mm)) => height(mm).map(ClearanceChoice::BodyMm),
        _ => Err("it is none, base, hip:MM or body:MM".to_owned()),
    }
}
