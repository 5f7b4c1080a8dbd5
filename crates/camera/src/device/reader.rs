use std::io;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use moq_v4l::buffer::{Flags, Metadata};
use moq_v4l::io::mmap::Stream;
use moq_v4l::io::traits::CaptureStream;
use nix::sys::signal::SigSet;
use nix::time::{ClockId, clock_gettime};
use tracelight_picture::unless_it_panics;

use super::why;
use crate::latest::{Latest, PATIENCE};
use tracelight_eye::about::{Rhythm, Stamps};
use tracelight_eye::coding::Layout;

/// An image that a camera sent.
#[derive(Clone, Debug)]
pub(super) struct Received {
    pub(super) bytes: Vec<u8>,
    /// How many came until then, itself and broken ones, too.
    pub(super) number: u64,
    /// When it began to arrive, by the clock that never jumps, s: the driver's stamp, or what comes nearest.
    pub(super) stamp_s: f64,
}

/// Ages of images that are kept.
const MOST_AGES: usize = 1000;
/// How long one is waited for until it is asked whether any is still wanted, ms.
const GLANCE_MS: i32 = 100;
/// How long the end of a stream is waited for.
const FAREWELL: Duration = Duration::from_secs(1);
/// Images without an end after which a camera is believed never to send one.
const ENDLESS: u32 = 10;

/// A camera's images, read by a thread of its own; it ends when this is dropped.
pub(super) struct Reader {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

struct Shared {
    layout: Layout,
    /// From one image to the next, s.
    interval_s: f64,
    latest: Latest<Received>,
    rhythm: Mutex<Rhythm>,
    /// Images that came, broken ones, too.
    count: AtomicU64,
    /// Nobody wants any more.
    is_over: AtomicBool,
}

impl Reader {
    /// Reads a stream's images, one each so many seconds.
    pub(super) fn begin(stream: Stream<'static>, layout: Layout, interval_s: f64) -> Self {
        let shared = Arc::new(Shared {
            layout,
            interval_s,
            latest: Latest::default(),
            rhythm: Mutex::default(),
            count: AtomicU64::new(0),
            is_over: AtomicBool::new(false),
        });
        let reads = Arc::clone(&shared);
        Self { thread: Some(std::thread::spawn(move || reads.read_all(stream))), shared }
    }

    /// The next image; or why none comes.
    pub(super) fn next(&self) -> Result<Received, String> {
        self.shared.latest.next(PATIENCE).map_err(|why| match self.rhythm() {
            Rhythm { images: 0, broken, .. } if broken > 0 => {
                format!("{broken} images came, none of them whole: is its cable bad?")
            }
            _ => why,
        })
    }

    /// How many images came until now, broken ones, too.
    pub(super) fn count(&self) -> u64 {
        self.shared.count.load(Ordering::SeqCst)
    }

    /// How its images came until now.
    pub(super) fn rhythm(&self) -> Rhythm {
        self.shared.rhythm.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Drop for Reader {
    fn drop(&mut self) {
        self.shared.is_over.store(true, Ordering::SeqCst);
        // whoever opens a camera next, this one or its neighbour on the bus, would find it busy
        let until = Instant::now() + FAREWELL;
        let Some(thread) = self.thread.take() else { return };
        while !thread.is_finished() && Instant::now() < until {
            std::thread::sleep(Duration::from_millis(2));
        }
    }
}

/// What a reading thread remembers from image to image.
#[derive(Default)]
struct SoFar {
    /// Number that the driver gave the last.
    numbered: Option<u32>,
    /// Images without an end; `None` once one had an end.
    endless: Option<u32>,
    is_begun: bool,
}

impl Shared {
    /// Reads until nobody wants any more, or none comes.
    fn read_all(&self, mut stream: Stream<'_>) {
        // one that interrupts a wait would leave the library with a buffer that it hands over twice
        let _ = SigSet::all().thread_block();
        stream.set_timeout(PATIENCE);
        let mut so_far = SoFar { endless: Some(0), ..SoFar::default() };
        let Err(error) = why::calmly(|| self.read_on(&mut stream, &mut so_far)) else {
            let _ = unless_it_panics(|| drop(stream));
            return;
        };
        let is_calm = error.kind() == io::ErrorKind::TimedOut || why::is_gone(&error);
        self.latest.end(why::in_words(&error));
        if is_calm {
            let _ = unless_it_panics(|| drop(stream));
        } else {
            // the library panics, twice at once, where a stream that failed cannot be ended either
            std::mem::forget(stream);
        }
    }

    fn read_on(&self, stream: &mut Stream<'_>, so_far: &mut SoFar) -> io::Result<()> {
        /// `POLLIN`
        const THERE_IS_ONE: i16 = 1;
        let mut last = Instant::now();
        while !self.is_over.load(Ordering::SeqCst) {
            // the first begins the stream, and waits by itself
            if so_far.is_begun && stream.handle().poll(THERE_IS_ONE, GLANCE_MS)? == 0 {
                if last.elapsed() > PATIENCE {
                    return Err(io::ErrorKind::TimedOut.into());
                }
                continue;
            }
            self.read(stream, so_far)?;
            last = Instant::now();
        }
        Ok(())
    }

    fn read(&self, stream: &mut Stream<'_>, so_far: &mut SoFar) -> io::Result<()> {
        let (bytes, about) = stream.next()?;
        let arrived_s = now_s();
        let used = bytes.get(..about.bytesused as usize).unwrap_or(bytes);
        let is_whole = !about.flags.contains(Flags::ERROR) && self.is_whole(used, so_far);
        let (stamp_s, stamps) = self.stamp_s(about, arrived_s);
        let lost = so_far.numbered.map_or(0, |before| about.sequence.wrapping_sub(before).wrapping_sub(1));
        (so_far.numbered, so_far.is_begun) = (Some(about.sequence), true);
        let number = self.count.fetch_add(1, Ordering::SeqCst) + 1;
        let mut rhythm = self.rhythm.lock().unwrap_or_else(PoisonError::into_inner);
        if !is_whole {
            rhythm.broken += 1;
            return Ok(());
        }
        if rhythm.images == 0 {
            // many a camera begins with half an image
            *rhythm = Rhythm { between_s: Some([stamp_s; 2]), ..Rhythm::default() };
        } else {
            // a driver that does not count says 0 each time
            rhythm.lost += if lost < 1000 { lost } else { 0 };
        }
        rhythm.images += 1;
        rhythm.stamps = stamps;
        rhythm.between_s = rhythm.between_s.map(|[first, _]| [first, stamp_s]);
        if rhythm.late_s.len() < MOST_AGES {
            rhythm.late_s.push(arrived_s - stamp_s);
        }
        drop(rhythm);
        self.latest.put(Received { bytes: used.to_vec(), number, stamp_s });
        Ok(())
    }

    /// Whether an image is whole: of a camera that never sends an image's end, if it begins as one.
    fn is_whole(&self, bytes: &[u8], so_far: &mut SoFar) -> bool {
        let is_whole = self.layout.is_whole(bytes);
        if is_whole {
            so_far.endless = None;
        }
        if let Some(endless) = &mut so_far.endless
            && self.layout.is_endless(bytes)
        {
            *endless += 1;
            return *endless > ENDLESS;
        }
        is_whole
    }

    /// When an image began to arrive, s, and how that is known.
    fn stamp_s(&self, about: &Metadata, arrived_s: f64) -> (f64, Stamps) {
        let stamp_s = about.timestamp.sec as f64 + 1e-6 * about.timestamp.usec as f64;
        let is_stamped = about.flags.intersection(Flags::TIMESTAMP_MASK) == Flags::TIMESTAMP_MONOTONIC
            && (0.0..10.0).contains(&(arrived_s - stamp_s));
        let is_beginning = about.flags.intersection(Flags::TSTAMP_SRC_MASK) == Flags::TSTAMP_SRC_SOE;
        match (is_stamped, is_beginning) {
            (true, true) => (stamp_s, Stamps::Beginning),
            (true, false) => (stamp_s - self.interval_s, Stamps::End),
            (false, _) => (arrived_s - self.interval_s, Stamps::None),
        }
    }
}

/// The clock that never jumps, s.
pub(super) fn now_s() -> f64 {
    // there is no Linux without it
    clock_gettime(ClockId::CLOCK_MONOTONIC)
        .map_or(0.0, |now| now.tv_sec() as f64 + 1e-9 * now.tv_nsec() as f64)
}
