//! A head that was just powered up finds out where it points: it goes round and lights a dot here and there until the camera sees one.
//!
//! Encoders that count from where they were powered up know angles from there and no others. One dot in sight tells both joints' angles as well as it is known
//! how the head stands; dots all over the wall tell them to a fraction of a count.

use tracelight_aim::{Alignment, Camera, HeadGeometry, HeadPose};
use tracelight_lab::Quantiles;
use tracelight_rig::{Command, Darkness, Joint, PanTilt, Phase, Segment, TICK_F64_S, Telemetry};
use tracelight_sim::Simulated;
use tracelight_stroke::Point;
use tracelight_trajectory::JointMotion;
use tracelight_vision::{Grey, SpotLost, SpotWindow, find_spot};

use super::head::{DotsRequest, SPOT_EXPOSURE_S, find_head, see_dots};
use super::spots::{History, Light, Timing, WHOLE};
use super::{Eye, Looks};
use crate::cli::driving::Driving;
use crate::failure::Failure;
use crate::progress::Progress;
use crate::stop::Stop;

/// A head whose encoders were told where it stands.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Homed {
    /// Dots that were lit until one was seen.
    pub(crate) sought: usize,
    /// What its encoders read where they read 0 before.
    pub(crate) counts: PanTilt<i32>,
}

/// From one dot to the next, as a share of what the camera sees: one of them at least falls well within it.
const STRIDE: f64 = 0.6;
/// Fastest and most sudden motion of a joint of which nobody knows where it is, rad/s and rad/s².
const GENTLE_RAD_S: f64 = 1.5;
const GENTLE_RAD_S2: f64 = 4.0;
/// How far it may stray meanwhile, rad.
const STRAY_RAD: f32 = 0.05;
/// How long a dot is lit, ticks: a camera that sends ten images a second sees it whole.
const DOT_TICKS: u16 = 350;
/// How long its image is waited for, ticks.
const WAIT_TICKS: u32 = 600;
/// Images of a dot in which it is looked for.
const LIT_IMAGES: usize = 3;
/// How long a joint rests after a motion until a dot is lit, ticks.
const REST_TICKS: u32 = 150;
/// Longest that a head takes to go to zero, ticks.
const HOMEWARD_TICKS: u32 = 15_000;
/// How near to it is there, rad, and how slow at rest, rad/s.
const THERE_RAD: f32 = 3e-3;
const STILL_RAD_S: f32 = 0.01;
/// Fewest spots by which a known head is homed.
const FEWEST_SPOTS: usize = 12;
/// Half of its dots tell of zeros that are no further apart, counts.
const MOST_APART_COUNTS: f64 = 0.75;
/// How far apart two images of one dot may show it, px.
const SAME_PX: f64 = 3.0;

/// Homes a head by dots, wherever it points. Zero is then where a known head, as is believed, has it; of another, where pan has the beam
/// straight at the wall, and tilt has it square to the pan axis. The rig rests unhomed in the dark; afterwards at zero, homed.
pub(crate) fn home_head<R: Simulated + Eye>(
    rig: &mut R,
    camera: &Camera,
    driving: &Driving,
    is_known: bool,
    (progress, stop): (&Progress, &Stop),
) -> Result<Homed, Failure> {
    let history = History::new(&driving.rig.model.relay);
    let mut homing = Homing { rig, camera, driving, stop, history, counts: PanTilt::default() };
    progress.stage("homing", 1);
    let homed = homing.home(is_known, (progress, stop));
    // dark whatever became of it; and a guess is not to be drawn by
    let _ = homing.rig.send(Command::Disarm);
    if homed.is_err() {
        let _ = homing.rig.send(Command::Unhome);
    }
    for _ in 0..REST_TICKS {
        let _ = homing.rig.send(Command::KeepAlive);
        homing.rig.step();
    }
    homed
}

/// By which angles a head is turned from where it should be to have zero, rad: pan from where its beam goes straight at the wall, tilt from where it is square to the pan axis.
pub(crate) fn turned_rad(geometry: &HeadGeometry, pose: &HeadPose) -> Option<PanTilt<f64>> {
    let beam = HeadGeometry { laser_offset_m: [0.0; 3], ..anywhere(geometry) };
    let straight = beam.angles(pose, Point::new(pose.right_m, pose.up_m)).ok()?;
    Some(PanTilt::new(-straight.pan, geometry.beam_off_rad[1]))
}

/// By how much a known head's joints are truly further than its encoders say, rad: what most dots say.
fn off_rad<R: Simulated + Eye>(
    rig: &mut R,
    camera: &Camera,
    driving: &Driving,
    watched: (&Progress, &Stop),
) -> Result<PanTilt<f64>, Failure> {
    let geometry = anywhere(&driving.machine.geometry);
    let spots = see_dots(rig, camera, driving, &DotsRequest::few(driving), watched, &mut |_| {})?.spots();
    let off: Vec<PanTilt<f64>> = spots
        .iter()
        .filter_map(|spot| {
            let truly = geometry.angles(&driving.pose, spot.at).ok()?;
            Some(PanTilt::from_fn(|j| truly[j] - spot.angle_rad[j]))
        })
        .collect();
    if off.len() < FEWEST_SPOTS {
        let message = format!(
            "of the dots only {} were seen: is the camera's view of the wall free, and the laser on?",
            off.len()
        );
        return Err(Failure::failed("head-not-found", message));
    }
    let middle = PanTilt::from_fn(|j| Quantiles::of(off.iter().map(|off| off[j])).median);
    // of a head that stands as is believed all dots say the same
    let apart_rad =
        PanTilt::from_fn(|j| Quantiles::of(off.iter().map(|off| (off[j] - middle[j]).abs())).median);
    let count_rad = driving.rig.model.encoder.count_rad();
    if apart_rad.pan.max(apart_rad.tilt) > MOST_APART_COUNTS * count_rad {
        let message = "the head stands elsewhere than where it was found: its dots tell of different zeros; find it anew (calibrate head --home without --head)";
        return Err(Failure::failed("head-not-found", message));
    }
    Ok(middle)
}

/// The same head with joints that go anywhere in front of it: where one stands that was left, its range does not tell.
fn anywhere(geometry: &HeadGeometry) -> HeadGeometry {
    const NEARLY_RIGHT_RAD: f64 = 1.4;
    let all = (-NEARLY_RIGHT_RAD, NEARLY_RIGHT_RAD);
    HeadGeometry { range_rad: PanTilt::new(all, all), ..*geometry }
}

/// A rig that is being homed, and what is known meanwhile.
struct Homing<'a, R> {
    rig: &'a mut R,
    camera: &'a Camera,
    driving: &'a Driving,
    stop: &'a Stop,
    history: History,
    /// What was added to what its encoders read, until now.
    counts: PanTilt<i32>,
}

impl<R: Simulated + Eye> Homing<'_, R> {
    fn home(&mut self, is_known: bool, watched: (&Progress, &Stop)) -> Result<Homed, Failure> {
        let (sought, true_rad) = self.seek()?;
        self.tell(true_rad)?;
        let off_rad = if is_known {
            off_rad(self.rig, self.camera, self.driving, watched)?
        } else {
            let all = DotsRequest::first(self.driving);
            let found = find_head(self.rig, self.camera, self.driving, &all, watched, &mut |_| {})?;
            let Alignment { geometry, pose, .. } = found.aligned.alignment;
            turned_rad(&geometry, &pose).ok_or_else(|| {
                Failure::failed("head-not-found", "the head as its dots tell does not face the wall: turn it by hand so that it does, and home it again")
            })?
        };
        let now = self.rest(1)?;
        self.tell(PanTilt::from_fn(|j| self.count_rad() * f64::from(now.measured[j].count) + off_rad[j]))?;
        Ok(Homed { sought, counts: self.counts })
    }

    fn count_rad(&self) -> f64 {
        self.driving.rig.model.encoder.count_rad()
    }

    /// Lights dots further and further off until one is seen. How many there were, and the joints' true angles at the last, rad.
    fn seek(&mut self) -> Result<(usize, PanTilt<f64>), Failure> {
        // before anything is remembered: while an image is waited for, nobody watches the ticks
        let change = self.change()?;
        let range = self.driving.machine.geometry.range_rad;
        let mut at = PanTilt::new(0.0, 0.0);
        let places = places(self.stride_rad(), range);
        let count = places.len();
        for (number, place) in (1..).zip(places) {
            self.go(at, place)?;
            at = place;
            if let Some(spot) = self.dot(change)? {
                let geometry = anywhere(&self.driving.machine.geometry);
                let on_wall = self.camera.target(spot);
                let truly = on_wall.and_then(|on_wall| geometry.angles(&self.driving.pose, on_wall).ok());
                if let Some(truly) = truly {
                    return Ok((number, truly));
                }
            }
        }
        let message = format!(
            "the camera saw none of {count} dots: is the laser on, and is the wall that the camera sees within the head's reach? Turn the head by hand so that it faces the wall, and home it again"
        );
        Err(Failure::failed("head-not-found", message))
    }

    /// By how much the wall seems to change by itself, from one image to the next.
    fn change(&mut self) -> Result<f64, Failure> {
        const IMAGES: usize = 4;
        let dark = Dark { image: self.rig.take(SPOT_EXPOSURE_S)?.red()?, change: 0.0 };
        let mut change = 0.0_f64;
        for _ in 1..IMAGES {
            self.stop.check()?;
            change = change.max(dark.brightest(&self.rig.take(SPOT_EXPOSURE_S)?.red()?));
        }
        Ok(change)
    }

    /// From one place to the next, so that one of them falls into what the camera sees, rad.
    fn stride_rad(&self) -> PanTilt<f64> {
        let [width, height] = self.camera.lens.size_px.map(|n| n as f64);
        let geometry = anywhere(&self.driving.machine.geometry);
        let angles = |across: f64, down: f64| {
            let at = self.camera.target(Point::new(width * across, height * down))?;
            geometry.angles(&self.driving.pose, at).ok()
        };
        let between = |from: Option<PanTilt<f64>>, to: Option<PanTilt<f64>>, j: Joint| match (from, to) {
            (Some(from), Some(to)) => Some((from[j] - to[j]).abs()),
            _ => None,
        };
        // a camera that sees that little would see nothing of a head anyway
        const LEAST_RAD: f64 = 0.05;
        let pan = between(angles(0.1, 0.5), angles(0.9, 0.5), Joint::Pan);
        let tilt = between(angles(0.5, 0.1), angles(0.5, 0.9), Joint::Tilt);
        PanTilt::new(pan, tilt).map(|seen| (STRIDE * seen.unwrap_or(0.3)).max(LEAST_RAD))
    }

    /// Moves in the dark from rest to rest, by its encoders.
    fn go(&mut self, from: PanTilt<f64>, to: PanTilt<f64>) -> Result<(), Failure> {
        let far = (to.pan - from.pan).abs().max((to.tilt - from.tilt).abs());
        if far > 0.0 {
            // a quintic from rest to rest is 1.875 times as fast as in the mean, and speeds up with 5.77 times way over time squared
            let time_s = (1.875 * far / GENTLE_RAD_S).max((5.774 * far / GENTLE_RAD_S2).sqrt());
            let ticks = (time_s / TICK_F64_S).ceil().clamp(50.0, 30_000.0);
            let coefficients = PanTilt::from_fn(|j| {
                JointMotion::at_rest(from[j])
                    .quintic_to(&JointMotion::at_rest(to[j]), ticks)
                    .map(|c| c as f32)
            });
            let tolerance_rad = PanTilt::new(STRAY_RAD, STRAY_RAD);
            let segment =
                Segment { start_tick: 0, ticks: ticks as u16, coefficients, tolerance_rad, gate: false };
            for command in [Command::Arm, Command::Append(segment), Command::Finish] {
                let _ = self.rig.send(command);
            }
            let most = 2 * segment.ticks + 5000;
            let done = self.until(u32::from(most), |now| now.phase == Phase::Done)?;
            let _ = self.rig.send(Command::Disarm);
            if done.is_none() {
                let message = "the head does not come where it is sent: is something in its way?";
                return Err(Failure::failed("unfinished", message));
            }
        }
        self.rest(REST_TICKS).map(|_| ())
    }

    /// Lights a dot where the head rests; where the camera sees it, px. What does not go out with it is none.
    fn dot(&mut self, change: f64) -> Result<Option<Point>, Failure> {
        let Some(image) = self.image(Light::Dark)? else {
            return Err(Failure::failed(
                "no-image",
                "the camera sends no images any more: is it plugged in?",
            ));
        };
        let dark = Dark { image, change };
        let _ = self.rig.send(Command::Point(DOT_TICKS));
        let mut seen: Vec<Point> = Vec::new();
        for _ in 0..LIT_IMAGES {
            let lit = self.image(Light::Lit)?;
            seen.extend(lit.and_then(|lit| dark.spot(&lit)));
        }
        let &[.., before, now] = seen.as_slice() else { return Ok(None) };
        let after = self.image(Light::Dark)?.and_then(|after| dark.spot(&after));
        let is_gone = after.is_none_or(|after| after.distance(now) > SAME_PX);
        Ok((is_gone && before.distance(now) < SAME_PX).then_some(now))
    }

    /// The next image that was taken all in light, or all in the dark; `None` if none comes.
    fn image(&mut self, wanted: Light) -> Result<Option<Grey>, Failure> {
        for _ in 0..WAIT_TICKS {
            self.step()?;
            while let Some(shot) = self.rig.shot() {
                if shot.is_exposed(SPOT_EXPOSURE_S)
                    && Timing::USUAL.light(&self.history, &shot, WHOLE) == wanted
                    && let Ok(image) = shot.red()
                {
                    return Ok(Some(image));
                }
            }
        }
        Ok(None)
    }

    /// Tells the rig at which angles its joints rest, rad, and lets them go to zero.
    fn tell(&mut self, true_rad: PanTilt<f64>) -> Result<(), Failure> {
        let now = self.rest(REST_TICKS)?;
        // within the count it reads the observer knows no better than that it is somewhere
        let by = PanTilt::from_fn(|j| {
            (true_rad[j] / self.count_rad() - f64::from(now.measured[j].count)).round() as i32
        });
        let counts = PanTilt::from_fn(|j| now.measured[j].count + by[j]);
        if self.rig.send(Command::Home(counts)).is_err() {
            let message = "the rig does not take where its joints are: they move, or they cannot be there; let it come to rest, and home it again";
            return Err(Failure::failed("unfinished", message));
        }
        self.counts = PanTilt::from_fn(|j| self.counts[j] + by[j]);
        let _ = self.rig.send(Command::Abandon);
        let is_there = |now: &Telemetry| {
            let near =
                |j: Joint| now.position_rad[j].abs() < THERE_RAD && now.velocity_rad_s[j].abs() < STILL_RAD_S;
            Joint::BOTH.into_iter().all(near)
        };
        if self.until(HOMEWARD_TICKS, is_there)?.is_none() {
            let message = "the head does not come to where it was told zero is: is something in its way?";
            return Err(Failure::failed("unfinished", message));
        }
        self.rest(REST_TICKS).map(|_| ())
    }

    /// Lets ticks pass until something holds; `None` if it never does.
    fn until(
        &mut self,
        ticks: u32,
        holds: impl Fn(&Telemetry) -> bool,
    ) -> Result<Option<Telemetry>, Failure> {
        for _ in 0..ticks {
            let now = self.step()?;
            if holds(&now) {
                return Ok(Some(now));
            }
        }
        Ok(None)
    }

    /// Lets ticks pass.
    fn rest(&mut self, ticks: u32) -> Result<Telemetry, Failure> {
        for _ in 1..ticks {
            self.step()?;
        }
        self.step()
    }

    fn step(&mut self) -> Result<Telemetry, Failure> {
        self.stop.check()?;
        let _ = self.rig.send(Command::KeepAlive);
        let now = self.rig.step().telemetry;
        self.history.push(&now);
        now.fault.map_or(Ok(now), |fault| Err(Failure::fault(fault)))
    }
}

/// The wall without light.
struct Dark {
    image: Grey,
    /// The most by which anything on it became brighter without light, as a share of full light.
    change: f64,
}

/// How many times brighter than what becomes brighter by itself the light of a dot is.
const PLAIN: f64 = 3.0;

impl Dark {
    /// The spot in a whole image.
    fn spot(&self, lit: &Grey) -> Option<Point> {
        let spot = find_spot(lit, &self.image, &self.window()).ok()?;
        (spot.brightness > PLAIN * self.change).then_some(spot.at)
    }

    /// By how much anything is brighter in another image of the same.
    fn brightest(&self, other: &Grey) -> f64 {
        match find_spot(other, &self.image, &self.window()) {
            Ok(spot) => spot.brightness,
            Err(SpotLost::Dim { change, .. }) => change / 100.0,
            Err(_) => 0.0,
        }
    }

    /// All of it.
    fn window(&self) -> SpotWindow {
        let (width, height) = (self.image.width(), self.image.height());
        let centre = Point::new(width as f64 / 2.0, height as f64 / 2.0);
        SpotWindow { centre, half_px: width.max(height) / 2 }
    }
}

/// Places of both joints further and further from where they are, in rings, as far from there as the joints' ranges go, rad.
fn places(stride_rad: PanTilt<f64>, range_rad: PanTilt<(f64, f64)>) -> Vec<PanTilt<f64>> {
    let reach = |j: Joint| (0.9 * range_rad[j].0, 0.9 * range_rad[j].1);
    let steps = |j: Joint| {
        let (lower, upper) = reach(j);
        (lower.abs().max(upper) / stride_rad[j]).floor() as i32
    };
    let rings = steps(Joint::Pan).max(steps(Joint::Tilt)).clamp(0, 50);
    let mut all = vec![PanTilt::new(0.0, 0.0)];
    for ring in 1..=rings {
        // round from below right, so that one place is next to the one before it
        let side = (-ring..ring).collect::<Vec<i32>>();
        let corners = side
            .iter()
            .map(|k| (ring, *k))
            .chain(side.iter().map(|k| (-k, ring)))
            .chain(side.iter().map(|k| (-ring, -k)))
            .chain(side.iter().map(|k| (*k, -ring)));
        all.extend(corners.map(|(pan, tilt)| {
            PanTilt::new(f64::from(pan) * stride_rad.pan, f64::from(tilt) * stride_rad.tilt)
        }));
    }
    let reached =
        |place: &PanTilt<f64>| Joint::BOTH.into_iter().all(|j| (reach(j).0..=reach(j).1).contains(&place[j]));
    all.retain(reached);
    all
}

/// Refuses a rig that does not know where its joints are.
pub(crate) fn check_homed(now: &Telemetry) -> Result<(), Failure> {
    if !now.darkness.contains(Darkness::Unhomed) {
        return Ok(());
    }
    let message = "the head was powered up and not homed since: nobody knows where its light would fall, and nothing was drawn; home it first (tracelight calibrate head --home --camera …)";
    Err(Failure::failed("unhomed", message))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_lie_in_rings_within_reach_and_none_is_far_from_one() {
        let range = PanTilt::new((-1.0, 1.0), (-0.5, 0.8));
        let stride = PanTilt::new(0.25, 0.2);
        let all = places(stride, range);
        let ring = |place: &PanTilt<f64>| (place.pan / 0.25).abs().max((place.tilt / 0.2).abs()).round();
        assert!(all.windows(2).all(|pair| ring(&pair[0]) <= ring(&pair[1])));
        assert_eq!(all[0], PanTilt::new(0.0, 0.0));
        // every place as far as half a stride beyond the outermost is within half a stride of one
        for pan in -35..=35 {
            for tilt in -20..=28 {
                let at = PanTilt::new(f64::from(pan) * 0.025, f64::from(tilt) * 0.025);
                let near = |place: &PanTilt<f64>| {
                    (place.pan - at.pan).abs() <= 0.1251 && (place.tilt - at.tilt).abs() <= 0.1001
                };
                assert!(all.iter().any(near), "{at:?}");
            }
        }
        for pair in all.windows(2).filter(|pair| ring(&pair[0]) == ring(&pair[1])).take(20) {
            assert!((pair[0].pan - pair[1].pan).hypot(pair[0].tilt - pair[1].tilt) < 0.8, "{pair:?}");
        }
    }
}
