//! No circle of imports inside any crate.
//!
//! An arrow runs from the module that names another one to the module that it names: in a `use`, in
//! a path such as `crate::robot::load`, or by declaring it (`mod`). A path leads to the deepest
//! module on it, and on to where the name behind that module comes from, if the module has it by a
//! `use` of its own: `pub use` hides no arrow. A module that uses what its parent or another ancestor
//! defines draws no arrow, so that a folder may share types in the file above it. Tests draw none
//! either. A `use` of everything (`*`) leads no further than its module.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// A module by the names that lead to it from the root of its crate, which has none.
type Module = Vec<String>;
/// The source text of the modules of one crate.
type Sources = BTreeMap<Module, String>;
/// The names that a module has by its `use`, with the paths that they stand for.
type Imports = BTreeMap<String, Module>;
/// Where the arrows of each module lead.
type Arrows = BTreeMap<Module, BTreeSet<Module>>;

#[test]
fn no_crate_has_a_circle_of_imports() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut found = Vec::new();
    for entry in fs::read_dir(crates).unwrap() {
        let folder = entry.unwrap().path();
        let source = folder.join("src");
        if source.is_dir() {
            let name = folder.file_name().unwrap().to_string_lossy().into_owned();
            let circles = circles(&arrows(&sources(&source)));
            found.extend(
                circles
                    .into_iter()
                    .map(|circle| format!("{name}: {circle}")),
            );
        }
    }
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn a_planted_circle_is_found() {
    let planted = [
        ("", "mod camera;\nmod robot;"),
        ("camera", "mod glass;\nmod light;\nuse light::Studio;"),
        ("camera::glass", "use super::{light::{Studio, on}, Lens};"),
        ("camera::light", "fn on() { crate::robot::stand() }"),
        (
            "robot",
            "/// As in [`crate::camera`].\nuse crate::camera::glass;",
        ),
    ];
    assert_eq!(
        circles(&arrows(&written(&planted))),
        ["camera::glass -> camera::light, camera::light -> robot, robot -> camera::glass"]
    );
}

#[test]
fn a_circle_through_a_re_export_is_found() {
    // As the figures had it: the check names a record by their parent, which has it from a child.
    let planted = [
        ("", "mod camera;"),
        (
            "camera",
            "mod check;\nmod glass;\nmod light;\npub use glass::{Lens as Eye, draw};\nstruct Failure;",
        ),
        ("camera::check", "use super::{Eye, Failure};"),
        (
            "camera::glass",
            "use super::{Failure, check};\nstruct Lens;",
        ),
        ("camera::light", "fn f() { super::draw() }"),
    ];
    assert_eq!(
        circles(&arrows(&written(&planted))),
        ["camera::check -> camera::glass, camera::glass -> camera::check"]
    );
}

#[test]
fn a_re_export_is_followed_through_others_and_through_a_module_of_another_name() {
    let planted = [
        ("", "mod camera;\nmod robot;\nuse robot as body;"),
        ("camera", "mod glass;\npub(crate) use glass::Lens;"),
        // What follows nested braces counts too.
        (
            "camera::glass",
            "use crate::{\n    camera::{Lens},\n    body::arm::lift,\n};",
        ),
        ("robot", "mod arm;\npub use crate::camera::Lens;"),
        ("robot::arm", "use super::Lens;"),
    ];
    assert_eq!(
        circles(&arrows(&written(&planted))),
        [
            "camera -> camera::glass, camera::glass -> robot::arm, robot::arm -> camera, robot::arm -> camera::glass"
        ]
    );
}

#[test]
fn a_child_that_uses_its_parents_types_is_no_circle() {
    let house = [
        ("", "mod camera;\npub struct Failure;"),
        (
            "camera",
            "mod glass;\nuse crate::Failure;\nstruct Lens;\nfn f() { glass::draw() }",
        ),
        (
            "camera::glass",
            "use super::Lens;\n// crate::camera::light\n#[cfg(test)]\nmod tests { use crate::camera::glass; }",
        ),
    ];
    assert_eq!(circles(&arrows(&written(&house))), Vec::<String>::new());
}

fn written(modules: &[(&str, &str)]) -> Sources {
    let of = |(path, text): &(&str, &str)| {
        let names = path.split("::").filter(|name| !name.is_empty());
        (names.map(str::to_owned).collect(), (*text).to_owned())
    };
    modules.iter().map(of).collect()
}

/// Reads the modules of a crate; a module of tests is none.
fn sources(folder: &Path) -> Sources {
    let mut sources = Sources::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        let paths = fs::read_dir(next)
            .unwrap()
            .map(|entry| entry.unwrap().path());
        for path in paths.collect::<Vec<PathBuf>>() {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let inside = path.strip_prefix(folder).unwrap().with_extension("");
                let names = inside
                    .iter()
                    .map(|part| part.to_string_lossy().into_owned());
                let module: Module = names
                    .filter(|name| !ROOTS.contains(&name.as_str()))
                    .collect();
                if module.last().is_none_or(|name| name != "tests") {
                    sources.insert(module, fs::read_to_string(path).unwrap());
                }
            }
        }
    }
    sources
}

/// Files that are named after no module of their own.
const ROOTS: [&str; 3] = ["lib", "main", "mod"];

fn arrows(sources: &Sources) -> Arrows {
    let codes: Sources = sources
        .iter()
        .map(|(module, text)| (module.clone(), code(text)))
        .collect();
    let modules: BTreeMap<Module, Imports> = codes
        .iter()
        .map(|(module, code)| (module.clone(), imports(code)))
        .collect();
    let arrows = codes.iter().map(|(module, code)| {
        let named = paths(code)
            .into_iter()
            .flat_map(|path| resolve(module, &path, &modules));
        (
            module.clone(),
            named.filter(|other| !module.starts_with(other)).collect(),
        )
    });
    arrows.collect()
}

/// A text without its tests and comments.
fn code(text: &str) -> String {
    let code = text
        .split("#[cfg(test)]\nmod tests {")
        .next()
        .unwrap_or_default();
    let lines = code
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default());
    lines.collect::<Vec<_>>().join("\n")
}

/// Every path with two names or more, trees of `use` taken apart, and `self::x` for a `mod x`.
fn paths(code: &str) -> Vec<Module> {
    let mut paths = Vec::new();
    let mut rest = code;
    while let Some(start) = rest.find(is_name) {
        let name = leading_name(&rest[start..]);
        let after = &rest[start + name.len()..];
        if after.starts_with("::") {
            let mut found = Vec::new();
            rest = unfold(&[], &rest[start..], &mut found);
            paths.extend(found.into_iter().map(|(path, _)| path));
        } else {
            if name == "mod" {
                let child = leading_name(after.trim_start());
                paths.push(vec!["self".to_owned(), child.to_owned()]);
            }
            rest = after;
        }
    }
    paths
}

/// The names that every `use` of a module brings.
fn imports(code: &str) -> Imports {
    let mut found = Vec::new();
    let mut rest = code;
    while let Some(start) = rest.find(is_name) {
        let name = leading_name(&rest[start..]);
        rest = &rest[start + name.len()..];
        if name == "use" {
            rest = unfold(&[], rest.trim_start(), &mut found);
        }
    }
    let named = found.into_iter().map(|(mut path, called)| {
        // `use light::{self}` brings `light`.
        path.pop_if(|last| last == "self");
        let called = called.or_else(|| path.last().cloned());
        (called.unwrap_or_default(), path)
    });
    named.collect()
}

/// Adds the paths that a tree stands for, each with the name that `as` gives it, and returns the text
/// behind it.
fn unfold<'t>(
    before: &[String],
    tree: &'t str,
    paths: &mut Vec<(Module, Option<String>)>,
) -> &'t str {
    let mut path = before.to_vec();
    let mut rest = tree;
    loop {
        let name = leading_name(rest);
        path.extend((!name.is_empty()).then(|| name.to_owned()));
        rest = &rest[name.len()..];
        match rest.strip_prefix("::") {
            Some(more) if more.starts_with(is_name) => rest = more,
            Some(more) if more.starts_with('{') => {
                rest = &more[1..];
                while !rest.trim_start().starts_with('}') && !rest.is_empty() {
                    rest = unfold(&path, rest.trim_start(), paths);
                    // A comma, a star, or a new name behind `as`.
                    let end = rest.find([',', '}']).unwrap_or(rest.len());
                    rest = rest[end..].strip_prefix(',').unwrap_or(&rest[end..]);
                }
                let behind = rest.trim_start();
                return behind.strip_prefix('}').unwrap_or(behind);
            }
            _ => break,
        }
    }
    let called = rest.trim_start().strip_prefix("as ");
    let called = called.map(|name| leading_name(name.trim_start()).to_owned());
    paths.push((path, called));
    rest
}

fn is_name(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

fn leading_name(text: &str) -> &str {
    &text[..text.find(|letter| !is_name(letter)).unwrap_or(text.len())]
}

/// Most re-exports that one name is followed through: more is a name that stands for itself.
const LONGEST_WAY: usize = 10;

/// The deepest module on a path, if it begins with one of this crate, and the modules that a name
/// behind it comes from.
fn resolve(module: &Module, path: &[String], modules: &BTreeMap<Module, Imports>) -> Vec<Module> {
    let mut found = Vec::new();
    let (mut here, mut path) = (module.clone(), path.to_vec());
    for _ in 0..LONGEST_WAY {
        let Some((deepest, left)) = descend(&here, &path, modules) else {
            break;
        };
        found.push(deepest.clone());
        let Some((name, behind)) = left.split_first() else {
            break;
        };
        let import = modules.get(&deepest).and_then(|imports| imports.get(name));
        let Some(import) = import else {
            break;
        };
        (here, path) = (deepest, [import, behind].concat());
    }
    found
}

/// The deepest module on a path, and the names behind it.
fn descend(
    module: &Module,
    path: &[String],
    modules: &BTreeMap<Module, Imports>,
) -> Option<(Module, Module)> {
    let mut here = module.clone();
    let mut names = path.iter().peekable();
    if names.next_if(|name| *name == "crate").is_some() {
        here.clear();
    }
    while let Some(name) = names.next_if(|name| ["self", "super"].contains(&name.as_str())) {
        if name == "super" {
            here.pop()?;
        }
    }
    while let Some(name) = names.peek() {
        here.push((*name).clone());
        if !modules.contains_key(&here) {
            here.pop();
            break;
        }
        names.next();
    }
    Some((here, names.cloned().collect()))
}

/// The arrows of each circle: of modules that lead to one another.
fn circles(arrows: &Arrows) -> Vec<String> {
    let reached: Arrows = arrows
        .keys()
        .map(|start| {
            let mut seen = BTreeSet::new();
            let mut next = vec![start];
            while let Some(ends) = next.pop().and_then(|module| arrows.get(module)) {
                next.extend(ends.iter().filter(|end| seen.insert((*end).clone())));
            }
            (start.clone(), seen)
        })
        .collect();
    let mut circles = BTreeSet::new();
    for start in arrows
        .keys()
        .filter(|start| reached[*start].contains(*start))
    {
        let inside: Vec<&Module> = reached[start]
            .iter()
            .filter(|end| reached.get(*end).is_some_and(|back| back.contains(start)))
            .collect();
        let lines = inside.iter().flat_map(|from| {
            let ends = arrows[*from].iter().filter(|end| inside.contains(end));
            ends.map(|end| format!("{} -> {}", from.join("::"), end.join("::")))
        });
        circles.insert(lines.collect::<Vec<_>>().join(", "));
    }
    circles.into_iter().collect()
}
