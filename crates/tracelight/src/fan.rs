//! The same work many times, on all cores.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::progress::Progress;
use crate::stop::Stop;

/// What `work` makes of each number below `count`, in order; it does not depend on how many cores there are. Where somebody wants to
/// stop, some are missing. The progress shows how many are done.
pub(crate) fn on_all_cores<T: Send>(
    count: usize,
    progress: &Progress,
    stop: &Stop,
    work: impl Fn(usize) -> T + Sync,
) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<(usize, T)>> = Mutex::new(Vec::with_capacity(count));
    let worker = || {
        while let Some(number) = Some(next.fetch_add(1, Ordering::Relaxed)).filter(|&n| n < count) {
            if stop.is_wanted() {
                return;
            }
            let made = work(number);
            // a list is whole whatever thread panicked while it held it
            let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
            done.push((number, made));
            progress.at(done.len() as u64);
        }
    };
    let cores = std::thread::available_parallelism().map_or(1, usize::from).min(count.max(1));
    std::thread::scope(|scope| (0..cores).for_each(|_| drop(scope.spawn(worker))));
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_by_key(|(number, _)| *number);
    done.into_iter().map(|(_, made)| made).collect()
}
