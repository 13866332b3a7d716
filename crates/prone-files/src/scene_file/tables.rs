//! The tables of a scene file, in the units that their keys state.

use std::f64::consts::PI;
use std::ops::Range;

use glam::DVec3;
use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use prone::frames::Point;
use prone::scene::{
    Floor, Item, Legs, Marker, Panel, Plate, Quantity, Ramp, Roughness, Scene, SideFriction,
};

use crate::exactly::exactly;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneFile {
    pub(super) name: Spanned<String>,
    #[serde(default)]
    description: String,
    #[serde(default)]
    floor: FloorTable,
    #[serde(default)]
    plate: Vec<PlateTable>,
    #[serde(default)]
    panel: Vec<PanelTable>,
    #[serde(default)]
    ramp: Vec<RampTable>,
    marker: Option<MarkerTable>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct FloorTable {
    friction_left: Option<f64>,
    friction_right: Option<f64>,
    slope_deg: Option<f64>,
    rough: Option<RoughTable>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct RoughTable {
    bump_mm: f64,
    spacing_mm: f64,
    start_mm: f64,
    length_mm: f64,
    width_mm: Option<f64>,
    seed: u64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct PlateTable {
    start_mm: f64,
    length_mm: f64,
    width_mm: Option<f64>,
    height_mm: f64,
    thickness_mm: Option<f64>,
    #[serde(default = "four_legs", with = "LegsName")]
    legs: Legs,
}

#[derive(Deserialize)]
#[serde(remote = "Legs", rename_all = "kebab-case")]
enum LegsName {
    Four,
    None,
}

const fn four_legs() -> Legs {
    Legs::Four
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(clippy::struct_field_names, reason = "keys carry their unit")]
struct PanelTable {
    start_mm: f64,
    width_mm: Option<f64>,
    lower_edge_mm: f64,
    upper_edge_mm: f64,
    thickness_mm: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct RampTable {
    start_mm: f64,
    length_mm: f64,
    angle_deg: f64,
    width_mm: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct MarkerTable {
    #[serde(deserialize_with = "exactly")]
    position_mm: [f64; 3],
    radius_mm: f64,
    facing_deg: Option<f64>,
}

impl SceneFile {
    /// Metres and radians; bounds are not checked.
    pub(super) fn scene(&self) -> Scene {
        let floor = &self.floor;
        let friction = floor.friction_left.zip(floor.friction_right);
        Scene {
            name: self.name.get_ref().clone(),
            description: self.description.clone(),
            floor: Floor {
                friction: friction.map(|(left, right)| SideFriction { left, right }),
                slope: floor.slope_deg.map_or(0.0, f64::to_radians),
                roughness: floor.rough.as_ref().map(Into::into),
            },
            plates: self.plate.iter().map(Into::into).collect(),
            panels: self.panel.iter().map(Into::into).collect(),
            ramps: self.ramp.iter().map(Into::into).collect(),
            marker: self.marker.as_ref().map(Into::into),
        }
    }

    /// Of which side alone friction is given, and of which it is not.
    pub(super) const fn half_a_friction(&self) -> Option<[Quantity; 2]> {
        match (self.floor.friction_left, self.floor.friction_right) {
            (Some(_), None) => Some([Quantity::LeftFriction, Quantity::RightFriction]),
            (None, Some(_)) => Some([Quantity::RightFriction, Quantity::LeftFriction]),
            _ => None,
        }
    }
}

/// Where a number of a scene stands in its text; its table where that is silent, the beginning where
/// there is neither.
pub(super) fn place(text: &str, item: Item, quantity: Quantity) -> Range<usize> {
    let file = DeTable::parse(text).map(Spanned::into_inner);
    let part = |table: &str| file.as_ref().ok()?.get(table);
    let element = |table: &str, index: usize| part(table)?.get_ref().get(index);
    let table = match item {
        Item::Floor => part("floor"),
        Item::Rough => part("floor").and_then(|floor| floor.get_ref().get("rough")),
        Item::Plate(index) => element("plate", index),
        Item::Panel(index) => element("panel", index),
        Item::Ramp(index) => element("ramp", index),
        Item::Marker => part("marker"),
    };
    let number = table.and_then(|table| number(table.get_ref(), quantity));
    number.or(table).map_or(0..0, Spanned::span)
}

/// The number of a table.
fn number<'a, 'i>(table: &'a DeValue<'i>, quantity: Quantity) -> Option<&'a Spanned<DeValue<'i>>> {
    let coordinate = match quantity {
        Quantity::X => 0,
        Quantity::Y => 1,
        Quantity::Z => 2,
        _ => return table.get(key(quantity)),
    };
    table.get("position_mm")?.get_ref().get(coordinate)
}

/// The key under which a number of a scene stands.
pub(super) const fn key(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Slope => "slope_deg",
        Quantity::LeftFriction => "friction_left",
        Quantity::RightFriction => "friction_right",
        Quantity::BumpHeight => "bump_mm",
        Quantity::Spacing => "spacing_mm",
        Quantity::Start => "start_mm",
        Quantity::Length => "length_mm",
        Quantity::Width => "width_mm",
        Quantity::Height => "height_mm",
        Quantity::Thickness => "thickness_mm",
        Quantity::LowerEdge => "lower_edge_mm",
        Quantity::UpperEdge => "upper_edge_mm",
        Quantity::Angle => "angle_deg",
        Quantity::X => "x of position_mm",
        Quantity::Y => "y of position_mm",
        Quantity::Z => "z of position_mm",
        Quantity::Radius => "radius_mm",
        Quantity::Facing => "facing_deg",
    }
}

impl From<&RoughTable> for Roughness {
    fn from(table: &RoughTable) -> Self {
        Self {
            height: metres(table.bump_mm),
            spacing: metres(table.spacing_mm),
            from_x: metres(table.start_mm),
            length: metres(table.length_mm),
            width: table.width_mm.map_or(Self::WIDTH, metres),
            seed: table.seed,
        }
    }
}

impl From<&PlateTable> for Plate {
    fn from(table: &PlateTable) -> Self {
        Self {
            start: metres(table.start_mm),
            length: metres(table.length_mm),
            width: table.width_mm.map_or(Self::WIDTH, metres),
            height: metres(table.height_mm),
            thickness: table.thickness_mm.map_or(Self::THICKNESS, metres),
            legs: table.legs,
        }
    }
}

impl From<&PanelTable> for Panel {
    fn from(table: &PanelTable) -> Self {
        Self {
            start: metres(table.start_mm),
            width: table.width_mm.map_or(Self::WIDTH, metres),
            lower_edge: metres(table.lower_edge_mm),
            upper_edge: metres(table.upper_edge_mm),
            thickness: table.thickness_mm.map_or(Self::THICKNESS, metres),
        }
    }
}

impl From<&RampTable> for Ramp {
    fn from(table: &RampTable) -> Self {
        Self {
            start: metres(table.start_mm),
            length: metres(table.length_mm),
            angle: table.angle_deg.to_radians(),
            width: table.width_mm.map_or(Self::WIDTH, metres),
        }
    }
}

impl From<&MarkerTable> for Marker {
    fn from(table: &MarkerTable) -> Self {
        let [x, y, z] = table.position_mm;
        Self {
            position: Point::new(DVec3::new(metres(x), metres(y), metres(z))),
            radius: metres(table.radius_mm),
            // Towards the robot that starts.
            facing: table.facing_deg.map_or(PI, f64::to_radians),
        }
    }
}

fn metres(millimetres: f64) -> f64 {
    millimetres / 1000.0
}
