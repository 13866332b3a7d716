use std::fs;

use super::*;

const ROWS: &str = "time_s,cycle,stage,s,x_mm,y_mm,z_mm,qw,qx,qy,qz,Knee_rad,Knee_nm,head_top_mm\n\
    0.02,1,pull,0.0,-300,0,50,1,0,0,0,0.1,0.5,170\n\
    0.04,1,pull,0.5,-299,0,51,1,0,0,0,0.2,,171\n\
    0.06,1,recovery,,-298,0,52,1,0,0,0,0.3,0.7,172\n";

const CONTACTS: &str = "time_s,body,with,x_mm,y_mm,z_mm,fx_n,fy_n,fz_n\n\
    0.0200,leg,floor,1,2,0,0,0,20\n\
    0.0600,trunk,plate 1,1,2,200,0,0,-5\n\
    0.0600,leg,floor,2,2,0,0,0,21\n";

const MODEL: &str = r#"{"bodies":[
    {"name":"trunk","parent":null,"joint":null,"position":[0.1000000001,0,0]},
    {"name":"leg","parent":0,"joint":{"name":"Knee"}}],
    "shapes":[],"chain":{},"obstacles":[]}"#;

fn run_json() -> String {
    let version = env!("CARGO_PKG_VERSION");
    format!(
        r#"{{"program":"prone","version":"{version}","command":"crawl run","gait":{{"name":"g"}},"scene":{{"name":"s"}}}}"#
    )
}

fn record(changes: &[(&str, Option<&str>)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let run = run_json();
    let whole = [
        (RUN_FILE, run.as_str()),
        (MODEL_FILE, MODEL),
        (ROWS_FILE, ROWS),
        (CONTACTS_FILE, CONTACTS),
    ];
    for (name, text) in whole {
        let change = changes.iter().find(|(changed, _)| *changed == name);
        if let Some(text) = change.map_or(Some(text), |(_, change)| *change) {
            fs::write(folder.path().join(name), text).unwrap();
        }
    }
    folder
}

fn message(changes: &[(&str, Option<&str>)]) -> String {
    let folder = record(changes);
    let message = read(folder.path()).unwrap_err().to_string();
    message.replace(&folder.path().display().to_string(), "RUN")
}

#[test]
fn a_whole_record_is_taken_whole() {
    let folder = record(&[]);
    let run = read(folder.path()).unwrap();
    assert_eq!((run.title(), run.rows()), ("g · s", 3));
    assert_eq!(run.notes(), [""; 0]);
    assert_eq!(
        run.stages,
        [(0, "pull".to_owned()), (2, "recovery".to_owned())]
    );
    assert_eq!(run.channels["y_mm"], Packed::Constant { constant: 0.0 });
    assert!(!run.channels.contains_key("stage"));
    assert_eq!(run.model["bodies"][0]["position"][0], 0.1);
    let contacts = run.contacts.unwrap();
    assert_eq!(contacts.counts, pack::counts(&[1, 0, 2]));
    assert_eq!(contacts.bodies, pack::counts(&[1, 0, 1]));
    assert_eq!(contacts.others, pack::counts(&[0, 1, 0]));
    assert_eq!(contacts.names, ["floor", "plate 1"]);
}

#[test]
fn what_stands_before_a_break_is_shown_and_said() {
    // A line that lost its end, a field that is no number, fewer fields, time that goes back.
    let cut = ROWS.len() - 4;
    let texts = [
        ROWS[..cut].to_owned(),
        ROWS.replace("0.06,1", "x.06,1"),
        ROWS.replace(",0.3,0.7,172", ""),
        ROWS.replace("0.06,1", "0.03,1"),
    ];
    for text in texts {
        let folder = record(&[(ROWS_FILE, Some(&text))]);
        let run = read(folder.path()).unwrap();
        assert_eq!(run.rows(), 2, "{text}");
        assert_eq!(
            run.notes(),
            ["rows.csv breaks off in line 4: the run is shown up to 0.04 s."]
        );
    }
    let folder = record(&[(CONTACTS_FILE, Some(&CONTACTS[..CONTACTS.len() - 3]))]);
    let run = read(folder.path()).unwrap();
    assert_eq!(
        run.notes(),
        ["contacts.csv breaks off in line 4: later contact forces are missing."]
    );
    let folder = record(&[(CONTACTS_FILE, None)]);
    let run = read(folder.path()).unwrap();
    assert!(run.notes()[0].starts_with("No contact forces are shown: cannot read "));
}

#[test]
fn what_is_no_record_is_refused_with_a_reason() {
    let version = env!("CARGO_PKG_VERSION");
    let other = run_json().replace(version, "9.9.9");
    let pull = run_json().replace("crawl run", "reproduce");
    let header = ROWS.lines().next().unwrap().to_owned() + "\n";
    let cases = [
        message(&[(RUN_FILE, None)]),
        message(&[(RUN_FILE, Some("{"))]),
        message(&[(RUN_FILE, Some("{}"))]),
        message(&[(RUN_FILE, Some(&pull))]),
        message(&[(RUN_FILE, Some(&other))]),
        message(&[(
            MODEL_FILE,
            Some(&MODEL.replace("\"parent\":0", "\"parent\":1")),
        )]),
        message(&[(ROWS_FILE, Some(&header))]),
        message(&[(ROWS_FILE, Some(&ROWS.replace("Knee_rad", "Hip_rad")))]),
    ];
    let said = [
        "RUN is not a recorded run: it holds no run.json",
        "RUN is not a recorded run: its run.json is not JSON",
        "RUN is not a recorded run: its run.json does not say that prone wrote it",
        "RUN is not a recorded run: it holds no crawl; `prone crawl run --record` makes one",
        &format!("RUN was recorded by prone 9.9.9, this is prone {version}: record it anew"),
        "RUN/model.json: body leg does not follow its parent",
        "RUN/rows.csv: it holds no whole row",
        "RUN/rows.csv: there is no column Knee_rad",
    ];
    assert_eq!(cases, said);
    let nowhere = read(Path::new("/no/such/run")).unwrap_err().to_string();
    assert_eq!(
        nowhere,
        "/no/such/run is not a recorded run: there is no such folder"
    );
}
