//! What a search looks at: points that stand for gaits, and what these cost.

use std::sync::{Mutex, PoisonError};

use prone::gait::cycle::CycleError;
use prone::gait::{CurveError, PhaseDurationError};
use prone_optim::{Answer, Failure, Interval, Query, Score, Scorer};
use prone_record::frontier::SettingKind;
use prone_record::gait_search::Broken;
use prone_record::measure::Measure;
use prone_record::search::Search;
use prone_sim::crawl::CrawlError;
use prone_sim::self_collision::SelfCollisionError;
use rayon::prelude::*;

use super::pull_trial::PullTrialError;
use super::trial::Trial;
use crate::watch::{Progress, Watch};

/// Gaits of one form under one set of rules. It owns what it needs, so that a worker can hold it.
pub trait Candidates: Send + Sync + 'static {
    /// A pull or a cycle.
    type Gait: Clone + Send + Sync;

    /// Limits of each number of a point.
    fn bounds(&self) -> &[Interval];

    /// The point of the gait that is searched about, where there is one.
    fn known(&self) -> Option<&[f64]> {
        None
    }

    /// The gait of a point.
    fn gait(&self, point: &[f64]) -> Result<Self::Gait, PointError>;

    /// The cost of a gait, which depends on nothing but the gait; none where `stopped` said so before it
    /// was known.
    fn cost_unless(
        &self,
        stopped: &dyn Fn() -> bool,
        gait: &Self::Gait,
        depth: Depth,
    ) -> Option<Cost>;

    /// What an optimiser sees of a point, and the rules that are broken there, as far as they are known;
    /// nothing where `stopped` said so before.
    ///
    /// # Errors
    /// [`Failure`] where the point has no gait.
    fn score_unless(
        &self,
        stopped: &dyn Fn() -> bool,
        point: &[f64],
    ) -> Result<Option<(Score, Vec<Broken>)>, Failure> {
        let gait = self
            .gait(point)
            .map_err(|error| Failure::from_error(&error))?;
        let cost = self.cost_unless(stopped, &gait, Depth::UntilBroken);
        Ok(cost.map(|cost| (cost.score(), cost.broken)))
    }
}

/// How far a cost is followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Depth {
    /// As far as a search needs it: what is beaten by its violations already is not simulated.
    UntilBroken,
    /// Everything that can be simulated is, whatever is broken.
    Everything,
}

/// What a gait costs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cost {
    /// What is minimised among gaits that break as much; NaN where it is not known.
    pub value: f64,
    /// What is broken in all, 0 for a gait that keeps the rules.
    pub violation: f64,
    /// The same rule by rule.
    pub broken: Vec<Broken>,
    /// The crawls that were simulated, one a setting.
    pub trials: Vec<Trial>,
    /// Why it could not be moved, where it could not; what it breaks is counted all the same.
    pub refusal: Option<Refusal>,
}

/// Why a gait could not be moved, or has no cost.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// A curve is no polynomial of degree 3 or less, and the published objective has a cost for
    /// nothing else.
    #[error("a curve is no polynomial of degree 3 or less")]
    NotCubic,
    /// The pull cannot be simulated.
    #[error(transparent)]
    Pull(#[from] PullTrialError),
    /// The cycle cannot be planned.
    #[error(transparent)]
    Plan(#[from] CycleError),
    /// Its limbs cannot be compared.
    #[error(transparent)]
    Limbs(#[from] SelfCollisionError),
    /// It cannot be crawled in a setting.
    #[error("{setting}: {source}")]
    Crawl {
        /// Which.
        setting: SettingKind,
        /// Why.
        source: CrawlError,
    },
}

/// Why a point has no gait.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum PointError {
    /// It is a point of another box.
    #[error("a point of {numbers} numbers is given, this box has {variables}")]
    Numbers {
        /// How many numbers it has.
        numbers: usize,
        /// How many the box has.
        variables: usize,
    },
    /// It makes no curve.
    #[error(transparent)]
    Curve(#[from] CurveError),
    /// The pull would be too short or too long.
    #[error("the pull: {0}")]
    Duration(#[from] PhaseDurationError),
}

impl Cost {
    /// What is not known at all: worse than anything that is.
    pub(super) fn unknown() -> Self {
        Self {
            value: f64::NAN,
            violation: f64::MAX,
            ..Self::default()
        }
    }

    /// Adds what is broken of a rule.
    pub(super) fn add(&mut self, rule: &'static str, amount: f64) {
        self.add_all(&[(rule, amount)]);
    }

    /// Adds what is broken of several rules, which are summed up first.
    pub(super) fn add_all(&mut self, rules: &[(&'static str, f64)]) {
        self.violation += rules.iter().map(|(_, amount)| amount).sum::<f64>();
        for &(rule, sum) in rules.iter().filter(|(_, amount)| *amount > 0.0) {
            match self.broken.iter_mut().find(|broken| broken.rule == rule) {
                Some(broken) => {
                    broken.count += 1;
                    broken.sum += sum;
                }
                None => self.broken.push(Broken {
                    rule: rule.into(),
                    count: 1,
                    sum,
                }),
            }
        }
    }

    /// As scores compare: violation before value. Where a rule is broken, a value that is not known
    /// does not count. Where none is, it stays not a number, which never wins.
    pub fn score(&self) -> Score {
        let known = !(self.value.is_nan() && self.violation > 0.0);
        Score::new(self.violation, if known { self.value } else { 0.0 })
    }
}

/// Candidates as the problem of an optimiser. It remembers which rules the best one breaks, for
/// whoever watches.
#[derive(Debug)]
pub struct Searched<'a, C> {
    candidates: &'a C,
    best: Mutex<Option<(Score, Vec<Broken>)>>,
}

impl<C: Candidates> Searched<'_, C> {
    /// What an optimiser sees of a point; nothing where `stopped` said so before it was known.
    fn evaluate_unless(
        &self,
        stopped: &dyn Fn() -> bool,
        point: &[f64],
    ) -> Option<Result<Score, Failure>> {
        let scored = self.candidates.score_unless(stopped, point).transpose()?;
        Some(scored.map(|(score, broken)| {
            if !broken.is_empty() {
                self.remember(score, broken);
            }
            score
        }))
    }
}

impl<'a, C> Searched<'a, C> {
    /// Nothing of them has been looked at.
    pub const fn new(candidates: &'a C) -> Self {
        Self {
            candidates,
            best: Mutex::new(None),
        }
    }

    /// The rules that a score's candidate breaks, if it is the best that was looked at; none of one that
    /// an earlier program has found.
    pub fn broken_by(&self, score: &Score) -> Vec<Broken> {
        let best = self.best.lock().unwrap_or_else(PoisonError::into_inner);
        let own = best.as_ref().filter(|(best, _)| best == score);
        own.map_or_else(Vec::new, |(_, broken)| broken.clone())
    }

    fn remember(&self, score: Score, broken: Vec<Broken>) {
        let mut best = self.best.lock().unwrap_or_else(PoisonError::into_inner);
        if best.as_ref().is_none_or(|(best, _)| score.beats(best)) {
            *best = Some((score, broken));
        }
    }
}

/// Scores candidates on the current rayon pool until a watch says stop: what is not done by then is left
/// out, and the generation is given up.
pub struct Watched<'a, C> {
    searched: Searched<'a, C>,
    watch: &'a dyn Watch,
}

impl<'a, C: Candidates> Watched<'a, C> {
    /// None of them has been looked at.
    pub const fn new(candidates: &'a C, watch: &'a dyn Watch) -> Self {
        Self {
            searched: Searched::new(candidates),
            watch,
        }
    }

    /// Tells the watch how a search goes, with the rules that its best breaks.
    pub fn tell(&self, search: &Search, measure: Measure) {
        let best = search.best();
        let broken = best.map_or_else(Vec::new, |(_, it)| self.searched.broken_by(&it.score));
        self.watch.progress(&Progress::Searching {
            search,
            measure,
            broken: &broken,
        });
    }
}

impl<C: Candidates> Scorer for Watched<'_, C> {
    fn bounds(&self) -> &[Interval] {
        self.searched.candidates.bounds()
    }

    fn known(&self) -> Option<&[f64]> {
        self.searched.candidates.known()
    }

    fn score(&self, batch: &[Query]) -> Vec<Answer> {
        let answers = batch.par_iter().filter_map(|query| {
            let stopped = || self.watch.stop();
            if stopped() {
                return None;
            }
            let score = self.searched.evaluate_unless(&stopped, &query.point)?;
            Some((query.id, score))
        });
        answers.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of one number, whose amount above 1 is broken.
    struct Line([Interval; 1]);

    impl Candidates for Line {
        type Gait = f64;

        fn bounds(&self) -> &[Interval] {
            &self.0
        }

        fn gait(&self, point: &[f64]) -> Result<f64, PointError> {
            Ok(point[0])
        }

        fn cost_unless(&self, stopped: &dyn Fn() -> bool, gait: &f64, _: Depth) -> Option<Cost> {
            if stopped() {
                return None;
            }
            let mut cost = Cost {
                value: -gait,
                ..Cost::default()
            };
            let rule = if *gait > 2.0 { "far" } else { "near" };
            cost.add(rule, (gait - 1.0).max(0.0));
            Some(cost)
        }
    }

    #[test]
    fn the_rules_that_the_best_breaks_are_remembered() {
        let line = Line([Interval::new(0.0, 4.0).unwrap()]);
        let searched = Searched::new(&line);
        let score = |x| searched.evaluate_unless(&|| false, &[x]).unwrap().unwrap();
        let scores = [3.0, 1.5, 2.5].map(score);
        assert!(searched.evaluate_unless(&|| true, &[0.0]).is_none());
        let rules = |score: &Score| {
            let broken = searched.broken_by(score).into_iter();
            broken.map(|it| it.rule.into_owned()).collect::<Vec<_>>()
        };
        assert_eq!(rules(&scores[1]), ["near"]);
        assert!(rules(&scores[0]).is_empty() && rules(&scores[2]).is_empty());
    }

    #[test]
    fn limit_an_unknown_value_never_wins() {
        let score = |violation, value| {
            let cost = Cost {
                value,
                violation,
                ..Cost::default()
            };
            cost.score()
        };
        assert!(score(0.0, 1e300).beats(&score(0.0, f64::NAN)));
        assert_eq!(score(0.5, f64::NAN), Score::new(0.5, 0.0));
        assert_eq!(score(0.5, 3.0), Score::new(0.5, 3.0));
    }
}
