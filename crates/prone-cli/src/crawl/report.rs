//! What `prone crawl run` prints.

use std::io::{Result, Write};

use prone::motor::HEAD_CARRIES;
use prone::robot::BodyPart;
use prone_record::crawl_summary::{CrawlSummary, PlateContact, ReasonSummary};

pub(crate) fn print(summary: &CrawlSummary, out: &mut dyn Write) -> Result<()> {
    let s = summary;
    let sentence = s.outcome.as_ref().map(|outcome| &*outcome.sentence);
    writeln!(
        out,
        "{} on {}, scene {}: {}",
        s.gait,
        s.robot,
        s.scene,
        sentence.unwrap_or("unknown")
    )?;
    writeln!(
        out,
        "  {} cycles in {:.1} s, path {:.1} mm: {:.1} mm per cycle, {:.1} mm/s; {:.1} mm ahead, {:+.1} mm to the left, heading {:+.1}°",
        s.cycles,
        s.time_s,
        s.path_mm,
        s.mm_per_cycle,
        s.mm_per_s,
        s.distance_mm,
        s.lateral_mm,
        s.yaw_deg
    )?;
    match s.stride_mm {
        Some(stride_mm) => print_pull(s, stride_mm, out)?,
        None => writeln!(
            out,
            "  no pull, waypoints alone; trunk, head and legs carry {:.0} % of the weight",
            s.recovery_body_share * 100.0
        )?,
    }
    let tops = BodyPart::ALL.into_iter().zip(s.top_mm.to_array());
    let tops: Vec<_> = tops
        .map(|(part, top)| format!(" {} {top:.1}", part.name()))
        .collect();
    writeln!(out, "  highest points, mm:{}", tops.concat())?;
    if let Some(width_mm) = s.width_mm {
        writeln!(out, "  width {width_mm:.1} mm, about its own heading")?;
    }
    let nearest = s.self_collision.iter();
    for collision in nearest.filter(|nearest| nearest.is_collision()) {
        writeln!(out, "  goes through itself: {}", collision.in_words())?;
    }
    print_motors(s, out)?;
    print_touched_and_stopped(s, out)
}

/// What the pulls and the ways back made of the stride of the planned chain, mm.
fn print_pull(s: &CrawlSummary, stride_mm: f64, out: &mut dyn Write) -> Result<()> {
    writeln!(
        out,
        "  a cycle: {:.1} mm in the pull, {:.1} mm in the recovery; trunk, head and legs carry {:.0} % and {:.0} % of the weight",
        s.pull_mm_per_cycle,
        s.recovery_mm_per_cycle,
        s.pull_body_share * 100.0,
        s.recovery_body_share * 100.0
    )?;
    match s.pull_efficiency.zip(s.stride_efficiency) {
        Some((pull, cycle)) => writeln!(
            out,
            "  stride of the planned chain {stride_mm:.1} mm: pulls make {:.0} % of it, whole cycles {:.0} %",
            pull * 100.0,
            cycle * 100.0
        ),
        None => writeln!(
            out,
            "  stride of the planned chain {stride_mm:.1} mm: the pull does not lead forward"
        ),
    }
}

/// What the motors did, and whether those of a robot could do it.
fn print_motors(s: &CrawlSummary, out: &mut dyn Write) -> Result<()> {
    writeln!(
        out,
        "  peak torque {:.2} of the effort limit ({}); position error of a shoulder asks for up to {:.2} N·m, its motor is at its limit {:.1} % of the time",
        s.peak_torque_over_rated,
        s.peak_torque_joint,
        s.demanded_peak_shoulder_nm,
        s.saturated_shoulder_share * 100.0
    )?;
    let percent = s.saturated_share * 100.0;
    match &s.saturated_joint {
        Some(joint) => writeln!(
            out,
            "  at the current limit {percent:.1} % of the time ({joint})"
        )?,
        None => writeln!(out, "  never at a current limit")?,
    }
    let lag = s.joints.iter();
    let lag = lag.max_by(|a, b| a.largest_lag_deg.total_cmp(&b.largest_lag_deg));
    if let Some(motor) = lag {
        let (lag, joint) = (motor.largest_lag_deg, &motor.joint);
        writeln!(out, "  largest lag behind the command {lag:.1}° ({joint})")?;
    }
    let head = s.ground.head;
    if head.peak_n >= HEAD_CARRIES {
        writeln!(
            out,
            "  the head carries weight {:.0} % of the time, up to {:.0} N",
            head.share_of_time * 100.0,
            head.peak_n
        )?;
    }
    if let Some(cost) = s.cost_of_transport {
        write!(
            out,
            "  cost of transport {cost:.2} (positive work {:.1} J)",
            s.work_j
        )?;
        match s.heat_per_metre_s.zip(s.heat_per_second) {
            Some((metre, second)) => {
                writeln!(
                    out,
                    "; motor heat {metre:.0} s per metre, {second:.2} per second"
                )?;
            }
            None => writeln!(out, "; motor heat unknown")?,
        }
    }
    print_verdict(s, out)
}

/// Efficiencies of gears beside the one that is supposed: what is known of a robot's lies between.
const OTHER_GEARS: [f64; 2] = [0.5, 0.75];

fn print_verdict(s: &CrawlSummary, out: &mut dyn Write) -> Result<()> {
    let verdict = &s.verdict;
    if let Some(unknown) = &verdict.unknown {
        return writeln!(out, "  on a robot: unknown, {unknown}");
    }
    let duty = verdict.duty.as_deref().unwrap_or("unknown");
    let reasons: Vec<String> = verdict
        .reasons
        .iter()
        .map(ReasonSummary::in_words)
        .collect();
    let because = if reasons.is_empty() {
        String::new()
    } else {
        format!(": {}", reasons.join("; "))
    };
    writeln!(out, "  on a robot's motors: {duty}{because}")?;
    let warmest = s.joints.iter().filter_map(|motor| {
        let rms = motor.rms_over_nominal?;
        Some((rms, &motor.joint))
    });
    if let Some((rms, joint)) = warmest.max_by(|a, b| a.0.total_cmp(&b.0)) {
        let supposed = verdict.gear_efficiency;
        let others = OTHER_GEARS.map(|gears| format!("{:.2} with {gears}", rms * supposed / gears));
        writeln!(
            out,
            "  RMS torque over what gears of efficiency {supposed} pass on of the nominal: at most {rms:.2} ({joint}); over that of others {}",
            others.join(", ")
        )?;
    }
    Ok(())
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
