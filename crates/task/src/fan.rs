//! The same work many times, on all cores.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::Task;

/// What `work` makes of each number below `count`, in order; it does not depend on how many cores there are. Where somebody wants to
/// stop, some are missing. The progress shows how many are done.
pub fn on_all_cores<T: Send>(count: usize, task: Task<'_>, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<(usize, T)>> = Mutex::new(Vec::with_capacity(count));
    let worker = || {
        while let Some(number) = Some(next.fetch_add(1, Ordering::Relaxed)).filter(|&n| n < count) {
            if task.stop.is_wanted() {
                return;
            }
            let made = work(number);
            // a list is whole whatever thread panicked while it held it
            let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
            done.push((number, made));
            task.at(done.len() as u64);
        }
    };
    let cores = std::thread::available_parallelism().map_or(1, usize::from).min(count.max(1));
    match cores {
        // where there are no threads there is one core
        1 => worker(),
        _ => std::thread::scope(|scope| (0..cores).for_each(|_| drop(scope.spawn(worker)))),
    }
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_by_key(|(number, _)| *number);
    done.into_iter().map(|(_, made)| made).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{NoProgress, Stop};

    #[test]
    fn what_is_made_stands_in_order_and_stops_where_that_is_wanted() {
        let stop = Stop::default();
        let task = Task { progress: &NoProgress, stop: &stop };
        let made = on_all_cores(100, task, |number| number * number);
        assert!(made.iter().enumerate().all(|(number, square)| *square == number * number));
        assert_eq!(made.len(), 100);
        let made = on_all_cores(10_000, task, |number| {
            if number == 5 {
                stop.want();
            }
            number
        });
        assert!((6..10_000).contains(&made.len()), "{}", made.len());
        assert!(stop.check().is_err() && on_all_cores(3, task, |number| number).is_empty());
    }
}
