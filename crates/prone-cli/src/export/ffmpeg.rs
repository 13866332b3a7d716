//! mp4 by the `ffmpeg` that is installed: raw pictures go into its standard input.
//!
//! It writes to a hidden file beside the target, which takes the target's place when all is done
//! and goes with this value otherwise. It does not hear the terminal's Ctrl-C: this program ends it.

use std::fs::File;
use std::io::{Read as _, Seek as _, Write as _};
use std::os::unix::process::CommandExt as _;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use anyhow::{Context as _, anyhow};
use tempfile::NamedTempFile;

use prone_record::output::without_hidden_name;
use prone_sim::camera::Picture;
use prone_study::export::film::{Reel, Shot};

use crate::Failure;

/// Quality of the encoder, 0 to 51, smaller is better: its own middle is 23, which shows on the thin
/// lines of the floor.
const QUALITY: &str = "20";

/// A running ffmpeg.
pub(super) struct Ffmpeg {
    child: Child,
    said: File,
    file: NamedTempFile,
}

impl Ffmpeg {
    /// Starts it.
    pub(super) fn start(out: &Path, shot: &Shot) -> Result<Self, Failure> {
        let (file, said) = files(out).map_err(Failure::Work)?;
        let (width, height) = shot.size;
        let stderr = said.try_clone().map_err(Failure::work)?;
        let started = Command::new("ffmpeg")
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
            .process_group(0)
            .spawn();
        match started {
            Ok(child) => Ok(Self { child, said, file }),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                Err(Failure::Work(anyhow!(
                    "mp4 is made by ffmpeg, which is not on PATH: install it (Debian: apt-get \
                     install ffmpeg), or take --format webp or gif, which need nothing"
                )))
            }
            Err(error) => Err(Failure::Work(anyhow!("cannot start ffmpeg: {error}"))),
        }
    }

    /// Waits until the file is complete.
    pub(super) fn finish(mut self) -> Result<NamedTempFile, Failure> {
        drop(self.child.stdin.take());
        let status = self.child.wait().map_err(Failure::work)?;
        if !status.success() {
            return Err(Failure::Work(self.complaint()));
        }
        self.file.as_file().sync_all().map_err(Failure::work)?;
        // The rest of this value ends a process that is not there any more.
        let placeholder = tempfile::Builder::new().tempfile().map_err(Failure::work)?;
        Ok(std::mem::replace(&mut self.file, placeholder))
    }

    /// What ffmpeg itself says, its last line.
    fn complaint(&mut self) -> anyhow::Error {
        let mut text = String::new();
        let _ = self.said.rewind();
        let _ = self.said.read_to_string(&mut text);
        let line = text.trim().lines().next_back().unwrap_or("it says nothing");
        anyhow!("ffmpeg failed: {line}")
    }
}

impl Drop for Ffmpeg {
    fn drop(&mut self) {
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
        let Some(input) = &mut self.child.stdin else {
            return Ok(());
        };
        if input.write_all(&frame).is_err() {
            // It has gone, and says why.
            let _ = self.child.wait();
            return Err(self.complaint());
        }
        Ok(())
    }
}

/// Where the film and the complaints go.
fn files(out: &Path) -> Result<(NamedTempFile, File), anyhow::Error> {
    let folder = match out.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let permissions = std::os::unix::fs::PermissionsExt::from_mode(0o666);
    let file = tempfile::Builder::new()
        .prefix(".prone-")
        .suffix(".mp4")
        .permissions(permissions)
        .tempfile_in(folder)
        .map_err(|error| {
            let reason = without_hidden_name(&error);
            anyhow!("cannot write {}: {reason}", out.display())
        })?;
    let said = tempfile::tempfile().context("cannot keep what ffmpeg says")?;
    Ok((file, said))
}
