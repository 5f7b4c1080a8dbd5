//! Work of libraries that panic where they should refuse.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    /// Whether such work is done on this thread.
    static AT_WORK: Cell<bool> = const { Cell::new(false) };
}

/// What a library answers; `None` where it panics, which nobody need read about. For work that leaves nothing half changed that is used
/// afterwards.
pub fn unless_it_panics<T>(work: impl FnOnce() -> T) -> Option<T> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let told = take_hook();
        set_hook(Box::new(move |panic| {
            if !AT_WORK.get() {
                told(panic);
            }
        }));
    });
    AT_WORK.set(true);
    let answer = catch_unwind(AssertUnwindSafe(work));
    AT_WORK.set(false);
    answer.ok()
}
