//! The report card of each crawl, and other people's crawls beside it.

use maud::{Markup, html};

use prone::motor::HEAD_CARRIES;

use super::card::Card;
use super::html_table::{optional, percent};
use super::rivals::{HEADS, RIVALS};
use crate::figures::each_once;

/// Cards of all crawls in one table, joints below; nothing without crawls. `crawled` is what is published
/// of a crawl, to be read beside them.
pub(super) fn all(cards: &[Card], crawled: Option<&str>) -> Markup {
    html! {
        @if !cards.is_empty() {
            section {
                h2 { "Report card" }
                (origins(cards, crawled))
                (figures(cards))
                (verdicts(cards))
                (joints(cards))
                (rivals())
            }
        }
    }
}

/// A line of the table: what it says, and its value for a card.
type Line = (&'static str, fn(&Card) -> String);

const LINES: [Line; 21] = [
    ("outcome", |card| {
        card.outcome.clone().unwrap_or_else(|| "–".to_owned())
    }),
    ("path, time", |card| {
        let (path, time, cycles) = (card.path_mm, card.time_s, card.cycles);
        format!("{path:.0} mm, {time:.1} s, {cycles} cycles")
    }),
    ("speed", |card| format!("{:.1} mm/s", card.speed_mm_s)),
    ("speed in standing heights", |card| {
        optional(card.standing_heights_per_s, |value| {
            format!("{value:.3} /s")
        })
    }),
    ("stride efficiency", |card| {
        let pull = optional(card.pull_efficiency, percent);
        let cycle = optional(card.stride_efficiency, percent);
        format!("pulls {pull}, whole cycles {cycle}")
    }),
    ("lowest passage", |card| {
        format!("{:.0} mm ({})", card.lowest_passage_mm, card.highest_part)
    }),
    ("lowest passage over standing height", |card| {
        optional(card.passage_over_standing, |value| format!("{value:.2}"))
    }),
    ("width", |card| {
        optional(card.width_mm, |value| format!("{value:.0} mm"))
    }),
    ("nearest of its own parts", |card| {
        card.nearest_parts.clone().unwrap_or_else(|| "–".to_owned())
    }),
    ("met plates or panels", |card| match card.plate_contacts {
        0 => "never".to_owned(),
        1 => "once".to_owned(),
        times => format!("{times} times"),
    }),
    ("cost of transport, mechanical", |card| {
        let mechanical = card.cost_of_transport_mechanical;
        optional(mechanical, |value| format!("{value:.2}"))
    }),
    ("cost of transport, electrical (estimated)", |card| {
        let estimated = card.cost_of_transport_electrical_estimated;
        optional(estimated, |value| format!("at least {value:.1}"))
    }),
    ("head carries weight", |card| {
        if card.head_peak_n < HEAD_CARRIES {
            "never".to_owned()
        } else {
            let share = percent(card.head_share);
            format!("{share} of the time, up to {:.0} N", card.head_peak_n)
        }
    }),
    ("hands carry up to", |card| {
        format!("{:.0} N", card.hand_peak_n)
    }),
    ("on a robot's motors", |card| {
        card.verdict.clone().unwrap_or_else(|| "unknown".to_owned())
    }),
    ("heat of all motors per second", |card| {
        optional(card.heat_per_second, |value| format!("{value:.2}"))
    }),
    ("heat per metre", |card| {
        optional(card.heat_per_metre_s, |value| format!("{value:.0} s/m"))
    }),
    ("temperature", |_| "not predicted".to_owned()),
    ("drift", |card| {
        optional(card.drift_mm_per_m, |value| {
            format!("{} mm/m", signed(value))
        })
    }),
    ("change of heading", |card| {
        optional(card.yaw_deg_per_m, |value| format!("{}°/m", signed(value)))
    }),
    ("steering; joints off by", |card| {
        format!("{}; {}°", card.steering, card.joint_offset_deg)
    }),
];

/// Whether every crawl was simulated.
fn all_simulated(cards: &[Card]) -> bool {
    cards.iter().all(|card| card.not_simulated.is_none())
}

/// Where the crawls come from, as their records say.
fn origins(cards: &[Card], crawled: Option<&str>) -> Markup {
    let regimes = cards.iter().filter_map(|card| card.regime.as_deref());
    let regimes = each_once(regimes, &[]);
    html! {
        p {
            @if !regimes.is_empty() {
                "Ours, by simulation in the contact regime " (regimes.join(", and in ")) ". "
            }
            @for card in cards {
                @if let Some(from) = &card.not_simulated { (card.run) " was not simulated: " (from) ". " }
            }
            "Every line is a figure of the crawl's record, or one over another."
            @if all_simulated(cards) { " No robot crawled them." }
            @if let Some(crawled) = crawled { " " (crawled) }
        }
    }
}

fn figures(cards: &[Card]) -> Markup {
    let simulated = all_simulated(cards);
    html! {
        div.scroll { table {
            caption {
                "Path: sum of the cycles' advances, each along its own heading; all rates are over it. \
                 Lowest passage: highest point of any part in the whole run. Width: largest \
                 extent to the left and to the right of the robot's own heading together. Nearest of its own \
                 parts: of the measured postures every 20 ms, but those of neighbours. Stride efficiency: advance \
                 of a pull, and of a whole cycle, over the stride of the planned chain. Cost of transport: positive work of \
                 the motors at the joints over weight times distance; electrical adds what the windings \
                 lose, τ² ω₀ / τ_stall from the manufacturer's motor figures, "
                strong { "an estimate" }
                " and a lower bound: gears and drives lose nothing in it, and braking gives nothing back. Heat: \
                 Σ (τ / nominal torque)² over all motors, τ the torque applied; 1 is one motor at its \
                 continuous rating. On a robot's motors: continuous, limited to minutes, or not at \
                 all, by the worst motor, an estimate of the gears' efficiency in it. Head: mean force \
                 over 20 ms. No thermal model of the motors is in the robot's data, so no \
                 temperature is given. Drift and heading: positive to the left"
                @if simulated { "; a symmetric model without joint errors hides both" }
                "."
            }
            thead { tr {
                th scope="col" { @if simulated { "ours, simulated" } @else { "crawl" } }
                @for card in cards { th scope="col" { (card.gait) br; small { (card.scene) } br; small.run { (card.run) } } }
            } }
            tbody { @for (label, value) in &LINES { tr {
                th scope="row" { (label) }
                @for card in cards { td { (value(card)) } }
            } } }
        } }
    }
}

/// What speaks against going on for ever, crawl by crawl; nothing where nothing does.
fn verdicts(cards: &[Card]) -> Markup {
    let spoken = |card: &&Card| !card.verdict_reasons.is_empty();
    html! {
        @if cards.iter().any(|card| spoken(&card)) {
            p { "What a robot's motors could not go on with, or what is not known of them:" }
            ul { @for card in cards.iter().filter(spoken) {
                li {
                    (card.gait) " " small.run { "(" (card.run) ")" } ": "
                    (card.verdict_reasons.join("; ")) "."
                }
            } }
        }
    }
}

/// A row per motor that is warm in any crawl, five columns per crawl.
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
                " Torque applied. Peak: the largest over the motor's continuous torque at the joint, \
                 before gear losses. RMS: root mean square over what the gear passes on of that torque, \
                 an estimate; 1 can go on for ever. Heat: share of all motors'. Voltage and limit: share \
                 of the time outside rests in which the supply's voltage, or the current limit, cuts \
                 what the controller asks for. "
                @if all_simulated(cards) { "Ours, simulated; the" } @else { "The" }
                " warmest of the first crawl first; – is less than 1 % of the heat."
            }
            thead {
                tr {
                    th scope="col" rowspan="2" { "joint" }
                    th scope="col" rowspan="2" { "nominal" }
                    @for card in cards { th scope="colgroup" colspan="5" { (card.gait) br; small.run { (card.run) } } }
                }
                tr { @for _ in cards { @for head in ["peak", "RMS", "voltage", "limit", "heat"] { th scope="col" { (head) } } } }
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
                                td { (optional(joint.voltage_clipped_share, percent)) }
                                td { (percent(joint.saturated_share)) }
                                td { (percent(joint.heat_share)) }
                            }
                            None => { @for _ in 0..5 { td { "–" } } }
                        }
                    }
                } }
                tr {
                    th scope="row" { "all others" }
                    td {}
                    @for card in cards {
                        td {} td {} td {} td {}
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
            thead { tr { @for head in HEADS { th scope="col" { (head) } } } }
            tbody { @for [system, others @ ..] in &RIVALS { tr {
                th scope="row" { (system) }
                @for cell in others { td { (cell) } }
            } } }
        } }
    }
}

/// With its sign, but zero without.
fn signed(value: f64) -> String {
    let text = format!("{value:+.1}");
    match text.as_str() {
        "+0.0" | "-0.0" => "0.0".to_owned(),
        _ => text.replace('-', "−"),
    }
}
