//! Changes of one number or of one text between quotes.

use std::ops::Range;

use crate::chance::Chance;

use super::replaced;

/// What no reader may take for a plausible number, or has to bound.
const NUMBERS: &[&str] = &[
    "NaN",
    "nan",
    "inf",
    "-inf",
    "+Infinity",
    "1e308",
    "-1e308",
    "1e999",
    "1e-308",
    "5e-324",
    "-0",
    "0",
    "-1",
    "1",
    "1e9",
    "-1e9",
    "1000000000",
    "99999",
    "18446744073709551616",
    "-9223372036854775809",
    "9007199254740993",
    "4294967296",
    "2147483647",
    "0x10",
    "0x1p4",
    "1_000",
    "1,5",
    "1.5.2",
    "",
    "9999999999999999999999999999999999999999",
    "1e",
    ".",
    "-",
    "true",
    "null",
    "0.1234567890123456789012345678901234567890",
    "٣",
    "1 2 3 4 5 6 7 8 9",
];

/// Texts that are something else to somebody: a path, a format, a cell, a terminal, a page.
const TEXTS: &[&str] = &[
    "",
    " ",
    "%s%s%s%s%s%s%s%s",
    "%n",
    "%p %p %p %p",
    "%100000000d",
    "../x",
    "../../../../etc/passwd",
    "/dev/zero",
    ".",
    "..",
    "C:\\\\x",
    "a/b",
    "a,b",
    "a;b",
    "a\tb",
    "L\"Knee",
    "a'b",
    "a\nb",
    "a\r\nb",
    "\u{1b}[2J\u{1b}[31mX",
    "\u{202e}abc",
    "\u{feff}",
    "\u{0}",
    "a\\u0000b",
    "a\\u001b[2Jb",
    "\u{7}",
    "<script>alert(1)</script>",
    "</script><!--",
    "=1+1",
    "@SUM(A1)",
    "NaN",
    "inf",
    "null",
    "-rf",
    "é",
    "👩‍👩‍👧",
    "Ａ",
    "world",
    "floor",
    "LKneePitch",
    "LKneePitch_cmd",
    "time_s",
    "CON",
    "a ",
    " a",
];

/// One change; the text as it is where it has neither a number nor quotes.
pub(super) fn change(chance: &mut Chance, text: &str) -> String {
    let (numbers, texts) = (numbers(text), quoted(text));
    let on_number = texts.is_empty() || (!numbers.is_empty() && !chance.once_in(3));
    let ranges = if on_number { &numbers } else { &texts };
    if ranges.is_empty() {
        return text.to_owned();
    }
    let range = chance.one(ranges).clone();
    let now = &text[range.clone()];
    if chance.once_in(5) {
        // The value of another place.
        let other = chance.one(ranges).clone();
        let other = text[other].to_owned();
        return replaced(text, range, &other);
    }
    let new = if on_number {
        number(chance, now)
    } else {
        string(chance, now)
    };
    replaced(text, range, &new)
}

/// Another number in place of one.
pub(super) fn number(chance: &mut Chance, now: &str) -> String {
    let value: f64 = now.parse().unwrap_or(1.0);
    match chance.below(10) {
        0 => (value * 1e6).to_string(),
        1 => (value * 1e-6).to_string(),
        2 => format!("-{now}").replace("--", ""),
        3 => (value * 1e3).to_string(),
        4 => now.replace('.', ","),
        5 => format!("{now}{}", "9".repeat(1 + chance.below(400))),
        6 => (value * 1.000_001 + 1e-9).to_string(),
        _ => (*chance.one(NUMBERS)).to_owned(),
    }
}

/// Another text in place of one.
pub(super) fn string(chance: &mut Chance, now: &str) -> String {
    match chance.below(6) {
        0 => "x".repeat(1 << chance.below(18)),
        1 => format!("{now}{}", chance.one(TEXTS)),
        2 => now.to_uppercase(),
        _ => (*chance.one(TEXTS)).to_owned(),
    }
}

/// Where numbers stand.
pub(super) fn numbers(text: &str) -> Vec<Range<usize>> {
    let bytes = text.as_bytes();
    let belongs = |byte: u8| byte.is_ascii_digit() || b".eE+-".contains(&byte);
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let word = bytes[at].is_ascii_alphanumeric() || bytes[at] == b'_';
        let starts = bytes[at].is_ascii_digit()
            || (b".-".contains(&bytes[at]) && bytes.get(at + 1).is_some_and(u8::is_ascii_digit));
        let end = at
            + bytes[at..]
                .iter()
                .take_while(|byte| belongs(**byte))
                .count();
        if starts {
            found.push(at..end);
            at = end;
        } else if word {
            // A digit within a name is no number.
            at += bytes[at..]
                .iter()
                .take_while(|byte| byte.is_ascii_alphanumeric() || **byte == b'_')
                .count();
        } else {
            at += 1;
        }
    }
    found
}

/// What stands between two quotes of a line.
pub(super) fn quoted(text: &str) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut open = None;
    for (at, byte) in text.bytes().enumerate() {
        match (byte, open) {
            (b'"', None) => open = Some(at + 1),
            (b'"', Some(start)) => {
                found.push(start..at);
                open = None;
            }
            (b'\n', _) => open = None,
            _ => {}
        }
    }
    found
}
