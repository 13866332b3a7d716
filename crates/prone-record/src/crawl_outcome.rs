//! What a crawl says of itself in one sentence, and how near the robot's parts came to one another.

use serde::{Deserialize, Serialize};

/// A part of the robot that met an obstacle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlateContact {
    /// The part, by its name in the model.
    pub body: String,
    /// Kind and number of the obstacle.
    pub obstacle: String,
    /// How often they met.
    pub count: usize,
    /// When first, s since the first pull began.
    pub first_s: f64,
    /// How long in all, s.
    pub seconds: f64,
    /// Largest normal force, N.
    pub peak_n: f64,
}

/// Whether a crawl came through, and what it touched.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OutcomeSummary {
    /// Whether it got past the obstacles, where that was asked for.
    pub passed: Option<bool>,
    /// Whether a part of the robot met a plate, its legs or a panel.
    pub touched: bool,
    /// Largest normal force of such a meeting, N; nothing without one.
    pub largest_contact_n: Option<f64>,
    /// The same in words, without an end.
    pub sentence: String,
}

/// The two parts of the robot that came nearest to one another.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SelfCollisionSummary {
    /// Names of their shapes.
    pub shapes: [String; 2],
    /// Between their surfaces, mm; negative where they were in one another.
    pub distance_mm: f64,
    /// When, s since the first pull began.
    pub time_s: f64,
}

impl OutcomeSummary {
    /// Of a crawl of so many cycles, mm each. `passed` says whether it got past the obstacles, where
    /// that was asked for.
    pub fn new(
        passed: Option<bool>,
        cycles: usize,
        mm_per_cycle: f64,
        contacts: &[PlateContact],
    ) -> Self {
        let hardest = contacts
            .iter()
            .max_by(|one, other| one.peak_n.total_cmp(&other.peak_n));
        let counted = match cycles {
            1 => "1 cycle".to_owned(),
            _ => format!("{cycles} cycles"),
        };
        let sentence = match (passed, hardest.map(hit)) {
            (Some(true), None) => "past the obstacles, without touching one".to_owned(),
            (Some(true), Some(hit)) => format!("past the obstacles, but {hit}"),
            (Some(false), None) => {
                format!("not past the obstacles after {counted}, without touching one")
            }
            (Some(false), Some(hit)) => format!("not past the obstacles after {counted}, {hit}"),
            (None, None) => format!("{counted}, {mm_per_cycle:.0} mm each, nothing touched"),
            (None, Some(hit)) => format!("{counted}, {mm_per_cycle:.0} mm each, {hit}"),
        };
        Self {
            passed,
            touched: hardest.is_some(),
            largest_contact_n: hardest.map(|contact| contact.peak_n),
            sentence,
        }
    }
}

impl SelfCollisionSummary {
    /// Whether the two were in one another.
    pub fn is_collision(&self) -> bool {
        self.distance_mm < 0.0
    }

    /// How deep and when, without an end.
    pub fn in_words(&self) -> String {
        let Self {
            shapes: [one, other],
            distance_mm,
            time_s,
        } = self;
        if self.is_collision() {
            format!(
                "{one} and {other} {:.1} mm in one another at {time_s:.2} s",
                -distance_mm
            )
        } else {
            format!("{one} and {other} {distance_mm:.1} mm apart at {time_s:.2} s")
        }
    }
}

/// The hardest meeting in words.
fn hit(contact: &PlateContact) -> String {
    let PlateContact {
        body,
        obstacle,
        count,
        peak_n,
        ..
    } = contact;
    let times = match count {
        1 => "once".to_owned(),
        _ => format!("{count} times"),
    };
    format!("hit {obstacle} with {peak_n:.0} N ({body}, {times})")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contact(body: &str, count: usize, peak_n: f64) -> PlateContact {
        PlateContact {
            body: body.to_owned(),
            obstacle: "plate 1".to_owned(),
            count,
            first_s: 1.0,
            seconds: 0.5,
            peak_n,
        }
    }

    #[test]
    fn a_sentence_says_whether_it_passed_and_what_was_hit_hardest() {
        let hits = [contact("LHand", 3, 20.0), contact("Head", 239, 106.4)];
        let once = [contact("Head", 1, 2.0)];
        for (passed, contacts, sentence) in [
            (
                Some(true),
                &[][..],
                "past the obstacles, without touching one",
            ),
            (
                Some(true),
                &hits,
                "past the obstacles, but hit plate 1 with 106 N (Head, 239 times)",
            ),
            (
                Some(false),
                &[],
                "not past the obstacles after 5 cycles, without touching one",
            ),
            (
                Some(false),
                &once,
                "not past the obstacles after 5 cycles, hit plate 1 with 2 N (Head, once)",
            ),
            (None, &[], "5 cycles, 253 mm each, nothing touched"),
            (
                None,
                &hits,
                "5 cycles, 253 mm each, hit plate 1 with 106 N (Head, 239 times)",
            ),
        ] {
            let outcome = OutcomeSummary::new(passed, 5, 253.2, contacts);
            assert_eq!(outcome.sentence, sentence);
            assert_eq!(outcome.passed, passed);
            assert_eq!(outcome.touched, !contacts.is_empty());
        }
        let outcome = OutcomeSummary::new(None, 1, 70.0, &hits);
        assert_eq!(outcome.largest_contact_n, Some(106.4));
        assert!(outcome.sentence.starts_with("1 cycle, 70 mm"));
    }

    #[test]
    fn nearest_parts_are_apart_or_in_one_another() {
        let near = |distance_mm| SelfCollisionSummary {
            shapes: ["LHandShell".to_owned(), "Skull".to_owned()],
            distance_mm,
            time_s: 1.5,
        };
        let (apart, within) = (near(3.21), near(-0.8));
        assert!(!apart.is_collision() && within.is_collision());
        assert_eq!(
            apart.in_words(),
            "LHandShell and Skull 3.2 mm apart at 1.50 s"
        );
        assert_eq!(
            within.in_words(),
            "LHandShell and Skull 0.8 mm in one another at 1.50 s"
        );
    }
}
