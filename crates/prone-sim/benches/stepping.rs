//! Simulated steps per second: our control step against a bare loop over the engine's step.
//!
//! Both run the same model from the same settled state in the same run; the ratio of the two is
//! the figure that counts (goal: ≥ 0.95), the absolute numbers belong to the machine.
fn main() {}
