//! Changes of elements and attributes of a model, in the words of its own language.

use std::ops::Range;

use crate::chance::Chance;

use super::vocabulary::{ATTRIBUTES, ELEMENTS, HOSTILE, OWN_ATTRIBUTES, VALUES};
use super::{replaced, tokens};

/// One change.
pub(super) fn change(chance: &mut Chance, text: &str) -> String {
    let tags = tags(text);
    if tags.is_empty() {
        return format!("<mujoco>{text}</mujoco>");
    }
    let tag = chance.one(&tags).clone();
    let name = tag.start
        + 1
        + text[tag.start + 1..tag.end]
            .find([' ', '/', '>'])
            .unwrap_or(0);
    let after = tag.end..tag.end;
    match chance.below(9) {
        0..=2 => {
            let new = attribute(chance, &text[tag.start + 1..name]);
            replaced(text, name..name, &new)
        }
        3 => {
            let element = element(chance);
            insert(text, after, &element)
        }
        4 => insert(text, after, chance.word(HOSTILE)),
        5 => {
            // One of them with so many numbers of its own that the engine keeps as many for each.
            let name = *chance.one(&["site", "geom", "camera", "body", "joint", "light", "frame"]);
            let numbers = "1 ".repeat(1 << (8 + chance.below(9)));
            let first =
                format!("<{name} user=\"{numbers}\" size=\".01\"/>").repeat(chance.below(2));
            let first = if name == "camera" {
                first.replace(" size=\".01\"", "")
            } else {
                first
            };
            let size = if name == "geom" { " size=\".01\"" } else { "" };
            let more = format!("<{name}{size}/>").repeat(1 << (5 + chance.below(9)));
            replaced(text, after, &[first, more].concat())
        }
        6 => replaced(text, tag, ""),
        7 => {
            let again = text[tag.clone()].to_owned();
            replaced(text, tag.end..tag.end, &again)
        }
        _ => {
            // An attribute of an element that is there: gone, or with another value.
            let quoted = tokens::quoted(&text[tag.clone()]);
            if quoted.is_empty() {
                return text.to_owned();
            }
            let within = chance.one(&quoted).clone();
            let value = tag.start + within.start..tag.start + within.end;
            replaced(text, value, &any_value(chance))
        }
    }
}

/// Where tags of elements stand, closing ones left out.
fn tags(text: &str) -> Vec<Range<usize>> {
    let starts = text.match_indices('<').map(|(at, _)| at);
    starts
        .filter(|at| text[at + 1..].starts_with(|letter: char| letter.is_ascii_alphabetic()))
        .filter_map(|at| Some(at..at + text[at..].find('>')? + 1))
        .collect()
}

/// Inserts an element where it can stand: some have their place at the top.
fn insert(text: &str, after: Range<usize>, element: &str) -> String {
    const AT_TOP: &[&str] = &[
        "option",
        "compiler",
        "size",
        "visual",
        "statistic",
        "default",
        "asset",
        "equality",
        "sensor",
        "contact",
    ];
    let name = element[1..]
        .split([' ', '>', '/'])
        .next()
        .unwrap_or_default();
    let world = text.find("<worldbody").filter(|_| AT_TOP.contains(&name));
    replaced(text, world.map_or(after, |at| at..at), element)
}

fn element(chance: &mut Chance) -> String {
    let name = if chance.once_in(2) {
        *chance.one(ELEMENTS)
    } else {
        chance.one(OWN_ATTRIBUTES).0
    };
    let mut tag = format!("<{name}");
    for _ in 0..chance.below(4) {
        tag.push_str(&attribute(chance, name));
    }
    if chance.once_in(4) {
        let depth = 1 + chance.below(30);
        return [
            format!("{tag}>").repeat(depth),
            format!("</{name}>").repeat(depth),
        ]
        .concat();
    }
    tag + "/>"
}

/// An attribute of an element: mostly one that it has.
fn attribute(chance: &mut Chance, element: &str) -> String {
    let own = OWN_ATTRIBUTES.iter().find(|(name, _)| *name == element);
    let name = match own {
        Some((_, own)) if !own.is_empty() && !chance.once_in(6) => *chance.one(own),
        _ => *chance.one(ATTRIBUTES),
    };
    let value = match (name, chance.below(4)) {
        ("user", _) => "1 ".repeat(1 << chance.below(15)),
        ("class" | "childclass", 0..=2) => {
            (*chance.one(&["%s%s%s%s%s%s%s%s", "%n", "nothing", "main", ""])).to_owned()
        }
        (_, 0) => any_value(chance),
        // Of a number that is one, which gets past the gate.
        _ => (*chance.one(VALUES)).to_owned(),
    };
    format!(" {name}=\"{value}\"")
}

fn any_value(chance: &mut Chance) -> String {
    match chance.below(3) {
        0 => tokens::number(chance, "0.5"),
        1 => tokens::string(chance, "a")
            .replace('"', "&quot;")
            .replace('<', "&lt;"),
        _ => (*chance.one(VALUES)).to_owned(),
    }
}
