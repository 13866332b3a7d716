//! Which figures the chapter has, and what stands in their place while no run fills it.

/// A figure of the published results.
pub(super) struct Place {
    /// Its number there.
    pub(super) number: &'static str,
    /// What it shows, in our words.
    pub(super) shows: &'static str,
    /// What makes our counterpart.
    pub(super) made_by: MadeBy,
    /// What is published of it, and how that was obtained.
    pub(super) published: Option<&'static str>,
}

/// What makes a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MadeBy {
    /// A command, whose folder is then given to the report.
    Command(&'static str),
    /// A robot on the wire, which this program does not drive yet.
    Robot,
}

/// A part of the chapter.
pub(super) struct Part {
    pub(super) title: &'static str,
    pub(super) lead: &'static str,
    pub(super) places: &'static [Place],
}

const REPRODUCE: MadeBy = MadeBy::Command("prone reproduce");
const TABLE: MadeBy =
    MadeBy::Command("prone crawl run --gait thesis-nominal --scene table --record DIR");
const SEARCH: MadeBy =
    MadeBy::Command("prone optimize --objective torque --source dynamics --seed 1 --out DIR");

/// Figures 22 to 45 in their order.
pub(super) const PARTS: [Part; 3] = [
    Part {
        title: "Set-up and gait parameters",
        lead: "The robot where a pull begins and under what it crawls under; the three angles that \
               define a gait, and the search that found the published optimum.",
        places: &[
            Place {
                number: "22",
                shows: "the robot at the start pose",
                made_by: REPRODUCE,
                published: None,
            },
            Place {
                number: "23",
                shows: "the robot under the table",
                made_by: TABLE,
                published: Some(
                    "Published, on the robot: panels down to about 200 mm above the floor, which the \
                     head nearly touches.",
                ),
            },
            Place {
                number: "24",
                shows: "best and mean of each generation of a search",
                made_by: SEARCH,
                published: Some(
                    "Published: a genetic algorithm on a table of static torques, 50 to 80 \
                     generations, with little change after about 10.",
                ),
            },
            Place {
                number: "25",
                shows: "the gait parameters over the phase",
                made_by: REPRODUCE,
                published: None,
            },
        ],
    },
    Part {
        title: "The nominal gait, and whole cycles",
        lead: "What is commanded: the closed chain in the sagittal plane, joint centres only; the \
               body around them has thickness. Then what the simulated robot makes of it, in one pull \
               and in whole cycles under the table.",
        places: &[
            Place {
                number: "26",
                shows: "the planned chain of the nominal gait",
                made_by: REPRODUCE,
                published: Some(
                    "Published, for the planned chain: the ankle is the highest point, at about \
                     100 mm.",
                ),
            },
            Place {
                number: "27",
                shows: "the robot over a pull with the nominal gait",
                made_by: REPRODUCE,
                published: None,
            },
            Place {
                number: "28",
                shows: "the crawl under the table",
                made_by: TABLE,
                published: Some(
                    "Published, on the robot: 610 mm in 9 cycles and 27 s, and 1,676.4 mm in 25 \
                     cycles and 58 s.",
                ),
            },
            Place {
                number: "29",
                shows: "the robot walking up to the table, to a marker",
                made_by: MadeBy::Robot,
                published: None,
            },
            Place {
                number: "30",
                shows: "the robot sitting up behind the table",
                made_by: MadeBy::Robot,
                published: None,
            },
            Place {
                number: "31",
                shows: "joint angles over several cycles",
                made_by: TABLE,
                published: None,
            },
            Place {
                number: "32",
                shows: "joint angles from standing to crawling and back",
                made_by: MadeBy::Robot,
                published: None,
            },
            Place {
                number: "33",
                shows: "motor currents while crawling",
                made_by: MadeBy::Robot,
                published: None,
            },
        ],
    },
    Part {
        title: "The optimal gait: torques and cost",
        lead: "Joint torque is minus the actuator torque about the joint's axis, right side, averaged \
               over one control step: the sign and averaging of the published recordings. Cost is the \
               integral over the pull of the squared joint torques of one side, unweighted; the \
               published axis is labelled N²/m², the quantity is N²·m²·s.",
        places: &[
            torque("34", "the planned chain of the optimal gait", None),
            torque("35", "the robot over a pull with the optimal gait", None),
            torque("36", "torques of the nominal gait by duration", None),
            torque("37", "torques of the optimal gait by duration", None),
            torque(
                "38",
                "torques of the nominal gait over time, by joint",
                None,
            ),
            torque(
                "39",
                "torques of the optimal gait over time, by joint",
                None,
            ),
            torque(
                "40",
                "the beginning of the nominal torques",
                Some(
                    "Published, in the authors' simulation: whatever the duration, the curves run \
                     together until about 0.25 s.",
                ),
            ),
            torque(
                "41",
                "the beginning of the optimal torques",
                Some(
                    "Published, in the authors' simulation: the curves run together until about \
                     0.175 s.",
                ),
            ),
            torque(
                "42",
                "torques of the nominal gait over the phase",
                Some(
                    "Published, in the authors' simulation: from 20 % of the phase on the curves of \
                     all durations are nearly one.",
                ),
            ),
            torque(
                "43",
                "torques of the optimal gait over the phase",
                Some(
                    "Published, in the authors' simulation: from 20 % of the phase on the curves of \
                     all durations are nearly one.",
                ),
            ),
            torque("44", "torques of both gaits", None),
            torque(
                "45",
                "cost against duration",
                Some(
                    "Published, in the authors' simulation: the optimal gait costs at best 21.5 % \
                     less, at 7 s.",
                ),
            ),
        ],
    },
];

const fn torque(
    number: &'static str,
    shows: &'static str,
    published: Option<&'static str>,
) -> Place {
    Place {
        number,
        shows,
        made_by: REPRODUCE,
        published,
    }
}

/// Every place.
pub(super) fn places() -> impl Iterator<Item = &'static Place> {
    PARTS.iter().flat_map(|part| part.places)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_figure_of_the_chapter_has_one_place() {
        let numbers: Vec<String> = places().map(|place| place.number.to_owned()).collect();
        let expected: Vec<String> = (22..=45).map(|number| number.to_string()).collect();
        assert_eq!(numbers, expected);
    }
}
