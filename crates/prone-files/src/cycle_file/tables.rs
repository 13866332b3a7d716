//! The tables of a cycle file, and what each of them says.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

use prone::foreign_text::{Quoted, is_hidden};
use prone::gait::cycle::{Approach, Cycle, Easing, Pull, Steering, Waypoint};
use prone::gait::{LimitsPolicy, PhaseDuration};
use prone::mapping::{ArmMode, MappingVariant};

use crate::curve_table::CurveTable;
use crate::error::{FileError, Source};
use crate::gait_file::{ArmName, LimitsName, MappingName};

/// Longest name of a waypoint, bytes.
const LONGEST_NAME: usize = 100;
/// Largest angle of a joint in a file, degrees.
const LARGEST_DEG: f64 = 360.0;
/// Largest turn command, degrees: beyond it the sines of the steering's geometry are not small.
const LARGEST_TURN_DEG: f64 = 30.0;
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CycleFile {
    pub(super) name: Spanned<String>,
    #[serde(default)]
    pub(super) description: String,
    pub(super) mapping: Option<Spanned<MappingText>>,
    pub(super) arm: Option<Spanned<ArmText>>,
    #[serde(default, with = "LimitsName")]
    pub(super) limits: LimitsPolicy,
    pub(super) pull: Option<PullTable>,
    #[serde(default)]
    pub(super) recovery: Vec<WaypointTable>,
    #[serde(default)]
    pub(super) waypoint: Vec<WaypointTable>,
    pub(super) approach: Option<ApproachTable>,
    pub(super) steering: Option<SteeringTable>,
}

#[derive(Debug, Deserialize)]
pub(super) struct MappingText(#[serde(with = "MappingName")] MappingVariant);

#[derive(Debug, Deserialize)]
pub(super) struct ArmText(#[serde(with = "ArmName")] ArmMode);

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PullTable {
    pub(super) duration_s: Spanned<f64>,
    knee: CurveTable,
    hip: CurveTable,
    upper_arm: CurveTable,
    #[serde(default)]
    joints: BTreeMap<String, CurveTable>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WaypointTable {
    pub(super) name: Option<Spanned<String>>,
    pub(super) time_s: Spanned<f64>,
    #[serde(default, with = "EasingName")]
    easing: Easing,
    #[serde(default)]
    joints_deg: BTreeMap<String, Spanned<f64>>,
    #[serde(default)]
    joints_rad: BTreeMap<String, Spanned<f64>>,
    #[serde(default)]
    turn: BTreeMap<String, Spanned<f64>>,
    #[serde(default)]
    shift: BTreeMap<String, Spanned<f64>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ApproachTable {
    pub(super) time_s: Spanned<f64>,
    #[serde(default, with = "EasingName")]
    pub(super) easing: Easing,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SteeringTable {
    limit_deg: Option<Spanned<f64>>,
    limit_rad: Option<Spanned<f64>>,
    shift_limit_deg: Option<Spanned<f64>>,
    shift_limit_rad: Option<Spanned<f64>>,
    dead_band_deg: Option<Spanned<f64>>,
    dead_band_rad: Option<Spanned<f64>>,
    spread: Option<Spanned<f64>>,
    #[serde(default)]
    joints: BTreeMap<String, Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(remote = "Easing", rename_all = "kebab-case")]
enum EasingName {
    Smoothstep,
    Linear,
}

/// Name of a waypoint that has none, by its place from 0.
pub(super) fn usual_name(index: usize) -> String {
    (index + 1).to_string()
}

impl Source<'_> {
    pub(super) fn pull(
        self,
        table: PullTable,
        mapping: Option<Spanned<MappingText>>,
        arm: Option<Spanned<ArmText>>,
        approach: Approach,
    ) -> Result<Pull, FileError> {
        let duration = PhaseDuration::new(*table.duration_s.get_ref())
            .map_err(|error| self.error(table.duration_s.span(), error))?;
        let mut company = BTreeMap::new();
        for (joint, curve) in table.joints {
            company.insert(joint, curve.read(self)?);
        }
        Ok(Pull {
            knee: table.knee.read(self)?,
            hip: table.hip.read(self)?,
            upper_arm: table.upper_arm.read(self)?,
            mapping: mapping.map_or_else(MappingVariant::default, |it| it.into_inner().0),
            arm: arm.map_or_else(ArmMode::default, |it| it.into_inner().0),
            duration,
            company,
            approach,
        })
    }

    pub(super) fn waypoint(
        self,
        index: usize,
        table: WaypointTable,
    ) -> Result<Waypoint, FileError> {
        if let Some(name) = table
            .name
            .as_ref()
            .filter(|it| it.get_ref().trim().is_empty())
        {
            return Err(self.error(name.span(), "a waypoint's name is empty"));
        }
        let is_shown = |name: &str| name.len() <= LONGEST_NAME && !name.contains(is_hidden);
        if let Some(name) = table.name.as_ref().filter(|it| !is_shown(it.get_ref())) {
            let message = format!(
                "a waypoint's name has at most {LONGEST_NAME} bytes, and no letter that is not seen, not {}",
                Quoted(name.get_ref())
            );
            return Err(self.error(name.span(), message));
        }
        let mut joints = BTreeMap::new();
        for (joint, angle) in table.joints_deg {
            let degrees = self.within(&angle, &joint, LARGEST_DEG)?;
            joints.insert(joint, degrees.to_radians());
        }
        for (joint, angle) in table.joints_rad {
            let radians = self.within(&angle, &joint, LARGEST_DEG.to_radians())?;
            if joints.insert(joint.clone(), radians).is_some() {
                let twice = format!("{joint} is given twice, in degrees and in radians");
                return Err(self.error(angle.span(), twice));
            }
        }
        let name = table.name.map(Spanned::into_inner);
        Ok(Waypoint {
            name: name.unwrap_or_else(|| usual_name(index)),
            approach: self.approach(&table.time_s, table.easing)?,
            joints,
            turn: self.factors(table.turn)?,
            shift: self.factors(table.shift)?,
        })
    }

    /// Factors of a command, by joint.
    fn factors(
        self,
        table: BTreeMap<String, Spanned<f64>>,
    ) -> Result<BTreeMap<String, f64>, FileError> {
        let factors = table.into_iter().map(|(joint, factor)| {
            let value = self.within(&factor, &joint, Steering::LARGEST_FACTOR)?;
            Ok((joint, value))
        });
        factors.collect()
    }

    pub(super) fn approach(
        self,
        time: &Spanned<f64>,
        easing: Easing,
    ) -> Result<Approach, FileError> {
        let seconds = *time.get_ref();
        let (least, most) = Cycle::STRETCH_SECONDS;
        if !(least..=most).contains(&seconds) {
            let message = format!("time_s must be {least} to {most} s, not {seconds}");
            return Err(self.error(time.span(), message));
        }
        Ok(Approach { seconds, easing })
    }

    pub(super) fn steering(
        self,
        table: SteeringTable,
        has_pull: bool,
    ) -> Result<Steering, FileError> {
        let limit = match (&table.limit_deg, &table.limit_rad) {
            (Some(degrees), None) => self
                .positive(degrees, "limit_deg", LARGEST_TURN_DEG)?
                .to_radians(),
            (None, Some(radians)) => {
                self.positive(radians, "limit_rad", LARGEST_TURN_DEG.to_radians())?
            }
            (Some(number), Some(_)) => {
                let message = "[steering] has both limit_deg and limit_rad";
                return Err(self.error(number.span(), message));
            }
            (None, None) => {
                let header = self.text.find("[steering").unwrap_or_default();
                let message = "[steering] needs one of limit_deg and limit_rad";
                return Err(self.error(header..header, message));
            }
        };
        let dead_band =
            self.degrees_or_radians((&table.dead_band_deg, &table.dead_band_rad), "dead_band")?;
        let in_pull = table
            .spread
            .as_ref()
            .or_else(|| table.joints.values().next());
        if let Some(number) = in_pull.filter(|_| !has_pull) {
            let message = "spread and joints of [steering] act in a pull, and there is no [pull]; \
                           `turn` of a waypoint acts there";
            return Err(self.error(number.span(), message));
        }
        let shift_limit = self.degrees_or_radians(
            (&table.shift_limit_deg, &table.shift_limit_rad),
            "shift_limit",
        )?;
        let spread = table.spread.as_ref();
        let spread = spread.map(|it| self.within(it, "spread", Steering::LARGEST_FACTOR));
        Ok(Steering {
            limit,
            dead_band,
            spread: spread.transpose()?.unwrap_or_default(),
            joints: self.factors(table.joints)?,
            shift_limit,
        })
    }

    /// An angle that is given in degrees or in radians, or not at all, which is 0; rad.
    fn degrees_or_radians(
        self,
        given: (&Option<Spanned<f64>>, &Option<Spanned<f64>>),
        what: &str,
    ) -> Result<f64, FileError> {
        match given {
            (None, None) => Ok(0.0),
            (Some(degrees), None) => {
                let degrees =
                    self.not_negative(degrees, &format!("{what}_deg"), LARGEST_TURN_DEG)?;
                Ok(degrees.to_radians())
            }
            (None, Some(radians)) => {
                let largest = LARGEST_TURN_DEG.to_radians();
                self.not_negative(radians, &format!("{what}_rad"), largest)
            }
            (Some(number), Some(_)) => {
                let message = format!("[steering] has both {what}_deg and {what}_rad");
                Err(self.error(number.span(), message))
            }
        }
    }

    fn not_negative(
        self,
        number: &Spanned<f64>,
        what: &str,
        largest: f64,
    ) -> Result<f64, FileError> {
        let value = *number.get_ref();
        if (0.0..=largest).contains(&value) {
            return Ok(value);
        }
        let message = format!("{what} must be 0 to {largest}, not {value}");
        Err(self.error(number.span(), message))
    }

    fn within(self, number: &Spanned<f64>, what: &str, largest: f64) -> Result<f64, FileError> {
        let value = *number.get_ref();
        if (-largest..=largest).contains(&value) {
            return Ok(value);
        }
        let message = format!("{what} must be within -{largest}..{largest}, not {value}");
        Err(self.error(number.span(), message))
    }

    fn positive(self, number: &Spanned<f64>, what: &str, largest: f64) -> Result<f64, FileError> {
        let value = *number.get_ref();
        if value > 0.0 && value <= largest {
            return Ok(value);
        }
        let message = format!("{what} must be above 0, up to {largest}, not {value}");
        Err(self.error(number.span(), message))
    }
}
