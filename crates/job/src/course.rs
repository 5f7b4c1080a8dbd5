//! One way to drive a session with somebody at the wall, whatever is drawn.

use tracelight_eye::power::{PowerWatch, check_homed, lost_power};
use tracelight_eye::refused;
use tracelight_rig::FaultRecord;
use tracelight_session::{Event, Job, Refused, Request, Session, Snapshot, State};
use tracelight_sim::{AFTERMATH_TICKS, Observed, Tick, observed_tick};
use tracelight_task::{Failure, Task};

use crate::hands::{Ask, Hands};
use crate::keep::Keep;

/// A rig that a session has in hand, whichever it is.
pub(crate) type Wall<'a> = Session<&'a mut (dyn Observed + 'a)>;

/// Ticks the head is watched after the user stopped it: longer than any relay of a rig file takes to open.
const GOODBYE_TICKS: u32 = 80;

/// What a session does with somebody at the wall, and what is kept of it.
pub(crate) trait Course {
    /// Its first job is about to begin.
    fn begins(&mut self, _hands: &mut dyn Hands) {}

    /// Keeps a tick; `laps` is how often a job that is done again and again had been done before it.
    fn keep(&mut self, keep: &mut dyn Keep, tick: Tick, now: &Snapshot, laps: u32) -> Result<(), Failure>;

    /// Sees what happened; false where nobody needs to be told.
    fn see(&mut self, event: &Event, now: &Snapshot) -> bool;

    /// Does what is asked.
    fn ask(
        &mut self,
        ask: Ask,
        wall: &mut Wall<'_>,
        hands: &mut dyn Hands,
        task: Task<'_>,
    ) -> Result<(), Refused>;

    /// Whether nothing is to come any more.
    fn is_over(&self) -> bool {
        false
    }
}

/// How a session ended.
pub(crate) struct Ended {
    /// Why, if its rig lost power, or was disarmed by nobody here.
    pub(crate) failure: Option<Failure>,
    /// The fault that is latched.
    pub(crate) fault: Option<FaultRecord>,
    /// Where it stood.
    pub(crate) now: Snapshot,
}

/// Lets a session with a rig run a job to its end, or to where nobody is there to go on with it. Who calls for it has done both acts of arming, unless whoever is at the
/// wall does them. A head that rests elsewhere than where the job begins goes there first. Whatever ends it darkens first.
pub(crate) fn drive(
    rig: &mut dyn Observed,
    job: Job,
    course: &mut dyn Course,
    (keep, hands): (&mut dyn Keep, &mut dyn Hands),
    task: Task<'_>,
) -> Result<Ended, Failure> {
    let wall = &mut Session::new(rig);
    let Some(first) = observed_tick(wall) else { return Ok(Ended::gone(wall)) };
    check_homed(&first.telemetry)?;
    course.keep(keep, first, &wall.snapshot(), 0)?;
    if job.dry || !hands.arms() {
        begin(wall, job).map_err(refused)?;
    }
    let mut power = PowerWatch::default();
    power.is_lost(&first.telemetry);
    let (mut goodbye, mut aftermath, mut on_ticks) = (GOODBYE_TICKS, AFTERMATH_TICKS, 0);
    let patience_ticks = wall.rig().patience_ticks();
    while !course.is_over() && wall.state() != State::Done && goodbye > 0 && aftermath > 0 {
        // the tick in which a lap ends belongs to that one
        let laps = wall.snapshot().laps;
        let Some(last) = observed_tick(wall) else { return Ok(Ended::gone(wall)) };
        let now = wall.snapshot();
        if power.is_lost(&last.telemetry) {
            return Ok(Ended { failure: Some(lost_power()), fault: None, now });
        }
        if let Err(why) = course.keep(keep, last, &now, laps) {
            let _ = wall.request(Request::Stop);
            observed_tick(wall);
            return Err(why);
        }
        while let Some(event) = wall.event() {
            if course.see(&event, &now) {
                hands.event(&event);
            }
        }
        let ended = matches!(now.state, State::Fault | State::Stopped | State::Ready);
        aftermath -= u32::from(ended && !hands.is_there());
        // a head that leaves its stroke again and again
        on_ticks += usize::from(now.state.is_on() && !now.state.repeats());
        if on_ticks > now.plan_ticks as usize + patience_ticks && !hands.is_there() {
            break;
        }
        if task.stop.is_wanted() {
            let _ = wall.request(Request::Stop);
            goodbye -= 1;
        } else if let Some(ask) = hands.tick(&now)
            && let Err(why) = course.ask(ask, wall, hands, task)
        {
            hands.refused(&why);
        }
    }
    let now = wall.snapshot();
    let is_ours = hands.is_there() || task.stop.is_wanted() || course.is_over();
    let failure = (now.state == State::Stopped && !is_ours).then(disarmed);
    // whatever ended it, and whether its gate is open or not
    if now.state != State::Done {
        let _ = wall.request(Request::Stop);
    }
    if now.gate
        && let Some(last) = observed_tick(wall)
    {
        course.keep(keep, last, &wall.snapshot(), now.laps)?;
    }
    Ok(Ended { failure, fault: wall.told().latched, now })
}

impl Ended {
    /// Of a rig that does not answer any more.
    fn gone(wall: &Wall<'_>) -> Self {
        Self { failure: Some(gone()), fault: None, now: wall.snapshot() }
    }
}

/// A rig that does not answer any more.
pub(crate) fn gone() -> Failure {
    let message = "the rig does not answer any more; its board darkens by itself. What was drawn until then is told, and `tracelight resume` with the folder of this \
                   run draws what is left";
    Failure::failed("rig-gone", message)
}

/// A rig that does not go on, though nobody here stopped it.
fn disarmed() -> Failure {
    let message = "the rig was disarmed, and not from here: by `tracelight stop` of another program, or the connection to its board was interrupted. It is dark until somebody arms it; \
                   `tracelight resume` with the folder of this run draws what is left";
    Failure::failed("disarmed", message)
}

fn begin(wall: &mut Wall<'_>, job: Job) -> Result<(), Refused> {
    if !job.dry {
        wall.request(Request::Arm)?;
    }
    match wall.request(Request::Trace(job.clone())) {
        // it goes to zero first, in the dark
        Err(Refused::Elsewhere { .. } | Refused::Moving) => {
            if job.dry {
                wall.request(Request::Arm)?;
            }
            wall.request(Request::Next(job))
        }
        begun => begun,
    }
}
