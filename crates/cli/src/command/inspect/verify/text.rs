//! What a verification found, for people.

use super::super::text::{Page, runs};
use super::checks::{Check, Verdict};
use super::record::{AngleRecord, DifferenceRecord, Verification};
use crate::plain::{cut, printable};
use std::io::{self, Write};

pub(in super::super) fn write(of: &Verification, page: &mut Page<'_, impl Write>) -> io::Result<()> {
    page.begin("verification")?;
    for check in &of.checks {
        page.row(verdict(check.verdict), &sentence(check))?;
    }
    write_angles(of, page)?;
    if !of.untracked.is_empty() {
        page.begin("not tracked")?;
    }
    for untracked in &of.untracked {
        page.row(&printable(&untracked.segment), &runs(&untracked.runs))?;
    }
    Ok(())
}

fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Ok => "ok",
        Verdict::Look => "look at this",
        Verdict::NotThere => "not there",
    }
}

fn sentence(check: &Check) -> String {
    let Some(value) = check.value else {
        let note = check.note.as_ref().map(|note| format!(": {note}"));
        return format!("{}{}", check.name, note.unwrap_or_default());
    };
    let unit = match check.unit {
        "" | "samples" => String::new(),
        unit => format!(" {unit}"),
    };
    let mut parts = vec![format!(
        "{}: {}{unit} (limit {})",
        check.name,
        found(value, check.unit),
        limit(check)
    )];
    parts.extend(check.place.clone());
    parts.extend(check.sample.map(|sample| format!("sample {sample}")));
    parts.extend(check.note.clone());
    parts.join(", ")
}

fn found(value: f64, unit: &str) -> String {
    let decimals = match unit {
        "deg" => 4,
        "" => 7,
        "m/s" | "rad/s" => 3,
        "samples" => 0,
        _ => 1,
    };
    format!("{value:.decimals$}")
}

/// Limits that were computed have more digits than they deserve.
fn limit(check: &Check) -> String {
    match check.unit {
        unit @ ("ms" | "ppm" | "m/s" | "rad/s") => found(check.limit, unit),
        _ => check.limit.to_string(),
    }
}

fn write_angles(of: &Verification, page: &mut Page<'_, impl Write>) -> io::Result<()> {
    let angles = || of.joint_angles.iter().chain(&of.ergonomic_angles);
    if !angles().any(|angle| angle.zxy.is_some() || angle.xzy.is_some()) {
        return Ok(());
    }
    page.begin("largest difference of the recomputed angles, degrees")?;
    let title = format!("{:<26}{:>9}  {:>8}  {:>9}  {:>8}", "", "ZXY", "sample", "XZY", "sample");
    writeln!(page.out, "  {title}")?;
    for angle in angles() {
        writeln!(page.out, "  {}", row(angle).trim_end())?;
    }
    Ok(())
}

fn row(angle: &AngleRecord) -> String {
    let [zxy, xzy] = [&angle.zxy, &angle.xzy].map(|record| {
        let number = |record: &DifferenceRecord| {
            let difference = record
                .difference_deg
                .map_or_else(|| "-".to_owned(), |value| format!("{value:.4}"));
            let sample = record.sample.map_or_else(String::new, |sample| sample.to_string());
            format!("{difference:>9}  {sample:>8}")
        };
        record.as_ref().map_or_else(|| format!("{:>9}  {:>8}", "-", ""), number)
    });
    format!("{:<26}{zxy}  {xzy}", cut(&printable(&angle.name), 25))
}
