//! A head that finds where its joints end, by coming up against their end stops gently, and is homed by them.

use tracelight_eye::homing::may_be_a_stop;
use tracelight_rig::{Fault, FaultRecord, Joint, PanTilt, Telemetry};
use tracelight_session::{Job, Request, State};
use tracelight_sim::observed_tick;
use tracelight_task::Failure;

use super::{GENTLE_RAD_S, GENTLE_RAD_S2, Mover, PARK_TICKS, Place, REST_TICKS};

/// How fast a joint looks for its stop, rad/s, and how fast it then goes against it to see where exactly that is: the slower, the less a belt gives.
const SEARCH_RAD_S: f64 = 0.5;
const TOUCH_RAD_S: f64 = 0.05;
/// How far it goes beyond as far as its range is wide while it looks, rad: the controller lets it go a little further.
const BEYOND_RAD: f64 = 0.19;
/// From how far before a stop it is touched, rad.
const BEFORE_RAD: f64 = 0.06;
/// A joint is held up that stays so far behind its plan, rad, at less than that speed, rad/s, for so many ticks: few, so that it does not push hard.
const HELD_UP_RAD: f32 = 6e-3;
const HELD_UP_RAD_S: f32 = 0.01;
const HELD_UP_TICKS: u32 = 20;
/// A stop that is touched twice is at the same place, counts.
const AGREE_COUNTS: i32 = 4;
/// How far a joint may turn more or less between its stops than it is said to, rad: a way that something else ends is another.
const SAME_WAY_RAD: f64 = 8.7e-3;
/// Faults in a row that a joint may have while it comes back from a stop.
const MOST_FAULTS: u32 = 3;
/// How long a board may take to take note of it, ticks.
const CLEARED_TICKS: u32 = 500;
/// A joint that stays within so many counts for so long, ticks, is where it is to be.
const SWAY_COUNTS: i32 = 2;
const CALM_TICKS: u32 = 200;
/// Ticks in which a joint comes to rest that came up against something hard.
const SWING_TICKS: u32 = 300;

impl Mover<'_> {
    /// Finds where each joint comes up against its end stops, lower and upper, by the zero that its encoders have now, rad; in the dark, one joint at a time. A head that is
    /// homed stays so.
    ///
    /// # Errors
    /// As of [`new`](Mover::new); `no-stop`: a joint turns on and on; `stops`: it does not stop at the same place twice, or within the range it is said to have. A homed head is not homed any more after the others.
    pub fn find_stops(&mut self) -> Result<PanTilt<(f64, f64)>, Failure> {
        if !self.place().homed {
            let message = "the head is not homed, and its stops would be told from wherever it was powered up: home it first, such as by `tracelight home`";
            return Err(Failure::failed("unhomed", message));
        }
        self.check_encoders()?;
        self.let_go_after(|mover| {
            mover.unhome()?;
            // whoever measures what is kept looks twice
            let found = mover.touch_stops(2)?;
            if let Some(fault) = mover.lost.take() {
                let message = format!(
                    "an encoder may have lost counts ({}) when a joint came up against its stop: home the head again, and try again",
                    fault.code()
                );
                return Err(Failure::failed("stops", message));
            }
            mover.check_beyond_range(found)?;
            mover.home_calmly(|told| told.measured.map(|measured| measured.count))?;
            Ok(found)
        })
    }

    /// Refuses a head that does not notice what holds its joints up.
    fn check_encoders(&self) -> Result<(), Failure> {
        if self.driving.rig.drive.kind.is_open_loop() {
            let message =
                "a head without encoders does not notice its stops: it is homed by a camera or by hand";
            return Err(Failure::failed("stops", message));
        }
        Ok(())
    }

    /// Does something that may leave a joint at its stop; where it fails or is interrupted, the joint is let go.
    fn let_go_after<T>(&mut self, what: impl FnOnce(&mut Self) -> Result<T, Failure>) -> Result<T, Failure> {
        self.lost = None;
        let done = what(self);
        if done.is_err() {
            // refused is what makes no sense any more
            let _ = self.ask(Request::Stop);
            let _ = self.ask(Request::Park);
            let _ = observed_tick(&mut self.wall);
        }
        done
    }

    fn unhome(&mut self) -> Result<(), Failure> {
        if self.place().homed {
            self.ask(Request::Unhome)?;
            self.wait(REST_TICKS, |wall| wall.state() == State::Unhomed)?;
        }
        Ok(())
    }

    /// Refuses stops within what the joints are said to turn.
    fn check_beyond_range(&self, found_rad: PanTilt<(f64, f64)>) -> Result<(), Failure> {
        for joint in Joint::BOTH {
            let ((lower, upper), said) = (found_rad[joint], self.driving.machine.geometry.range_rad[joint]);
            if lower >= said.0 || upper <= said.1 {
                let message = format!(
                    "{joint} ends at {:.2} and {:.2} degrees, within its range of {:.1} to {:.1}: is the head's zero where it is straight ahead, and was nothing in its way? \
                     Otherwise set model.{joint}.range_min and range_max to what it turns",
                    lower.to_degrees(),
                    upper.to_degrees(),
                    said.0.to_degrees(),
                    said.1.to_degrees()
                );
                return Err(Failure::failed("stops", message));
            }
        }
        Ok(())
    }

    /// Homes a head by its end stops, whose angles its rig tells. Afterwards it rests straight ahead.
    ///
    /// # Errors
    /// As of [`find_stops`](Self::find_stops); `stops`: its rig tells none, or a joint turns further between them than it should, or less far.
    pub fn home_by_stops(&mut self) -> Result<Place, Failure> {
        let Some(stops_rad) = self.driving.rig.known_stops_rad() else {
            let message = "the rig file tells no end stops: home the head otherwise, once, and have `tracelight home --find-stops` measure them for its [homing]";
            return Err(Failure::failed("stops", message));
        };
        self.check_encoders()?;
        self.let_go_after(|mover| mover.homed_by(stops_rad))
    }

    fn homed_by(&mut self, stops_rad: PanTilt<(f64, f64)>) -> Result<Place, Failure> {
        self.unhome()?;
        // that both are as far apart as they are said to be shows that they are they
        let found_rad = self.touch_stops(1)?;
        for joint in Joint::BOTH {
            let way = |(lower, upper): (f64, f64)| upper - lower;
            let (found, said) = (way(found_rad[joint]), way(stops_rad[joint]));
            if (found - said).abs() > SAME_WAY_RAD {
                let message = format!(
                    "{joint} turns {:.2} degrees between what stops it, and {:.2} by the rig file's [homing]: is something in its way, or are the stops others? \
                     `tracelight home --find-stops` measures them on a head that is homed",
                    found.to_degrees(),
                    said.to_degrees()
                );
                return Err(Failure::failed("stops", message));
            }
        }
        let count_rad = self.driving.rig.model.encoder.count_rad();
        let off = PanTilt::from_fn(|j| {
            let (found, said) = (found_rad[j], stops_rad[j]);
            // what gives way gives way at both
            let off_rad = 0.5 * ((said.0 + said.1) - (found.0 + found.1));
            (off_rad / count_rad).round() as i32
        });
        self.home_calmly(|told| PanTilt::from_fn(|j| told.measured[j].count + off[j]))?;
        self.park()
    }

    /// Where the joints end, lower and upper, rad, each touched so many times.
    fn touch_stops(&mut self, touches: usize) -> Result<PanTilt<(f64, f64)>, Failure> {
        self.back(Joint::Pan)?;
        let mut found = PanTilt::new((0.0, 0.0), (0.0, 0.0));
        for joint in Joint::BOTH {
            found[joint] = (self.stop_of(joint, -1.0, touches)?, self.stop_of(joint, 1.0, touches)?);
        }
        Ok(found)
    }

    /// Where a joint ends one way, rad by its encoders, touched so many times.
    fn stop_of(&mut self, joint: Joint, way: f64, touches: usize) -> Result<f64, Failure> {
        let (lower, upper) = self.driving.machine.geometry.range_rad[joint];
        let furthest_rad = upper - lower + BEYOND_RAD;
        let Some(first) = self.push(joint, (way, way * furthest_rad), SEARCH_RAD_S)? else {
            let message = format!(
                "{joint} was turned by {:.0} degrees and nothing stopped it: it has no end stop there, or one further out than model.{joint}.range_min and range_max say",
                furthest_rad.to_degrees()
            );
            return Err(Failure::failed("no-stop", message));
        };
        self.back(joint)?;
        let count_rad = self.driving.rig.model.encoder.count_rad();
        let degrees = |count: i32| (f64::from(count) * count_rad).to_degrees();
        let mut touched = vec![first; touches];
        for count in &mut touched {
            let near_rad = f64::from(first) * count_rad - way * BEFORE_RAD;
            let found = match self.push(joint, (way, near_rad), GENTLE_RAD_S)? {
                None => self.push(joint, (way, near_rad + 2.0 * way * BEFORE_RAD), TOUCH_RAD_S)?,
                early => early,
            };
            self.back(joint)?;
            *count = found.ok_or_else(|| {
                let message = format!(
                    "{joint} came up against something at {:.2} degrees, and went past it the next time: is something in its way?",
                    degrees(first)
                );
                Failure::failed("stops", message)
            })?;
        }
        let (least, most) =
            touched.iter().fold((i32::MAX, i32::MIN), |(least, most), at| (least.min(*at), most.max(*at)));
        if most - least > AGREE_COUNTS {
            let message = format!(
                "{joint} came up against something at {:.2} degrees, and at {:.2} another time: a stop must stand firm",
                degrees(least),
                degrees(most)
            );
            return Err(Failure::failed("stops", message));
        }
        Ok(0.5 * f64::from(least + most) * count_rad)
    }

    /// Turns a joint to an angle, rad; the furthest count that it came to if something held it up.
    fn push(
        &mut self,
        joint: Joint,
        (way, to_rad): (f64, f64),
        speed_rad_s: f64,
    ) -> Result<Option<i32>, Failure> {
        let from = self.place().angle_rad;
        let mut to = from;
        to[joint] = to_rad;
        if (to_rad - from[joint]) * way <= 0.0 {
            return Ok(None);
        }
        let turn = self.driving.machine.turn(from, to, (speed_rad_s, GENTLE_RAD_S2));
        self.ask(Request::Jog(Job { segments: vec![turn], ..Job::default() }))?;
        let mut held_up = 0;
        let mut furthest = self.last.telemetry.measured[joint].count;
        for _ in 0..2 * u32::from(turn.ticks) + REST_TICKS {
            self.observe()?;
            let told = &self.last.telemetry;
            furthest = further(furthest, told.measured[joint].count, way);
            if told.latched.is_some() {
                return self.struck(joint, way, furthest).map(Some);
            }
            held_up = if is_held_up(told, joint, way) { held_up + 1 } else { 0 };
            if held_up >= HELD_UP_TICKS {
                return Ok(Some(furthest));
            }
            if self.wall.state() != State::Jogging {
                self.calm()?;
                return Ok(None);
            }
        }
        Err(Failure::failed(
            "unfinished",
            format!("{joint} does not come where it is sent, and nothing holds it up"),
        ))
    }

    /// A joint struck something so hard that its controller took it for a fault: the furthest count that it came to. A fault of anything else is one.
    fn struck(&mut self, joint: Joint, way: f64, mut furthest: i32) -> Result<i32, Failure> {
        let may_be =
            |record: &FaultRecord| may_be_a_stop(record.fault) && record.joint.is_none_or(|of| of == joint);
        for _ in 0..SWING_TICKS {
            let Telemetry { latched, inputs, .. } = self.last.telemetry;
            if let Some(record) = latched {
                // one fault is told; whoever arms has an interlock that opened meanwhile told, and the laser's switches tried anew
                if !may_be(&record) || inputs.any_open() {
                    return Err(Failure::fault(record));
                }
                self.lost = self.lost.or_else(|| Some(record.fault).filter(|fault| may_lose(*fault)));
            }
            self.observe()?;
            furthest = further(furthest, self.last.telemetry.measured[joint].count, way);
        }
        // what the fault was is known, and what it means here
        self.ask(Request::Clear)?;
        for _ in 0..CLEARED_TICKS {
            self.observe()?;
            if self.last.telemetry.latched.is_none() {
                return Ok(furthest);
            }
        }
        self.step().map(|()| furthest)
    }

    /// Goes from what is in a joint's way to where the encoders read zero, and rests.
    fn back(&mut self, joint: Joint) -> Result<(), Failure> {
        if self.wall.state() == State::Jogging {
            self.ask(Request::Stop)?;
        }
        for _ in 0..MOST_FAULTS {
            self.ask(Request::Park)?;
            let mut left = PARK_TICKS;
            while left > 0 && self.last.telemetry.latched.is_none() {
                self.observe()?;
                left -= 1;
                if self.wall.state() != State::Parking && self.last.telemetry.latched.is_none() {
                    return self.calm();
                }
            }
            if self.last.telemetry.latched.is_none() {
                break;
            }
            // it pushed for a moment longer than its controller has patience
            self.struck(joint, 0.0, 0)?;
        }
        Err(Failure::failed(
            "unfinished",
            format!("{joint} does not come back from where something stopped it: is it free?"),
        ))
    }

    /// Waits until the joints stay within a count or two. Where a head is that is not homed nobody knows, nor how gravity pulls there: it may sway about its count.
    fn calm(&mut self) -> Result<(), Failure> {
        let mut about = self.last.telemetry.measured;
        self.stay(CALM_TICKS, |mover| {
            let now = mover.last.telemetry.measured;
            let stays = Joint::BOTH.into_iter().all(|j| (now[j].count - about[j].count).abs() <= SWAY_COUNTS);
            about = if stays { about } else { now };
            stays
        })
    }

    /// Homes it in a tick in which it rests.
    fn home_calmly(&mut self, counts: impl Fn(&Telemetry) -> PanTilt<i32>) -> Result<Place, Failure> {
        self.wait(REST_TICKS, |wall| wall.rests())?;
        let counts = counts(&self.last.telemetry);
        self.home_at(counts)
    }
}

/// The count that is further that way.
fn further(a: i32, b: i32, way: f64) -> i32 {
    if way > 0.0 { a.max(b) } else { a.min(b) }
}

/// Whether counts may have been lost with this fault; an encoder that stood while its motor pushed was held up.
const fn may_lose(fault: Fault) -> bool {
    matches!(
        fault,
        Fault::EncoderJumped | Fault::EncoderSlipping | Fault::EncoderNoisy | Fault::EstimateDiverged
    )
}

/// Whether a joint is behind its plan, and stands.
fn is_held_up(told: &Telemetry, joint: Joint, way: f64) -> bool {
    let behind_rad = (told.setpoint[joint].position_rad - told.position_rad[joint]) * way as f32;
    behind_rad > HELD_UP_RAD && told.velocity_rad_s[joint].abs() < HELD_UP_RAD_S
}
