//! The model's text, before the engine reads it.
//!
//! The engine ends the process, or reads beyond its memory, over some texts that no robot of
//! primitives needs: memory sizes, height fields, pictures of negative size. So the elements that
//! a robot may have are listed, and every other one is refused at its place.

use roxmltree::{Attribute, Document, Node, TextPos};

use prone::robot::bounds;
use prone_files::FileError;

/// Checks elements, file references and numbers; `file` is the name that errors carry.
pub(super) fn check(file: &str, text: &str) -> Result<(), FileError> {
    let error = |place: TextPos, message: String| FileError {
        file: file.to_owned(),
        line: place.row as usize,
        column: place.col as usize,
        message,
    };
    check_no_nul(file, text)?;
    let document = Document::parse(text).map_err(|source| {
        // The reader ends its messages with the place, which is said before them here.
        let message = source.to_string();
        let message = message.split(" at ").next().unwrap_or_default();
        error(source.pos(), message.to_owned())
    })?;
    for node in document.descendants().filter(Node::is_element) {
        let at = |offset| document.text_pos_at(offset);
        let element = node.tag_name().name();
        if let Some(reason) = refusal(element) {
            let message = format!("<{element}> is not read here: {reason}");
            return Err(error(at(node.range().start), message));
        }
        for attribute in node.attributes() {
            check_attribute(element, &attribute)
                .map_err(|message| error(at(attribute.range().start), message))?;
        }
    }
    Ok(())
}

/// A C string ends where a zero byte stands.
fn check_no_nul(file: &str, text: &str) -> Result<(), FileError> {
    let Some(offset) = text.find('\0') else {
        return Ok(());
    };
    let before = &text[..offset];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    Err(FileError {
        file: file.to_owned(),
        line: before.matches('\n').count() + 1,
        column: before[line_start..].chars().count() + 1,
        message: "a zero byte in a text file".to_owned(),
    })
}

/// Why an element is not read; `None` for one that a robot may have.
fn refusal(element: &str) -> Option<&'static str> {
    let reason = match element {
        "accelerometer" | "asset" | "body" | "camera" | "compiler" | "connect" | "contact"
        | "default" | "equality" | "exclude" | "flag" | "frame" | "freejoint" | "geom" | "global"
        | "gyro" | "headlight" | "inertial" | "joint" | "light" | "map" | "material" | "mujoco"
        | "option" | "pair" | "quality" | "rgba" | "scale" | "sensor" | "site" | "statistic"
        | "visual" | "weld" | "worldbody"
        // Defaults of actuators that the model does not have.
        | "general" | "motor" | "position" | "velocity" | "intvelocity" => return None,
        "actuator" => "servos are added by the program, from robot.toml",
        "keyframe" => "postures are in robot.toml",
        "size" => "the engine finds its sizes itself",
        "include" | "attach" | "model" => "a model is one file",
        "extension" | "plugin" => "the engine runs without plugins",
        "mesh" | "hfield" | "skin" | "texture" | "deformable" | "flex" | "flexcomp"
        | "composite" => "robots are made of primitives",
        _ => "a robot needs none",
    };
    Some(reason)
}

fn check_attribute(element: &str, attribute: &Attribute) -> Result<(), String> {
    let (name, value) = (attribute.name(), attribute.value());
    // All that may be said of a sensor of the inertial unit. What else the engine reads of one is
    // memory (a history of samples), or what the program adds (noise).
    let is_sensor = ["accelerometer", "gyro"].contains(&element);
    if is_sensor && !["name", "site"].contains(&name) {
        return Err(format!(
            "{name} of <{element}> is not read here: a sensor has a name and a site; its noise is in robot.toml"
        ));
    }
    match name {
        "file" => {
            return Err(format!(
                "file {value:?} is not looked for: a model is one file"
            ));
        }
        // What holds a name, which may look like a number.
        "name" | "class" | "childclass" | "dclass" | "material" | "model" | "site" | "target"
        | "body1" | "body2" | "geom1" | "geom2" | "joint1" | "joint2" | "site1" | "site2" => {
            return Ok(());
        }
        _ => {}
    }
    let words = value.split_whitespace();
    for number in words.map_while(|word| word.parse::<f64>().ok()) {
        // Units differ, so this is no physical bound: those are checked on what the engine makes of
        // the text. A NaN is in no range.
        let largest = bounds::NUMBER;
        if !(-largest..=largest).contains(&number) {
            return Err(format!(
                "{name}: {number} is outside -{largest:e}..{largest:e}"
            ));
        }
    }
    Ok(())
}
