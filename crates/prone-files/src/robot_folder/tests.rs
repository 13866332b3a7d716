//! Families, versions and robots of their own, on disk.

use crate::shipped::NAO;

use super::*;

const FAMILY: &str = "name = \"nao\"\ndefault = \"v4\"\n";
const KEY: &str = "family = \"nao\"\n";

/// A home with some files, at paths within it.
fn home(files: &[(&str, &str)]) -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    for (path, text) in files {
        let path = home.path().join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    home
}

/// Two versions, the second of another name.
fn family(more: &str) -> tempfile::TempDir {
    let second = NAO.toml.replacen("NAO H25 V4", "NAO H25 V5", 2);
    let nominal = shipped::gait_file("nominal").unwrap().text;
    let low = shipped::gait_file("low-175").unwrap().text;
    home(&[
        ("nao/family.toml", &format!("{FAMILY}{more}")),
        ("nao/gaits/ours.toml", &nominal),
        ("nao/gaits/low.toml", &low),
        ("nao/v4/robot.toml", NAO.toml),
        ("nao/v4/robot.xml", NAO.mjcf),
        ("nao/v5/robot.toml", &second),
        ("nao/v5/robot.xml", NAO.mjcf),
    ])
}

fn said(path: &Path, home: &tempfile::TempDir) -> String {
    let message = RobotFiles::read(path).unwrap_err().to_string();
    message.replace(&format!("{}/", home.path().display()), "")
}

fn alone(toml: &str) -> String {
    toml.replacen(KEY, "", 1)
}

#[test]
fn a_family_s_folder_is_its_default_version() {
    let home = family("");
    let at = |path: &str| RobotFiles::read(&home.path().join(path)).unwrap();
    let files = at("nao");
    assert_eq!(files, at("nao/v4"));
    assert_eq!(files.hash(), RobotFiles::shipped(&NAO).hash());
    let version = files.version.clone().unwrap();
    assert_eq!(
        (version.family.as_str(), version.version.as_str()),
        ("nao", "v4")
    );
    assert!(files.folder.ends_with("/nao/v4"));
    let read = ["v4/robot.toml", "v4/robot.xml", "family.toml"];
    assert_eq!(
        files.read,
        read.map(|file| home.path().join("nao").join(file))
    );

    let other = at("nao/v5");
    assert_eq!(other.version.clone().unwrap().version, "v5");
    assert_ne!(other.hash(), files.hash());
    assert_eq!(other.gaits, files.gaits);
}

#[test]
fn a_version_is_found_by_any_path_to_its_folder() {
    let home = family("");
    std::os::unix::fs::symlink("v5", home.path().join("nao/latest")).unwrap();
    for path in [
        "nao/v5",
        "nao/v5/",
        "nao/v5/.",
        "nao/v4/../v5",
        "nao/v5/../v5",
        "nao/latest",
    ] {
        let files = RobotFiles::read(&home.path().join(path)).unwrap();
        assert_eq!(files.version.unwrap().version, "v5", "{path}");
    }
}

#[test]
fn a_robot_without_a_family_is_two_files_and_may_have_gaits() {
    let toml = alone(NAO.toml);
    let low = shipped::gait_file("low-175").unwrap().text;
    let home = home(&[
        ("bare/robot.toml", &toml),
        ("bare/robot.xml", NAO.mjcf),
        (
            "own/robot.toml",
            &format!("{toml}\n[defaults.cycle]\nfrom = [\"mine\"]\n"),
        ),
        ("own/robot.xml", NAO.mjcf),
        ("own/gaits/mine.toml", &low),
    ]);
    let bare = RobotFiles::read(&home.path().join("bare")).unwrap();
    assert_eq!((&bare.version, &bare.gaits), (&None, &Gaits::None));
    assert_eq!(
        bare.defaults().unwrap(),
        shipped::defaults(DefaultsTable::default()).unwrap()
    );

    let own = RobotFiles::read(&home.path().join("own")).unwrap();
    let defaults = own.defaults().unwrap();
    assert_eq!(defaults.cycle.from, ["mine"]);
    // Nothing says what is tried under a ceiling: its own, all of them.
    assert_eq!(defaults.cycle.under, ["mine"]);
    assert_eq!(defaults.pull.from, "nominal");
}

#[test]
fn what_a_version_says_goes_before_what_its_family_says() {
    let home = family("[defaults.pull]\nfrom = \"ours\"\ncompared = []\n");
    let v5 = home.path().join("nao/v5");
    let said = |files: RobotFiles| files.defaults().unwrap().pull;
    let family_s = said(RobotFiles::read(&v5).unwrap());
    assert_eq!(
        (family_s.from.as_str(), family_s.compared.len()),
        ("ours", 0)
    );
    assert_eq!(family_s.body_share_of, "optimal");

    let toml = fs::read_to_string(v5.join("robot.toml")).unwrap();
    let toml = format!("{toml}\n[defaults.pull]\nfrom = \"optimal\"\n");
    fs::write(v5.join("robot.toml"), toml).unwrap();
    let own = said(RobotFiles::read(&v5).unwrap());
    assert_eq!((own.from.as_str(), own.compared.len()), ("optimal", 0));
}

#[test]
fn versions_and_families_name_one_another() {
    let home = family("");
    let at = |path: &str| home.path().join(path);
    let write = |path: &str, text: &str| fs::write(at(path), text).unwrap();

    write(
        "nao/v5/robot.toml",
        &NAO.toml.replacen(KEY, "family = \"pepper\"\n", 1),
    );
    assert_eq!(
        said(&at("nao/v5"), &home),
        "nao/v5/robot.toml:3:10: the family of nao/family.toml is called \"nao\", not \"pepper\""
    );
    write("nao/v4/robot.toml", &alone(NAO.toml));
    assert_eq!(
        said(&at("nao"), &home),
        "nao/v4/robot.toml:1:1: a version names its family: the key family is missing"
    );
    write("nao/family.toml", &FAMILY.replace("v4", "v6"));
    assert_eq!(
        said(&at("nao"), &home),
        "nao/family.toml:2:11: there is no nao/v6/robot.toml"
    );
    write("nao/robot.toml", NAO.toml);
    assert!(said(&at("nao"), &home).contains("both a family.toml and a robot.toml"));
    fs::remove_file(at("nao/family.toml")).unwrap();
    fs::remove_file(at("nao/robot.toml")).unwrap();
    assert_eq!(
        said(&at("nao/v5"), &home),
        "nao/v5/robot.toml:3:10: there is no nao/family.toml: a version lies in its family's folder; a robot without a family has no key family"
    );
    fs::create_dir(at("nao/family.toml")).unwrap();
    assert_eq!(
        said(&at("nao"), &home),
        "cannot read nao/family.toml: it is not a regular file"
    );
}

#[test]
fn the_recorded_version_is_another_one_that_is_there() {
    let of = |more: &str, version: &str| {
        let home = family(more);
        let files = RobotFiles::read(&home.path().join(version)).unwrap();
        let recorded = files
            .recorded()
            .map(|files| files.and_then(|it| it.version));
        let recorded = recorded.map(|version| version.map(|it| it.version));
        let message = recorded.as_ref().err().map(ToString::to_string);
        let home = format!("{}/", home.path().display());
        (
            recorded.ok().flatten(),
            message.map(|message| message.replace(&home, "")),
        )
    };
    let v5 = "recorded = \"v5\"\n";
    for path in ["nao", "nao/v4"] {
        assert_eq!(of(v5, path), (Some("v5".to_owned()), None));
    }
    assert_eq!(of(v5, "nao/v5"), (None, None));
    assert_eq!(of("", "nao"), (None, None));
    let missing = "nao/family.toml:3:12: there is no nao/scene/robot.toml";
    assert_eq!(
        of("recorded = \"scene\"\n", "nao"),
        (None, Some(missing.to_owned()))
    );
}

#[test]
fn defaults_name_gaits_that_there_are() {
    for (line, expected) in [
        (
            "[defaults.pull]\nfrom = \"their\"",
            "4:8: there is no pull \"their\"; `prone list` shows all",
        ),
        (
            "[defaults.pull]\nfrom = \"low\"",
            "4:8: low is a cycle, not a pull",
        ),
        (
            "[defaults.cycle]\nunder = [\"low\", \"ours\"]",
            "4:17: ours is a pull, not a cycle",
        ),
    ] {
        let home = family(line);
        let message = said(&home.path().join("nao"), &home);
        assert_eq!(message, format!("nao/family.toml:{expected}"));
    }
}

#[test]
fn a_robot_that_ships_is_known_by_name() {
    let shipped = RobotFiles::shipped(&NAO);
    for name in ["nao", "nao/v4"] {
        assert_eq!(RobotFiles::named(Path::new(name)).unwrap(), shipped);
    }
    let message = RobotFiles::named(Path::new("nao/v0"))
        .unwrap_err()
        .to_string();
    assert_eq!(
        message,
        "there is no robot \"nao/v0\"; did you mean \"nao/v4\"? `prone list` shows all"
    );
    for (folder, name) in [
        ("robots/nao/", "nao"),
        ("elsewhere/robots/nao/v5", "nao/v5"),
    ] {
        let message = RobotFiles::named(Path::new(folder))
            .unwrap_err()
            .to_string();
        let built_in = format!(
            "there is no folder {folder:?}; that robot is built in, and needs none: its name is {name:?}"
        );
        assert_eq!(message, built_in);
    }
}

/// A file of a robot leads to its folder, or to what has to be done.
#[test]
fn a_file_is_taken_for_its_folder_or_refused_with_what_to_do() {
    let home = tempfile::tempdir().unwrap();
    let at = |name: &str| home.path().join(name);
    fs::create_dir(at("robot")).unwrap();
    let toml = shipped::NAO.toml.replacen("family = \"nao\"\n", "", 1);
    fs::write(at("robot/robot.toml"), toml).unwrap();
    fs::write(at("robot/robot.xml"), shipped::NAO.mjcf).unwrap();
    fs::write(at("a.urdf"), "<robot/>").unwrap();
    fs::write(at("a.xml"), "<mujoco/>").unwrap();
    let folder = RobotFiles::named(&at("robot")).unwrap();
    assert_eq!(RobotFiles::named(&at("robot/robot.toml")).unwrap(), folder);
    for (file, says) in [
        ("robot/robot.xml", "give its folder, "),
        ("a.urdf", "a URDF is not read: MuJoCo's `compile"),
        ("a.xml", "docs/robot.md says what its robot.toml holds"),
    ] {
        let error = RobotFiles::named(&at(file)).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
}
