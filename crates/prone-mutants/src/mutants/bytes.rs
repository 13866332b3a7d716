//! Changes of bytes and lines, whatever they mean.

use crate::chance::Chance;

/// One change. What is no UTF-8 afterwards is made so, as all readers here take texts.
pub(super) fn change(chance: &mut Chance, text: &str, seeds: &[&str]) -> String {
    let mut bytes = text.as_bytes().to_vec();
    let at = chance.below(bytes.len());
    let end = (at + 1 + chance.below(64)).min(bytes.len());
    match chance.below(9) {
        0 if !bytes.is_empty() => bytes[at] ^= 1 << chance.below(8),
        1 => drop(bytes.drain(at..end)),
        2 => {
            let noise: Vec<u8> = (0..=chance.below(8))
                .map(|_| chance.bits().to_le_bytes()[0])
                .collect();
            bytes.splice(at..at, noise);
        }
        3 => {
            let part = bytes[at..end].to_vec();
            bytes.splice(at..at, part.repeat(1 + chance.below(50)));
        }
        4 => bytes.truncate(at),
        5 => {
            let other = chance.one(seeds).as_bytes();
            bytes.truncate(at);
            bytes.extend_from_slice(&other[chance.below(other.len())..]);
        }
        6 => {
            let mut lines: Vec<&str> = text.split_inclusive('\n').collect();
            if !lines.is_empty() {
                let (one, other) = (chance.below(lines.len()), chance.below(lines.len()));
                lines.swap(one, other);
            }
            bytes = lines.concat().into_bytes();
        }
        7 => {
            bytes = text
                .replace('\n', chance.word(&["\r\n", "\r", "\n\n", " "]))
                .into_bytes();
        }
        _ => drop(bytes.splice(..0, *b"\xef\xbb\xbf")),
    }
    String::from_utf8(bytes)
        .unwrap_or_else(|error| String::from_utf8_lossy(error.as_bytes()).into_owned())
}
