//! Ctrl-C.

use tracelight_task::Stop;

/// Listens from now on. A second Ctrl-C ends the process at once.
pub(crate) fn listen() -> Stop {
    let stop = Stop::default();
    let flag = stop.clone();
    let armed = ctrlc::set_handler(move || {
        if flag.want() {
            std::process::exit(130);
        }
    });
    // without a handler Ctrl-C ends the process by itself, which is dark too: every rig darkens without a host
    drop(armed);
    stop
}
