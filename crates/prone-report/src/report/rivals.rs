//! Other crawling humanoids, as their authors report them. Theirs, not ours: nothing here was run by
//! this program.

/// What is said of each. Speeds say how they were obtained; a passage is the lowest one, over the
/// standing height.
pub(super) const HEADS: [&str; 7] = [
    "theirs",
    "robot",
    "speed",
    "standing heights per s",
    "lowest passage / standing height",
    "besides",
    "source",
];

/// Those that were found in 2026.
pub(super) const RIVALS: [[&str; 7]; 4] = [
    [
        "Projected Profile crawl, 2015",
        "NAO, 0.574 m",
        "22.6 and 28.9 mm/s, measured on the robot in two experiments",
        "0.039 and 0.050",
        "0.35 (panels 200 mm above the floor)",
        "squared torque of a pull, in simulation",
        "master's thesis, NYU Polytechnic 2015; IROS 2015, doi 10.1109/IROS.2015.7354220",
    ],
    [
        "Locomotion Beyond Feet, 2026",
        "ToddlerBot, 0.56 m",
        "57 mm/s in its reference motion",
        "0.10",
        "about 0.39",
        "its crawl is not steered",
        "ToddlerBot project",
    ],
    [
        "GR00T-WholeBodyControl, SONIC",
        "Unitree G1, 1.32 m",
        "0.7 to 1.0 m/s, as commanded to an elbow crawl",
        "0.53 to 0.76",
        "0.23, of the pelvis alone",
        "warns that crawling may overheat the robot",
        "documentation of the GR00T-WholeBodyControl repository",
    ],
    [
        "g1_crawl, in Isaac Lab",
        "Unitree G1, 1.32 m",
        "not stated",
        "–",
        "0.17, the height aimed at for the base",
        "its rewards are not recorded",
        "g1_crawl repository",
    ],
];
