//! A figure on the page, and what stands where one is not there.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use maud::{Markup, PreEscaped, html};

use super::publication::Place;
use super::shown::{Image, Shown};

/// What stands in the place of a picture for which a page has no room.
pub(super) fn left_out(figure: &Shown) -> Markup {
    html! {
        div.place { p {
            "Left out, as the page would be too large: " code { "figures/" (figure.stem) ".png" }
            " of a report that is written into a folder."
        } }
    }
}

/// A figure that is not there: what fills its place.
pub(super) fn empty(place: &Place) -> Markup {
    html! {
        div.place id={ "place-" (place.number) } {
            p {
                strong { "Figure " (place.number) ": " (place.shows) ". " }
                @match &place.command {
                    Some(command) => {
                        "Not among these runs. " code { (command) } " makes it; give its folder to "
                        code { "prone report" } "."
                    }
                    None => { "Comes with a robot on the wire, which prone does not drive yet." }
                }
            }
            @if let Some(published) = &place.published { p { (published) } }
        }
    }
}

/// A figure without its caption.
pub(super) fn image(figure: &Shown) -> Markup {
    let picture = |kind: &str, bytes: &[u8]| {
        html! { img alt=(figure.alt) src={ "data:image/" (kind) ";base64," (BASE64.encode(bytes)) }; }
    };
    match &figure.image {
        Image::Drawing { svg, .. } => html! {
            div.drawing role="img" aria-label=(figure.alt) { (PreEscaped(inline(svg))) }
        },
        Image::Recorded {
            small: Some(small), ..
        } => picture("png", small),
        // In an image nothing of a drawing can run or load.
        Image::Recorded { svg, .. } => html! { div.drawing { (picture("svg+xml", svg)) } },
    }
}

/// An SVG document as a part of a page: without its XML declaration.
fn inline(svg: &str) -> &str {
    svg.find("<svg").map_or(svg, |start| &svg[start..])
}
