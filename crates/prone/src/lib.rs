//! The mechanics of a low-profile crawl, and nothing else.
//!
//! Seen from the side, a prone humanoid with toes and elbows planted is a closed five-link
//! chain. This crate holds that chain ([`chain`]), the curves that steer it ([`gait`]), the way
//! from chain angles to a robot's joints ([`mapping`]), the robot ([`robot`]) and what it crawls
//! on and under ([`scene`]) as data, the torques that hold it still ([`statics`]) or that a table
//! knows ([`torque_map`]), what a crawl costs ([`cost`]), what it asks of the motors ([`motor`]) and how it keeps its line
//! ([`steering`]).
//! Which way is up, as its inertial unit tells, is in [`attitude`]. The crawler itself is a state
//! machine ([`crawl`]) over whatever can be driven ([`port`]).
//!
//! It reads no file and no clock, and knows no particular robot: files are read by `prone-files`,
//! the robot's shape comes from its MJCF through `prone-sim`.
//!
//! Inside: `f64`, SI units, radians. Frames are in the types ([`frames`]): a transform is named
//! and typed `target_from_source`, so that neighbours cancel.

/// Tests that other crates share name this one as they do.
#[cfg(test)]
extern crate self as prone;

pub mod attitude;
pub mod chain;
pub mod cost;
pub mod crawl;
pub mod csv_text;
pub mod foreign_text;
pub mod frames;
pub mod gait;
pub mod mapping;
pub mod motor;
pub mod odd_number;
pub mod plausible;
pub mod port;
pub mod regime;
pub mod robot;
pub mod scene;
pub mod statics;
pub mod steering;
pub mod torque_map;
