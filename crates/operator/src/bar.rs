//! What stderr shows while work goes on.

use std::fmt::Write;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use tracelight_task::Progress;

/// A stage of so many steps: how many of them are done is how far it is.
const COUNTED: &str = "{msg:10} {wide_bar} {percent:>3} %  {passed} of {whole}";
/// A stage of which nobody knows how far it is: something moves, and the time goes on.
const MOVING: &str = "{msg:10} {moving}  {passed}";
/// Things, with their rate and the last one's name.
const THINGS: &str = "{pos} of {len} {wide_bar} {rate}  {left} left  {msg}";
/// Before the first stage.
const NOTHING: &str = "{msg}";
/// How often what is shown goes on by itself.
const EVERY: Duration = Duration::from_millis(100);
/// How wide the track is in which something moves, and how wide that is, columns.
const TRACK: (usize, usize) = (30, 4);

/// A bar with the stage's name when stderr is a terminal, nothing otherwise.
#[derive(Debug)]
pub struct Bar {
    bar: ProgressBar,
    quiet: bool,
    began: Instant,
}

impl Bar {
    /// One on standard error; quiet, nothing is said either.
    #[must_use]
    pub fn new(quiet: bool) -> Self {
        let shown = !quiet && std::io::stderr().is_terminal();
        Self::on(if shown { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() }, quiet)
    }

    fn on(target: ProgressDrawTarget, quiet: bool) -> Self {
        let bar = ProgressBar::with_draw_target(Some(1), target);
        let shown = Self { bar, quiet, began: Instant::now() };
        shown.styled(NOTHING);
        shown
    }

    /// A template that cannot be read leaves what was shown before.
    fn styled(&self, template: &str) {
        if let Ok(style) = ProgressStyle::with_template(template) {
            self.bar.set_style(with_times(style));
        }
    }

    fn begin(&self, name: &'static str, steps: u64, template: &str) {
        self.bar.reset();
        self.styled(template);
        self.bar.set_message(name);
        self.bar.set_length(steps);
        if !self.bar.is_hidden() {
            self.bar.enable_steady_tick(EVERY);
        }
    }
}

/// What the templates name beside what every bar knows. Where it cannot be written the bar goes on without it.
fn with_times(style: ProgressStyle) -> ProgressStyle {
    let rate = |state: &ProgressState, text: &mut dyn Write| {
        let _ = write!(text, "{:.1} pictures/s", state.per_sec());
    };
    let passed = |state: &ProgressState, text: &mut dyn Write| {
        let _ = write!(text, "{}", clock(state.elapsed()));
    };
    let whole = |state: &ProgressState, text: &mut dyn Write| {
        let _ = write!(text, "{}", estimate(state).map_or_else(|| "-:--".to_owned(), clock));
    };
    let left = |state: &ProgressState, text: &mut dyn Write| {
        let left = estimate(state).map(|whole| whole.saturating_sub(state.elapsed()));
        let _ = write!(text, "{}", left.map_or_else(|| "-:--".to_owned(), clock));
    };
    let moving = |state: &ProgressState, text: &mut dyn Write| {
        let _ = write!(text, "{}", moving(state.elapsed()));
    };
    style
        .with_key("rate", rate)
        .with_key("passed", passed)
        .with_key("whole", whole)
        .with_key("left", left)
        .with_key("moving", moving)
}

/// How long all of a stage is likely to take, once something of it is done.
fn estimate(state: &ProgressState) -> Option<Duration> {
    let (done, all) = (state.pos(), state.len()?);
    (done > 0 && done <= all).then(|| state.elapsed().mul_f64(all as f64 / done as f64))
}

/// Minutes and seconds, as 1:07; of an hour and more the hours before them.
fn clock(time: Duration) -> String {
    let seconds = time.as_secs();
    let (hours, minutes, seconds) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    match hours {
        0 => format!("{minutes}:{seconds:02}"),
        _ => format!("{hours}:{minutes:02}:{seconds:02}"),
    }
}

/// A block that goes to and fro, a column each time something is shown.
fn moving(time: Duration) -> String {
    let (track, block) = TRACK;
    let way = track - block;
    let step = (time.as_millis() / EVERY.as_millis()) as usize % (2 * way);
    let at = if step < way { step } else { 2 * way - step };
    format!("{}{}{}", "░".repeat(at), "█".repeat(block), "░".repeat(way - at))
}

impl Progress for Bar {
    fn stage(&self, name: &'static str, steps: u64) {
        let template = if steps > 1 { COUNTED } else { MOVING };
        self.begin(name, steps.max(1), template);
    }

    fn things(&self, count: u64) {
        self.begin("", count.max(1), THINGS);
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

#[cfg(test)]
mod tests {
    use std::io;
    use std::sync::{Arc, Mutex};

    use indicatif::TermLike;

    use super::*;

    /// A terminal that keeps what is written to it.
    #[derive(Clone, Debug, Default)]
    struct Seen(Arc<Mutex<Vec<String>>>);

    impl Seen {
        fn keep(&self, text: &str) -> io::Result<()> {
            let text = text.trim().to_owned();
            let mut all = self.0.lock().unwrap();
            if !text.is_empty() && all.last() != Some(&text) {
                all.push(text);
            }
            Ok(())
        }

        fn all(&self) -> Vec<String> {
            self.0.lock().unwrap().clone()
        }
    }

    impl TermLike for Seen {
        fn width(&self) -> u16 {
            80
        }

        fn move_cursor_up(&self, _: usize) -> io::Result<()> {
            Ok(())
        }

        fn move_cursor_down(&self, _: usize) -> io::Result<()> {
            Ok(())
        }

        fn move_cursor_right(&self, _: usize) -> io::Result<()> {
            Ok(())
        }

        fn move_cursor_left(&self, _: usize) -> io::Result<()> {
            Ok(())
        }

        fn write_line(&self, text: &str) -> io::Result<()> {
            self.keep(text)
        }

        fn write_str(&self, text: &str) -> io::Result<()> {
            self.keep(text)
        }

        fn clear_line(&self) -> io::Result<()> {
            Ok(())
        }

        fn flush(&self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn times_are_minutes_and_seconds() {
        let clock = |s: u64| clock(Duration::from_secs(s));
        assert_eq!([0, 7, 67, 600, 3607].map(clock), ["0:00", "0:07", "1:07", "10:00", "1:00:07"]);
    }

    #[test]
    fn a_block_goes_to_and_fro_within_its_track() {
        let (track, block) = TRACK;
        let shown: Vec<_> = (0..60).map(|k| moving(k * EVERY)).collect();
        assert!(shown.windows(2).all(|pair| pair[0] != pair[1]));
        assert!(shown.iter().all(|line| line.chars().count() == track));
        assert!(shown.iter().all(|line| line.chars().filter(|&c| c == '█').count() == block));
    }

    #[test]
    fn a_stage_without_steps_moves_by_itself_and_names_no_share() {
        let seen = Seen::default();
        let bar = Bar::on(ProgressDrawTarget::term_like(Box::new(seen.clone())), false);
        bar.stage("plan", 1);
        std::thread::sleep(8 * EVERY);
        drop(bar);
        let lines = seen.all();
        assert!(lines.len() >= 4, "{lines:?}");
        assert!(
            lines
                .iter()
                .all(|line| line.starts_with("plan") && line.ends_with("0:00") && !line.contains('%')),
            "{lines:?}"
        );
    }

    #[test]
    fn a_stage_of_steps_shows_their_share_and_how_long_all_takes() {
        let seen = Seen::default();
        let bar = Bar::on(ProgressDrawTarget::term_like(Box::new(seen.clone())), false);
        bar.stage("run", 1000);
        for step in 0..8 {
            bar.at(125 * step);
            std::thread::sleep(EVERY);
        }
        drop(bar);
        let lines = seen.all();
        let shares: Vec<u32> = lines
            .iter()
            .filter_map(|line| line.split(" %").next()?.rsplit(' ').next()?.parse().ok())
            .collect();
        assert!(shares.is_sorted() && shares.last() > Some(&50), "{lines:?}");
        assert!(lines.iter().all(|line| line.starts_with("run") && line.contains(" of ")), "{lines:?}");
        assert!(lines.last().is_some_and(|line| line.ends_with("0:00 of 0:00")), "{lines:?}");
    }

    #[test]
    fn what_is_no_terminal_is_shown_nothing() {
        let bar = Bar::on(ProgressDrawTarget::hidden(), false);
        bar.stage("plan", 1);
        assert!(bar.bar.is_hidden());
    }
}
