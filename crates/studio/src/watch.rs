//! Cameras that are looked through, for as long as somebody asks what they see.

use std::collections::VecDeque;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use axum::body::Bytes;
use serde_json::{Value, json};
use tokio::sync::watch;
use tokio::time::timeout;
use tracelight_task::{Failure, Stop};

use crate::program::Program;
use crate::tasks::broken;

/// How a camera is called where a picture may be: `camera:video0`.
pub(crate) const AS_PICTURE: &str = "camera:";
/// The simulated camera, alone or with a picture of the folder on its wall: `sim:house.png`.
pub(crate) const SIMULATED: &str = "sim";
/// How long nobody has to ask for an image until the camera is let go.
const UNASKED: Duration = Duration::from_secs(4);
/// How long an image is waited for, and the end of who looked before.
const PATIENCE: Duration = Duration::from_secs(15);
/// Images that are kept for pages to fetch, and cameras that are looked through at once.
const KEPT: usize = 4;
const MOST: usize = 2;

/// Cameras that are looked through.
#[derive(Default)]
pub(crate) struct Watching {
    all: Mutex<Vec<Arc<Watch>>>,
    /// The number that was given last.
    numbers: Arc<AtomicU64>,
}

/// A camera that is looked through.
struct Watch {
    id: String,
    /// The calibration that its images are held against, by name; empty for none.
    held: String,
    stop: Stop,
    asked: Mutex<Instant>,
    numbers: Arc<AtomicU64>,
    seen: watch::Sender<Seen>,
}

#[derive(Clone, Default)]
struct Seen {
    /// How many there were.
    number: u64,
    /// The newest last: number, image, and what is in it.
    images: VecDeque<(u64, Bytes, Arc<Value>)>,
    /// Why there are no more.
    ended: Option<Failure>,
}

fn locked<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Watching {
    /// Who looks through a camera and holds it against that, if somebody does.
    fn found(&self, id: &str, held: &str) -> Option<Arc<Watch>> {
        let all = locked(&self.all);
        all.iter().find(|watch| watch.id == id && watch.held == held && !watch.is_over()).cloned()
    }

    /// What a camera sees in an image newer than that number; opened by a command where nobody looks through it yet.
    ///
    /// # Errors
    /// What the camera fails with.
    pub(crate) async fn look(
        &self,
        program: &Arc<dyn Program>,
        (id, held): (&str, &str),
        command: Vec<String>,
        after: u64,
    ) -> Result<Value, Failure> {
        let watch = match self.found(id, held) {
            Some(watch) => watch,
            None => self.opened(program, (id, held), command).await,
        };
        // of a studio that was open before
        let after = if after > self.numbers.load(Ordering::Relaxed) { 0 } else { after };
        let mut seen = watch.seen.subscribe();
        let waited =
            timeout(PATIENCE, seen.wait_for(|seen| seen.number > after || seen.ended.is_some())).await;
        *locked(&watch.asked) = Instant::now();
        let seen = match waited {
            Ok(Ok(seen)) => seen.clone(),
            Ok(Err(_)) => return Err(broken()),
            Err(_) => {
                let message = format!("the camera sends no image for {} s", PATIENCE.as_secs());
                return Err(Failure::failed("no-image", message));
            }
        };
        match (seen.images.back().filter(|(number, ..)| *number > after), seen.ended) {
            (Some((number, _, told)), _) => {
                let mut told = Value::clone(told);
                told["number"] = json!(number);
                told["image"] = json!(format!("/api/v1/cameras/{id}/images/{number}"));
                Ok(told)
            }
            (None, why) => Err(why.unwrap_or_else(broken)),
        }
    }

    /// Looks through a camera from now on.
    async fn opened(
        &self,
        program: &Arc<dyn Program>,
        (id, held): (&str, &str),
        command: Vec<String>,
    ) -> Arc<Watch> {
        // a camera is one program's at a time, and nobody needs many
        self.free(id).await;
        let oldest = {
            let mut all = locked(&self.all);
            all.retain(|watch| !watch.is_over());
            (all.len() >= MOST).then(|| Arc::clone(&all[0]))
        };
        if let Some(oldest) = oldest {
            oldest.let_go().await;
        }
        // somebody else may have been quicker
        if let Some(watch) = self.found(id, held) {
            return watch;
        }
        let watch = Arc::new(Watch {
            id: id.to_owned(),
            held: held.to_owned(),
            stop: Stop::default(),
            asked: Mutex::new(Instant::now()),
            numbers: Arc::clone(&self.numbers),
            seen: watch::Sender::new(Seen::default()),
        });
        locked(&self.all).push(Arc::clone(&watch));
        let (program, of) = (Arc::clone(program), Arc::clone(&watch));
        let begun =
            std::thread::Builder::new().name("camera".to_owned()).spawn(move || of.look(&*program, &command));
        if let Err(e) = begun {
            let why = Failure::failed("internal", format!("this computer gives no thread: {e}"));
            drop(AtEnd { of: &watch, why });
        }
        watch
    }

    /// Has nobody look through a camera any more, so that a command may.
    pub(crate) async fn free(&self, id: &str) {
        let on: Vec<Arc<Watch>> =
            locked(&self.all).iter().filter(|watch| watch.id == id && !watch.is_over()).cloned().collect();
        for watch in on {
            watch.let_go().await;
        }
    }

    /// Has nobody look through any camera any more.
    pub(crate) fn close(&self) {
        locked(&self.all).iter().for_each(|watch| {
            watch.stop.want();
        });
    }

    /// An image of a camera that is looked through.
    pub(crate) fn image(&self, id: &str, number: u64) -> Option<Bytes> {
        let all = locked(&self.all);
        all.iter().filter(|watch| watch.id == id).find_map(|watch| {
            let seen = watch.seen.borrow();
            seen.images.iter().find(|(of, ..)| *of == number).map(|(_, jpeg, _)| jpeg.clone())
        })
    }
}

/// The camera that is meant where a picture may be; `None` of a picture.
pub(crate) fn as_camera(picture: &str) -> Option<&str> {
    picture.strip_prefix(AS_PICTURE)
}

/// Whether a camera is simulated, in a simulated room.
pub(crate) fn is_simulated(camera: &str) -> bool {
    camera.split(':').next() == Some(SIMULATED)
}

impl Watch {
    fn is_over(&self) -> bool {
        self.seen.borrow().ended.is_some()
    }

    /// Takes an image; whether somebody wants more.
    fn take(&self, jpeg: Vec<u8>, told: Value) -> bool {
        // no two images of any camera have one number: a page knows by it what it has seen
        let number = self.numbers.fetch_add(1, Ordering::Relaxed) + 1;
        self.seen.send_modify(|seen| {
            seen.number = number;
            seen.images.push_back((seen.number, Bytes::from(jpeg), Arc::new(told)));
            if seen.images.len() > KEPT {
                seen.images.pop_front();
            }
        });
        // who waits asks still
        let is_wanted = self.seen.receiver_count() > 0 || locked(&self.asked).elapsed() < UNASKED;
        is_wanted && !self.stop.is_wanted()
    }

    /// Looks until nobody wants more.
    fn look(&self, program: &dyn Program, command: &[String]) {
        // also where it panics
        let mut end = AtEnd { of: self, why: broken() };
        end.why = match program.look(command, &self.stop, &mut |jpeg, told| self.take(jpeg, told)) {
            Ok(()) => Failure::interrupted(),
            Err(failure) => failure,
        };
    }

    /// Has it end, and waits until its camera is free.
    async fn let_go(&self) {
        self.stop.want();
        let mut seen = self.seen.subscribe();
        // one that hangs is found busy by who opens it next
        let _ = timeout(PATIENCE, seen.wait_for(|seen| seen.ended.is_some())).await;
    }
}

/// Says that a look is over, however it ended.
struct AtEnd<'a> {
    of: &'a Watch,
    why: Failure,
}

impl Drop for AtEnd<'_> {
    fn drop(&mut self) {
        self.of.seen.send_modify(|seen| seen.ended = Some(self.why.clone()));
    }
}

/// What a camera is called where files are named by it.
pub(crate) fn file_stem(id: &str) -> String {
    let picture = id.strip_prefix(SIMULATED).and_then(|rest| rest.strip_prefix(':'));
    let stem = picture.and_then(|picture| Path::new(picture).file_stem()?.to_str()).unwrap_or(id);
    format!("{stem}-camera.png")
}
