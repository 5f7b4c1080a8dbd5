//! What becomes of a run when something is suddenly off: it is dark, somebody looks, and the head is found again.

use tracelight_aim::{Alignment, HeadGeometry, HeadPose, TrimBelief};
use tracelight_eye::figures::RecoveryFigures;
use tracelight_eye::follow::{Blind, Followed, Follower, Suspicion};
use tracelight_eye::head::{DotsRequest, find_head};
use tracelight_eye::homing::home_again;
use tracelight_eye::power::lost_power;
use tracelight_eye::wall::{MOVED_PX, SeenWall, moved_px, see_wall, well_exposed};
use tracelight_eye::{Driven as _, Eye, Looks, PATIENCE_TICKS, Shot, refused};
use tracelight_pipeline::schedule_whole;
use tracelight_rig::{PanTilt, TICK_F64_S};
use tracelight_session::{Request, State, When, seconds};
use tracelight_stroke::{Drawing, Stroke};
use tracelight_task::{Failure, Task};
use tracelight_trajectory::Plan;

use crate::aside::Aside;
use crate::watched::{MOST_RECOVERIES, REST_TICKS, Watched, Why};

/// Most ticks that a head needs to go back to zero.
const HOME_TICKS: u32 = 8000;
/// A head that seems to have moved by less, mm, stands where it stood.
const STOOD_MM: f64 = 0.7;
/// Most dots by which jolts are looked after.
const MOST_CHECKS: usize = 50;
/// How long a dot is lit, ticks: as long as an image takes, and one after the other comes besides.
const DOT_TICKS: u16 = 60;
/// Share of the time that light may stand in one place which a dot takes at most: the stroke was there before.
const DOT_SHARE: f64 = 0.8;

impl Watched<'_> {
    /// Looks into what is off. Why the head must be found again; nothing if the job goes on.
    pub(crate) fn look_after(&mut self, suspicion: Suspicion) -> Result<Option<Why>, Failure> {
        let Some(suspicion) = self.dotted(suspicion)? else { return Ok(None) };
        let words = self.look_into(suspicion)?;
        Ok(words.map(|words| Why { words, seen_off: matches!(suspicion, Suspicion::Off(_)) }))
    }

    /// Pauses what is drawn, dark at once, and lets the head come to rest.
    fn pause(&mut self) {
        if self.session.state().is_on() {
            let _ = self.session.request(Request::Pause(When::AtOnce));
        }
        self.rest(REST_TICKS);
    }

    /// What a jolt came to: the head is darkened, and one dot tells where it points. Nothing if that is where it should be, or nobody sees.
    fn dotted(&mut self, suspicion: Suspicion) -> Result<Option<Suspicion>, Failure> {
        let Suspicion::Jolt(_) = suspicion else { return Ok(Some(suspicion)) };
        let is_lit = self.joined.points.get(self.plan_tick as usize).is_some_and(|point| point.lit);
        let is_blind = self.follower.blind().is_some();
        // somebody who leans on it all day is the interlock's to judge
        if is_blind || !is_lit || self.job.dry || self.figures.checks >= MOST_CHECKS {
            return Ok(None);
        }
        self.pause();
        let before = self.follower.marks.len();
        let images_s = 2.0 * self.follower.period_s() + f64::from(DOT_TICKS) * TICK_F64_S;
        let most_s = DOT_SHARE * self.driving.rig.light.standing_s;
        let dot_ticks = (images_s.min(most_s) / TICK_F64_S).round() as u16;
        self.looking.stop.check()?;
        // after a stop it may be asked for no dot: then the wall is looked at
        if self.session.request(Request::Mark(dot_ticks)).is_err() {
            return Ok(Some(suspicion));
        }
        let mut off = None;
        self.dots = true;
        for _ in 0..u32::from(dot_ticks) + REST_TICKS {
            off = off.or(self.step().1);
            if self.is_over() {
                let _ = self.session.request(Request::Stop);
                break;
            }
        }
        self.dots = false;
        self.figures.checks += 1;
        // a dot's image is of no stroke
        let seen = self.follower.marks.split_off(before.min(self.follower.marks.len()));
        self.looking.stop.check()?;
        Ok(off.or(seen.is_empty().then_some(suspicion)))
    }

    /// Darkens, and looks what became of the camera. Why the head must be found again, if the camera stands where it stood.
    fn look_into(&mut self, suspicion: Suspicion) -> Result<Option<String>, Failure> {
        let began_s = self.now_s();
        let Some(wall) = self.wall_now(suspicion)? else { return Ok(None) };
        if self.figures.recoveries.len() >= MOST_RECOVERIES {
            let times = MOST_RECOVERIES + 1;
            let message = format!(
                "{}, and that for the {times}th time: is something loose?",
                self.suspected(suspicion)
            );
            return Err(dark(&message));
        }
        let stood = self.wall.stood.as_ref().map(|stood| stood.camera.camera);
        let moved = match stood.and_then(|stood| moved_px(&stood, &wall.camera.camera)) {
            Some(px) if px <= MOVED_PX => return Ok(Some(self.suspected(suspicion))),
            Some(px) => format!("moved {px:.1} px"),
            None => "looks elsewhere".to_owned(),
        };
        self.figures.lost_images += self.follower.watch.lost;
        self.follower.look_from(wall.camera.camera);
        self.wall = wall.known(&self.job.seen.today);
        // an image without the spot, as it sees now
        self.rest(REST_TICKS);
        self.recovered(began_s, format!("the camera {moved}; it was found anew"), 0);
        Ok(None)
    }

    /// The wall as the camera sees it now, in the dark; nothing if it is blind, and the job goes on without it.
    fn wall_now(&mut self, suspicion: Suspicion) -> Result<Option<SeenWall>, Failure> {
        self.pause();
        let stop = self.looking.stop.clone();
        let wall = well_exposed(self, &stop).and_then(|pixels| see_wall(pixels, Some(&self.wall)));
        stop.check()?;
        if self.is_over() || self.follower.blind() == Some(Blind::Stamps) {
            return Ok(None);
        }
        let had_markers = self.job.seen.figures.markers > 0;
        let why = match wall {
            Ok(wall) if wall.rms_px.is_some() => return Ok(Some(wall)),
            Ok(_) if !had_markers => {
                "whether camera or head moved nobody can tell without markers in sight: hang pages where the camera sees them \
                 (tracelight calibrate sheet), or keep both still"
                    .to_owned()
            }
            Ok(_) => "the camera sees no markers any more".to_owned(),
            Err(why) => why.message,
        };
        match suspicion {
            // what it sees not may be its own fault
            Suspicion::Lost(_) | Suspicion::Jolt(_) if had_markers => {
                self.follower.distrust(Blind::Covered);
                self.tell_blindness();
                Ok(None)
            }
            _ => Err(dark(&format!("{}; {why}", self.suspected(suspicion)))),
        }
    }

    fn suspected(&self, suspicion: Suspicion) -> String {
        match suspicion {
            Suspicion::Off(m) => format!("the spot was {:.1} mm from where it should be", 1e3 * m),
            Suspicion::Lost(why) => format!("the spot was not seen: {why}"),
            Suspicion::Jolt(rad) => {
                format!("the head was jolted by {:.2} mrad, and its spot is not to be seen", 1e3 * rad)
            }
        }
    }

    /// Time since power-up, s.
    pub(crate) fn now_s(&self) -> f64 {
        seconds(self.now)
    }

    fn recovered(&mut self, t_s: f64, what: String, dots: usize) {
        let lasted_s = self.now_s() - t_s;
        self.remark_of(t_s, &what);
        self.figures.recoveries.push(RecoveryFigures { t_s, what, dots, lasted_s });
    }

    /// Goes home in the dark, has the head draw a few dots, and plans what is left with the head as it is now.
    pub(crate) fn found_again(
        &mut self,
        Why { words: why, seen_off }: &Why,
        left: &Drawing,
    ) -> Result<Plan, Failure> {
        self.looking.stop.check()?;
        let began_s = self.now_s();
        self.rest(REST_TICKS);
        self.home()?;
        let (timing, exposure_s) = (self.follower.watch.timing, self.follower.watch.exposure_s);
        let camera = self.wall.stood.as_ref().map_or(self.job.seen.followed.camera, |s| s.camera.camera);
        let request = DotsRequest::again(&self.driving, timing, exposure_s);
        let driving = self.driving.clone();
        let stop = self.looking.stop.clone();
        let task = Task { stop: &stop, ..self.task };
        let because = |e: Failure| match stop.is_wanted() {
            true => e,
            false => Failure { message: format!("{why}; {}", e.message), ..e },
        };
        let mut turned_rad = PanTilt::default();
        if !self.session.told().homed {
            let homed = home_again(&mut Aside(self), &camera, &driving, (timing, exposure_s), task);
            let count_rad = self.driving.rig.model.encoder.count_rad();
            turned_rad = homed.map_err(because)?.counts.map(|count| f64::from(count) * count_rad);
        }
        let found = find_head(&mut Aside(self), &camera, &driving, &request, task).map_err(because)?;
        let Alignment { geometry, pose, .. } = found.aligned.alignment;
        let moved = self.moved_mm(left, (&geometry, &pose), turned_rad);
        self.driving.believe(geometry, pose);
        let head = Alignment { late_s: 0.0, readout_s: 0.0, ..found.aligned.alignment };
        let followed = Followed {
            camera,
            head,
            timing: found.timing,
            exposure_s: found.exposure_s,
            belief: TrimBelief::found(found.aligned.rms_m),
            ..self.job.seen.followed.clone()
        };
        let marks = std::mem::take(&mut self.follower.marks);
        let painted = self.follower.watch.painted.take();
        self.figures.lost_images += self.follower.watch.lost;
        self.follower = Follower::new(&followed, painted);
        self.follower.marks = marks;
        self.home()?;
        if moved < STOOD_MM && *seen_off {
            self.follower.distrust(Blind::Untimely);
        }
        let what = format!(
            "{why}: the head was found anew by {} dots, its spot had moved by {moved:.1} mm",
            found.dots
        );
        self.looking.stop.check()?;
        self.recovered(began_s, what, found.dots);
        // whole strokes: what is told of them goes by their numbers
        schedule_whole(left.clone(), &self.driving).map(|schedule| schedule.plan)
    }

    /// By how much the spot had moved on what is left, in the mean, mm: of a head that is so and stands so, and whose joints were by so much further than
    /// their counts said, rad.
    fn moved_mm(
        &self,
        left: &Drawing,
        (geometry, pose): (&HeadGeometry, &HeadPose),
        turned_rad: PanTilt<f64>,
    ) -> f64 {
        let own = &self.driving;
        let off = |stroke: &Stroke| {
            let at = stroke.path.start();
            let angle = own.machine.geometry.angles(&own.pose, at).ok()?;
            let angle = PanTilt::new(angle.pan + turned_rad.pan, angle.tilt + turned_rad.tilt);
            geometry.spot(pose, angle).map(|now| now.distance(at))
        };
        let all: Vec<f64> = left.strokes.iter().filter_map(off).collect();
        1e3 * all.iter().sum::<f64>() / all.len().max(1) as f64
    }

    /// Forgets the job and goes back to zero in the dark.
    fn home(&mut self) -> Result<(), Failure> {
        if self.session.state() == State::Fault {
            self.session.request(Request::Clear).map_err(refused)?;
            self.step();
        }
        if self.session.state() == State::Armed {
            self.session.request(Request::Disarm).map_err(refused)?;
        }
        self.trimmer = None;
        self.session.request(Request::Park).map_err(refused)?;
        for _ in 0..HOME_TICKS {
            let (tick, _) = self.step();
            if self.unpowered {
                return Err(lost_power());
            }
            if let Some(record) = tick.telemetry.latched {
                return Err(Failure::fault(record));
            }
            if self.session.state() != State::Parking {
                return Aside(self).settle();
            }
            self.looking.stop.check()?;
        }
        let message = format!(
            "the head did not come to zero in {:.0} s: is something in its way?",
            f64::from(HOME_TICKS) * TICK_F64_S
        );
        Err(Failure::failed("unfinished", message))
    }
}

impl Looks for Watched<'_> {
    fn take(&mut self, exposure_s: f64) -> Result<Shot, Failure> {
        self.follower.want(exposure_s.min(self.session.longest_s()));
        self.session.expose(exposure_s);
        for _ in 0..PATIENCE_TICKS {
            self.step();
            if self.unpowered {
                return Err(lost_power());
            }
            if let Some(shot) = self.follower.taken() {
                return Ok(shot);
            }
            self.looking.stop.check()?;
        }
        self.follower.want_no_more();
        Err(Failure::failed("no-image", "the camera sends no image any more: is it still plugged in?"))
    }

    fn longest(&self) -> Option<f64> {
        Some(self.session.longest_s())
    }
}

/// What can not be mended.
fn dark(why: &str) -> Failure {
    Failure::failed("spot-off", format!("{why}; the laser is dark"))
}
