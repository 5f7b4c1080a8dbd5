use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use moq_v4l::buffer::{Flags, Metadata};
use moq_v4l::io::mmap::Stream;
use moq_v4l::io::traits::CaptureStream;
use nix::time::{ClockId, clock_gettime};

use crate::eye::about::Rhythm;
use crate::eye::coding::Layout;
use crate::eye::latest::Latest;
use crate::quiet::unless_it_panics;

/// An image that a camera sent. Times are of the clock that never jumps, s.
#[derive(Clone, Debug)]
pub(super) struct Received {
    pub(super) bytes: Vec<u8>,
    /// When its exposure began, as far as the driver tells.
    pub(super) began_s: f64,
}

/// Ages of images that are kept.
const MOST_AGES: usize = 1000;

/// What reads a camera's images on a thread of its own.
pub(super) struct Reader {
    pub(super) layout: Layout,
    /// From one image to the next, s.
    pub(super) interval_s: f64,
    pub(super) latest: Latest<Received>,
    pub(super) rhythm: Mutex<Rhythm>,
    /// Nobody wants any more.
    pub(super) is_over: AtomicBool,
}

/// Longest that an image is waited for.
pub(super) const PATIENCE: Duration = Duration::from_secs(5);

impl Reader {
    /// Reads until nobody wants any more, or none comes.
    pub(super) fn read_all(&self, mut stream: Stream<'_>) {
        stream.set_timeout(PATIENCE);
        let mut before = None;
        while !self.is_over.load(Ordering::SeqCst) {
            match unless_it_panics(|| self.read(&mut stream, &mut before)).unwrap_or_else(unknown) {
                Ok(()) => {}
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => {
                    self.latest.end(words(&error));
                    // the library panics where a camera that is gone cannot be told to stop
                    return std::mem::forget(stream);
                }
            }
        }
        unless_it_panics(|| drop(stream));
    }

    /// Reads one image; `before` is the number of the last.
    fn read(&self, stream: &mut Stream<'_>, before: &mut Option<u32>) -> io::Result<()> {
        let (bytes, about) = stream.next()?;
        let arrived_s = now_s();
        let used = bytes.get(..about.bytesused as usize).unwrap_or(bytes);
        let is_whole = !about.flags.contains(Flags::ERROR) && self.layout.is_whole(used);
        let (began_s, is_stamped) = self.began_s(about, arrived_s);
        let lost = before.map_or(0, |before| about.sequence.wrapping_sub(before).wrapping_sub(1));
        *before = Some(about.sequence);
        let mut rhythm = self.rhythm.lock().unwrap_or_else(PoisonError::into_inner);
        // a driver that does not count says 0 each time
        rhythm.lost += if lost < 1000 { lost } else { 0 };
        rhythm.is_stamped = is_stamped;
        rhythm.between_s = Some([rhythm.between_s.map_or(began_s, |[first, _]| first), began_s]);
        if !is_whole {
            rhythm.broken += 1;
            return Ok(());
        }
        rhythm.images += 1;
        if rhythm.late_s.len() < MOST_AGES {
            rhythm.late_s.push(arrived_s - began_s);
        }
        drop(rhythm);
        self.latest.put(Received { bytes: used.to_vec(), began_s });
        Ok(())
    }

    /// When an image's exposure began, and whether the driver says.
    fn began_s(&self, about: &Metadata, arrived_s: f64) -> (f64, bool) {
        let stamp_s = about.timestamp.sec as f64 + 1e-6 * about.timestamp.usec as f64;
        let is_stamped = about.flags.intersection(Flags::TIMESTAMP_MASK) == Flags::TIMESTAMP_MONOTONIC
            && (0.0..10.0).contains(&(arrived_s - stamp_s));
        let is_beginning = about.flags.intersection(Flags::TSTAMP_SRC_MASK) == Flags::TSTAMP_SRC_SOE;
        match (is_stamped, is_beginning) {
            (true, true) => (stamp_s, true),
            // exposed and read out by then
            (true, false) => (stamp_s - self.interval_s, false),
            (false, _) => (arrived_s - self.interval_s, false),
        }
    }
}

/// What a library that panicked said.
fn unknown<T>() -> io::Result<T> {
    Err(io::Error::other("its driver says what nobody knows"))
}

/// Why no image came, in words.
fn words(error: &io::Error) -> String {
    /// `ENODEV`
    const NO_DEVICE: i32 = 19;
    match (error.kind(), error.raw_os_error()) {
        (io::ErrorKind::TimedOut, _) => format!("no image for {} s", PATIENCE.as_secs()),
        (_, Some(NO_DEVICE)) => "it was unplugged".to_owned(),
        _ => error.to_string(),
    }
}

/// The clock that never jumps, s.
pub(super) fn now_s() -> f64 {
    // there is no Linux without it
    clock_gettime(ClockId::CLOCK_MONOTONIC)
        .map_or(0.0, |now| now.tv_sec() as f64 + 1e-9 * now.tv_nsec() as f64)
}
