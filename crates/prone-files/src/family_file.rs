//! `family.toml`: what the versions of a robot share.
//!
//! ```toml
//! name = "nao"       # as the versions' robot.toml name it
//! default = "v4"     # the folder of the version that the family's own folder stands for
//! recorded = "scene" # the folder of the version whose torques were recorded and published; optional
//!
//! [defaults]         # which gaits the program uses, see [`crate::defaults`]
//! ```

use prone::foreign_text::Quoted;
use serde::Deserialize;
use toml::Spanned;

use crate::FileError;
use crate::defaults::DefaultsTable;
use crate::error::Source;
use crate::plain_name::is_plain;

/// The contents of a `family.toml`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FamilyFile {
    /// The family's name.
    pub(crate) name: Spanned<String>,
    /// Folder of the version that the family stands for.
    pub(crate) default: Spanned<String>,
    /// Folder of the version whose torques were recorded and published, where there is one.
    pub(crate) recorded: Option<Spanned<String>>,
    /// Which gaits the program uses.
    #[serde(default)]
    pub(crate) defaults: DefaultsTable,
}

impl FamilyFile {
    /// Reads a `family.toml`; `file` is the name that errors carry.
    pub(crate) fn parse(file: &str, text: &str) -> Result<Self, FileError> {
        let source = Source { file, text };
        let family: Self = source.parse()?;
        let names = [(&family.name, "a family"), (&family.default, "a version")];
        let recorded = family.recorded.iter().map(|name| (name, "a version"));
        for (name, whose) in names.into_iter().chain(recorded) {
            if !is_plain(name.get_ref()) {
                let message = format!(
                    "the name of {whose} is made of letters, digits, - and _ (it names a folder), not {}",
                    Quoted(name.get_ref())
                );
                return Err(source.error(name.span(), message));
            }
        }
        family.defaults.check(source)?;
        Ok(family)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> String {
        FamilyFile::parse("family.toml", text)
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn a_family_needs_little() {
        let text = "name = \"nao\"\ndefault = \"v4\"\n";
        let family = FamilyFile::parse("family.toml", text).unwrap();
        assert_eq!(family.name.get_ref(), "nao");
        assert_eq!(family.default.get_ref(), "v4");
        assert!(!family.defaults.has_under());
    }

    #[test]
    fn names_are_never_paths() {
        for name in [
            "",
            ".",
            "..",
            "../v4",
            "/v4",
            "v4/",
            "a\\\\b",
            "v 4",
            "a\\u0000b",
        ] {
            let text = format!("name = \"nao\"\ndefault = \"{name}\"\n");
            assert!(
                refused(&text).starts_with("family.toml:2:11: the name of a version is made of"),
                "{name}"
            );
            let text = format!("name = \"nao\"\ndefault = \"v4\"\nrecorded = \"{name}\"\n");
            assert!(
                refused(&text).starts_with("family.toml:3:12: the name of a version is made of"),
                "{name}"
            );
            let text = format!("default = \"v4\"\nname = \"{name}\"\n");
            assert!(
                refused(&text).starts_with("family.toml:2:8: the name of a family is made of"),
                "{name}"
            );
            let text = format!(
                "name = \"nao\"\ndefault = \"v4\"\n[defaults.cycle]\ncompared = [\"a\", \"{name}\"]\n"
            );
            assert!(
                refused(&text).starts_with("family.toml:4:18: a gait's name is made of"),
                "{name}"
            );
        }
    }

    #[test]
    fn lists_have_bounds_and_unknown_keys_are_errors() {
        let head = "name = \"nao\"\ndefault = \"v4\"\n";
        let table = |line: &str| refused(&format!("{head}[defaults.cycle]\n{line}\n"));
        assert_eq!(
            table("from = []"),
            "family.toml:4:8: at least one name is needed"
        );
        assert_eq!(
            table("under = []"),
            "family.toml:4:9: at least one name is needed"
        );
        let many = vec!["\"a\""; 101].join(", ");
        assert_eq!(
            table(&format!("compared = [{many}]")),
            "family.toml:4:12: more than 100 names"
        );
        assert!(table("uphill = \"a\"").starts_with("family.toml:4:1: unknown field `uphill`"));
        assert!(refused("name = \"nao\"\n").contains("missing field `default`"));
    }
}
