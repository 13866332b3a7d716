//! An experiment is all that it takes: it is sent as text, read back, and run without a file.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use prone_files::robot_folder::RobotFiles;
use prone_files::shipped;
use prone_record::experiment::{
    ClearanceChoice, CostExperiment, CrawlExperiment, CycleCostExperiment, CycleRulesChoice,
    CycleSearchExperiment, Detail, Ending, Ends, Experiment, GaitForm, GaitText, LimitsChoice,
    MapSource, NamedGait, PassageCycle, PassageExperiment, PullCostChoice, PullExperiment,
    PullObjective, PullRules, PullSearchExperiment, RobotText, Runs, SceneText, ServoChoice, Share,
    SteeringChoice, TorqueChoice, TorqueMapExperiment, Under,
};
use prone_record::frontier::{CycleObjective, Quantity};
use prone_record::resumption::Opening;
use prone_record::search::Solver;
use prone_record::search_result::SearchResult;
use prone_study::run::{Outcome, Place, RunError, Session, run};
use prone_study::watch::{Progress, Unwatched, Watch};

fn robot() -> RobotText {
    RobotText::from_files(&RobotFiles::shipped(&shipped::NAO))
}

fn gait(name: &str) -> GaitText {
    let gait = shipped::gait_file(name).unwrap();
    GaitText::new(&gait.file, &gait.text)
}

fn crawl() -> CrawlExperiment {
    CrawlExperiment {
        ending: Ending::Cycles(1),
        ..CrawlExperiment::new(robot(), gait("hip-10"))
    }
}

fn sent(experiment: &Experiment) -> Experiment {
    serde_json::from_str(&serde_json::to_string(experiment).unwrap()).unwrap()
}

#[test]
fn a_crawl_that_was_sent_is_the_crawl_that_was_asked_for() {
    let experiment = Experiment::Crawl(Box::new(crawl()));
    let summary = |experiment: &Experiment| match run(experiment, &Unwatched).unwrap() {
        Outcome::Crawl(crawl) => {
            assert!(crawl.artefacts.is_none(), "no rows were asked for");
            crawl.summary
        }
        other => panic!("a crawl was asked for: {other:?}"),
    };
    let here = summary(&experiment);
    assert_eq!(here.cycles, 1);
    assert!(here.distance_mm > 50.0, "{} mm", here.distance_mm);
    assert_eq!(summary(&sent(&experiment)), here);
}

#[test]
fn a_pull_leaves_the_record_of_a_pull() {
    let experiment = Experiment::Pull(Box::new(PullExperiment {
        robot: robot(),
        gait: gait("nominal"),
        duration_s: 1.0,
    }));
    let Outcome::Pull(pull) = run(&experiment, &Unwatched).unwrap() else {
        panic!("a pull was asked for");
    };
    assert_eq!(pull.record.rows.len(), 20, "one row per control step");
    assert!(pull.artefacts.contains_key("rows.csv"));
    let run = String::from_utf8(pull.artefacts["run.json"].clone()).unwrap();
    assert!(run.contains(r#""command": "pull run""#), "{run}");
}

#[test]
fn a_passage_names_the_cycle_that_fits() {
    let passage = PassageExperiment {
        robot: robot(),
        cycles: ["thesis-nominal", "hip-10"]
            .map(|name| PassageCycle {
                gait: gait(name),
                called: name.to_owned(),
                origin: "shipped".to_owned(),
            })
            .into(),
        ceiling_mm: 188.0,
        length_m: 1.0,
        margin_mm: 1.0,
        search: None,
    };
    let experiment = sent(&Experiment::Passage(Box::new(passage.clone())));
    let Outcome::Passage(outcome) = run(&experiment, &Unwatched).unwrap() else {
        panic!("a passage was asked for");
    };
    assert!(outcome.passage.feasible);
    assert_eq!(outcome.cycle.unwrap().name, "hip-10");
    for (margin_mm, expected) in [
        (
            188.0,
            "a margin of 188 mm leaves no room under a ceiling of 188 mm",
        ),
        (f64::NAN, "a margin of NaN mm is outside 0 to 1000 mm"),
        (-50.0, "a margin of -50 mm is outside 0 to 1000 mm"),
    ] {
        let none = PassageExperiment {
            margin_mm,
            ..passage.clone()
        };
        let error = run(&Experiment::Passage(Box::new(none)), &Unwatched).unwrap_err();
        assert_eq!(error.to_string(), expected);
    }
}

#[test]
fn limit_what_no_crawl_can_have() {
    let refused = |change: fn(&mut CrawlExperiment)| {
        let mut experiment = crawl();
        change(&mut experiment);
        let experiment = Experiment::Crawl(Box::new(experiment));
        run(&experiment, &Unwatched).unwrap_err().to_string()
    };
    for (said, expected) in [
        (
            refused(|it| it.joint_offset_deg = Some(2.0)),
            "calibration errors cannot be drawn without a seed",
        ),
        (
            refused(|it| it.uphill = Some(it.gait.clone())),
            "the noise of the inertial unit cannot be drawn without a seed",
        ),
        (
            refused(|it| {
                it.joint_offset_deg = Some(f64::NAN);
                it.seed = Some(1);
            }),
            "a calibration error of NaN° is outside 0 to 10°",
        ),
        (
            refused(|it| it.late_commands_ms = Some(20.0)),
            "the delays of commands cannot be drawn without a seed",
        ),
        (
            refused(|it| {
                it.late_commands_ms = Some(20.1);
                it.seed = Some(1);
            }),
            "a delay of 20.1 ms is outside 0 to 20 ms",
        ),
        (
            refused(|it| it.mass_factor = Some(0.0)),
            "a factor of masses of 0 is outside 0.5 to 2",
        ),
        (
            refused(|it| it.servo = ServoChoice::Times(5.0)),
            "a factor of stiffness of 5 is outside 0.1 to 4",
        ),
        (
            refused(|it| it.backlash_deg = Some(f64::NAN)),
            "a backlash of NaN° is outside 0 to 5°",
        ),
        (
            refused(|it| it.ending = Ending::Cycles(0)),
            "a crawl of 0 cycles is outside 1 to 1000 cycles",
        ),
        (
            refused(|it| it.steering = SteeringChoice::Heading { degrees: 181.0 }),
            "a heading of 181° is outside -180 to 180°",
        ),
        (
            refused(|it| {
                it.scene.text = Some(SceneText::new("s.toml", ""));
                it.scene.plate = Some((178.0, 1.0));
            }),
            "scene s.toml and a plate exclude each other",
        ),
    ] {
        assert_eq!(said, expected);
    }
}

/// Says stop after so many looks, and then always.
struct After(AtomicUsize);

impl Watch for After {
    fn stop(&self) -> bool {
        let left = |looks: usize| looks.checked_sub(1);
        let looked = self
            .0
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, left);
        looked.is_err()
    }

    fn progress(&self, _: &Progress<'_>) {}
}

#[test]
fn an_experiment_is_stopped_and_a_changed_text_refused() {
    let experiment = Experiment::Crawl(Box::new(crawl()));
    let stopped = run(&experiment, &After(AtomicUsize::new(20)));
    assert!(matches!(stopped, Err(RunError::Stopped)));
    let mut changed = crawl();
    changed.gait.text.push('\n');
    let error = run(&Experiment::Crawl(Box::new(changed)), &Unwatched).unwrap_err();
    assert!(error.to_string().contains("SHA-256"), "{error}");
    let mut rows = crawl();
    rows.detail = Detail::Rows;
    rows.time_step_s = Some(0.1);
    let error = run(&Experiment::Crawl(Box::new(rows)), &Unwatched).unwrap_err();
    assert!(
        error.to_string().contains("outside 0.0001 to 0.005 s"),
        "{error}"
    );
}

fn terms() -> PullCostChoice {
    PullCostChoice {
        objective: PullObjective::Heat {
            rules: PullRules {
                per: Share::Metre,
                duration_s: 3.0,
                rate_deg_per_phase: Some(200.0),
                clearance: ClearanceChoice::Base,
                limits: LimitsChoice::Base,
            },
        },
        source: TorqueChoice::Statics,
        base: gait("nominal"),
    }
}

fn pull_search() -> PullSearchExperiment {
    PullSearchExperiment {
        robot: robot(),
        terms: terms(),
        form: GaitForm::Cubic,
        ends: Ends::Fixed,
        solver: Solver::DifferentialEvolution,
        runs: Runs {
            seed: 1,
            runs: 2,
            budget: 400,
        },
        time_budget_s: None,
        name: "best".to_owned(),
        compared: vec![gait("nominal"), gait("optimal")],
        confirm_durations_s: vec![1.0],
    }
}

fn put(path: &Path, opening: Opening) -> Session {
    Session {
        place: Some(Place {
            path: path.to_owned(),
            opening,
        }),
        ..Session::default()
    }
}

#[test]
fn a_cost_that_was_sent_is_the_cost_that_was_asked_for() {
    let cost = |terms: PullCostChoice| {
        let experiment = Experiment::Cost(Box::new(CostExperiment {
            robot: robot(),
            gait: gait("optimal"),
            terms,
        }));
        match run(&sent(&experiment), &Unwatched)? {
            Outcome::Cost(outcome) => Ok(outcome.cost.cost.unwrap()),
            other => panic!("a cost was asked for: {other:?}"),
        }
    };
    let per_metre: f64 = cost(terms()).unwrap();
    let PullObjective::Heat { rules } = terms().objective else {
        panic!("the objective is heat");
    };
    let per_pull = PullCostChoice {
        objective: PullObjective::Heat {
            rules: PullRules {
                per: Share::Phase,
                ..rules
            },
        },
        ..terms()
    };
    // The shoulder of both published gaits advances by its own upper arm's stroke.
    let stroke: f64 = cost(per_pull).unwrap() / per_metre;
    assert!((0.05..0.15).contains(&stroke), "{stroke} m");
    let weightless = PullCostChoice {
        objective: PullObjective::Torque {
            weights: [0.0; 4],
            rules,
        },
        ..terms()
    };
    let refused: RunError = cost(weightless).unwrap_err();
    assert!(refused.to_string().contains("not all 0"), "{refused}");
}

#[test]
fn identity_a_search_is_the_same_in_memory_and_stopped_and_resumed_in_a_folder() {
    let home = tempfile::tempdir().unwrap();
    let out = home.path().join("found");
    let experiment = Experiment::PullSearch(Box::new(pull_search()));
    let text = |outcome| match outcome {
        Outcome::Search(done) => {
            assert!(done.artefacts.contains_key("gait.toml"));
            serde_json::to_string(&done.result).unwrap()
        }
        other => panic!("a search was asked for: {other:?}"),
    };
    let in_memory = text(run(&sent(&experiment), &Unwatched).unwrap());
    let stopped = put(&out, Opening::Restart).run(&experiment, &After(AtomicUsize::new(200)));
    let Err(RunError::StoppedSearch { checkpoint }) = stopped else {
        panic!("it was to stop: {stopped:?}");
    };
    assert!(checkpoint.exists() && !out.exists());
    let other = PullSearchExperiment {
        ends: Ends::Free,
        ..pull_search()
    };
    let other = Experiment::PullSearch(Box::new(other));
    let refused = put(&out, Opening::Resume).run(&other, &Unwatched);
    assert!(
        matches!(refused, Err(RunError::Resumption(_))),
        "{refused:?}"
    );
    let resumed = put(&out, Opening::Resume).run(&experiment, &Unwatched);
    assert_eq!(text(resumed.unwrap()), in_memory);
    assert!(out.join("gait.toml").exists() && !checkpoint.exists());
}

#[test]
fn limit_a_key_that_an_experiment_does_not_have() {
    let mut sent = serde_json::to_value(Experiment::PullSearch(Box::new(pull_search()))).unwrap();
    assert!(serde_json::from_value::<Experiment>(sent.clone()).is_ok());
    for place in [
        "",
        "/runs",
        "/terms",
        "/terms/objective/heat/rules",
        "/robot",
    ] {
        let mut wrong = sent.clone();
        wrong.pointer_mut(place).unwrap()["ceilling_mm"] = 178.into();
        let refused = serde_json::from_value::<Experiment>(wrong)
            .unwrap_err()
            .to_string();
        assert!(refused.contains("ceilling_mm"), "{place}: {refused}");
    }
    sent["runs"].as_object_mut().unwrap().remove("seed");
    let refused = serde_json::from_value::<Experiment>(sent)
        .unwrap_err()
        .to_string();
    assert!(refused.contains("seed"), "{refused}");
}

#[test]
fn limit_what_no_search_can_have() {
    let refused = |change: fn(&mut PullSearchExperiment)| {
        let mut experiment = pull_search();
        change(&mut experiment);
        let experiment = Experiment::PullSearch(Box::new(experiment));
        run(&experiment, &Unwatched).unwrap_err().to_string()
    };
    let named = "a gait's name is made of letters, digits, - and _, not \"../../best\"";
    for (said, expected) in [
        (
            refused(|it| it.runs.runs = u64::MAX),
            "a search of 18446744073709552000 runs is outside 1 to 1000 runs",
        ),
        (
            refused(|it| it.runs.budget = 0),
            "a budget of 0 evaluations is outside 1 to 1000000000 evaluations",
        ),
        (
            refused(|it| it.time_budget_s = Some(-1.0)),
            "a time budget of -1 s is outside 0 to 1000000000 s",
        ),
        (refused(|it| it.name = "../../best".to_owned()), named),
        (
            refused(|it| it.name = "nominal".to_owned()),
            "the found gait would be called \"nominal\", like one that it is compared with",
        ),
        (
            refused(|it| it.form = GaitForm::BSpline { points: 3 }),
            "a B-spline of 3 control points is outside 4..32",
        ),
    ] {
        assert_eq!(said, expected);
    }
}

#[test]
fn a_search_of_cycles_that_was_sent() {
    let experiment = CycleSearchExperiment {
        robot: robot(),
        objective: CycleObjective::Advance,
        steerable: false,
        ideal: false,
        reach: 1.0,
        under: Under::One {
            rules: Box::new(CycleRulesChoice {
                ceiling_mm: Some(178.0),
                ..CycleRulesChoice::default()
            }),
            worst_over: None,
            name: Some("low".to_owned()),
        },
        from: vec![NamedGait {
            called: "hip-10".to_owned(),
            gait: gait("hip-10"),
        }],
        compared: Vec::new(),
        runs: Runs {
            seed: 1,
            runs: 1,
            budget: 16,
        },
        time_budget_s: None,
    };
    let asked = sent(&Experiment::CycleSearch(Box::new(experiment.clone())));
    let Outcome::Search(done) = run(&asked, &Unwatched).unwrap() else {
        panic!("a search was asked for");
    };
    assert!(done.artefacts.contains_key("gaits/low-seed-1.toml"));
    let SearchResult::Cycles(found) = done.result else {
        panic!("a search of cycles was asked for");
    };
    assert_eq!(found.found[0].gait, "low-seed-1");
    let refused = |under| {
        let asked = CycleSearchExperiment {
            under,
            ..experiment.clone()
        };
        let refused = run(&Experiment::CycleSearch(Box::new(asked)), &Unwatched);
        refused.unwrap_err().to_string()
    };
    let said = refused(Under::One {
        rules: Box::default(),
        worst_over: None,
        name: Some("a/b".to_owned()),
    });
    assert!(said.contains("a gait's name is made of"), "{said}");
    for (at, margin_mm, reason) in [
        (vec![178.0, 178.0], 1.0, "178 mm is there twice"),
        (vec![115.0], 1.0, "115 mm is too low for NAO H25 V4"),
        (vec![178.0], 178.0, "a margin of 178 mm leaves no room"),
        (
            vec![1.0],
            0.5,
            "a ceiling of 1 mm is outside 10 to 10000 mm",
        ),
        (
            vec![f64::NAN],
            1.0,
            "a ceiling of NaN mm is outside 10 to 10000 mm",
        ),
    ] {
        let said = refused(Under::Across {
            held: Quantity::Ceiling,
            at,
            margin_mm,
        });
        assert!(said.contains(reason), "{said}");
    }
    let said = refused(Under::One {
        rules: Box::new(CycleRulesChoice {
            most_heat: Some(100.0),
            ..CycleRulesChoice::default()
        }),
        worst_over: None,
        name: None,
    });
    assert!(
        said.contains("most_heat goes with the objectives heat"),
        "{said}"
    );
}

/// A cycle costs what a search says of it, and keeps no rule that it is held to and breaks.
#[test]
fn the_cost_of_a_cycle_that_was_sent() {
    let quoted = |rules: CycleRulesChoice, objective, ideal| {
        let experiment = Experiment::CycleCost(Box::new(CycleCostExperiment {
            robot: robot(),
            gait: gait("hip-10"),
            from: None,
            objective,
            steerable: false,
            ideal,
            rules,
            worst_over: None,
        }));
        let Outcome::CycleCost(cost) = run(&sent(&experiment), &Unwatched).unwrap() else {
            panic!("a cost was asked for");
        };
        *cost
    };
    // Corners are another matter.
    let cost = |rules, objective| quoted(rules, objective, true);
    let free = CycleRulesChoice {
        most_head_n: Some(1000.0),
        least_advance_mm: Some(10.0),
        ..CycleRulesChoice::default()
    };
    let heat = cost(free, CycleObjective::Heat);
    assert_eq!((heat.unit, heat.violations), ("s/m", 0.0));
    let [own, stiff] = &heat.settings[..] else {
        panic!("{heat:?}");
    };
    let heats = [own, stiff].map(|it| it.row.heat_per_metre_s.unwrap());
    let mean = (heats[0] * heats[1]).sqrt();
    assert!((heat.value.unwrap() - mean).abs() < 1e-9 * mean, "{heat:?}");
    // A tenth more than it has is asked of it.
    let speed = own.row.mm_per_s.unwrap();
    let faster = CycleRulesChoice {
        least_speed_mm_s: Some(speed / 0.9),
        ..free
    };
    let broken = cost(faster, CycleObjective::Heat);
    let rule = &broken.settings[0].broken[0];
    assert_eq!(rule.rule, "speed");
    assert!((rule.sum - 0.1).abs() < 1e-9, "{rule:?}");
    let duty = own.row.duty.unwrap();
    let gentler = CycleRulesChoice {
        most_duty: Some(duty / 1.1),
        ..free
    };
    let broken = cost(gentler, CycleObjective::Heat);
    let rule = &broken.settings[0].broken[0];
    assert_eq!(rule.rule, "duty");
    assert!((rule.sum - 0.1).abs() < 1e-9, "{rule:?}");
    // With them the value is the same, as it is that of the servos.
    let cornered = quoted(free, CycleObjective::Heat, false);
    assert_eq!(cornered.value, heat.value);
    assert_eq!(cornered.settings[..2], heat.settings[..]);
    assert!(cornered.settings.len() >= 10, "{}", cornered.settings.len());
}

#[test]
fn identity_a_torque_map_is_the_same_in_memory_and_in_a_file() {
    let home = tempfile::tempdir().unwrap();
    let out = home.path().join("map.csv");
    let experiment = Experiment::TorqueMap(Box::new(TorqueMapExperiment {
        robot: robot(),
        source: MapSource::Statics,
        step_deg: 10.0,
        theta4_max_deg: 10.0,
    }));
    let Outcome::TorqueMap(map) = run(&sent(&experiment), &Unwatched).unwrap() else {
        panic!("a map was asked for");
    };
    put(&out, Opening::Resume)
        .run(&experiment, &Unwatched)
        .unwrap();
    assert_eq!(std::fs::read_to_string(&out).unwrap(), map.text);
    assert_eq!(std::fs::read_dir(home.path()).unwrap().count(), 1);
}
