//! Picks records: the runs of a gait by duration, the durations a figure has room for.

use prone_record::pulls::PullRecord;

use super::GaitNumbers;

/// Durations closer than this are the same, s.
const SAME_DURATION_S: f64 = 1e-9;

/// Whether two durations are the same.
pub(super) fn same_duration(a: f64, b: f64) -> bool {
    (a - b).abs() < SAME_DURATION_S
}

/// The pulls of `gait` that have rows, by rising duration, the first of each duration.
pub(super) fn runs_of<'a>(pulls: &'a [PullRecord], gait: &str) -> Vec<&'a PullRecord> {
    let own = |pull: &&PullRecord| pull.gait == gait && !pull.rows.is_empty();
    let mut runs: Vec<&PullRecord> = pulls.iter().filter(own).collect();
    runs.sort_by(|a, b| a.duration_s.total_cmp(&b.duration_s));
    runs.dedup_by(|a, b| same_duration(a.duration_s, b.duration_s));
    runs
}

/// The items whose durations come nearest to the `wanted` ones, each once, in their own order.
pub(super) fn nearest<T: Copy>(
    items: &[T],
    duration_s: impl Fn(&T) -> f64,
    wanted: &[f64],
) -> Vec<T> {
    let mut left: Vec<(usize, T)> = items.iter().copied().enumerate().collect();
    let mut chosen = Vec::new();
    for target in wanted {
        let distance = |item: &(usize, T)| (duration_s(&item.1) - target).abs();
        let best =
            (0..left.len()).min_by(|a, b| distance(&left[*a]).total_cmp(&distance(&left[*b])));
        chosen.extend(best.map(|index| left.remove(index)));
    }
    chosen.sort_by_key(|item| item.0);
    chosen.into_iter().map(|item| item.1).collect()
}

/// Names of a publication's gaits.
pub(super) fn names(gaits: &[GaitNumbers]) -> Vec<&'static str> {
    gaits.iter().map(|numbers| numbers.gait).collect()
}

/// The names in order of appearance, `first` ones foremost, each once.
pub(crate) fn each_once<'a>(
    names: impl Iterator<Item = &'a str>,
    first: &[&'a str],
) -> Vec<&'a str> {
    let mut found: Vec<&str> = Vec::new();
    for name in names {
        if !found.contains(&name) {
            found.push(name);
        }
    }
    let place = |name: &&str| first.iter().position(|known| known == name);
    // Stable: the others keep their order.
    found.sort_by_key(|name| place(name).unwrap_or(first.len()));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(available: &[f64], wanted: &[f64]) -> Vec<f64> {
        nearest(available, |duration| *duration, wanted)
    }

    #[test]
    fn nearest_takes_what_there_is() {
        let all: Vec<f64> = (1..=10).map(f64::from).collect();
        assert_eq!(chosen(&all, &[1.0, 5.0, 10.0]), [1.0, 5.0, 10.0]);
        assert_eq!(chosen(&[1.0, 2.0, 5.0], &[1.0, 5.0, 10.0]), [1.0, 2.0, 5.0]);
        assert_eq!(chosen(&[5.0], &[1.0, 5.0, 10.0]), [5.0]);
        assert!(chosen(&[], &[1.0]).is_empty());
    }

    #[test]
    fn known_gaits_come_first() {
        let names = ["ours", "optimal", "nominal", "ours"];
        assert_eq!(
            each_once(names.into_iter(), &["nominal", "optimal"]),
            ["nominal", "optimal", "ours"]
        );
    }
}
