//! What only the engine can export of a record: films.
//!
//! | module | format | read by |
//! |---|---|---|
//! | [`film`] with [`gif_film`], [`webp_film`] | pictures that move | browsers |

pub mod film;
pub mod gif_film;
mod moved;
pub mod webp_film;
