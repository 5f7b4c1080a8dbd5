//! Strokes one at a time: each is drawn again and again until somebody asks for the next one.

use tracelight_pipeline::{Driving, Schedule, schedule_rest};
use tracelight_rig::Fault;
use tracelight_session::{Event, Job, Refused, Request, Session, Snapshot, State};
use tracelight_sim::{Run, SimulatedRig, Tick, looped_job};
use tracelight_stroke::{Drawing, Path, Stroke};
use tracelight_task::{Failure, Task, counted};
use tracelight_trajectory::{Plan, plan_from};

use crate::by_hand::{Ask, Course, Hands, REST_TICKS, Step, drive};
use crate::keep::Keep;
use crate::remainder::join;

/// What came of it.
pub(crate) struct StepRun {
    /// The first time of each stroke.
    pub(crate) run: Run,
    /// What that followed.
    pub(crate) plan: Plan,
    /// The strokes that were looked at, in the order in which they were asked for.
    pub(crate) drawing: Drawing,
    /// Why it ended before its time, if neither the rig nor the user ended it.
    pub(crate) failure: Option<Failure>,
    /// The fault that ended it.
    pub(crate) fault: Option<Fault>,
    /// All strokes had their turn.
    pub(crate) finished: bool,
    pub(crate) notes: Vec<String>,
}

/// A stroke to be drawn again and again.
struct Looped {
    /// There and back, where it is open.
    stroke: Stroke,
    /// From zero to it, once.
    once: Plan,
    /// From its end, again and again.
    again: Plan,
    job: Job,
}

/// There along a stroke and back, where it is open: it ends where it begins.
fn there_and_back(path: &Path) -> Path {
    if path.is_closed() {
        return path.clone();
    }
    let mut both = path.clone();
    path.reversed().elements().iter().for_each(|&element| both.push(element));
    both
}

impl Looped {
    fn of(
        stroke: &Stroke,
        (number, of): (usize, usize),
        driving: &Driving,
        dry: bool,
    ) -> Result<Self, Failure> {
        let stroke = stroke.along(there_and_back(&stroke.path));
        let drawing = Drawing { strokes: vec![stroke.clone()] };
        let Schedule { plan: once, .. } = schedule_rest(drawing.clone(), driving)?;
        let end = once.points.last().map(|point| point.joints.map(|joint| joint.position_rad));
        let again = plan_from(&drawing, &driving.machine, &driving.request, end.unwrap_or_default())
            .map_err(tracelight_pipeline::refused)?;
        let looped = looped_job(&driving.rig, &once, &again, dry).ok_or_else(|| stands(number))?;
        let job = Job { first: number as u32, of: of as u32, ..looped };
        Ok(Self { stroke, once, again, job })
    }
}

fn stands(number: usize) -> Failure {
    let message = format!(
        "stroke {} is so short that its light would stand, drawn again and again: draw it larger (--width), or without --step",
        number + 1
    );
    Failure::failed("standing-light", message)
}

/// A walk through the strokes of a drawing.
struct Walk<'a> {
    strokes: &'a [Stroke],
    driving: &'a Driving,
    dry: bool,
    /// The stroke that is drawn.
    at: usize,
    looped: Looped,
    /// What is drawn now begins there in `run`'s plan.
    base: u32,
    done: Vec<bool>,
    seen: StepRun,
    /// Ticks since it rests.
    rests: u32,
}

/// Goes through the strokes of a drawing, each drawn again and again until somebody asks for another one.
pub(crate) fn run_steps(
    rig: &mut SimulatedRig,
    (drawing, driving): (&Drawing, &Driving),
    dry: bool,
    (keep, hands): (&mut dyn Keep, &mut dyn Hands),
    task: Task<'_>,
) -> Result<StepRun, Failure> {
    let mut walk = Walk::begin(&drawing.strokes, driving, dry)?;
    let ended = drive(rig, walk.looped.job.clone(), &mut walk, (keep, hands), task)?;
    if ended.state == State::Done {
        walk.seen.notes.push("nothing was asked for ten minutes: it ended, dark".to_owned());
    }
    (walk.seen.failure, walk.seen.fault) = (ended.failure, ended.fault);
    Ok(walk.ended())
}

impl<'a> Walk<'a> {
    fn begin(strokes: &'a [Stroke], driving: &'a Driving, dry: bool) -> Result<Self, Failure> {
        let Some(first) = strokes.first() else {
            return Err(Failure::failed("no-strokes", "there is no stroke to step through"));
        };
        let looped = Looped::of(first, (0, strokes.len()), driving, dry)?;
        let seen = StepRun {
            run: Run::default(),
            plan: looped.once.clone(),
            drawing: Drawing { strokes: vec![looped.stroke.clone()] },
            failure: None,
            fault: None,
            finished: false,
            notes: Vec::new(),
        };
        Ok(Self {
            strokes,
            driving,
            dry,
            at: 0,
            looped,
            base: 0,
            done: vec![false; strokes.len()],
            seen,
            rests: 0,
        })
    }

    /// The stroke that was to be drawn when it was stopped on the way there, or by a fault: it is begun again, from
    /// wherever that left the head.
    fn begin_here(&self, ask: Ask, wall: &mut Session<&mut SimulatedRig>) -> Result<(), Refused> {
        wall.request(match ask {
            Ask::Step(_) | Ask::Request(Request::Resume) => Request::Next(self.looped.job.clone()),
            Ask::Request(request) => request,
        })
    }

    /// Goes to another stroke; after the last one it is finished. One that cannot be drawn again and again is left out, and said.
    fn step(
        &mut self,
        step: Step,
        wall: &mut Session<&mut SimulatedRig>,
        hands: &mut dyn Hands,
        task: Task<'_>,
    ) -> Result<(), Refused> {
        let forwards = !matches!(step, Step::Previous);
        let mut to = match step {
            Step::Next | Step::Skip => Some(self.at + 1),
            Step::Previous => self.at.checked_sub(1),
            Step::To(number) => Some((number as usize).min(self.strokes.len() - 1)),
        };
        while let Some(number) = to.filter(|&number| number < self.strokes.len()) {
            match Looped::of(&self.strokes[number], (number, self.strokes.len()), self.driving, self.dry) {
                Ok(looped) => {
                    let lit = self.was_lit(wall);
                    wall.request(Request::Next(looped.job.clone()))?;
                    self.tick_off(step, lit, hands);
                    let end = self.seen.plan.points.len().saturating_sub(1) as u32;
                    let visits = self.seen.drawing.strokes.len() as u32;
                    self.base = join(&mut self.seen.plan, end, &looped.once, visits);
                    self.seen.drawing.strokes.push(looped.stroke.clone());
                    (self.at, self.looped) = (number, looped);
                    return Ok(());
                }
                Err(why) => {
                    let note = format!("stroke {} is left out: {}", number + 1, why.message);
                    task.say(&format!("note: {note}"));
                    self.seen.notes.push(note);
                    to = if forwards { Some(number + 1) } else { number.checked_sub(1) };
                }
            }
        }
        if !forwards {
            return Ok(());
        }
        self.tick_off(step, self.was_lit(wall), hands);
        self.seen.finished = true;
        wall.request(Request::Stop)
    }

    /// Whether the present stroke was drawn, or a part of it.
    fn was_lit(&self, wall: &Session<&mut SimulatedRig>) -> bool {
        let now = wall.snapshot();
        now.laps > 0 || now.plan_tick > 0
    }

    fn tick_off(&mut self, step: Step, lit: bool, hands: &mut dyn Hands) {
        self.done[self.at] |= step == Step::Next && (lit || self.dry);
        hands.left(self.at as u32, self.done[self.at]);
    }

    fn ended(mut self) -> StepRun {
        let done = self.done.iter().filter(|&&done| done).count();
        let not: Vec<String> =
            (1..).zip(&self.done).filter(|(_, done)| !**done).map(|(number, _)| number.to_string()).collect();
        let all = counted(self.strokes.len(), "stroke");
        let which = match not.len() {
            0 => String::new(),
            1..=20 => format!("; not {}", not.join(", ")),
            n => format!("; not {}, and {} more", not[..20].join(", "), n - 20),
        };
        self.seen.notes.push(format!(
            "stroke by stroke: {done} of {all} done{which}; the figures are of each one's first time"
        ));
        self.seen
    }
}

impl Course for Walk<'_> {
    /// Keeps all ticks in the log, and those of each stroke's first time for the figures.
    fn keep(
        &mut self,
        keep: &mut dyn Keep,
        mut tick: Tick,
        now: &Snapshot,
        laps: u32,
    ) -> Result<(), Failure> {
        let state = now.state;
        if laps > 0 && state != State::Parking {
            return keep.tick(&self.looped.again, &tick);
        }
        // on its way to a stroke it is at rest at the beginning of that one's plan
        let plan_tick = if state == State::Parking { 0 } else { tick.telemetry.plan_tick };
        tick.telemetry.plan_tick = self.base + plan_tick;
        keep.tick(&self.seen.plan, &tick)?;
        let is_on = matches!(state, State::Stepping | State::Returning | State::Pausing);
        self.rests = if is_on { 0 } else { self.rests.saturating_add(1) };
        if state != State::Parking && self.rests <= REST_TICKS {
            self.seen.run.ticks.push(tick);
        }
        Ok(())
    }

    /// Tells all but strokes that are begun again.
    fn see(&mut self, event: &Event, now: &Snapshot) -> bool {
        !matches!(event, Event::Stroke { .. }) || now.laps == 0
    }

    fn ask(
        &mut self,
        ask: Ask,
        wall: &mut Session<&mut SimulatedRig>,
        hands: &mut dyn Hands,
        task: Task<'_>,
    ) -> Result<(), Refused> {
        if wall.state() == State::Armed && wall.snapshot().plan_ticks == 0 {
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
