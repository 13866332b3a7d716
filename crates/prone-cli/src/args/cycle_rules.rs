//! What may be typed about the cost of whole cycles: `prone cost` and `prone optimize` take the same.

use clap::ValueEnum;

use prone_record::experiment::CycleSearchExperiment;
use prone_record::frontier::Quantity;

use super::within;

/// The rules that cycles are held against.
#[derive(Debug, Default, clap::Args)]
pub(crate) struct CycleRulesArgs {
    /// cycle: height below which everything stays, mm [default: none]
    #[arg(long, value_name = "H", value_parser = super::heights::ceiling, allow_negative_numbers = true)]
    pub(crate) ceiling_mm: Option<f64>,
    /// cycle: only cycles that can be steered, as in `prone crawl frontier --steerable`
    #[arg(long)]
    pub(crate) steerable: bool,
    /// cycle: leave out the corners, so that what is found is for good ground only
    #[arg(long)]
    pub(crate) ideal: bool,
    /// cycle: farthest from the line in the corners, in 6 cycles on uneven ground, with the heading held, mm
    /// [default: any]
    #[arg(long, value_name = "MM", value_parser = super::heights::height, allow_negative_numbers = true)]
    pub(crate) most_drift_mm: Option<f64>,
    /// cycle: what the motors of a robot have to be able to do [default: anything]
    #[arg(long, value_enum)]
    pub(crate) verdict: Option<VerdictName>,
    /// cycle: least advance per cycle, mm [default: 10 for advance and speed, else that of robot.toml (NAO 120)]
    #[arg(long, value_name = "MM", value_parser = super::heights::height, allow_negative_numbers = true)]
    pub(crate) least_advance_mm: Option<f64>,
    /// cycle: least speed, mm/s [default: any]
    #[arg(long, value_name = "V", value_parser = speed, allow_negative_numbers = true)]
    pub(crate) least_speed_mm_s: Option<f64>,
    /// cycle: largest torque that the position error of a shoulder may ask for before any limit, N·m
    /// [default: any]
    #[arg(long, value_name = "NM", value_parser = positive, allow_negative_numbers = true)]
    pub(crate) demanded_shoulder_nm: Option<f64>,
    /// cycle: largest share of the weight on trunk, head and legs in the pull, percent [default: any]
    #[arg(long, value_name = "P", value_parser = percent, allow_negative_numbers = true)]
    pub(crate) body_share_percent: Option<f64>,
    /// cycle, heat and peak: heat is the larger of those with normal and with stiff servos, each over
    /// that of this cycle, instead of their geometric mean; with peak it needs --most-heat
    #[arg(long, value_name = "GAIT")]
    pub(crate) worst_over: Option<String>,
    /// cycle, heat and peak: largest heat, s/m, or share with --worst-over [default: any]
    #[arg(long, value_name = "H", value_parser = positive, allow_negative_numbers = true)]
    pub(crate) most_heat: Option<f64>,
    /// cycle: largest duty, the RMS torque of the worst motor over its nominal torque [default: any]
    #[arg(long, value_name = "D", value_parser = duty, allow_negative_numbers = true)]
    pub(crate) most_duty: Option<f64>,
    /// cycle: largest mean force on the head over 20 ms, N [default: 1]
    #[arg(long, value_name = "N", value_parser = positive, allow_negative_numbers = true)]
    pub(crate) most_head_n: Option<f64>,
}

impl CycleRulesArgs {
    /// Each option, and whether it was given.
    pub(crate) fn given(&self) -> [(&'static str, bool); 13] {
        [
            ("--ideal", self.ideal),
            ("--most-drift-mm", self.most_drift_mm.is_some()),
            ("--verdict", self.verdict.is_some()),
            ("--ceiling-mm", self.ceiling_mm.is_some()),
            ("--steerable", self.steerable),
            ("--least-advance-mm", self.least_advance_mm.is_some()),
            ("--least-speed-mm-s", self.least_speed_mm_s.is_some()),
            (
                "--demanded-shoulder-nm",
                self.demanded_shoulder_nm.is_some(),
            ),
            ("--body-share-percent", self.body_share_percent.is_some()),
            ("--worst-over", self.worst_over.is_some()),
            ("--most-heat", self.most_heat.is_some()),
            ("--most-duty", self.most_duty.is_some()),
            ("--most-head-n", self.most_head_n.is_some()),
        ]
    }
}

/// For how long motors have to be able to do it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum VerdictName {
    /// As long as the battery lasts
    Continuous,
    /// For minutes
    Limited,
}

pub(super) fn reach(text: &str) -> Result<f64, String> {
    within(text, "", CycleSearchExperiment::REACH)
}

fn positive(text: &str) -> Result<f64, String> {
    within(text, "", (0.01, 1000.0))
}

fn percent(text: &str) -> Result<f64, String> {
    within(text, " %", (0.0, 100.0))
}

fn speed(text: &str) -> Result<f64, String> {
    within(text, " mm/s", Quantity::Speed.bounds())
}

fn duty(text: &str) -> Result<f64, String> {
    within(text, "", Quantity::Duty.bounds())
}
