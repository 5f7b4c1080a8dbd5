//! How a head goes round of which nobody knows where it points: gently, a joint at a time, and back from whatever is in its way.

use tracelight_rig::{Fault, FaultRecord, Joint, PanTilt, Phase, Telemetry};
use tracelight_session::{Job, Request, State};
use tracelight_task::Failure;

use crate::Driven;
use crate::homing::state::{BEFORE_STOP_RAD, Homing, REST_TICKS};

/// Fastest and most sudden motion of a joint of which nobody knows where it is, rad/s and rad/s².
const GENTLE_RAD_S: f64 = 1.5;
const GENTLE_RAD_S2: f64 = 4.0;
/// Most times that a joint comes up against something: it has two stops.
const MOST_STOPS: usize = 8;
/// Of how many strides on either joint a place is no other than one that was tried.
const SAME_STRIDES: f64 = 0.25;
/// How long a joint swings that came up against something, ticks.
const SWING_TICKS: u32 = 300;
/// Longest that a head takes to go to zero, ticks.
const HOMEWARD_TICKS: u32 = 15_000;

impl<D: Driven> Homing<'_, D> {
    /// Goes to a place, or as near to it as a stop lets it, one joint after the other; where it is then, unless a dot was tried there before.
    pub(super) fn reach(
        &mut self,
        at: &mut PanTilt<f64>,
        place: PanTilt<f64>,
        stride_rad: PanTilt<f64>,
        tried: &[PanTilt<f64>],
    ) -> Result<Option<PanTilt<f64>>, Failure> {
        loop {
            let there = PanTilt::from_fn(|j| {
                let (lower, upper) = self.free_rad[j];
                place[j].clamp(lower, upper)
            });
            let is_same = |other: &PanTilt<f64>| {
                Joint::BOTH.into_iter().all(|j| (there[j] - other[j]).abs() < SAME_STRIDES * stride_rad[j])
            };
            if tried.iter().any(is_same) {
                return Ok(None);
            }
            let stopped = Joint::BOTH.into_iter().find_map(|j| {
                let mut to = *at;
                to[j] = there[j];
                match self.go(*at, to) {
                    Ok(None) => {
                        *at = to;
                        None
                    }
                    Ok(Some(fault)) => Some(self.turn_back(j, there[j] - at[j], tried, fault)),
                    Err(failure) => Some(Err(failure)),
                }
            });
            match stopped {
                None => return Ok(Some(there)),
                Some(turned) => turned?,
            }
            *at = PanTilt::new(0.0, 0.0);
        }
    }

    /// Something was in a joint's way, as the fault shows: goes back to where it was powered up, and goes no further that way, unless it was there before.
    fn turn_back(
        &mut self,
        joint: Joint,
        way_rad: f64,
        tried: &[PanTilt<f64>],
        record: FaultRecord,
    ) -> Result<(), Failure> {
        self.stops += 1;
        if self.stops > MOST_STOPS || !may_be_a_stop(record.fault) {
            return Err(Failure::fault(record));
        }
        // it may still go on, and swings back
        let mut end_rad = f64::NEG_INFINITY;
        for _ in 0..SWING_TICKS {
            let count = self.tick()?.measured[joint].count;
            end_rad = end_rad.max(way_rad.signum() * self.count_rad() * f64::from(count));
        }
        let beyond = |place: &PanTilt<f64>| way_rad.signum() * place[joint] > end_rad;
        if !tried.iter().any(beyond) {
            let (lower, upper) = &mut self.free_rad[joint];
            let free_rad = (end_rad - BEFORE_STOP_RAD).max(0.0);
            if way_rad < 0.0 {
                *lower = -free_rad
            } else {
                *upper = free_rad
            }
            self.task.say(&format!(
                "note: something is in the way of {joint} {:.0}° from where it was powered up: it goes no further that way",
                end_rad.max(0.0).to_degrees()
            ));
        }
        // what the fault was is known, and what it means here
        self.rig.ask(Request::Clear)?;
        self.rest(1)?;
        self.zero("the head does not come back from where something was in its way: is it free?")
    }

    /// Has the session turn the head and let out dots: who homes it has armed it.
    pub(super) fn begin(&mut self) -> Result<(), Failure> {
        if self.rig.session().state() == State::Homing {
            return Ok(());
        }
        self.rig.ask(Request::Arm)?;
        self.rig.ask(Request::Seek)
    }

    /// Moves in the dark from rest to rest, by its encoders, and rests; the fault that ended it, if one did.
    pub(super) fn go(
        &mut self,
        from: PanTilt<f64>,
        to: PanTilt<f64>,
    ) -> Result<Option<FaultRecord>, Failure> {
        if from == to {
            return Ok(None);
        }
        let turn = self.driving.machine.turn(from, to, (GENTLE_RAD_S, GENTLE_RAD_S2));
        self.begin()?;
        self.rig.ask(Request::Jog(Job { segments: vec![turn], ..Job::default() }))?;
        let most = 2 * u32::from(turn.ticks) + 5000;
        for _ in 0..most {
            let now = self.tick()?;
            if now.latched.is_some() {
                return Ok(now.latched);
            }
            if now.phase == Phase::Done {
                return self.fault_at_rest();
            }
        }
        let message = "the head does not come where it is sent: is something in its way?";
        Err(Failure::failed("unfinished", message))
    }

    /// Rests; the fault that shows meanwhile: what is in a joint's way just before its end shows when it pushes there.
    fn fault_at_rest(&mut self) -> Result<Option<FaultRecord>, Failure> {
        for _ in 0..REST_TICKS {
            let now = self.tick()?;
            if now.latched.is_some() {
                return Ok(now.latched);
            }
        }
        Ok(None)
    }

    /// Forgets what was to be done, and goes to where both encoders read zero; what it is told if it does not come there.
    pub(super) fn zero(&mut self, otherwise: &str) -> Result<(), Failure> {
        self.rig.ask(Request::Park)?;
        for _ in 0..HOMEWARD_TICKS {
            self.step()?;
            if self.rig.session().state() != State::Parking {
                return self.rest(REST_TICKS).map(|_| ());
            }
        }
        Err(Failure::failed("unfinished", otherwise))
    }

    /// Lets ticks pass.
    pub(super) fn rest(&mut self, ticks: u32) -> Result<Telemetry, Failure> {
        for _ in 1..ticks {
            self.step()?;
        }
        self.step()
    }

    pub(super) fn step(&mut self) -> Result<Telemetry, Failure> {
        let now = self.tick()?;
        now.latched.map_or(Ok(now), |record| Err(Failure::fault(record)))
    }

    /// The same, whatever is wrong with the rig.
    pub(super) fn tick(&mut self) -> Result<Telemetry, Failure> {
        self.task.check()?;
        let now = self.rig.step()?.telemetry;
        self.history.push(&now);
        Ok(now)
    }
}

/// Whether a joint that comes up against something may have this fault.
#[must_use]
pub const fn may_be_a_stop(fault: Fault) -> bool {
    matches!(
        fault,
        Fault::EncoderJumped
            | Fault::EncoderDead
            | Fault::EncoderSlipping
            | Fault::EncoderNoisy
            | Fault::EstimateDiverged
            | Fault::HoldTimedOut
            | Fault::AmplifierSaturated
            | Fault::LimitReached
    )
}
