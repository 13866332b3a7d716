//! Optimisers for bounded problems with graded violations. Numbers only: no robot, no file, no
//! clock, no random number that the seed does not determine.
//!
//! Six nouns, after argmin: a [`Problem`] knows the score of a point; a [`Scorer`] answers for a
//! batch of points, by id and in any order ([`Threads`] does so on threads); a [`Solver`] proposes
//! points, a generation at a time; a [`Run`] drives one solver on one problem; an [`Observer`] hears of each
//! generation; a [`Termination`] says when to stop.
//!
//! - [`DifferentialEvolution`] is the default;
//! - [`CovarianceMatrix`] is an independent check (CMA-ES, crate `cmaes`);
//! - [`Genetic`] repeats MATLAB's `ga` with its defaults.
//!
//! Scores compare lexicographically, violation before value (Deb 2000). Whatever order a generation's
//! results come in, they are gathered in the order of its points: the result is the same, bit by bit,
//! for any number of threads. A [`Run`] is its own checkpoint: serialised and read back it goes
//! on as if it had never stopped (the format must keep every bit of an `f64`; for `serde_json`
//! that is its feature `float_roundtrip`).

mod covariance_matrix;
mod differential_evolution;
mod evaluator;
mod genetic;
mod observer;
mod problem;
mod random;
mod run;
mod scorer;
mod solver;

pub use covariance_matrix::{CovarianceMatrix, CovarianceMatrixOptions};
pub use differential_evolution::{DifferentialEvolution, DifferentialEvolutionOptions};
pub use evaluator::{Evaluator, NoScores};
pub use genetic::{Genetic, GeneticOptions};
pub use observer::{Generation, History, Observer};
pub use problem::{Candidate, Failure, Interval, IntervalError, Problem, Score};
pub use random::Random;
pub use run::{Run, StopReason, Termination};
pub use scorer::{Answer, Query, QueryId, Scorer, Threads};
pub use solver::Solver;
