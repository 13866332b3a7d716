//! A corner of a search or a passage, and the same asked for with the options of a crawl.

use prone_files::shipped;
use prone_record::experiment::{
    CrawlExperiment, Ending, GaitText, RobotText, SceneChoice, ServoChoice, SteeringChoice,
};
use prone_sim::{LoadedRobot, RobotFiles};
use prone_study::crawl::CrawlSetup;
use prone_study::search::corners::{self, Asked, Corner, OFFSET_DEG};
use prone_study::search::setting::Role;
use prone_study::search::trial::try_out;

const ASKED: Asked = Asked {
    cycles: 2,
    role: Role::Beside,
};

/// A corner can be crawled again by the options of `prone crawl run`: to the bit the same advance.
#[test]
fn identity_a_corner_is_what_the_options_of_a_crawl_say() {
    let files = RobotFiles::shipped(&shipped::NAO);
    let loaded = LoadedRobot::load(files.clone()).unwrap();
    // One that cannot be steered, and one that holds its heading.
    let cycles = [
        ("thesis-nominal", SteeringChoice::None),
        ("low-165", SteeringChoice::Line),
    ];
    for (name, steering) in cycles {
        let gait = shipped::gait_file(name).unwrap();
        let gait = GaitText::new(&gait.file, &gait.text);
        let plain = CrawlExperiment {
            ending: Ending::Cycles(ASKED.cycles),
            steering,
            ..CrawlExperiment::new(RobotText::from_files(&files), gait)
        };
        let cycle = shipped::cycle(name).unwrap().unwrap();
        for corner in corners::all().skip(14) {
            let mut experiment = plain.clone();
            experiment.scene = SceneChoice {
                friction: corner.friction().map(|it| (it.left, it.right)),
                ..SceneChoice::default()
            };
            match corner {
                Corner::Uneven { seed, .. } => {
                    experiment.joint_offset_deg = Some(OFFSET_DEG);
                    experiment.seed = Some(seed);
                }
                Corner::Friction(_) => {}
                Corner::Masses(factor) => experiment.mass_factor = Some(factor),
                Corner::Stiffness(factor) => experiment.servo = ServoChoice::Times(factor),
                Corner::Backlash { degrees } => experiment.backlash_deg = Some(degrees),
                Corner::LateCommands { ms, seed } => {
                    experiment.late_commands_ms = Some(ms);
                    experiment.seed = Some(seed);
                }
            }
            let crawl = CrawlSetup::new(&experiment)
                .unwrap()
                .run(&|| false)
                .unwrap();
            let spec = corner.spec(loaded.robot(), ASKED);
            let trial = try_out(&spec.compile(&loaded).unwrap(), &cycle).unwrap();
            let advance = crawl.cycles[1].advance().forward;
            assert!(advance > 0.03, "{corner}: {advance} m");
            assert_eq!(advance.to_bits(), trial.advance.to_bits(), "{corner}");
        }
    }
}
