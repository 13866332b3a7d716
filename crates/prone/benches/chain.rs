//! Time of one closed-chain solve. Reference of the same run: one `sin_cos` of the same input.

use std::hint::black_box;

use prone::chain::{ClosedChain, GaitParameters};

fn main() {
    divan::main();
}

const CHAIN: ClosedChain = ClosedChain {
    toe_to_ankle: 0.103_847,
    ankle_to_knee: 0.1029,
    knee_to_hip: 0.1,
    hip_to_shoulder: 0.1885,
    shoulder_to_elbow: 0.08975,
    span: 0.43,
};

const PARAMETERS: GaitParameters = GaitParameters {
    knee: 0.287_98,
    hip: 0.479_97,
    upper_arm: -0.9,
};

#[divan::bench(sample_count = 500, sample_size = 1000)]
fn close(bencher: divan::Bencher) {
    bencher.bench(|| CHAIN.close(black_box(PARAMETERS)));
}

#[divan::bench(sample_count = 500, sample_size = 1000)]
fn posture(bencher: divan::Bencher) {
    let angles = CHAIN
        .close(PARAMETERS)
        .expect("a posture of the published gait");
    bencher.bench(|| CHAIN.posture(black_box(&angles)));
}

#[divan::bench(sample_count = 500, sample_size = 1000)]
fn reference_sin_cos(bencher: divan::Bencher) {
    bencher.bench(|| black_box(PARAMETERS.upper_arm).sin_cos());
}
