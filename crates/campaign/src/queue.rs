//! Work on several threads: begun in order, never more at once than memory holds, past what panics.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError, mpsc};
use std::thread;

use tracelight_task::Stop;

/// Stack of a worker, bytes: what a main thread has on Linux, for drawings that nest as deep as it reads them.
const STACK_BYTES: usize = 8 << 20;

/// A number of independent pieces of work.
pub(crate) trait Work: Sync {
    /// What a piece comes to.
    type Done: Send;
    /// Memory that piece `index` takes while it is worked on, bytes.
    fn bytes(&self, index: usize) -> u64;
    /// Does it.
    fn run(&self, index: usize) -> Self::Done;
}

/// How much happens at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// Threads.
    pub(crate) jobs: usize,
    /// Memory of all pieces in work, bytes; a piece that takes more is worked on alone.
    pub(crate) bytes: u64,
}

/// What a piece of work said when it panicked.
#[derive(Debug, PartialEq)]
pub(crate) struct Panicked(pub(crate) String);

/// Does pieces `0..count`, begun in that order, until all are done or the user wants to stop; tells `done` on this
/// thread of each as it ends.
pub(crate) fn run<W: Work>(
    work: &W,
    count: usize,
    limits: Limits,
    stop: &Stop,
    mut done: impl FnMut(usize, Result<W::Done, Panicked>),
) {
    // bounded: while `done` is busy, say with a reader that does not read, results do not pile up
    let (sender, receiver) = mpsc::sync_channel(limits.jobs);
    let queue = Queue { work, count, stop, next: Mutex::new(0), room: Room::of(limits.bytes) };
    thread::scope(|scope| {
        let queue = &queue;
        let worker = |sender: mpsc::SyncSender<_>| {
            move || queue.work_off(|index, result| sender.send((index, result)).is_ok())
        };
        let builder = || thread::Builder::new().stack_size(STACK_BYTES);
        let spawned = (0..limits.jobs.min(count))
            .filter(|_| builder().spawn_scoped(scope, worker(sender.clone())).is_ok())
            .count();
        if spawned == 0 {
            // a system that is out of threads still has this one
            queue.work_off(|index, result| {
                done(index, result);
                true
            });
        }
        drop(sender);
        receiver.iter().for_each(|(index, result)| done(index, result));
    });
}

struct Queue<'a, W> {
    work: &'a W,
    count: usize,
    stop: &'a Stop,
    /// Held while a piece waits for room, so that a large one is not overtaken for ever by small ones.
    next: Mutex<usize>,
    room: Room,
}

impl<W: Work> Queue<'_, W> {
    /// Takes pieces until there are none, or nobody listens any more.
    fn work_off(&self, mut tell: impl FnMut(usize, Result<W::Done, Panicked>) -> bool) {
        while let Some((index, place)) = self.begin() {
            let result = caught(|| self.work.run(index));
            drop(place);
            if !tell(index, result) {
                return;
            }
        }
    }

    fn begin(&self) -> Option<(usize, Place<'_>)> {
        let mut next = lock(&self.next);
        if *next >= self.count || self.stop.is_wanted() {
            return None;
        }
        let index = *next;
        *next += 1;
        // what cannot be weighed is taken to fill all room
        let bytes = caught(|| self.work.bytes(index)).unwrap_or(u64::MAX);
        let place = self.room.enter(bytes);
        (!self.stop.is_wanted()).then_some((index, place))
    }
}

fn caught<T>(work: impl FnOnce() -> T) -> Result<T, Panicked> {
    // pieces share nothing that one of them could leave half changed
    catch_unwind(AssertUnwindSafe(work)).map_err(|payload| {
        let said = payload.downcast_ref::<String>().map(String::as_str);
        let said = said.or_else(|| payload.downcast_ref::<&str>().copied());
        Panicked(said.unwrap_or("no reason given").to_owned())
    })
}

/// Memory that is shared out.
struct Room {
    size: u64,
    free: Mutex<u64>,
    freed: Condvar,
}

impl Room {
    fn of(size: u64) -> Self {
        Self { size, free: Mutex::new(size), freed: Condvar::new() }
    }

    /// Waits until there is room.
    fn enter(&self, bytes: u64) -> Place<'_> {
        let bytes = bytes.min(self.size);
        let free = lock(&self.free);
        let free = self.freed.wait_while(free, |free| *free < bytes);
        *free.unwrap_or_else(PoisonError::into_inner) -= bytes;
        Place { room: self, bytes }
    }
}

/// A share of the room, given back when dropped.
struct Place<'a> {
    room: &'a Room,
    bytes: u64,
}

impl Drop for Place<'_> {
    fn drop(&mut self) {
        *lock(&self.room.free) += self.bytes;
        self.room.freed.notify_all();
    }
}

/// Numbers are whole whatever thread panicked while it held them.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU64, Ordering};
    use std::time::Duration;

    use super::*;

    /// Pieces of known size; the third panics. Watches how much is in work at once.
    struct Watched {
        sizes: Vec<u64>,
        panics: Option<usize>,
        in_work: AtomicU64,
        most: AtomicU64,
    }

    impl Watched {
        fn of(sizes: &[u64], panics: Option<usize>) -> Self {
            Self { sizes: sizes.to_vec(), panics, in_work: AtomicU64::new(0), most: AtomicU64::new(0) }
        }
    }

    impl Work for Watched {
        type Done = usize;

        fn bytes(&self, index: usize) -> u64 {
            self.sizes[index]
        }

        fn run(&self, index: usize) -> usize {
            let now = self.in_work.fetch_add(self.sizes[index], Ordering::SeqCst) + self.sizes[index];
            self.most.fetch_max(now, Ordering::SeqCst);
            thread::sleep(Duration::from_millis(2));
            self.in_work.fetch_sub(self.sizes[index], Ordering::SeqCst);
            assert!(self.panics != Some(index), "piece {index} fell");
            10 * index
        }
    }

    fn results(work: &Watched, jobs: usize, bytes: u64) -> Vec<Result<usize, Panicked>> {
        let mut found: Vec<_> = work.sizes.iter().map(|_| None).collect();
        run(work, work.sizes.len(), Limits { jobs, bytes }, &Stop::default(), |index, result| {
            assert!(found[index].replace(result).is_none(), "{index} came twice");
        });
        found.into_iter().map(Option::unwrap).collect()
    }

    #[test]
    fn every_piece_is_done_once_on_any_number_of_threads() {
        for jobs in [1, 2, 3, 50] {
            let expected: Vec<_> = (0..20).map(|i| Ok(10 * i)).collect();
            assert_eq!(results(&Watched::of(&[1; 20], None), jobs, 100), expected, "{jobs} threads");
        }
    }

    #[test]
    fn a_piece_that_panics_takes_no_other_down() {
        let found = results(&Watched::of(&[1; 9], Some(2)), 3, 100);
        assert_eq!(found[2], Err(Panicked("piece 2 fell".to_owned())));
        assert_eq!(found.iter().filter(|r| r.is_ok()).count(), 8);
    }

    #[test]
    fn no_more_is_in_work_than_there_is_room_for() {
        let work = Watched::of(&[4, 4, 4, 9, 1, 1, 4, 4, 6, 5, 5], None);
        assert_eq!(results(&work, 8, 10).len(), 11);
        let most = work.most.load(Ordering::SeqCst);
        assert!((5..=10).contains(&most), "{most} of 10 bytes");
    }

    #[test]
    fn what_is_larger_than_all_room_is_done_alone() {
        let work = Watched::of(&[4, u64::from(u32::MAX), 4], None);
        assert_eq!(results(&work, 3, 10), [Ok(0), Ok(10), Ok(20)]);
        assert_eq!(work.most.load(Ordering::SeqCst), u64::from(u32::MAX));
    }
}
