//! Other crawling humanoids, as their authors report them. Theirs, not ours: nothing here was run by
//! this program.

/// What others say of their crawl.
pub(super) struct Rival {
    pub(super) system: &'static str,
    pub(super) robot: &'static str,
    /// Speed, with how it was obtained.
    pub(super) speed: &'static str,
    pub(super) standing_heights_per_s: &'static str,
    /// Lowest passage over standing height.
    pub(super) passage: &'static str,
    pub(super) besides: &'static str,
    /// Where it is said.
    pub(super) source: &'static str,
}

/// Found in 2026.
pub(super) const RIVALS: [Rival; 4] = [
    Rival {
        system: "Projected Profile crawl, 2015",
        robot: "NAO, 0.574 m",
        speed: "22.6 and 28.9 mm/s, measured on the robot in two experiments",
        standing_heights_per_s: "0.039 and 0.050",
        passage: "0.35 (panels 200 mm above the floor)",
        besides: "squared torque of a pull, in simulation",
        source: "master's thesis, NYU Polytechnic 2015; IROS 2015, doi 10.1109/IROS.2015.7354220",
    },
    Rival {
        system: "Locomotion Beyond Feet, 2026",
        robot: "ToddlerBot, 0.56 m",
        speed: "57 mm/s in its reference motion",
        standing_heights_per_s: "0.10",
        passage: "about 0.39",
        besides: "its crawl is not steered",
        source: "ToddlerBot project",
    },
    Rival {
        system: "GR00T-WholeBodyControl, SONIC",
        robot: "Unitree G1, 1.32 m",
        speed: "0.7 to 1.0 m/s, as commanded to an elbow crawl",
        standing_heights_per_s: "0.53 to 0.76",
        passage: "0.23, of the pelvis alone",
        besides: "warns that crawling may overheat the robot",
        source: "documentation of the GR00T-WholeBodyControl repository",
    },
    Rival {
        system: "g1_crawl, in Isaac Lab",
        robot: "Unitree G1, 1.32 m",
        speed: "not stated",
        standing_heights_per_s: "–",
        passage: "0.17, the height aimed at for the base",
        besides: "its rewards are not recorded",
        source: "g1_crawl repository",
    },
];
