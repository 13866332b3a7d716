//! What the ground carries in a crawl.

use prone::motor::HEAD_CARRIES;
use prone::robot::ContactGroup;

/// What the ground carried over a time, by [`ContactGroup::ALL`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GroundLoad {
    /// ∫ normal force dt, N·s.
    pub impulse: [f64; ContactGroup::COUNT],
    /// Largest mean over [`super::ROW_STEP`], N.
    pub peak: [f64; ContactGroup::COUNT],
    /// How long that mean was [`HEAD_CARRIES`] or more, s.
    pub carried: [f64; ContactGroup::COUNT],
}

impl GroundLoad {
    /// Adds an engine step of some length, s, with its forces, N.
    pub(super) fn add_step(&mut self, forces: [f64; ContactGroup::COUNT], seconds: f64) {
        for (sum, force) in self.impulse.iter_mut().zip(forces) {
            *sum += force * seconds;
        }
    }

    /// Adds the means of a row, N, of some length, s.
    pub(super) fn add_row(&mut self, means: [f64; ContactGroup::COUNT], seconds: f64) {
        for (group, force) in means.into_iter().enumerate() {
            self.peak[group] = self.peak[group].max(force);
            if force >= HEAD_CARRIES {
                self.carried[group] += seconds;
            }
        }
    }

    pub(super) fn add(&mut self, other: &Self) {
        for group in 0..ContactGroup::COUNT {
            self.impulse[group] += other.impulse[group];
            self.peak[group] = self.peak[group].max(other.peak[group]);
            self.carried[group] += other.carried[group];
        }
    }

    /// Largest mean force on the head over [`super::ROW_STEP`], N.
    pub const fn head_peak(&self) -> f64 {
        self.peak[ContactGroup::Head as usize]
    }
}

/// Sums over a stage of what the ground carries.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct BodyLoad {
    body: f64,
    all: f64,
}

impl BodyLoad {
    pub(super) fn add(&mut self, forces: [f64; ContactGroup::COUNT]) {
        for (group, force) in ContactGroup::ALL.into_iter().zip(forces) {
            self.all += force;
            if group.is_body() {
                self.body += force;
            }
        }
    }

    /// Share on trunk, head and legs; 0 where nothing is carried.
    pub(super) fn share(self) -> f64 {
        if self.all > 0.0 {
            self.body / self.all
        } else {
            0.0
        }
    }
}
