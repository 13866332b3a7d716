use std::f64::consts::PI;

use insta::assert_snapshot;
use prone::scene::{Legs, Panel, Plate, Ramp, Roughness};

use super::*;

const FULL: &str = r#"name = "attic"
description = "a low plate on an uneven floor"

[floor]
friction_left = 0.5
friction_right = 0.9
slope_deg = 5

[floor.rough]
bump_mm = 5
spacing_mm = 50
start_mm = 100
length_mm = 1000
seed = 1

[[plate]]
start_mm = 50
length_mm = 1500
height_mm = 200

[[plate]]
start_mm = 2000
length_mm = 300
width_mm = 700
height_mm = 180
thickness_mm = 30
legs = "none"

[[panel]]
start_mm = 60
lower_edge_mm = 200
upper_edge_mm = 450

[[ramp]]
start_mm = 1600
length_mm = 1200
angle_deg = 10

[marker]
position_mm = [48, 0, 325]
radius_mm = 60
"#;

fn error(text: &str) -> String {
    parse("scene.toml", text).unwrap_err().to_string()
}

fn changed(from: &str, to: &str) -> String {
    assert!(FULL.contains(from), "{from}");
    error(&FULL.replacen(from, to, 1))
}

#[test]
fn a_scene_is_read_in_metres_and_radians_with_defaults() {
    let scene = parse("scene.toml", FULL).unwrap();
    assert_eq!(scene.name, "attic");
    let friction = scene.floor.friction.unwrap();
    assert_eq!((friction.left, friction.right), (0.5, 0.9));
    assert!((scene.floor.slope - PI / 36.0).abs() < 1e-15);
    let expected = Roughness {
        height: 0.005,
        spacing: 0.05,
        from_x: 0.1,
        length: 1.0,
        width: Roughness::WIDTH,
        seed: 1,
    };
    assert_eq!(scene.floor.roughness, Some(expected));
    let expected = Plate {
        start: 0.05,
        length: 1.5,
        width: Plate::WIDTH,
        height: 0.2,
        thickness: Plate::THICKNESS,
        legs: Legs::Four,
    };
    assert_eq!(scene.plates[0], expected);
    let second = scene.plates[1];
    assert_eq!(
        (second.width, second.thickness, second.legs),
        (0.7, 0.03, Legs::None)
    );
    let expected = Panel {
        start: 0.06,
        width: Panel::WIDTH,
        lower_edge: 0.2,
        upper_edge: 0.45,
        thickness: Panel::THICKNESS,
    };
    assert_eq!(scene.panels, [expected]);
    let expected = Ramp {
        start: 1.6,
        length: 1.2,
        angle: 10_f64.to_radians(),
        width: Ramp::WIDTH,
    };
    assert_eq!(scene.ramps, [expected]);
    let marker = scene.marker.unwrap();
    assert!((marker.facing - PI).abs() < 1e-15, "it faces the robot");
    assert!((marker.position.z() - 0.325).abs() < 1e-15);
}

#[test]
fn a_name_alone_is_a_level_floor() {
    assert!(parse("scene.toml", "name = \"hall\"").unwrap().is_plain());
}

#[test]
fn numbers_out_of_bounds_point_at_the_place() {
    assert_snapshot!(changed("slope_deg = 5", "slope_deg = 46"), @"scene.toml:7:13: slope_deg = 46 is outside -45 to 45");
    assert_snapshot!(changed("friction_left = 0.5", "friction_left = -0.1"), @"scene.toml:5:17: friction_left = -0.1 is outside 0 to 10");
    assert_snapshot!(changed("friction_right = 0.9", "friction_right = 10.5"), @"scene.toml:6:18: friction_right = 10.5 is outside 0 to 10");
    assert_snapshot!(changed("bump_mm = 5", "bump_mm = 0"), @"scene.toml:10:11: bump_mm = 0 is outside 0.1 to 100000");
    assert_snapshot!(changed("spacing_mm = 50", "spacing_mm = 0.2"), @"scene.toml:11:14: spacing_mm = 0.2 makes 25010001 points, at most 1000000 are possible");
    assert_snapshot!(changed("length_mm = 1000", "length_mm = 99"), @"scene.toml:13:13: length_mm = 99 is outside 100 to 100000");
    assert_snapshot!(changed("start_mm = 50", "start_mm = -20"), @"scene.toml:17:12: start_mm = -20 is outside 0 to 100000: what begins before 0 stands in the robot's starting place");
    assert_snapshot!(changed("length_mm = 1500", "length_mm = 1500000"), @"scene.toml:18:13: length_mm = 1500000 is outside 40 to 100000");
    assert_snapshot!(changed("height_mm = 200", "height_mm = -200"), @"scene.toml:19:13: height_mm = -200 is outside 0.1 to 100000");
    assert_snapshot!(changed("height_mm = 200", "height_mm = 0.19"), @"scene.toml:19:13: height_mm = 0.19: did you mean 190?");
    assert_snapshot!(changed("height_mm = 200", "height_mm = nan"), @"scene.toml:19:13: height_mm = NaN is outside 0.1 to 100000");
    assert_snapshot!(changed("thickness_mm = 30", "thickness_mm = 0"), @"scene.toml:26:16: thickness_mm = 0 is outside 0.1 to 100000");
    assert_snapshot!(changed("width_mm = 700", "width_mm = inf"), @"scene.toml:24:12: width_mm = inf is outside 0.1 to 100000");
    assert_snapshot!(changed("upper_edge_mm = 450", "upper_edge_mm = 200"), @"scene.toml:32:17: upper_edge_mm = 200 is outside 200.1 to 100000");
    assert_snapshot!(changed("angle_deg = 10", "angle_deg = 60"), @"scene.toml:37:13: angle_deg = 60 is outside 0.1 to 45");
    assert_snapshot!(changed("325]", "50]"), @"scene.toml:40:23: z of position_mm = 50 is outside 60 to 100000");
    assert_snapshot!(changed("radius_mm = 60", "radius_mm = 60\nfacing_deg = 400"), @"scene.toml:42:14: facing_deg = 400 is outside -360 to 360");
}

#[test]
fn what_is_not_a_scene_points_at_the_place() {
    assert_snapshot!(changed("friction_left = 0.5\n", ""), @"scene.toml:5:18: friction_right needs friction_left beside it");
    assert_snapshot!(changed("friction_right = 0.9\n", ""), @"scene.toml:5:17: friction_left needs friction_right beside it");
    assert_snapshot!(changed("\"attic\"", "\"../attic\""), @r#"scene.toml:1:8: a scene's name is made of letters, digits, - and _ (it becomes part of file names), not "../attic""#);
    assert_snapshot!(changed("height_mm = 200", "hight_mm = 200"), @"scene.toml:19:1: unknown field `hight_mm`, expected one of `start_mm`, `length_mm`, `width_mm`, `height_mm`, `thickness_mm`, `legs`");
    assert_snapshot!(changed("height_mm = 200\n", ""), @"scene.toml:16:1: missing field `height_mm`");
    assert_snapshot!(changed("\"none\"", "\"three\""), @"scene.toml:27:8: unknown variant `three`, expected `four` or `none`");
    assert_snapshot!(changed("[48, 0, 325]", "[48, 0]"), @"scene.toml:40:15: invalid length 2, expected an array of exactly 3 values");
    assert_snapshot!(changed("seed = 1", "seed = -1"), @"scene.toml:14:8: invalid value: integer `-1`, expected u64");
    assert_snapshot!(changed("[floor]", "[floor]\nfriction = 1"), @"scene.toml:5:1: unknown field `friction`, expected one of `friction_left`, `friction_right`, `slope_deg`, `rough`");
}
