//! Mutants of `compiled-robot`, see docs/fuzzing.md.
#![no_main]

use prone_fuzz::Target;
use prone_mutants::Format;

static TARGET: Target = Target::new(Format::CompiledRobot);

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| TARGET.read(bytes));

libfuzzer_sys::fuzz_mutator!(|data: &mut [u8], size: usize, largest: usize, seed: u32| {
    prone_fuzz::mutate(Format::CompiledRobot, data, size, largest, seed)
});
