//! Texts that others wrote, where a person reads them.
//!
//! A name or a description comes from a file of somebody else. Printed as it is, a control character
//! commands the terminal, a direction mark turns the letters after it round, and an invisible letter
//! makes two names look like one. Wherever such a text is shown, these letters are written as
//! `\u{1b}`; all others, accents, ideographs and pictures among them, stay as they are. Wherever a
//! text is kept as data it stays what it is: in JSON as an escape of JSON, which reads as the same
//! letter.
//!
//! Hidden letters are the control characters of Unicode (C0 with tab and line end, DEL, C1), the
//! separators of lines and paragraphs, the marks of direction, letters without a width (the joiners
//! among them, so that a picture made of several falls apart), tags, the marks of annotations, and the
//! two numbers that are no letters. Without [`escaped_lines`] a line end is one of them: a name of two
//! lines could otherwise show a line of its own making.
//!
//! In a message a value is cut after [`LONGEST`] letters, with the number of those left out.

use std::borrow::Cow;
use std::fmt::{self, Write as _};

/// Most letters of a foreign value that a message shows.
pub const LONGEST: usize = 80;

/// Most letters of what a library says of a text, of which that may be a part.
pub const LONGEST_MESSAGE: usize = 400;

/// Whether a letter is not to be seen, or changes how others are.
pub const fn is_hidden(letter: char) -> bool {
    matches!(letter,
        '\0'..='\u{1f}'
        | '\u{7f}'..='\u{9f}'
        | '\u{ad}' // soft hyphen
        | '\u{34f}' // grapheme joiner
        | '\u{61c}' // Arabic letter mark
        | '\u{180e}' // Mongolian vowel separator
        | '\u{200b}'..='\u{200f}' // no width, joiners, direction
        | '\u{2028}'..='\u{202e}' // separators, direction
        | '\u{2060}'..='\u{206f}' // joiner, invisible operators, isolates
        | '\u{feff}' // byte order mark
        | '\u{fff9}'..='\u{fffb}' // annotations
        | '\u{fffe}' | '\u{ffff}'
        | '\u{e0000}'..='\u{e007f}' // tags
    )
}

/// A text in one line, with every hidden letter written as its number, such as `\u{1b}`.
pub fn escaped(text: &str) -> Cow<'_, str> {
    replaced(text, is_hidden, show)
}

/// A text of lines, with every hidden letter but their ends written as its number, such as `\u{1b}`.
pub fn escaped_lines(text: &str) -> Cow<'_, str> {
    replaced(text, |it| it != '\n' && is_hidden(it), show)
}

/// A page or a script, in which tabs stand too.
pub fn escaped_page(text: &str) -> Cow<'_, str> {
    replaced(text, |it| !matches!(it, '\n' | '\t') && is_hidden(it), show)
}

/// The text of a JSON document with every hidden letter as an escape of JSON: it reads as the same
/// value. What is not in a string has none.
pub fn escaped_json(json: &str) -> Cow<'_, str> {
    let in_strings = |it| it != '\n' && it != '\t' && it != '\r' && is_hidden(it);
    replaced(json, in_strings, |text, letter| {
        for unit in letter.encode_utf16(&mut [0; 2]) {
            // Writing to a string does not fail.
            let _ = write!(text, "\\u{unit:04x}");
        }
    })
}

/// A value as a message shows it: escaped, and cut after [`LONGEST`] letters.
pub fn cut(text: &str) -> Cow<'_, str> {
    match beginning(text) {
        (whole, 0) => escaped(whole),
        (kept, left_out) => Cow::Owned(format!("{}… ({left_out} more letters)", escaped(kept))),
    }
}

/// A value in quotes, as a message shows it: escaped, and cut after [`LONGEST`] letters.
#[derive(Debug, Clone, Copy)]
pub struct Quoted<'a>(pub &'a str);

impl fmt::Display for Quoted<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The debug form of a text escapes quotes, and every letter that is not printable.
        match beginning(self.0) {
            (whole, 0) => write!(f, "{}", escaped(&format!("{whole:?}"))),
            (kept, more) => {
                let kept = format!("{kept:?}");
                let open = escaped(kept.strip_suffix('"').unwrap_or(&kept));
                write!(f, "{open}…\" ({more} more letters)")
            }
        }
    }
}

/// What a library says of a text that may be a part of what is said: in one line, escaped, and of a
/// long message the middle is left out.
pub fn message(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    without_middle(&lines.join("; "), LONGEST_MESSAGE, Unit::Letters)
}

/// Lines of at most `most` bytes in all; of more, the middle is left out, and that is said.
pub fn bounded(text: &str, most: usize) -> String {
    without_middle(text, most, Unit::Bytes)
}

/// By what a length is measured.
#[derive(Clone, Copy)]
enum Unit {
    Letters,
    Bytes,
}

impl Unit {
    const fn size(self, letter: char) -> usize {
        match self {
            Self::Letters => 1,
            Self::Bytes => letter.len_utf8(),
        }
    }
}

/// Room for what is said in the place of the middle.
const SAID: usize = 48;

/// The first two thirds and the last third of what a text may have, escaped.
fn without_middle(text: &str, most: usize, unit: Unit) -> String {
    let text = match unit {
        Unit::Letters => escaped(text),
        Unit::Bytes => escaped_lines(text),
    };
    let whole: usize = text.chars().map(|letter| unit.size(letter)).sum();
    if whole <= most {
        return text.into_owned();
    }
    let room = most.saturating_sub(SAID);
    let reach = |mut left: usize, letters: &mut dyn Iterator<Item = char>| {
        let taken = letters.take_while(|letter| {
            let fits = unit.size(*letter) <= left;
            left = left.saturating_sub(unit.size(*letter));
            fits
        });
        taken.map(char::len_utf8).sum::<usize>()
    };
    let begin = reach(room - room / 3, &mut text.chars());
    let end = text.len() - reach(room / 3, &mut text.chars().rev());
    let left_out = text[begin..end].chars().count();
    format!(
        "{}… ({left_out} letters left out) …{}",
        &text[..begin],
        &text[end..]
    )
}

/// The first [`LONGEST`] letters, and how many follow.
fn beginning(text: &str) -> (&str, usize) {
    match text.char_indices().nth(LONGEST) {
        None => (text, 0),
        Some((end, _)) => (&text[..end], text[end..].chars().count()),
    }
}

/// A hidden letter as Rust writes it.
fn show(text: &mut String, letter: char) {
    text.extend(letter.escape_unicode());
}

fn replaced(
    text: &str,
    is_hidden: impl Fn(char) -> bool,
    write: impl Fn(&mut String, char),
) -> Cow<'_, str> {
    let Some(first) = text.find(&is_hidden) else {
        return Cow::Borrowed(text);
    };
    let mut shown = String::with_capacity(text.len() + 16);
    shown.push_str(&text[..first]);
    for letter in text[first..].chars() {
        if is_hidden(letter) {
            write(&mut shown, letter);
        } else {
            shown.push(letter);
        }
    }
    Cow::Owned(shown)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_commands_a_terminal_or_hides_is_shown() {
        let hostile = "a\u{1b}[2J\u{202e}b\tc\nd\u{7f}\u{9b}\u{2028}\u{200b}\u{e0041}\u{feff}";
        let shown = escaped(hostile);
        assert_eq!(
            shown,
            r"a\u{1b}[2J\u{202e}b\u{9}c\u{a}d\u{7f}\u{9b}\u{2028}\u{200b}\u{e0041}\u{feff}"
        );
        assert!(!shown.contains(is_hidden));
        assert_eq!(escaped_lines("a\r\nb\u{85}"), "a\\u{d}\nb\\u{85}");
        assert_eq!(escaped_page("\ta\u{2066}\n"), "\ta\\u{2066}\n");
    }

    #[test]
    fn what_is_harmless_stays() {
        for text in [
            "Gänge für 匍匐前進 🦎",
            "θ3 = 16.5° − 2",
            "עברית العربية",
            "",
        ] {
            assert!(matches!(escaped(text), Cow::Borrowed(same) if same == text));
            assert!(matches!(escaped_json(text), Cow::Borrowed(same) if same == text));
            assert_eq!(cut(text), text);
        }
    }

    #[test]
    fn a_long_value_is_cut_and_the_rest_counted() {
        let long = "ü".repeat(LONGEST + 5_000_000);
        let shown = cut(&long);
        assert!(shown.ends_with("ü… (5000000 more letters)"));
        assert_eq!(shown.chars().filter(|it| *it == 'ü').count(), LONGEST);
        let quoted = Quoted(&long).to_string();
        assert!(quoted.starts_with("\"ü") && quoted.ends_with("ü…\" (5000000 more letters)"));
        assert_eq!(
            Quoted("a\"\u{1b}\u{202e}").to_string(),
            r#""a\"\u{1b}\u{202e}""#
        );
        // Escapes are longer than letters, and bounded too.
        assert!(cut(&"\u{e0041}".repeat(1_000_000)).len() < 1000);
    }

    #[test]
    fn of_a_long_message_the_middle_is_left_out() {
        let said = message(&format!(
            "unknown field `{}`,\nexpected `name`",
            "x".repeat(1 << 20)
        ));
        assert!(said.starts_with("unknown field `xx"), "{said}");
        assert!(said.ends_with("x`,; expected `name`"), "{said}");
        assert!(said.contains("letters left out") && said.chars().count() <= LONGEST_MESSAGE);
        for most in [100, 101, 102, 103] {
            let said = bounded(&"a\nü匍".repeat(500), most);
            assert!(
                said.len() <= most && said.contains("letters left out"),
                "{said}"
            );
        }
        assert_eq!(bounded("a\nb\u{1b}", 100), "a\nb\\u{1b}");
    }

    #[test]
    fn json_reads_as_the_same_value() {
        let json = "{\n  \"a\": \"\u{7f}\u{85}\u{202e}\u{e0041}ü\"\n}";
        let shown = escaped_json(json);
        assert_eq!(
            shown,
            "{\n  \"a\": \"\\u007f\\u0085\\u202e\\udb40\\udc41ü\"\n}"
        );
    }
}
