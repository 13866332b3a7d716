//! Which way a cycle came: forward, to the left, and turned to the left, are positive.

use prone::motor::Effort;
use prone::robot::Tops;
use prone::steering::Bearing;
use prone_sim::crawl::{Advance, CycleRow, GroundLoad};

/// A cycle between two bearings, its pull ended half-way.
fn cycle(from: Bearing, to: Bearing) -> CycleRow {
    CycleRow {
        gait: String::new(),
        turn: 0.0,
        shift: 0.0,
        begin: 0.0,
        seconds: 1.0,
        from,
        pulled: Bearing {
            x: from.x.midpoint(to.x),
            y: from.y.midpoint(to.y),
            yaw: from.yaw,
        },
        to,
        tops: Tops::NONE,
        effort: Effort {
            seconds: 1.0,
            moving: 1.0,
            motors: Vec::new(),
        },
        ground: GroundLoad::default(),
        body_share: 0.0,
        recovery_body_share: 0.0,
    }
}

#[track_caller]
fn near(found: Advance, forward: f64, left: f64, yaw: f64) {
    let off = [found.forward - forward, found.left - left, found.yaw - yaw];
    assert!(off.iter().all(|off| off.abs() < 1e-12), "{found:?}");
}

const fn bearing(x: f64, y: f64, yaw: f64) -> Bearing {
    Bearing { x, y, yaw }
}

#[test]
fn a_robot_that_heads_along_x_has_y_on_its_left() {
    let row = cycle(bearing(1.0, 2.0, 0.0), bearing(1.3, 2.1, 0.2));
    near(row.advance(), 0.3, 0.1, 0.2);
    near(row.pull_advance(), 0.15, 0.05, 0.0);
    let row = cycle(bearing(0.0, 0.0, 0.0), bearing(-0.3, -0.1, -0.2));
    near(row.advance(), -0.3, -0.1, -0.2);
}

/// Heading along y, forward is y and the left is against x.
#[test]
fn a_robot_that_heads_along_y_has_x_on_its_right() {
    let heading = std::f64::consts::FRAC_PI_2;
    let row = cycle(bearing(0.0, 0.0, heading), bearing(0.1, 0.3, heading));
    near(row.advance(), 0.3, -0.1, 0.0);
}

/// However it was laid down, the same way is the same advance.
#[test]
fn identity_an_advance_does_not_depend_on_where_a_robot_begins() {
    let (forward, left, turn) = (0.2, -0.03, 0.1);
    for yaw in [-3.0, -1.0, 0.4, 2.0, 3.1] {
        let from = bearing(0.7, -0.4, yaw);
        let (sin, cos) = f64::sin_cos(yaw);
        let to = Bearing {
            x: from.x + forward * cos - left * sin,
            y: from.y + forward * sin + left * cos,
            yaw: yaw + turn,
        };
        near(cycle(from, to).advance(), forward, left, turn);
    }
}

/// A heading is known between −180° and 180° only.
#[test]
fn a_turn_across_the_back_is_the_short_one() {
    let row = cycle(bearing(0.0, 0.0, 3.1), bearing(0.0, 0.0, -3.1));
    let turn = std::f64::consts::TAU - 6.2;
    assert!((row.advance().yaw - turn).abs() < 1e-12);
    let row = cycle(bearing(0.0, 0.0, -3.1), bearing(0.0, 0.0, 3.1));
    assert!((row.advance().yaw + turn).abs() < 1e-12);
}
