//! The `MuJoCo` shared library, fetched by this crate's build script.
//!
//! The crate holds no code: depending on it makes Cargo fetch the library before the final link
//! and puts its directory on the linker's search path. The directory is also published as the
//! metadata key `libdir`; a crate with binaries, tests or benchmarks depends on `mujoco-dist`
//! *directly* and turns the key into a run path in its own build script:
//!
//! ```no_run
//! let libdir = std::env::var("DEP_MUJOCO_LIBDIR").expect("mujoco-dist is a direct dependency");
//! println!("cargo::rustc-link-arg=-Wl,-rpath,{libdir}");
//! ```
//!
//! `link/libmujoco.so` is a linker script that stands in for the library until then:
//! `mujoco-rs` asks only that a file of that name exists.

/// The version of the engine that the build script fetches.
pub const VERSION: &str = "3.17.0";
