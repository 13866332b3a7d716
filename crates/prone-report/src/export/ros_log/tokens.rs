//! Names as parts of a topic's name: valid ones, and a different one for each name.
//!
//! A part begins with a letter, has letters, digits and single underscores of ASCII, and does not end
//! with an underscore: so ROS 2 takes it on every middleware. A name that is such a part stays. Any
//! other is made one, and gets a number behind it where that one is taken.

use std::collections::{BTreeMap, BTreeSet};

/// A part before its number has no more bytes, so that a topic of two parts stays within the 247
/// bytes that ROS 2 leaves to it.
const LONGEST: usize = 100;

/// The part for each name. `kind` begins a part whose name does not begin with a letter.
pub(super) fn tokens<'a>(
    kind: &str,
    names: impl IntoIterator<Item = &'a str>,
) -> BTreeMap<&'a str, String> {
    let names: BTreeSet<&str> = names.into_iter().collect();
    let mut tokens: BTreeMap<&str, String> = BTreeMap::new();
    let mut taken: BTreeSet<String> = BTreeSet::new();
    // Names that can stay come first: no other may take their part.
    let (valid, others): (Vec<&str>, Vec<&str>) = names
        .into_iter()
        .partition(|name| made(kind, name) == **name);
    for name in valid.into_iter().chain(others) {
        let token = made(kind, name);
        let numbered = (2..).map(|number| format!("{token}_{number}"));
        let mut choices = std::iter::once(token.clone()).chain(numbered);
        if let Some(free) = choices.find(|choice| !taken.contains(choice)) {
            taken.insert(free.clone());
            tokens.insert(name, free);
        }
    }
    tokens
}

/// A part that looks like the name.
fn made(kind: &str, name: &str) -> String {
    let words = name.split(|letter: char| !letter.is_ascii_alphanumeric());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    let mut token = words.join("_");
    if !token.starts_with(|first: char| first.is_ascii_alphabetic()) {
        token = match token.as_str() {
            "" => kind.to_owned(),
            rest => format!("{kind}_{rest}"),
        };
    }
    token.truncate(LONGEST);
    // An underscore may have become the last letter.
    token.trim_end_matches('_').to_owned()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn is_valid(token: &str) -> bool {
        let letters = |c: char| c.is_ascii_alphanumeric() || c == '_';
        token.starts_with(|c: char| c.is_ascii_alphabetic())
            && token.chars().all(letters)
            && !token.contains("__")
            && !token.ends_with('_')
            && token.len() <= LONGEST + 6
    }

    #[test]
    fn names_that_are_valid_stay_and_others_are_numbered() {
        let names = [
            "L.Foot", "L_Foot", "L-Foot", "2 by 4", "", "äöü", "a__b", "a_b", "a_b_2", "_a", "a_",
        ];
        let tokens = tokens("thing", names);
        let found = names.map(|name| tokens[name].as_str());
        assert_eq!(
            found,
            [
                "L_Foot_3",
                "L_Foot",
                "L_Foot_2",
                "thing_2_by_4",
                "thing",
                "thing_2",
                "a_b_3",
                "a_b",
                "a_b_2",
                "a",
                "a_2"
            ]
        );
    }

    proptest! {
        #[test]
        fn tokens_are_valid_and_distinct(
            names in proptest::collection::btree_set("(?s).{0,6}|[ab_.0-9]{0,4}|[a_]{98,110}", 0..40)
        ) {
            let tokens = tokens("body", names.iter().map(String::as_str));
            prop_assert_eq!(tokens.len(), names.len());
            let distinct: BTreeSet<&String> = tokens.values().collect();
            prop_assert_eq!(distinct.len(), names.len());
            for token in tokens.values() {
                prop_assert!(is_valid(token), "{}", token);
            }
        }
    }
}
