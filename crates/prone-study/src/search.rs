//! Searching gaits, pulls alone or whole cycles, and proof that what is found is better.
//!
//! One search, whatever is searched:
//!
//! 1. A *form* turns the numbers of a point into a gait: [`pull_form`], [`cycle_form`]. A pull is a
//!    cycle without recovery.
//! 2. The gait has a *cost*: a value, what it breaks of the rules, and where it cannot be moved at
//!    all the reason ([`candidates`]). A pull's comes from a torque map, the statics or a simulation
//!    ([`pull_cost`]), a cycle's from crawls in several settings ([`cycle_cost`]). Rules are in
//!    [`chain_rules`] and [`cycle_rules`].
//! 3. [`run`] lets an optimiser of `prone-optim` search, under a budget, with checkpoints.
//! 4. [`confirm`] simulates what was found, beside other gaits, in settings that the search did not
//!    look at.
//! 5. [`pulls`] and [`cycles`] put the result together: the record and its folder.
//!
//! What was asked for becomes this in [`pull_terms`] and [`cycle_jobs`], with [`pull_error`] and [`room`]
//! for what cannot be searched. [`settings`] are the settings of cycles, of which [`trial`] crawls one;
//! [`corners`] are the ways in which a robot and its floor may differ from the model, the same for all who
//! ask whether a cycle holds; [`steering`] tells whether a found cycle can be steered, [`passage`] answers
//! `crawl under`, and [`costed_cycle`] tells the cost of a single cycle.

pub mod candidates;
pub mod chain_rules;
pub mod confirm;
pub mod corners;
pub mod costed_cycle;
pub mod cycle_cost;
pub mod cycle_form;
pub mod cycle_jobs;
pub mod cycle_rules;
pub mod cycles;
pub mod passage;
pub mod published;
pub mod pull_cost;
pub mod pull_error;
pub mod pull_form;
pub mod pull_terms;
pub mod pull_trial;
pub mod pulls;
pub mod room;
pub mod run;
pub mod setting;
pub mod settings;
pub mod steering;
pub mod trial;
