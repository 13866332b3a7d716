//! Figures 22, 23 and 28: the robot before its first pull, under what it crawls under, and on its way
//! from before to past that, one instant below the other.

use glam::DVec3;
use rayon::prelude::*;

use prone::scene::ObstacleKind;
use prone_sim::camera::{self, Picture};
use prone_sim::crawl::{Crawl, Row};
use prone_sim::{Snapshot, World};

use crate::frames::{Frames, FramesError, stacked, towards, unless};
use crate::watch::Watch;
use prone_report::figures::Figure;

/// How many instants are shown.
const INSTANTS: usize = 6;

/// Width of a frame, pixels.
const WIDTH: usize = 1200;

// Lengths are those at scale 1 of `camera::scale`.

/// Room ahead of and behind the root over the whole way, m: a robot stretched out, and a little.
const BEHIND: f64 = 0.45;
const AHEAD: f64 = 0.45;

/// What a frame shows above and below its middle together, m: somewhat more than the thesis' table.
const HEIGHT: f64 = 0.5;

/// Height of the point in the middle of a frame, m.
const MIDDLE: f64 = 0.16;

/// One robot: pixels, width shown, m, and height of the point in the middle, m.
const SIZE_CLOSE: (usize, usize) = (960, 420);
const WIDTH_CLOSE: f64 = 1.12;
const MIDDLE_CLOSE: f64 = 0.1;
/// Where the camera stands, seen from the robot: low enough to see under a plate, and so that the leg of
/// a table, which is at the robot's hands at the start and at its trunk when it is below the panel, does
/// not hide it.
const FROM_BEHIND: DVec3 = DVec3::new(-0.5, -1.0, 0.25);
const FROM_AHEAD: DVec3 = DVec3::new(0.8, -1.0, 0.22);

/// How near to an obstacle's middle the root must come to be under it, m: less than a cycle.
const NEAR: f64 = 0.1;

/// How far away the camera stands, in widths of what it shows: far, so that it sees all parts of
/// the way from nearly the same side.
const DISTANCE: f64 = 2.5;

/// How far above the horizontal, in the same measure as one to the side: low, so that it sees
/// under the plate.
const RISE: f64 = 0.13;

/// All pictures of a crawl with rows.
pub fn all(
    world: &World,
    gait: &str,
    crawl: &Crawl,
    watch: &dyn Watch,
) -> Result<Vec<Frames>, FramesError> {
    let mut pictures: Vec<Frames> = start(world, gait, crawl, watch)?.into_iter().collect();
    pictures.extend(on_its_way(world, gait, crawl, watch)?);
    Ok(pictures)
}

/// The pictures of a crawl with rows but that of its start.
pub fn on_its_way(
    world: &World,
    gait: &str,
    crawl: &Crawl,
    watch: &dyn Watch,
) -> Result<Vec<Frames>, FramesError> {
    let pictures = [
        under(world, gait, crawl, watch)?,
        sequence(world, gait, crawl, watch)?,
    ];
    Ok(pictures.into_iter().flatten().collect())
}

/// Figure 22: the first row.
fn start(
    world: &World,
    gait: &str,
    crawl: &Crawl,
    watch: &dyn Watch,
) -> Result<Option<Frames>, FramesError> {
    let Some((first, snapshot)) = crawl.rows.first().zip(crawl.snapshots.first()) else {
        return Ok(None);
    };
    let figure = Figure {
        stem: format!("fig-22-{gait}-start"),
        number: "22",
        title: format!("The simulated robot at the start, {gait}"),
        caption: format!(
            "The robot {:.2} s into its first pull with {gait}, ray cast from our simulation: the \
             arms reach forward, and the floor still carries the trunk. Lines on the floor are \
             100 mm apart, heavy ones 500 mm.",
            first.time
        ),
        alt: "The simulated robot from its right and behind, prone, legs behind it, arms ahead."
            .to_owned(),
        svg: String::new(),
    };
    let picture = unless(watch, || close(world, first, snapshot, FROM_BEHIND))?;
    Ok(Some(stacked(&[picture], &[String::new()], figure)?))
}

/// Figure 23: the row nearest to the middle of the first panel or, without one, plate; nothing
/// where the robot never gets there.
fn under(
    world: &World,
    gait: &str,
    crawl: &Crawl,
    watch: &dyn Watch,
) -> Result<Option<Frames>, FramesError> {
    let of_kind = |kind| {
        world
            .obstacles()
            .iter()
            .find(|obstacle| obstacle.kind == kind)
    };
    let obstacle = of_kind(ObstacleKind::Panel).or_else(|| of_kind(ObstacleKind::Plate));
    let Some(obstacle) = obstacle else {
        return Ok(None);
    };
    let middle = obstacle.ground_from_box.origin().metres();
    let away = |row: &Row| (row.ground_from_root.origin().x() - middle.x).abs();
    let rows = crawl.rows.iter().zip(&crawl.snapshots);
    let nearest = rows.min_by(|a, b| away(a.0).total_cmp(&away(b.0)));
    let Some((row, snapshot)) =
        nearest.filter(|(row, _)| away(row) <= NEAR * camera::scale(world.robot()))
    else {
        return Ok(None);
    };
    let ceiling_mm = (middle.z - obstacle.half_edges.z) * 1e3;
    let tops = row.tops.0.iter().map(|top| top * 1e3);
    let top_mm = tops.fold(f64::NEG_INFINITY, f64::max);
    let kind = obstacle.kind.name();
    let figure = Figure {
        stem: format!("fig-23-{gait}-under"),
        number: "23",
        title: format!("The simulated robot under the {kind}, {gait}"),
        caption: format!(
            "The robot {:.1} s into its crawl with {gait}, ray cast from our simulation, at the {kind} \
             whose lower edge is {ceiling_mm:.0} mm above the floor; at this instant its highest \
             point is at {top_mm:.0} mm. Plates and panels are drawn as glass.",
            row.time
        ),
        alt: format!(
            "The simulated robot from its right and ahead, prone below the {kind}, whose lower edge is \
             {ceiling_mm:.0} millimetres above the floor."
        ),
        svg: String::new(),
    };
    let picture = unless(watch, || close(world, row, snapshot, FROM_AHEAD))?;
    Ok(Some(stacked(&[picture], &[String::new()], figure)?))
}

/// One robot, from its right and low.
fn close(world: &World, row: &Row, snapshot: &Snapshot, from: DVec3) -> Picture {
    let scale = camera::scale(world.robot());
    let root = row.ground_from_root.origin().metres();
    let target = DVec3::new(root.x, root.y, MIDDLE_CLOSE * scale);
    let shown = WIDTH_CLOSE * scale;
    let distance = DISTANCE * shown;
    let (width, height) = SIZE_CLOSE;
    let shown = shown * height as f64 / width as f64;
    let camera = towards(target, from, distance, shown);
    camera::ray_cast(&mut world.at(snapshot), &camera, SIZE_CLOSE)
}

/// Rows spread over the cycles, each a sixth of a cycle further in its own: spread over the time
/// alone they would show one posture again and again where a crawl has five cycles.
fn instants(crawl: &Crawl) -> Vec<usize> {
    let cycles = crawl.rows.last().map_or(0, |last| last.cycle + 1);
    let of_cycle = |cycle: usize| {
        let begin = crawl.rows.partition_point(|row| row.cycle < cycle);
        (begin, crawl.rows.partition_point(|row| row.cycle <= cycle))
    };
    let count = INSTANTS.min(crawl.rows.len());
    let mut instants: Vec<usize> = (0..count)
        .map(|index| {
            let cycle = index * cycles.saturating_sub(1) / (count - 1).max(1);
            let (begin, end) = of_cycle(cycle);
            begin + index * (end - begin) / count
        })
        .collect();
    instants.sort_unstable();
    instants.dedup();
    instants
}

/// Takes the pictures from the robot's right with a camera that stays where it is; nothing without
/// rows.
fn sequence(
    world: &World,
    gait: &str,
    crawl: &Crawl,
    watch: &dyn Watch,
) -> Result<Option<Frames>, FramesError> {
    let (Some(first), Some(last)) = (crawl.rows.first(), crawl.rows.last()) else {
        return Ok(None);
    };
    let xs = crawl
        .rows
        .iter()
        .map(|row| row.ground_from_root.origin().x());
    let (low, high) = xs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (low.min(x), high.max(x))
    });
    let scale = camera::scale(world.robot());
    let (low, high) = (low - BEHIND * scale, high + AHEAD * scale);
    let width = high - low;
    let y = f64::midpoint(
        first.ground_from_root.origin().metres().y,
        last.ground_from_root.origin().metres().y,
    );
    let target = DVec3::new(f64::midpoint(low, high), y, MIDDLE * scale);
    let direction = DVec3::new(0.0, -1.0, RISE);
    let height = HEIGHT * scale;
    let distance = DISTANCE * width;
    let camera = towards(target, direction, distance, height);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "some hundred pixels"
    )]
    let size = (WIDTH, (WIDTH as f64 * height / width).round() as usize);
    let instants = instants(crawl);
    let count = instants.len();
    let picture = |index: usize| {
        let snapshot = &crawl.snapshots[index];
        unless(watch, || {
            camera::ray_cast(&mut world.at(snapshot), &camera, size)
        })
    };
    let pictures = instants.par_iter().map(|&index| picture(index));
    let pictures: Vec<Picture> = pictures.collect::<Result<_, FramesError>>()?;
    let labels: Vec<String> = instants
        .iter()
        .map(|&index| {
            let row = &crawl.rows[index];
            format!("{:.1} s, cycle {}", row.time, row.cycle + 1)
        })
        .collect();
    let scene = &world.scene().name;
    let said = labels.join("; ");
    let figure = Figure {
        stem: format!("fig-28-{gait}-sequence"),
        number: "28",
        title: format!("The simulated robot, {gait}, scene {scene}"),
        caption: format!(
            "The robot at {said} (top to bottom) of a crawl of {} cycles with {gait}, ray cast from \
             our simulation. It crawls to the right; plates and panels are drawn as glass, lines on \
             the floor are 100 mm apart, heavy ones 500 mm. The camera does not move.",
            crawl.cycles.len()
        ),
        alt: format!(
            "{count} pictures of the simulated robot crawling to the right on its belly, at {said}."
        ),
        svg: String::new(),
    };
    Ok(Some(stacked(&pictures, &labels, figure)?))
}

#[cfg(test)]
mod tests {
    use prone::crawl::Straight;
    use prone::gait::cycle::TimeScale;
    use prone::regime::Regime;
    use prone_files::shipped;
    use prone_sim::crawl::{self, CrawlPlan, Detail, End, OnTouch};
    use prone_sim::{LoadedRobot, RobotFiles};

    use super::*;

    /// Five cycles from end to end, and never the same posture: evenly in time it would be.
    #[test]
    fn frames_are_of_different_postures() {
        let robot = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
        let world = World::new(&robot, Regime::LOCOMOTION).unwrap();
        let plan = CrawlPlan {
            cycles: vec![shipped::cycle("hip-10").unwrap().unwrap()],
            scale: TimeScale::ONE,
            end: End::Cycles(5),
            offsets: None,
            late: None,
            imu_seed: None,
            on_touch: OnTouch::GoOn,
            detail: Detail::Rows,
        };
        let crawl = crawl::run(&world, &plan, Straight { turn: 0.0 }).unwrap();
        let shown = instants(&crawl);
        assert_eq!(shown.len(), INSTANTS);
        let rows: Vec<&Row> = shown.iter().map(|&index| &crawl.rows[index]).collect();
        assert_eq!((rows[0].cycle, rows[INSTANTS - 1].cycle), (0, 4));
        for (index, row) in rows.iter().enumerate() {
            for other in &rows[..index] {
                let pairs = row.angles.as_slice().iter().zip(other.angles.as_slice());
                let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(
                    apart > 0.1,
                    "{} s and {} s: {apart} rad",
                    row.time,
                    other.time
                );
            }
        }
    }
}
