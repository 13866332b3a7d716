//! What the engine says: in our errors, and nowhere else.
//!
//! Keeps the engine from writing `MUJOCO_LOG.TXT` into the user's folder.
//!
//! What it would write there (a diverging state) is checked after every control step and returned
//! as an error, so nothing is lost.

use std::sync::Once;

use mujoco_rs::wrappers::mj_logging::{log_config, set_log_config};

/// Silences the engine's own console and file output, once per process.
#[expect(unsafe_code, reason = "the engine's log settings are one global")]
pub(crate) fn silence() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let mut quiet = log_config();
        quiet.set_logto_console(false);
        quiet.set_logto_file(false);
        // SAFETY: every use of the engine in this crate starts with `silence`, and `Once` makes
        // all of them wait for this one write; nothing else reads or writes the settings.
        unsafe { set_log_config(quiet) }
    });
}

/// The engine's messages span lines; ours do not.
pub(crate) fn one_line(message: &str) -> String {
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}
