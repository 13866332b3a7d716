//! Published figures that ours are held against.
//!
//! Source: the *Projected Profile* crawl gait of the NAO humanoid, master's thesis, NYU
//! Polytechnic 2015, and IROS 2015 (doi 10.1109/IROS.2015.7354220).

use serde::{Deserialize, Serialize};

use prone_report::figures::{GaitNumbers, PublishedRange};

/// Values behind Figure 45: ∫ Σ τ² dt of one side at 1, 2, … 10 s, N²·m²·s.
const NOMINAL_COSTS: [f64; 10] = [
    1.552, 2.769, 3.946, 5.003, 6.114, 7.211, 8.354, 9.641, 10.769, 11.761,
];
const OPTIMAL_COSTS: [f64; 10] = [
    1.489, 2.494, 3.330, 4.379, 5.195, 5.928, 6.558, 7.692, 8.932, 9.643,
];

/// Name of the published gait of constant knee and hip (Table 2).
pub const NOMINAL: &str = "nominal";
/// Name of the published gait of least torque (Table 3).
pub const OPTIMAL: &str = "optimal";

/// The gaits of the published study.
pub const GAITS: [&str; 2] = [NOMINAL, OPTIMAL];

/// The gaits of the study, with the numbers of the chapter's figures.
pub const FIGURES: [GaitNumbers; 2] = [
    GaitNumbers {
        gait: NOMINAL,
        chain: "26",
        frames: "27",
        torque_by_duration: "36",
        torque_over_time: "38",
        transient: "40",
        torque_over_cycle: "42",
        published_divergence_s: 0.25,
    },
    GaitNumbers {
        gait: OPTIMAL,
        chain: "34",
        frames: "35",
        torque_by_duration: "37",
        torque_over_time: "39",
        transient: "41",
        torque_over_cycle: "43",
        published_divergence_s: 0.175,
    },
];

/// The cycle of the published experiments on the robot.
pub const TABLE_CYCLE: &str = "thesis-nominal";
/// The scene of these experiments.
pub const TABLE_SCENE: &str = "table";

/// Durations of the published study, s.
pub const DURATIONS_S: [f64; 10] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0];

/// Table 2: θ3, θ4 and α of the nominal gait at the start and at the end of a pull, degrees.
pub const NOMINAL_DEG: [[f64; 2]; 3] = [[16.5, 16.5], [27.5, 27.5], [-30.0, -90.0]];

/// Table 3: c₃ to c₀ of θ3, θ4 and α of the optimal gait, rad, as printed: the last one has the wrong
/// sign.
#[expect(clippy::approx_constant, reason = "the digits that are printed")]
pub const OPTIMAL_COEFFICIENTS: [[f64; 4]; 3] = [
    [0.2365, 0.0893, -0.3267, 0.28798],
    [1.8796, -0.1365, -1.7434, 0.47997],
    [-0.2134, 1.1570, -1.9898, 0.52360],
];

/// The height at which Figure 26 shows the ankle's highest point, mm, as its text words it.
pub const ANKLE_PEAK_MM: &str = "about 100";

/// Ranges of the left joints of the crawling robot at 3 s a cycle (Figure 31), rad, read off the
/// drawing; one value where the joint hardly moved.
const CRAWL_RANGES: [(&str, f64, f64); 7] = [
    ("LShoulderPitch", -1.0, 0.2),
    ("LShoulderRoll", 0.45, 1.2),
    ("LElbowYaw", -1.7, -1.05),
    ("LElbowRoll", -1.54, -0.7),
    ("LHipPitch", 0.3, 0.3),
    ("LKneePitch", 0.15, 0.7),
    ("LAnklePitch", -1.19, -0.2),
];

/// How the ranges of the crawling robot were obtained.
const RANGES_OBTAINED: &str = "Published: the range that the same joint swept on the real robot at 3 s \
                               a cycle, read off the original's figure.";

/// The published range of a joint of the crawling robot.
pub fn crawl_range(joint: &str) -> Option<PublishedRange> {
    let found = CRAWL_RANGES.iter().find(|(name, ..)| *name == joint);
    found.map(|&(_, low, high)| PublishedRange {
        angles: (low, high),
        obtained: RANGES_OBTAINED,
    })
}

/// A crawl of the real robot under its table.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TableCrawl {
    /// How many cycles.
    pub cycles: usize,
    /// How far, mm.
    pub distance_mm: f64,
    /// In which time, s.
    pub time_s: f64,
}

impl TableCrawl {
    /// How far it came per cycle, mm.
    pub const fn mm_per_cycle(&self) -> f64 {
        self.distance_mm / self.cycles as f64
    }
}

/// The two experiments of the real robot.
pub const TABLE_CRAWLS: [TableCrawl; 2] = [
    TableCrawl {
        cycles: 9,
        distance_mm: 610.0,
        time_s: 27.0,
    },
    TableCrawl {
        cycles: 25,
        distance_mm: 1676.4,
        time_s: 58.0,
    },
];

/// The published cost of a published gait, N²·m²·s.
pub fn cost(gait: &str, duration_s: f64) -> Option<f64> {
    let costs = match gait {
        NOMINAL => NOMINAL_COSTS,
        OPTIMAL => OPTIMAL_COSTS,
        _ => return None,
    };
    DURATIONS_S
        .iter()
        .position(|published| (published - duration_s).abs() < 1e-9)
        .map(|index| costs[index])
}

/// Mean recorded torque in one tenth of a phase.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct TorqueBin {
    /// Name of the gait.
    pub gait: String,
    /// Duration of the phase, s.
    pub duration_s: f64,
    /// Start of the bin, percent of the phase.
    pub from_percent: f64,
    /// End of the bin, percent of the phase.
    pub to_percent: f64,
    /// Recorded torques, N·m.
    pub ankle_nm: f64,
    /// See `ankle_nm`.
    pub knee_nm: f64,
    /// See `ankle_nm`.
    pub hip_nm: f64,
    /// See `ankle_nm`.
    pub shoulder_nm: f64,
}

impl TorqueBin {
    /// In the order of [`prone_record::pulls::JOINTS`].
    pub const fn torques(&self) -> [f64; 4] {
        [self.ankle_nm, self.knee_nm, self.hip_nm, self.shoulder_nm]
    }
}

/// The recorded torques that ship with the program, by gait and duration in the file's order.
///
/// # Errors
/// [`csv::Error`] if the embedded file does not parse, which a test excludes.
pub fn torque_bins() -> Result<Vec<TorqueBin>, csv::Error> {
    let text = include_str!("../../../data/recorded-torque-bins.csv");
    csv::Reader::from_reader(text.as_bytes())
        .deserialize()
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reference_best_published_ratio_is_at_seven_seconds() {
        let ratio =
            |duration| cost("optimal", duration).unwrap() / cost("nominal", duration).unwrap();
        let best = DURATIONS_S
            .iter()
            .copied()
            .min_by(|a, b| ratio(*a).total_cmp(&ratio(*b)));
        assert_eq!(best, Some(7.0));
        assert!((ratio(7.0) - 0.785).abs() < 5e-4, "21.5 % less");
    }

    #[test]
    fn shipped_bins_are_whole_phases() {
        let bins = torque_bins().unwrap();
        assert_eq!(bins.len(), 2 * 6 * 10);
        for phase in bins.chunks(10) {
            assert!(phase.iter().all(|bin| bin.gait == phase[0].gait));
            let length: f64 = phase
                .iter()
                .map(|bin| bin.to_percent - bin.from_percent)
                .sum();
            assert!((length - 100.0).abs() < 1e-9);
        }
    }
}
