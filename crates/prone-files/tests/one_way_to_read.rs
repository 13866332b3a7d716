//! Files are read in one way: `prone_files::text_file` takes regular files of a bounded size only.

use std::fs;
use std::path::{Path, PathBuf};

/// What reads a file past it.
const BARE: [&str; 5] = [
    ".read(true)",
    "fs::read(",
    "read_to_string(",
    "File::open(",
    "fs::read_link(",
];

/// The developers' tool, which reads its own seeds and what its children leave.
const TOOL: &str = "prone-mutants";

/// Where that is right, and why.
const EXCEPTIONS: [(&str, &str); 3] = [
    (
        "prone-cli/src/interrupt.rs",
        "asks the system which signals are ignored",
    ),
    (
        "prone-record/src/output/staging.rs",
        "opens folders, to lock them",
    ),
    (
        "prone-cli/src/export/ffmpeg.rs",
        "reads what a program of ours says on its pipe",
    ),
];

#[test]
fn nothing_but_the_reader_opens_a_file() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut bare = Vec::new();
    for file in sources(crates) {
        let name = file.strip_prefix(crates).unwrap().display().to_string();
        let is_exception = EXCEPTIONS.iter().any(|(file, _)| name.ends_with(file));
        if is_exception || name == "prone-files/src/text_file.rs" {
            continue;
        }
        let text = fs::read_to_string(&file).unwrap();
        // Tests may read what they like.
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap();
        let lines = code.lines().enumerate();
        bare.extend(
            lines
                .filter(|(_, line)| BARE.iter().any(|it| line.contains(it)))
                .map(|(index, line)| format!("{name}:{}: {}", index + 1, line.trim())),
        );
    }
    assert!(bare.is_empty(), "{}", bare.join("\n"));
}

/// The code of all crates, without that of tests and build scripts.
fn sources(crates: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders: Vec<PathBuf> = fs::read_dir(crates)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|folder| folder.file_name().is_some_and(|name| name != TOOL))
        .map(|folder| folder.join("src"))
        .collect();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            if path.is_dir() && name != "tests" {
                folders.push(path);
            } else if path.extension().is_some_and(|it| it == "rs") && name != "tests.rs" {
                found.push(path);
            }
        }
    }
    assert!(found.len() > 100, "{} files", found.len());
    found
}
