//! Files that appear whole or not at all.

use super::problem::Problem;
use super::{LeftOut, Progress, Recording, WriteOptions, WriteSeek, write_to};
use crate::beside::{beside, folder_of, give_name};
use crate::endpoint::FileFormat;
use crate::{Error, Result};
use posewire_motion::Section;
use std::ffi::OsString;
use std::fs::{self, Metadata};
use std::io;
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Where a take is saved, and as what.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Target {
    /// The file; with a file for each section, what their names begin with.
    pub path: PathBuf,
    /// What it is to hold.
    pub format: FileFormat,
    /// Whether a file that is there already is replaced.
    pub overwrite: bool,
}

/// What was saved.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Saved {
    /// The files and the bytes of each.
    pub files: Vec<(PathBuf, u64)>,
    /// What is not in them.
    pub left_out: LeftOut,
}

/// Saves a take in a file, or in a file for each section where the options say so.
///
/// A file is written under another name beside its own, and gets its name when it is whole and on the disk. Whatever goes
/// wrong before leaves nothing behind, and a file that was there already as it was.
///
/// # Errors
/// Those of [`write`](super::write); [`Error::Write`] and [`Error::Exists`] as [`Target::check`].
pub fn save(target: &Target, recording: &Recording, options: &WriteOptions, progress: &Progress) -> Result<Saved> {
    let mut waiting = Vec::new();
    let mut left_out = LeftOut::new();
    for (path, options) in parts(target, recording, options) {
        let (file, missing) = write_part(&path, target.overwrite, progress, |out| {
            write_to(target.format, recording, &options, progress, out)
        })?;
        left_out = missing;
        waiting.push((path, file));
    }
    let named = waiting.into_iter().map(|(path, file)| {
        let bytes = give_name(file, &path, target.overwrite)?;
        Ok((path, bytes))
    });
    let files = named.collect::<Result<_>>()?;
    Ok(Saved { files, left_out })
}

/// Saves one file that `fill` writes.
pub(super) fn save_one(
    target: &Target,
    progress: &Progress,
    fill: impl FnOnce(&mut dyn WriteSeek) -> Result<LeftOut, Problem>,
) -> Result<Saved> {
    let (file, left_out) = write_part(&target.path, target.overwrite, progress, fill)?;
    let bytes = give_name(file, &target.path, target.overwrite)?;
    Ok(Saved {
        files: vec![(target.path.clone(), bytes)],
        left_out,
    })
}

/// Writes a file that has no name yet, and tells what is not in it.
fn write_part(
    path: &Path,
    overwrite: bool,
    progress: &Progress,
    fill: impl FnOnce(&mut dyn WriteSeek) -> Result<LeftOut, Problem>,
) -> Result<(NamedTempFile, LeftOut)> {
    check(path, overwrite)?;
    let mut left_out = LeftOut::new();
    let file = write_beside(path, |out| {
        left_out = fill(out)?;
        Ok(())
    });
    match file {
        Ok(file) => Ok((file, left_out)),
        Err(Problem::Output(_)) if progress.is_stopped() => Err(Error::Stopped {
            what: format!("writing {}", path.display()),
        }),
        Err(problem) => Err(problem.at(&path.display().to_string())),
    }
}

impl Target {
    /// Looks whether a file could be saved here, before the work of making it. Of one file for each section the folder is
    /// looked at, and each file when it is saved.
    ///
    /// # Errors
    /// [`Error::Exists`] when a file is there that is not to be replaced; [`Error::Write`] when what is there is no file or
    /// is read-only, or when its folder is not there.
    pub fn check(&self, options: &WriteOptions) -> Result<()> {
        if has_parts(self, options) {
            return check_folder(&self.path);
        }
        check(&self.path, self.overwrite)
    }
}

/// Whether each section has a file.
fn has_parts(target: &Target, options: &WriteOptions) -> bool {
    target.format == FileFormat::Csv && options.csv.file_per_section
}

/// Every file to write, and what goes into it.
fn parts(target: &Target, recording: &Recording, options: &WriteOptions) -> Vec<(PathBuf, WriteOptions)> {
    if !has_parts(target, options) {
        return vec![(target.path.clone(), options.clone())];
    }
    let sections = options.sections_of(&recording.take);
    let part = |name: &str, sections: &[Section]| {
        let options = WriteOptions {
            sections: Some(sections.to_vec()),
            ..options.clone()
        };
        (with_part(&target.path, name), options)
    };
    // What belongs to no section has a file too.
    let times = options.sections.is_none().then(|| part("frames", &[]));
    sections
        .map(|section| part(section.name(), &[section]))
        .chain(times)
        .collect()
}

/// `take.csv` with a part: `take_position.csv`.
fn with_part(path: &Path, part: &str) -> PathBuf {
    let mut name = path.file_stem().map_or_else(OsString::new, OsString::from);
    name.push("_");
    name.push(part);
    if let Some(ending) = path.extension() {
        name.push(".");
        name.push(ending);
    }
    path.with_file_name(name)
}

fn check_folder(path: &Path) -> Result<()> {
    if folder_of(path).is_dir() {
        return Ok(());
    }
    Err(refused(path, io::ErrorKind::NotFound, "its folder is not there"))
}

fn refused(path: &Path, kind: io::ErrorKind, reason: &str) -> Error {
    Error::write(path.display().to_string(), &io::Error::new(kind, reason.to_owned()))
}

fn check(path: &Path, overwrite: bool) -> Result<()> {
    let refuse = |kind, reason| refused(path, kind, reason);
    check_folder(path)?;
    let there = match fs::metadata(path) {
        Ok(there) => there,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(Error::write(path.display().to_string(), &error)),
    };
    if there.is_dir() {
        return Err(refuse(io::ErrorKind::IsADirectory, "it is a folder"));
    }
    // To rename a file to the name of a device would remove the device.
    if !there.is_file() {
        return Err(refuse(io::ErrorKind::InvalidInput, "it is not a file"));
    }
    if !overwrite {
        return Err(Error::Exists { path: path.to_owned() });
    }
    if is_read_only(&there) {
        return Err(refuse(io::ErrorKind::PermissionDenied, "it is read-only"));
    }
    Ok(())
}

fn is_read_only(file: &Metadata) -> bool {
    file.permissions().readonly()
}

/// Writes a file that has no name of its own yet.
fn write_beside(
    path: &Path,
    fill: impl FnOnce(&mut dyn WriteSeek) -> Result<(), Problem>,
) -> Result<NamedTempFile, Problem> {
    let mut file = beside(path)?;
    fill(file.as_file_mut())?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::TempDir;

    fn names(folder: &TempDir) -> Vec<String> {
        let entries = fs::read_dir(folder.path()).unwrap();
        let mut names: Vec<_> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_has_its_name_when_it_is_whole() {
        let folder = TempDir::new().unwrap();
        let path = folder.path().join("take.bvh");
        let file = write_beside(&path, |out| Ok(out.write_all(b"whole")?)).unwrap();
        assert!(!path.exists());
        assert_eq!(give_name(file, &path, false), Ok(5));
        assert_eq!(names(&folder), ["take.bvh"]);
        assert_eq!(fs::read(&path).unwrap(), b"whole");
    }

    #[test]
    fn names_are_as_long_as_the_disk_allows() {
        let folder = TempDir::new().unwrap();
        let path = folder.path().join("n".repeat(255));
        let file = write_beside(&path, |out| Ok(out.write_all(b"whole")?)).unwrap();
        assert_eq!(give_name(file, &path, false), Ok(5));
        let error = check(&folder.path().join("n".repeat(256)), false).unwrap_err();
        assert_eq!(error.help().as_deref(), Some("choose a shorter name"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn what_a_link_leads_to_is_written_in_its_own_folder() {
        let [here, there] = [(); 2].map(|()| TempDir::new().unwrap());
        let (link, whole) = (here.path().join("link.bvh"), there.path().join("take.bvh"));
        fs::write(&whole, "old").unwrap();
        std::os::unix::fs::symlink(&whole, &link).unwrap();
        let file = write_beside(&link, |out| {
            assert_eq!((names(&here).len(), names(&there).len()), (1, 2));
            Ok(out.write_all(b"new")?)
        });
        assert_eq!(give_name(file.unwrap(), &link, true), Ok(3));
        assert_eq!(fs::read(&whole).unwrap(), b"new");
    }

    #[test]
    fn a_full_disk_leaves_nothing_behind() {
        let folder = TempDir::new().unwrap();
        let path = folder.path().join("take.bvh");
        let full = write_beside(&path, |out| {
            out.write_all(b"half")?;
            Err(io::Error::from(io::ErrorKind::StorageFull).into())
        });
        let error = full.unwrap_err().at("take.bvh");
        assert!(
            matches!(
                error,
                Error::Write {
                    kind: io::ErrorKind::StorageFull,
                    ..
                }
            ),
            "{error}"
        );
        assert_eq!(names(&folder), [""; 0]);
    }

    #[test]
    fn a_file_that_came_in_between_is_not_replaced() {
        let folder = TempDir::new().unwrap();
        let path = folder.path().join("take.bvh");
        let file = write_beside(&path, |out| Ok(out.write_all(b"new")?)).unwrap();
        fs::write(&path, "old").unwrap();
        assert_eq!(give_name(file, &path, false), Err(Error::Exists { path: path.clone() }));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(&folder), ["take.bvh"]);
    }

    #[test]
    fn what_cannot_become_the_file_is_refused_beforehand() {
        let folder = TempDir::new().unwrap();
        let target = |name: &str, overwrite| Target {
            path: folder.path().join(name),
            format: FileFormat::Bvh,
            overwrite,
        };
        let options = WriteOptions::default();
        assert_eq!(target("new.bvh", false).check(&options), Ok(()));
        fs::write(folder.path().join("old.bvh"), "").unwrap();
        assert!(matches!(
            target("old.bvh", false).check(&options),
            Err(Error::Exists { .. })
        ));
        assert_eq!(target("old.bvh", true).check(&options), Ok(()));
        fs::create_dir(folder.path().join("folder.bvh")).unwrap();
        for (name, reason) in [
            ("folder.bvh", "it is a folder"),
            ("nowhere/new.bvh", "its folder is not there"),
        ] {
            let error = target(name, true).check(&options).unwrap_err();
            assert!(error.to_string().ends_with(reason), "{error}");
        }
        let mut permissions = fs::metadata(folder.path().join("old.bvh")).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(folder.path().join("old.bvh"), permissions).unwrap();
        let error = target("old.bvh", true).check(&options).unwrap_err();
        assert!(error.to_string().ends_with("it is read-only"), "{error}");
    }

    #[test]
    fn a_section_is_part_of_the_name() {
        assert_eq!(
            with_part(Path::new("a/take.csv"), "position"),
            Path::new("a/take_position.csv")
        );
    }
}
