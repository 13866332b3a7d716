//! When a crawler is asked, and in which form it answers.

/// How often a crawler is asked, and in which form it answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    tick: f64,
    delivery: Delivery,
}

/// In which form a crawler commands a phase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Delivery {
    /// One posture every so often, s: the one that is to be reached when the next one comes.
    SetPoints {
        /// Time between two of them, s.
        every: f64,
    },
    /// The whole phase at once as a path in time, for a robot that follows it by itself.
    Segments {
        /// Time between two knots, s, at the most; every waypoint is a knot besides.
        every: f64,
    },
}

/// A timing that no crawl can have.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum TimingError {
    /// Ticks take no time, or ages.
    #[error("a tick of {tick_s} s is outside {}..{} s", Timing::TICK.0, Timing::TICK.1)]
    Tick {
        /// What was asked for, s.
        tick_s: f64,
    },
    /// Commands come faster than ticks, or hardly ever.
    #[error(
        "a command every {every_s} s is outside {tick_s}..{} s",
        Timing::SLOWEST
    )]
    Every {
        /// What was asked for, s.
        every_s: f64,
        /// The tick, s.
        tick_s: f64,
    },
    /// Knots lie closer than any robot follows, or so far apart that a pull is no pull any more.
    #[error(
        "knots every {every_s} s are outside {}..{} s",
        Timing::KNOTS.0,
        Timing::KNOTS.1
    )]
    Knots {
        /// What was asked for, s.
        every_s: f64,
    },
}

/// Tolerance of times that are meant to be a whole number of ticks, in ticks: sums of rounded
/// numbers are off by far less, clocks of robots by far more.
const EXACTLY: f64 = 1e-6;

impl Timing {
    /// Shortest and longest tick, s.
    pub const TICK: (f64, f64) = (1e-5, 0.1);
    /// Longest time between two commands, s.
    pub const SLOWEST: f64 = 1.0;
    /// Shortest and longest time between two knots of a segment, s. It does not depend on the tick:
    /// the robot goes from knot to knot by itself.
    pub const KNOTS: (f64, f64) = (1e-3, 0.1);
    /// For how long nothing may be felt, s, where ticks are short: longer than a busy controller is
    /// away, and so short that what is made up for afterwards is a step that a gate can judge.
    const LONGEST_GAP: f64 = 0.1;

    /// A crawler that is asked about every `tick`, s.
    ///
    /// # Errors
    /// [`TimingError`], for NaN too.
    pub fn new(tick: f64, delivery: Delivery) -> Result<Self, TimingError> {
        if !(Self::TICK.0..=Self::TICK.1).contains(&tick) {
            return Err(TimingError::Tick { tick_s: tick });
        }
        match delivery {
            Delivery::SetPoints { every } if !(tick..=Self::SLOWEST).contains(&every) => {
                Err(TimingError::Every {
                    every_s: every,
                    tick_s: tick,
                })
            }
            Delivery::Segments { every } if !(Self::KNOTS.0..=Self::KNOTS.1).contains(&every) => {
                Err(TimingError::Knots { every_s: every })
            }
            Delivery::SetPoints { .. } | Delivery::Segments { .. } => Ok(Self { tick, delivery }),
        }
    }

    /// About how often the crawler is asked, s.
    pub const fn tick(&self) -> f64 {
        self.tick
    }

    /// For how long nothing may be felt in a crawl, s: two ticks may always be lost.
    pub(super) fn longest_gap(&self) -> f64 {
        Self::LONGEST_GAP.max(3.5 * self.tick)
    }

    /// Form of the commands.
    pub const fn delivery(&self) -> Delivery {
        self.delivery
    }

    /// A time that is a whole number of ticks but for rounding, s, without that rounding; any other
    /// time as it is.
    pub(super) fn snapped(&self, seconds: f64) -> f64 {
        let ticks = (seconds / self.tick).round();
        if (seconds / self.tick - ticks).abs() < EXACTLY {
            ticks * self.tick
        } else {
            seconds
        }
    }

    /// Ticks that have gone by in a time, s, to the nearest.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the time of a crawl over a tick of 10 µs or more; a negative time is no tick"
    )]
    pub(super) fn ticks(&self, seconds: f64) -> usize {
        (seconds / self.tick).round() as usize
    }

    /// The same of something that lasts: at least one tick.
    pub(super) fn ticks_of(&self, seconds: f64) -> usize {
        self.ticks(seconds).max(1)
    }

    /// Number of the set-point that is due so many ticks into a phase, and the time at which it is
    /// to be reached, s.
    pub(super) fn set_point(&self, every: f64, tick: usize) -> (usize, f64) {
        let every = self.ticks_of(every);
        let number = tick / every;
        (number, ((number + 1) * every) as f64 * self.tick)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limit_timings() {
        let set_points = |tick, every| Timing::new(tick, Delivery::SetPoints { every });
        assert!(set_points(0.0025, 0.01).is_ok());
        assert!(set_points(0.01, 0.01).is_ok());
        for (tick, every) in [
            (0.0, 0.01),
            (-0.01, 0.01),
            (f64::NAN, 0.01),
            (2.0, 2.0),
            (0.01, 0.009),
            (0.01, f64::NAN),
            (0.01, 1.1),
        ] {
            assert!(set_points(tick, every).is_err(), "{tick} {every}");
        }
        let segments = |every| Timing::new(0.02, Delivery::Segments { every });
        assert!(segments(0.001).is_ok());
        assert!(segments(0.1).is_ok());
        for every in [0.0, 0.0009, 0.11, f64::NAN] {
            let error = segments(every).err();
            assert!(matches!(error, Some(TimingError::Knots { .. })), "{every}");
        }
    }

    /// The set-point is the one that is to be reached when the next one comes.
    #[test]
    fn set_points_lead_by_one() {
        let every = 0.01;
        let timing = Timing::new(0.0025, Delivery::SetPoints { every }).unwrap();
        assert_eq!(timing.set_point(every, 0), (0, 0.01));
        assert_eq!(timing.set_point(every, 3), (0, 0.01));
        assert_eq!(timing.set_point(every, 4), (1, 0.02));
        // A tick that comes late finds the set-point of its own time.
        assert_eq!(timing.set_point(every, 9), (2, 0.03));
    }

    #[test]
    fn rounding_is_taken_away_and_jitter_is_not() {
        let timing = Timing::new(0.0025, Delivery::SetPoints { every: 0.01 }).unwrap();
        let (late, early) = (401.0 * 0.0025, 400.0 * 0.0025);
        assert_eq!(timing.snapped(late - early).to_bits(), 0.0025_f64.to_bits());
        assert_eq!(timing.snapped(0.0031).to_bits(), 0.0031_f64.to_bits());
    }
}
