//! Transcripts of the command line: what is typed, what is answered, and the exit code.

#[test]
fn transcripts() {
    trycmd::TestCases::new().case("tests/cmd/*.trycmd");
}
