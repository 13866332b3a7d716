//! What a text is that is no TOML, where the text shows it.
//!
//! The reader of TOML says what it expected. Who typed a decimal comma, or took a file from a word
//! processor, is told what stands there instead.

use std::ops::Range;

use prone::{foreign_text, odd_number};

/// Quotes of print.
const QUOTES: [char; 8] = ['“', '”', '„', '‟', '‘', '’', '«', '»'];

/// Says what the text around an error is, as a sentence; nothing where that is not known.
pub(crate) fn explained(text: &str, span: Range<usize>) -> Option<String> {
    if let Some(other) = other_format(text) {
        return Some(other.to_owned());
    }
    let line = line_at(text, span.start)?;
    let (_, value) = line.split_once('=')?;
    let value = value.trim();
    if value.starts_with(QUOTES) {
        let inner = foreign_text::cut(value.trim_matches(QUOTES));
        return Some(format!("a text stands in straight quotes: \"{inner}\""));
    }
    let value = match value.split_once(" #") {
        Some((value, _)) if !value.contains('"') => value.trim_end(),
        _ => value,
    };
    let inner = value.trim_matches(['[', ']']);
    let mut candidates = std::iter::once(value).chain(inner.split([',', ';']));
    candidates
        .find_map(|it| {
            Some(it.trim())
                .filter(|it| !it.is_empty())
                .and_then(odd_number::explained)
        })
        .or_else(|| hidden(line))
}

/// Files of other formats, by how they begin.
fn other_format(text: &str) -> Option<&'static str> {
    let begin = text.trim_start_matches('\u{feff}').trim_start();
    match begin.chars().next()? {
        '<' => {
            Some("it is XML, as models (MJCF, URDF) and Choregraphe's projects are, and no TOML")
        }
        '{' => Some("it is JSON, and no TOML"),
        _ => {
            let mut lines = begin
                .lines()
                .filter(|line| !line.trim_start().starts_with('#'));
            let first = lines.next()?;
            let is_table = first.split([',', ';', '\t']).count() > 3 && !first.contains(['=', '[']);
            is_table.then_some("it is a table, as spreadsheets write them, and no TOML")
        }
    }
}

/// A letter that is not to be seen, where TOML takes it for none of its blanks.
fn hidden(line: &str) -> Option<String> {
    let is_odd = |letter: &char| {
        foreign_text::is_hidden(*letter) && *letter != '\t'
            || letter.is_whitespace() && !matches!(letter, ' ' | '\t')
    };
    let letter = line.chars().find(is_odd)?;
    let number = u32::from(letter);
    Some(format!(
        "a letter U+{number:04X} stands in the line, which looks like a blank or like nothing"
    ))
}

fn line_at(text: &str, offset: usize) -> Option<&str> {
    let before = text.get(..offset)?;
    let start = before.rfind('\n').map_or(0, |newline| newline + 1);
    text[start..].lines().next()
}

#[cfg(test)]
mod tests {
    use crate::gait_file;

    #[test]
    fn what_is_no_toml_is_named() {
        let gait = |knee: &str| {
            format!(
                "name = \"a\"\n[knee]\n{knee}\n[hip]\nconstant_deg = 27.5\n[upper_arm]\nlinear_deg = [-30, -90]\n"
            )
        };
        for (knee, says) in [
            (
                "constant_deg = 16,5",
                "a number has a point, not a comma: 16.5",
            ),
            (
                "constant_deg = 16,5 # degrees",
                "a number has a point, not a comma: 16.5",
            ),
            (
                "constant_deg = −16.5",
                "a sign is written -, not − (U+2212): -16.5",
            ),
            (
                "constant_deg = 16.5°",
                "a number has no unit behind it (°): 16.5",
            ),
            (
                "constant_deg = \"16.5\"",
                "a number has no quotes around it: 16.5",
            ),
            (
                "constant_deg = 1\u{a0}600",
                "a number has no blanks in it (U+00A0): 1600",
            ),
            (
                "linear_deg = [–30, 90]",
                "a sign is written -, not – (U+2013): -30",
            ),
            (
                "constant_deg\u{a0}= 16.5",
                "a letter U+00A0 stands in the line",
            ),
        ] {
            let error = gait_file::parse("a.toml", &gait(knee))
                .unwrap_err()
                .to_string();
            assert!(
                error.starts_with("a.toml:3:") && error.contains(says),
                "{error}"
            );
        }
        for (text, says) in [
            ("name = “a”\n", "a text stands in straight quotes: \"a\""),
            ("<robot name=\"a\"/>", "it is XML"),
            ("\u{feff}{\"joints\": []}", "it is JSON"),
            ("# a\ntime_s,a,b,c\n0,1,2,3\n", "it is a table"),
        ] {
            let error = gait_file::parse("a.toml", text).unwrap_err().to_string();
            assert!(error.contains(says), "{error}");
        }
    }

    #[test]
    fn what_is_only_wrong_is_said_as_ever_and_cut() {
        let error = gait_file::parse("a.toml", "name = \"a\"\nknie = 1\n").unwrap_err();
        assert!(error.message.contains("unknown field"), "{error}");
        let long = format!("name = \"a\"\n\"{}\" = 1\n", "x\u{1b}".repeat(2_000_000));
        let error = gait_file::parse("a.toml", &long).unwrap_err().to_string();
        assert!(
            error.len() < 1_000 && !error.contains('\u{1b}'),
            "{}",
            error.len()
        );
    }
}
