//! Landmarks and joint centres as `OpenSim` reads markers: a TRC file.

use super::{DECIMALS, NOT_TRACKED, TO_GROUND, label, times};
use crate::endpoint::FileFormat;
use crate::file::format::symbol;
use crate::file::problem::Problem;
use crate::file::text::Line;
use crate::file::tracks::{Track, Values, tracks};
use crate::file::{Job, LeftOut, Output};
use posewire_motion::{DVec3, Section};
use std::io::{self, Write};

/// A marker for each point of each segment, labelled as in C3D.
///
/// The axes are those of `OpenSim`'s ground where no others are asked for. Frames are numbered from 1.
pub(in crate::file) fn write(job: &Job<'_>, out: &mut Output<'_>) -> Result<LeftOut, Problem> {
    let take = job.take;
    let markers = if job.column(Section::Position).is_some() {
        tracks(take, &[Section::Position])
    } else {
        Vec::new()
    };
    if markers.is_empty() {
        return Err(Problem::lacks(FileFormat::Trc, "positions of segments"));
    }
    let rate = job.rate(FileFormat::Trc)?;
    write_head(job, rate, &markers, out)?;
    let values = Values::of(take);
    let mut line = Line::new('\t');
    for (frame, time) in times(take, rate).into_iter().enumerate() {
        line.whole(frame as u64 + 1);
        line.number(time, DECIMALS);
        for marker in &markers {
            add_marker(job, values.read(marker, frame), &mut line);
        }
        line.end(out, "\n")?;
        job.progress.advance(1)?;
    }
    Ok(LeftOut::new())
}

fn write_head(job: &Job<'_>, rate: f64, markers: &[Track], out: &mut Output<'_>) -> io::Result<()> {
    let frames = job.take.len();
    let name = label(&job.take.subject.name);
    let unit = symbol(job.space.unit);
    write!(
        out,
        "PathFileType\t4\t(X/Y/Z)\t{name}.trc\n\
         DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n\
         {rate:.6}\t{rate:.6}\t{frames}\t{}\t{unit}\t{rate:.6}\t1\t{frames}\nFrame#\tTime",
        markers.len()
    )?;
    // Every marker's name stands over the first of its three columns.
    for (place, marker) in markers.iter().enumerate() {
        let tabs = if place == 0 { "\t" } else { "\t\t\t" };
        write!(out, "{tabs}{}", label(&marker.label))?;
    }
    write!(out, "\t\t\n\t")?;
    for number in 1..=markers.len() {
        write!(out, "\tX{number}\tY{number}\tZ{number}")?;
    }
    out.write_all(b"\n\n")
}

fn add_marker(job: &Job<'_>, place: Option<DVec3>, line: &mut Line) {
    let Some(place) = place else {
        (0..3).for_each(|_| line.field(NOT_TRACKED));
        return;
    };
    let place = match job.options.axes {
        Some(_) => job.space.position_from_canonical(place),
        None => TO_GROUND * place * job.space.unit.per_metre(),
    };
    for component in place.to_array() {
        line.number(component, DECIMALS);
    }
}

#[cfg(test)]
mod tests {
    use crate::endpoint::FileFormat;
    use crate::file::tests::{text_of, walk};
    use crate::file::{Axes, WriteOptions};
    use posewire_motion::{DQuat, DVec3, Frame, Point, Segment, SegmentKind, Skeleton, Subject, Take, Unit};
    use std::f64::consts::FRAC_PI_2;
    use std::sync::Arc;

    /// A bat whose tip is 1 m in front of its grip, held upright, and a ball that is seen in the second frame alone.
    fn bat_and_ball() -> Take {
        let mut bat = Segment::new("Bat", SegmentKind::Body);
        bat.points = vec![Point {
            id: 1,
            name: "pTip".to_owned(),
            offset: DVec3::X,
            flags: 0,
        }];
        let ball = Segment::new("My Ball", SegmentKind::Body);
        let skeleton = Skeleton {
            segments: vec![bat, ball],
            ..Skeleton::default()
        };
        let subject = Arc::new(Subject::new("Ada", skeleton));
        let mut take = Take::new(Arc::clone(&subject), 100.0);
        let mut frame = Frame::new(subject);
        frame.position = vec![Some(DVec3::new(1.0, 2.0, 3.0)), None];
        frame.orientation = vec![Some(DQuat::from_rotation_y(-FRAC_PI_2)); 2];
        take.push(&frame).unwrap();
        frame.sample = 1;
        frame.position[1] = Some(DVec3::new(0.5, 0.0, -0.25));
        take.push(&frame).unwrap();
        take
    }

    #[test]
    fn markers_are_in_millimetres_in_opensims_ground() {
        let expected = "PathFileType\t4\t(X/Y/Z)\tAda.trc\n\
            DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n\
            100.000000\t100.000000\t2\t2\tmm\t100.000000\t1\t2\n\
            Frame#\tTime\tpTip\t\t\tMy_Ball\t\t\n\
            \t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\
            \n\
            1\t0.000000\t1000.000000\t4000.000000\t-2000.000000\tNaN\tNaN\tNaN\n\
            2\t0.010000\t1000.000000\t4000.000000\t-2000.000000\t500.000000\t-250.000000\t0.000000\n";
        assert_eq!(
            text_of(FileFormat::Trc, bat_and_ball(), &WriteOptions::default()),
            expected
        );
    }

    #[test]
    fn other_axes_and_another_unit_can_be_asked_for() {
        let options = WriteOptions {
            axes: Some(Axes::YUp),
            unit: Some(Unit::Metre),
            ..WriteOptions::default()
        };
        let text = text_of(FileFormat::Trc, bat_and_ball(), &options);
        assert!(text.contains("\t2\tm\t"), "{text}");
        assert!(
            text.ends_with("2.000000\t4.000000\t1.000000\t0.000000\t-0.250000\t0.500000\n"),
            "{text}"
        );
    }

    #[test]
    fn every_line_has_three_columns_for_each_marker() {
        let text = text_of(FileFormat::Trc, walk(2), &WriteOptions::default());
        let counts: Vec<_> = text.lines().skip(3).map(|line| line.split('\t').count()).collect();
        assert_eq!(counts[0], counts[1]);
        assert_eq!((counts[3], counts[4]), (counts[1], counts[1]));
        assert_eq!((counts[1] - 2) % 3, 0);
    }
}
