//! The head of every page of ours: it may load nothing.

use maud::{Markup, html};

/// What stands in a page's `head` before its style. `policy` is its content security policy.
pub(crate) fn from_title(title: &str, policy: &str) -> Markup {
    html! {
        meta charset="utf-8";
        meta name="viewport" content="width=device-width, initial-scale=1";
        meta http-equiv="Content-Security-Policy" content=(policy);
        // Without it a browser asks the server for one.
        link rel="icon" href="data:,";
        title { (title) }
    }
}
