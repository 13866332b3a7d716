//! What was typed about a price, checked and loaded.

use std::path::Path;

use anyhow::anyhow;
use serde_json::{Value, json};

use prone::cost::objective::Objective;
use prone::cost::published::PublishedRules;
use prone::gait::{Gait, PhaseDuration};
use prone::regime::Regime;
use prone::torque_map::{self, TorqueMap};
use prone_files::defaults::PullDefaults;
use prone_files::gaits::Gaits;
use prone_files::text_file;
use prone_sim::{LoadedRobot, World};
use prone_study::optimize::pricer::{self, Aim, Source, Terms};
use prone_study::optimize::pricing::{self, Share};
use prone_study::optimize::rules::{self, ChainRules, Clearance};

use crate::Failure;
use crate::args::pricing::{ClearanceName, LimitsName, ObjectiveName, PerName, PricingArgs};

/// Duration of a pull where none is asked for, s.
const DURATION_S: f64 = 3.0;

/// Fastest command where none is asked for, degrees per pull: what a search may ask of a joint is
/// what the published optimum asks of the hip (206°), rounded down.
const RATE_DEG_PER_PHASE: f64 = 200.0;

/// Largest weight: squares of torques times it are far from overflowing.
const HEAVIEST: f64 = 1e6;

/// Everything that decides a price, loaded.
pub(crate) struct Pricing {
    pub(crate) robot: LoadedRobot,
    pub(crate) world: World,
    pub(crate) aim: Aim,
    pub(crate) base: Gait,
    pub(crate) duration: PhaseDuration,
    source: LoadedSource,
    share: Share,
    rules: ChainRules,
    body_share: f64,
    /// For `run.json` and checkpoints.
    pub(crate) record: Value,
}

enum LoadedSource {
    Map { map: Box<TorqueMap>, hash: String },
    Statics,
    Dynamics,
}

impl Pricing {
    /// Checks what was typed, and loads the rest; `priced` is the gait to price, where there is one.
    pub(crate) fn new(
        args: &PricingArgs,
        robot: LoadedRobot,
        priced: Option<&Gait>,
    ) -> Result<Self, Failure> {
        let aim = aim(args)?;
        let source = source(&args.source)?;
        let files = robot.files();
        let defaults = files.defaults().map_err(Failure::input)?.pull;
        let base = base(args, &files.gaits, &defaults, priced)?;
        let world = World::new(&robot, Regime::TORQUE_STUDY).map_err(Failure::input)?;
        let duration = match args.duration {
            Some(duration) => duration,
            None => PhaseDuration::new(DURATION_S).map_err(Failure::input)?,
        };
        let clearance = clearance(args, &source, &world, &base)?;
        let (body_share, share_of) = match (aim, &source) {
            (Aim::Graded(_), LoadedSource::Dynamics) => {
                let gait = body_share_of(args, &robot, &defaults, &base)?;
                let share = pricer::body_share(&world, &gait, duration).map_err(Failure::input)?;
                (share, Some(gait.name))
            }
            _ if args.body_share_of.is_some() => {
                return Err(Failure::Input(anyhow!(
                    "--body-share-of goes with --source dynamics only: nothing else knows what carries the weight"
                )));
            }
            _ => (1.0, None),
        };
        let share = match args.per {
            None | Some(PerName::Phase) => Share::Phase,
            Some(PerName::Metre) => {
                for gait in priced.into_iter().chain([&base]) {
                    pricing::check_advance(world.robot(), gait).map_err(Failure::input)?;
                }
                Share::Metre
            }
        };
        let rules = ChainRules {
            rate: args
                .rate_deg_per_phase
                .unwrap_or(RATE_DEG_PER_PHASE.to_radians()),
            clearance,
            stops: match args.limits {
                Some(LimitsName::None) => None,
                None | Some(LimitsName::Base) => {
                    let stops = rules::widened_stops(world.robot(), &base);
                    Some(stops.map_err(Failure::input)?)
                }
            },
        };
        let mut pricing = Self {
            robot,
            world,
            aim,
            base,
            duration,
            source,
            share,
            rules,
            body_share,
            record: Value::Null,
        };
        pricing.record = pricing.record(args, share_of.as_deref());
        Ok(pricing)
    }

    /// The terms of the price.
    pub(crate) fn terms(&self) -> Terms<'_> {
        Terms {
            aim: self.aim,
            source: match &self.source {
                LoadedSource::Map { map, .. } => Source::Map(map),
                LoadedSource::Statics => Source::Statics,
                LoadedSource::Dynamics => Source::Dynamics,
            },
            base: &self.base,
            share: self.share,
            rules: self.rules.clone(),
            duration: self.duration,
            body_share: self.body_share,
        }
    }

    /// The source in a word: of a file its name, wherever it is.
    pub(crate) fn source_name(given: &str) -> &str {
        let file = Path::new(given).file_name().and_then(|name| name.to_str());
        file.unwrap_or(given)
    }

    /// Whether gaits are simulated one by one.
    pub(crate) fn is_dynamic(&self) -> bool {
        matches!(self.source, LoadedSource::Dynamics)
    }

    /// The torque objective, the published one's weights included.
    pub(crate) fn objective(&self) -> Objective {
        match self.aim {
            Aim::Graded(objective) => objective,
            Aim::Published(_) => Objective::Torque {
                weights: prone::cost::published::WEIGHTS,
            },
        }
    }

    fn record(&self, args: &PricingArgs, share_of: Option<&str>) -> Value {
        let source = match &self.source {
            LoadedSource::Map { hash, .. } => json!({ "file": args.source, "sha256": hash }),
            LoadedSource::Statics => json!("statics"),
            LoadedSource::Dynamics => json!("dynamics"),
        };
        let aim = match self.aim {
            Aim::Published(rules) => json!({
                "objective": "published",
                "hip_threshold_mm": rules.hip_threshold * 1e3,
                "limit_tolerance_rad": rules.limit_tolerance,
            }),
            Aim::Graded(objective) => json!({
                "objective": objective.name(),
                "weights": match objective {
                    Objective::Torque { weights } => Some(weights),
                    _ => None,
                },
                "per": self.share.name(),
                "duration_s": self.duration.seconds(),
                "rate_deg_per_phase": Some(self.rules.rate.to_degrees()).filter(|r| r.is_finite()),
                "clearance": match self.rules.clearance {
                    Clearance::Free => json!("none"),
                    Clearance::Hip(height) => json!({ "hip_mm": height * 1e3 }),
                    Clearance::Body(height) => json!({ "body_mm": height * 1e3 }),
                },
                "limits": if self.rules.stops.is_some() { "base" } else { "none" },
                "body_share_of": share_of,
                "body_share_percent": share_of.map(|_| self.body_share * 100.0),
                "regime": self.world.regime().name,
                "start": "the gait's own first pose, settled",
            }),
        };
        json!({
            "aim": aim,
            "source": source,
            "from": self.base.name,
            "mapping": self.base.mapping.name(),
            "arm": self.base.arm.name(),
            "robot": crate::robot::said(&self.robot),
        })
    }
}

/// The objective; options of the other kind are refused, not ignored.
fn aim(args: &PricingArgs) -> Result<Aim, Failure> {
    if matches!(
        args.objective,
        ObjectiveName::Advance | ObjectiveName::Speed
    ) {
        return Err(Failure::Input(anyhow!(
            "--objective advance and speed are those of whole cycles: they go with --source cycle only"
        )));
    }
    let refuse = |given: &[(&str, bool)], reason: &str| {
        let option = given.iter().find(|(_, given)| *given);
        option.map_or(Ok(()), |(option, _)| {
            Err(Failure::Input(anyhow!("{option} {reason}")))
        })
    };
    if args.objective == ObjectiveName::Published {
        refuse(
            &[
                ("--weights", args.weights.is_some()),
                ("--per", args.per.is_some()),
                ("--duration", args.duration.is_some()),
                ("--rate-deg-per-phase", args.rate_deg_per_phase.is_some()),
                ("--clearance", args.clearance.is_some()),
                ("--limits", args.limits.is_some()),
                ("--body-share-of", args.body_share_of.is_some()),
            ],
            "does not go with --objective published, which has rules of its own",
        )?;
        let published = PublishedRules::PUBLISHED;
        return Ok(Aim::Published(PublishedRules {
            hip_threshold: args
                .hip_threshold_mm
                .map_or(published.hip_threshold, |mm| mm / 1e3),
            limit_tolerance: args
                .limit_tolerance_rad
                .unwrap_or(published.limit_tolerance),
        }));
    }
    refuse(
        &[
            ("--hip-threshold-mm", args.hip_threshold_mm.is_some()),
            ("--limit-tolerance-rad", args.limit_tolerance_rad.is_some()),
        ],
        "goes with --objective published only",
    )?;
    let weights = match args.weights.as_deref() {
        None => [1.0; 4],
        Some(&[a, k, h, s])
            if [a, k, h, s].iter().all(|w| (0.0..=HEAVIEST).contains(w))
                && [a, k, h, s].iter().any(|w| *w > 0.0) =>
        {
            [a, k, h, s]
        }
        Some(weights) => {
            return Err(Failure::Input(anyhow!(
                "--weights takes four numbers from 0 to {HEAVIEST}, not all 0 (ankle, knee, hip, shoulder), not {weights:?}"
            )));
        }
    };
    Ok(Aim::Graded(match args.objective {
        ObjectiveName::Torque | ObjectiveName::Published => Objective::Torque { weights },
        other => {
            refuse(
                &[("--weights", args.weights.is_some())],
                "goes with --objective torque only",
            )?;
            if other == ObjectiveName::Peak {
                refuse(
                    &[("--per", args.per == Some(PerName::Metre))],
                    "metre does not go with --objective peak: a peak does not add up",
                )?;
                Objective::Peak
            } else {
                Objective::Heat
            }
        }
    }))
}

/// The gait of --from, or a default of the kind of the gait to price.
fn base(
    args: &PricingArgs,
    gaits: &Gaits,
    defaults: &PullDefaults,
    priced: Option<&Gait>,
) -> Result<Gait, Failure> {
    if let Some(name) = &args.from {
        return crate::gait::find(gaits, name);
    }
    let usual = crate::gait::find(gaits, &defaults.from)?;
    let kind = |gait: &Gait| (gait.mapping, gait.arm);
    let other = priced.filter(|gait| kind(gait) != kind(&usual));
    Ok(other.cloned().unwrap_or(usual))
}

fn source(given: &str) -> Result<LoadedSource, Failure> {
    match given {
        "cycle" => {
            return Err(Failure::Input(anyhow!(
                "--source cycle is for prone optimize: prone crawl run prices a cycle"
            )));
        }
        "statics" => return Ok(LoadedSource::Statics),
        "dynamics" => return Ok(LoadedSource::Dynamics),
        _ => {}
    }
    let path = Path::new(given);
    if !path.exists() {
        return Err(Failure::Input(anyhow!(
            "--source {given} is neither statics, dynamics nor a file"
        )));
    }
    let text = crate::torque_map::text(path)?;
    let map =
        torque_map::parse(&text).map_err(|error| Failure::Input(anyhow!("{given}: {error}")))?;
    Ok(LoadedSource::Map {
        map: Box::new(map),
        hash: text_file::sha256(&[&text]),
    })
}

fn clearance(
    args: &PricingArgs,
    source: &LoadedSource,
    world: &World,
    base: &Gait,
) -> Result<Clearance, Failure> {
    let default = match source {
        // There the share of the weight on the body says what is low.
        LoadedSource::Dynamics => ClearanceName::None,
        _ => ClearanceName::Base,
    };
    Ok(match args.clearance.unwrap_or(default) {
        ClearanceName::None => Clearance::Free,
        ClearanceName::Hip(height) => Clearance::Hip(height),
        ClearanceName::Body(height) => Clearance::Body(height),
        ClearanceName::Base => pricer::lowest_hip(world, base).map_err(Failure::input)?,
    })
}

/// The gait whose share of the weight on trunk and legs is the limit.
fn body_share_of(
    args: &PricingArgs,
    robot: &LoadedRobot,
    defaults: &PullDefaults,
    base: &Gait,
) -> Result<Gait, Failure> {
    let gaits = &robot.files().gaits;
    if let Some(name) = &args.body_share_of {
        return crate::gait::find(gaits, name);
    }
    let usual = crate::gait::find(gaits, &defaults.body_share_of)?;
    let followed = crate::gait::can_follow(robot.robot(), &usual);
    Ok(if followed { usual } else { base.clone() })
}
