//! Lets the program find the engine at run time, and tells it the commit it was built from.

use std::process::Command;

fn main() {
    let libdir = std::env::var("DEP_MUJOCO_LIBDIR").expect("mujoco-dist is a direct dependency");
    println!("cargo::rustc-link-arg=-Wl,-rpath,{libdir}");

    let commit = git(&["rev-parse", "--short=12", "HEAD"]).unwrap_or_else(|| "unknown".into());
    println!("cargo::rustc-env=PRONE_COMMIT={commit}");
    // Run again when HEAD or the branch that it names moves; a file that is missing counts as
    // changed.
    for name in ["HEAD", "logs/HEAD"] {
        if let Some(path) = git(&["rev-parse", "--git-path", name]) {
            println!("cargo::rerun-if-changed={path}");
        }
    }
}

fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}
