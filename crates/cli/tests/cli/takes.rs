//! A small take, made up.

use std::fmt::Write;

/// An MVNX file of two segments at 60 Hz, with as many frames, without sensors.
pub(crate) fn small_take(frames: usize) -> String {
    let mut text = HEAD.to_owned();
    for index in 0..frames {
        let (time, x) = (index * 1000 / 60, index as f64 / 60.0);
        _ = write!(
            text,
            "\t\t\t<frame time=\"{time}\" index=\"{index}\" tc=\"12:00:00:{index:02}\" ms=\"{ms}\" type=\"normal\">\n\
             \t\t\t\t<orientation>1.000000 0.000000 0.000000 0.000000 1.000000 0.000000 0.000000 0.000000</orientation>\n\
             \t\t\t\t<position>{x:.6} 0.000000 0.900000 {x:.6} 0.000000 1.000000</position>\n\
             \t\t\t</frame>\n",
            ms = 1_700_000_000_000 + time as u64,
        );
    }
    text + "\t\t</frames>\n\t</subject>\n</mvnx>\n"
}

const HEAD: &str = "\
<?xml version=\"1.0\" encoding=\"UTF-8\"?>
<mvnx version=\"4\">
\t<mvn version=\"2020.0\" build=\"1\"/>
\t<subject label=\"Bea\" torsoColor=\"#336699\" frameRate=\"60\" segmentCount=\"2\">
\t\t<segments>
\t\t\t<segment label=\"Pelvis\" id=\"1\"><points><point label=\"jL5S1\"><pos_b>0.000000 0.000000 0.100000</pos_b></point></points></segment>
\t\t\t<segment label=\"L5\" id=\"2\"><points><point label=\"jL5S1\"><pos_b>0.000000 0.000000 0.000000</pos_b></point></points></segment>
\t\t</segments>
\t\t<joints><joint label=\"jL5S1\"><connector1>Pelvis/jL5S1</connector1><connector2>L5/jL5S1</connector2></joint></joints>
\t\t<frames segmentCount=\"2\" jointCount=\"1\">
\t\t\t<frame time=\"0\" tc=\"00:00:00:00\" ms=\"0\" type=\"identity\">
\t\t\t\t<orientation>1.000000 0.000000 0.000000 0.000000 1.000000 0.000000 0.000000 0.000000</orientation>
\t\t\t\t<position>0.000000 0.000000 0.900000 0.000000 0.000000 1.000000</position>
\t\t\t</frame>
";
