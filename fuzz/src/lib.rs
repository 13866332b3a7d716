//! What every target does: a text of its format is read, and what cannot be right ends the fuzzer.

use std::cell::OnceCell;
use std::sync::Mutex;

use prone_mutants::Format;
use prone_mutants::reading::Reader;

/// One target of one format.
pub struct Target {
    format: Format,
    reader: Mutex<OnceCell<Reader>>,
}

impl Target {
    /// Nothing is read yet.
    pub const fn new(format: Format) -> Self {
        Self {
            format,
            reader: Mutex::new(OnceCell::new()),
        }
    }

    /// Reads what the fuzzer made; every reader takes texts.
    pub fn read(&self, bytes: &[u8]) {
        let Ok(text) = std::str::from_utf8(bytes) else {
            return;
        };
        let reader = self.reader.lock().unwrap();
        let reader = reader.get_or_init(|| Reader::new(self.format).unwrap());
        if let Err(finding) = reader.read(text) {
            panic!("{finding}");
        }
    }
}

/// Changes the text in `data`, every other time by the mutators of the format, and returns its length.
pub fn mutate(format: Format, data: &mut [u8], size: usize, largest: usize, seed: u32) -> usize {
    let text = std::str::from_utf8(&data[..size])
        .ok()
        .filter(|_| seed % 2 == 0);
    let mutant = text.map(|text| prone_mutants::mutant(format, &[text], seed.into()));
    match mutant {
        Some(mutant) if mutant.len() <= largest => {
            data[..mutant.len()].copy_from_slice(mutant.as_bytes());
            mutant.len()
        }
        _ => libfuzzer_sys::fuzzer_mutate(data, size, largest),
    }
}
