//! The report: one HTML page without external links. It reads records and computes nothing.

mod sections;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::figures::Figure;
use crate::frames::Frames;
use crate::reproduce::CrawlFigures;
use crate::run_info::RunInfo;
use crate::summary::Summary;

const STYLE: &str = include_str!("report/style.css");

/// How many of a series of sections share a figure: first and last chapter figure number.
struct Group {
    title: &'static str,
    lead: &'static str,
    numbers: &'static [&'static str],
}

const GROUPS: [Group; 3] = [
    Group {
        title: "The gaits",
        lead: "What is commanded: three chain angles over the phase, and the closed chain that they make in the sagittal plane. The chain has joint centres only; the body around them has thickness.",
        numbers: &["25", "26", "34"],
    },
    Group {
        title: "Joint torques",
        lead: "Joint torque is minus the actuator torque about the joint's axis, right side, averaged over one control step: the sign and averaging of the published recordings. All curves are ours.",
        numbers: &["36", "37", "38", "39", "40", "41", "42", "43", "44"],
    },
    Group {
        title: "Cost against duration",
        lead: "Cost is the integral over the phase of the squared joint torques of one side, unweighted. The published axis is labelled N²/m²; the quantity is N²·m²·s.",
        numbers: &["45"],
    },
];

/// Renders the page.
pub(crate) fn html(
    info: &RunInfo,
    summary: &Summary,
    figures: &[Figure],
    frames: &[Frames],
    crawled: Option<&CrawlFigures>,
) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "prone: the Projected Profile crawl, reproduced" }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header {
                    h1 { "The Projected Profile crawl, reproduced" }
                    p.lead {
                        "Torque study of a low-profile crawl of the " (info.robot.name) ": two gaits of \
                         the closed chain from toe to elbow, "
                        (info.options.durations_s.len()) " durations, simulated with contact physics and \
                         held against the study published in 2015."
                    }
                }
                main {
                    (sections::results(summary))
                    (photographs(frames))
                    (sections::contacts(summary))
                    @for group in &GROUPS { (figure_group(group, figures)) }
                    (sections::costs(summary))
                    (sections::agreement(summary))
                    (sections::stride(summary))
                    @if let Some(crawled) = crawled { (under_the_table(summary, crawled)) }
                    (sections::clamps(summary))
                    (sections::mappings(summary))
                    (sections::differences())
                    (sections::what_was_run(info))
                }
                footer {
                    p {
                        "prone " (info.built.version) ", commit " (info.built.commit) ", "
                        (info.engine) ". Tables and figures were computed by the run that wrote this page, \
                         except what is marked published; the text describes the NAO."
                    }
                }
            }
        }
    };
    page.into_string()
}

fn photographs(frames: &[Frames]) -> Markup {
    html! {
        section {
            h2 { "The simulated robot" }
            div.pair {
                @for frames in frames {
                    @let figure = &frames.figure;
                    @let data = BASE64.encode(&frames.png);
                    (captioned(figure, &html! {
                        img alt=(figure.alt) src={ "data:image/png;base64," (data) };
                    }))
                }
            }
        }
    }
}

fn under_the_table(summary: &Summary, crawled: &CrawlFigures) -> Markup {
    let (frames, angles) = (&crawled.frames.figure, &crawled.angles);
    html! {
        section {
            h2 { "Whole cycles under the table" }
            (sections::table_crawl(summary))
            (captioned(frames, &html! {
                img alt=(frames.alt)
                    src={ "data:image/png;base64," (BASE64.encode(&crawled.frames.png)) };
            }))
            (captioned(angles, &html! {
                div.drawing role="img" aria-label=(angles.alt) { (PreEscaped(inline(&angles.svg))) }
            }))
        }
    }
}

fn figure_group(group: &Group, figures: &[Figure]) -> Markup {
    html! {
        section {
            h2 { (group.title) }
            p { (group.lead) }
            @for figure in figures.iter().filter(|figure| group.numbers.contains(&figure.number)) {
                (captioned(figure, &html! {
                    div.drawing role="img" aria-label=(figure.alt) { (PreEscaped(inline(&figure.svg))) }
                }))
            }
        }
    }
}

fn captioned(figure: &Figure, picture: &Markup) -> Markup {
    html! {
        figure id={ (figure.stem) } {
            (picture)
            figcaption {
                strong { "Figure " (figure.number) ". " (figure.title) ". " }
                (figure.caption)
            }
        }
    }
}

/// An SVG document as a part of a page: without its XML declaration.
fn inline(svg: &str) -> &str {
    svg.find("<svg").map_or(svg, |start| &svg[start..])
}
