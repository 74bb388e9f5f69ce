//! What the measurements were taken on.

use std::fs;
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

use crate::shell;

/// One line: processor, cores, memory, system, compiler.
pub fn describe() -> String {
    let line_after = |file: &str, key: &str, separator: char| {
        let text = fs::read_to_string(file).ok()?;
        let line = text.lines().find(|line| line.starts_with(key))?;
        Some(line.split_once(separator)?.1.trim().trim_matches('"').to_owned())
    };
    let cpu = line_after("/proc/cpuinfo", "model name", ':').unwrap_or_else(|| std::env::consts::ARCH.to_owned());
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let memory = line_after("/proc/meminfo", "MemTotal", ':').and_then(|text| gib(&text));
    let memory = memory.map_or(String::new(), |gib| format!(", {gib:.0} GiB of memory"));
    let system = line_after("/etc/os-release", "PRETTY_NAME", '=').unwrap_or_else(|| std::env::consts::OS.to_owned());
    let rustc = shell::output(Command::new("rustc").arg("-V")).unwrap_or_default();
    format!("{cpu}, {cores} cores{memory}, {system}, {}", rustc.trim())
}

/// GiB of memory that are free for a process, where the system tells.
pub fn available_gib() -> Option<f64> {
    let text = fs::read_to_string("/proc/meminfo").ok()?;
    gib(text.lines().find(|line| line.starts_with("MemAvailable"))?.split_once(':')?.1)
}

fn gib(kib: &str) -> Option<f64> {
    let kib: f64 = kib.split_whitespace().next()?.parse().ok()?;
    Some(kib / (1024.0 * 1024.0))
}

/// Today, as `2026-01-31`, in UTC.
pub fn date() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let (mut days, mut year) = (seconds / 86_400, 1970);
    let length =
        |year: u64| 365 + u64::from(year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400)));
    while days >= length(year) {
        days -= length(year);
        year += 1;
    }
    let months = [31, length(year) - 337, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let mut month = 0;
    while days >= months[month] {
        days -= months[month];
        month += 1;
    }
    format!("{year}-{:02}-{:02}", month + 1, days + 1)
}
