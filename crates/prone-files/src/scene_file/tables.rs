//! The tables of a scene file, in the units that their keys state.

use std::ops::Range;

use glam::DVec3;
use serde::Deserialize;
use toml::Spanned;

use prone::frames::Point;
use prone::scene::{
    Floor, Item, Legs, Marker, Panel, Plate, Quantity, Ramp, Roughness, Scene, SideFriction,
};

use crate::exactly::exactly;

/// A number with its place in the file.
type Number = Spanned<f64>;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneFile {
    pub(super) name: Spanned<String>,
    #[serde(default)]
    description: String,
    #[serde(default)]
    floor: FloorTable,
    #[serde(default)]
    plate: Vec<Spanned<PlateTable>>,
    #[serde(default)]
    panel: Vec<Spanned<PanelTable>>,
    #[serde(default)]
    ramp: Vec<Spanned<RampTable>>,
    marker: Option<Spanned<MarkerTable>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct FloorTable {
    friction_left: Option<Number>,
    friction_right: Option<Number>,
    slope_deg: Option<Number>,
    rough: Option<Spanned<RoughTable>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct RoughTable {
    bump_mm: Number,
    spacing_mm: Number,
    start_mm: Number,
    length_mm: Number,
    width_mm: Option<Number>,
    seed: u64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct PlateTable {
    start_mm: Number,
    length_mm: Number,
    width_mm: Option<Number>,
    height_mm: Number,
    thickness_mm: Option<Number>,
    #[serde(default)]
    legs: LegsName,
}

#[derive(Debug, Default, Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum LegsName {
    #[default]
    Four,
    None,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(clippy::struct_field_names, reason = "keys carry their unit")]
struct PanelTable {
    start_mm: Number,
    width_mm: Option<Number>,
    lower_edge_mm: Number,
    upper_edge_mm: Number,
    thickness_mm: Option<Number>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct RampTable {
    start_mm: Number,
    length_mm: Number,
    angle_deg: Number,
    width_mm: Option<Number>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct MarkerTable {
    #[serde(deserialize_with = "exactly")]
    position_mm: [Number; 3],
    radius_mm: Number,
    facing_deg: Option<Number>,
}

impl SceneFile {
    /// Metres and radians; bounds are not checked.
    pub(super) fn scene(&self) -> Scene {
        let floor = &self.floor;
        let friction = floor
            .friction_left
            .as_ref()
            .zip(floor.friction_right.as_ref());
        Scene {
            name: self.name.get_ref().clone(),
            description: self.description.clone(),
            floor: Floor {
                friction: friction.map(|(left, right)| SideFriction {
                    left: *left.get_ref(),
                    right: *right.get_ref(),
                }),
                slope: floor.slope_deg.as_ref().map_or(0.0, radians),
                roughness: floor.rough.as_ref().map(|rough| rough.get_ref().into()),
            },
            plates: self
                .plate
                .iter()
                .map(|plate| plate.get_ref().into())
                .collect(),
            panels: self
                .panel
                .iter()
                .map(|panel| panel.get_ref().into())
                .collect(),
            ramps: self.ramp.iter().map(|ramp| ramp.get_ref().into()).collect(),
            marker: self.marker.as_ref().map(|marker| marker.get_ref().into()),
        }
    }

    /// Where friction of one side only is given, and the key of the other.
    pub(super) fn half_a_friction(&self) -> Option<(Range<usize>, &'static str)> {
        match (&self.floor.friction_left, &self.floor.friction_right) {
            (Some(left), None) => Some((left.span(), "friction_right")),
            (None, Some(right)) => Some((right.span(), "friction_left")),
            _ => None,
        }
    }

    /// Where a number stands; its table where the file is silent, the file's start where there is
    /// neither.
    pub(super) fn place(&self, item: Item, quantity: Quantity) -> Range<usize> {
        let number = match item {
            Item::Floor => self.floor.number(quantity),
            Item::Rough => self
                .floor
                .rough
                .as_ref()
                .and_then(|t| t.get_ref().number(quantity)),
            Item::Plate(index) => self.plate[index].get_ref().number(quantity),
            Item::Panel(index) => self.panel[index].get_ref().number(quantity),
            Item::Ramp(index) => self.ramp[index].get_ref().number(quantity),
            Item::Marker => self
                .marker
                .as_ref()
                .and_then(|t| t.get_ref().number(quantity)),
        };
        if let Some(number) = number {
            return number.span();
        }
        match item {
            Item::Floor => 0..0,
            Item::Rough => self.floor.rough.as_ref().map_or(0..0, Spanned::span),
            Item::Plate(index) => self.plate[index].span(),
            Item::Panel(index) => self.panel[index].span(),
            Item::Ramp(index) => self.ramp[index].span(),
            Item::Marker => self.marker.as_ref().map_or(0..0, Spanned::span),
        }
    }
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

impl FloorTable {
    fn number(&self, quantity: Quantity) -> Option<&Number> {
        match quantity {
            Quantity::Slope => self.slope_deg.as_ref(),
            Quantity::LeftFriction => self.friction_left.as_ref(),
            Quantity::RightFriction => self.friction_right.as_ref(),
            _ => None,
        }
    }
}

impl RoughTable {
    fn number(&self, quantity: Quantity) -> Option<&Number> {
        match quantity {
            Quantity::BumpHeight => Some(&self.bump_mm),
            Quantity::Spacing => Some(&self.spacing_mm),
            Quantity::Start => Some(&self.start_mm),
            Quantity::Length => Some(&self.length_mm),
            Quantity::Width => self.width_mm.as_ref(),
            _ => None,
        }
    }
}

impl PlateTable {
    fn number(&self, quantity: Quantity) -> Option<&Number> {
        match quantity {
            Quantity::Start => Some(&self.start_mm),
            Quantity::Length => Some(&self.length_mm),
            Quantity::Width => self.width_mm.as_ref(),
            Quantity::Height => Some(&self.height_mm),
            Quantity::Thickness => self.thickness_mm.as_ref(),
            _ => None,
        }
    }
}

impl PanelTable {
    fn number(&self, quantity: Quantity) -> Option<&Number> {
        match quantity {
            Quantity::Start => Some(&self.start_mm),
            Quantity::Width => self.width_mm.as_ref(),
            Quantity::LowerEdge => Some(&self.lower_edge_mm),
            Quantity::UpperEdge => Some(&self.upper_edge_mm),
            Quantity::Thickness => self.thickness_mm.as_ref(),
            _ => None,
        }
    }
}

impl RampTable {
    fn number(&self, quantity: Quantity) -> Option<&Number> {
        match quantity {
            Quantity::Start => Some(&self.start_mm),
            Quantity::Length => Some(&self.length_mm),
            Quantity::Angle => Some(&self.angle_deg),
            Quantity::Width => self.width_mm.as_ref(),
            _ => None,
        }
    }
}

impl MarkerTable {
    fn number(&self, quantity: Quantity) -> Option<&Number> {
        let [x, y, z] = &self.position_mm;
        match quantity {
            Quantity::X => Some(x),
            Quantity::Y => Some(y),
            Quantity::Z => Some(z),
            Quantity::Radius => Some(&self.radius_mm),
            Quantity::Facing => self.facing_deg.as_ref(),
            _ => None,
        }
    }
}

impl From<&RoughTable> for Roughness {
    fn from(table: &RoughTable) -> Self {
        Self {
            height: metres(&table.bump_mm),
            spacing: metres(&table.spacing_mm),
            from_x: metres(&table.start_mm),
            length: metres(&table.length_mm),
            width: table.width_mm.as_ref().map_or(Self::WIDTH, metres),
            seed: table.seed,
        }
    }
}

impl From<&PlateTable> for Plate {
    fn from(table: &PlateTable) -> Self {
        Self {
            start: metres(&table.start_mm),
            length: metres(&table.length_mm),
            width: table.width_mm.as_ref().map_or(Self::WIDTH, metres),
            height: metres(&table.height_mm),
            thickness: table.thickness_mm.as_ref().map_or(Self::THICKNESS, metres),
            legs: match table.legs {
                LegsName::Four => Legs::Four,
                LegsName::None => Legs::None,
            },
        }
    }
}

impl From<&PanelTable> for Panel {
    fn from(table: &PanelTable) -> Self {
        Self {
            start: metres(&table.start_mm),
            width: table.width_mm.as_ref().map_or(Self::WIDTH, metres),
            lower_edge: metres(&table.lower_edge_mm),
            upper_edge: metres(&table.upper_edge_mm),
            thickness: table.thickness_mm.as_ref().map_or(Self::THICKNESS, metres),
        }
    }
}

impl From<&RampTable> for Ramp {
    fn from(table: &RampTable) -> Self {
        Self {
            start: metres(&table.start_mm),
            length: metres(&table.length_mm),
            angle: radians(&table.angle_deg),
            width: table.width_mm.as_ref().map_or(Self::WIDTH, metres),
        }
    }
}

impl From<&MarkerTable> for Marker {
    fn from(table: &MarkerTable) -> Self {
        let [x, y, z] = &table.position_mm;
        Self {
            position: Point::new(DVec3::new(metres(x), metres(y), metres(z))),
            radius: metres(&table.radius_mm),
            // Towards the robot that starts.
            facing: table
                .facing_deg
                .as_ref()
                .map_or(std::f64::consts::PI, radians),
        }
    }
}

fn metres(millimetres: &Number) -> f64 {
    millimetres.get_ref() / 1000.0
}

fn radians(degrees: &Number) -> f64 {
    degrees.get_ref().to_radians()
}
