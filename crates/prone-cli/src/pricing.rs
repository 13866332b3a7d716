//! What was typed about the cost of a pull, checked and loaded.

use std::path::Path;
use std::sync::Arc;

use anyhow::anyhow;

use prone::cost::objective::Objective;
use prone::cost::published::PublishedRules;
use prone::gait::{Gait, PhaseDuration};
use prone::regime::Regime;
use prone::torque_map;
use prone_files::defaults::PullDefaults;
use prone_files::gaits::Gaits;
use prone_files::text_file;
use prone_sim::{LoadedRobot, World};
use prone_study::search::chain_rules::{self, ChainRules, Clearance};
use prone_study::search::pull_cost::{self, PullAim, PullTerms, Share, Source};

use crate::Failure;
use crate::args::pricing::{ClearanceName, LimitsName, ObjectiveName, PerName, PricingArgs};

/// Duration of a pull where none is asked for, s.
const DURATION_S: f64 = 3.0;

/// Fastest command where none is asked for, degrees per pull: what a search may ask of a joint is
/// what the published optimum asks of the hip (206°), rounded down.
const RATE_DEG_PER_PHASE: f64 = 200.0;

/// Largest weight: squares of torques times it are far from overflowing.
const HEAVIEST: f64 = 1e6;

/// Everything that decides a cost, loaded.
pub(crate) struct Pricing {
    pub(crate) robot: LoadedRobot,
    pub(crate) world: World,
    pub(crate) terms: PullTerms,
}

impl Pricing {
    /// Checks what was typed, and loads the rest; `priced` is the gait whose cost is asked for, where
    /// there is one.
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
        let (body_share, body_share_of) = match (aim, &source) {
            (PullAim::Graded(_), Source::Dynamics) => {
                let gait = body_share_of(args, &robot, &defaults, &base)?;
                let share = pull_cost::body_share(&world, &gait, duration);
                (share.map_err(Failure::input)?, Some(gait.name))
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
                    pull_cost::check_advance(world.robot(), gait).map_err(Failure::input)?;
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
                    let stops = chain_rules::widened_stops(world.robot(), &base);
                    Some(stops.map_err(Failure::input)?)
                }
            },
        };
        let terms = PullTerms {
            aim,
            source,
            base,
            share,
            rules,
            duration,
            body_share,
            body_share_of,
        };
        Ok(Self {
            robot,
            world,
            terms,
        })
    }
}

/// The objective; options of the other kind are refused, not ignored.
fn aim(args: &PricingArgs) -> Result<PullAim, Failure> {
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
        return Ok(PullAim::Published(PublishedRules {
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
    Ok(PullAim::Graded(match args.objective {
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

fn source(given: &str) -> Result<Source, Failure> {
    match given {
        "cycle" => {
            return Err(Failure::Input(anyhow!(
                "--source cycle is for prone optimize: prone crawl run prices a cycle"
            )));
        }
        "statics" => return Ok(Source::Statics),
        "dynamics" => return Ok(Source::Dynamics),
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
    Ok(Source::Map {
        map: Arc::new(map),
        file: given.to_owned(),
        sha256: text_file::sha256(&[&text]),
    })
}

fn clearance(
    args: &PricingArgs,
    source: &Source,
    world: &World,
    base: &Gait,
) -> Result<Clearance, Failure> {
    let default = match source {
        // There the share of the weight on the body says what is low.
        Source::Dynamics => ClearanceName::None,
        _ => ClearanceName::Base,
    };
    Ok(match args.clearance.unwrap_or(default) {
        ClearanceName::None => Clearance::Free,
        ClearanceName::Hip(height) => Clearance::Hip(height),
        ClearanceName::Body(height) => Clearance::Body(height),
        ClearanceName::Base => pull_cost::lowest_hip(world, base).map_err(Failure::input)?,
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
