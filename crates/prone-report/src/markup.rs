//! Texts inside SVG and XML.

use prone::foreign_text;

/// A text as the content of an element, or inside an attribute's double quotes. XML has no form for most
/// control characters, and a mark of direction would turn the letters after it: both are shown as what
/// they are.
pub fn escaped(text: &str) -> String {
    foreign_text::escaped(text)
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_in_a_text_is_escaped() {
        assert_eq!(escaped("a\u{1b}b\u{202e}"), "a\\u{1b}b\\u{202e}");
        assert_eq!(escaped("a < b & \"c\""), "a &lt; b &amp; &quot;c&quot;");
    }
}
