//! What was typed about the cost of pulls.

use std::path::Path;

use anyhow::anyhow;

use prone::cost::published::PublishedRules;
use prone::gait::{Gait, PhaseDuration};
use prone_files::robot_folder::RobotFiles;
use prone_record::experiment::{
    BodyShareOf, ClearanceChoice, GaitText, LimitsChoice, PullCostChoice, PullObjective, PullRules,
    Share, TextFile, TorqueChoice,
};

use crate::args::pull_terms::{LimitsName, ObjectiveName, PerName, PullTermsArgs};
use crate::gait::find;
use crate::{Failure, refusal};

/// Duration of a pull where none is asked for, s.
const DURATION_S: f64 = 3.0;

/// Fastest command where none is asked for, degrees per pull: what a search may ask of a joint is
/// what the published optimum asks of the hip (206°), rounded down.
const RATE_DEG_PER_PHASE: f64 = 200.0;

/// What was typed, with the texts of the gaits and the map that it names; `costed` is the gait whose
/// cost is asked for, where there is one.
pub(crate) fn choice(
    args: &PullTermsArgs,
    files: &RobotFiles,
    costed: Option<&(Gait, GaitText)>,
) -> Result<PullCostChoice, Failure> {
    let objective = objective(args)?;
    let source = source(args, files)?;
    let base = if let Some(name) = &args.from {
        find(&files.gaits, name)?
    } else {
        let defaults = files.defaults().map_err(Failure::input)?.pull;
        let usual = find(&files.gaits, &defaults.from)?;
        let kind = |(gait, _): &(Gait, GaitText)| (gait.mapping, gait.arm);
        let other = costed.filter(|costed| kind(costed) != kind(&usual));
        other.cloned().unwrap_or(usual)
    };
    let clearance = args.clearance.unwrap_or(match source {
        // There the share of the weight on the body says what is low.
        TorqueChoice::Dynamics { .. } => ClearanceChoice::None,
        TorqueChoice::Statics | TorqueChoice::Map(_) => ClearanceChoice::Base,
    });
    let rate = args.rate_deg_per_phase.unwrap_or(RATE_DEG_PER_PHASE);
    let rules = PullRules {
        per: match args.per {
            None | Some(PerName::Phase) => Share::Phase,
            Some(PerName::Metre) => Share::Metre,
        },
        duration_s: args.duration.map_or(DURATION_S, PhaseDuration::seconds),
        rate_deg_per_phase: Some(rate).filter(|rate| rate.is_finite()),
        clearance,
        limits: match args.limits {
            Some(LimitsName::None) => LimitsChoice::None,
            None | Some(LimitsName::Base) => LimitsChoice::Base,
        },
    };
    Ok(PullCostChoice {
        objective: objective(rules),
        source,
        base: base.1,
    })
}

/// The objective, once its rules are known; options of the other kind are refused, not ignored.
fn objective(
    args: &PullTermsArgs,
) -> Result<impl FnOnce(PullRules) -> PullObjective + use<>, Failure> {
    let name = args.objective;
    let of_cycles = [
        (ObjectiveName::Advance, "advance"),
        (ObjectiveName::Speed, "speed"),
        (ObjectiveName::Duty, "duty"),
        (ObjectiveName::Height, "height"),
    ];
    if let Some((_, word)) = of_cycles.iter().find(|(other, _)| *other == name) {
        return Err(Failure::Input(anyhow!(
            "--objective {word} is one of whole cycles: it goes with --source cycle only"
        )));
    }
    if name == ObjectiveName::Published {
        Failure::if_given(
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
    } else {
        Failure::if_given(
            &[
                ("--hip-threshold-mm", args.hip_threshold_mm.is_some()),
                ("--limit-tolerance-rad", args.limit_tolerance_rad.is_some()),
            ],
            "goes with --objective published only",
        )?;
    }
    if matches!(name, ObjectiveName::Peak | ObjectiveName::Heat) {
        Failure::if_given(
            &[("--weights", args.weights.is_some())],
            "goes with --objective torque only",
        )?;
    }
    if name == ObjectiveName::Peak {
        Failure::if_given(
            &[("--per", args.per == Some(PerName::Metre))],
            "metre does not go with --objective peak: a peak does not add up",
        )?;
    }
    let weights = match args.weights.as_deref() {
        None => [1.0; 4],
        Some(&[ankle, knee, hip, shoulder]) => [ankle, knee, hip, shoulder],
        Some(weights) => return Err(Failure::Input(anyhow!(refusal::of_weights(weights)))),
    };
    let published = PublishedRules::PUBLISHED;
    let threshold = args
        .hip_threshold_mm
        .unwrap_or(published.hip_threshold * 1e3);
    let tolerance = args
        .limit_tolerance_rad
        .unwrap_or(published.limit_tolerance);
    Ok(move |rules| match name {
        ObjectiveName::Published => PullObjective::Published {
            hip_threshold_mm: threshold,
            limit_tolerance_rad: tolerance,
        },
        ObjectiveName::Peak => PullObjective::Peak { rules },
        ObjectiveName::Heat => PullObjective::Heat { rules },
        _ => PullObjective::Torque { weights, rules },
    })
}

/// Where torques come from, with the text of a map.
fn source(args: &PullTermsArgs, files: &RobotFiles) -> Result<TorqueChoice, Failure> {
    let given = args.source.as_deref().unwrap_or("dynamics");
    if given == "dynamics" {
        let body_share_of = if let Some(name) = &args.body_share_of {
            BodyShareOf::Gait(find(&files.gaits, name)?.1)
        } else {
            let defaults = files.defaults().map_err(Failure::input)?.pull;
            BodyShareOf::Usual(find(&files.gaits, &defaults.body_share_of)?.1)
        };
        return Ok(TorqueChoice::Dynamics { body_share_of });
    }
    let path = Path::new(given);
    let source = match given {
        "statics" => TorqueChoice::Statics,
        _ if !path.exists() => {
            return Err(Failure::Input(anyhow!(
                "--source {given} is neither statics, dynamics nor a file"
            )));
        }
        _ => TorqueChoice::Map(TextFile::new(given, &crate::torque_map::text(path)?)),
    };
    if args.body_share_of.is_some() {
        return Err(Failure::Input(anyhow!(
            "--body-share-of goes with --source dynamics only: nothing else knows what carries the weight"
        )));
    }
    Ok(source)
}
