//! Changes of keys and tables of a TOML file, by its lines.

use crate::chance::Chance;

use super::tokens;

/// One change.
pub(super) fn change(chance: &mut Chance, text: &str) -> String {
    let mut lines: Vec<String> = text.split_inclusive('\n').map(str::to_owned).collect();
    if lines.is_empty() {
        return "\n".to_owned();
    }
    let at = chance.below(lines.len());
    let line = lines[at].clone();
    let key = line.split('=').next().unwrap_or_default().trim().to_owned();
    let value = line
        .split_once('=')
        .map(|(_, value)| value.trim().to_owned());
    let new = |value: &str| format!("{key} = {value}\n");
    match chance.below(11) {
        0 => drop(lines.remove(at)),
        1 => lines.insert(at, line),
        2 => lines[at] = line.replacen(&key, &format!("{key}x"), 1),
        3 => {
            let other = lines[chance.below(lines.len())].clone();
            if let Some((_, value)) = other.split_once('=') {
                lines[at] = new(value.trim());
            }
        }
        4 => {
            // A whole table twice, or gone.
            let start = lines[..=at]
                .iter()
                .rposition(|line| line.starts_with('['))
                .unwrap_or(0);
            let length = lines[start + 1..]
                .iter()
                .position(|line| line.starts_with('['));
            let end = length.map_or(lines.len(), |length| start + 1 + length);
            let table: Vec<String> = lines.drain(start..end).collect();
            let times = *chance.one(&[0, 2, 2, 300]);
            let again = std::iter::repeat_n(table, times).flatten();
            lines.splice(start..start, again);
        }
        5 => {
            let depth = 1 << chance.below(15);
            lines[at] = new(&format!("{}1{}", "[".repeat(depth), "]".repeat(depth)));
        }
        6 => {
            lines[at] = new(chance.word(&[
                "{}",
                "[]",
                "\"\"",
                "true",
                "1979-05-27",
                "[[1]]",
                "{a={b=1}}",
                "''' '''",
            ]));
        }
        7 => {
            let item = value.unwrap_or_else(|| "1".to_owned());
            let items = vec![item; 1 << chance.below(14)].join(", ");
            lines[at] = new(&format!("[{items}]"));
        }
        8 => lines.insert(at, format!("{}x = 1\n", "a.".repeat(1 + chance.below(300)))),
        9 => lines.insert(
            at,
            format!(
                "[{}]\n",
                ["knee", "pull", "floor", "control", "a.b"][chance.below(5)]
            ),
        ),
        _ => lines[at] = tokens::change(chance, &line),
    }
    lines.concat()
}
