//! The model's text, before the engine reads it.
//!
//! The engine ends the process, or reads beyond its memory, over some texts that no robot of
//! primitives needs: memory sizes, height fields, pictures of negative size. So the elements that
//! a robot may have are listed, and every other one is refused at its place.

use roxmltree::{Attribute, Document, Node, TextPos};

use prone::robot::bounds;
use prone_files::FileError;

/// Elements of a model.
const ELEMENTS: [&str; 39] = [
    "accelerometer",
    "asset",
    "body",
    "camera",
    "compiler",
    "connect",
    "contact",
    "default",
    "equality",
    "exclude",
    "flag",
    "frame",
    "freejoint",
    "geom",
    "global",
    "gyro",
    "headlight",
    "inertial",
    "joint",
    "light",
    "map",
    "material",
    "mujoco",
    "option",
    "pair",
    "quality",
    "rgba",
    "scale",
    "sensor",
    "site",
    "statistic",
    "visual",
    "weld",
    "worldbody",
    // Defaults of actuators that the model does not have.
    "general",
    "motor",
    "position",
    "velocity",
    "intvelocity",
];

/// Attributes that hold a name, which may look like a number.
const NAMES: [&str; 16] = [
    "name",
    "class",
    "childclass",
    "dclass",
    "material",
    "model",
    "site",
    "target",
    "body1",
    "body2",
    "geom1",
    "geom2",
    "joint1",
    "joint2",
    "site1",
    "site2",
];

/// The sensors of an inertial unit, and all that may be said of one. What else the engine reads of
/// a sensor is memory (a history of samples), or what the program adds (noise).
const SENSORS: [&str; 2] = ["accelerometer", "gyro"];
const SENSOR_ATTRIBUTES: [&str; 2] = ["name", "site"];

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
        if let Some(reason) = refusal(&node) {
            let message = format!("<{}> is not read here: {reason}", node.tag_name().name());
            return Err(error(at(node.range().start), message));
        }
        for attribute in node.attributes() {
            check_sensor_attribute(node.tag_name().name(), &attribute)
                .and_then(|()| check_attribute(&attribute))
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

fn refusal(node: &Node) -> Option<&'static str> {
    let name = node.tag_name().name();
    let reason = match name {
        "actuator" => "servos are added by the program, from robot.toml",
        "keyframe" => "postures are in robot.toml",
        "size" => "the engine finds its sizes itself",
        "include" | "attach" | "model" => "a model is one file",
        "extension" | "plugin" => "the engine runs without plugins",
        "mesh" | "hfield" | "skin" | "texture" | "deformable" | "flex" | "flexcomp"
        | "composite" => "robots are made of primitives",
        _ if ELEMENTS.contains(&name) => return None,
        _ => "a robot needs none",
    };
    Some(reason)
}

fn check_sensor_attribute(element: &str, attribute: &Attribute) -> Result<(), String> {
    let name = attribute.name();
    if !SENSORS.contains(&element) || SENSOR_ATTRIBUTES.contains(&name) {
        return Ok(());
    }
    Err(format!(
        "{name} of <{element}> is not read here: a sensor has a name and a site; its noise is in robot.toml"
    ))
}

fn check_attribute(attribute: &Attribute) -> Result<(), String> {
    let (name, value) = (attribute.name(), attribute.value());
    if name == "file" {
        return Err(format!(
            "file {value:?} is not looked for: a model is one file"
        ));
    }
    if NAMES.contains(&name) {
        return Ok(());
    }
    for number in value
        .split_whitespace()
        .map_while(|word| word.parse::<f64>().ok())
    {
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
