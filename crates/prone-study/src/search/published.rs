//! The published optimisation as an optimiser sees it: six free coefficients, ±2.
//!
//! The published cost is the torque part and 1000 N²·m²·s per violated sample, so that fewer
//! violated samples win, and torque decides between equals. That is the order of scores here:
//!
//! ```text
//! violation = violated samples, or 505 + the excess of coefficients over ±2      (1)
//! value     = torque part                                                        (2)
//! ```
//!
//! 505 is more than any gait's count (five rules at 101 samples), so that no gait beyond the bounds
//! beats one within.

use prone::chain::ClosedChain;
use prone::cost::published::{
    Coefficients, FREE, PublishedError, PublishedObjective, PublishedRules, SAMPLES, START,
};
use prone::gait::{Curve, CurveError, CurveForm, Gait, LimitsPolicy};
use prone::mapping::{ArmMode, MappingVariant};
use prone::robot::Robot;
use prone::torque_map::TorqueMap;
use prone_optim::{Failure, Interval, IntervalError, Problem, Score};

use super::candidates::PointError;

/// Bound of every coefficient.
pub const BOUND: f64 = 2.0;

/// How far above its threshold the hip is searched, m: where the best gaits keep one sample
/// exactly at the threshold, another implementation's rounding must not count it as below.
pub const HIP_MARGIN: f64 = 1e-9;

/// The published problem on a map.
#[derive(Debug, Clone)]
pub struct PublishedProblem {
    objective: PublishedObjective,
    bounds: [Interval; FREE],
}

/// Why there is no such problem.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PublishedProblemError {
    /// The robot's publication prints no chain.
    #[error("robot {robot} has no published chain, which the objective `published` needs")]
    NoPublishedChain {
        /// The robot's name.
        robot: String,
    },
    /// The map cannot serve.
    #[error(transparent)]
    Map(#[from] PublishedError),
    /// The bounds are no interval, which a constant excludes.
    #[error(transparent)]
    Bounds(#[from] IntervalError),
}

impl PublishedProblem {
    /// The problem of a robot's published chain on a map; `rules` as published or varied.
    pub fn new(
        robot: &Robot,
        map: &TorqueMap,
        rules: PublishedRules,
    ) -> Result<Self, PublishedProblemError> {
        let chain = published_chain(robot)?;
        let searched = PublishedRules {
            hip_threshold: rules.hip_threshold + HIP_MARGIN,
            ..rules
        };
        Ok(Self {
            objective: PublishedObjective::new(chain, map, searched)?,
            bounds: [Interval::new(-BOUND, BOUND)?; FREE],
        })
    }
}

/// The published objective of a robot's published chain on a map.
pub fn objective(
    robot: &Robot,
    map: &TorqueMap,
    rules: PublishedRules,
) -> Result<PublishedObjective, PublishedProblemError> {
    Ok(PublishedObjective::new(
        published_chain(robot)?,
        map,
        rules,
    )?)
}

fn published_chain(robot: &Robot) -> Result<ClosedChain, PublishedProblemError> {
    let published = robot.chain.published;
    published.map(|published| published.chain).ok_or_else(|| {
        PublishedProblemError::NoPublishedChain {
            robot: robot.name.clone(),
        }
    })
}

impl Problem for PublishedProblem {
    fn bounds(&self) -> &[Interval] {
        &self.bounds
    }

    fn evaluate(&self, point: &[f64]) -> Result<Score, Failure> {
        let gait = coefficients(point).map_err(|error| Failure::from_error(&error))?;
        // The three coefficients that follow from the end have the same bounds.
        let outside = gait.outside(BOUND);
        if outside > 0.0 {
            return Ok(Score::new(5.0 * SAMPLES as f64 + outside, 0.0));
        }
        let price = self.objective.price(&gait);
        let violated = f64::from(price.violated.total());
        Ok(Score::new(violated, price.torque))
    }
}

/// The gait's coefficients of a point.
///
/// # Errors
/// [`PointError`] unless it has six numbers.
pub fn coefficients(point: &[f64]) -> Result<Coefficients, PointError> {
    let free: [f64; FREE] = point.try_into().map_err(|_| PointError::Numbers {
        numbers: point.len(),
        variables: FREE,
    })?;
    Ok(Coefficients::through_end(free))
}

/// A gait as the published objective sees it: c3, c2, c1 of its cubics. The objective has a start
/// of its own, so constant terms do not count. `None` where a curve is no polynomial of degree 3
/// or less.
pub fn coefficients_of(gait: &Gait) -> Option<Coefficients> {
    let of = |curve: &Curve| {
        let CurveForm::Polynomial(coefficients) = curve.form() else {
            return None;
        };
        let (above, cubic) = coefficients.split_at(coefficients.len().saturating_sub(4));
        if above.iter().any(|c| *c != 0.0) {
            return None;
        }
        let mut c = [0.0; 4];
        c[4 - cubic.len()..].copy_from_slice(cubic);
        let [c3, c2, c1, _] = c;
        Some([c3, c2, c1])
    };
    let curves = [of(&gait.knee)?, of(&gait.hip)?, of(&gait.upper_arm)?];
    Some(Coefficients(curves))
}

/// The gait of published coefficients, with the published start and mapping.
///
/// # Errors
/// [`CurveError`] where a coefficient is not a finite number.
pub fn gait(name: &str, coefficients: &Coefficients) -> Result<Gait, CurveError> {
    let curve = |parameter: usize| {
        let mut numbers = coefficients.0[parameter].to_vec();
        numbers.push(START[parameter]);
        Curve::polynomial(numbers)
    };
    Ok(Gait {
        name: name.to_owned(),
        description: String::new(),
        knee: curve(0)?,
        hip: curve(1)?,
        upper_arm: curve(2)?,
        mapping: MappingVariant::Original,
        arm: ArmMode::FlatForearm,
        limits: LimitsPolicy::Clamp,
    })
}
