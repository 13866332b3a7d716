//! The nodes of a torque map, as a user asks for them: in degrees.

use prone::torque_map::{Axis, Grid, GridError};

/// θ3 and α of the published table, and where its θ4 begins, degrees.
const THETA3_DEG: [f64; 2] = [-5.0, 45.0];
const THETA4_FROM_DEG: f64 = -30.0;
const ALPHA_DEG: [f64; 2] = [-90.0, -30.0];

/// Half a turn: no hinge bends further.
const THETA4_MOST_DEG: f64 = 180.0;

/// Rows of the largest map; a step of 1° makes fewer, one of 0.5° more.
pub const MOST_ROWS: usize = 200_000;

/// A regular grid over θ3, θ4 and α with one step for all three.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodeGrid {
    step_deg: f64,
    theta4_max_deg: f64,
    grid: Grid,
}

/// Why what was asked for is no grid.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum NodeGridError {
    /// Zero, negative or not a number.
    // `:?`: a number of many digits is written with its exponent.
    #[error("a step of {step_deg:?}° is not a positive number of degrees")]
    Step {
        /// What was asked for, degrees.
        step_deg: f64,
    },
    /// The range of θ4 is empty, endless or not a number.
    #[error(
        "theta4 up to {theta4_max_deg:?}° is outside {THETA4_FROM_DEG}..{THETA4_MOST_DEG}°, its lower end excluded"
    )]
    Range {
        /// What was asked for, degrees.
        theta4_max_deg: f64,
    },
    /// A range is not a whole number of steps.
    #[error(
        "a step of {step_deg:?}° does not divide {axis} from {low_deg}° to {high_deg}°: its last node would be {last_deg}°, short of the bound of {high_deg}°"
    )]
    Divides {
        /// What was asked for, degrees.
        step_deg: f64,
        /// The axis.
        axis: &'static str,
        /// Its lower bound, degrees.
        low_deg: f64,
        /// Its upper bound, degrees.
        high_deg: f64,
        /// The last node below the bound, degrees.
        last_deg: f64,
    },
    /// More rows than [`MOST_ROWS`].
    #[error("a step of {step_deg:?}° makes {rows:.3e} rows, more than {MOST_ROWS}")]
    Rows {
        /// What was asked for, degrees.
        step_deg: f64,
        /// How many rows that would be.
        rows: f64,
    },
    /// Numbers that make no axis.
    #[error(transparent)]
    Grid(#[from] GridError),
}

impl NodeGrid {
    /// θ3 −5…45°, θ4 −30° to a bound, α −90…−30°.
    pub fn new(step_deg: f64, theta4_max_deg: f64) -> Result<Self, NodeGridError> {
        if !(step_deg > 0.0 && step_deg.is_finite()) {
            return Err(NodeGridError::Step { step_deg });
        }
        if !(theta4_max_deg > THETA4_FROM_DEG && theta4_max_deg <= THETA4_MOST_DEG) {
            return Err(NodeGridError::Range { theta4_max_deg });
        }
        let ranges = [
            ("theta3", THETA3_DEG),
            ("theta4", [THETA4_FROM_DEG, theta4_max_deg]),
            ("alpha", ALPHA_DEG),
        ];
        for (axis, range) in ranges {
            check_divides(step_deg, axis, range)?;
        }
        let nodes = ranges.map(|(_, [low, high])| ((high - low) / step_deg).round() + 1.0);
        let rows = nodes.iter().product();
        if rows > MOST_ROWS as f64 {
            return Err(NodeGridError::Rows { step_deg, rows });
        }
        let axis = |place: usize| {
            let [low, high] = ranges[place].1;
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "2 to MOST_ROWS"
            )]
            let nodes = nodes[place] as usize;
            Axis::new(low.to_radians(), high.to_radians(), nodes)
        };
        Ok(Self {
            step_deg,
            theta4_max_deg,
            grid: Grid {
                knee: axis(0)?,
                hip: axis(1)?,
                upper_arm: axis(2)?,
            },
        })
    }

    /// The same in radians.
    pub const fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Bounds of θ3, θ4 and α and the step, in words.
    pub(super) fn bounds(&self) -> [(&'static str, String); 4] {
        let range = |[low, high]: [f64; 2]| format!("{low}..{high} deg");
        [
            ("theta3", range(THETA3_DEG)),
            ("theta4", range([THETA4_FROM_DEG, self.theta4_max_deg])),
            ("alpha", range(ALPHA_DEG)),
            ("step", format!("{} deg", self.step_deg)),
        ]
    }
}

fn check_divides(
    step_deg: f64,
    axis: &'static str,
    [low_deg, high_deg]: [f64; 2],
) -> Result<(), NodeGridError> {
    /// Part of a step by which decimal steps miss a bound in binary.
    const SLACK: f64 = 1e-6;
    let steps = (high_deg - low_deg) / step_deg;
    if steps.round() >= 1.0 && (steps - steps.round()).abs() <= SLACK {
        return Ok(());
    }
    let last_deg = low_deg + steps.floor() * step_deg;
    Err(NodeGridError::Divides {
        step_deg,
        axis,
        low_deg,
        high_deg,
        // A millionth of a degree is enough to be read.
        last_deg: (last_deg * 1e6).round() / 1e6,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reference_grids_of_the_published_tables() {
        // Thesis: 21 × 19 × 25 = 9,975 and the recorded table up to 27.5°: 21 × 24 × 25.
        for (step, most, rows) in [(2.5, 15.0, 9975), (2.5, 27.5, 12_600), (5.0, 15.0, 1430)] {
            assert_eq!(NodeGrid::new(step, most).unwrap().grid().len(), rows);
        }
        let thirds = NodeGrid::new(5.0 / 3.0, 20.0).unwrap();
        assert_eq!(thirds.grid().knee.len(), 31, "thirds are not exact");
    }

    #[test]
    fn limit_what_is_no_grid_is_refused_with_value_and_bound() {
        let refusal = |step, most| NodeGrid::new(step, most).unwrap_err().to_string();
        assert_eq!(
            refusal(7.0, 27.5),
            "a step of 7.0° does not divide theta3 from -5° to 45°: its last node would be 44°, short of the bound of 45°"
        );
        assert_eq!(
            refusal(5.0, 27.5),
            "a step of 5.0° does not divide theta4 from -30° to 27.5°: its last node would be 25°, short of the bound of 27.5°"
        );
        assert!(refusal(400.0, 27.5).contains("its last node would be -5°"));
        for step in [0.0, -2.5, f64::NAN, f64::INFINITY] {
            let expected = format!("a step of {step:?}° is not a positive number of degrees");
            assert_eq!(refusal(step, 27.5), expected);
        }
        for most in [-30.0, -40.0, f64::NAN, 181.0, f64::INFINITY] {
            assert!(refusal(2.5, most).starts_with(&format!("theta4 up to {most:?}° is outside")));
        }
        assert_eq!(
            refusal(0.5, 27.5),
            "a step of 0.5° makes 1.418e6 rows, more than 200000"
        );
        assert!(refusal(1e-300, 27.5).len() < 200);
    }
}
