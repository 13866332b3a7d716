use std::fmt::Write as _;

use super::*;
use crate::shipped;

fn parsed(text: &str) -> Result<ModelFile, FileError> {
    ModelFile::parse("robot.xml", text)
}

/// The NAO's model with one change.
fn changed(from: &str, to: &str) -> Result<ModelFile, FileError> {
    assert!(shipped::NAO.mjcf.contains(from), "{from}");
    parsed(&shipped::NAO.mjcf.replacen(from, to, 1))
}

const KNEE: &str = "<joint name=\"LKneePitch\"";

/// A robot of one body with something in it.
fn body(inside: &str) -> String {
    format!("<mujoco>\n<worldbody><body name=\"trunk\">{inside}</body></worldbody></mujoco>")
}

/// Each element stands on its line, and all that was said of it is there.
#[test]
fn identity_what_ships_is_given_to_the_engine_as_it_is() {
    for robot in [shipped::NAO, shipped::NAO_V5, shipped::NAO_OF_THE_SCENE] {
        let model = parsed(robot.mjcf).unwrap();
        let (ours, theirs) = (
            Document::parse(model.text()).unwrap(),
            Document::parse(robot.mjcf).unwrap(),
        );
        let said = |document: &Document<'_>| {
            let mut lines = Vec::new();
            for node in document.descendants().filter(Node::is_element) {
                let mut line = format!(
                    "{} {}",
                    document.text_pos_at(node.range().start).row,
                    node.tag_name().name()
                );
                for attribute in node.attributes().filter(|it| it.name() != "model") {
                    let words: Vec<&str> = attribute.value().split_whitespace().collect();
                    write!(line, " {}={}", attribute.name(), words.join(" ")).unwrap();
                }
                lines.push(line);
            }
            lines
        };
        assert_eq!(said(&ours), said(&theirs));
    }
}

#[test]
fn what_the_program_states_itself_never_reaches_the_engine() {
    let text = body("<freejoint/>").replace(
        "<worldbody>",
        "<option iterations=\"1000000000\" timestep=\"1e9\"><flag gravity=\"disable\"/></option>\
         <visual><global offwidth=\"100000\"/></visual><statistic meaninertia=\"1e9\"/>\
         <default><motor ctrlrange=\"-1 1\"/></default><compiler meshdir=\"%s\"/><worldbody>",
    );
    let model = parsed(&text).unwrap();
    for gone in [
        "option",
        "flag",
        "visual",
        "offwidth",
        "statistic",
        "motor",
        "meshdir",
        "%",
    ] {
        assert!(!model.text().contains(gone), "{gone} in {}", model.text());
    }
}

/// The engine takes the name of an undefined class for a format.
#[test]
fn limit_classes_are_defined_and_names_are_plain() {
    for (to, says) in [
        (
            " class=\"%s%s%s%s%s%s\"",
            "class: no <default> defines the class",
        ),
        (" class=\"%n\"", "class: no <default> defines the class"),
        (
            " class=\"visuel\"",
            "class: no <default> defines the class visuel",
        ),
        (" type=\"%p %p\"", "type: %p %p is no keyword"),
        (
            " margin=\"%100000000d 1\"",
            "margin: it has 1 number, not 2",
        ),
        (
            " margin=\"%100000000d\"",
            "margin: %100000000d is no number",
        ),
        (
            " user=\"1 2 3\"",
            "user of <joint> is not read here: nothing uses such numbers",
        ),
        (" group=\"1e400\"", "group: inf is outside"),
        (
            " damping=\"-50\"",
            "damping: -50 is outside 0..1000 N·m·s/rad: damping takes energy out",
        ),
        (" armature=\"-1\"", "armature: -1 is outside 0..100 kg·m²"),
        (
            " stiffness=\"-1000\"",
            "stiffness: -1000 is outside 0..100000 N·m/rad",
        ),
        (
            " frictionloss=\"-1\"",
            "frictionloss: -1 is outside 0..1000 N·m",
        ),
        (" solreflimit=\"-1 1\"", "solreflimit: -1 1 is neither"),
    ] {
        let error = changed(KNEE, &format!("{KNEE}{to}")).unwrap_err();
        assert!(error.message.contains(says), "{error}");
        let line = shipped::NAO
            .mjcf
            .lines()
            .position(|line| line.contains(KNEE))
            .unwrap();
        assert_eq!(error.line, line + 1, "{error}");
    }
    assert!(changed(KNEE, &format!("{KNEE} class=\"visual\"")).is_ok());
    let defined = "<default class=\"%s\"/>";
    assert!(changed("<default>", &format!("<default>{defined}")).is_err());
    let gravity = changed(
        "<body name=\"LTibia\"",
        "<body gravcomp=\"1\" name=\"LTibia\"",
    )
    .unwrap_err();
    assert!(
        gravity.message.ends_with("gravity acts on all of a robot"),
        "{gravity}"
    );
}

#[test]
fn limit_parts_have_names_that_every_format_takes() {
    for (from, to, says) in [
        (
            KNEE,
            "<joint name=\"L,Knee\"",
            "name: the name of a part is made of letters",
        ),
        (
            KNEE,
            "<joint name=\"\"",
            "name: the name of a part has 1 to 64 bytes, not 0",
        ),
        (
            KNEE,
            "<joint name=\"L.Hip_Roll\"/><joint name=\"L-Hip.Roll\"",
            "joint L-Hip.Roll is called like joint L.Hip_Roll",
        ),
        (
            KNEE,
            "<joint name=\"LKneePitch_cmd\"",
            "the column of a joint's command",
        ),
        (
            "<body name=\"LTibia\"",
            "<body name=\"world\"",
            "the frame of the ground",
        ),
        (
            "<body name=\"LTibia\"",
            "<body name=\"R-Tibia\"/><body name=\"R.Tibia\"",
            "is called like body",
        ),
    ] {
        let error = changed(from, to).unwrap_err();
        assert!(error.message.contains(says), "{error}");
    }
}

#[test]
fn limit_models_are_bounded_in_number_depth_and_length() {
    let many = |element: &str, count: usize| body(&element.repeat(count));
    let nested = format!("{}{}", "<frame>".repeat(200), "</frame>".repeat(200));
    let long = format!("<site pos=\"{}\"/>", "0 ".repeat(100_000));
    for (text, says) in [
        (
            many("<geom size=\".1\"/>", 2_001),
            "more than 2000 elements <geom>",
        ),
        (many("<site/>", 2_001), "more than 2000 elements <site>"),
        (many("<body/>", 250), "more than 250 elements <body>"),
        (
            many("<!-- -->\n", 100_000),
            "more than 50000 elements, comments and blanks",
        ),
        (body(&nested), "elements are nested deeper than 100"),
        (body(&long), "pos: 200000 bytes are more than 1000"),
        (body("words"), "text within <body>"),
        (
            body("<x:geom xmlns:x=\"urn:x\"/>"),
            "<geom> has a namespace",
        ),
        (
            body("<geom xmlns:x=\"urn:x\" x:size=\".1\"/>"),
            "size of <geom> is not read here",
        ),
    ] {
        let error = parsed(&text).unwrap_err();
        assert!(error.message.contains(says), "{error}");
        assert!(error.to_string().len() < 500, "{error}");
    }
}

/// What is malformed is said in the reader's words, once and whole.
#[test]
fn malformed_texts_keep_their_reason() {
    for (text, says) in [
        ("<mujoco><!-- a -- b --></mujoco>", "comment contains '--'"),
        (
            "<mujoco a=\"1\" a=\"2\"/>",
            "attribute 'a' is already defined",
        ),
        ("<mujoco>", "the root node was opened but never closed"),
    ] {
        let error = parsed(text).unwrap_err();
        assert!(error.message.contains(says), "{error}");
    }
}
