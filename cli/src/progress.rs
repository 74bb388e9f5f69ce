//! Progress on the terminal, and Ctrl-C.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

static IS_INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// From now on Ctrl-C asks the solve to stop, and a second one ends the program at once.
pub fn catch_interrupts() {
    let on_interrupt = || {
        if IS_INTERRUPTED.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(crate::INTERRUPTED));
        }
    };
    // Without a handler Ctrl-C ends the program and nothing is written: worth no failure.
    let _ = ctrlc::set_handler(on_interrupt);
}

/// True once Ctrl-C was pressed.
pub fn is_interrupted() -> bool {
    IS_INTERRUPTED.load(Ordering::Relaxed)
}

/// A bar on standard error if that is a terminal; else nothing.
pub struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// `length` iterations, or time steps, at most.
    pub fn new(length: u32, is_quiet: bool) -> Self {
        if is_quiet || !std::io::stderr().is_terminal() {
            return Self { bar: ProgressBar::hidden() };
        }
        let bar = ProgressBar::new(u64::from(length));
        let style = ProgressStyle::with_template("{elapsed:>4} {bar:32.cyan} {pos:>5}/{len}  {msg}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.enable_steady_tick(Duration::from_millis(100));
        Self { bar }
    }

    /// `measure` is what `value` is: the energy, or the residual of an exploration.
    pub fn show(&self, position: u32, measure: &str, value: f64, largest_move: f64) {
        if self.bar.is_hidden() {
            return;
        }
        self.bar.set_position(u64::from(position));
        self.bar
            .set_message(format!("{measure} {value:.4e}  largest move {largest_move:.1e}  (Ctrl-C stops and writes)"));
    }

    /// Any position with a message.
    pub fn say(&self, position: usize, message: &str) {
        if self.bar.is_hidden() {
            return;
        }
        self.bar.set_position(position as u64);
        self.bar.set_message(format!("{message}  (Ctrl-C stops and writes)"));
    }

    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
