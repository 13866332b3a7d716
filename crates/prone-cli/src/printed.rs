//! Standard output: results as lines of text. No letter of a foreign text commands the terminal.

use std::io::{self, StdoutLock, Write};

use prone::foreign_text;

/// Where commands print their results. Whatever is printed there goes through one place, so that no
/// printer can forget it; JSON has its own escapes by then
/// ([`prone_record::output::json_text`]).
#[expect(clippy::disallowed_methods, reason = "the one place")]
pub(crate) fn out() -> Printed {
    Printed(io::stdout().lock())
}

/// Text with every letter that is not seen, but line ends, written out.
pub(crate) struct Printed(StdoutLock<'static>);

impl Write for Printed {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        // What is printed comes piece by piece, each of them whole letters.
        let text = String::from_utf8_lossy(bytes);
        self.0
            .write_all(foreign_text::escaped_lines(&text).as_bytes())?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}
