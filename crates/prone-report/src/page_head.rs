//! The head of every page of ours: it may load nothing.

use maud::{Markup, html};

/// Nothing leaves a page, and nothing comes to it; a frame within it inherits this.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; \
                      img-src data:; base-uri 'none'; form-action 'none'";

/// What stands in a page's `head` before its style.
pub(crate) fn from_title(title: &str) -> Markup {
    html! {
        meta charset="utf-8";
        meta name="viewport" content="width=device-width, initial-scale=1";
        meta http-equiv="Content-Security-Policy" content=(POLICY);
        // Without it a browser asks the server for one.
        link rel="icon" href="data:,";
        title { (title) }
    }
}
