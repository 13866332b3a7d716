//! Changes of one value of a JSON text.

use serde_json::{Value, json};

use crate::chance::Chance;

use super::{lines, tokens};

/// One change; by lines where the text is no JSON.
pub(super) fn change(chance: &mut Chance, text: &str) -> String {
    let Ok(mut document) = serde_json::from_str::<Value>(text) else {
        return lines::change(chance, text);
    };
    if chance.once_in(10) {
        // A key that stands twice, or nesting, which a value cannot say.
        let depth = 1 << chance.below(17);
        let deep = ["[".repeat(depth), "]".repeat(depth)].concat();
        let key = *chance.one(&["format", "version", "rows", "name", "robot", "x"]);
        return text.replacen('{', &format!("{{\"{key}\": {deep},"), 1);
    }
    let count = size(&document);
    let mut place = chance.below(count);
    if let Some(value) = nth(&mut document, &mut place) {
        alter(chance, value);
    }
    serde_json::to_string(&document).unwrap_or_default()
}

/// How many values there are.
fn size(value: &Value) -> usize {
    let within: usize = match value {
        Value::Array(items) => items.iter().map(size).sum(),
        Value::Object(entries) => entries.values().map(size).sum(),
        _ => 0,
    };
    1 + within
}

/// The value at a place, counted from the outside.
fn nth<'v>(value: &'v mut Value, place: &mut usize) -> Option<&'v mut Value> {
    if *place == 0 {
        return Some(value);
    }
    *place -= 1;
    match value {
        Value::Array(items) => items.iter_mut().find_map(|item| nth(item, place)),
        Value::Object(entries) => entries.values_mut().find_map(|entry| nth(entry, place)),
        _ => None,
    }
}

fn alter(chance: &mut Chance, value: &mut Value) {
    let kinds = [
        json!(null),
        json!(true),
        json!(-1),
        json!(1e300),
        json!(""),
        json!([]),
        json!({}),
        json!([[1]]),
    ];
    if chance.once_in(3) {
        *value = chance.one(&kinds).clone();
        return;
    }
    match value {
        Value::Number(number) => {
            let text = tokens::number(chance, &number.to_string());
            *value = serde_json::from_str(&text).unwrap_or(Value::String(text));
        }
        Value::String(text) => *text = tokens::string(chance, text),
        Value::Array(items) => {
            let at = chance.below(items.len());
            match chance.below(4) {
                0 => items.truncate(at),
                1 => items.reverse(),
                2 => {
                    let item = items.get(at).cloned().unwrap_or(json!(0));
                    // A long list of long items is a long file, not a new one.
                    let most = 20_000 / (1 + item.to_string().len());
                    items.extend(std::iter::repeat_n(item, 1 + chance.below(most)));
                }
                _ => drop((at < items.len()).then(|| items.remove(at))),
            }
        }
        Value::Object(entries) => {
            let keys: Vec<String> = entries.keys().cloned().collect();
            if keys.is_empty() {
                return;
            }
            let (key, other) = (chance.one(&keys), chance.one(&keys));
            let taken = entries.remove(key);
            let new = match chance.below(3) {
                0 => return,
                1 => format!("{key}x"),
                _ => other.clone(),
            };
            entries.insert(new, taken.unwrap_or(Value::Null));
        }
        Value::Bool(truth) => *truth = !*truth,
        Value::Null => *value = json!(0),
    }
}
