//! One way to crawl a cycle: as data, and compiled into a world.

use prone::crawl::{Pilot, Straight};
use prone::gait::PhaseDuration;
use prone::gait::cycle::{Cycle, TimeScale};
use prone::motor::{Load, Verdict};
use prone::regime::Regime;
use prone::robot::JointAngles;
use prone::scene::{Scene, SideFriction};
use prone::steering::HeadingHold;
use prone_record::frontier::SettingKind;
use prone_sim::crawl::Crawl;
use prone_sim::driven::LateCommands;
use prone_sim::{LoadedRobot, World, WorldError};

/// What a setting is for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Role {
    /// Its value counts.
    Value,
    /// It has to advance by at least that share of the first setting's advance.
    Keep(f64),
    /// It has to turn to the left by at least that angle a cycle, rad.
    Turn(f64),
    /// Nothing is asked of it; what it does is reported.
    Beside,
}

/// Share of the first setting's advance that a confirmation asks for.
pub const HOLDS: f64 = 0.75;

/// Share of the advance that is left where it turns as hard as it can.
const TURNING: f64 = 0.5;

impl Role {
    /// Share of the first setting's advance that is asked for, where one is.
    pub const fn keep(self) -> Option<f64> {
        match self {
            Self::Keep(share) => Some(share),
            Self::Turn(_) => Some(TURNING),
            Self::Value | Self::Beside => None,
        }
    }
}

/// One way to crawl a cycle, as data: what a worker would be sent.
#[derive(Debug, Clone, PartialEq)]
pub struct SettingSpec {
    /// What it changes.
    pub kind: SettingKind,
    /// Contacts, servos, limits, engine step.
    pub regime: Regime,
    /// Friction by side, in place of the regime's.
    pub friction: Option<SideFriction>,
    /// How slowly.
    pub scale: TimeScale,
    /// How long the pull lasts instead, before the scale.
    pub pull: Option<PhaseDuration>,
    /// What every commanded angle is off by, rad.
    pub offsets: Option<JointAngles>,
    /// How late commands reach the servos, where they do.
    pub late: Option<LateCommands>,
    /// How many cycles; the last one is measured.
    pub cycles: usize,
    /// Turn command, in shares of the cycle's limit; the first pull is straight all the same.
    pub turn: f64,
    /// Whether a cycle that can be steered holds its heading.
    pub held: bool,
    /// What it is for.
    pub role: Role,
}

/// A setting in the engine.
#[derive(Debug, Clone)]
pub struct Setting {
    /// What it is.
    pub spec: SettingSpec,
    /// The robot on its floor.
    pub world: World,
}

impl Setting {
    /// Who steers a cycle in it: the heading is held, where it is to be and the cycle can be steered, or
    /// the setting's share of the cycle's largest turn is commanded.
    pub fn pilot(&self, cycle: &Cycle) -> Box<dyn Pilot> {
        match &cycle.steering {
            Some(steering) if self.spec.held => {
                let gains = self.world.robot().control.steering;
                Box::new(HeadingHold::of(gains, steering))
            }
            steering => {
                let limit = steering.as_ref().map_or(0.0, |steering| steering.limit);
                let turn = self.spec.turn * limit;
                Box::new(Straight { turn })
            }
        }
    }

    /// What a robot's motors would make of a crawl in it; nothing where they are not known.
    pub fn verdict(&self, crawl: &Crawl) -> Option<Verdict> {
        let load = Load {
            robot: self.world.robot(),
            gear_efficiency: self.world.gear_efficiency(),
            effort: &crawl.effort,
            head: crawl.ground.head_peak(),
        };
        Verdict::from_load(&load).ok()
    }
}

impl SettingSpec {
    /// A robot's world for it, on a level floor.
    pub fn compile(self, robot: &LoadedRobot) -> Result<Setting, WorldError> {
        self.compile_in(robot, Scene::level())
    }

    /// A robot's world for it, in a scene; where the setting has a friction by side, it replaces that
    /// of the scene.
    pub fn compile_in(self, robot: &LoadedRobot, mut scene: Scene) -> Result<Setting, WorldError> {
        scene.floor.friction = self.friction.or(scene.floor.friction);
        Ok(Setting {
            world: World::in_scene(robot, self.regime, &scene)?,
            spec: self,
        })
    }
}
