//! Files that get their name when they are whole.

use crate::recording::is_being_recorded;
use crate::{Error, Result};
use std::fs::{self, File};
use std::io;
use std::path::Path;
use tempfile::NamedTempFile;

/// A file under a hidden name beside the one that it is to have. Unless it is [given that](give_name), it goes with its owner.
pub(crate) fn beside(path: &Path) -> io::Result<NamedTempFile> {
    // Where a link leads to another disk, a file beside the link could not be renamed to what it leads to.
    let whole = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let name = whole.file_name().unwrap_or_default().to_string_lossy();
    // As long as names may be, so that there is room for more.
    let name: String = name.chars().take(LONGEST_PREFIX).collect();
    let prefix = format!(".{name}.");
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(".part");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(ALL_BUT_MASKED));
    builder.tempfile_in(folder_of(&whole))
}

/// Sees a file onto the disk and gives it its name; gives how long it is.
pub(crate) fn give_name(file: NamedTempFile, path: &Path, overwrite: bool) -> Result<u64> {
    let failed = |error: &io::Error| match error.kind() {
        io::ErrorKind::AlreadyExists => Error::Exists { path: path.to_owned() },
        _ => Error::write(path.display().to_string(), error),
    };
    file.as_file().sync_all().map_err(|error| failed(&error))?;
    let bytes = file.as_file().metadata().map_err(|error| failed(&error))?.len();
    if overwrite {
        if is_being_recorded(path) {
            return Err(Error::BeingRecorded { path: path.to_owned() });
        }
        // What a link points to is replaced, not the link.
        let whole = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        file.persist(whole).map_err(|error| failed(&error.error))?;
    } else {
        file.persist_noclobber(path).map_err(|error| failed(&error.error))?;
    }
    // The name is on the disk when its folder is. Where folders cannot be opened the system sees to it.
    if let Ok(folder) = File::open(folder_of(path)) {
        let _ = folder.sync_all();
    }
    Ok(bytes)
}

/// Whether two paths lead to one file, by whichever links.
pub(crate) fn is_same_file(one: &Path, other: &Path) -> bool {
    let (Ok(one), Ok(other)) = (fs::canonicalize(one), fs::canonicalize(other)) else {
        return false;
    };
    one == other || has_two_names(&one, &other)
}

/// Whether a file has both names, each as its own.
#[cfg(unix)]
fn has_two_names(one: &Path, other: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let number = |path| fs::metadata(path).map(|file| (file.dev(), file.ino()));
    matches!((number(one), number(other)), (Ok(one), Ok(other)) if one == other)
}

#[cfg(not(unix))]
fn has_two_names(_one: &Path, _other: &Path) -> bool {
    false
}

/// The folder that a file is in, or would be.
pub(crate) fn folder_of(path: &Path) -> &Path {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    folder.unwrap_or(Path::new("."))
}

/// Characters, of which each has four bytes at most, of the 255 bytes that a name may have.
const LONGEST_PREFIX: usize = 60;

/// As any new file: the system takes away what its mask says.
#[cfg(unix)]
const ALL_BUT_MASKED: u32 = 0o666;
