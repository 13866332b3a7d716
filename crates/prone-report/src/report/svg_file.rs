//! Drawings that lie in a result as files: only what a drawing is made of is taken over.
//!
//! An SVG is a page of its own where it is opened by itself. One with a script, or with an address that
//! it loads, would be passed on with the report that copies it.

use roxmltree::{Document, Node, ParsingOptions};

use prone::foreign_text;

/// The elements of our own drawings.
const ELEMENTS: [&str; 13] = [
    "svg", "title", "desc", "defs", "clipPath", "g", "rect", "circle", "path", "polygon",
    "polyline", "text", "image",
];

/// The attributes of our own drawings, beside `href` and `clip-path`.
const ATTRIBUTES: [&str; 35] = [
    "alt",
    "aria-label",
    "aria-labelledby",
    "class",
    "cx",
    "cy",
    "d",
    "fill",
    "fill-opacity",
    "font-family",
    "font-size",
    "font-style",
    "font-weight",
    "height",
    "id",
    "opacity",
    "paint-order",
    "points",
    "preserveAspectRatio",
    "r",
    "role",
    "rx",
    "shape-rendering",
    "stroke",
    "stroke-dasharray",
    "stroke-linecap",
    "stroke-linejoin",
    "stroke-opacity",
    "stroke-width",
    "text-anchor",
    "transform",
    "viewBox",
    "width",
    "x",
    "y",
];

/// Most elements, texts and blanks of a drawing.
const MOST_NODES: u32 = 500_000;

/// Refuses a drawing that holds what ours never do; a refusal is a message.
pub(super) fn check(svg: &[u8]) -> Result<(), String> {
    let text = str::from_utf8(svg).map_err(|error| error.to_string())?;
    let options = ParsingOptions {
        nodes_limit: MOST_NODES,
        ..ParsingOptions::default()
    };
    let document = Document::parse_with_options(text, options)
        .map_err(|error| foreign_text::message(&error.to_string()))?;
    let mut nodes = document.descendants();
    nodes.try_for_each(|node| check_node(node))
}

fn check_node(node: Node<'_, '_>) -> Result<(), String> {
    if node.is_pi() {
        return Err("it has an instruction for programs".to_owned());
    }
    let name = node.tag_name().name();
    if node.is_element() && !ELEMENTS.contains(&name) {
        return Err(format!("it has an element <{}>", foreign_text::cut(name)));
    }
    for attribute in node.attributes() {
        let (name, value) = (attribute.name(), attribute.value());
        let loads = match name {
            "href" => !value.starts_with("data:image/png;base64,") && !value.starts_with('#'),
            // An attribute of our own drawings refers to a part of the drawing alone, and to one.
            "clip-path" => !(value.starts_with("url(#") && value.matches("url").count() == 1),
            _ => !ATTRIBUTES.contains(&name) || value.contains(['\\', '(']) && name != "transform",
        };
        if loads {
            let name = foreign_text::cut(name);
            return Err(format!(
                "{name} of an element is not one of a drawing of ours"
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drawings_that_run_or_load_something_are_refused() {
        let svg = |inside: &str| {
            let head = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1 1">"#;
            check(format!("{head}{inside}</svg>").as_bytes())
        };
        let png = r#"<image href="data:image/png;base64,AAAA"/>"#;
        let own = r#"<g clip-path="url(#a)" font-family="x"><text x="1">a &lt; b</text></g>"#;
        assert_eq!(svg(&format!("{own}{png}")), Ok(()));
        for hostile in [
            "<script>alert(1)</script>",
            r#"<rect onload="alert(1)"/>"#,
            r#"<image href="https://example.org/a.png"/>"#,
            r#"<image href="data:image/svg+xml;base64,AAAA"/>"#,
            r#"<rect fill="url(https://example.org/#a)"/>"#,
            r#"<rect style="fill:url(//example.org)"/>"#,
            r#"<rect fill="URL(https://example.org/#a)"/>"#,
            r#"<rect clip-path="url(#a), url(https://example.org)"/>"#,
            r#"<rect mask="url(#a)"/>"#,
            r#"<rect fill="u\72l(https://example.org)"/>"#,
            "<foreignObject><p xmlns='http://www.w3.org/1999/xhtml'>x</p></foreignObject>",
            r#"<a href="javascript:alert(1)"><text>x</text></a>"#,
            r#"<set attributeName="onload" to="alert(1)"/>"#,
            "<?xml-stylesheet href='a.css'?>",
        ] {
            assert!(svg(hostile).is_err(), "{hostile}");
        }
        assert!(check(b"\xff").is_err());
        assert!(check(b"<!DOCTYPE svg [<!ENTITY a \"b\">]><svg/>").is_err());
    }
}
