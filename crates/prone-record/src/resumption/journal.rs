//! Unfinished work of many independent parts: each is appended as it is done.

use std::fs::{File, OpenOptions};
use std::io::{self, Seek as _, SeekFrom, Write as _};
use std::marker::PhantomData;
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{Opening, Place, ResumptionError, Standing, Work, unwritten};

/// Lines kept in memory until they are written: a third of a second of simulation.
const BATCH: usize = 32;

/// A journal of parts `S`, open and locked.
#[derive(Debug)]
pub struct Journal<S> {
    place: Place,
    file: File,
    /// Bytes of whole lines in the file.
    written: u64,
    batch: String,
    batched: usize,
    parts: PhantomData<fn(S) -> S>,
}

impl<S: Serialize + DeserializeOwned> Journal<S> {
    /// Opens the journal of a result, and reads the parts that it holds, in the order in which they
    /// were done.
    ///
    /// # Errors
    /// [`ResumptionError`]; a file that is there is then as it was.
    pub fn open(
        work: Work,
        result: &Path,
        plan: &impl Serialize,
        opening: Opening,
    ) -> Result<(Self, Vec<S>), ResumptionError> {
        let place = Place::new(work, result, plan)?;
        let (parts, kept) = match (place.standing()?, opening) {
            (Standing::Nothing, _) | (_, Opening::Restart) => (Vec::new(), 0),
            (Standing::Kept(bytes), Opening::Resume) => place.states(&bytes)?,
            (Standing::Other(format), Opening::Resume) => return Err(place.other_format(format)),
        };
        let file = OpenOptions::new()
            .write(true)
            .create(true)
            .truncate(false)
            .open(&place.path)
            .map_err(|error| unwritten(&place.path, error))?;
        let mut journal = Self {
            place,
            file,
            written: kept as u64,
            batch: String::new(),
            batched: 0,
            parts: PhantomData,
        };
        journal.cut().map_err(|error| journal.unwritten(error))?;
        if kept == 0 {
            journal.batch = journal.place.head()?;
            journal.flush()?;
        }
        Ok((journal, parts))
    }

    /// Adds a part; it is on disk with the batch that it fills.
    ///
    /// # Errors
    /// [`ResumptionError::Write`].
    pub fn append(&mut self, part: &S) -> Result<(), ResumptionError> {
        self.batch.push_str(&self.place.line(part)?);
        self.batched += 1;
        if self.batched < BATCH {
            return Ok(());
        }
        self.flush()
    }

    /// Writes what is still in memory.
    ///
    /// # Errors
    /// [`ResumptionError::Write`].
    pub fn flush(&mut self) -> Result<(), ResumptionError> {
        let batch = std::mem::take(&mut self.batch);
        self.batched = 0;
        if let Err(error) = self.file.write_all(batch.as_bytes()) {
            // A full disk may have taken half of it.
            let _ = self.cut();
            return Err(self.unwritten(error));
        }
        self.written += batch.len() as u64;
        Ok(())
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.place.path
    }

    /// The error of a part that [`Journal::open`] gave and that cannot be one of this work.
    pub fn impossible(&self, index: usize, part: &S) -> ResumptionError {
        let text = serde_json::to_string(part).unwrap_or_default();
        self.place.damaged(index + 2, &text)
    }

    /// Removes it: the result is in place, or there was nothing to keep.
    ///
    /// # Errors
    /// [`ResumptionError::Write`].
    pub fn remove(self) -> Result<(), ResumptionError> {
        self.place.remove()
    }

    /// Cuts off what is not a whole line.
    fn cut(&mut self) -> io::Result<()> {
        self.file.set_len(self.written)?;
        self.file.seek(SeekFrom::Start(self.written)).map(drop)
    }

    fn unwritten(&self, error: io::Error) -> ResumptionError {
        unwritten(&self.place.path, error)
    }
}
