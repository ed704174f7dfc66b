//! Free memory of the machine.

use crate::error::Cause;

/// Memory that is available without swapping, bytes, if the system reports it.
fn available() -> Option<u64> {
    available_in(&std::fs::read_to_string("/proc/meminfo").ok()?)
}

/// The same from the contents of `/proc/meminfo`.
fn available_in(account: &str) -> Option<u64> {
    let line = account.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

/// Returns an error if `bytes` exceed the available memory: a system that overcommits would kill the process later.
pub(crate) fn check(what: &str, bytes: u64) -> Result<(), Cause> {
    check_against(what, bytes, available())
}

fn check_against(what: &str, bytes: u64, available: Option<u64>) -> Result<(), Cause> {
    match available.filter(|available| bytes > *available) {
        Some(available) => Err(Cause::from(format!(
            "{what} take {}, and the machine has {} left: give fewer, or end other programs",
            size(bytes),
            size(available)
        ))),
        None => Ok(()),
    }
}

/// A size with its unit.
pub(crate) fn size(bytes: u64) -> String {
    let units = ["bytes", "KiB", "MiB", "GiB", "TiB"];
    let unit = (bytes.max(1).ilog2() / 10).min(4);
    match unit {
        0 => format!("{bytes} {}", units[0]),
        _ => format!("{:.1} {}", bytes as f64 / f64::from(unit * 10).exp2(), units[unit as usize]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_larger_than_what_is_left_is_refused_with_both_sizes() {
        assert_eq!(check_against("points", 5 << 30, None), Ok(()));
        assert_eq!(check_against("points", 5 << 30, Some(5 << 30)), Ok(()));
        let cause = check_against("7 points", 5 << 30, Some(3 << 29)).unwrap_err().to_string();
        assert!(cause.contains("7 points take 5.0 GiB") && cause.contains("1.5 GiB left"), "{cause}");
        assert_eq!(
            [size(0), size(1023), size(1024), size(3 << 20)],
            ["0 bytes", "1023 bytes", "1.0 KiB", "3.0 MiB"]
        );
    }

    #[test]
    fn linux_tells_what_is_left() {
        let account = "MemTotal:       24633824 kB\nMemFree:        10000 kB\nMemAvailable:   21000000 kB\n";
        assert_eq!(available_in(account), Some(21_000_000 * 1024));
        assert_eq!(available_in("MemFree: 1 kB"), None);
    }
}
