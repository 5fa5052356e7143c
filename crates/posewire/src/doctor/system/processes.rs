//! Processes as Linux lists them.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A process.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Process {
    pub(super) id: u32,
    /// The name of its program, cut off after 15 bytes by the system.
    pub(super) name: String,
}

/// Which process has which socket, by the socket's inode; of other users' processes only the administrator is told.
pub(super) fn by_socket() -> BTreeMap<u64, Process> {
    let mut owners = BTreeMap::new();
    for process in all() {
        let folder = format!("/proc/{}/fd", process.id);
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            if let Some(inode) = fs::read_link(entry.path()).ok().as_deref().and_then(inode) {
                owners.insert(inode, process.clone());
            }
        }
    }
    owners
}

/// Every process that may be seen; none where the system has no `/proc`.
pub(super) fn all() -> impl Iterator<Item = Process> {
    let entries = fs::read_dir("/proc").into_iter().flatten().flatten();
    entries.filter_map(|entry| {
        let id = entry.file_name().to_str()?.parse().ok()?;
        let name = fs::read_to_string(entry.path().join("comm")).ok()?;
        let name = name.trim_end().replace(char::is_control, "\u{fffd}");
        Some(Process { id, name })
    })
}

/// `socket:[40960]`
fn inode(link: &Path) -> Option<u64> {
    let text = link.to_str()?.strip_prefix("socket:[")?;
    text.strip_suffix(']')?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_socket_has_the_inode_of_one() {
        assert_eq!(inode(Path::new("socket:[40960]")), Some(40960));
        for other in ["pipe:[40960]", "/dev/null", "socket:[", "socket:[x]"] {
            assert_eq!(inode(Path::new(other)), None);
        }
    }
}
