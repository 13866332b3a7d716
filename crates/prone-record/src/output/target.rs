//! Where a result goes: links resolved, mounts refused, folders above made.

use std::fs;
use std::io;
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};

use rustix::fs::{Access, AtFlags, CWD, StatxAttributes, StatxFlags};

use super::{OutputError, write_error};
use crate::real_path::real_path;

/// A place for a result: absolute, without links, with a folder above it.
#[derive(Debug)]
pub(super) struct Target {
    pub(super) folder: PathBuf,
    pub(super) parent: PathBuf,
    pub(super) name: String,
}

impl Target {
    /// Resolves what a user typed.
    pub(super) fn resolve(given: &Path) -> Result<Self, OutputError> {
        let nameless = || OutputError::Nameless {
            folder: given.to_owned(),
        };
        given.file_name().ok_or_else(nameless)?;
        let folder = real_path(given)?;
        // A link may lead to the root.
        let name = folder.file_name().ok_or_else(nameless)?;
        let parent = folder.parent().ok_or_else(nameless)?;
        Ok(Self {
            name: name.to_string_lossy().into_owned(),
            parent: parent.to_owned(),
            folder,
        })
    }

    /// The nearest folder above that exists.
    pub(super) fn ground(&self) -> &Path {
        let mut above = self.parent.ancestors();
        above
            .find(|folder| folder.exists())
            .unwrap_or(Path::new("/"))
    }

    /// Checks that what stands here can be moved aside.
    pub(super) fn check_movable(&self) -> Result<(), OutputError> {
        let error = |source| write_error(&self.folder, source);
        let device = |path: &Path| fs::metadata(path).map(|found| found.dev());
        let elsewhere =
            device(&self.folder).map_err(error)? != device(&self.parent).map_err(error)?;
        if elsewhere || is_mount(&self.folder) {
            return Err(OutputError::MountPoint {
                folder: self.folder.clone(),
            });
        }
        rustix::fs::access(&self.folder, Access::WRITE_OK | Access::EXEC_OK)
            .map_err(|source| error(source.into()))
    }
}

/// Whether a folder is a mount point of its own file system, which the device number does not
/// tell; `false` where the kernel cannot say.
fn is_mount(folder: &Path) -> bool {
    let flags = AtFlags::SYMLINK_NOFOLLOW;
    rustix::fs::statx(CWD, folder, flags, StatxFlags::empty())
        .is_ok_and(|found| found.stx_attributes.contains(StatxAttributes::MOUNT_ROOT))
}

/// The folders above a result that had to be made; removed again when dropped, unless kept.
#[derive(Debug)]
pub(super) struct Parents {
    /// Outermost first.
    made: Vec<PathBuf>,
}

impl Parents {
    /// Makes the folders that are missing.
    pub(super) fn make(parent: &Path) -> Result<Self, OutputError> {
        let missing: Vec<&Path> = parent.ancestors().take_while(|f| !f.exists()).collect();
        let mut parents = Self { made: Vec::new() };
        for folder in missing.into_iter().rev() {
            match fs::create_dir(folder) {
                Ok(()) => parents.made.push(folder.to_owned()),
                // Another run made it.
                Err(source) if source.kind() == io::ErrorKind::AlreadyExists => {}
                Err(source) => return Err(write_error(folder, source)),
            }
        }
        Ok(parents)
    }

    /// They hold a result now.
    pub(super) fn keep(mut self) {
        self.made.clear();
    }
}

impl Drop for Parents {
    fn drop(&mut self) {
        for folder in self.made.iter().rev() {
            // One that another run uses meanwhile is not empty, and stays.
            let _ = fs::remove_dir(folder);
        }
    }
}
