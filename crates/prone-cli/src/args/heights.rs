//! Heights and ceilings, as they are typed.

use prone::scene::{LOWEST_CEILING, taken_for_metres};

use super::within;

/// A ceiling as typed, mm; one that is lower than any robot was typed in metres.
pub(crate) fn ceiling(text: &str) -> Result<f64, String> {
    let typed: Option<f64> = text.trim().parse().ok();
    let meant = |mm: f64| Some((mm, taken_for_metres(mm / 1e3)? * 1e3));
    if let Some((mm, meant)) = typed.and_then(meant) {
        // Without the digits that a conversion makes up.
        let meant = (meant * 1e9).round() / 1e9;
        return Err(format!("{mm} mm: did you mean {meant}?"));
    }
    within(text, " mm", (LOWEST_CEILING * 1e3, 10_000.0))
}

/// A height as typed, mm: above nothing, below any room.
pub(crate) fn height(text: &str) -> Result<f64, String> {
    within(text, " mm", (1.0, 10_000.0))
}
