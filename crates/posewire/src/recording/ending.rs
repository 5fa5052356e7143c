//! What a recording can be called.

use crate::capture::Format;
use crate::endpoint::FileFormat;
use crate::{Error, Result};
use std::path::Path;

/// Checks that a path does not end as a file of another format does: whoever opens a recording by its name would take it for that.
///
/// # Errors
/// [`Error::NotAsRecorded`], a usage error.
///
/// ```
/// use posewire::recording::check_ending;
///
/// assert!(check_ending("take.mcap".as_ref()).is_ok());
/// assert!(check_ending("take.pcapng".as_ref()).is_err());
/// ```
pub fn check_ending(path: &Path) -> Result<()> {
    let name = path.to_string_lossy().to_lowercase();
    let captures = [Format::Pcap, Format::PcapNg].map(Format::ending);
    let takes = FileFormat::ALL.iter().map(|format| format.ending());
    let others = captures.into_iter().chain(takes);
    let mut found = others.filter(|ending| name.ends_with(&format!(".{ending}")));
    found.next().map_or(Ok(()), |ending| {
        Err(Error::NotAsRecorded {
            path: path.to_owned(),
            ending,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_recording_is_called_as_nothing_else_is() {
        for name in ["take.mcap", "take", "take.1", "mvnx", "folder.csv/take.mcap"] {
            assert_eq!(check_ending(name.as_ref()), Ok(()), "{name}");
        }
        for (name, ending) in [
            ("take.PCAP", "pcap"),
            ("take.pcapng", "pcapng"),
            ("take.mvnx.gz", "mvnx.gz"),
        ] {
            let path = name.into();
            assert_eq!(check_ending(name.as_ref()), Err(Error::NotAsRecorded { path, ending }));
        }
    }

    #[test]
    fn what_is_wanted_is_made_of_the_recording() {
        let error = check_ending("new.pcapng".as_ref()).unwrap_err();
        assert_eq!(error.to_string(), "record writes MCAP files, new.pcapng says pcapng");
        let help = "name it new.mcap; posewire convert new.mcap new.pcapng makes the other of it";
        assert_eq!(error.help().as_deref(), Some(help));
        assert!(error.is_usage());
    }
}
