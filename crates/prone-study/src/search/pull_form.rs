//! Gaits as points of a box, so that an optimiser that knows only numbers can search them.
//!
//! Each curve is made of n numbers, its first and last one at the ends of the phase:
//!
//! ```text
//! cubic:      values at s = 0, 1/3, 2/3, 1                                       (1)
//! B-spline:   n control points, cubic, clamped and uniform                       (2)
//! ```
//!
//! (1) has no bound on the coefficients c3…c0; those of [`PullForm::bounds`] are bounds on
//! where the joints go. The ends of α are always those of the base gait: they set the stroke,
//! l5 (cos α(0) − cos α(1)), which gaits must share to be compared. The ends of θ3 and θ4 are kept
//! or free ([`Ends`]).

use prone::chain::GaitParameters;
use prone::gait::{Curve, CurveError, Gait};
use prone_optim::{Interval, IntervalError};

pub use prone_record::experiment::{Ends, GaitForm};

/// Degree of the B-splines.
const DEGREE: usize = 3;

/// How far θ3 and θ4 are searched from the straight line between the base gait's ends, rad: 60°,
/// more than the speed limit of 200° per phase lets them go and come back.
const LEG_REACH: f64 = std::f64::consts::FRAC_PI_3;

/// The same for α, rad: 45°. The upper arm sweeps 60° in a phase.
const ARM_REACH: f64 = std::f64::consts::FRAC_PI_4;

/// Why a form cannot be searched.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum FormError {
    /// Too few control points for a cubic spline, or more than make sense.
    #[error("a B-spline of {points} control points is outside 4..32")]
    Points {
        /// Points asked for.
        points: usize,
    },
    /// The base gait's ends are no numbers.
    #[error("the base gait cannot be searched around: {0}")]
    Base(#[from] IntervalError),
}

/// How many numbers a curve has.
const fn numbers_per_curve(form: GaitForm) -> usize {
    match form {
        GaitForm::Cubic => 4,
        GaitForm::BSpline { points } => points,
    }
}

/// A box of numbers and the gaits they stand for.
#[derive(Debug, Clone, PartialEq)]
pub struct PullForm {
    form: GaitForm,
    ends: Ends,
    base: Gait,
    /// Values of θ3, θ4, α at both ends.
    fixed: [[f64; 2]; 3],
    bounds: Vec<Interval>,
}

impl PullForm {
    /// Gaits of a form about a base gait, whose mapping, arms and limits policy they keep.
    pub fn new(form: GaitForm, ends: Ends, base: &Gait) -> Result<Self, FormError> {
        if !(4..=32).contains(&numbers_per_curve(form)) {
            return Err(FormError::Points {
                points: numbers_per_curve(form),
            });
        }
        let (start, end) = (parts(base.parameters(0.0)), parts(base.parameters(1.0)));
        let fixed = std::array::from_fn(|curve| [start[curve], end[curve]]);
        let mut bounds = Vec::new();
        for (curve, [start, end]) in fixed.into_iter().enumerate() {
            let reach = if curve == ARM { ARM_REACH } else { LEG_REACH };
            for number in searched(form, ends, curve) {
                let s = number as f64 / (numbers_per_curve(form) - 1) as f64;
                let middle = start + s * (end - start);
                bounds.push(Interval::new(middle - reach, middle + reach)?);
            }
        }
        Ok(Self {
            form,
            ends,
            base: base.clone(),
            fixed,
            bounds,
        })
    }

    /// Limits of the numbers, rad.
    pub fn bounds(&self) -> &[Interval] {
        &self.bounds
    }

    /// The form.
    pub const fn form(&self) -> GaitForm {
        self.form
    }

    /// The ends.
    pub const fn ends(&self) -> Ends {
        self.ends
    }

    /// The gait of a point; it bears the base gait's name.
    pub fn gait(&self, point: &[f64]) -> Result<Gait, CurveError> {
        let mut numbers = point.iter().copied();
        let mut curve = |curve: usize| {
            let mut values = vec![f64::NAN; numbers_per_curve(self.form)];
            if let ([first, .., last], [start, end]) = (&mut values[..], self.fixed[curve]) {
                (*first, *last) = (start, end);
            }
            for (index, number) in searched(self.form, self.ends, curve).zip(&mut numbers) {
                values[index] = number;
            }
            match self.form {
                GaitForm::Cubic => Curve::polynomial(through_thirds(&values)),
                GaitForm::BSpline { .. } => Curve::b_spline(DEGREE, values),
            }
        };
        let (knee, hip, upper_arm) = (curve(0)?, curve(1)?, curve(ARM)?);
        Ok(Gait {
            knee,
            hip,
            upper_arm,
            ..self.base.clone()
        })
    }
}

/// Index of α among the curves.
const ARM: usize = 2;

const fn parts(at: GaitParameters) -> [f64; 3] {
    [at.knee, at.hip, at.upper_arm]
}

/// Which of a curve's numbers are searched.
fn searched(form: GaitForm, ends: Ends, curve: usize) -> std::ops::Range<usize> {
    let last = numbers_per_curve(form) - 1;
    if curve != ARM && ends == Ends::Free {
        0..last + 1
    } else {
        1..last
    }
}

/// [c3, c2, c1, c0] of the cubic through values at 0, 1/3, 2/3 and 1.
fn through_thirds(values: &[f64]) -> Vec<f64> {
    let [v0, v1, v2, v3] = [values[0], values[1], values[2], values[3]];
    let c1 = 0.5 * (-11.0 * v0 + 18.0 * v1 - 9.0 * v2 + 2.0 * v3);
    let c3 = 4.5 * (-v0 + 3.0 * v1 - 3.0 * v2 + v3);
    // What is left makes the end exact but for one rounding.
    let c2 = v3 - v0 - c1 - c3;
    vec![c3, c2, c1, v0]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn base() -> Gait {
        Gait {
            name: "base".into(),
            description: String::new(),
            knee: Curve::linear(0.2, 0.4).unwrap(),
            hip: Curve::constant(0.5).unwrap(),
            upper_arm: Curve::linear(-0.5, -1.5).unwrap(),
            mapping: prone::mapping::MappingVariant::Original,
            arm: prone::mapping::ArmMode::FlatForearm,
            limits: prone::gait::LimitsPolicy::Clamp,
        }
    }

    #[test]
    fn the_middle_of_the_box_is_the_straight_gait() {
        for (form, ends, count) in [
            (GaitForm::Cubic, Ends::Fixed, 6),
            (GaitForm::Cubic, Ends::Free, 10),
            (GaitForm::BSpline { points: 8 }, Ends::Fixed, 18),
            (GaitForm::BSpline { points: 8 }, Ends::Free, 22),
        ] {
            let forms = PullForm::new(form, ends, &base()).unwrap();
            assert_eq!(forms.bounds().len(), count);
            let middle: Vec<f64> = forms.bounds().iter().map(|i| i.at(0.5)).collect();
            let gait = forms.gait(&middle).unwrap();
            for s in [0.0, 1.0] {
                for (ours, base) in parts(gait.parameters(s))
                    .iter()
                    .zip(parts(base().parameters(s)))
                {
                    assert!((ours - base).abs() < 1e-12, "{form} at {s}");
                }
            }
        }
    }

    #[test]
    fn limit_numbers_of_control_points() {
        for points in [0, 3, 33] {
            let form = GaitForm::BSpline { points };
            assert_eq!(
                PullForm::new(form, Ends::Fixed, &base()).unwrap_err(),
                FormError::Points { points }
            );
        }
    }

    proptest! {
        #[test]
        fn identity_a_cubic_goes_through_its_values(values in prop::array::uniform4(-3.0..3.0_f64)) {
            let cubic = Curve::polynomial(through_thirds(&values)).unwrap();
            for (k, value) in values.into_iter().enumerate() {
                prop_assert!((cubic.value(k as f64 / 3.0) - value).abs() < 1e-12);
            }
        }

        /// The stroke is fixed by the ends of α, whatever else is free.
        #[test]
        fn identity_fixed_ends_stay(shares in prop::collection::vec(0.0..1.0_f64, 22)) {
            for (form, ends) in [(GaitForm::Cubic, Ends::Fixed), (GaitForm::BSpline { points: 8 }, Ends::Free)] {
                let forms = PullForm::new(form, ends, &base()).unwrap();
                let point: Vec<f64> = forms.bounds().iter().zip(&shares).map(|(i, &s)| i.at(s)).collect();
                let gait = forms.gait(&point).unwrap();
                for s in [0.0, 1.0] {
                    let (ours, base) = (gait.parameters(s), base().parameters(s));
                    prop_assert!((ours.upper_arm - base.upper_arm).abs() < 1e-12);
                    if ends == Ends::Fixed {
                        prop_assert!((ours.knee - base.knee).abs() < 1e-12);
                        prop_assert!((ours.hip - base.hip).abs() < 1e-12);
                    }
                }
            }
        }
    }
}
