//! How closely our torques follow the recorded ones.
//!
//! Both are means over tenths of the phase. The first two tenths are left out: there the robot
//! still travels from its start pose and lies on its belly.

use prone_record::statistics::{correlation, rms};
use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::published::TorqueBin;
use prone_record::pulls::{JOINTS, PullRecord};

/// Percent of the phase from which on the two are compared.
pub const FROM_PERCENT: f64 = 20.0;

const BINS: usize = 10;

/// Agreement of one joint over one pull.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Agreement {
    /// Name of the gait.
    pub gait: String,
    /// Duration of the phase, s.
    pub duration_s: f64,
    /// One of [`JOINTS`].
    pub joint: Cow<'static, str>,
    /// Root of the mean squared difference, N·m.
    pub rms_nm: f64,
    /// Pearson's correlation; `None` where one of the two does not vary.
    pub correlation: Option<f64>,
}

/// Agreement of every pull of which recorded bins exist, four joints each.
pub fn of(pulls: &[PullRecord], bins: &[TorqueBin]) -> Vec<Agreement> {
    pulls.iter().flat_map(|pull| of_pull(pull, bins)).collect()
}

fn of_pull(pull: &PullRecord, bins: &[TorqueBin]) -> Vec<Agreement> {
    let recorded: Vec<&TorqueBin> = bins
        .iter()
        .filter(|bin| bin.gait == pull.gait && (bin.duration_s - pull.duration_s).abs() < 1e-9)
        .filter(|bin| bin.from_percent >= FROM_PERCENT)
        .collect();
    if recorded.is_empty() {
        return Vec::new();
    }
    let ours = mean_torques(pull);
    (0..JOINTS.len())
        .map(|joint| {
            let pairs: Vec<(f64, f64)> = recorded
                .iter()
                .map(|bin| (ours[bin_of(bin.from_percent)][joint], bin.torques()[joint]))
                .collect();
            Agreement {
                gait: pull.gait.clone(),
                duration_s: pull.duration_s,
                joint: JOINTS[joint].into(),
                rms_nm: rms(&pairs),
                correlation: correlation(&pairs),
            }
        })
        .collect()
}

/// Mean torque in each tenth of the phase, N·m; a row belongs to the tenth that holds the middle
/// of its control step. NaN where a tenth holds no row.
fn mean_torques(pull: &PullRecord) -> [[f64; 4]; BINS] {
    let step_percent = pull.rows.first().map_or(0.0, |row| row.cycle_percent);
    let mut sums = [[0.0; 4]; BINS];
    let mut counts = [0.0; BINS];
    for row in &pull.rows {
        let bin = bin_of(row.cycle_percent - 0.5 * step_percent);
        counts[bin] += 1.0;
        for (sum, torque) in sums[bin].iter_mut().zip(row.torque_nm) {
            *sum += torque;
        }
    }
    for (sum, count) in sums.iter_mut().zip(counts) {
        for sum in sum {
            *sum /= count;
        }
    }
    sums
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "percent is between 0 and 100; the cast saturates otherwise"
)]
fn bin_of(percent: f64) -> usize {
    ((percent / 10.0) as usize).min(BINS - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use prone_record::pulls::PullRow;

    fn pull(rows: usize, torque: impl Fn(f64) -> f64) -> PullRecord {
        PullRecord {
            gait: "nominal".to_owned(),
            duration_s: 5.0,
            rows: (1..=rows)
                .map(|k| {
                    let cycle_percent = 100.0 * k as f64 / rows as f64;
                    PullRow {
                        time_s: 0.05 * k as f64,
                        cycle_percent,
                        torque_nm: [torque(cycle_percent), 0.0, 0.0, 0.0],
                        command_rad: [0.0; 7],
                        angle_rad: [0.0; 7],
                        contact_n: [0.0; 4],
                        top_mm: 0.0,
                        head_top_mm: 0.0,
                    }
                })
                .collect(),
        }
    }

    fn bins(torque: impl Fn(f64) -> f64) -> Vec<TorqueBin> {
        (0..10)
            .map(|k| TorqueBin {
                gait: "nominal".to_owned(),
                duration_s: 5.0,
                from_percent: f64::from(k) * 10.0,
                to_percent: f64::from(k + 1) * 10.0,
                ankle_nm: torque(f64::from(k) * 10.0 + 5.0),
                knee_nm: 0.0,
                hip_nm: 0.0,
                shoulder_nm: 0.0,
            })
            .collect()
    }

    #[test]
    fn the_same_curve_agrees_and_a_shifted_one_differs_by_the_shift() {
        let line = |percent: f64| 0.01 * percent;
        for rows in [20, 100, 140] {
            // A row's torque is the line at the end of its step, half a step after the middle.
            let half_step = 0.005 * 100.0 / rows as f64;
            let ours = pull(rows, |percent| line(percent) - half_step);
            let [ankle, knee, ..] = &of(&[ours], &bins(line))[..] else {
                panic!("four joints");
            };
            assert!(ankle.rms_nm < 1e-12, "{}", ankle.rms_nm);
            assert!((ankle.correlation.unwrap() - 1.0).abs() < 1e-12);
            assert_eq!(knee.correlation, None, "a flat curve has none");
            let shifted = pull(rows, |percent| line(percent) - half_step + 0.3);
            assert!((of(&[shifted], &bins(line))[0].rms_nm - 0.3).abs() < 1e-12);
            let turned = pull(rows, |percent| -line(percent));
            assert!((of(&[turned], &bins(line))[0].correlation.unwrap() + 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_start_of_the_phase_is_left_out() {
        let ours = pull(100, |percent| if percent <= 20.0 { 99.0 } else { 1.0 });
        assert!(of(&[ours], &bins(|_| 1.0))[0].rms_nm < 1e-12);
    }

    #[test]
    fn pulls_that_were_not_recorded_have_no_agreement() {
        let mut ours = pull(100, |_| 1.0);
        ours.duration_s = 4.5;
        assert!(of(&[ours], &bins(|_| 1.0)).is_empty());
    }
}
