//! Commands that are not there, and that `prone list` does: a tip leads to it.

use std::ffi::OsString;

use clap::Parser;
use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, Error};

use crate::args::Args;

/// Words by which a list is asked for, as commands or after one.
const WORDS: [&str; 9] = [
    "list", "ls", "gaits", "cycle", "cycles", "scene", "scenes", "robots", "names",
];

/// What was typed, or why it is nothing that can be done.
pub(crate) fn parse(
    typed: impl IntoIterator<Item = impl Into<OsString> + Clone>,
) -> Result<Args, Error> {
    Args::try_parse_from(typed).map_err(with_tip)
}

fn with_tip(mut error: Error) -> Error {
    let asked = match error.get(ContextKind::InvalidSubcommand) {
        Some(ContextValue::String(asked)) => asked.as_str(),
        _ => return error,
    };
    if WORDS.contains(&asked) {
        let tip = "`prone list` lists gaits, cycles, scenes and robots";
        // In place of commands that are spelt alike.
        error.remove(ContextKind::SuggestedSubcommand);
        let tips = ContextValue::StyledStrs(vec![StyledStr::from(tip)]);
        error.insert(ContextKind::Suggested, tips);
    }
    error
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(typed: &[&str]) -> String {
        parse(typed).unwrap_err().to_string()
    }

    #[test]
    fn a_list_of_one_kind_leads_to_the_list_of_all() {
        for typed in [
            &["prone", "crawl", "list"][..],
            &["prone", "gait", "list"],
            &["prone", "robot", "ls"],
            &["prone", "scene", "list"],
        ] {
            let said = said(typed);
            assert!(said.contains("tip: `prone list` lists gaits"), "{said}");
        }
        assert!(!said(&["prone", "gait", "shwo"]).contains("prone list"));
        assert!(parse(["prone", "list"]).is_ok());
    }
}
