//! Whether a firewall is on: as much as may be known without being the administrator.

use super::super::{Check, Finding};
use super::processes;
use std::fs;
use std::path::Path;

/// What may be known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Signs {
    /// ufw's own setting.
    ufw: Option<bool>,
    /// firewalld runs.
    firewalld: bool,
    /// The kernel has tables of packet filters in use, where it tells.
    tables: Option<bool>,
}

/// What is known of a firewall.
pub(super) fn finding() -> Finding {
    of(Signs::seen())
}

impl Signs {
    fn seen() -> Self {
        let ufw = fs::read_to_string("/etc/ufw/ufw.conf").ok();
        Self {
            ufw: ufw.as_deref().and_then(is_enabled),
            firewalld: processes::all().any(|process| process.name == "firewalld"),
            tables: tables(),
        }
    }
}

/// Whether old-style tables are in use; nftables does not tell, so that their lack says nothing where it is there.
fn tables() -> Option<bool> {
    let names = fs::read_to_string("/proc/net/ip_tables_names").ok();
    let has_nftables = Path::new("/sys/module/nf_tables").exists() || Path::new("/etc/nftables.conf").exists();
    match names {
        Some(names) if !names.trim().is_empty() => Some(true),
        Some(_) if !has_nftables => Some(false),
        _ => None,
    }
}

fn of(signs: Signs) -> Finding {
    let is_on = |name: &str, remedy: &str| {
        Finding::new(Check::Firewall, format!("The firewall {name} is switched on.")).with_remedy(remedy)
    };
    let unknown = |what: &str| Finding::new(Check::FirewallUnknown, what);
    match signs {
        Signs { firewalld: true, .. } => is_on(
            "firewalld",
            "Let in what you listen to: firewall-cmd --add-port=9763/udp, and the same with /tcp.",
        ),
        Signs { ufw: Some(true), .. } => is_on(
            "ufw",
            "Let in what you listen to: ufw allow 9763/udp, and the same with /tcp.",
        ),
        Signs { tables: Some(true), .. } => unknown("Packet filters are in use; what they do cannot be told."),
        Signs {
            tables: Some(false), ..
        } => unknown("No sign of a firewall: neither ufw, firewalld nor iptables."),
        _ => unknown("Whether there is a firewall cannot be told."),
    }
}

/// `ENABLED=yes`
fn is_enabled(settings: &str) -> Option<bool> {
    let value = settings.lines().find_map(|line| line.trim().strip_prefix("ENABLED="))?;
    Some(value.trim_matches('"').eq_ignore_ascii_case("yes"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_firewall_is_named_when_it_says_that_it_is_on() {
        assert_eq!(is_enabled("# ufw\nENABLED=yes\nLOGLEVEL=low\n"), Some(true));
        assert_eq!(is_enabled("ENABLED=no"), Some(false));
        assert_eq!(is_enabled(""), None);
        let ufw = Signs {
            ufw: Some(true),
            ..Signs::default()
        };
        assert!(of(ufw).remedy.contains("ufw allow 9763/udp"));
        let firewalld = Signs {
            firewalld: true,
            ..Signs::default()
        };
        assert_eq!(of(firewalld).check, Check::Firewall);
    }

    #[test]
    fn what_cannot_be_told_is_not_claimed() {
        for tables in [None, Some(true), Some(false)] {
            let found = of(Signs {
                tables,
                ..Signs::default()
            });
            assert_eq!(found.check, Check::FirewallUnknown);
        }
    }
}
