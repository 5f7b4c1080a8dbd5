//! Strokes, or marks of points, one at a time: each is drawn again and again until somebody asks for the next one.

use tracelight_pipeline::Driving;
use tracelight_rig::FaultRecord;
use tracelight_session::{Event, Refused, Request, Snapshot, State, seconds};
use tracelight_sim::{Observed, Run, Tick};
use tracelight_stroke::Drawing;
use tracelight_task::{Failure, Task, counted};
use tracelight_trajectory::Plan;

use crate::course::{Course, Wall};
use crate::frame::drive_framed;
use crate::hands::{Ask, Hands, Step};
use crate::keep::{Keep, Memory};
use crate::looped::{Item, Looped};
use crate::points::PointDone;
use crate::remainder::join;

/// What came of it.
pub(crate) struct StepRun {
    /// The first time of each item.
    pub(crate) run: Run,
    /// What that followed.
    pub(crate) plan: Plan,
    /// The strokes that were looked at, in the order in which they were asked for.
    pub(crate) drawing: Drawing,
    /// Why it ended before its time, if neither the rig nor the user ended it.
    pub(crate) failure: Option<Failure>,
    /// The fault that ended it.
    pub(crate) fault: Option<FaultRecord>,
    /// All items had their turn.
    pub(crate) finished: bool,
    /// When which point was ticked off, s of the run.
    pub(crate) points: Vec<PointDone>,
    pub(crate) notes: Vec<String>,
}

/// A walk through the items of a drawing.
struct Walk<'a> {
    items: &'a [Item],
    driving: &'a Driving,
    dry: bool,
    /// The item that is drawn.
    at: usize,
    looped: Looped,
    /// What is drawn now begins there in `run`'s plan.
    base: u32,
    /// When each was ticked off, s.
    done_s: Vec<Option<f64>>,
    /// One was ticked off that is not kept yet.
    is_new: bool,
    seen: StepRun,
    memory: Memory,
}

/// Goes through items, each drawn again and again until somebody asks for another one.
pub(crate) fn run_steps(
    rig: &mut dyn Observed,
    (items, driving): (&[Item], &Driving),
    (frame, dry): (Option<&Looped>, bool),
    (keep, hands): (&mut dyn Keep, &mut dyn Hands),
    task: Task<'_>,
) -> Result<StepRun, Failure> {
    let mut walk = Walk::begin(items, driving, dry)?;
    let first = walk.looped.job.clone();
    let ended = drive_framed(rig, (first, &mut walk), frame, (keep, hands), task)?;
    if ended.now.state == State::Done {
        walk.seen.notes.push("nothing was asked for ten minutes: it ended, dark".to_owned());
    }
    (walk.seen.failure, walk.seen.fault) = (ended.failure, ended.fault);
    Ok(walk.ended())
}

/// How many there are in the whole drawing: the last one's number tells.
fn of_all(items: &[Item]) -> u32 {
    items.last().map_or(0, |item| item.number + 1)
}

impl<'a> Walk<'a> {
    fn begin(items: &'a [Item], driving: &'a Driving, dry: bool) -> Result<Self, Failure> {
        let Some(first) = items.first() else {
            return Err(Failure::failed("no-strokes", "there is no stroke to step through"));
        };
        let looped = Looped::of(first, of_all(items), driving, dry)?;
        let seen = StepRun {
            run: Run::default(),
            plan: looped.once.clone(),
            drawing: Drawing { strokes: looped.strokes.clone() },
            failure: None,
            fault: None,
            finished: false,
            points: Vec::new(),
            notes: Vec::new(),
        };
        Ok(Self {
            items,
            driving,
            dry,
            at: 0,
            looped,
            base: 0,
            done_s: vec![None; items.len()],
            is_new: false,
            seen,
            memory: Memory::default(),
        })
    }

    /// The item that was to be drawn when it was stopped on the way there, or by a fault: it is begun again, from
    /// wherever that left the head.
    fn begin_here(&self, ask: Ask, wall: &mut Wall<'_>) -> Result<(), Refused> {
        wall.request(match ask {
            Ask::Step(_) | Ask::Request(Request::Resume) => Request::Next(self.looped.job.clone()),
            Ask::Request(request) => request,
        })
    }

    fn tell_where(&self, hands: &mut dyn Hands) {
        let item = &self.items[self.at];
        item.point.iter().for_each(|point| hands.goes_to(point, item.number, of_all(self.items)));
    }

    /// Goes to another item; after the last one it is finished. One that cannot be drawn again and again is left out, and said.
    fn step(
        &mut self,
        step: Step,
        wall: &mut Wall<'_>,
        hands: &mut dyn Hands,
        task: Task<'_>,
    ) -> Result<(), Refused> {
        let forwards = !matches!(step, Step::Previous);
        let mut to = match step {
            Step::Next | Step::Skip => Some(self.at + 1),
            Step::Previous => self.at.checked_sub(1),
            Step::To(number) => {
                let at = number.saturating_sub(self.items.first().map_or(0, |item| item.number));
                Some((at as usize).min(self.items.len() - 1))
            }
        };
        while let Some(number) = to.filter(|&number| number < self.items.len()) {
            let item = &self.items[number];
            match Looped::of(item, of_all(self.items), self.driving, self.dry) {
                Ok(looped) => {
                    let lit = self.was_lit(wall);
                    wall.request(Request::Next(looped.job.clone()))?;
                    self.tick_off(step, lit, wall, hands);
                    let end = self.seen.plan.points.len().saturating_sub(1) as u32;
                    let visits = self.seen.drawing.strokes.len() as u32;
                    self.base = join(&mut self.seen.plan, end, &looped.once, visits);
                    self.seen.drawing.strokes.extend(looped.strokes.iter().cloned());
                    (self.at, self.looped) = (number, looped);
                    self.tell_where(hands);
                    return Ok(());
                }
                Err(why) => {
                    let note = format!("{} {} is left out: {}", item.word(), item.number + 1, why.message);
                    task.say(&format!("note: {note}"));
                    self.seen.notes.push(note);
                    to = if forwards { Some(number + 1) } else { number.checked_sub(1) };
                }
            }
        }
        if !forwards {
            return Ok(());
        }
        self.tick_off(step, self.was_lit(wall), wall, hands);
        self.seen.finished = true;
        wall.request(Request::Stop)
    }

    /// Whether the present item was drawn, or a part of it.
    fn was_lit(&self, wall: &Wall<'_>) -> bool {
        let now = wall.snapshot();
        let begins = self.looped.job.strokes.first().map_or(0, |stroke| stroke.start);
        now.laps > 0 || now.plan_tick > begins
    }

    fn tick_off(&mut self, step: Step, lit: bool, wall: &Wall<'_>, hands: &mut dyn Hands) {
        let done_s = &mut self.done_s[self.at];
        if step == Step::Next && (lit || self.dry) {
            self.is_new |= done_s.is_none();
            done_s.get_or_insert(seconds(wall.told().tick));
        }
        hands.left(self.items[self.at].number, done_s.is_some());
    }

    fn ended(mut self) -> StepRun {
        let done = self.done_s.iter().flatten().count();
        let not = self.items.iter().zip(&self.done_s).filter(|(_, done_s)| done_s.is_none());
        let not: Vec<String> = not.map(|(item, _)| (item.number + 1).to_string()).collect();
        let word = self.items.first().map_or("stroke", Item::word);
        let all = counted(self.items.len(), word);
        let which = match not.len() {
            0 => String::new(),
            1..=20 => format!("; not {}", not.join(", ")),
            n => format!("; not {}, and {} more", not[..20].join(", "), n - 20),
        };
        self.seen.notes.push(format!(
            "{word} by {word}: {done} of {all} done{which}; the figures are of each one's first time"
        ));
        self.seen.points = self.points();
        self.seen
    }

    /// The points among the items, as they stand now.
    fn points(&self) -> Vec<PointDone> {
        let points = self.items.iter().zip(&self.done_s);
        let done = |(item, done_s): (&Item, &Option<f64>)| {
            item.point.clone().map(|place| PointDone { number: item.number, place, done_s: *done_s })
        };
        points.filter_map(done).collect()
    }
}

impl Course for Walk<'_> {
    fn begins(&mut self, hands: &mut dyn Hands) {
        self.tell_where(hands);
    }

    /// Keeps all ticks in the log, and those of each stroke's first time for the figures.
    fn keep(
        &mut self,
        keep: &mut dyn Keep,
        mut tick: Tick,
        now: &Snapshot,
        laps: u32,
    ) -> Result<(), Failure> {
        if std::mem::take(&mut self.is_new) {
            keep.points(&self.points())?;
        }
        let state = now.state;
        if laps > 0 && state != State::Parking {
            return keep.tick(&self.looped.again, &tick);
        }
        // on its way to a stroke it is at rest at the beginning of that one's plan
        let plan_tick = if state == State::Parking { 0 } else { tick.telemetry.plan_tick };
        tick.telemetry.plan_tick = self.base + plan_tick;
        keep.tick(&self.seen.plan, &tick)?;
        self.memory.keep(&mut self.seen.run.ticks, tick, state);
        Ok(())
    }

    /// Tells all but what is begun again.
    fn see(&mut self, event: &Event, now: &Snapshot) -> bool {
        !matches!(event, Event::Stroke { .. }) || now.laps == 0
    }

    fn ask(
        &mut self,
        ask: Ask,
        wall: &mut Wall<'_>,
        hands: &mut dyn Hands,
        task: Task<'_>,
    ) -> Result<(), Refused> {
        if wall.awaits_job() {
            return self.begin_here(ask, wall);
        }
        match ask {
            Ask::Request(request) => wall.request(request),
            Ask::Step(step) => self.step(step, wall, hands, task),
        }
    }

    fn is_over(&self) -> bool {
        self.seen.finished
    }
}
