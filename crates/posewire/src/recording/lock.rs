//! Files that are being recorded, which nobody else may write meanwhile.

use crate::{Error, Result};
use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::Path;

/// Whether a posewire records into this file now, this program or another: that it has no end yet is no damage then.
pub fn is_being_recorded(path: &Path) -> bool {
    // A pipe would wait to be opened until somebody writes into it.
    let is_file = fs::metadata(path).is_ok_and(|metadata| metadata.is_file());
    is_file && is_owned(path)
}

/// Opens a file to be recorded into, and keeps others away for as long as it is open. One that is there is emptied, and only with
/// `overwrite`.
pub(super) fn create(path: &Path, overwrite: bool) -> Result<File> {
    let mut options = OpenOptions::new();
    // Emptied once it is known that nobody records into it.
    options.write(true).create(true).truncate(false);
    if !overwrite {
        options.create_new(true);
    }
    #[cfg(windows)]
    std::os::windows::fs::OpenOptionsExt::share_mode(&mut options, SHARE_READ);
    let file = options.open(path).map_err(|error| cannot_create(path, &error))?;
    if is_regular(&file) {
        own(&file, path)?;
        file.set_len(0).map_err(|error| cannot_create(path, &error))?;
    }
    Ok(file)
}

/// Keeps recorders away from a file for as long as it is open.
///
/// # Errors
/// [`Error::BeingRecorded`] when there is one.
pub(super) fn own(file: &File, path: &Path) -> Result<()> {
    // Where the system has no locks there is nothing to be kept from.
    if cfg!(unix) && matches!(file.try_lock(), Err(fs::TryLockError::WouldBlock)) {
        return Err(Error::BeingRecorded { path: path.to_owned() });
    }
    Ok(())
}

/// Opens a file so that no recorder begins to write it for as long as it is open; `None` when one writes it already, and where
/// the system has no locks.
pub(crate) fn read_locked(path: &Path) -> Option<File> {
    let file = File::open(path).ok().filter(|_| cfg!(unix))?;
    file.try_lock_shared().ok().map(|()| file)
}

/// What became of the name of a file that is open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Whereabouts {
    /// The file is where it was.
    There,
    /// The file has another name now, or is in another folder.
    Moved,
    /// The file has no name any more, and goes when it is closed.
    Removed,
}

#[cfg(unix)]
pub(super) fn whereabouts(file: &File, path: &Path) -> Whereabouts {
    use std::os::unix::fs::MetadataExt;
    let Ok(own) = file.metadata() else {
        return Whereabouts::There;
    };
    let named = fs::metadata(path).map(|named| (named.dev(), named.ino()));
    match named {
        _ if !own.is_file() => Whereabouts::There,
        Ok(named) if named == (own.dev(), own.ino()) => Whereabouts::There,
        _ if own.nlink() == 0 => Whereabouts::Removed,
        Err(error) if error.kind() != io::ErrorKind::NotFound => Whereabouts::There,
        _ => Whereabouts::Moved,
    }
}

/// A file that is open to be written cannot be moved or removed here.
#[cfg(not(unix))]
pub(super) fn whereabouts(_: &File, _: &Path) -> Whereabouts {
    Whereabouts::There
}

#[cfg(not(windows))]
fn is_owned(path: &Path) -> bool {
    let file = File::open(path);
    cfg!(unix) && file.is_ok_and(|file| matches!(file.try_lock_shared(), Err(fs::TryLockError::WouldBlock)))
}

/// Locks of files keep readers away here as well; what is shared with others when a file is opened does not.
#[cfg(windows)]
fn is_owned(path: &Path) -> bool {
    let opened = OpenOptions::new().write(true).open(path);
    opened.is_err_and(|error| error.raw_os_error() == Some(SHARING_VIOLATION))
}

fn is_regular(file: &File) -> bool {
    file.metadata().is_ok_and(|metadata| metadata.is_file())
}

fn cannot_create(path: &Path, error: &io::Error) -> Error {
    if error.kind() == io::ErrorKind::AlreadyExists {
        return Error::Exists { path: path.to_owned() };
    }
    if cfg!(windows) && error.raw_os_error() == Some(SHARING_VIOLATION) {
        return Error::BeingRecorded { path: path.to_owned() };
    }
    Error::write(path.display().to_string(), error)
}

/// Others may read the file, and neither write, rename nor remove it.
#[cfg(windows)]
const SHARE_READ: u32 = 1;
/// What Windows says of a file that another program does not share.
const SHARING_VIOLATION: i32 = 32;
