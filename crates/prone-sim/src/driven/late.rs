//! Commands that reach the servos of a robot late.
//!
//! Between a program and the servos of a robot there is a bus. It takes what was commanded last once in
//! a while ([`LateCommands::every`]), and delivers it after a delay, a whole number of engine steps,
//! each number as likely as any other up to a bound. What is commanded in between is lost, but for the
//! last command, which is taken when its time has come. A command overtakes no earlier one. The delay
//! counts from when a command is taken: it was given up to one of the program's own intervals before.

use std::collections::VecDeque;

use prone::regime::Regime;
use prone::robot::JointAngles;

use crate::random::Random;

/// How late commands reach the servos.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LateCommands {
    /// Shortest time between two commands that are taken, s.
    pub every: f64,
    /// Longest delay of a command that is taken, s; what is less than an engine step of it is not used.
    pub at_most: f64,
    /// Seed of the delays.
    pub seed: u64,
}

impl LateCommands {
    /// Time between two commands on a bus that is slow, s: half as often as the NAO's own.
    pub const SLOW: f64 = 0.02;

    /// On such a bus, each late by up to so many ms.
    pub fn slow(ms: f64, seed: u64) -> Self {
        Self {
            every: Self::SLOW,
            at_most: ms / 1e3,
            seed,
        }
    }
}

/// Begins another sequence than that of the inertial unit's noise, which has the same seed.
const STREAM: u64 = 0x6c61_7465_6e65_7373;

/// Commands on their way; time is in engine steps.
#[derive(Debug, Clone)]
pub(super) struct Bus {
    every: usize,
    at_most: usize,
    random: Random,
    /// What was commanded last, where it has not been taken yet.
    waiting: Option<JointAngles>,
    /// When a command was taken last.
    taken: Option<usize>,
    /// What was taken, with the step in which it arrives, the first one first.
    under_way: VecDeque<(usize, JointAngles)>,
}

impl Bus {
    pub(super) fn new(late: LateCommands, regime: &Regime) -> Self {
        // A step is as good as one that rounding has made a little longer.
        let whole = (late.at_most / regime.time_step + 1e-6).floor();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a delay of milliseconds over a step of a tenth of a millisecond or more"
        )]
        let at_most = whole.max(0.0) as usize;
        Self {
            every: regime.steps_in(late.every),
            at_most,
            random: Random::new(late.seed ^ STREAM),
            waiting: None,
            taken: None,
            under_way: VecDeque::new(),
        }
    }

    /// Takes notice of a command, in place of one that still waits.
    pub(super) fn command(&mut self, posture: JointAngles) {
        self.waiting = Some(posture);
    }

    /// What arrives before an engine step, where anything does; once for each step.
    pub(super) fn arrived(&mut self, step: usize) -> Option<JointAngles> {
        if self.taken.is_none_or(|taken| taken + self.every <= step)
            && let Some(posture) = self.waiting.take()
        {
            self.taken = Some(step);
            let drawn = step + self.random.up_to(self.at_most);
            let earlier = self.under_way.back().map_or(0, |(arrival, _)| *arrival);
            self.under_way.push_back((drawn.max(earlier), posture));
        }
        let mut last = None;
        while let Some((_, posture)) = self.under_way.pop_front_if(|(arrival, _)| *arrival <= step)
        {
            last = Some(posture);
        }
        last
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = Regime::LOCOMOTION.time_step;

    /// Gives a command before every `given`th of so many steps, by its number, and returns which
    /// arrive, with the step in which each does.
    fn delivered(late: LateCommands, given: usize, steps: usize) -> Vec<(usize, usize)> {
        let mut bus = Bus::new(late, &Regime::LOCOMOTION);
        let mut delivered = Vec::new();
        for step in 0..steps {
            if step % given == 0 {
                bus.command(JointAngles::from_fn(1, |_| step as f64));
            }
            if let Some(posture) = bus.arrived(step) {
                let number = posture.as_slice()[0];
                let sent = (0..steps).find(|sent| (*sent as f64 - number).abs() < 0.5);
                delivered.push((sent.unwrap(), step));
            }
        }
        delivered
    }

    /// Of commands every 10 ms each second one is taken and arrives up to 20 ms later, in order; over
    /// many, each delay occurs about as often as the others.
    #[test]
    fn identity_commands_arrive_within_the_bound_and_in_order() {
        let late = LateCommands {
            every: 0.02,
            at_most: 0.02,
            seed: 5,
        };
        let delivered = delivered(late, 4, 80_000);
        let mut delays = [0; 9];
        for (sent, arrived) in &delivered {
            assert_eq!(sent % 8, 0, "each second one of those every four steps");
            delays[arrived - sent] += 1;
        }
        assert!(delivered.is_sorted_by(|a, b| a.0 < b.0 && a.1 < b.1));
        // Where one of 20 ms meets one of none, the later one wins: one of 81 is never seen.
        assert!(delivered.len() > 9_800 && delivered.len() < 10_000);
        // Five standard errors of a ninth of ten thousand, and those that were never seen.
        for count in delays {
            assert!((1_111_i32 - count).abs() < 160 + 124, "{delays:?}");
        }
    }

    /// A bus that is never late and takes each command hands it on in the same step.
    #[test]
    fn limit_no_lateness_is_none() {
        let prompt = LateCommands {
            every: STEP,
            at_most: 0.0,
            seed: 1,
        };
        let delivered = delivered(prompt, 1, 100);
        assert_eq!(delivered.len(), 100);
        assert!(delivered.iter().all(|(sent, arrived)| sent == arrived));
    }

    /// The last command of all arrives, though it was given too soon after the one before.
    #[test]
    fn the_last_command_is_not_lost() {
        let late = LateCommands {
            every: 0.02,
            at_most: 0.013,
            seed: 2,
        };
        let mut bus = Bus::new(late, &Regime::LOCOMOTION);
        let posture = |angle: f64| JointAngles::from_fn(1, |_| angle);
        let mut last = None;
        for step in 0..20 {
            match step {
                0 => bus.command(posture(1.0)),
                4 => bus.command(posture(2.0)),
                5 => bus.command(posture(3.0)),
                _ => {}
            }
            if let Some(posture) = bus.arrived(step) {
                last = Some((step, posture));
            }
        }
        let (step, arrived) = last.unwrap();
        assert_eq!(arrived, posture(3.0));
        // 13 ms hold five steps of 2.5 ms.
        assert!((8..=13).contains(&step), "{step}");
    }

    #[test]
    fn a_seed_draws_the_same_delays_and_another_one_others() {
        let with = |seed| {
            let late = LateCommands {
                every: 0.02,
                at_most: 0.02,
                seed,
            };
            delivered(late, 4, 400)
        };
        assert_eq!(with(1), with(1));
        assert_ne!(with(1), with(2));
    }
}
