//! When a crawl that is to get past something is over: past it, or at a pace that does not lead there.
//!
//! With x where it ends, r(k) the robot's last point after cycle k, and w = [`WATCHED`], the pace is
//!
//! ```text
//! v(k) = (r(k) − r(k − w)) / w                        (1)
//! k + (x − r(k)) / v(k) ≤ MOST_CYCLES                 (2)
//! ```
//!
//! From cycle w on, (2) says whether it can still get there. So a crawl that advances is never cut
//! off, however long the way, and one that is stuck ends about w cycles later.

/// Cycles over which a pace is measured: a robot that wriggles itself free takes fewer.
pub const WATCHED: usize = 20;

/// Most cycles that any crawl may have.
pub const MOST_CYCLES: usize = 1000;

/// How long a crawl may take to get past something.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bound {
    /// So many cycles.
    Cycles(usize),
    /// As long as its pace leads there within [`MOST_CYCLES`], measured over [`WATCHED`] cycles.
    Pace,
}

impl Bound {
    /// Cycles after which it is over at the latest.
    pub const fn most_cycles(self) -> usize {
        match self {
            Self::Cycles(cycles) => cycles,
            Self::Pace => MOST_CYCLES,
        }
    }
}

/// What a cycle has led to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reached {
    /// The robot is past x.
    Past,
    /// It may get there.
    OnTheWay,
    /// It will not.
    Stuck,
}

/// The way of the robot's last point.
#[derive(Debug, Clone)]
pub(super) struct Pace {
    x: f64,
    bound: Bound,
    /// Where that point was at the start and after each cycle, m.
    rears: Vec<f64>,
}

impl Pace {
    /// Of a crawl past x, m, that begins with its last point at `rear`, m.
    pub(super) fn new(x: f64, bound: Bound, rear: f64) -> Self {
        Self {
            x,
            bound,
            rears: vec![rear],
        }
    }

    /// After a cycle that ended with the last point at `rear`, m.
    pub(super) fn cycle_ended(&mut self, rear: f64) -> Reached {
        self.rears.push(rear);
        if rear > self.x {
            return Reached::Past;
        }
        let cycles = self.rears.len() - 1;
        if self.bound != Bound::Pace || cycles < WATCHED {
            return Reached::OnTheWay;
        }
        let pace = (rear - self.rears[cycles - WATCHED]) / WATCHED as f64;
        let cycles_in_all = cycles as f64 + (self.x - rear) / pace;
        // NaN is no way either.
        if pace > 0.0 && cycles_in_all <= MOST_CYCLES as f64 {
            Reached::OnTheWay
        } else {
            Reached::Stuck
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cycles until it is over, where each goes as far as `advance` says of its number, m.
    fn crawl(x: f64, bound: Bound, advance: impl Fn(usize) -> f64) -> (usize, Reached) {
        let mut rear = -0.5;
        let mut pace = Pace::new(x, bound, rear);
        for cycle in 1..=MOST_CYCLES {
            rear += advance(cycle);
            match pace.cycle_ended(rear) {
                Reached::OnTheWay => {}
                reached => return (cycle, reached),
            }
        }
        (MOST_CYCLES, Reached::OnTheWay)
    }

    #[test]
    fn a_crawl_that_advances_gets_there_however_long_it_takes() {
        // 2 m at 20 cm, 2 cm and 5 mm a cycle, and over 20 m; ends are no whole number of cycles away.
        for (x, advance, cycles) in [
            (1.49, 0.2, 10),
            (1.49, 0.02, 100),
            (1.492, 0.005, 399),
            (19.49, 0.2, 100),
        ] {
            assert_eq!(
                crawl(x, Bound::Pace, |_| advance),
                (cycles, Reached::Past),
                "{x} {advance}"
            );
        }
        // It slows down to a tenth on its way.
        let slower = |cycle| if cycle <= 5 { 0.2 } else { 0.02 };
        assert_eq!(crawl(1.49, Bound::Pace, slower), (55, Reached::Past));
    }

    #[test]
    fn limit_a_crawl_that_is_stuck_ends() {
        let wriggles = |cycle: usize| if cycle.is_multiple_of(2) { 0.01 } else { -0.01 };
        assert_eq!(crawl(1.5, Bound::Pace, wriggles), (WATCHED, Reached::Stuck));
        // Stuck after five cycles: their advance has to leave what is watched.
        let then_stuck = |cycle| if cycle <= 5 { 0.2 } else { 0.0 };
        let (cycles, reached) = crawl(1.5, Bound::Pace, then_stuck);
        assert_eq!(reached, Reached::Stuck);
        assert!((WATCHED..=WATCHED + 5).contains(&cycles), "{cycles}");
        let (cycles, reached) = crawl(1.5, Bound::Pace, |_| f64::NAN);
        assert_eq!((cycles, reached), (WATCHED, Reached::Stuck));
    }

    #[test]
    fn limit_a_bound_of_the_user_is_the_only_one() {
        let bound = Bound::Cycles(40);
        assert_eq!(bound.most_cycles(), 40);
        let (cycles, reached) = crawl(1.5, bound, |_| 0.0);
        assert_eq!((cycles, reached), (MOST_CYCLES, Reached::OnTheWay));
    }
}
