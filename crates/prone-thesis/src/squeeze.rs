//! What the internal squeeze of the planted chain does to torques and costs.
//!
//! Toes and elbows may press the chain between them: the ground pushes each foot forward with S and
//! each elbow back with S (S > 0 presses together, N a side). Weight does not decide S, friction
//! does. Seen from the side, z is the height of a joint's centre above the floor, where these forces
//! act, and `a_y` = ±1 the direction of its pitch axis. The moment about y of a force `F_x` at the
//! floor is −z `F_x`, so that one newton a side adds, in the sign of the recordings (the moment of
//! what lies beyond the joint, [`prone::statics`]),
//!
//! ```text
//! e_j = −a_y z_j   at ankle, knee and hip, beyond which the toe lies           (1)
//! e_s = +a_y z_s   at the shoulder, beyond which the elbow lies                (2)
//! τ_j(S) = τ_j(0) + S e_j                                                      (3)
//! ```
//!
//! z is that of the posture which our simulation measured, laid on the floor. Our S is measured at
//! the contacts. That of a published pull is found by least squares over its four torques p against
//! our τ, in each tenth of the pull (one unknown, four equations):
//!
//! ```text
//! S_pub = S + Σ_j (p_j − τ_j) e_j / Σ_j e_j²                                   (4)
//! ```
//!
//! So (4) also takes in what else differs along e, as masses do. The rate r of a cost is the mean of
//! `Σ τ_j²` over the tenths; with τ(0) of (3) it is the rate without squeeze, and
//!
//! ```text
//! d ln r / dS at S = 0 = 2 Σ τ_j(0) e_j / Σ τ_j(0)²                            (5)
//! ```
//!
//! Compared are the tenths from [`FROM_PERCENT`] on that begin after toes and elbows have taken
//! over from the belly, in every gait of that duration.

use serde::{Deserialize, Serialize};

use prone::robot::Mirror;
use prone::robot::{ContactGroup, JointAngles, Robot};
use prone::statics::{self, Footing, HalfRobot, RestError, Stance, SupportRule};
use prone_record::contact_story;
use prone_record::pulls::{PullRecord, PullRow};

use crate::agreement::{FROM_PERCENT, TENTHS, tenth_means};
use crate::published::{self, TorqueBin};

/// The squeeze of one pull, ours and the published one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Squeeze {
    /// Name of the gait.
    pub gait: String,
    /// Duration of the pull, s.
    pub duration_s: f64,
    /// From where on it is compared, percent of the pull.
    pub from_percent: f64,
    /// What one newton a side adds to each torque, N·m, mean; in the order of
    /// [`prone_record::pulls::JOINTS`].
    pub effect_nm: [f64; 4],
    /// What one newton a side does to the rate of cost by (5), percent.
    pub effect_percent: f64,
    /// In our simulation.
    pub ours: Squeezed,
    /// In the published recordings, where there are some.
    pub published: Option<Squeezed>,
    /// Root mean square of published less ours over the four joints, N·m.
    pub rms_nm: Option<f64>,
    /// The same when ours has the squeeze of the published one.
    pub rms_with_its_squeeze_nm: Option<f64>,
}

/// A pull with its squeeze and without.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Squeezed {
    /// Mean squeeze, N a side.
    pub squeeze_n: f64,
    /// Mean of Σ τ², N²·m².
    pub rate_n2m2: f64,
    /// The same without the squeeze.
    pub rate_without_n2m2: f64,
}

/// Optimal over nominal, by rates of cost.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SqueezeRatio {
    /// Duration of the pulls, s.
    pub duration_s: f64,
    /// In our simulation.
    pub ours: f64,
    /// The same without the squeeze.
    pub ours_without: f64,
    /// In the published recordings.
    pub published: Option<f64>,
    /// The same without the squeeze.
    pub published_without: Option<f64>,
}

/// Our means over one tenth of a pull, and the published torques there.
struct Tenth {
    torque: [f64; 4],
    squeeze: f64,
    effect: [f64; 4],
    published: Option<[f64; 4]>,
}

/// What lays a robot's recorded postures on the floor.
struct Floor<'r> {
    robot: &'r Robot,
    half: HalfRobot,
    mirror: Mirror,
}

/// The squeeze of every pull in which toes and elbows come to carry the body; none of a robot whose
/// sides do not mirror each other, for which the statics has no posture on the floor.
pub fn of(robot: &Robot, pulls: &[PullRecord], bins: &[TorqueBin]) -> Vec<Squeeze> {
    let Ok(half) = HalfRobot::from_robot(robot) else {
        return Vec::new();
    };
    let floor = Floor {
        robot,
        half,
        mirror: Mirror::of(robot),
    };
    let of_pulls = pulls.iter().map(|pull| {
        // Gaits of one duration are held against one another, so all have the window of the last.
        let of_duration = pulls
            .iter()
            .filter(|other| (other.duration_s - pull.duration_s).abs() < 1e-9);
        let first = of_duration.map(first_tenth).max()?;
        of_pull(&floor, pull, first, bins)
    });
    of_pulls.flatten().collect()
}

/// The first tenth that begins after toes and elbows have taken over, or past the last where they do
/// not.
fn first_tenth(pull: &PullRecord) -> usize {
    match contact_story::of(pull).carried_from_percent {
        Some(carried_from) => tenth_from(carried_from.max(FROM_PERCENT)),
        None => TENTHS,
    }
}

fn of_pull(
    floor: &Floor<'_>,
    pull: &PullRecord,
    first: usize,
    bins: &[TorqueBin],
) -> Option<Squeeze> {
    let effects: Vec<Option<[f64; 4]>> = pull.rows.iter().map(|row| floor.effect(row)).collect();
    let torque = tenth_means(pull, |_, row| Some(row.torque_nm));
    let squeeze = tenth_means(pull, |_, row| Some([row.squeeze_n]));
    let effect = tenth_means(pull, |index, _| effects[index]);
    let mut tenths = Vec::new();
    for tenth in first..TENTHS {
        let from_percent = 10.0 * tenth as f64;
        let bin = bins.iter().find(|bin| {
            bin.gait == pull.gait
                && (bin.duration_s - pull.duration_s).abs() < 1e-9
                && (bin.from_percent - from_percent).abs() < 1e-9
        });
        tenths.push(Tenth {
            torque: torque[tenth]?,
            squeeze: squeeze[tenth]?[0],
            effect: effect[tenth]?,
            published: bin.map(TorqueBin::torques),
        });
    }
    (!tenths.is_empty()).then(|| gathered(pull, 10.0 * first as f64, &tenths))
}

fn gathered(pull: &PullRecord, from_percent: f64, tenths: &[Tenth]) -> Squeeze {
    let ours: Vec<_> = tenths.iter().map(|it| (it.torque, it.squeeze)).collect();
    let theirs: Option<Vec<_>> = tenths
        .iter()
        .map(|it| Some((it.published?, it.published_squeeze()?)))
        .collect();
    let mut effect_nm = [0.0; 4];
    let (mut slope, mut square) = (0.0, 0.0);
    for tenth in tenths {
        let free = less(tenth.torque, tenth.squeeze, tenth.effect);
        slope += 2.0 * dot(free, tenth.effect);
        square += dot(free, free);
        for (mean, effect) in effect_nm.iter_mut().zip(tenth.effect) {
            *mean += effect / tenths.len() as f64;
        }
    }
    let published = theirs.as_deref().map(|theirs| squeezed(theirs, tenths));
    // What the published torques differ by, and what of that S_pub − S does not explain.
    let apart = |explained: bool| {
        let squares = theirs.as_deref()?.iter().zip(tenths).map(|(theirs, ours)| {
            let difference = less(theirs.0, 1.0, ours.torque);
            let by = if explained {
                theirs.1 - ours.squeeze
            } else {
                0.0
            };
            let rest = less(difference, by, ours.effect);
            dot(rest, rest)
        });
        Some((squares.sum::<f64>() / (4 * tenths.len()) as f64).sqrt())
    };
    Squeeze {
        gait: pull.gait.clone(),
        duration_s: pull.duration_s,
        from_percent,
        effect_nm,
        effect_percent: 100.0 * slope / square,
        ours: squeezed(&ours, tenths),
        published,
        rms_nm: apart(false),
        rms_with_its_squeeze_nm: apart(true),
    }
}

/// Means over tenths of torques with a squeeze, with the effects of our postures.
fn squeezed(torques: &[([f64; 4], f64)], tenths: &[Tenth]) -> Squeezed {
    let count = tenths.len() as f64;
    let mean = |value: &dyn Fn(&[f64; 4], f64, &Tenth) -> f64| {
        let values = torques.iter().zip(tenths);
        let values = values.map(|((torque, squeeze), tenth)| value(torque, *squeeze, tenth));
        values.sum::<f64>() / count
    };
    Squeezed {
        squeeze_n: mean(&|_, squeeze, _| squeeze),
        rate_n2m2: mean(&|&torque, _, _| dot(torque, torque)),
        rate_without_n2m2: mean(&|&torque, squeeze, tenth| {
            let free = less(torque, squeeze, tenth.effect);
            dot(free, free)
        }),
    }
}

/// Optimal over nominal of every duration, over the tenths that are compared.
pub fn ratios(squeezes: &[Squeeze]) -> Vec<SqueezeRatio> {
    let of = |gait: &'static str| squeezes.iter().filter(move |it| it.gait == gait);
    let ratios = of(published::NOMINAL).filter_map(|nominal| {
        let same = |it: &&Squeeze| (it.duration_s - nominal.duration_s).abs() < 1e-9;
        let optimal = of(published::OPTIMAL).find(same)?;
        let theirs = optimal.published.zip(nominal.published);
        Some(SqueezeRatio {
            duration_s: nominal.duration_s,
            ours: optimal.ours.rate_n2m2 / nominal.ours.rate_n2m2,
            ours_without: optimal.ours.rate_without_n2m2 / nominal.ours.rate_without_n2m2,
            published: theirs.map(|(optimal, nominal)| optimal.rate_n2m2 / nominal.rate_n2m2),
            published_without: theirs
                .map(|(optimal, nominal)| optimal.rate_without_n2m2 / nominal.rate_without_n2m2),
        })
    });
    ratios.collect()
}

impl Tenth {
    /// Equation (4).
    fn published_squeeze(&self) -> Option<f64> {
        let difference = less(self.published?, 1.0, self.torque);
        Some(self.squeeze + dot(difference, self.effect) / dot(self.effect, self.effect))
    }
}

impl Floor<'_> {
    /// Equations (1) and (2) in the posture of a row; `None` where it does not rest on toes and arms.
    fn effect(&self, row: &PullRow) -> Option<[f64; 4]> {
        self.effect_in(&self.posture(row)).ok().flatten()
    }

    /// The recorded right side's angles on both sides.
    fn posture(&self, row: &PullRow) -> JointAngles {
        let mut right = JointAngles::zero(self.robot);
        let joints = self.robot.chain.right.commanded_joints();
        for (joint, angle) in joints.into_iter().zip(row.angle_rad) {
            right[joint] = angle;
        }
        let mut both = self.mirror.posture(&right);
        for joint in joints {
            both[joint] = right[joint];
        }
        both
    }

    fn effect_in(&self, posture: &JointAngles) -> Result<Option<[f64; 4]>, RestError> {
        // The give of the elbow's servos leaves the load at the elbow, not along the forearm.
        let stance = Stance::unsqueezed(SupportRule::ElbowNotHand);
        let rest = statics::rest(self.robot, &self.half, posture, stance)?;
        let planted = matches!(rest.footing, Footing::Two { rear, front }
            if rear.group == ContactGroup::Toe && front.group.is_front());
        if !planted {
            return Ok(None);
        }
        let poses = self
            .robot
            .forward_kinematics(rest.ground_from_root, posture);
        let mut sign = [-1.0, -1.0, -1.0, 1.0].into_iter();
        let joints = self.robot.chain.right.pitch_joints();
        Ok(Some(joints.map(|joint| {
            let joint = &self.robot.joints[joint.0];
            sign.next().unwrap_or_default() * poses.axis(joint).y * poses.anchor(joint).z()
        })))
    }
}

/// The first tenth that begins at or after a percentage.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "percent is between 0 and 100; the cast saturates otherwise"
)]
fn tenth_from(percent: f64) -> usize {
    (percent / 10.0).ceil() as usize
}

fn dot(a: [f64; 4], b: [f64; 4]) -> f64 {
    a.into_iter().zip(b).map(|(a, b)| a * b).sum()
}

/// a − share · b.
fn less(a: [f64; 4], share: f64, b: [f64; 4]) -> [f64; 4] {
    std::array::from_fn(|joint| a[joint] - share * b[joint])
}

#[cfg(test)]
mod tests;
