//! What the robot bumped into.

use prone::robot::BodyId;

use crate::simulation::Simulation;
use crate::world::World;

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
    /// By body, then by obstacle.
    met: Vec<Touch>,
    /// Of each touch: when it was last seen, in engine steps, and its force in that step.
    seen: Vec<(usize, f64)>,
    /// Which obstacles count.
    walls: Vec<bool>,
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
        let step = simulation.steps();
        for contact in simulation.obstacle_contacts() {
            if !self.walls[contact.obstacle] {
                continue;
            }
            let key = (contact.body, contact.obstacle);
            let place = self
                .met
                .binary_search_by_key(&key, |touch| (touch.body, touch.obstacle));
            let index = place.unwrap_or_else(|index| {
                self.met.insert(
                    index,
                    Touch {
                        body: contact.body,
                        obstacle: contact.obstacle,
                        count: 0,
                        first: time,
                        seconds: 0.0,
                        peak: 0.0,
                    },
                );
                self.seen.insert(index, (0, 0.0));
                index
            });
            let (touch, seen) = (&mut self.met[index], &mut self.seen[index]);
            if seen.0 != step {
                touch.seconds += simulation.time_step();
                if seen.0 + 1 != step {
                    touch.count += 1;
                }
                *seen = (step, 0.0);
            }
            seen.1 += contact.normal;
            touch.peak = touch.peak.max(seen.1);
        }
    }

    pub(super) fn finish(self) -> Vec<Touch> {
        self.met
    }
}
