//! Work that keeps something of every pixel, refused where the machine has no memory for it.

use hadar::error::{Error, Result};

/// Refuses what takes more bytes than are free, where the system says how many there are (Linux does).
pub(super) fn check(bytes: u64, what: &str, instead: &str) -> Result<()> {
    within(bytes, free().unwrap_or(u64::MAX), what, instead)
}

fn within(bytes: u64, free: u64, what: &str, instead: &str) -> Result<()> {
    if bytes <= free {
        return Ok(());
    }
    let in_gb = |bytes: u64| format!("{:.1} GB", bytes as f64 / 1e9);
    let found = format!("{what} takes {} of memory, and {} are free", in_gb(bytes), in_gb(free));
    Err(Error::malformed(found, instead))
}

/// Bytes that the system can give without swapping.
fn free() -> Option<u64> {
    let told = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = told.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_fits_is_not_refused() {
        assert!(within(1 << 30, 1 << 31, "this", "that").is_ok());
        let message = within(3 << 30, 1 << 31, "this", "give less").unwrap_err().to_string();
        assert!(message.contains("this takes 3.2 GB of memory, and 2.1 GB are free"), "{message}");
        #[cfg(target_os = "linux")]
        assert!(free().is_some_and(|free| free > 1 << 20));
    }
}
