//! Searching for better gaits, and proof that they are better.
//!
//! [`form`] makes gaits of numbers, [`pricer`] prices them by a [`prone::cost::objective`] on a source of
//! torques under [`rules`], [`prone_record::search`] runs an optimiser of `prone-optim` over both, [`confirm`] simulates what it
//! found beside other gaits, and [`outcome`] is what a result folder holds of all that.

pub mod confirm;
pub mod dynamic;
pub mod form;
pub mod outcome;
pub mod pricer;
pub mod pricing;
pub mod problem;
pub mod published_problem;
pub mod rules;
pub mod static_pricing;
