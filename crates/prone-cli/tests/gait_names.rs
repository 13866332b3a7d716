//! No code knows a gait by its name: which are used is data, but for the published study.

use std::fs;
use std::path::{Path, PathBuf};

use prone_files::shipped;

/// What ships is listed once, and the published study has two gaits and a cycle.
const MAY: [&str; 2] = [
    "prone-files/src/shipped.rs",
    "prone-thesis/src/published.rs",
];

/// Words that are names of gaits too.
const OTHER_MEANING: [(&str, &str); 1] = [
    // A motor's torque.
    ("prone-report/src/report/card_sections.rs", "nominal"),
];

/// The name of a cycle that is a word of every other file: whether the cycle is meant cannot be seen.
const EVERYWHERE: &str = "robot";

#[test]
fn no_gait_is_named_in_code() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let names: Vec<&str> = shipped::gait_names()
        .chain(shipped::cycle_names())
        .filter(|name| *name != EVERYWHERE)
        .collect();
    let mut found = Vec::new();
    for path in sources(&crates) {
        let inside = path.strip_prefix(&crates).unwrap().to_str().unwrap();
        if MAY.contains(&inside) {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
        for (number, line) in code.lines().enumerate() {
            let line = line.split("//").next().unwrap();
            let named = names.iter().filter(|name| {
                line.contains(&format!("\"{name}\"")) && !OTHER_MEANING.contains(&(inside, name))
            });
            found.extend(named.map(|name| format!("{inside}:{}: {name}", number + 1)));
        }
    }
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

/// Every source file of the crates that is none of tests.
fn sources(crates: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders: Vec<PathBuf> = fs::read_dir(crates)
        .unwrap()
        .map(|entry| entry.unwrap().path().join("src"))
        .filter(|folder| folder.is_dir())
        .collect();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let stem = path.file_stem().unwrap();
            if stem == "tests" || stem == "testing" {
                continue;
            }
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                found.push(path);
            }
        }
    }
    assert!(found.len() > 100, "the sources are not where they were");
    found
}
