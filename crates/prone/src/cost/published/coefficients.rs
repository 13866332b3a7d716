//! The nine coefficients of a published gait and the six that are free.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_6};

/// θ3, θ4, α at s = 0, rad. The original's own start, whatever constant terms a gait prints.
pub const START: [f64; 3] = [0.28798, 0.47996, -FRAC_PI_6];
/// θ3, θ4, α at s = 1, rad.
pub const END: [f64; 3] = [START[0], START[1], -FRAC_PI_2];
/// Number of coefficients that the end leaves free.
pub const FREE: usize = 6;

/// c3, c2, c1 of θ3, θ4 and α.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficients(pub [[f64; 3]; 3]);

impl Coefficients {
    /// All three straight from start to end: θ3 and θ4 constant, α linear.
    pub const NOMINAL: Self = Self::through_end([0.0; FREE]);

    /// From (c3, c2) of θ3, θ4 and α; c1 follows from the end: c1 = end − start − c3 − c2.
    pub const fn through_end([a3, a2, b3, b2, d3, d2]: [f64; FREE]) -> Self {
        Self([
            [a3, a2, END[0] - START[0] - a3 - a2],
            [b3, b2, END[1] - START[1] - b3 - b2],
            [d3, d2, END[2] - START[2] - d3 - d2],
        ])
    }

    /// By how much the coefficients leave ±`bound`, summed; zero inside.
    pub fn outside(&self, bound: f64) -> f64 {
        self.0
            .iter()
            .flatten()
            .map(|c| (c.abs() - bound).max(0.0))
            .sum()
    }
}
