use std::collections::BTreeSet;

use prone_files::shipped;
use prone_sim::RobotFiles;

use super::*;

const ASKED: Asked = Asked {
    cycles: 1,
    role: Role::Beside,
};

fn nao() -> LoadedRobot {
    LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap()
}

/// Others keep these names and know them again; each is one corner, and has a kind of its own.
#[test]
fn regression_corners_are_complete_and_distinct() {
    let names: Vec<String> = all().map(|corner| corner.to_string()).collect();
    assert_eq!(
        names,
        [
            "uneven-0.5-0.9-seed-1",
            "uneven-0.9-0.5-seed-1",
            "uneven-0.5-0.9-seed-2",
            "uneven-0.9-0.5-seed-2",
            "uneven-0.5-0.9-seed-3",
            "uneven-0.9-0.5-seed-3",
            "uneven-0.5-0.9-seed-4",
            "uneven-0.9-0.5-seed-4",
            "uneven-0.5-0.9-seed-5",
            "uneven-0.9-0.5-seed-5",
            "uneven-0.5-0.9-seed-6",
            "uneven-0.9-0.5-seed-6",
            "uneven-0.5-0.9-seed-7",
            "uneven-0.9-0.5-seed-7",
            "uneven-0.5-0.9-seed-8",
            "uneven-0.9-0.5-seed-8",
            "friction-0.4",
            "friction-1",
            "mass-0.9",
            "mass-1.1",
            "stiffness-0.5",
            "stiffness-2",
            "backlash-1-deg",
            "late-20-ms",
        ]
    );
    let kinds: BTreeSet<String> = all().map(|corner| corner.kind().to_string()).collect();
    assert_eq!(kinds.len(), names.len());
    let sentences: BTreeSet<String> = all().map(Corner::sentence).collect();
    assert_eq!(sentences.len(), names.len());
}

/// No corner is the robot as its model says, and no two are the same robot on the same floor.
#[test]
fn corners_differ_in_what_they_change() {
    let loaded = nao();
    let robot = loaded.robot();
    let conditions = |corner: Corner| {
        let regime = corner.regime();
        (
            regime,
            corner.friction(),
            corner.offsets(robot),
            corner.late(),
        )
    };
    let mut seen = vec![(Regime::LOCOMOTION, None, None, None)];
    for corner in all() {
        let conditions = conditions(corner);
        assert!(!seen.contains(&conditions), "{corner}");
        if let Some(offsets) = &conditions.2 {
            let largest = offsets
                .as_slice()
                .iter()
                .fold(0.0_f64, |a, b| a.max(b.abs()));
            let bound = OFFSET_DEG.to_radians();
            assert!(largest > 0.5 * bound && largest <= bound, "{corner}");
        }
        seen.push(conditions);
    }
}

/// Sixteen uneven runs need two compiled models; all corners are in the scene that was asked for.
#[test]
fn corners_that_differ_in_joint_errors_alone_share_a_model() {
    let scene = Scene::under_plate(0.2, 1.5);
    let settings = settings(&nao(), &scene, all(), ASKED).unwrap();
    assert!(
        all()
            .map(Corner::kind)
            .eq(settings.iter().map(|it| it.spec.kind))
    );
    let mut models: Vec<&World> = Vec::new();
    for (index, setting) in settings.iter().enumerate() {
        assert_eq!(setting.world.scene().plates, scene.plates);
        assert_eq!(setting.world.scene().floor.friction, setting.spec.friction);
        if !models.iter().any(|it| it.shares_model_with(&setting.world)) {
            models.push(&setting.world);
        }
        let uneven = index < 16;
        assert!(!uneven || models.len() <= 2, "{index}");
    }
    assert_eq!(models.len(), 10);
}
