//! The replay: recorded runs in one HTML page that needs nothing else.
//!
//! The page holds the script that `viewer/` builds and, as JSON, the runs ([`record::read`]). The
//! script moves the bodies by the recorded joint angles; no physics is computed here or there.
//! `viewer/README.md` describes the JSON.

mod pack;
pub mod record;

use maud::{DOCTYPE, PreEscaped, html};
use serde::Serialize;

use prone::foreign_text;

use crate::page_head;
use record::Run;

/// The bundle of `viewer/`, which `npm ci && npm run build` there reproduces.
const VIEWER: &str = include_str!("../../../viewer/dist/viewer.js");

/// What of the JSON changed last; the script refuses another.
const FORMAT_VERSION: u32 = 1;

#[derive(Serialize)]
struct Content<'a> {
    format: &'static str,
    version: u32,
    runs: &'a [&'a Run],
}

/// The page of one run, or of several to compare.
///
/// # Errors
/// [`serde_json::Error`] where a run cannot be written as JSON.
pub fn page(runs: &[&Run]) -> Result<String, serde_json::Error> {
    let data = serde_json::to_string(&Content {
        format: "prone-replay",
        version: FORMAT_VERSION,
        runs,
    })?;
    let titles: Vec<&str> = runs.iter().map(|run| run.title()).collect();
    let title = format!("{} – prone", titles.join(" | "));
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                (page_head::from_title(&title))
            }
            body {
                div #app {}
                noscript { "The replay needs JavaScript; the record folder holds the run as tables." }
                script type="application/json" id="prone-runs" { (PreEscaped(in_script(&data))) }
                script { (PreEscaped(VIEWER)) }
            }
        }
    };
    Ok(foreign_text::escaped_page(&page.into_string()).into_owned())
}

/// JSON in which nothing ends the element that it stands in.
fn in_script(json: &str) -> String {
    json.replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use prone::robot::{BodyPart, ContactGroup};

    use super::*;

    #[test]
    fn no_text_ends_its_script() {
        let text = in_script(r#"{"title":"</script><!--"}"#);
        assert!(!text.contains('<'));
        let back: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(back["title"], "</script><!--");
        let lower = VIEWER.to_lowercase();
        assert!(!lower.contains("</script") && !lower.contains("<!--"));
    }

    #[test]
    fn the_bundle_names_whose_work_it_holds() {
        let (head, _) = VIEWER.split_once("*/").unwrap();
        for said in ["three ", "uplot ", "MIT License", "Copyright"] {
            assert!(head.contains(said), "{said}");
        }
    }

    /// The browser's side reads columns by these names.
    #[test]
    fn the_viewer_lists_the_same_parts_and_groups() {
        let data = include_str!("../../../viewer/src/data.ts");
        let listed = |list: &str, names: &[&str]| {
            let line = format!("export const {list} = {names:?} as const;");
            assert!(data.contains(&line), "{line}");
        };
        listed("BODY_PARTS", &BodyPart::ALL.map(BodyPart::name));
        listed("CONTACT_GROUPS", &ContactGroup::ALL.map(ContactGroup::name));
    }
}
