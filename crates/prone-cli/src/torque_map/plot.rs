//! `prone torque-map plot`.

use crate::Failure;
use crate::args::PlotArgs;

pub(super) fn run(_args: &PlotArgs) -> Result<(), Failure> {
    Err(Failure::Stopped)
}
