//! Scene files: a floor and what stands on it.
//!
//! ```toml
//! name = "attic"
//! description = "a low plate on an uneven floor"
//!
//! [floor]
//! friction_left = 0.5      # both, or none: then the contact regime's
//! friction_right = 0.9
//! slope_deg = 5            # uphill ahead
//!
//! [floor.rough]
//! bump_mm = 5
//! spacing_mm = 50
//! start_mm = 100
//! length_mm = 1000
//! seed = 1
//!
//! [[plate]]                # crawled under
//! start_mm = 50
//! length_mm = 1500
//! height_mm = 200
//! legs = "four"            # or "none"
//!
//! [[panel]]                # an upright board across the way
//! start_mm = 50
//! lower_edge_mm = 200
//! upper_edge_mm = 450
//!
//! [[ramp]]
//! start_mm = 1600
//! length_mm = 1200
//! angle_deg = 10
//!
//! [marker]                 # a red disc
//! position_mm = [48, 0, 325]
//! radius_mm = 60
//! ```
//!
//! x = 0 is the robot's foremost point when it starts, as in [`prone::scene`].

mod tables;

use prone::foreign_text::Quoted;
use prone::scene::{Item, Quantity, Scene, SceneError};

use crate::error::{FileError, Source};
use crate::plain_name::is_plain;
use tables::SceneFile;

/// Reads a scene from the text of a scene file; `file` is the name that errors carry.
pub fn parse(file: &str, text: &str) -> Result<Scene, FileError> {
    let source = Source { file, text };
    let table: SceneFile = source.parse()?;
    let name = table.name.get_ref();
    if !is_plain(name) {
        return Err(source.error(
            table.name.span(),
            format!("a scene's name is made of letters, digits, - and _ (it becomes part of file names), not {}", Quoted(name)),
        ));
    }
    if let Some([given, missing]) = table.half_a_friction() {
        let [key, other] = [given, missing].map(tables::key);
        let place = tables::place(text, Item::Floor, given);
        return Err(source.error(place, format!("{key} needs {other} beside it")));
    }
    let scene = table.scene();
    scene.check().map_err(|error| refuse(source, error))?;
    Ok(scene)
}

/// The same error in the units of the file, at the number that it is about.
fn refuse(source: Source<'_>, error: SceneError) -> FileError {
    let (item, quantity, message) = match error {
        SceneError::OutOfBounds {
            item,
            quantity,
            value,
            lowest,
            highest,
        } => {
            let [value, lowest, highest] =
                [value, lowest, highest].map(|number| in_file(quantity, number));
            let key = tables::key(quantity);
            let reason = quantity.reason();
            let message = format!("{key} = {value} is outside {lowest} to {highest}{reason}");
            (item, quantity, message)
        }
        SceneError::TakenForMetres {
            item,
            quantity,
            value,
            meant,
        } => {
            let [value, meant] = [value, meant].map(|number| in_file(quantity, number));
            let key = tables::key(quantity);
            let message = format!("{key} = {value}: did you mean {meant}?");
            (item, quantity, message)
        }
        SceneError::TooManyPoints { spacing, points } => {
            let spacing = in_file(Quantity::Spacing, spacing);
            let most = prone::scene::MOST_POINTS;
            let message = format!(
                "spacing_mm = {spacing} makes {points} points, at most {most} are possible"
            );
            (Item::Rough, Quantity::Spacing, message)
        }
    };
    source.error(tables::place(source.text, item, quantity), message)
}

/// A number as the file has it, without the digits that the conversion makes up.
fn in_file(quantity: Quantity, number: f64) -> f64 {
    let number = match quantity {
        Quantity::LeftFriction | Quantity::RightFriction => number,
        Quantity::Slope | Quantity::Angle | Quantity::Facing => number.to_degrees(),
        _ => 1000.0 * number,
    };
    // Nine decimals: finer than what anyone types, coarser than rounding.
    let rounded = (number * 1e9).round() / 1e9;
    if rounded.is_finite() { rounded } else { number }
}

#[cfg(test)]
mod tests;
