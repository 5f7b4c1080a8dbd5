//! The newest image of a camera that sends by itself, and how long any is waited for.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Longest that an image, or an answer, of a camera is waited for.
pub(crate) const PATIENCE: Duration = Duration::from_secs(5);

/// What a camera sent last, put there by a thread of its own: who comes late gets the newest and not what piled up.
pub(crate) struct Latest<T> {
    slot: Mutex<Slot<T>>,
    changed: Condvar,
}

struct Slot<T> {
    /// How many there were.
    count: u64,
    image: Option<T>,
    /// Why no more will come.
    ended: Option<String>,
}

impl<T> Default for Latest<T> {
    fn default() -> Self {
        Self { slot: Mutex::new(Slot { count: 0, image: None, ended: None }), changed: Condvar::new() }
    }
}

impl<T: Clone> Latest<T> {
    fn slot(&self) -> MutexGuard<'_, Slot<T>> {
        self.slot.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn change(&self, change: impl FnOnce(&mut Slot<T>)) {
        change(&mut self.slot());
        self.changed.notify_all();
    }

    pub(crate) fn put(&self, image: T) {
        self.change(|slot| {
            slot.count += 1;
            slot.image = Some(image);
        });
    }

    /// No more will come.
    pub(crate) fn end(&self, why: String) {
        self.change(|slot| slot.ended = Some(why));
    }

    /// One that comes from now on.
    ///
    /// # Errors
    /// Why none comes.
    pub(crate) fn next(&self, patience: Duration) -> Result<T, String> {
        let slot = self.slot();
        let before = slot.count;
        let fresh = |slot: &mut Slot<T>| slot.count == before && slot.ended.is_none();
        let waited = self.changed.wait_timeout_while(slot, patience, fresh);
        let slot = &waited.unwrap_or_else(PoisonError::into_inner).0;
        match (&slot.image, &slot.ended) {
            (Some(image), _) if slot.count > before => Ok(image.clone()),
            (_, Some(why)) => Err(why.clone()),
            _ => Err(format!("no image for {:.0} s", patience.as_secs_f64())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};

    #[test]
    fn who_waits_gets_what_comes_and_not_what_was_there_before() {
        let latest = Arc::new(Latest::default());
        latest.put(1);
        assert_eq!(latest.next(Duration::from_millis(1)).unwrap_err(), "no image for 0 s");
        let (to, is_read) = (Arc::clone(&latest), Arc::new(AtomicBool::new(false)));
        let enough = Arc::clone(&is_read);
        let putting = std::thread::spawn(move || {
            while !enough.load(Ordering::SeqCst) {
                to.put(2);
            }
            to.end("unplugged".to_owned());
        });
        assert_eq!(latest.next(Duration::from_secs(60)).unwrap(), 2);
        is_read.store(true, Ordering::SeqCst);
        putting.join().unwrap();
        assert_eq!(latest.next(Duration::from_secs(60)).unwrap_err(), "unplugged");
    }
}
