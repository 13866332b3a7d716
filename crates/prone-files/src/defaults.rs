//! `[defaults]`: the gaits that the program uses with a robot where its user names none.
//!
//! ```toml
//! [defaults.pull]
//! from = "nominal"                   # what a search of pulls starts from
//! compared = ["nominal", "optimal"]  # beside which a found pull is simulated
//! body_share_of = "optimal"          # trunk, head and legs carry no larger share of the weight
//!
//! [defaults.cycle]
//! from = ["low-175", "low-165"]      # what a search of cycles starts from
//! compared = ["thesis-nominal"]      # beside which a found cycle is crawled
//! under = ["low-175", "low-165"]     # what `prone crawl under` tries
//! ```
//!
//! The table stands in `family.toml`, or in `robot.toml`, whose keys go before those of the family.
//! A key that neither has is that of the robot that ships.

use serde::Deserialize;
use toml::Spanned;

use crate::error::{FileError, Source};
use crate::gait_text::GaitKind;
use crate::plain_name;

/// Most names of a list.
const MOST_NAMES: usize = 100;

/// Which gaits the program uses, by name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Defaults {
    /// Of pulls.
    pub pull: PullDefaults,
    /// Of whole cycles.
    pub cycle: CycleDefaults,
}

/// Which pulls the program uses, by name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PullDefaults {
    /// The pull about which a search is made.
    pub from: String,
    /// The pulls that a found one is compared with, as far as the robot can follow them.
    pub compared: Vec<String>,
    /// The pull whose share of the weight on trunk, head and legs is a found one's limit.
    pub body_share_of: String,
}

/// Which cycles the program uses, by name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CycleDefaults {
    /// The cycles of which a search takes one to begin with.
    pub from: Vec<String>,
    /// The cycles that a found one is compared with, as far as the robot can crawl them.
    pub compared: Vec<String>,
    /// The cycles that are tried under a ceiling, in this order.
    pub under: Vec<String>,
}

/// `[defaults]` as a file has it, keys left out.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DefaultsTable {
    #[serde(default)]
    pull: PullTable,
    #[serde(default)]
    cycle: CycleTable,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct PullTable {
    from: Option<Spanned<String>>,
    compared: Option<Names>,
    body_share_of: Option<Spanned<String>>,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct CycleTable {
    from: Option<Names>,
    compared: Option<Names>,
    under: Option<Names>,
}

type Names = Spanned<Vec<Spanned<String>>>;

impl DefaultsTable {
    /// Refuses what no table can say: names that are paths, lists that are too long, and empty
    /// ones where one gait is needed.
    pub(crate) fn check(&self, source: Source<'_>) -> Result<(), FileError> {
        for (_, name) in self.names() {
            let checked = plain_name::check_gait(name.get_ref());
            checked.map_err(|error| source.error(name.span(), error.to_string()))?;
        }
        for names in self.lists() {
            if names.get_ref().len() > MOST_NAMES {
                let message = format!("more than {MOST_NAMES} names");
                return Err(source.error(names.span(), message));
            }
        }
        let needed = [&self.cycle.from, &self.cycle.under];
        match needed
            .into_iter()
            .flatten()
            .find(|it| it.get_ref().is_empty())
        {
            Some(empty) => Err(source.error(empty.span(), "at least one name is needed")),
            None => Ok(()),
        }
    }

    /// Every name, with what it must be the name of.
    pub(crate) fn names(&self) -> impl Iterator<Item = (GaitKind, &Spanned<String>)> {
        fn all(names: Option<&Names>) -> impl Iterator<Item = &Spanned<String>> {
            names.into_iter().flat_map(Spanned::get_ref)
        }
        let (pull, cycle) = (&self.pull, &self.cycle);
        let pulls = all(pull.compared.as_ref())
            .chain(&pull.from)
            .chain(&pull.body_share_of);
        let cycles = all(cycle.from.as_ref())
            .chain(all(cycle.compared.as_ref()))
            .chain(all(cycle.under.as_ref()));
        pulls
            .map(|name| (GaitKind::Pull, name))
            .chain(cycles.map(|name| (GaitKind::Cycle, name)))
    }

    fn lists(&self) -> impl Iterator<Item = &Names> {
        let (pull, cycle) = (&self.pull, &self.cycle);
        [&pull.compared, &cycle.from, &cycle.compared, &cycle.under]
            .into_iter()
            .flatten()
    }

    /// Whether it says which cycles are tried under a ceiling.
    pub(crate) const fn has_under(&self) -> bool {
        self.cycle.under.is_some()
    }

    /// Cycles that are tried under a ceiling where it does not say which; none change nothing.
    pub(crate) fn try_under(&mut self, cycles: Vec<String>) {
        let names = cycles.into_iter().map(|name| Spanned::new(0..0, name));
        let names: Vec<_> = names.collect();
        if !names.is_empty() {
            self.cycle.under = Some(Spanned::new(0..0, names));
        }
    }

    /// Its keys, and those of `others` that it lacks.
    pub(crate) fn over(self, others: Self) -> Self {
        let (pull, cycle) = (self.pull, self.cycle);
        Self {
            pull: PullTable {
                from: pull.from.or(others.pull.from),
                compared: pull.compared.or(others.pull.compared),
                body_share_of: pull.body_share_of.or(others.pull.body_share_of),
            },
            cycle: CycleTable {
                from: cycle.from.or(others.cycle.from),
                compared: cycle.compared.or(others.cycle.compared),
                under: cycle.under.or(others.cycle.under),
            },
        }
    }

    /// All defaults, of a table that lacks none; an error names `source`.
    pub(crate) fn whole(self, source: Source<'_>) -> Result<Defaults, FileError> {
        let lacks = |key| source.error(0..0, format!("[defaults] lacks {key}"));
        let one = |key, name: Option<Spanned<String>>| {
            name.map(Spanned::into_inner).ok_or_else(|| lacks(key))
        };
        let some = |key, names: Option<Names>| {
            let names = names.ok_or_else(|| lacks(key))?.into_inner().into_iter();
            Ok(names.map(Spanned::into_inner).collect())
        };
        Ok(Defaults {
            pull: PullDefaults {
                from: one("pull.from", self.pull.from)?,
                compared: some("pull.compared", self.pull.compared)?,
                body_share_of: one("pull.body_share_of", self.pull.body_share_of)?,
            },
            cycle: CycleDefaults {
                from: some("cycle.from", self.cycle.from)?,
                compared: some("cycle.compared", self.cycle.compared)?,
                under: some("cycle.under", self.cycle.under)?,
            },
        })
    }
}
