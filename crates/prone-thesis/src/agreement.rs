//! How closely our torques follow the recorded ones.
//!
//! Both are means over tenths of the phase. The first two tenths are left out: there the robot
//! still travels from its start pose and lies on its belly.

use prone_record::statistics::{correlation, rms};
use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::published::TorqueBin;
use prone_record::pulls::{JOINTS, PullRecord, PullRow};

/// Percent of the phase from which on the two are compared.
pub const FROM_PERCENT: f64 = 20.0;

/// Into how many parts a phase is divided.
pub(crate) const TENTHS: usize = 10;

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
    let ours = tenth_means(pull, |_, row| Some(row.torque_nm));
    (0..JOINTS.len())
        .map(|joint| {
            let pairs: Vec<(f64, f64)> = recorded
                .iter()
                .map(|bin| {
                    let ours = ours[tenth_of(bin.from_percent)];
                    let ours = ours.map_or(f64::NAN, |torques| torques[joint]);
                    (ours, bin.torques()[joint])
                })
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

/// Means over each tenth of the phase of what a row has, by the row's place and the row; a row belongs
/// to the tenth that holds the middle of its control step. `None` where no row of a tenth has it.
pub(crate) fn tenth_means<const N: usize>(
    pull: &PullRecord,
    value: impl Fn(usize, &PullRow) -> Option<[f64; N]>,
) -> [Option<[f64; N]>; TENTHS] {
    let step_percent = pull.rows.first().map_or(0.0, |row| row.cycle_percent);
    let mut sums = [[0.0; N]; TENTHS];
    let mut counts = [0_u32; TENTHS];
    for (index, row) in pull.rows.iter().enumerate() {
        let Some(values) = value(index, row) else {
            continue;
        };
        let tenth = tenth_of(row.cycle_percent - 0.5 * step_percent);
        counts[tenth] += 1;
        for (sum, value) in sums[tenth].iter_mut().zip(values) {
            *sum += value;
        }
    }
    std::array::from_fn(|tenth| {
        let count = counts[tenth];
        (count > 0).then(|| sums[tenth].map(|sum| sum / f64::from(count)))
    })
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "percent is between 0 and 100; the cast saturates otherwise"
)]
fn tenth_of(percent: f64) -> usize {
    ((percent / 10.0) as usize).min(TENTHS - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

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
                        squeeze_n: 0.0,
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
