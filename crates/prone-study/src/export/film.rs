//! A record as pictures that move, ray cast by the engine from recorded poses.
//!
//! Pictures are taken and encoded on all threads of the current rayon pool, a batch at a time, and
//! are put together in their order: the file does not depend on the number of threads.

use glam::DVec3;
use rayon::prelude::*;

use prone::frames::{Ground, Root, Transform};
use prone::robot::Robot;
use prone_sim::camera::{self, Camera, Picture};
use prone_sim::{Snapshot, World};

use prone_record::recorded::Recorded;

use crate::frames::{field_of_view, towards};
use crate::watch::{Progress, Watch};

// Lengths are those at scale 1 of `camera::scale`.

/// Room ahead of and behind the root over the whole way, m: a robot stretched out, and a little.
const MARGIN: f64 = 0.45;

/// Height of the point in the middle of a picture, m.
const MIDDLE: f64 = 0.1;

/// How far away the camera beside the way stands, in widths of what it shows: far, so that it sees
/// all parts of the way from nearly the same side.
const DISTANCE: f64 = 2.5;

/// How far above the horizontal it stands, in the same measure as one to the side: low, so that it
/// sees under a plate.
const RISE: f64 = 0.13;

/// What the camera that follows shows at least, m: a robot stretched out, from a corner.
const FOLLOWED: (f64, f64) = (1.05, 0.6);

/// How long before and after an instant the camera that follows looks for the way, s: a whole cycle
/// together, so that it does not jerk with each pull.
const CALM: f64 = 1.4;

/// Where the camera is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum View {
    /// At the robot's right, where it sees the whole way; it does not move.
    Side,
    /// In the robot's head.
    Eye,
    /// Ahead of the robot at its right, and goes along.
    Follow,
}

/// What is filmed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shot {
    /// From where.
    pub view: View,
    /// Width and height, pixels.
    pub size: (usize, usize),
    /// Pictures per second.
    pub fps: f64,
    /// First and last instant, s.
    pub span_s: (f64, f64),
}

/// A shot of a record.
pub struct Film<'a> {
    world: &'a World,
    record: &'a Recorded,
    shot: Shot,
    /// Pose of the root at each row.
    roots: Vec<Transform<Ground, Root>>,
    /// What the camera that follows looks at, at each row.
    way: Vec<DVec3>,
}

/// Why there is no film.
#[derive(Debug, thiserror::Error)]
pub enum FilmError {
    /// The record is of another robot than the world has.
    #[error(
        "joint {number} of the record is {recorded}, and {own} of the robot: it is of another robot"
    )]
    OtherRobot {
        /// Number of the first joint that differs, from 1.
        number: usize,
        /// Its name in the record; `none` where the record has fewer.
        recorded: String,
        /// Its name in the robot.
        own: String,
    },
    /// The record does not say where the robot is at every instant.
    #[error("{what} was not recorded at {time_s:.2} s: that cannot be filmed")]
    Unrecorded {
        /// A joint's angle, or the root's pose.
        what: String,
        /// The first such instant, s.
        time_s: f64,
    },
    /// The model has no camera.
    #[error("{robot} has no camera in its model: there is no view from its eye")]
    NoEye {
        /// The robot's name.
        robot: String,
    },
}

/// What ended a film before it was done.
#[derive(Debug)]
pub enum Interrupted<E> {
    /// The user.
    Stopped,
    /// The encoder.
    Failed(E),
}

/// Puts pictures together.
pub trait Reel {
    /// A picture, encoded.
    type Frame: Send;
    /// Why it cannot be.
    type Error: Send;

    /// Encodes a picture that follows another, on any thread.
    fn frame(before: Option<&Picture>, now: &Picture) -> Result<Self::Frame, Self::Error>;

    /// Appends a picture.
    fn take(&mut self, frame: Self::Frame) -> Result<(), Self::Error>;
}

impl<'a> Film<'a> {
    /// Prepares a shot.
    pub fn new(world: &'a World, record: &'a Recorded, shot: Shot) -> Result<Self, FilmError> {
        check_joints(world.robot(), &record.joints)?;
        if let Some((joint, time_s)) = record.missing_angle() {
            let what = format!("the angle of {joint}");
            return Err(FilmError::Unrecorded { what, time_s });
        }
        let roots = record.rows.iter().map(|row| {
            row.ground_from_root.ok_or_else(|| FilmError::Unrecorded {
                what: "the pose of the root".to_owned(),
                time_s: row.time_s,
            })
        });
        let roots = roots.collect::<Result<Vec<_>, _>>()?;
        let film = Self {
            world,
            record,
            shot,
            way: calm_way(record, &roots),
            roots,
        };
        if shot.view == View::Eye && Camera::eye(&world.at(&film.snapshot(0.0))).is_none() {
            return Err(FilmError::NoEye {
                robot: world.robot().name.clone(),
            });
        }
        Ok(film)
    }

    /// How many pictures there are: from the first instant on, up to the last.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "some thousand pictures"
    )]
    pub fn len(&self) -> usize {
        let (from, to) = self.shot.span_s;
        // Instants have four decimals; half of the last is not a reason to miss one.
        ((to - from).max(0.0) * self.shot.fps + 1e-4).floor() as usize + 1
    }

    /// Whether there is no picture; there always is one.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Takes one picture, by its number from 0.
    pub fn picture(&self, number: usize) -> Picture {
        let time = self.shot.span_s.0 + number as f64 / self.shot.fps;
        let mut data = self.world.at(&self.snapshot(time));
        let camera = match self.shot.view {
            View::Side => self.beside(),
            View::Follow => self.along(time),
            // There is one: `new` has looked.
            View::Eye => Camera::eye(&data).unwrap_or_else(|| self.along(time)),
        };
        camera::ray_cast(&mut data, &camera, self.shot.size)
    }

    /// Takes all pictures and puts them on a reel.
    pub fn shoot<R: Reel>(
        &self,
        reel: &mut R,
        watch: &dyn Watch,
    ) -> Result<(), Interrupted<R::Error>> {
        /// Pictures of a batch for each thread: enough that none waits long for the others.
        const PER_THREAD: usize = 2;
        let batch = PER_THREAD * rayon::current_num_threads();
        let mut before: Option<Picture> = None;
        for first in (0..self.len()).step_by(batch) {
            if watch.stop() {
                return Err(Interrupted::Stopped);
            }
            let numbers = first..self.len().min(first + batch);
            let picture = |number| (!watch.stop()).then(|| self.picture(number));
            let pictures = numbers.into_par_iter().map(picture);
            let Some(pictures) = pictures.collect::<Option<Vec<Picture>>>() else {
                return Err(Interrupted::Stopped);
            };
            let frames: Vec<Result<R::Frame, R::Error>> = (0..pictures.len())
                .into_par_iter()
                .map(|index| {
                    let earlier = index.checked_sub(1).map(|earlier| &pictures[earlier]);
                    R::frame(earlier.or(before.as_ref()), &pictures[index])
                })
                .collect();
            for frame in frames {
                frame
                    .and_then(|frame| reel.take(frame))
                    .map_err(Interrupted::Failed)?;
            }
            watch.progress(&Progress::Done(pictures.len()));
            before = pictures.into_iter().next_back();
        }
        Ok(())
    }

    /// The position at an instant, between two rows if need be.
    fn snapshot(&self, time_s: f64) -> Snapshot {
        let rows = &self.record.rows;
        let after = rows
            .partition_point(|row| row.time_s < time_s)
            .min(rows.len() - 1);
        let before = after.saturating_sub(1);
        let (from, to) = (self.roots[before], self.roots[after]);
        let (before, after) = (&rows[before], &rows[after]);
        let seconds = after.time_s - before.time_s;
        let share = if seconds > 0.0 {
            ((time_s - before.time_s) / seconds).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let root = Transform::new(
            from.rotation().slerp(to.rotation(), share).normalize(),
            from.origin().metres().lerp(to.origin().metres(), share),
        );
        Snapshot::new(root, &before.angles.towards(&after.angles, share))
    }

    /// Sees the whole way from the right.
    fn beside(&self) -> Camera {
        let roots = self.roots.iter().map(|root| root.origin().metres());
        let (low, high) = roots.fold(
            (DVec3::INFINITY, DVec3::NEG_INFINITY),
            |(low, high), root| (low.min(root), high.max(root)),
        );
        let scale = camera::scale(self.world.robot());
        let width = high.x - low.x + 2.0 * MARGIN * scale;
        let middle = low.midpoint(high);
        let target = DVec3::new(middle.x, middle.y, MIDDLE * scale);
        let distance = DISTANCE * width;
        let (columns, rows) = self.shot.size;
        let height = width * rows as f64 / columns as f64;
        towards(target, DVec3::new(0.0, -1.0, RISE), distance, height)
    }

    /// Goes along.
    fn along(&self, time_s: f64) -> Camera {
        let rows = &self.record.rows;
        let near = rows
            .partition_point(|row| row.time_s < time_s)
            .min(rows.len() - 1);
        let mut target = self.way[near];
        let scale = camera::scale(self.world.robot());
        target.z = MIDDLE * scale;
        let (width, height) = (FOLLOWED.0 * scale, FOLLOWED.1 * scale);
        let (columns, rows) = self.shot.size;
        let height = height.max(width * rows as f64 / columns as f64);
        let camera = Camera::three_quarter(target, scale);
        Camera {
            vertical_fov: field_of_view(height, camera.position.distance(target)),
            ..camera
        }
    }
}

/// Checks that a record has the joints of a robot, in their order.
fn check_joints(robot: &Robot, joints: &[String]) -> Result<(), FilmError> {
    let name = |name: Option<&String>| name.map_or("none", String::as_str).to_owned();
    for index in 0..robot.joints.len().max(joints.len()) {
        let own = robot.joints.get(index).map(|joint| &joint.name);
        let recorded = joints.get(index);
        if own != recorded {
            return Err(FilmError::OtherRobot {
                number: index + 1,
                recorded: name(recorded),
                own: name(own),
            });
        }
    }
    Ok(())
}

/// Where the root is at each row, averaged over [`CALM`] before and after it, as far as the record
/// reaches to both sides.
fn calm_way(record: &Recorded, roots: &[Transform<Ground, Root>]) -> Vec<DVec3> {
    let rows = &record.rows;
    let mut sums = vec![DVec3::ZERO];
    for root in roots {
        let sum = sums[sums.len() - 1] + root.origin().metres();
        sums.push(sum);
    }
    let (begin, end) = record.span_s();
    let way = rows.iter().map(|row| {
        let reach = CALM.min(row.time_s - begin).min(end - row.time_s);
        let first = rows.partition_point(|other| other.time_s < row.time_s - reach - 1e-6);
        let last = rows.partition_point(|other| other.time_s <= row.time_s + reach + 1e-6);
        (sums[last] - sums[first]) / (last - first).max(1) as f64
    });
    way.collect()
}

/// Tells each picture's time in whole ticks without drifting from the true rate.
#[derive(Debug, Clone)]
pub struct Clock {
    ticks_per_picture: f64,
    pictures: usize,
    told: usize,
}

impl Clock {
    /// For so many pictures and so many ticks per second.
    pub fn new(fps: f64, ticks: f64) -> Self {
        Self {
            ticks_per_picture: ticks / fps,
            pictures: 0,
            told: 0,
        }
    }

    /// How many ticks the next picture is shown.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "some thousand ticks"
    )]
    pub fn tell(&mut self) -> usize {
        self.pictures += 1;
        let end = (self.pictures as f64 * self.ticks_per_picture).round() as usize;
        let ticks = end - self.told;
        self.told = end;
        ticks
    }
}

#[cfg(test)]
mod tests {
    use prone_files::compiled_robot::CompiledRobot;
    use prone_files::shipped;

    use super::{Clock, check_joints};

    #[test]
    fn a_record_of_another_robot_is_refused_by_the_first_joint_that_differs() {
        let robot = CompiledRobot::shipped(&shipped::NAO).unwrap().into_robot();
        let own = robot.joints.iter().map(|joint| joint.name.clone());
        let mut joints: Vec<String> = own.collect();
        assert!(check_joints(&robot, &joints).is_ok());
        let said = |joints: &[String]| check_joints(&robot, joints).unwrap_err().to_string();
        let last = joints.pop().unwrap();
        let fewer = format!(
            "joint {} of the record is none, and {last} ",
            joints.len() + 1
        );
        assert!(said(&joints).starts_with(&fewer), "{}", said(&joints));
        joints.swap(0, 1);
        assert_eq!(
            said(&joints),
            "joint 1 of the record is HeadPitch, and HeadYaw of the robot: it is of another robot"
        );
    }

    #[test]
    fn a_clock_does_not_drift() {
        let mut clock = Clock::new(30.0, 100.0);
        let ticks: Vec<usize> = (0..30).map(|_| clock.tell()).collect();
        assert_eq!(ticks.iter().sum::<usize>(), 100);
        assert_eq!(ticks[..3], [3, 4, 3]);
    }
}
