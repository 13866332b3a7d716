//! The plan of a search: what is searched, by which rules, how, and of which robot. It is `run.json` of
//! the result folder, what a checkpoint must agree with, and what the report reads.
//!
//! Numbers are in the units that their names say, as they are written.

use std::collections::BTreeMap;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::Value;

use prone_files::text_file;

use crate::experiment::{CycleRulesChoice, Ends, PullRules, Runs};
use crate::frontier::{CycleObjective, Quantity};
use crate::program::{Program, RobotInfo};
use crate::search::{Search, Solver};

/// The plan of a search.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum SearchPlan {
    /// `prone optimize` over pulls.
    Pull(Box<PullPlan>),
    /// `prone optimize` over whole cycles, and `prone crawl frontier`.
    Cycle(Box<CyclePlan>),
}

/// Cycles are told from pulls by the command and by the source `cycle`.
impl<'de> Deserialize<'de> for SearchPlan {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let plan = Value::deserialize(deserializer)?;
        let is = |key: &str, word: &str| plan.get(key).and_then(Value::as_str) == Some(word);
        let read = if is("command", "crawl frontier") || is("source", "cycle") {
            serde_json::from_value(plan).map(Self::Cycle)
        } else {
            serde_json::from_value(plan).map(Self::Pull)
        };
        read.map_err(D::Error::custom)
    }
}

/// What every plan says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SearchHead {
    /// `prone`.
    pub program: String,
    /// Its version.
    pub version: String,
    /// The commit it was built from.
    pub commit: String,
    /// The physics engine.
    pub engine: String,
    /// The command.
    pub command: String,
    /// The optimiser.
    pub solver: Solver,
    /// Seed of the first run; the others follow.
    pub seed: u64,
    /// Independent runs.
    pub runs: u64,
    /// Most evaluations of each run. No part of what a checkpoint must agree with, as a search may be
    /// given more.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub budget: Option<u64>,
    /// Hashes of the gaits that are searched about, by their names; where several texts have the same
    /// name, their hashes stand one behind the other.
    #[serde(default)]
    pub base_sha256: BTreeMap<String, String>,
}

/// A search of pulls.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PullPlan {
    /// What every plan says.
    #[serde(flatten)]
    pub head: SearchHead,
    /// What pulls cost.
    pub pricing: PullCostPlan,
    /// Curves that are searched.
    pub form: String,
    /// Whether θ3 and θ4 keep the base gait's ends.
    pub ends: Ends,
    /// Name of the found gait.
    pub name: String,
    /// Durations at which the found gait is simulated, s.
    pub confirm_durations_s: Vec<f64>,
}

/// What pulls cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PullCostPlan {
    /// What is minimised, and the rules.
    pub aim: PullAimPlan,
    /// Where torques come from.
    pub source: SourcePlan,
    /// The gait whose mapping, arms and ends hold.
    pub from: String,
    /// Its mapping.
    pub mapping: String,
    /// Its arms.
    pub arm: String,
    /// Of which robot.
    pub robot: RobotInfo,
}

/// What is minimised, and the rules.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "objective", rename_all = "lowercase")]
pub enum PullAimPlan {
    /// The published cost.
    Published {
        /// Least height of the hip's centre, mm.
        hip_threshold_mm: f64,
        /// How far outside the table's limits an angle may lie, rad.
        limit_tolerance_rad: f64,
    },
    /// Squared torque.
    Torque(GradedPlan),
    /// Largest torque over the manufacturer's effort limit.
    Peak(GradedPlan),
    /// Motor heat.
    Heat(GradedPlan),
}

/// The rules of an objective with graded violations.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GradedPlan {
    /// Of ankle, knee, hip and shoulder, for torque.
    pub weights: Option<[f64; 4]>,
    /// The rules, with the height of the base gait's hip where it is the clearance.
    #[serde(flatten)]
    pub rules: PullRules,
    /// The gait whose share of the weight on trunk, head and legs is the limit.
    pub body_share_of: Option<String>,
    /// That share.
    pub body_share_percent: Option<f64>,
    /// Contact regime.
    pub regime: String,
    /// How a pull begins.
    pub start: String,
}

/// Where torques come from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum SourcePlan {
    /// A torque map.
    Map {
        /// Its file, as the user named it.
        file: String,
        /// Of its text.
        sha256: String,
    },
    /// `statics` or `dynamics`.
    Named(String),
}

/// A search of whole cycles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CyclePlan {
    /// What every plan says.
    #[serde(flatten)]
    pub head: SearchHead,
    /// What is minimised.
    pub objective: CycleObjective,
    /// Whether only cycles that can be steered count.
    pub steerable: bool,
    /// Whether the corners are left out; those of an earlier record were others.
    #[serde(default)]
    pub ideal: bool,
    /// Size of the searched box, as a share of the largest.
    #[serde(default = "whole")]
    pub reach: f64,
    /// Under which ceilings, by which rules.
    #[serde(flatten)]
    pub under: UnderPlan,
    /// The cycle that is searched about, under each ceiling; known once the search is prepared.
    pub bases: Vec<String>,
    /// Contact regime.
    pub regime: String,
    /// Of which robot.
    pub robot: RobotInfo,
}

/// Searches had no smaller box once.
const fn whole() -> f64 {
    1.0
}

/// Under which ceilings cycles are searched, by which rules.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum UnderPlan {
    /// `prone crawl frontier`: a quantity that is held at several values, the usual rules.
    Frontier {
        /// What is held.
        #[serde(default)]
        held: Quantity,
        /// At which values, in its unit.
        #[serde(alias = "ceilings_mm")]
        at: Vec<f64>,
        /// Distance that has to stay between robot and ceiling, mm.
        margin_mm: f64,
        /// Cycles of which one is searched about under each ceiling.
        from: Vec<String>,
    },
    /// `prone optimize`: one ceiling or none, rules that can be asked for.
    One(Box<OnePlan>),
}

/// One ceiling or none, and the rules that are asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OnePlan {
    /// `cycle`.
    pub source: String,
    /// The rules, with the usual least advance where none was asked for.
    #[serde(flatten)]
    pub rules: CycleRulesChoice,
    /// The cycle over whose heats those found are.
    pub worst_over: Option<String>,
    /// The cycle that is searched about; known once the search is prepared.
    pub from: String,
    /// Name of the found cycle, where the user gave one; else it is called after the objective.
    pub name: Option<String>,
}

impl SearchPlan {
    /// What every plan says.
    pub const fn head(&self) -> &SearchHead {
        match self {
            Self::Pull(plan) => &plan.head,
            Self::Cycle(plan) => &plan.head,
        }
    }

    /// The same without what may change from a run to its resumption.
    #[must_use]
    pub fn without_budget(&self) -> Self {
        let mut plan = self.clone();
        let head = match &mut plan {
            Self::Pull(plan) => &mut plan.head,
            Self::Cycle(plan) => &mut plan.head,
        };
        head.budget = None;
        plan
    }
}

impl SearchHead {
    /// What a search says that has not been prepared.
    pub fn new(
        program: &Program,
        command: &str,
        engine: String,
        solver: Solver,
        runs: Runs,
    ) -> Self {
        Self {
            program: "prone".to_owned(),
            version: program.version.to_string(),
            commit: program.commit.to_string(),
            engine,
            command: command.to_owned(),
            solver,
            seed: runs.seed,
            runs: runs.runs,
            budget: Some(runs.budget),
            base_sha256: BTreeMap::new(),
        }
    }

    /// Adds a gait that is searched about, with the hash of its text.
    pub fn add_base(&mut self, name: &str, text: &str) {
        let hash = text_file::sha256(&[text]);
        let hashes = self.base_sha256.entry(name.to_owned()).or_default();
        if hashes.is_empty() {
            *hashes = hash;
        } else if !hashes.contains(&hash) {
            hashes.push(' ');
            hashes.push_str(&hash);
        }
    }

    /// A search that has not begun.
    pub fn new_search(&self) -> Search {
        Search::new(self.solver, self.seed, self.runs, self.budget.unwrap_or(0))
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn head(command: &str, solver: &str) -> Value {
        json!({
            "program": "prone", "version": "0.1.0", "commit": "abc", "engine": "MuJoCo 3.17.0",
            "command": command, "solver": solver, "seed": 1, "runs": 2, "budget": 60,
        })
    }

    fn with(mut head: Value, more: Value) -> Value {
        if let (Value::Object(head), Value::Object(more)) = (&mut head, more) {
            head.extend(more);
        }
        head
    }

    fn robot() -> Value {
        json!({ "name": "NAO", "family": "nao", "version": "v4", "folder": "robots", "sha256": "x" })
    }

    /// A search is not resumed after one of two gaits of the same name was edited.
    #[test]
    fn the_texts_of_one_name_are_all_hashed() {
        let hashed = |texts: &[&str]| {
            let mut head: SearchHead = serde_json::from_value(head("optimize", "cma-es")).unwrap();
            for text in texts {
                head.add_base("flat", text);
            }
            head.base_sha256
        };
        assert_ne!(hashed(&["first", "second"]), hashed(&["edited", "second"]));
        assert_ne!(hashed(&["first", "second"]), hashed(&["first", "edited"]));
        assert_eq!(hashed(&["first", "first"]), hashed(&["first"]));
    }

    /// What the release before wrote is read, and written under the same keys.
    #[test]
    fn a_plan_is_read_and_written_under_the_same_keys() {
        let graded = json!({
            "objective": "heat", "weights": null, "per": "metre", "duration_s": 3.0,
            "rate_deg_per_phase": 200.0, "clearance": { "body_mm": 5.0 }, "limits": "base",
            "body_share_of": null, "body_share_percent": null, "regime": "torque-study",
            "start": "settled",
        });
        let pull = with(
            head("optimize", "cma-es"),
            json!({
                "pricing": {
                    "aim": graded, "source": "statics", "from": "nominal", "mapping": "original",
                    "arm": "fixed", "robot": robot(),
                },
                "form": "cubic", "ends": "free", "name": "low", "confirm_durations_s": [1.0],
            }),
        );
        let cycle = with(
            head("optimize", "cma-es, about the middle"),
            json!({
                "source": "cycle", "objective": "heat", "ceiling_mm": null, "steerable": false,
                "least_advance_mm": 120.0, "demanded_shoulder_nm": null,
                "body_share_percent": null, "worst_over": "other", "most_heat": null,
                "from": "low-175", "name": null, "regime": "locomotion", "bases": ["low-175"],
                "robot": robot(),
            }),
        );
        let frontier = with(
            head("crawl frontier", "cma-es, about the middle"),
            json!({
                "ceilings_mm": [165.0], "objective": "advance", "margin_mm": 1.0,
                "steerable": true, "from": ["low-175"], "bases": ["low-175"],
                "regime": "locomotion", "robot": robot(),
            }),
        );
        for written in [pull, cycle, frontier] {
            let plan: SearchPlan = serde_json::from_value(written.clone()).unwrap();
            let again = serde_json::to_value(&plan).unwrap();
            for (key, value) in written.as_object().unwrap() {
                // What the release before called ceilings is one of several quantities.
                let key = if key == "ceilings_mm" { "at" } else { key };
                if key != "robot" && key != "pricing" {
                    assert_eq!(&again[key], value, "{key}");
                }
            }
            let read: SearchPlan = serde_json::from_value(again.clone()).unwrap();
            assert_eq!(read, plan);
            if let SearchPlan::Pull(plan) = &plan {
                assert_eq!(again["pricing"]["aim"], written["pricing"]["aim"]);
                assert_eq!(again["pricing"]["source"], "statics");
                assert!(matches!(plan.pricing.aim, PullAimPlan::Heat(_)));
            }
            assert_eq!(plan.head().budget, Some(60));
            assert_eq!(plan.without_budget().head().budget, None);
        }
    }

    /// A plan that lacks a key is refused by its name.
    #[test]
    fn a_missing_key_is_named() {
        let refused = serde_json::from_value::<SearchPlan>(head("optimize", "genetic"));
        assert!(refused.unwrap_err().to_string().contains("pricing"));
    }
}
