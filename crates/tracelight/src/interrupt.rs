//! Ctrl-C, and whatever else asks a process to end.

use std::time::Duration;

use tracelight_task::{Failure, Stop};

/// How long work has to end by itself.
const GRACE: Duration = Duration::from_millis(300);
const POLL: Duration = Duration::from_millis(10);

/// Listens from now on. Work that looks at the [`Stop`] ends by itself; where it does not in time, because it reads a pipe or computes, the process ends,
/// unless a laser may be lit or results are half written. A second Ctrl-C ends it at once.
///
/// Must be called before there is another thread: what is said of file sizes holds for those that follow.
pub(crate) fn listen() -> Stop {
    outlive_full_files();
    let stop = Stop::default();
    let flag = stop.clone();
    let armed = ctrlc::set_handler(move || {
        if flag.want() {
            leave();
        }
        let flag = flag.clone();
        std::thread::spawn(move || {
            std::thread::sleep(GRACE);
            while flag.is_kept() {
                std::thread::sleep(POLL);
            }
            // who has just come to his end says so himself
            std::thread::sleep(GRACE);
            tell();
            leave();
        });
    });
    // without a handler Ctrl-C ends the process by itself, which is dark too: every rig darkens without a host
    drop(armed);
    stop
}

/// A file that reaches the largest size it may have (`ulimit -f`) is a write that fails and is told as such, not the end of
/// the process in the middle of its results. Held back for good, the signal comes to nothing.
#[cfg(unix)]
fn outlive_full_files() {
    use nix::sys::signal::{SigSet, Signal};
    // where it cannot be held back such a write ends the process, as anywhere
    SigSet::from(Signal::SIGXFSZ).thread_block().ok();
}

#[cfg(not(unix))]
const fn outlive_full_files() {}

fn leave() -> ! {
    std::process::exit(i32::from(Failure::interrupted().status.code()))
}

#[expect(clippy::print_stderr, reason = "messages to people go to stderr")]
fn tell() {
    eprintln!("error: interrupted: nothing is lit, and no file is half written");
}
