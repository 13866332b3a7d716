//! What a scene may hold.

use std::fmt;

use super::{Legs, Plate, Scene};

/// The largest extent or distance, m: beyond it a number was typed in another unit.
const LARGEST: f64 = 100.0;
/// The lowest ceiling, m: the thinnest robot that lies down is higher.
pub const LOWEST_CEILING: f64 = 0.01;
/// The smallest extent, m: below it the engine's contacts see nothing.
const SMALLEST: f64 = 1e-4;
/// The steepest floor or ramp, rad.
const STEEPEST: f64 = 45_f64.to_radians();
/// The flattest ramp, rad.
const FLATTEST: f64 = 0.1_f64.to_radians();
/// Rubber on rubber has about 1; beyond ten nothing slides that has not slid before.
const LARGEST_FRICTION: f64 = 10.0;
/// Grid points of a rough ground: 1,000 on each side.
pub const MOST_POINTS: f64 = 1e6;

/// Why a scene cannot be built.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// A number lies outside its bounds, or is none.
    #[error(
        "{item}: {quantity} {value}{unit} is outside {lowest} to {highest}{unit}{reason}",
        unit = quantity.unit(),
        reason = quantity.reason()
    )]
    OutOfBounds {
        /// Of which part of the scene.
        item: Item,
        /// Which number.
        quantity: Quantity,
        /// What it is; SI, radians.
        value: f64,
        /// The least that it may be.
        lowest: f64,
        /// The most that it may be.
        highest: f64,
    },
    /// A height in metres was given as one in millimetres.
    #[error("{item}: {quantity} {value} m: did you mean {meant}?")]
    TakenForMetres {
        /// Of which part of the scene.
        item: Item,
        /// Which number.
        quantity: Quantity,
        /// What it is, m.
        value: f64,
        /// What was probably meant, m.
        meant: f64,
    },
    /// The grid of the rough ground is too fine for its size.
    #[error(
        "{}: a spacing of {spacing} m makes {points} points, at most {MOST_POINTS} are possible",
        Item::Rough
    )]
    TooManyPoints {
        /// From bump to bump, m.
        spacing: f64,
        /// How many points it makes.
        points: f64,
    },
}

/// A part of a scene; numbers count from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Item {
    /// The floor.
    Floor,
    /// Its rough stretch.
    Rough,
    /// A plate.
    Plate(usize),
    /// A panel.
    Panel(usize),
    /// A ramp.
    Ramp(usize),
    /// The marker.
    Marker,
}

/// A number of a scene's part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Quantity {
    Slope,
    LeftFriction,
    RightFriction,
    BumpHeight,
    Spacing,
    Start,
    Length,
    Width,
    Height,
    Thickness,
    LowerEdge,
    UpperEdge,
    Angle,
    X,
    Y,
    Z,
    Radius,
    Facing,
}

impl Quantity {
    const fn name(self) -> &'static str {
        match self {
            Self::Slope => "slope",
            Self::LeftFriction => "left friction",
            Self::RightFriction => "right friction",
            Self::BumpHeight => "bump height",
            Self::Spacing => "spacing",
            Self::Start => "start",
            Self::Length => "length",
            Self::Width => "width",
            Self::Height => "height",
            Self::Thickness => "thickness",
            Self::LowerEdge => "lower edge",
            Self::UpperEdge => "upper edge",
            Self::Angle => "angle",
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
            Self::Radius => "radius",
            Self::Facing => "facing",
        }
    }

    const fn unit(self) -> &'static str {
        match self {
            Self::Slope | Self::Angle | Self::Facing => " rad",
            Self::LeftFriction | Self::RightFriction => "",
            _ => " m",
        }
    }

    /// Why the bounds are there, where that is not plain; follows a message.
    pub const fn reason(self) -> &'static str {
        match self {
            Self::Start => ": what begins before 0 stands in the robot's starting place",
            _ => "",
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl fmt::Display for Item {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Floor => f.write_str("floor"),
            Self::Rough => f.write_str("rough ground"),
            Self::Plate(index) => write!(f, "plate {}", index + 1),
            Self::Panel(index) => write!(f, "panel {}", index + 1),
            Self::Ramp(index) => write!(f, "ramp {}", index + 1),
            Self::Marker => f.write_str("marker"),
        }
    }
}

/// What a ceiling's height, m, was probably meant to be, m, where it is lower than any robot: a
/// thousand times as much, as it was typed in metres where millimetres were asked for.
pub fn taken_for_metres(height: f64) -> Option<f64> {
    (height > 0.0 && height < LOWEST_CEILING).then_some(height * 1e3)
}

/// A number and its bounds.
type Rule = (Quantity, f64, [f64; 2]);

impl Scene {
    /// Holds every number against its bounds.
    ///
    /// # Errors
    /// [`SceneError`] for the first that lies outside.
    pub fn check(&self) -> Result<(), SceneError> {
        for (item, rules) in self.rules() {
            for (quantity, value, [lowest, highest]) in rules {
                let meant = match quantity {
                    Quantity::Height => taken_for_metres(value),
                    _ => None,
                };
                if let Some(meant) = meant {
                    return Err(SceneError::TakenForMetres {
                        item,
                        quantity,
                        value,
                        meant,
                    });
                }
                // A number that is none lies in no interval.
                if !(lowest..=highest).contains(&value) {
                    return Err(SceneError::OutOfBounds {
                        item,
                        quantity,
                        value,
                        lowest,
                        highest,
                    });
                }
            }
        }
        if let Some(rough) = &self.floor.roughness {
            let [columns, rows] = rough.points();
            let points = columns as f64 * rows as f64;
            if points > MOST_POINTS {
                return Err(SceneError::TooManyPoints {
                    spacing: rough.spacing,
                    points,
                });
            }
        }
        Ok(())
    }

    fn rules(&self) -> Vec<(Item, Vec<Rule>)> {
        let mut rules = vec![(Item::Floor, self.floor_rules())];
        if let Some(rough) = &self.floor.roughness {
            // Two spacings: a point must lie inside the border.
            let extent = [2.0 * rough.spacing, LARGEST];
            rules.push((
                Item::Rough,
                vec![
                    (Quantity::BumpHeight, rough.height, [SMALLEST, LARGEST]),
                    (Quantity::Spacing, rough.spacing, [SMALLEST, LARGEST]),
                    start(rough.from_x),
                    (Quantity::Length, rough.length, extent),
                    (Quantity::Width, rough.width, extent),
                ],
            ));
        }
        for (index, plate) in self.plates.iter().enumerate() {
            rules.push((Item::Plate(index), plate_rules(plate)));
        }
        for (index, panel) in self.panels.iter().enumerate() {
            let above = [panel.lower_edge + SMALLEST, LARGEST];
            rules.push((
                Item::Panel(index),
                vec![
                    start(panel.start),
                    extent(Quantity::Width, panel.width),
                    (Quantity::LowerEdge, panel.lower_edge, [0.0, LARGEST]),
                    (Quantity::UpperEdge, panel.upper_edge, above),
                    extent(Quantity::Thickness, panel.thickness),
                ],
            ));
        }
        for (index, ramp) in self.ramps.iter().enumerate() {
            rules.push((
                Item::Ramp(index),
                vec![
                    start(ramp.start),
                    extent(Quantity::Length, ramp.length),
                    (Quantity::Angle, ramp.angle, [FLATTEST, STEEPEST]),
                    extent(Quantity::Width, ramp.width),
                ],
            ));
        }
        if let Some(marker) = &self.marker {
            let [x, y, z] = marker.position.metres().to_array();
            let turn = std::f64::consts::TAU;
            rules.push((
                Item::Marker,
                vec![
                    extent(Quantity::Radius, marker.radius),
                    (Quantity::X, x, [-LARGEST, LARGEST]),
                    (Quantity::Y, y, [-LARGEST, LARGEST]),
                    // No part of it is in the ground.
                    (Quantity::Z, z, [marker.radius, LARGEST]),
                    (Quantity::Facing, marker.facing, [-turn, turn]),
                ],
            ));
        }
        rules
    }

    fn floor_rules(&self) -> Vec<Rule> {
        let slope = (Quantity::Slope, self.floor.slope, [-STEEPEST, STEEPEST]);
        let friction = self.floor.friction.into_iter().flat_map(|friction| {
            [
                (Quantity::LeftFriction, friction.left),
                (Quantity::RightFriction, friction.right),
            ]
            .map(|(quantity, value)| (quantity, value, [0.0, LARGEST_FRICTION]))
        });
        std::iter::once(slope).chain(friction).collect()
    }
}

fn plate_rules(plate: &Plate) -> Vec<Rule> {
    let least = match plate.legs {
        // Side by side they leave the robot nothing, but they are four.
        Legs::Four => 2.0 * Plate::LEG,
        Legs::None => SMALLEST,
    };
    vec![
        start(plate.start),
        (Quantity::Length, plate.length, [least, LARGEST]),
        (Quantity::Width, plate.width, [least, LARGEST]),
        extent(Quantity::Height, plate.height),
        extent(Quantity::Thickness, plate.thickness),
    ]
}

const fn start(x: f64) -> Rule {
    (Quantity::Start, x, [0.0, LARGEST])
}

const fn extent(quantity: Quantity, value: f64) -> Rule {
    (quantity, value, [SMALLEST, LARGEST])
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::{Marker, Panel, Ramp, Roughness, SideFriction};
    use super::*;
    use crate::frames::Point;

    fn full() -> Scene {
        let mut scene = Scene::under_plate(0.2, 1.5);
        scene.floor.friction = Some(SideFriction {
            left: 0.5,
            right: 0.9,
        });
        scene.floor.roughness = Some(Roughness {
            height: 0.005,
            spacing: 0.05,
            from_x: 0.3,
            length: 1.0,
            width: 0.8,
            seed: 1,
        });
        scene.panels.push(Panel {
            start: 1.0,
            width: 1.0,
            lower_edge: 0.2,
            upper_edge: 0.4,
            thickness: 0.01,
        });
        scene.ramps.push(Ramp {
            start: 2.0,
            length: 1.0,
            angle: 0.1,
            width: 1.0,
        });
        scene.marker = Some(Marker {
            position: Point::new(DVec3::new(1.0, 0.0, 0.3)),
            radius: 0.05,
            facing: std::f64::consts::PI,
        });
        scene
    }

    /// What `break_it` makes of a valid scene.
    fn error(break_it: impl FnOnce(&mut Scene)) -> String {
        let mut scene = full();
        assert_eq!(scene.check(), Ok(()));
        break_it(&mut scene);
        scene.check().unwrap_err().to_string()
    }

    #[test]
    fn errors_name_item_value_and_bound() {
        for (message, expected) in [
            (
                error(|s| s.plates[0].height = 0.0),
                "plate 1: height 0 m is outside 0.0001 to 100 m",
            ),
            (
                error(|s| s.plates[0].length = f64::NAN),
                "plate 1: length NaN m is outside 0.04 to 100 m",
            ),
            (
                error(|s| s.plates[0].start = -0.1),
                "plate 1: start -0.1 m is outside 0 to 100 m: what begins before 0 stands in the robot's starting place",
            ),
            (
                error(|s| s.panels[0].upper_edge = 0.1),
                "panel 1: upper edge 0.1 m is outside 0.2001 to 100 m",
            ),
            (
                error(|s| s.ramps[0].angle = -0.1),
                "ramp 1: angle -0.1 rad is outside 0.0017453292519943296 to 0.7853981633974483 rad",
            ),
            (
                error(|s| s.floor.slope = 1.0),
                "floor: slope 1 rad is outside -0.7853981633974483 to 0.7853981633974483 rad",
            ),
            (
                error(|s| s.floor.friction.as_mut().unwrap().right = 10.5),
                "floor: right friction 10.5 is outside 0 to 10",
            ),
            (
                error(|s| s.floor.roughness.as_mut().unwrap().width = 0.05),
                "rough ground: width 0.05 m is outside 0.1 to 100 m",
            ),
            (
                error(|s| s.floor.roughness.as_mut().unwrap().spacing = 2e-4),
                "rough ground: a spacing of 0.0002 m makes 20009001 points, at most 1000000 are possible",
            ),
            (
                error(|s| s.marker.as_mut().unwrap().radius = 0.31),
                "marker: z 0.3 m is outside 0.31 to 100 m",
            ),
        ] {
            assert_eq!(message, expected);
        }
    }

    #[test]
    fn limit_a_ceiling_in_metres_is_asked_about() {
        for (height, meant) in [(0.19e-3, 0.19), (1.5e-3, 1.5), (9.9e-3, 9.9)] {
            let mut scene = full();
            scene.plates[0].height = height;
            let Err(SceneError::TakenForMetres { meant: found, .. }) = scene.check() else {
                panic!("{height}");
            };
            assert!((found - meant).abs() < 1e-12, "{found}");
        }
        let mut scene = full();
        scene.plates[0].height = LOWEST_CEILING;
        assert_eq!(scene.check(), Ok(()));
    }

    #[test]
    fn limit_every_number_that_is_none_is_refused() {
        for (item, rules) in full().rules() {
            for (quantity, value, [lowest, highest]) in rules {
                assert!((lowest..=highest).contains(&value), "{item} {quantity}");
            }
        }
        let mut scene = full();
        scene.floor.roughness.as_mut().unwrap().spacing = f64::NAN;
        assert!(scene.check().is_err());
        let mut scene = full();
        scene.panels[0].lower_edge = f64::NAN;
        assert!(scene.check().is_err());
    }
}
