//! What only the engine can export of a record: films, and the robot as URDF.
//!
//! | module | format | read by |
//! |---|---|---|
//! | [`urdf`] | the robot as URDF | ROS, physics engines |
//! | [`film`] with [`gif_film`], [`webp_film`] | pictures that move | browsers |

pub mod film;
pub mod gif_film;
mod moved;
pub mod urdf;
pub mod webp_film;
