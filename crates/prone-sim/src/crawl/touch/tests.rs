use super::*;

/// Engine steps of 2 ms, the first pull a second after the first of them.
fn at(step: usize) -> Instant {
    Instant {
        step,
        time: 0.002 * step as f64 - 1.0,
        seconds: 0.002,
    }
}

const HEAD: BodyId = BodyId(3);
const TRUNK: BodyId = BodyId(1);

#[test]
fn touching_again_without_a_step_apart_is_the_same_meeting() {
    let mut touches = Touches::default();
    for step in [501, 502, 503, 505, 506, 510] {
        touches.meet(HEAD, 0, 5.0, at(step));
    }
    let met = touches.finish();
    let [touch] = met[..] else {
        panic!("{met:?}");
    };
    assert_eq!((touch.body, touch.obstacle, touch.count), (HEAD, 0, 3));
    assert!((touch.first - 0.002).abs() < 1e-12, "{touch:?}");
    assert!((touch.seconds - 6.0 * 0.002).abs() < 1e-12, "{touch:?}");
    assert!((touch.peak - 5.0).abs() < f64::EPSILON, "{touch:?}");
}

/// A head that lies against a wall from the first step on has met it.
#[test]
fn limit_a_meeting_in_the_first_step_counts() {
    let mut touches = Touches::default();
    touches.meet(HEAD, 0, 5.0, at(1));
    touches.meet(HEAD, 0, 5.0, at(2));
    assert_eq!(touches.finish()[0].count, 1);
}

#[test]
fn forces_of_one_step_add_up_and_those_of_two_do_not() {
    let mut touches = Touches::default();
    for (step, normal) in [(601, 3.0), (601, 4.0), (602, 6.0), (603, 1.0), (603, 5.0)] {
        touches.meet(HEAD, 0, normal, at(step));
    }
    let touch = touches.finish()[0];
    assert_eq!(touch.count, 1);
    assert!((touch.seconds - 3.0 * 0.002).abs() < 1e-12, "{touch:?}");
    assert!((touch.peak - 7.0).abs() < 1e-12, "{touch:?}");
}

#[test]
fn parts_and_obstacles_are_told_apart_and_in_order() {
    let mut touches = Touches::default();
    touches.meet(HEAD, 1, 2.0, at(701));
    touches.meet(TRUNK, 0, 3.0, at(701));
    touches.meet(HEAD, 0, 4.0, at(702));
    touches.meet(HEAD, 1, 5.0, at(703));
    let met = touches.finish();
    let rows: Vec<_> = met
        .iter()
        .map(|it| (it.body, it.obstacle, it.count, it.peak))
        .collect();
    assert_eq!(
        rows,
        [(TRUNK, 0, 1, 3.0), (HEAD, 0, 1, 4.0), (HEAD, 1, 2, 5.0)]
    );
}
