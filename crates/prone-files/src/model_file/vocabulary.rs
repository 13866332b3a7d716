//! The elements and attributes of MJCF that a robot may have, and what their values may be.
//!
//! Everything else is refused. The names are those of the format's reference,
//! <https://mujoco.readthedocs.io/en/stable/XMLreference.html>.

use strsim::osa_distance;

use super::value::{Bound, Value};
use Value::{Class, ClassName, Ignored, Impedance, Name, Numbers, Softness, Word};

/// An element, and what may stand in it.
pub(super) struct Element {
    pub(super) name: &'static str,
    /// What the engine is given of it.
    pub(super) passed: Passed,
    /// Most elements of this name.
    pub(super) most: usize,
    attributes: &'static [Attributes],
}

/// What becomes of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Passed {
    /// The engine reads it.
    On,
    /// The program does without it, and with all that is in it: it states such things itself.
    Not,
}

type Attributes = &'static [(&'static str, Value)];

impl Element {
    /// What the value of an attribute may be; nothing where the element has none of that name.
    pub(super) fn value(&self, attribute: &str) -> Option<Value> {
        let mut all = self.attributes.iter().flat_map(|some| some.iter());
        all.find(|(name, _)| *name == attribute)
            .map(|(_, value)| *value)
    }

    /// The attribute that may have been meant, where one is near.
    pub(super) fn nearest(&self, attribute: &str) -> Option<&'static str> {
        /// One letter more, less, wrong or exchanged.
        const NEAR: usize = 1;
        let mut all = self.attributes.iter().flat_map(|some| some.iter());
        all.find(|(name, _)| osa_distance(name, attribute) <= NEAR)
            .map(|(name, _)| *name)
    }
}

/// The element that may have been meant, where one is near.
pub(super) fn nearest_element(name: &str) -> Option<&'static str> {
    /// Two letters more, less, wrong or exchanged.
    const NEAR: usize = 2;
    let names = ELEMENTS.iter().map(|element| element.name);
    let near = names.map(|known| (osa_distance(known, name), known));
    let nearest = near.filter(|(edits, _)| *edits <= NEAR).min();
    nearest.map(|(_, known)| known)
}

/// The element of that name.
pub(super) fn element(name: &str) -> Option<&'static Element> {
    ELEMENTS.iter().find(|element| element.name == name)
}

const fn on(name: &'static str, most: usize, attributes: &'static [Attributes]) -> Element {
    Element {
        name,
        passed: Passed::On,
        most,
        attributes,
    }
}

const fn not(name: &'static str) -> Element {
    Element {
        name,
        passed: Passed::Not,
        most: 1_000,
        attributes: &[],
    }
}

const fn numbers(most: usize, bound: Bound) -> Value {
    Numbers { most, bound }
}

const ANY: Bound = Bound::ANY;
const ONE: Value = numbers(1, ANY);
const THREE: Value = numbers(3, ANY);
const COLOUR: Value = numbers(4, ANY);

/// A wall of elements would take the engine minutes, as its time grows with their square. The largest
/// humanoids have some 60 bodies.
const BODIES: usize = 250;
const SHAPES: usize = 2_000;
const CLASSES: usize = 200;
const FEW: usize = 500;

const PLACE: Attributes = &[
    ("pos", THREE),
    ("quat", numbers(4, ANY)),
    ("axisangle", numbers(4, ANY)),
    ("xyaxes", numbers(6, ANY)),
    ("zaxis", THREE),
    ("euler", THREE),
];

const NAMED: Attributes = &[("name", Name), ("class", ClassName)];

const SHAPE: Attributes = &[
    ("type", Word),
    ("size", THREE),
    ("fromto", numbers(6, ANY)),
    ("group", ONE),
    ("material", Name),
    ("rgba", COLOUR),
];

const SOFT: Attributes = &[("solref", Softness), ("solimp", Impedance)];

const CONTACT: Attributes = &[
    ("condim", ONE),
    ("friction", numbers(5, Bound::FRICTION)),
    ("margin", ONE),
    ("gap", ONE),
];

const ENDS: Attributes = &[
    ("body1", Name),
    ("body2", Name),
    ("site1", Name),
    ("site2", Name),
    ("anchor", THREE),
];

const ELEMENTS: &[Element] = &[
    on("mujoco", 1, &[&[("model", Ignored)]]),
    on(
        "compiler",
        10,
        &[&[
            ("alignfree", Word),
            ("angle", Word),
            ("assetdir", Ignored),
            ("autolimits", Word),
            ("balanceinertia", Word),
            ("boundinertia", numbers(1, Bound::LEAST_INERTIA)),
            ("boundmass", numbers(1, Bound::LEAST_MASS)),
            ("coordinate", Word),
            ("discardvisual", Word),
            ("eulerseq", Word),
            ("fitaabb", Word),
            ("fusestatic", Word),
            ("inertiafromgeom", Word),
            ("inertiagrouprange", numbers(2, ANY)),
            ("meshdir", Ignored),
            ("settotalmass", numbers(1, Bound::TOTAL_MASS)),
            ("strippath", Ignored),
            ("texturedir", Ignored),
            ("usethread", Ignored),
        ]],
    ),
    not("lengthrange"),
    // What a world is simulated with, seen by and scaled by is the program's.
    not("option"),
    not("flag"),
    not("visual"),
    not("global"),
    not("quality"),
    not("headlight"),
    not("map"),
    not("scale"),
    not("rgba"),
    not("statistic"),
    // Defaults of actuators that the model does not have.
    not("general"),
    not("motor"),
    not("position"),
    not("velocity"),
    not("intvelocity"),
    not("pid"),
    not("damper"),
    on("default", CLASSES, &[&[("class", Class)]]),
    on("asset", 10, &[]),
    on(
        "material",
        FEW,
        &[
            NAMED,
            &[
                ("emission", ONE),
                ("metallic", ONE),
                ("reflectance", ONE),
                ("rgba", COLOUR),
                ("roughness", ONE),
                ("shininess", ONE),
                ("specular", ONE),
                ("texrepeat", numbers(2, ANY)),
                ("texuniform", Word),
            ],
        ],
    ),
    on("worldbody", 10, &[]),
    on(
        "body",
        BODIES,
        &[
            &[
                ("name", Name),
                ("childclass", ClassName),
                ("gravcomp", numbers(1, Bound::GRAVITY_COMPENSATION)),
            ],
            PLACE,
        ],
    ),
    on(
        "frame",
        FEW,
        &[&[("name", Name), ("childclass", ClassName)], PLACE],
    ),
    on(
        "inertial",
        BODIES,
        &[
            &[
                ("mass", numbers(1, Bound::MASS)),
                ("diaginertia", numbers(3, Bound::INERTIA)),
                ("fullinertia", numbers(6, ANY)),
            ],
            PLACE,
        ],
    ),
    on(
        "freejoint",
        1,
        &[&[("name", Name), ("group", ONE), ("align", Word)]],
    ),
    // Of a body, of a default class, and of an equality.
    on(
        "joint",
        2 * BODIES + CLASSES,
        &[
            NAMED,
            SOFT,
            &[
                ("type", Word),
                ("axis", THREE),
                ("pos", THREE),
                ("range", Value::Range),
                ("limited", Word),
                ("group", ONE),
                ("armature", numbers(1, Bound::ARMATURE)),
                ("damping", numbers(1, Bound::DAMPING)),
                ("stiffness", numbers(1, Bound::SPRING)),
                ("springref", ONE),
                ("frictionloss", numbers(1, Bound::FRICTION_LOSS)),
                ("margin", numbers(1, Bound::JOINT_MARGIN)),
                ("ref", ONE),
                ("actuatorfrcrange", numbers(2, ANY)),
                ("actuatorfrclimited", Word),
                ("actuatorgravcomp", Word),
                ("solreflimit", Softness),
                ("solimplimit", Impedance),
                ("solreffriction", Softness),
                ("solimpfriction", Impedance),
                ("active", Word),
                ("joint1", Name),
                ("joint2", Name),
                ("polycoef", numbers(5, ANY)),
            ],
        ],
    ),
    on(
        "geom",
        SHAPES,
        &[
            NAMED,
            PLACE,
            SHAPE,
            CONTACT,
            SOFT,
            &[
                ("mass", numbers(1, Bound::MASS)),
                ("density", numbers(1, Bound::DENSITY)),
                ("shellinertia", Word),
                ("contype", ONE),
                ("conaffinity", ONE),
                ("priority", ONE),
                ("solmix", ONE),
            ],
        ],
    ),
    on("site", SHAPES, &[NAMED, PLACE, SHAPE]),
    on(
        "camera",
        FEW,
        &[
            NAMED,
            PLACE,
            &[
                ("mode", Word),
                ("fovy", ONE),
                ("ipd", ONE),
                ("focal", numbers(2, ANY)),
                ("focalpixel", numbers(2, ANY)),
                ("principal", numbers(2, ANY)),
                ("principalpixel", numbers(2, ANY)),
                ("sensorsize", numbers(2, ANY)),
                ("resolution", numbers(2, Bound::PIXELS)),
                ("projection", Word),
                ("target", Name),
            ],
        ],
    ),
    on(
        "light",
        FEW,
        &[
            NAMED,
            &[
                ("mode", Word),
                ("type", Word),
                ("target", Name),
                ("pos", THREE),
                ("dir", THREE),
                ("ambient", THREE),
                ("diffuse", THREE),
                ("specular", THREE),
                ("attenuation", THREE),
                ("active", Word),
                ("castshadow", Word),
                ("directional", Word),
                ("bulbradius", ONE),
                ("cutoff", ONE),
                ("exponent", ONE),
                ("intensity", ONE),
                ("range", ONE),
                ("softness", ONE),
            ],
        ],
    ),
    on("contact", 10, &[]),
    on(
        "pair",
        FEW,
        &[
            NAMED,
            CONTACT,
            SOFT,
            &[
                ("geom1", Name),
                ("geom2", Name),
                ("solreffriction", Softness),
            ],
        ],
    ),
    on("exclude", FEW, &[NAMED, ENDS]),
    on("equality", FEW, &[NAMED, SOFT, &[("active", Word)]]),
    on("connect", FEW, &[NAMED, SOFT, ENDS, &[("active", Word)]]),
    on("sensor", 10, &[]),
    // All that may be said of a sensor of the inertial unit. What else the engine reads of one is
    // memory (a history of samples), or what the program adds (noise).
    on("accelerometer", FEW, &[&[("name", Name), ("site", Name)]]),
    on("gyro", FEW, &[&[("name", Name), ("site", Name)]]),
];

/// Why an element is not read, of those that MJCF has.
pub(super) fn refusal(element: &str) -> Option<&'static str> {
    let reason = match element {
        "actuator" => "servos are added by the program, from robot.toml",
        "keyframe" => "postures are in robot.toml",
        "size" => "the engine finds its sizes itself",
        "include" | "attach" | "model" => "a model is one file",
        "weld" => "bodies that do not move against each other are one body, or fixed to it",
        "extension" | "plugin" => "the engine runs without plugins",
        "mesh" | "hfield" | "skin" | "texture" | "deformable" | "flex" | "flexcomp"
        | "composite" => "robots are made of primitives",
        _ => return None,
    };
    Some(reason)
}

/// Why an attribute is not read.
pub(super) fn attribute_refusal(element: &str, attribute: &str) -> &'static str {
    match (element, attribute) {
        ("accelerometer" | "gyro", _) => {
            "a sensor has a name and a site; its noise is in robot.toml"
        }
        (_, "file") => "a model is one file",
        (_, "user") => "nothing uses such numbers, and their memory has no bound",
        (_, "mesh" | "hfield" | "texture") => "robots are made of primitives",
        (_, "adhesion" | "surfacevel" | "fluidshape" | "fluidcoef") => {
            "contacts, and the air around, are the program's"
        }
        (_, "springdamper") => "stiffness and damping of a joint are stated",
        _ => "a robot needs none",
    }
}
