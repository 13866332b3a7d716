//! Mutants: one to three changes of a seed, each of the bytes, of a number or a text, or of what the
//! syntax is made of.

mod bytes;
mod json;
mod lines;
mod table;
mod tokens;
mod vocabulary;
mod xml;

use crate::chance::Chance;
use crate::format::{Format, Syntax};

/// The longest mutant, bytes: below what any reader takes, so that the readers' own bounds are met
/// by chance only and a campaign is not one of long files.
const LONGEST: usize = 2_000_000;

/// The mutant of a number. The same seeds and the same number give the same text.
///
/// # Panics
/// Where there is no seed.
pub fn mutant(format: Format, seeds: &[&str], seed: u64) -> String {
    // Formats with the same number differ, so that a campaign does not make the same choices in each.
    let salt = format.name().bytes().fold(0_u64, |sum, byte| {
        sum.wrapping_mul(0x0100_0000_01b3)
            .wrapping_add(u64::from(byte))
    });
    let mut chance = Chance::new(seed ^ salt);
    let mut text = (*chance.one(seeds)).to_owned();
    // One change is what gets deepest; more of them meet in places that one does not reach.
    let changes = *chance.one(&[1, 1, 1, 2, 3]);
    for _ in 0..changes {
        let changed = match chance.below(8) {
            0 => bytes::change(&mut chance, &text, seeds),
            1..=3 => tokens::change(&mut chance, &text),
            _ => match format.syntax() {
                Syntax::Xml => xml::change(&mut chance, &text),
                Syntax::Json => json::change(&mut chance, &text),
                Syntax::Table => table::change(&mut chance, &text),
                Syntax::Toml | Syntax::Journal => lines::change(&mut chance, &text),
            },
        };
        if changed.len() <= LONGEST {
            text = changed;
        }
    }
    text
}

/// A text with one of its ranges replaced.
fn replaced(text: &str, range: std::ops::Range<usize>, with: &str) -> String {
    [&text[..range.start], with, &text[range.end..]].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEEDS: &[(&str, Format)] = &[
        (
            "<mujoco><worldbody><body name=\"a\" pos=\"0 0 1\"><geom size=\".1\"/></body></worldbody></mujoco>",
            Format::RobotXml,
        ),
        (
            "name = \"a\"\n[knee]\nconstant_deg = 16.5\nlist = [1, \"x\"]\n",
            Format::Pull,
        ),
        (
            "{\"a\": [1, 2.5, {\"b\": \"text\"}], \"c\": null}",
            Format::Run,
        ),
        ("time_s,a,b\n0.1,2,x\n0.2,3,y\n", Format::Rows),
        ("{\"head\":1}\n[\"00ff\",{\"x\":1}]\n", Format::Checkpoint),
        ("", Format::Scene),
        ("é", Format::TorqueMap),
    ];

    #[test]
    fn identity_a_number_makes_one_text_and_numbers_make_many() {
        for (text, format) in SEEDS {
            let mut made = std::collections::BTreeSet::new();
            for seed in 0..2_000 {
                let first = mutant(*format, &[text], seed);
                assert_eq!(first, mutant(*format, &[text], seed));
                made.insert(first);
            }
            assert!(made.len() > 50, "{}: {} texts", format.name(), made.len());
        }
    }

    /// What the first campaign found is what these must go on making.
    #[test]
    fn mutants_of_a_model_have_what_a_model_can_say() {
        let (text, format) = SEEDS[0];
        let made: String = (0..30_000)
            .map(|seed| mutant(format, &[text], seed))
            .collect();
        for part in [
            " class=\"%",
            " user=\"",
            "<option ",
            " damping=\"-",
            "gravcomp=",
            "<default",
        ] {
            assert!(made.contains(part), "{part}");
        }
    }
}
