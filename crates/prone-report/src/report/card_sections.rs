//! The report card of each crawl, and other people's crawls beside it.

use maud::{Markup, html};

use super::card::Card;
use super::rivals::RIVALS;

/// Cards of all crawls in one table, joints below; nothing without crawls.
pub(super) fn all(cards: &[Card]) -> Markup {
    html! {
        @if !cards.is_empty() {
            section {
                h2 { "Report card" }
                (figures(cards))
                (joints(cards))
                (rivals())
            }
        }
    }
}

/// One line of the table: what it says, and its value for a card.
struct Line {
    label: &'static str,
    of: fn(&Card) -> String,
}

const LINES: [Line; 15] = [
    Line {
        label: "path, time",
        of: |card| {
            let cycles = card.cycles;
            format!(
                "{:.0} mm, {:.1} s, {cycles} cycles",
                card.path_mm, card.time_s
            )
        },
    },
    Line {
        label: "speed",
        of: |card| format!("{:.1} mm/s", card.speed_mm_s),
    },
    Line {
        label: "speed in standing heights",
        of: |card| {
            optional(card.standing_heights_per_s, |value| {
                format!("{value:.3} /s")
            })
        },
    },
    Line {
        label: "stride efficiency",
        of: |card| {
            let pull = optional(card.pull_efficiency, percent);
            let cycle = optional(card.stride_efficiency, percent);
            format!("pulls {pull}, whole cycles {cycle}")
        },
    },
    Line {
        label: "lowest passage",
        of: |card| format!("{:.0} mm ({})", card.lowest_passage_mm, card.highest_part),
    },
    Line {
        label: "lowest passage over standing height",
        of: |card| optional(card.passage_over_standing, |value| format!("{value:.2}")),
    },
    Line {
        label: "met plates or panels",
        of: |card| match card.plate_contacts {
            0 => "never".to_owned(),
            1 => "once".to_owned(),
            times => format!("{times} times"),
        },
    },
    Line {
        label: "cost of transport, mechanical",
        of: |card| {
            optional(card.cost_of_transport_mechanical, |value| {
                format!("{value:.2}")
            })
        },
    },
    Line {
        label: "cost of transport, electrical (estimated)",
        of: |card| {
            let estimated = card.cost_of_transport_electrical_estimated;
            optional(estimated, |value| format!("at least {value:.1}"))
        },
    },
    Line {
        label: "heat of all motors per second",
        of: |card| format!("{:.2}", card.heat_mean),
    },
    Line {
        label: "heat per metre",
        of: |card| optional(card.heat_per_metre_s, |value| format!("{value:.0} s/m")),
    },
    Line {
        label: "temperature",
        of: |_| "not predicted".to_owned(),
    },
    Line {
        label: "drift",
        of: |card| {
            optional(card.drift_mm_per_m, |value| {
                format!("{} mm/m", signed(value))
            })
        },
    },
    Line {
        label: "change of heading",
        of: |card| optional(card.yaw_deg_per_m, |value| format!("{}°/m", signed(value))),
    },
    Line {
        label: "steering; joints off by",
        of: |card| format!("{}; {}°", card.steering, card.joint_offset_deg),
    },
];

fn figures(cards: &[Card]) -> Markup {
    html! {
        p {
            "Ours, by simulation in the contact regime locomotion (engine's contacts, the \
             manufacturer's effort and joint limits on); every line is a figure of the crawl's record, or one over \
             another. No robot crawled them; the published one made 67 mm a cycle with the original's gait."
        }
        div.scroll { table {
            caption {
                "Path: sum of the cycles' advances, each along its own heading; all rates are over it. \
                 Lowest passage: highest point of any part in the whole run. Stride efficiency: advance \
                 of a pull, and of a whole cycle, over the stride of the planned chain. Cost of transport: positive work of \
                 the motors at the joints over weight times distance; electrical adds what the windings \
                 lose, τ² ω₀ / τ_stall from the manufacturer's motor figures, "
                strong { "an estimate" }
                " and a lower bound: gears and drives lose nothing in it, and braking gives nothing back. Heat: \
                 Σ (τ / nominal torque)² over all motors, τ actuator torque; 1 is one motor at its \
                 continuous rating. No thermal model of the motors is in the robot's data, so no \
                 temperature is given. Drift and heading: positive to the left; a symmetric model \
                 without joint errors hides both."
            }
            thead { tr {
                th scope="col" { "ours, simulated" }
                @for card in cards { th scope="col" { (card.gait) br; small { (card.scene) } br; small.run { (card.run) } } }
            } }
            tbody { @for line in &LINES { tr {
                th scope="row" { (line.label) }
                @for card in cards { td { ((line.of)(card)) } }
            } } }
        } }
    }
}

/// A row per joint that is warm in any crawl, four columns per crawl.
fn joints(cards: &[Card]) -> Markup {
    let mut rows: Vec<(&str, f64)> = Vec::new();
    for joint in cards.iter().flat_map(|card| &card.joints) {
        if !rows.iter().any(|(name, _)| *name == joint.joint) {
            rows.push((&joint.joint, joint.nominal_nm));
        }
    }
    html! {
        div.scroll { table {
            caption {
                strong { "Motors." }
                " Actuator torque after the effort limit, over the motor's continuous torque at the \
                 joint, lossless gears (real ones ask more of the motor): largest, and root mean square, whose square is the heat of \
                 a winding in units of its rating. Heat: share of all motors'. At the limit: share of the \
                 time in which the servo asked for more than the manufacturer's effort limit. Ours, \
                 simulated; the warmest of the first crawl first; – is less than 1 % of the heat."
            }
            thead {
                tr {
                    th scope="col" rowspan="2" { "joint" }
                    th scope="col" rowspan="2" { "nominal" }
                    @for card in cards { th scope="colgroup" colspan="4" { (card.gait) br; small.run { (card.run) } } }
                }
                tr { @for _ in cards { @for head in ["peak", "RMS", "limit", "heat"] { th scope="col" { (head) } } } }
            }
            tbody {
                @for (name, nominal_nm) in &rows { tr {
                    th scope="row" { (name) }
                    td { (format!("{nominal_nm:.2} N·m")) }
                    @for card in cards {
                        @match card.joints.iter().find(|joint| joint.joint == *name) {
                            Some(joint) => {
                                td { (format!("{:.2}", joint.peak_over_nominal)) }
                                td { (format!("{:.2}", joint.rms_over_nominal)) }
                                td { (percent(joint.saturated_share)) }
                                td { (percent(joint.heat_share)) }
                            }
                            None => { @for _ in 0..4 { td { "–" } } }
                        }
                    }
                } }
                tr {
                    th scope="row" { "all others" }
                    td {}
                    @for card in cards {
                        td {} td {} td {}
                        td { (percent(card.other_joints_heat_share)) }
                    }
                }
            }
        } }
    }
}

fn rivals() -> Markup {
    html! {
        div.scroll { table.words {
            caption {
                strong { "Others." }
                " Theirs, as their authors report it; not run, and not measured, by us. Conditions \
                 differ: a speed that is commanded to a policy is not one that was reached. None \
                 reports clearance, cost of transport, torque margin and heat together."
            }
            thead { tr { @for head in [
                "theirs", "robot", "speed", "standing heights per s", "lowest passage / standing height",
                "besides", "source",
            ] { th scope="col" { (head) } } } }
            tbody { @for rival in &RIVALS { tr {
                th scope="row" { (rival.system) }
                @for cell in [
                    rival.robot, rival.speed, rival.standing_heights_per_s, rival.passage, rival.besides,
                    rival.source,
                ] { td { (cell) } }
            } } }
        } }
    }
}

fn optional(value: Option<f64>, show: impl Fn(f64) -> String) -> String {
    value.map_or_else(|| "–".to_owned(), show)
}

fn percent(share: f64) -> String {
    format!("{:.0} %", share * 100.0)
}

/// With its sign, but zero without.
fn signed(value: f64) -> String {
    let text = format!("{value:+.1}");
    match text.as_str() {
        "+0.0" | "-0.0" => "0.0".to_owned(),
        _ => text.replace('-', "−"),
    }
}
