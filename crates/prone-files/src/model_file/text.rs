//! The text that the engine is given: what was checked, and nothing else.

use std::fmt::Write as _;

use roxmltree::Node;

use super::value::Value;
use super::vocabulary::{self, Passed};

/// Writes a checked element with all that is in it. Each element stands on the line that it has in the
/// file, which the engine's messages name; `line` tells it.
pub(super) fn written(root: Node<'_, '_>, line: impl Fn(usize) -> usize) -> String {
    let mut writer = Writer {
        text: String::new(),
        lines: 1,
    };
    writer.element(root, &line);
    writer.text.push('\n');
    writer.text
}

struct Writer {
    text: String,
    /// The line that is being written.
    lines: usize,
}

impl Writer {
    fn element(&mut self, node: Node<'_, '_>, line: &impl Fn(usize) -> usize) {
        let Some(element) = vocabulary::element(node.tag_name().name()) else {
            return;
        };
        if element.passed == Passed::Not {
            return;
        }
        let at = line(node.range().start);
        while self.lines < at {
            self.text.push('\n');
            self.lines += 1;
        }
        // Writing to a text does not fail.
        let _ = write!(self.text, "<{}", element.name);
        for attribute in node.attributes() {
            match element.value(attribute.name()) {
                None | Some(Value::Ignored) => {}
                // What was checked has no character that needs to be escaped. A line break between two
                // numbers would move the lines below.
                Some(_) => {
                    let words: Vec<&str> = attribute.value().split_ascii_whitespace().collect();
                    let _ = write!(self.text, " {}=\"{}\"", attribute.name(), words.join(" "));
                }
            }
        }
        self.text.push('>');
        for child in node.children().filter(Node::is_element) {
            self.element(child, line);
        }
        let _ = write!(self.text, "</{}>", element.name);
    }
}
