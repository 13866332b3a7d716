//! The model of a robot, MJCF, before the engine reads it.
//!
//! The engine ends the process, or reads beyond its memory, over some texts that no robot of primitives
//! needs: memory sizes, height fields, pictures of negative size, names of undefined classes, which it
//! takes for formats. Others keep it at work for minutes. So what a robot may say is listed, element by
//! element and attribute by attribute, and everything else is refused at its place; and the engine is not
//! given the file's text, but one that is written anew of what was checked ([`ModelFile::text`]).

mod text;
mod value;
mod vocabulary;

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::{Document, Node, ParsingOptions};

use prone::foreign_text;

use crate::FileError;
use crate::part_name;
use vocabulary::Passed;

/// Most elements of a model.
const MOST_ELEMENTS: usize = 5_000;

/// Most nodes of its text, blanks and comments included.
const MOST_NODES: u32 = 50_000;

/// Deepest nesting. A chain of hinges from a humanoid's trunk to its finger tips has some 15.
const DEEPEST: usize = 100;

/// A model that may be given to the engine.
#[derive(Debug, Clone)]
pub struct ModelFile {
    file: String,
    text: String,
    places: BTreeMap<(&'static str, String), Places>,
}

/// Line and column, from 1.
type Place = (usize, usize);

/// Where a part stands, and each of its attributes.
#[derive(Debug, Clone)]
struct Places {
    element: Place,
    attributes: Vec<(String, Place)>,
}

/// What a place is looked up for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModelPart {
    /// A body.
    Body,
    /// The `<inertial>` of a body, found by the body's name.
    Inertial,
    /// A joint.
    Joint,
    /// A shape.
    Geom,
    /// A site.
    Site,
    /// The `<compiler>`, which has no name.
    Compiler,
}

impl ModelPart {
    /// Its element of MJCF.
    pub const fn element(self) -> &'static str {
        match self {
            Self::Body => "body",
            Self::Inertial => "inertial",
            Self::Joint => "joint",
            Self::Geom => "geom",
            Self::Site => "site",
            Self::Compiler => "compiler",
        }
    }
}

impl ModelFile {
    /// Checks a text; `file` is the name that errors carry.
    ///
    /// # Errors
    /// [`FileError`] at the first element, attribute or value that a robot may not have.
    pub fn parse(file: &str, text: &str) -> Result<Self, FileError> {
        Reader::new(file, text).read()
    }

    /// What the engine is given: the listed elements with their checked attributes, each on the line that
    /// it has in the file.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The file's name, as errors carry it.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// An error at an attribute of a named part of the model, or at the part where the attribute is not
    /// stated there, as of a value that a default class has.
    pub fn error_at(
        &self,
        part: ModelPart,
        name: &str,
        attribute: &str,
        message: String,
    ) -> FileError {
        // A body whose inertia is that of its shapes has no element of its own for it.
        let places = self
            .places(part, name)
            .or_else(|| self.places(ModelPart::Body, name));
        let (line, column) = places.map_or((1, 1), |places| {
            let mut attributes = places.attributes.iter();
            let stated = attributes.find(|(stated, _)| stated == attribute);
            stated.map_or(places.element, |(_, place)| *place)
        });
        FileError {
            file: self.file.clone(),
            line,
            column,
            message,
        }
    }

    /// Whether a named part of the model states an attribute.
    pub fn states(&self, part: ModelPart, name: &str, attribute: &str) -> bool {
        let places = self.places(part, name);
        places.is_some_and(|places| places.attributes.iter().any(|(it, _)| it == attribute))
    }

    fn places(&self, part: ModelPart, name: &str) -> Option<&Places> {
        self.places.get(&(part.element(), name.to_owned()))
    }
}

/// A text that is being checked.
struct Reader<'a> {
    file: &'a str,
    text: &'a str,
    /// Where each line begins, bytes.
    lines: Vec<usize>,
}

impl<'a> Reader<'a> {
    fn new(file: &'a str, text: &'a str) -> Self {
        let newlines = text.match_indices('\n').map(|(offset, _)| offset + 1);
        let lines = std::iter::once(0).chain(newlines).collect();
        Self { file, text, lines }
    }

    fn read(&self) -> Result<ModelFile, FileError> {
        if let Some(offset) = self.text.find('\0') {
            // A C string ends there.
            return Err(self.error(offset, "a zero byte in a text file".to_owned()));
        }
        let options = ParsingOptions {
            nodes_limit: MOST_NODES,
            ..ParsingOptions::default()
        };
        let document = Document::parse_with_options(self.text, options)
            .map_err(|source| self.malformed(&source))?;
        let classes: BTreeSet<&str> = document
            .descendants()
            .filter(|node| node.has_tag_name("default"))
            .filter_map(|node| node.attribute("class"))
            // The class of the outermost <default> where that states none.
            .chain(["main"])
            .collect();
        let mut kept = Kept::default();
        self.check(document.root_element(), &classes, 1, &mut kept)?;
        self.check_names(&document)?;
        Ok(ModelFile {
            file: self.file.to_owned(),
            text: text::written(document.root_element(), |offset| self.place(offset).0),
            places: kept.places,
        })
    }

    fn check(
        &self,
        node: Node<'_, '_>,
        classes: &BTreeSet<&str>,
        depth: usize,
        kept: &mut Kept,
    ) -> Result<(), FileError> {
        let at = node.range().start;
        let name = node.tag_name().name();
        if node.tag_name().namespace().is_some() {
            let message = format!(
                "<{}> has a namespace; MJCF has none",
                foreign_text::cut(name)
            );
            return Err(self.error(at, message));
        }
        let Some(element) = vocabulary::element(name) else {
            let reason = match (vocabulary::refusal(name), vocabulary::nearest_element(name)) {
                (Some(reason), _) => reason.to_owned(),
                (None, Some(meant)) => format!("did you mean <{meant}>?"),
                (None, None) => "a robot needs none".to_owned(),
            };
            let message = format!("<{}> is not read here: {reason}", foreign_text::cut(name));
            return Err(self.error(at, message));
        };
        if element.passed == Passed::Not {
            return Ok(());
        }
        kept.count(element)
            .map_err(|message| self.error(at, message))?;
        if depth > DEEPEST {
            return Err(self.error(at, format!("elements are nested deeper than {DEEPEST}")));
        }
        for attribute in node.attributes() {
            let (name, at) = (attribute.name(), attribute.range().start);
            let value = element
                .value(name)
                .filter(|_| attribute.namespace().is_none());
            let Some(value) = value else {
                let reason = match element.nearest(name) {
                    Some(meant) => format!("did you mean {meant}?"),
                    None => vocabulary::attribute_refusal(element.name, name).to_owned(),
                };
                let (name, element) = (foreign_text::cut(name), element.name);
                let message = format!("{name} of <{element}> is not read here: {reason}");
                return Err(self.error(at, message));
            };
            let checked = value.check(attribute.value(), |class| classes.contains(class));
            checked.map_err(|message| self.error(at, format!("{name}: {message}")))?;
        }
        let ties = name == "joint" && node.parent().is_some_and(|it| it.has_tag_name("equality"));
        if ties && let Some(message) = wrong_tie(node) {
            return Err(self.error(at, message));
        }
        if let Some(text) = node.children().find(|it| is_written(*it)) {
            let message = format!("text within <{name}>: MJCF says all in attributes");
            return Err(self.error(text.range().start, message));
        }
        self.keep(node, element.name, kept);
        for child in node.children().filter(Node::is_element) {
            self.check(child, classes, depth + 1, kept)?;
        }
        Ok(())
    }

    /// Remembers where a part that errors may be about stands.
    fn keep(&self, node: Node<'_, '_>, element: &'static str, kept: &mut Kept) {
        let name = match element {
            "compiler" => Some(""),
            "inertial" => node.parent().and_then(|body| body.attribute("name")),
            _ => node.attribute("name"),
        };
        let Some(name) = name else {
            return;
        };
        let attributes = node.attributes();
        let attributes = attributes
            .map(|it| (it.name().to_owned(), self.place(it.range().start)))
            .collect();
        let places = Places {
            element: self.place(node.range().start),
            attributes,
        };
        kept.places.insert((element, name.to_owned()), places);
    }

    /// Names of bodies, joints, sites and shapes: each kind's are unlike each other.
    fn check_names(&self, document: &Document<'_>) -> Result<(), FileError> {
        let in_bodies = || {
            document
                .descendants()
                .filter(|it| it.ancestors().any(|it| it.has_tag_name("worldbody")))
        };
        for kind in ["body", "joint", "site", "geom"] {
            let named: Vec<(&str, usize)> = in_bodies()
                .filter(|node| node.has_tag_name(kind))
                .filter_map(|node| node.attribute_node("name"))
                .map(|name| (name.value(), name.range().start))
                .collect();
            for (name, at) in &named {
                let checked = match kind {
                    "body" => part_name::check_body(name),
                    "joint" => part_name::check_joint(name),
                    _ => Ok(()),
                };
                checked.map_err(|error| self.error(*at, error.to_string()))?;
            }
            let names = named.iter().map(|(name, _)| *name);
            part_name::check_distinct(kind, names)
                .map_err(|(index, error)| self.error(named[index].1, error.to_string()))?;
        }
        Ok(())
    }

    fn malformed(&self, source: &roxmltree::Error) -> FileError {
        let message = source.to_string();
        let place = source.pos();
        let message = if matches!(source, roxmltree::Error::NodesLimitReached) {
            format!("more than {MOST_NODES} elements, comments and blanks between them")
        } else {
            // The place is said before the message here.
            message.replacen(&format!(" at {place}"), "", 1)
        };
        FileError {
            file: self.file.to_owned(),
            line: place.row as usize,
            column: place.col as usize,
            message: foreign_text::message(&message),
        }
    }

    fn error(&self, offset: usize, message: String) -> FileError {
        let (line, column) = self.place(offset);
        FileError {
            file: self.file.to_owned(),
            line,
            column,
            message,
        }
    }

    fn place(&self, offset: usize) -> Place {
        let line = self.lines.partition_point(|&start| start <= offset);
        let start = self.lines[line - 1];
        let before = self.text.get(start..offset).unwrap_or_default();
        (line, before.chars().count() + 1)
    }
}

/// What has been met so far.
#[derive(Default)]
struct Kept {
    elements: usize,
    of_each: BTreeMap<&'static str, usize>,
    places: BTreeMap<(&'static str, String), Places>,
}

impl Kept {
    fn count(&mut self, element: &vocabulary::Element) -> Result<(), String> {
        self.elements += 1;
        let of_this = self.of_each.entry(element.name).or_default();
        *of_this += 1;
        if *of_this > element.most {
            return Err(format!(
                "more than {} elements <{}>: the engine would take minutes",
                element.most, element.name
            ));
        }
        if self.elements > MOST_ELEMENTS {
            return Err(format!(
                "more than {MOST_ELEMENTS} elements: the engine would take minutes"
            ));
        }
        Ok(())
    }
}

/// Why an equality of a joint ties it to no other joint; nothing of one that does.
fn wrong_tie(node: Node<'_, '_>) -> Option<String> {
    /// Turns of the one joint per turn of the other, in either sense.
    const RATIO: std::ops::RangeInclusive<f64> = 0.05..=20.0;
    if node.attribute("joint2").is_none() {
        return Some(
            "it holds a joint still, where a robot has none: it names no joint2".to_owned(),
        );
    }
    let polynomial = node.attribute("polycoef").unwrap_or("0 1 0 0 0");
    let factors: Vec<f64> = polynomial
        .split_ascii_whitespace()
        .filter_map(|word| word.parse().ok())
        .collect();
    let ratio = factors.get(1).map_or(1.0, |ratio| ratio.abs());
    let is_straight = factors.iter().skip(2).all(|factor| factor.abs() <= 0.0);
    if RATIO.contains(&ratio) && is_straight {
        return None;
    }
    Some(format!(
        "polycoef: a joint follows another in a straight line, with a ratio of {} to {}",
        RATIO.start(),
        RATIO.end()
    ))
}

/// Whether a node is text that says something.
fn is_written(node: Node<'_, '_>) -> bool {
    node.is_text() && node.text().is_some_and(|text| !text.trim().is_empty())
}

#[cfg(test)]
mod tests;
