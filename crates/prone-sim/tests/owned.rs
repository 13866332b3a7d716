//! What a client owns can be handed to a thread of its own and stay there. Compiling this file is the
//! test.

use prone::crawl::{Crawler, Program, SlopeAware, Straight, Timing};
use prone::port::{JointCommand, PortError, Senses};
use prone::steering::{HeadingHold, TurnTo};
use prone_sim::crawl::{Crawl, CrawlPlan};
use prone_sim::driven::SimulatedRobot;
use prone_sim::imu::SimulatedImu;
use prone_sim::{LoadedRobot, Simulation, World};

const fn can_be_handed_to_a_thread<T: Send + 'static>() {}

const _: () = {
    can_be_handed_to_a_thread::<LoadedRobot>();
    can_be_handed_to_a_thread::<World>();
    can_be_handed_to_a_thread::<Simulation>();
    can_be_handed_to_a_thread::<SimulatedImu>();
    can_be_handed_to_a_thread::<SimulatedRobot>();
};

const _: () = {
    can_be_handed_to_a_thread::<Program>();
    can_be_handed_to_a_thread::<Timing>();
    can_be_handed_to_a_thread::<Straight>();
    can_be_handed_to_a_thread::<HeadingHold>();
    can_be_handed_to_a_thread::<TurnTo>();
    can_be_handed_to_a_thread::<SlopeAware<HeadingHold>>();
    can_be_handed_to_a_thread::<Crawler<Straight>>();
    can_be_handed_to_a_thread::<Crawler<SlopeAware<HeadingHold>>>();
};

const _: () = {
    can_be_handed_to_a_thread::<CrawlPlan>();
    can_be_handed_to_a_thread::<Crawl>();
    can_be_handed_to_a_thread::<Senses>();
    can_be_handed_to_a_thread::<JointCommand>();
    can_be_handed_to_a_thread::<PortError>();
};
