//! mp4 by the `ffmpeg` that is installed: raw pictures go into its standard input.
//!
//! It writes to a hidden file beside the target, which takes the target's place when all is done
//! and goes with this value otherwise. It does not hear the terminal's Ctrl-C: this program ends it,
//! also where it is ended at once itself ([`leftovers`]).

use std::fs::File;
use std::io::{Read as _, Seek as _, Write as _};
use std::os::unix::process::CommandExt as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::Duration;

use anyhow::anyhow;
use rustix::process::{Pid, Signal, kill_process};

use prone_record::leftovers::{self, Leftover};
use prone_record::output::without_hidden_name;
use prone_record::single_file::HiddenFile;
use prone_sim::camera::Picture;
use prone_study::export::film::{Reel, Shot};

use crate::{Failure, interrupt};

/// Time between two looks at whether it has ended.
const GLANCE: Duration = Duration::from_millis(20);

/// Quality of the encoder, 0 to 51, smaller is better: its own middle is 23, which shows on the thin
/// lines of the floor.
const QUALITY: &str = "20";

/// A running ffmpeg.
pub(super) struct Ffmpeg {
    process: Process,
    said: File,
    // Removed when the process has ended.
    file: HiddenFile,
    /// Where the film goes, as it was named.
    out: PathBuf,
}

/// A child that is ended with this value.
struct Process {
    child: Child,
    running: Option<Leftover>,
}

impl Ffmpeg {
    /// Starts it.
    pub(super) fn start(out: &Path, shot: &Shot) -> Result<Self, Failure> {
        let file = HiddenFile::beside(out, ".mp4")?;
        let said = tempfile::tempfile();
        let said = said.map_err(|error| {
            let reason = without_hidden_name(&error);
            Failure::Work(anyhow!("cannot keep what ffmpeg says: {reason}"))
        })?;
        let (width, height) = shot.size;
        let stderr = said.try_clone().map_err(Failure::work)?;
        let mut ffmpeg = Command::new("ffmpeg");
        ffmpeg
            .args(["-hide_banner", "-loglevel", "error", "-nostdin", "-y"])
            .args(["-f", "rawvideo", "-pix_fmt", "rgb24"])
            .args(["-s", &format!("{width}x{height}")])
            .args(["-r", &shot.fps.to_string()])
            .args(["-i", "pipe:0"])
            // The widest spread form: every browser and player shows it.
            .args(["-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", QUALITY])
            .args(["-movflags", "+faststart", "-f", "mp4"])
            .arg(file.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(stderr)
            .process_group(0);
        let started = leftovers::make(
            || ffmpeg.spawn(),
            |child| {
                let child = Pid::from_child(child);
                // Struck off the list as soon as it is reaped: until then its number is its own.
                move || {
                    let _ = kill_process(child, Signal::KILL);
                }
            },
        );
        match started {
            Ok((child, running)) => Ok(Self {
                process: Process {
                    child,
                    running: Some(running),
                },
                said,
                file,
                out: out.to_owned(),
            }),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                Err(Failure::Work(anyhow!(
                    "mp4 is made by ffmpeg, which is not on PATH: install it (Debian: apt-get \
                     install ffmpeg), or take --format webp or gif, which need nothing"
                )))
            }
            Err(error) => Err(Failure::Work(anyhow!("cannot start ffmpeg: {error}"))),
        }
    }

    /// Waits until the file is complete, and gives it, unless the work is to end.
    pub(super) fn finish(mut self) -> Result<HiddenFile, Failure> {
        drop(self.process.child.stdin.take());
        // Looked at, not waited for, while it may have to be ended.
        loop {
            if interrupt::requested() {
                return Err(Failure::Stopped);
            }
            match self.process.ended().map_err(Failure::work)? {
                None => thread::sleep(GLANCE),
                Some(true) => return Ok(self.file),
                Some(false) => return Err(Failure::Work(self.complaint())),
            }
        }
    }

    /// What ffmpeg itself says, its last line.
    fn complaint(&mut self) -> anyhow::Error {
        let mut text = String::new();
        let _ = self.said.rewind();
        let _ = self.said.read_to_string(&mut text);
        let line = text.trim().lines().next_back().unwrap_or("it says nothing");
        // It knows the hidden file only.
        let hidden = self.file.path().display().to_string();
        let line = line.replace(&hidden, &self.out.display().to_string());
        anyhow!("ffmpeg failed: {line}")
    }
}

impl Process {
    /// Whether it has ended well, if it has ended.
    fn ended(&mut self) -> std::io::Result<Option<bool>> {
        let ended = self.child.try_wait()?;
        if ended.is_some() {
            self.running = None;
        }
        Ok(ended.map(|status| status.success()))
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        self.running = None;
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Reel for Ffmpeg {
    type Frame = Vec<u8>;
    type Error = anyhow::Error;

    fn frame(_: Option<&Picture>, now: &Picture) -> Result<Vec<u8>, anyhow::Error> {
        Ok(now.rgb.clone())
    }

    fn take(&mut self, frame: Vec<u8>) -> Result<(), anyhow::Error> {
        let Some(input) = &mut self.process.child.stdin else {
            return Ok(());
        };
        if input.write_all(&frame).is_err() {
            // It has gone, and says why.
            drop(self.process.child.stdin.take());
            let _ = self.process.child.wait();
            return Err(self.complaint());
        }
        Ok(())
    }
}
