//! Gaits priced by a source of static torques: the statics, or a torque map.

use prone::cost::graded::{self, Norm, Price, Rule, Rules};
use prone::gait::{Gait, PhaseDuration};
use prone::mapping::{Mapping, MappingError};
use prone::robot::Robot;
use prone::torque_map::TorqueSource;

use super::pricing::{Pricing, Share};
use super::rules::{ChainRules, phase, samples};

/// Intervals of a phase, as in the published objective.
const INTERVALS: usize = 100;

/// Prices gaits by one objective on one source.
#[derive(Debug)]
pub struct StaticPricing<'r, Source> {
    robot: &'r Robot,
    mapping: Mapping,
    source: Source,
    norm: Norm,
    share: Share,
    rules: ChainRules,
    duration: PhaseDuration,
}

impl<'r, Source: TorqueSource> StaticPricing<'r, Source> {
    /// A pricing of gaits that share mapping and arms with `base`. A phase of equal postures costs
    /// in proportion to its `duration`.
    ///
    /// # Errors
    /// [`MappingError`].
    pub fn new(
        robot: &'r Robot,
        base: &Gait,
        source: Source,
        norm: Norm,
        share: Share,
        rules: ChainRules,
        duration: PhaseDuration,
    ) -> Result<Self, MappingError> {
        Ok(Self {
            robot,
            mapping: Mapping::new(robot, base.mapping, base.arm)?,
            source,
            norm,
            share,
            rules,
            duration,
        })
    }
}

impl<Source: TorqueSource> Pricing for StaticPricing<'_, Source> {
    fn price(&self, gait: &Gait) -> Price {
        let chain = self.mapping.chain();
        // The rules are held against a finer grid than the torques.
        let none = Rules {
            clearance: 0.0,
            height: |_: &_| 0.0,
            rate: f64::INFINITY,
        };
        let samples = samples(gait, INTERVALS);
        let per = self.share.of(chain, gait);
        let phase = phase(&samples, self.duration);
        let mut price = graded::price(chain, phase, &self.source, &none, &self.norm, per);
        let mut violations = self
            .rules
            .broken(self.robot, &self.mapping, gait, self.duration);
        let gaps = price
            .violations
            .iter()
            .filter(|(rule, _)| *rule == Rule::Torque);
        for (rule, excess) in gaps {
            violations.add(rule, excess.sum);
        }
        price.violations = violations;
        price
    }
}
