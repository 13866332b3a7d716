//! What the values of attributes may be: names, words, and numbers within bounds.

use prone::robot::bounds;
use prone::{foreign_text, odd_number};

use crate::part_name;

/// Longest value, bytes: a hundred times what any attribute of a robot needs.
const LONGEST: usize = 1_000;

/// Longest keyword, bytes.
const LONGEST_WORD: usize = 32;

/// What a value is.
#[derive(Debug, Clone, Copy)]
pub(super) enum Value {
    /// A name, of the element or of another one.
    Name,
    /// The name of a default class, defined here.
    Class,
    /// The name of a default class that is defined somewhere in the file.
    ClassName,
    /// A keyword of the format: letters and digits. Which ones there are, the engine knows.
    Word,
    /// Numbers, at most so many.
    Numbers {
        /// Most of them.
        most: usize,
        /// Within what each of them is.
        bound: Bound,
    },
    /// Two ends, the lower one first; without a range both are 0.
    Range,
    /// `solref`: time constant, s, and damping ratio of a contact, or minus stiffness and damping.
    Softness,
    /// `solimp`: impedance by depth.
    Impedance,
    /// Anything: the engine is not given it.
    Ignored,
}

/// Within what a number is, and why.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bound {
    least: f64,
    largest: f64,
    unit: &'static str,
    /// What it protects, as the end of a sentence; nothing where units differ and the bound is no
    /// physical one.
    protects: &'static str,
}

impl Bound {
    /// Units differ, so this is no physical bound: those are checked on what the engine makes of the
    /// text. A NaN is in no range.
    pub(super) const ANY: Self = Self {
        least: -bounds::NUMBER,
        largest: bounds::NUMBER,
        unit: "",
        protects: "",
    };
    pub(super) const MASS: Self = Self::positive(
        bounds::MASS,
        " kg",
        "no body weighs less than nothing, or more than a car",
    );
    pub(super) const INERTIA: Self =
        Self::positive(bounds::INERTIA, " kg·m²", "a body resists turning");
    pub(super) const DENSITY: Self =
        Self::positive(bounds::DENSITY, " kg/m³", "no metal is denser");
    pub(super) const ARMATURE: Self = Self::positive(
        bounds::ARMATURE,
        " kg·m²",
        "a rotor resists turning, and no more than a robot does",
    );
    pub(super) const DAMPING: Self = Self::positive(
        bounds::DAMPING,
        " N·m·s/rad",
        "damping takes energy out, and lets a joint move",
    );
    pub(super) const SPRING: Self = Self::positive(
        bounds::STIFFNESS,
        " N·m/rad",
        "a spring pulls back, and lets a joint move",
    );
    pub(super) const FRICTION_LOSS: Self = Self::positive(
        bounds::EFFORT,
        " N·m",
        "dry friction takes energy out, and a motor overcomes it",
    );
    pub(super) const FRICTION: Self = Self::positive(10.0, "", "nothing sticks better");
    pub(super) const GRAVITY_COMPENSATION: Self =
        Self::positive(0.0, "", "gravity acts on all of a robot");
    /// Of a robot's mass the bounds are those of every robot; −1 leaves it as it is.
    pub(super) const TOTAL_MASS: Self = Self {
        least: -1.0,
        largest: bounds::TOTAL_MASS.1,
        unit: " kg",
        protects: "no humanoid is lighter or heavier",
    };
    pub(super) const LEAST_MASS: Self = Self::positive(
        0.01,
        " kg",
        "it repairs bodies without mass, and makes none heavy",
    );
    pub(super) const LEAST_INERTIA: Self = Self::positive(
        0.001,
        " kg·m²",
        "it repairs bodies without inertia, and makes none heavy",
    );
    pub(super) const JOINT_MARGIN: Self = Self::positive(0.01, " rad", "a stop acts at its angle");
    pub(super) const PIXELS: Self = Self::positive(4096.0, "", "a picture is kept in memory");

    const fn positive(largest: f64, unit: &'static str, protects: &'static str) -> Self {
        Self {
            least: 0.0,
            largest,
            unit,
            protects,
        }
    }

    fn check(&self, number: f64) -> Result<(), String> {
        let Self {
            least,
            largest,
            unit,
            protects,
        } = self;
        if (*least..=*largest).contains(&number) {
            return Ok(());
        }
        // Powers of ten are read better than rows of zeros.
        let end = |value: f64| {
            if value.abs() < 1e6 {
                value.to_string()
            } else {
                format!("{value:e}")
            }
        };
        let reason = if protects.is_empty() {
            String::new()
        } else {
            format!(": {protects}")
        };
        Err(format!(
            "{number} is outside {}..{}{unit}{reason}",
            end(*least),
            end(*largest)
        ))
    }
}

impl Value {
    /// Refuses a text that is no such value; `is_class` tells the classes of the file.
    pub(super) fn check(self, text: &str, is_class: impl Fn(&str) -> bool) -> Result<(), String> {
        if matches!(self, Self::Ignored) {
            return Ok(());
        }
        if text.len() > LONGEST {
            return Err(format!("{} bytes are more than {LONGEST}", text.len()));
        }
        match self {
            Self::Ignored => Ok(()),
            Self::Name => part_name::check("part", text).map_err(|error| error.to_string()),
            Self::Class => part_name::check("class", text).map_err(|error| error.to_string()),
            Self::ClassName if is_class(text) => Ok(()),
            Self::ClassName => Err(format!(
                "no <default> defines the class {}",
                foreign_text::cut(text)
            )),
            Self::Word => word(text),
            Self::Numbers { most, bound } => {
                let numbers = read_numbers(text, most)?;
                numbers
                    .into_iter()
                    .try_for_each(|number| bound.check(number))
            }
            Self::Range => range(&read_numbers(text, 2)?),
            Self::Softness => softness(&read_numbers(text, 2)?),
            Self::Impedance => impedance(&read_numbers(text, 5)?),
        }
    }
}

fn word(text: &str) -> Result<(), String> {
    let plain = text.bytes().all(|byte| byte.is_ascii_alphanumeric());
    if plain && (1..=LONGEST_WORD).contains(&text.len()) {
        return Ok(());
    }
    Err(format!("{} is no keyword", foreign_text::cut(text)))
}

fn read_numbers(text: &str, most: usize) -> Result<Vec<f64>, String> {
    let words: Vec<&str> = text.split_ascii_whitespace().collect();
    if words.is_empty() || words.len() > most {
        let many = if most == 1 {
            "1 number".to_owned()
        } else {
            format!("1 to {most} numbers")
        };
        return Err(format!("it has {many}, not {}", words.len()));
    }
    let number = |word: &&str| {
        let read = word.parse::<f64>().ok();
        read.ok_or_else(|| {
            let reason = match word.strip_suffix(',') {
                Some(_) => Some("blanks, not commas, stand between numbers".to_owned()),
                None => odd_number::explained(word),
            };
            let reason = reason.map_or_else(String::new, |reason| format!(": {reason}"));
            format!("{} is no number{reason}", foreign_text::cut(word))
        })
    };
    let numbers: Vec<f64> = words.iter().map(number).collect::<Result<_, _>>()?;
    numbers
        .iter()
        .try_for_each(|number| Bound::ANY.check(*number))?;
    Ok(numbers)
}

/// The lower end first.
fn range(numbers: &[f64]) -> Result<(), String> {
    match *numbers {
        [lower, upper] if lower > upper => Err(format!(
            "its lower end {lower} is above its upper end {upper}"
        )),
        [_, _] => Ok(()),
        _ => Err("it has 2 numbers, not 1".to_owned()),
    }
}

/// Contacts and stops hold: a time constant and a damping ratio, or a stiffness and a damping below zero.
fn softness(numbers: &[f64]) -> Result<(), String> {
    /// Seconds: from a tenth of the shortest step to what lets a robot sink in visibly.
    const TIME_CONSTANT: std::ops::RangeInclusive<f64> = 1e-4..=0.5;
    const DAMPING_RATIO: std::ops::RangeInclusive<f64> = 0.05..=20.0;
    let good = match *numbers {
        [time] => TIME_CONSTANT.contains(&time),
        [time, ratio] if time > 0.0 => {
            TIME_CONSTANT.contains(&time) && DAMPING_RATIO.contains(&ratio)
        }
        // Minus stiffness k and minus damping b: the time constant is 2 / b, the ratio b / (2 √k).
        [stiffness, damping] if stiffness < 0.0 && damping < 0.0 => {
            TIME_CONSTANT.contains(&(2.0 / -damping))
                && DAMPING_RATIO.contains(&(-damping / (2.0 * (-stiffness).sqrt())))
        }
        _ => false,
    };
    if good {
        return Ok(());
    }
    let numbers = numbers.iter().map(f64::to_string);
    Err(format!(
        "{} is neither a time constant of {} to {} s with a damping ratio of {} to {}, nor minus a stiffness and minus a damping of the same: a contact like that would not hold",
        numbers.collect::<Vec<_>>().join(" "),
        TIME_CONSTANT.start(),
        TIME_CONSTANT.end(),
        DAMPING_RATIO.start(),
        DAMPING_RATIO.end(),
    ))
}

/// Contacts and stops push: least and largest impedance, the depth between them, m or rad, and the form
/// of the transition.
fn impedance(numbers: &[f64]) -> Result<(), String> {
    let bounds = [
        ("the impedance at the surface", 0.0, 1.0),
        ("the impedance in the depth", 0.5, 1.0),
        ("the depth", 0.0, 0.1),
        ("the midpoint", 0.0, 1.0),
        ("the power", 1.0, 20.0),
    ];
    for (number, (what, least, largest)) in numbers.iter().zip(bounds) {
        if !(least..=largest).contains(number) {
            return Err(format!(
                "{what}, {number}, is outside {least}..{largest}: a contact like that would not hold"
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(value: Value, text: &str) -> Result<(), String> {
        value.check(text, |class| class == "visual")
    }

    #[test]
    fn values_are_what_they_are_said_to_be() {
        let one = Value::Numbers {
            most: 1,
            bound: Bound::DAMPING,
        };
        for (value, good, bad) in [
            (Value::Name, "L.Knee-1_2", "%s%n"),
            (Value::Class, "visual", "a b"),
            (Value::ClassName, "visual", "%p %p"),
            (Value::Word, "capsule", "capsule%s"),
            (Value::Word, "2d", ""),
            (one, " .5\t", "-50"),
            (one, "0", "1e6"),
            (one, "1", "1 2"),
            (one, "1e-3", "0x1p3"),
            (one, "1", "nan"),
            (one, "1", "1,5"),
            (Value::Range, "-1 1", "1 -1"),
            (Value::Range, "0 0", "1"),
            (Value::Softness, ".02 1", "0 1"),
            (Value::Softness, "-1000 -10", "-1000 10"),
            (Value::Softness, "-1000 -10", "-1000 -.001"),
            (Value::Softness, "-1000 -10", "-1e7 -1e7"),
            (Value::Softness, ".02", "5 1"),
            (Value::Impedance, ".9 .95 .001 .5 2", "0 0 1"),
            (Value::Impedance, ".015 1 .022", ".9 .1"),
        ] {
            assert_eq!(check(value, good), Ok(()), "{value:?}");
            assert!(check(value, bad).is_err(), "{value:?}: {bad}");
        }
        let long = "1 ".repeat(1_000);
        let many = Value::Numbers {
            most: 10_000,
            bound: Bound::ANY,
        };
        assert!(check(many, &long).is_err());
        assert_eq!(check(Value::Ignored, &long), Ok(()));
    }
}
