//! What the robot bumped into.

use std::collections::BTreeMap;

use prone::robot::BodyId;

use crate::simulation::Simulation;
use crate::world::{GeomRole, World};

/// A part of the robot and an obstacle that met. Ramps are ground and do not count.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// The part of the robot.
    pub body: BodyId,
    /// The obstacle's place in [`prone::scene::Scene::obstacles`].
    pub obstacle: usize,
    /// How often they met: touching again without an engine step apart is the same meeting.
    pub count: usize,
    /// When they first met, s since the first pull began.
    pub first: f64,
    /// How long they touched in all, s.
    pub seconds: f64,
    /// The largest normal force between them, N: where they touch in several places, of all.
    pub peak: f64,
}

/// Touches while a crawl goes on.
#[derive(Debug, Clone, Default)]
pub(super) struct Touches {
    /// By body, then by obstacle: the touch so far, and when it was last seen.
    met: BTreeMap<(BodyId, usize), (Touch, Option<Seen>)>,
    /// Which obstacles count.
    walls: Vec<bool>,
}

/// When a touch was last seen.
#[derive(Debug, Clone, Copy)]
struct Seen {
    /// In which engine step.
    step: usize,
    /// Normal force in it so far, N.
    force: f64,
}

/// When something is seen.
#[derive(Debug, Clone, Copy)]
struct Instant {
    /// In which engine step.
    step: usize,
    /// Since the first pull began, s.
    time: f64,
    /// Length of the step, s.
    seconds: f64,
}

impl Touches {
    pub(super) fn new(world: &World) -> Self {
        let obstacles = world.obstacles().iter();
        Self {
            walls: obstacles.map(|it| !it.kind.is_ground()).collect(),
            ..Self::default()
        }
    }

    /// After each engine step, `time` s after the first pull began.
    pub(super) fn step(&mut self, simulation: &Simulation, time: f64) {
        if !self.walls.contains(&true) {
            return;
        }
        let now = Instant {
            step: simulation.steps(),
            time,
            seconds: simulation.time_step(),
        };
        for contact in simulation.contacts() {
            if let GeomRole::Obstacle(obstacle) = contact.with
                && self.walls[obstacle]
            {
                self.meet(contact.body, obstacle, contact.normal(), now);
            }
        }
    }

    /// A contact with a normal force, N; one of several, where a part meets an obstacle in several
    /// places in the same step.
    fn meet(&mut self, body: BodyId, obstacle: usize, normal: f64, now: Instant) {
        let new = Touch {
            body,
            obstacle,
            count: 0,
            first: now.time,
            seconds: 0.0,
            peak: 0.0,
        };
        let (touch, seen) = self.met.entry((body, obstacle)).or_insert((new, None));
        let already = seen.filter(|seen| seen.step == now.step);
        if already.is_none() {
            touch.seconds += now.seconds;
            if seen.is_none_or(|seen| seen.step + 1 != now.step) {
                touch.count += 1;
            }
        }
        let force = already.map_or(0.0, |seen| seen.force) + normal;
        touch.peak = touch.peak.max(force);
        *seen = Some(Seen {
            step: now.step,
            force,
        });
    }

    /// Whether it has met anything so far.
    pub(super) fn any(&self) -> bool {
        !self.met.is_empty()
    }

    pub(super) fn finish(self) -> Vec<Touch> {
        self.met.into_values().map(|(touch, _)| touch).collect()
    }
}

#[cfg(test)]
mod tests;
