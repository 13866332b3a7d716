//! The rules of a search of cycles: the usual ones, those that were asked for, what is held.

use prone::gait::cycle::{Cycle, TimeScale};
use prone::motor::Duty;
use prone::robot::Robot;
use prone_record::experiment::{CycleRulesChoice, LeastVerdict, NamedGait};
use prone_record::frontier::{CycleObjective, Quantity};

use super::super::cycle_rules::CycleRules;
use super::CycleSearchError;

/// Checks rules that were asked for: each is one, and counts.
pub fn check_rules(
    objective: CycleObjective,
    rules: &CycleRulesChoice,
    worst_over: Option<&NamedGait>,
) -> Result<(), CycleSearchError> {
    rules.check()?;
    let several = matches!(objective, CycleObjective::Heat | CycleObjective::Peak);
    let heats = [
        ("worst_over", worst_over.is_some()),
        ("most_heat", rules.most_heat.is_some()),
    ];
    let unused = heats.iter().find(|(_, asked)| *asked && !several);
    if let Some((what, _)) = unused {
        return Err(CycleSearchError::HeatUnused { what });
    }
    let unread = objective == CycleObjective::Peak && rules.most_heat.is_none();
    if worst_over.is_some() && unread {
        return Err(CycleSearchError::WorstOverUnused);
    }
    Ok(())
}

/// The usual rules of a search below a height, m: for all but advance and speed the robot's least
/// advance; for advance, speed and duty a cycle no longer than the one that it is searched about, as
/// whoever takes more time advances farther, and with less torque.
pub fn usual_rules(
    objective: CycleObjective,
    height: f64,
    base: &Cycle,
    robot: &Robot,
) -> CycleRules {
    let free = CycleRules {
        ceiling: height,
        ..CycleRules::FREE
    };
    match objective {
        CycleObjective::Heat
        | CycleObjective::HeatRate
        | CycleObjective::Peak
        | CycleObjective::Height => CycleRules {
            advance: robot.search.least_advance,
            ..free
        },
        CycleObjective::Duty => CycleRules {
            advance: robot.search.least_advance,
            seconds: base.duration(TimeScale::ONE),
            ..free
        },
        CycleObjective::Advance | CycleObjective::Speed => CycleRules {
            seconds: base.duration(TimeScale::ONE),
            ..free
        },
    }
}

/// The rules that were asked for, and the usual ones where none was.
pub fn asked_rules(asked: &CycleRulesChoice, usual: CycleRules) -> CycleRules {
    let millimetres = asked.least_advance_mm.map(|mm| mm * 1e-3);
    let share = asked.body_share_percent.map(|percent| percent / 100.0);
    let demanded = asked.demanded_shoulder_nm;
    CycleRules {
        advance: millimetres.unwrap_or(usual.advance),
        demanded_shoulder: demanded.unwrap_or(usual.demanded_shoulder),
        body_share: share.unwrap_or(usual.body_share),
        heat: asked.most_heat.unwrap_or(usual.heat),
        drift: asked.most_drift_mm.map_or(usual.drift, |mm| mm * 1e-3),
        head: asked.most_head_n.unwrap_or(usual.head),
        verdict: match asked.verdict {
            None => usual.verdict,
            Some(LeastVerdict::Continuous) => Duty::Continuous,
            Some(LeastVerdict::Limited) => Duty::Limited,
        },
        least_speed: asked
            .least_speed_mm_s
            .map_or(usual.least_speed, |it| it * 1e-3),
        most_duty: asked.most_duty.unwrap_or(usual.most_duty),
        ..usual
    }
}

/// Rules with a quantity held at a value, in its unit; a ceiling is the height of the rules already.
/// Where the speed is held, a cycle may be as short as it likes.
pub(super) fn held_rules(held: Quantity, at: Option<f64>, rules: CycleRules) -> CycleRules {
    let Some(at) = at else {
        return rules;
    };
    match held {
        Quantity::Ceiling => rules,
        Quantity::Advance => CycleRules {
            advance: at * 1e-3,
            ..rules
        },
        Quantity::Speed => CycleRules {
            least_speed: at * 1e-3,
            advance: CycleRules::FREE.advance,
            ..rules
        },
        Quantity::Heat => CycleRules { heat: at, ..rules },
        Quantity::Duty => CycleRules {
            most_duty: at,
            ..rules
        },
    }
}
