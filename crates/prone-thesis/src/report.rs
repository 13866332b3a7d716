//! The study's part of a report: its result folder, its sections, its tables.

pub(crate) mod parameter_tables;
pub(crate) mod sections;
pub(crate) mod study;
