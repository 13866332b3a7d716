//! The shipped NAO with a change in its text.

use prone_files::shipped::NAO;
use prone_sim::RobotFiles;

/// No change.
pub(crate) const SAME: (&str, &str) = ("", "");

/// One change in each of its files.
pub(crate) fn changed(toml: (&str, &str), mjcf: (&str, &str)) -> RobotFiles {
    let change = |text: &str, (from, to): (&str, &str)| {
        assert!(text.contains(from), "{from} is not in the file");
        text.replacen(from, to, 1)
    };
    RobotFiles {
        folder: "nao".to_owned(),
        toml: change(NAO.toml, toml),
        mjcf: change(NAO.mjcf, mjcf),
        ..RobotFiles::shipped(&NAO)
    }
}
