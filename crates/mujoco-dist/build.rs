//! Fetches the `MuJoCo` library into `OUT_DIR` and publishes its directory.
//!
//! The library comes out of the engine's Python wheel, because every machine that builds this
//! project has `python3` with pip, and pip checks what it downloads against the hash below. The
//! interpreter's own version does not matter: one fixed wheel per platform is asked for.

use std::env;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, SystemTime};

const VERSION: &str = "3.17.0";
const LIBRARY: &str = "libmujoco.so.3.17.0";
/// Names a wheel on disk, for machines without a network.
const LOCAL_WHEEL: &str = "PRONE_MUJOCO_WHEEL";
/// Checks a wheel's hash and copies one file out of it.
const UNPACK: &str = include_str!("unpack.py");

/// One wheel that is known to work.
struct Wheel {
    arch: &'static str,
    platform: &'static str,
    sha256: &'static str,
}

const WHEELS: [Wheel; 2] = [
    Wheel {
        arch: "x86_64",
        platform: "manylinux_2_28_x86_64",
        sha256: "d66928d86a2d1b601bbaa4dc11db50214d17d5301bb8afd84721313b67ff0874",
    },
    Wheel {
        arch: "aarch64",
        platform: "manylinux_2_28_aarch64",
        sha256: "91a70ed9979c383ff1f5c03f25cc2e1280a8254c1a8e558d5dd7f4184f01efc9",
    },
];

fn main() {
    if let Err(message) = provide_library() {
        // Cargo fails the build for these lines; a failing exit code would bury them in a dump.
        for line in message.lines() {
            println!("cargo::error={line}");
        }
    }
}

fn provide_library() -> Result<(), String> {
    let libdir = PathBuf::from(variable("OUT_DIR")?);
    let library = libdir.join(LIBRARY);
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=unpack.py");
    println!("cargo::rerun-if-changed={}", library.display()); // deleted: fetch it again
    println!("cargo::rerun-if-env-changed={LOCAL_WHEEL}");

    let wheel = wheel_for_target()?;
    if !library.is_file() {
        // A directory of our own, so that an interrupted fetch never looks like a finished one.
        let scratch = libdir.join(format!("fetch-{}", std::process::id()));
        fs::create_dir_all(&scratch).map_err(|error| cannot("create", &scratch, &error))?;
        let fetched = fetch(wheel, &scratch, &library);
        let _ = fs::remove_dir_all(&scratch); // what is left over harms nothing
        fetched?;
    }

    println!("cargo::rustc-link-search=native={}", libdir.display());
    println!("cargo::metadata=libdir={}", libdir.display());
    Ok(())
}

/// The wheel for the machine that the program will run on, which need not be this one.
fn wheel_for_target() -> Result<&'static Wheel, String> {
    let [arch, os, libc] = [
        "CARGO_CFG_TARGET_ARCH",
        "CARGO_CFG_TARGET_OS",
        "CARGO_CFG_TARGET_ENV",
    ]
    .map(|name| env::var(name).unwrap_or_default());
    WHEELS
        .iter()
        .find(|wheel| wheel.arch == arch && os == "linux" && libc == "gnu")
        .ok_or_else(|| {
            format!(
                "MuJoCo {VERSION} is not available for {arch}-{os}-{libc}.\n\
                 Supported: x86_64 and aarch64 Linux with glibc 2.28 or newer."
            )
        })
}

/// Puts the library in place, complete or not at all.
fn fetch(wheel: &Wheel, scratch: &Path, library: &Path) -> Result<(), String> {
    let archive = match env::var_os(LOCAL_WHEEL) {
        Some(path) if !path.is_empty() => PathBuf::from(path),
        _ => download(wheel, scratch)?,
    };

    let unpacked = scratch.join(LIBRARY);
    let output = python(
        Command::new("python3")
            .args(["-c", UNPACK])
            .arg(&archive)
            .arg(wheel.sha256)
            .arg(format!("mujoco/{LIBRARY}"))
            .arg(&unpacked),
    )?;
    if !output.status.success() {
        return Err(format!(
            "The MuJoCo wheel cannot be used: {}\n\
             {LOCAL_WHEEL} must be the absolute path of the mujoco {VERSION} wheel for CPython 3.11, {}; \
             unset it to download that wheel.",
            text(&output.stderr),
            wheel.platform
        ));
    }

    // An old date: Cargo runs a build script again when a file it watches is newer than its run.
    let old = SystemTime::UNIX_EPOCH + Duration::from_hours(24);
    File::options()
        .append(true)
        .open(&unpacked)
        .and_then(|file| file.set_modified(old))
        .and_then(|()| fs::rename(&unpacked, library))
        .map_err(|error| cannot("write", library, &error))
}

/// Downloads the wheel with pip, which refuses any file with another hash.
fn download(wheel: &Wheel, scratch: &Path) -> Result<PathBuf, String> {
    let pip = python(Command::new("python3").args(["-m", "pip", "--version"]))?;
    if !pip.status.success() {
        return Err(format!(
            "MuJoCo {VERSION} is downloaded with pip, which python3 does not have: {}\n\
             Install pip (Debian and Ubuntu: `apt install python3-pip`; elsewhere \
             `python3 -m ensurepip`), or name a local wheel in {LOCAL_WHEEL}.",
            text(&pip.stderr)
        ));
    }

    let requirements = scratch.join("requirements.txt");
    let requirement = format!("mujoco=={VERSION} --hash=sha256:{}\n", wheel.sha256);
    fs::write(&requirements, requirement)
        .map_err(|error| cannot("write", &requirements, &error))?;
    let output = python(
        Command::new("python3")
            .args(["-m", "pip", "download", "--quiet", "--no-input"])
            .args(["--disable-pip-version-check", "--progress-bar", "off"])
            .args(["--no-deps", "--only-binary=:all:", "--require-hashes"])
            .args([
                "--implementation",
                "cp",
                "--python-version",
                "311",
                "--abi",
                "cp311",
            ])
            .args(["--platform", wheel.platform, "--dest"])
            .arg(scratch)
            .arg("--requirement")
            .arg(&requirements),
    )?;
    let report = text(&output.stderr);
    if report.contains("DO NOT MATCH THE HASHES") {
        return Err(format!(
            "The downloaded MuJoCo {VERSION} wheel is not the expected file, and was not used:\n\
             {report}\n\
             Check the package index that pip is configured to use, or name a trusted wheel in \
             {LOCAL_WHEEL}."
        ));
    }
    if !output.status.success() {
        return Err(format!(
            "pip could not download MuJoCo {VERSION}:\n\
             {report}\n\
             Is the machine online? If not, fetch the mujoco {VERSION} wheel for CPython 3.11, {} \
             elsewhere and name it in {LOCAL_WHEEL}.",
            wheel.platform
        ));
    }
    wheel_in(scratch)
}

fn wheel_in(directory: &Path) -> Result<PathBuf, String> {
    fs::read_dir(directory)
        .map_err(|error| cannot("read", directory, &error))?
        .filter_map(|entry| entry.ok().map(|entry| entry.path()))
        .find(|path| path.extension().is_some_and(|extension| extension == "whl"))
        .ok_or_else(|| {
            format!(
                "pip reported success, but left no wheel in {}",
                directory.display()
            )
        })
}

fn python(command: &mut Command) -> Result<Output, String> {
    command.output().map_err(|error| {
        format!(
            "MuJoCo {VERSION} is unpacked with python3, which cannot be run: {error}\n\
             Install it (Debian and Ubuntu: `apt install python3 python3-pip`) and build again."
        )
    })
}

fn variable(name: &str) -> Result<String, String> {
    env::var(name).map_err(|error| format!("{name}, which Cargo sets for build scripts: {error}"))
}

fn cannot(verb: &str, path: &Path, error: &std::io::Error) -> String {
    format!("cannot {verb} {}: {error}", path.display())
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).trim().to_owned()
}
