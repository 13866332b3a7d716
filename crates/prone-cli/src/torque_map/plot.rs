//! `prone torque-map plot`.

use std::io::Write as _;

use anyhow::anyhow;

use prone::torque_map::{comments, parse};
use prone_record::figure_entry::FIGURES_FILE;
use prone_record::output;
use prone_study::torque_map::plot::{self, MapFile};

use crate::args::PlotArgs;
use crate::outputs::{Files, Kind};
use crate::printed;
use crate::{Failure, interrupt};

pub(crate) fn run(args: &PlotArgs) -> Result<(), Failure> {
    let name = args.map.display();
    let files = Files::default().reading(&args.map);
    let files = files.writing("--out", &args.out, Kind::Folder);
    files.check_made_by("torque-map plot")?;
    let text = super::text(&args.map)?;
    let map = parse(&text).map_err(|error| Failure::Input(anyhow!("{name}: {error}")))?;
    let slices = plot::slices(&map, &args.theta3_deg)
        .map_err(|error| Failure::Input(anyhow!("{name}: {error}")))?;
    let file = MapFile {
        name: name.to_string(),
        comments: comments(&text).collect(),
    };
    let artefacts =
        plot::artefacts(&map, &slices, &file, &crate::program()).map_err(Failure::work)?;
    interrupt::publish(|| Ok(output::publish(&args.out, &artefacts)?))?;
    let mut out = printed::out();
    let described = [output::RUN_FILE, FIGURES_FILE];
    for file in artefacts
        .keys()
        .filter(|file| !described.contains(&file.as_str()))
    {
        writeln!(out, "{}", args.out.join(file).display())?;
    }
    Ok(())
}
