//! Mutants of `scene`, see docs/fuzzing.md.
#![no_main]

use prone_fuzz::Target;
use prone_mutants::Format;

static TARGET: Target = Target::new(Format::Scene);

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| TARGET.read(bytes));

libfuzzer_sys::fuzz_mutator!(|data: &mut [u8], size: usize, largest: usize, seed: u32| {
    prone_fuzz::mutate(Format::Scene, data, size, largest, seed)
});
