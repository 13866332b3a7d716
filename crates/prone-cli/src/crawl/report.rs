//! What `prone crawl run` prints.

use std::io::{Result, Write};

use prone::robot::BodyPart;
use prone_record::crawl_summary::{CrawlSummary, PlateContact};

pub(crate) fn print(summary: &CrawlSummary, out: &mut dyn Write) -> Result<()> {
    let s = summary;
    writeln!(
        out,
        "{} on {}, scene {}: {} cycles in {:.1} s{}",
        s.gait,
        s.robot,
        s.scene,
        s.cycles,
        s.time_s,
        match s.arrived {
            Some(true) => ", past the obstacles",
            Some(false) => ", not past the obstacles",
            None => "",
        }
    )?;
    writeln!(
        out,
        "  path {:.1} mm: {:.1} mm per cycle, {:.1} mm/s; {:.1} mm ahead, {:+.1} mm to the left, heading {:+.1}°
  a cycle: {:.1} mm in the pull, {:.1} mm in the recovery; trunk and legs carry {:.0} % and {:.0} % of the weight",
        s.path_mm,
        s.mm_per_cycle,
        s.mm_per_s,
        s.distance_mm,
        s.lateral_mm,
        s.yaw_deg,
        s.pull_mm_per_cycle,
        s.recovery_mm_per_cycle,
        s.pull_body_share * 100.0,
        s.recovery_body_share * 100.0
    )?;
    match s.pull_efficiency.zip(s.stride_efficiency) {
        Some((pull, cycle)) => writeln!(
            out,
            "  stride of the planned chain {:.1} mm: pulls make {:.0} % of it, whole cycles {:.0} %",
            s.stride_mm,
            pull * 100.0,
            cycle * 100.0
        )?,
        None => writeln!(
            out,
            "  stride of the planned chain {:.1} mm: the pull does not lead forward",
            s.stride_mm
        )?,
    }
    let tops = BodyPart::ALL.into_iter().zip(s.top_mm.to_array());
    let tops: Vec<_> = tops
        .map(|(part, top)| format!(" {} {top:.1}", part.name()))
        .collect();
    writeln!(out, "  highest points, mm:{}", tops.concat())?;
    writeln!(
        out,
        "  peak torque {:.2} of the effort limit ({}); demanded of a shoulder {:.2} N·m, more than its limit {:.1} % of the time",
        s.peak_torque_over_rated,
        s.peak_torque_joint,
        s.demanded_peak_shoulder_nm,
        s.saturated_shoulder_share * 100.0
    )?;
    let percent = s.saturated_share * 100.0;
    match &s.saturated_joint {
        Some(joint) => writeln!(
            out,
            "  at the effort limit {percent:.1} % of the time ({joint})"
        )?,
        None => writeln!(out, "  never at an effort limit")?,
    }
    if let Some((heat, cost)) = s.heat_per_metre_s.zip(s.cost_of_transport) {
        writeln!(
            out,
            "  motor heat {heat:.0} s per metre; cost of transport {cost:.2} (positive work {:.1} J)",
            s.work_j
        )?;
    }
    print_touched_and_stopped(s, out)
}

fn print_touched_and_stopped(s: &CrawlSummary, out: &mut dyn Write) -> Result<()> {
    if s.contacts.is_empty() {
        writeln!(out, "  touched no plate or panel")?;
    }
    for contact in &s.contacts {
        let PlateContact {
            body,
            obstacle,
            count,
            first_s,
            seconds,
            peak_n,
        } = contact;
        writeln!(
            out,
            "  touched {obstacle}: {body}, {count} times from {first_s:.2} s on, {seconds:.2} s in all, up to {peak_n:.1} N"
        )?;
    }
    for clamp in &s.clamps {
        writeln!(
            out,
            "  {} is stopped at its limit in the plan: {:+.2}° cut off at most",
            clamp.joint, clamp.largest_deg
        )?;
    }
    for stop in &s.calibration_stops {
        writeln!(
            out,
            "  {} is stopped at its limit in {} commands, as its calibration is off: {:+.2}° cut off at most",
            stop.joint, stop.commands, stop.largest_deg
        )?;
    }
    Ok(())
}
