//! What a crawl costs.
//!
//! [`squared_torque_integral`] costs a record as the published study does; [`published`] repeats
//! the original objective to the digit; [`graded`] keeps torque and violations apart and compares
//! them in that order of importance.

pub mod graded;
pub mod objective;
pub mod published;

/// Integral over time of the sum of squared torques, N²·m²·s, by the trapezoid rule.
///
/// `torques[k]` holds one side's joint torques, N·m, at `time_s[k]`; the first row is held back
/// to t = 0, as the records are means over a control step whose end is `time_s[k]`. This is the
/// cost that the original study plots against the gait's duration (its axis says N²/m²).
///
/// # Errors
/// [`CostError`] where the two slices differ in length, are empty, or time does not increase.
pub fn squared_torque_integral<const JOINTS: usize>(
    time_s: &[f64],
    torques: &[[f64; JOINTS]],
) -> Result<f64, CostError> {
    if time_s.len() != torques.len() {
        return Err(CostError::Lengths {
            times: time_s.len(),
            rows: torques.len(),
        });
    }
    let squared = |row: &[f64; JOINTS]| row.iter().map(|torque| torque * torque).sum::<f64>();
    let first = torques.first().ok_or(CostError::Empty)?;
    let (mut before, mut previous) = (0.0, squared(first));
    let mut integral = 0.0;
    for (row, (&time, torque)) in time_s.iter().zip(torques).enumerate() {
        if time
            .partial_cmp(&before)
            .is_none_or(std::cmp::Ordering::is_le)
        {
            return Err(CostError::Time { row, time });
        }
        let current = squared(torque);
        integral += 0.5 * (previous + current) * (time - before);
        (before, previous) = (time, current);
    }
    Ok(integral)
}

/// Why a record has no cost.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum CostError {
    /// No rows.
    #[error("the record has no rows")]
    Empty,
    /// One time per row is needed.
    #[error("{times} times for {rows} rows of torque")]
    Lengths {
        /// Number of times.
        times: usize,
        /// Number of rows.
        rows: usize,
    },
    /// Time stands still, runs back or is not a number.
    #[error("time {time} s in row {row} does not lie after the row before it")]
    Time {
        /// The row, from 0.
        row: usize,
        /// Its time, s.
        time: f64,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_torque_costs_its_square_times_the_duration() {
        let times: Vec<f64> = (1..=20).map(|k| f64::from(k) * 0.05).collect();
        let cost = squared_torque_integral(&times, &vec![[0.5, -1.0]; 20]).unwrap();
        assert!((cost - 1.25).abs() < 1e-12, "{cost}");
    }

    #[test]
    fn a_ramp_is_integrated_by_trapezoids() {
        // Torques 1, 2 at 1, 2 s: 1·1 held back to 0, then (1 + 4)/2.
        let cost = squared_torque_integral(&[1.0, 2.0], &[[1.0], [2.0]]).unwrap();
        assert!((cost - 3.5).abs() < 1e-15, "{cost}");
    }

    #[test]
    fn bad_records_are_errors() {
        assert_eq!(
            squared_torque_integral::<1>(&[], &[]),
            Err(CostError::Empty)
        );
        assert!(squared_torque_integral(&[0.0], &[[1.0]]).is_err());
        assert!(squared_torque_integral(&[f64::NAN], &[[1.0]]).is_err());
        assert!(squared_torque_integral(&[1.0, 1.0], &[[1.0], [1.0]]).is_err());
        assert!(squared_torque_integral(&[1.0], &[[1.0], [1.0]]).is_err());
    }
}
