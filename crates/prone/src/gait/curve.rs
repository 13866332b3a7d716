//! Curves over the phase s ∈ [0, 1].
//!
//! - polynomial: `c_n sⁿ + … + c_1 s + c_0`, by Horner's rule;
//! - B-spline of degree p with m control points on a clamped uniform knot vector (p+1 zeros,
//!   m−p−1 equal steps, p+1 ones), by de Boor's recursion: it starts and ends in its first and
//!   last control point;
//! - interpolating cubic: through given points, second derivative zero at both ends.

/// A smooth function of the phase.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    form: CurveForm,
    /// Second derivative at each point of [`CurveForm::Through`]; other forms have none.
    curvature: Vec<f64>,
}

/// The numbers that a curve was made of.
#[derive(Debug, Clone, PartialEq)]
pub enum CurveForm {
    /// Coefficients, highest power first.
    Polynomial(Vec<f64>),
    /// A clamped uniform B-spline.
    BSpline {
        /// Its degree.
        degree: usize,
        /// Its control points.
        control: Vec<f64>,
    },
    /// A natural cubic spline through points (s, value).
    Through(Vec<(f64, f64)>),
}

/// Why numbers do not make a curve.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum CurveError {
    /// A coefficient, control point or knot is NaN or infinite.
    #[error("{value} is not a finite number")]
    NotFinite {
        /// The number.
        value: f64,
    },
    /// Numbers whose sum is beyond every `f64`, so that the curve's values may be too.
    #[error("numbers as large as {largest:?} make the curve overflow")]
    Overflow {
        /// The number of the largest magnitude.
        largest: f64,
    },
    /// Points between which an interpolating curve's slopes are beyond every `f64`.
    #[error("the curve through these points overflows between the phases {from:?} and {to:?}")]
    Steep {
        /// Phase before the steepest part.
        from: f64,
        /// Phase after it.
        to: f64,
    },
    /// A polynomial without coefficients.
    #[error("a polynomial needs at least one coefficient")]
    NoCoefficients,
    /// Degree outside 1 to 7, or too few control points for it.
    #[error(
        "a B-spline of degree {degree} needs a degree of 1 to 7 and more than that many control points, not {control}"
    )]
    BSpline {
        /// Degree asked for.
        degree: usize,
        /// Control points given.
        control: usize,
    },
    /// Fewer than two points.
    #[error("an interpolating curve needs at least two points, not {points}")]
    TooFewPoints {
        /// Points given.
        points: usize,
    },
    /// The points' phases do not run from 0 to 1 in increasing order.
    #[error("the points' phases must increase from 0 to 1; {s:?} does not fit")]
    Phases {
        /// The phase that does not fit.
        s: f64,
    },
}

/// Largest degree of a B-spline: de Boor's working set lives on the stack.
const MAX_DEGREE: usize = 7;

impl Curve {
    /// The same value at every phase.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`].
    pub fn constant(value: f64) -> Result<Self, CurveError> {
        Self::polynomial(vec![value])
    }

    /// A straight line.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`], [`CurveError::Overflow`].
    pub fn linear(from: f64, to: f64) -> Result<Self, CurveError> {
        // Held against the ends, not their difference: an error names a number that was given.
        summable(&[from, to])?;
        Self::polynomial(vec![to - from, from])
    }

    /// A polynomial, coefficient of the highest power first.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`], [`CurveError::Overflow`], [`CurveError::NoCoefficients`].
    pub fn polynomial(coefficients: Vec<f64>) -> Result<Self, CurveError> {
        summable(&coefficients)?;
        if coefficients.is_empty() {
            return Err(CurveError::NoCoefficients);
        }
        Ok(Self::from_form(CurveForm::Polynomial(coefficients)))
    }

    const fn from_form(form: CurveForm) -> Self {
        Self {
            form,
            curvature: Vec::new(),
        }
    }

    /// What it was made of.
    pub const fn form(&self) -> &CurveForm {
        &self.form
    }

    /// A clamped uniform B-spline.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`], [`CurveError::Overflow`], [`CurveError::BSpline`].
    pub fn b_spline(degree: usize, control: Vec<f64>) -> Result<Self, CurveError> {
        summable(&control)?;
        if !(1..=MAX_DEGREE).contains(&degree) || control.len() <= degree {
            return Err(CurveError::BSpline {
                degree,
                control: control.len(),
            });
        }
        Ok(Self::from_form(CurveForm::BSpline { degree, control }))
    }

    /// A natural cubic spline through points (s, value).
    ///
    /// # Errors
    /// [`CurveError::NotFinite`], [`CurveError::TooFewPoints`], [`CurveError::Phases`],
    /// [`CurveError::Steep`].
    pub fn through(points: Vec<(f64, f64)>) -> Result<Self, CurveError> {
        for &(s, value) in &points {
            all_finite(&[s, value])?;
        }
        let [(first, _), .., (last, _)] = points[..] else {
            return Err(CurveError::TooFewPoints {
                points: points.len(),
            });
        };
        let misplaced = if first != 0.0 {
            Some(first)
        } else if last.to_bits() != 1.0_f64.to_bits() {
            Some(last)
        } else {
            points.windows(2).find(|w| w[1].0 <= w[0].0).map(|w| w[1].0)
        };
        if let Some(s) = misplaced {
            return Err(CurveError::Phases { s });
        }
        let curvature = natural_curvature(&points);
        if !interpolates(&points, &curvature) {
            let (from, to) = steepest(&points);
            return Err(CurveError::Steep { from, to });
        }
        Ok(Self {
            form: CurveForm::Through(points),
            curvature,
        })
    }

    /// The value at phase `s`; phases outside [0, 1] are held at the ends.
    pub fn value(&self, s: f64) -> f64 {
        let s = if s.is_nan() { s } else { s.clamp(0.0, 1.0) };
        match &self.form {
            CurveForm::Polynomial(coefficients) => {
                coefficients.iter().fold(0.0, |sum, c| sum * s + c)
            }
            CurveForm::BSpline { degree, control } => de_boor(*degree, control, s),
            CurveForm::Through(points) => interpolate(points, &self.curvature, s),
        }
    }
}

fn all_finite(numbers: &[f64]) -> Result<(), CurveError> {
    match numbers.iter().find(|number| !number.is_finite()) {
        Some(&value) => Err(CurveError::NotFinite { value }),
        None => Ok(()),
    }
}

/// Finite numbers whose magnitudes have a finite sum. On s ∈ [0, 1] that sum bounds every partial
/// result of Horner's rule, and of de Boor's recursion, which averages.
fn summable(numbers: &[f64]) -> Result<(), CurveError> {
    all_finite(numbers)?;
    let magnitudes = || numbers.iter().map(|number| number.abs());
    if magnitudes().sum::<f64>().is_finite() {
        return Ok(());
    }
    let largest = magnitudes().fold(0.0, f64::max);
    let signed = numbers.iter().find(|number| number.abs() >= largest);
    Err(CurveError::Overflow {
        largest: signed.copied().unwrap_or(largest),
    })
}

/// Whether [`interpolate`] stays finite: between two points the values weigh at most 1, the
/// curvatures at most 1 (by a³ − a and the squared width, both below).
fn interpolates(points: &[(f64, f64)], curvature: &[f64]) -> bool {
    let ends = points.iter().zip(curvature);
    let bounds: Vec<f64> = ends.map(|((_, v), c)| v.abs() + c.abs()).collect();
    bounds
        .windows(2)
        .all(|pair| (pair[0] + pair[1]).is_finite())
}

/// The phases between which the points rise or fall fastest.
fn steepest(points: &[(f64, f64)]) -> (f64, f64) {
    let slope = |pair: &[(f64, f64)]| ((pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0)).abs();
    let pairs = points.windows(2);
    let steepest = pairs.max_by(|a, b| slope(a).total_cmp(&slope(b)));
    steepest.map_or((0.0, 1.0), |pair| (pair[0].0, pair[1].0))
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "s is in [0, 1], so the span index is below the number of control points"
)]
fn de_boor(degree: usize, control: &[f64], s: f64) -> f64 {
    let spans = control.len() - degree;
    // knot(i) for i in 0..control.len()+degree+1, clamped and uniform.
    let knot = |i: usize| (i.saturating_sub(degree).min(spans)) as f64 / spans as f64;
    let span = degree + ((s * spans as f64) as usize).min(spans - 1);
    let mut d = [0.0; MAX_DEGREE + 1];
    d[..=degree].copy_from_slice(&control[span - degree..=span]);
    for level in 1..=degree {
        for j in (level..=degree).rev() {
            let i = span - degree + j;
            let (low, high) = (knot(i), knot(i + degree + 1 - level));
            let weight = (s - low) / (high - low);
            d[j] = (1.0 - weight) * d[j - 1] + weight * d[j];
        }
    }
    d[degree]
}

/// Second derivatives at the points of a natural cubic spline (Thomas' algorithm).
fn natural_curvature(points: &[(f64, f64)]) -> Vec<f64> {
    let n = points.len();
    let mut curvature = vec![0.0; n];
    let (mut upper, mut right) = (vec![0.0; n], vec![0.0; n]);
    for i in 1..n - 1 {
        let before = points[i].0 - points[i - 1].0;
        let after = points[i + 1].0 - points[i].0;
        let slope_after = (points[i + 1].1 - points[i].1) / after;
        let slope_before = (points[i].1 - points[i - 1].1) / before;
        let pivot = 2.0 * (before + after) - before * upper[i - 1];
        upper[i] = after / pivot;
        right[i] = (6.0 * (slope_after - slope_before) - before * right[i - 1]) / pivot;
    }
    for i in (1..n - 1).rev() {
        curvature[i] = right[i] - upper[i] * curvature[i + 1];
    }
    curvature
}

fn interpolate(points: &[(f64, f64)], curvature: &[f64], s: f64) -> f64 {
    let right = points
        .partition_point(|&(knot, _)| knot <= s)
        .clamp(1, points.len() - 1);
    let ((s0, v0), (s1, v1)) = (points[right - 1], points[right]);
    let (width, a) = (s1 - s0, (s1 - s) / (s1 - s0));
    let b = 1.0 - a;
    a * v0
        + b * v1
        + ((a * a * a - a) * curvature[right - 1] + (b * b * b - b) * curvature[right])
            * width
            * width
            / 6.0
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn polynomial_is_highest_power_first() {
        let curve = Curve::polynomial(vec![2.0, 0.0, -1.0]).unwrap();
        assert!((curve.value(0.5) + 0.5).abs() < 1e-15);
    }

    #[test]
    fn phases_outside_are_held_and_nan_stays_nan() {
        let line = Curve::linear(1.0, 3.0).unwrap();
        assert!((line.value(-1.0) - 1.0).abs() < 1e-15);
        assert!((line.value(2.0) - 3.0).abs() < 1e-15);
        assert!(line.value(f64::NAN).is_nan());
    }

    #[test]
    fn a_cubic_b_spline_of_four_points_is_the_bezier_curve() {
        let control = [0.3, -1.0, 2.0, 0.7];
        let curve = Curve::b_spline(3, control.to_vec()).unwrap();
        for k in 0..=10 {
            let s = f64::from(k) / 10.0;
            let r = 1.0 - s;
            let bezier = r * r * r * control[0]
                + 3.0 * r * r * s * control[1]
                + 3.0 * r * s * s * control[2]
                + s * s * s * control[3];
            assert!((curve.value(s) - bezier).abs() < 1e-14);
        }
    }

    proptest! {
        /// A spline through points of a straight line is that line; so is a B-spline whose
        /// control points are a line's values at the Greville abscissae.
        #[test]
        fn splines_reproduce_straight_lines(a in -2.0..2.0_f64, b in -2.0..2.0_f64, s in 0.0..1.0_f64) {
            let line = |s: f64| a + b * s;
            let through = Curve::through([0.0, 0.2, 0.5, 1.0].map(|s| (s, line(s))).to_vec()).unwrap();
            prop_assert!((through.value(s) - line(s)).abs() < 1e-12);
            let greville = [0.0, 1.0 / 9.0, 3.0 / 9.0, 6.0 / 9.0, 8.0 / 9.0, 1.0];
            let spline = Curve::b_spline(3, greville.map(line).to_vec()).unwrap();
            prop_assert!((spline.value(s) - line(s)).abs() < 1e-12);
        }

        #[test]
        fn interpolating_curves_pass_their_points(v in prop::array::uniform5(-2.0..2.0_f64)) {
            let phases = [0.0, 0.1, 0.4, 0.8, 1.0];
            let points: Vec<_> = phases.into_iter().zip(v).collect();
            let curve = Curve::through(points.clone()).unwrap();
            for (s, value) in points {
                prop_assert!((curve.value(s) - value).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_natural_spline_matches_the_textbook_case() {
        // Points (0,0), (½,1), (1,0): by hand, S''(½) = −12 and S(¼) = 11/16.
        let curve = Curve::through(vec![(0.0, 0.0), (0.5, 1.0), (1.0, 0.0)]).unwrap();
        assert!(
            (curve.value(0.25) - 11.0 / 16.0).abs() < 1e-12,
            "{}",
            curve.value(0.25)
        );
    }

    #[test]
    fn numbers_that_make_no_curve_are_refused() {
        assert!(Curve::polynomial(vec![]).is_err());
        assert!(Curve::constant(f64::NAN).is_err());
        assert!(Curve::b_spline(3, vec![0.0; 3]).is_err());
        assert!(Curve::b_spline(0, vec![0.0; 3]).is_err());
        assert!(Curve::through(vec![(0.0, 1.0)]).is_err());
        assert!(Curve::through(vec![(0.0, 1.0), (0.5, 1.0)]).is_err());
        assert!(Curve::through(vec![(0.0, 1.0), (0.7, 1.0), (0.7, 1.0), (1.0, 2.0)]).is_err());
    }

    #[test]
    fn curves_that_overflow_are_refused_with_a_number_that_was_given() {
        let largest = |curve: Result<Curve, CurveError>| match curve {
            Err(CurveError::Overflow { largest }) => largest,
            other => panic!("{other:?}"),
        };
        let same = |a: f64, b: f64| assert_eq!(a.to_bits(), b.to_bits());
        same(largest(Curve::linear(-1e308, 1e308)), -1e308);
        same(
            largest(Curve::polynomial(vec![1.0, 1.5e308, 1e308])),
            1.5e308,
        );
        same(largest(Curve::b_spline(1, vec![f64::MAX; 2])), f64::MAX);
        for points in [
            vec![(0.0, 0.0), (0.5, 1e308), (0.75, -1e308), (1.0, 0.0)],
            vec![(0.0, -1e308), (0.5, 0.0), (0.75, 1.0), (1.0, -1e308)],
            vec![(0.0, 0.0), (0.5, 0.0), (0.75, 1e308), (1.0, 1e308)],
        ] {
            let refused = Curve::through(points.clone()).unwrap_err();
            let CurveError::Steep { from, to } = refused else {
                panic!("{refused:?}");
            };
            assert!(points.iter().any(|&(s, _)| s.to_bits() == from.to_bits()));
            assert!(points.iter().any(|&(s, _)| s.to_bits() == to.to_bits()));
        }
        let near = Curve::through(vec![(0.0, 0.0), (1e-308, 9.0), (1.0, 0.0)]);
        let message = near.unwrap_err().to_string();
        assert!(
            message.ends_with("between the phases 0.0 and 1e-308"),
            "{message}"
        );
    }

    proptest! {
        #[test]
        fn whatever_is_accepted_is_finite(
            numbers in prop::collection::vec(prop_oneof![-1.7e308..1.7e308_f64, -2.0..2.0_f64], 2..6),
            s in 0.0..=1.0_f64,
        ) {
            let last = (numbers.len() - 1) as f64;
            let points = numbers.iter().enumerate().map(|(k, &v)| (k as f64 / last, v)).collect();
            for curve in [
                Curve::linear(numbers[0], numbers[1]),
                Curve::polynomial(numbers.clone()),
                Curve::b_spline(1, numbers.clone()),
                Curve::through(points),
            ] {
                prop_assert!(curve.map_or(0.0, |curve| curve.value(s)).is_finite());
            }
        }
    }
}
