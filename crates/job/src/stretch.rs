//! A plan that a camera follows until something happens.

use tracelight_aim::Correction;
use tracelight_eye::follow::{Suspicion, strayed_rad};
use tracelight_eye::refused;
use tracelight_eye::trim::Trimmer;
use tracelight_rig::{Darkness, Phase};
use tracelight_session::{Job, Request, State};
use tracelight_sim::{AFTERMATH_TICKS, Simulated as _, job_of, slowest_speed};
use tracelight_task::Failure;
use tracelight_trajectory::Plan;

use crate::watched::{Due, Ended, Watched, may_be_found_again};

impl Watched<'_> {
    /// Begins a plan, or goes on with it; who started the job, or lets it go on, has done both acts. A head that is anywhere goes to where the plan begins.
    fn go(&mut self, plan: &Plan) -> Result<(), Failure> {
        let dry = self.job.dry;
        let request = match self.session.state() {
            State::Ready | State::Done => {
                self.trimmer = Some(Trimmer::default());
                let of = self.job.drawing.strokes.len() as u32;
                let may_slow = self.hands.is_there() && !dry;
                let slowest = if may_slow { slowest_speed(&self.driving.rig, plan) } else { 0.0 };
                let job = Job { first: self.first, of, slowest, ..job_of(plan, dry) };
                if self.goes_on { Request::Next(job) } else { Request::Trace(job) }
            }
            State::Paused | State::Stopped => Request::Resume,
            _ => return Ok(()),
        };
        let arms = !dry || matches!(request, Request::Next(_));
        let armed = if arms { self.session.request(Request::Arm) } else { Ok(()) };
        armed.and_then(|()| self.session.request(request)).map_err(refused)
    }

    /// Follows a plan until something happens.
    pub(crate) fn follow(&mut self, plan: &Plan) -> Result<Ended, Failure> {
        self.look(false);
        if self.is_ended() {
            return Ok(self.stopped());
        }
        self.go(plan)?;
        let mut most = plan.points.len() + self.session.rig().patience_ticks();
        let mut aftermath = AFTERMATH_TICKS;
        let mut lit = false;
        while most > 0 && aftermath > 0 {
            let wanted = if self.job.seen.open { Correction::default() } else { self.follower.correction() };
            self.trimmer.iter_mut().for_each(|trimmer| trimmer.wanted = wanted);
            let under_way = self.follower.is_under_way();
            let (tick, suspicion) = self.step();
            if self.is_over() {
                return Ok(self.stopped());
            }
            if self.goes_on {
                let due = self.due.take();
                if due.is_none() {
                    self.go(plan)?;
                }
                (self.goes_on, self.held) = (false, false);
                match due {
                    Some(Due::Fault(fault)) => return Ok(Ended::Fault(fault)),
                    Some(Due::Suspicion(suspicion)) => return Ok(Ended::Suspect(suspicion)),
                    None => continue,
                }
            }
            let state = self.session.state();
            let was_held = std::mem::replace(&mut self.held, !state.is_on() && state != State::Parking);
            match tick.telemetry.fault() {
                Some(fault) if may_be_found_again(fault) && self.can_recover() => {
                    if !was_held {
                        self.held = false;
                        return Ok(Ended::Fault(fault));
                    }
                    // who stopped it did not ask for dots
                    self.due = Some(Due::Fault(fault));
                }
                None if state == State::Done => return Ok(Ended::Done),
                _ => {}
            }
            aftermath -= u32::from(self.held && !self.hands.is_there());
            most -= usize::from(!self.held && !self.hands.is_there());
            lit |= tick.telemetry.actuation.lights();
            // what is armed anew on its way begins with a hold, and often with another one soon after
            let holds = under_way && matches!(tick.telemetry.phase, Phase::Holding | Phase::Testing);
            // before the first light it may only wait until its encoders were seen to follow its motors
            let waits = !lit && tick.telemetry.darkness.contains(Darkness::Untested);
            // a gyroscope tells by itself whether the head stands where it stood
            let judged = tick.telemetry.darkness.contains(Darkness::Jolted);
            let jolt = (holds && !waits && !judged).then(|| Suspicion::Jolt(strayed_rad(&tick.telemetry)));
            let suspicion = suspicion.or(jolt).filter(|_| !self.job.seen.open && state != State::Fault);
            match suspicion {
                Some(suspicion) if self.held => {
                    self.due = self.due.or(Some(Due::Suspicion(suspicion)));
                }
                Some(suspicion) => return Ok(Ended::Suspect(suspicion)),
                None => {}
            }
        }
        Ok(Ended::GivenUp)
    }

    fn stopped(&mut self) -> Ended {
        let _ = self.session.request(Request::Stop);
        self.rest(AFTERMATH_TICKS);
        Ended::Stopped
    }
}
