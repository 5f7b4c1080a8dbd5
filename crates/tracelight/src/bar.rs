//! What stderr shows while work goes on.

use std::fmt::Write;
use std::io::IsTerminal;
use std::time::Instant;

use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use tracelight_task::Progress;

/// A bar with the stage's name when stderr is a terminal, nothing otherwise.
pub(crate) struct Bar {
    bar: ProgressBar,
    quiet: bool,
    began: Instant,
}

impl Bar {
    pub(crate) fn new(quiet: bool) -> Self {
        let shown = !quiet && std::io::stderr().is_terminal();
        let bar = if shown { ProgressBar::new(1) } else { ProgressBar::hidden() };
        if let Ok(style) =
            ProgressStyle::with_template("{msg:10} {wide_bar} {percent:>3} %  {elapsed} of {duration}")
        {
            bar.set_style(style);
        }
        Self { bar, quiet, began: Instant::now() }
    }
}

impl Progress for Bar {
    fn stage(&self, name: &'static str, steps: u64) {
        self.bar.set_length(steps.max(1));
        self.bar.set_position(0);
        self.bar.set_message(name);
    }

    /// Shown with their rate and the last one's name.
    fn things(&self, count: u64) {
        const TEMPLATE: &str = "{pos} of {len} {wide_bar} {rate}  {eta:>4} left  {msg}";
        let rate = |state: &ProgressState, text: &mut dyn Write| {
            let _ = write!(text, "{:.1} pictures/s", state.per_sec()); // the bar goes on without it
        };
        if let Ok(style) = ProgressStyle::with_template(TEMPLATE) {
            self.bar.set_style(style.with_key("rate", rate));
        }
        self.stage("", count);
    }

    fn finished(&self, name: &str) {
        self.bar.set_message(name.to_owned());
        self.bar.inc(1);
    }

    fn at(&self, step: u64) {
        self.bar.set_position(step);
    }

    #[expect(clippy::print_stderr, reason = "messages to people go to stderr")]
    fn say(&self, message: &str) {
        if !self.quiet {
            self.bar.suspend(|| eprintln!("{message}"));
        }
    }

    fn clock_s(&self) -> f64 {
        self.began.elapsed().as_secs_f64()
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
