//! What a text is that stands where a number should, and is none.
//!
//! Spreadsheets, word processors and other programs write numbers in the manner of a country or of
//! print: `16,5`, `−5`, `1 234.5`, `“3”`, `16.5°`. None of these is guessed at: a value is refused, and
//! the message says what it is and, where it is known, how it should be written.

use crate::foreign_text::{cut, is_hidden};

/// Signs that look like a minus and are none.
const MINUSES: [char; 8] = [
    '\u{2212}', '\u{2010}', '\u{2011}', '\u{2012}', '\u{2013}', '\u{2014}', '\u{fe63}', '\u{ff0d}',
];

/// Quotes of print, and those of spreadsheets' texts.
const QUOTES: &str = "\"'“”„‟‘’‚‛«»";

/// What programs write where there is no number. Some read `nan` in all manners of writing.
const NO_NUMBERS: [&str; 9] = [
    "na", "n/a", "null", "none", "nil", "-", "--", "<na>", "missing",
];

/// Says what a text is that is no number, as a clause; nothing where that is not known.
pub fn explained(text: &str) -> Option<String> {
    let text = text.trim();
    if text.is_empty() {
        return Some("nothing stands there".to_owned());
    }
    let lower = text.to_lowercase();
    // Whatever a spreadsheet could not work out begins so: #N/A, #DIV/0!, #REF!.
    if NO_NUMBERS.contains(&lower.as_str()) || (text.starts_with('#') && text.len() > 1) {
        return Some("it stands for a number that is not there".to_owned());
    }
    // Nothing longer is a number in any manner.
    if text.len() > 64 {
        return None;
    }
    let mut number = text.to_owned();
    for step in [hidden, quotes, digits, signs, blanks, unit, exponent] {
        let (changed, reason) = step(&number);
        if let Some(reason) = reason {
            if is_number(&changed) {
                return Some(format!("{reason}: {changed}"));
            }
            // With a comma too, this is said first and the comma at the next reading.
            if let (other, Some(_)) = commas(&changed)
                && is_number(&other)
            {
                return Some(format!(
                    "{reason}, and it has a point, not a comma: {other}"
                ));
            }
            number = changed;
        }
    }
    let (changed, reason) = commas(&number);
    reason.filter(|_| is_number(&changed)).map(|reason| {
        if number == text || !reason.ends_with("comma") {
            format!("{reason}: {changed}")
        } else {
            format!("{reason}, and only digits, sign and point: {changed}")
        }
    })
}

/// A number as every reader of ours takes it: digits, and no word.
fn is_number(text: &str) -> bool {
    text.parse::<f64>().is_ok() && text.contains(|it: char| it.is_ascii_digit())
}

/// What a reading changes, and what it is that was changed.
type Step = (String, Option<String>);

/// Without a letter that matches, which is named.
fn without(text: &str, is: impl Fn(char) -> bool, said: impl Fn(char) -> String) -> Step {
    let first = text
        .find(&is)
        .and_then(|place| text[place..].chars().next());
    let rest = text.chars().filter(|letter| !is(*letter)).collect();
    (rest, first.map(said))
}

fn hidden(text: &str) -> Step {
    without(text, is_hidden, |letter| {
        format!(
            "the letter U+{:04X}, which is not to be seen, is no part of a number",
            u32::from(letter)
        )
    })
}

fn quotes(text: &str) -> Step {
    let inner = text.trim_matches(|letter| QUOTES.contains(letter));
    let reason = (inner.len() < text.len()).then(|| "a number has no quotes around it".to_owned());
    (inner.trim().to_owned(), reason)
}

fn digits(text: &str) -> Step {
    let ascii = text.chars().map(|letter| digit(letter).unwrap_or(letter));
    let ascii: String = ascii.collect();
    let reason = (ascii != text).then(|| "the digits of a number are 0 to 9".to_owned());
    (ascii, reason)
}

/// A digit or point of other scripts, and of full width.
fn digit(letter: char) -> Option<char> {
    const ZEROS: [u32; 11] = [
        0x660, 0x6f0, 0x966, 0x9e6, 0xa66, 0xae6, 0xb66, 0xe50, 0xed0, 0x1040, 0xff10,
    ];
    match letter {
        '\u{ff0e}' | '\u{66b}' => Some('.'),
        _ => ZEROS.iter().find_map(|zero| {
            let value = u32::from(letter).checked_sub(*zero)?;
            char::from_digit(value, 10)
        }),
    }
}

fn signs(text: &str) -> Step {
    let found = text
        .chars()
        .find(|it| MINUSES.contains(it) || *it == '\u{ff0b}');
    let changed = text.replace(MINUSES, "-").replace('\u{ff0b}', "+");
    let reason = found.map(|sign| {
        let written = if sign == '\u{ff0b}' { '+' } else { '-' };
        format!(
            "a sign is written {written}, not {sign} (U+{:04X})",
            u32::from(sign)
        )
    });
    (changed, reason)
}

fn blanks(text: &str) -> Step {
    let grouping = |letter: char| letter.is_whitespace() || matches!(letter, '\'' | '’' | '_');
    without(text, grouping, |letter| match letter {
        ' ' => "a number has no blanks in it".to_owned(),
        '\'' | '’' | '_' => "a number has no separators of thousands".to_owned(),
        blank => format!("a number has no blanks in it (U+{:04X})", u32::from(blank)),
    })
}

/// What stands behind the digits.
fn unit(text: &str) -> Step {
    let letter = |it: char| it.is_alphabetic() || "°%′″€$²³·/".contains(it);
    let number = text.trim_end_matches(letter);
    let number = number.trim_end_matches('^').trim_end();
    let behind = &text[number.len()..];
    let is_unit = !behind.is_empty() && number.contains(|it: char| it.is_ascii_digit());
    let reason =
        is_unit.then(|| format!("a number has no unit behind it ({})", cut(behind.trim())));
    (number.to_owned(), reason)
}

/// The exponent of Fortran, 1.5D-3.
fn exponent(text: &str) -> Step {
    let changed = text.replace(['d', 'D'], "e");
    let reason = (changed != text).then(|| "an exponent begins with e".to_owned());
    (changed, reason)
}

fn commas(text: &str) -> Step {
    let commas = text.matches(',').count();
    let points = text.matches('.').count();
    let reason = match (commas, points) {
        (0, 0 | 1) => return (text.to_owned(), None),
        // 1.234,5 and 1.234.567,8
        (1, _) if points > 0 && text.rfind(',') > text.rfind('.') => {
            return (
                text.replace('.', "").replace(',', "."),
                Some(
                    "a number has a point before its decimals, and no separators of thousands"
                        .to_owned(),
                ),
            );
        }
        (1, 0) => {
            let behind = text.rsplit(',').next().unwrap_or_default();
            let of_thousands = behind.len() == 3 && behind.bytes().all(|it| it.is_ascii_digit());
            if of_thousands {
                // Nobody can say which of two numbers 1,234 is.
                let decimal = text.replace(',', ".");
                let whole = text.replace(',', "");
                let reason =
                    "a number has a point before its decimals, and no separators of thousands";
                return (whole, Some(format!("{reason}: {decimal} or")));
            }
            return (
                text.replace(',', "."),
                Some("a number has a point, not a comma".to_owned()),
            );
        }
        (0, _) => {
            return (
                text.replace('.', ""),
                Some("a number has one point at most".to_owned()),
            );
        }
        _ => "a number has no separators of thousands",
    };
    (text.replace(',', ""), Some(reason.to_owned()))
}
