//! The frame of a drawing, again and again until somebody asks for the drawing.

use tracelight_pipeline::Driving;
use tracelight_session::{Event, Job, Refused, Request, Snapshot, State};
use tracelight_sim::{Observed, Tick};
use tracelight_stroke::Drawing;
use tracelight_task::{Failure, Task};

use crate::course::{Course, Ended, Wall, drive};
use crate::hands::{Ask, Hands, Step};
use crate::keep::Keep;
use crate::looped::{Item, Looped};

/// What to do where a frame cannot be drawn.
const WAY_OUT: &str =
    "take another one (--frame hull is never further out than the drawing), or leave --frame out";

/// A frame that can be drawn; `None` where none is asked for.
///
/// # Errors
/// Why it cannot be drawn: a corner of it is out of reach, or all of it is to be kept dark.
pub(crate) fn frame_of(
    frame: Option<&Drawing>,
    driving: &Driving,
    dry: bool,
) -> Result<Option<Looped>, Failure> {
    let Some(frame) = frame else { return Ok(None) };
    let wrong = |why: &str| Failure::failed("frame", format!("--frame: {why}; {WAY_OUT}"));
    if frame.strokes.is_empty() {
        return Err(wrong("all of it lies in what --no-go keeps dark"));
    }
    let item = Item::frame(frame.clone());
    Looped::of(&item, 1, driving, dry).map(Some).map_err(|failure| wrong(&failure.message))
}

/// Drives a course, after its frame where it has one.
pub(crate) fn drive_framed(
    rig: &mut dyn Observed,
    (first, course): (Job, &mut dyn Course),
    frame: Option<&Looped>,
    (keep, hands): (&mut dyn Keep, &mut dyn Hands),
    task: Task<'_>,
) -> Result<Ended, Failure> {
    let Some(frame) = frame else {
        course.begins(hands);
        return drive(rig, first, course, (keep, hands), task);
    };
    hands.frames(true);
    let mut framed = Framed { frame, first, course, stage: Stage::Before };
    let mut ended = drive(rig, frame.job.clone(), &mut framed, (keep, hands), task)?;
    if framed.stage != Stage::Course && ended.now.state == State::Done {
        let message = "nobody asked for more than the frame for ten minutes: it ended, and nothing was drawn";
        ended.failure = ended.failure.or_else(|| Some(Failure::failed("unfinished", message)));
    }
    Ok(ended)
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    /// Nothing has moved.
    Before,
    /// The frame is drawn.
    Frame,
    /// On the way to the course.
    Between,
    /// The frame is over.
    Course,
}

struct Framed<'a> {
    frame: &'a Looped,
    first: Job,
    course: &'a mut dyn Course,
    stage: Stage,
}

impl Course for Framed<'_> {
    fn keep(&mut self, keep: &mut dyn Keep, tick: Tick, now: &Snapshot, laps: u32) -> Result<(), Failure> {
        if self.stage == Stage::Between && now.state.is_on() {
            self.stage = Stage::Course;
        }
        match self.stage {
            Stage::Course => self.course.keep(keep, tick, now, laps),
            Stage::Before => {
                self.stage = Stage::Frame;
                self.course.keep(keep, tick, now, laps)
            }
            Stage::Frame if laps == 0 => keep.aside(&self.frame.once, &tick),
            Stage::Frame | Stage::Between => keep.aside(&self.frame.again, &tick),
        }
    }

    fn see(&mut self, event: &Event, now: &Snapshot) -> bool {
        match self.stage {
            Stage::Course => self.course.see(event, now),
            _ => !matches!(event, Event::Stroke { .. }),
        }
    }

    fn ask(
        &mut self,
        ask: Ask,
        wall: &mut Wall<'_>,
        hands: &mut dyn Hands,
        task: Task<'_>,
    ) -> Result<(), Refused> {
        let begins = wall.awaits_job();
        let goes_on = matches!(ask, Ask::Step(_) | Ask::Request(Request::Resume));
        match (self.stage, ask) {
            (Stage::Course, ask) => self.course.ask(ask, wall, hands, task),
            // it was stopped on its way, or by a fault
            (Stage::Between, _) if begins && goes_on => wall.request(Request::Next(self.first.clone())),
            (_, _) if begins && goes_on => wall.request(Request::Next(self.frame.job.clone())),
            (Stage::Frame, Ask::Step(Step::Next | Step::Skip)) => {
                wall.request(Request::Next(self.first.clone()))?;
                self.stage = Stage::Between;
                hands.frames(false);
                self.course.begins(hands);
                Ok(())
            }
            (_, Ask::Step(_)) => Ok(()),
            (_, Ask::Request(request)) => wall.request(request),
        }
    }

    fn is_over(&self) -> bool {
        self.stage == Stage::Course && self.course.is_over()
    }
}
