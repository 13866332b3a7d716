//! CDR, the encoding of ROS 2 messages: little endian, each number aligned to its size.
//!
//! OMG, *DDS Interoperability Wire Protocol*, 2.5, chapter 10: a header of four bytes, from whose
//! end alignment counts.

/// Plain CDR, little endian; two bytes of options, unused.
const ENCAPSULATION: [u8; 4] = [0, 1, 0, 0];

/// A message while it is made.
pub(super) struct Cdr(Vec<u8>);

impl Cdr {
    pub(super) fn new() -> Self {
        Self(ENCAPSULATION.to_vec())
    }

    pub(super) fn unsigned(&mut self, number: u32) {
        self.align(size_of::<u32>());
        self.0.extend(number.to_le_bytes());
    }

    /// The length of a sequence.
    pub(super) fn count(&mut self, count: usize) {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "some dozen joints or bodies"
        )]
        self.unsigned(count as u32);
    }

    /// Numbers one after the other, as in a structure; a sequence has its count before them.
    pub(super) fn numbers(&mut self, numbers: &[f64]) {
        for number in numbers {
            self.align(size_of::<f64>());
            self.0.extend(number.to_le_bytes());
        }
    }

    /// A text with its end.
    pub(super) fn text(&mut self, text: &str) {
        self.count(text.len() + 1);
        self.0.extend(text.as_bytes());
        self.0.push(0);
    }

    pub(super) fn finish(self) -> Vec<u8> {
        self.0
    }

    fn align(&mut self, size: usize) {
        let length = self.0.len() - ENCAPSULATION.len();
        let padding = length.next_multiple_of(size) - length;
        self.0.extend(std::iter::repeat_n(0, padding));
    }
}

#[cfg(test)]
mod tests {
    use super::Cdr;

    #[test]
    fn numbers_are_aligned_after_a_text() {
        let mut message = Cdr::new();
        message.text("ab");
        message.numbers(&[1.0]);
        let bytes = message.finish();
        assert_eq!(bytes[..11], [0, 1, 0, 0, 3, 0, 0, 0, b'a', b'b', 0]);
        // 7 bytes after the header, so one of padding.
        assert_eq!(bytes.len(), 4 + 8 + 8);
        assert_eq!(bytes[12..], 1.0_f64.to_le_bytes());
    }
}
