use std::collections::VecDeque;
use std::sync::Arc;

use tracelight_aim::Camera;
use tracelight_plant::{CameraConfig, Exposed, Image, Part, SimulatedCamera, SpotSample};
use tracelight_rig::{Command, Rig, TICK_F64_S, Telemetry};
use tracelight_stroke::Point;

use crate::run::{Simulated, SimulatedRig, Tick};
use crate::trouble::EyeTrouble;

/// A simulated rig in front of a wall, and a simulated camera that looks at it: one clock, that of the rig's ticks.
///
/// The camera takes one image after the other, and each is there only some time after it was taken.
#[derive(Clone, Debug)]
pub struct Room {
    rig: SimulatedRig,
    eye: Arc<SimulatedCamera>,
    exposure_s: f64,
    period_s: f64,
    /// Where the beam met the wall since the image that is being taken was begun.
    trail: VecDeque<SpotSample>,
    /// When that was, s, and its number.
    begun_s: f64,
    number: u64,
    /// Images on their way, and when they are there, s.
    sent: VecDeque<(f64, Taken)>,
    /// Ticks since power-up, which do not wrap.
    ticks: u64,
    now_s: f64,
    trouble: Option<EyeTrouble>,
    /// The last image that was taken before the camera froze.
    last: Option<Taken>,
    dice: oorandom::Rand64,
}

/// An image as a simulated camera sends it. What is on it is computed when somebody looks.
#[derive(Clone, Debug)]
pub struct Taken {
    eye: Arc<SimulatedCamera>,
    exposed: Exposed,
    /// When its first row began to be exposed, as its stamp says, s.
    pub stamp_s: f64,
    /// Commanded exposure of each row, s.
    pub exposure_s: f64,
}

impl Taken {
    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        self.eye.camera().lens.size_px
    }

    /// Whether it shows to the bit what another does.
    pub fn shows_same(&self, other: &Self) -> bool {
        self.exposed == other.exposed
    }

    /// All of it.
    pub fn image(&self) -> Image {
        self.part(&Part::whole(self.size()))
    }

    /// A part of it, pixel for pixel as in the whole.
    pub fn part(&self, part: &Part) -> Image {
        self.eye.develop(&self.exposed, part)
    }
}

impl Room {
    /// Makes a room; `seed` determines the delay of each image.
    pub fn new(rig: SimulatedRig, eye: SimulatedCamera, seed: u64) -> Self {
        let period_s = eye.config().period_s;
        Self {
            rig,
            exposure_s: period_s,
            period_s,
            eye: Arc::new(eye),
            trail: VecDeque::new(),
            begun_s: 0.0,
            number: 0,
            sent: VecDeque::new(),
            ticks: 0,
            now_s: 0.0,
            trouble: None,
            last: None,
            dice: oorandom::Rand64::new(u128::from(seed)),
        }
    }

    /// Takes the oldest image that has arrived and was not taken yet.
    pub fn taken(&mut self) -> Option<Taken> {
        let is_there = self.sent.front().is_some_and(|(there_s, _)| *there_s <= self.now_s);
        if is_there { self.sent.pop_front().map(|(_, image)| image) } else { None }
    }

    /// How long each row is exposed from the next image on, s; no longer than from one image to the next.
    pub fn expose(&mut self, exposure_s: f64) {
        self.exposure_s = exposure_s.clamp(0.0, self.eye.config().period_s);
    }

    /// What its camera is made of.
    pub fn eye_config(&self) -> &CameraConfig {
        self.eye.config()
    }

    /// The rig by itself.
    pub const fn rig(&mut self) -> &mut SimulatedRig {
        &mut self.rig
    }

    /// Something goes wrong with the camera from now on.
    pub fn suffer(&mut self, trouble: EyeTrouble) {
        match trouble {
            EyeTrouble::Bump(px) => {
                let camera = self.eye.camera();
                let turned = [0.0, px / camera.lens.focal_px[0], 0.0];
                let camera = Camera { pose: camera.pose.moved(turned, [0.0; 3]), ..*camera };
                Arc::make_mut(&mut self.eye).stand(&camera);
            }
            EyeTrouble::Slow(period_s) => self.period_s = period_s,
            other => self.trouble = Some(other),
        }
    }

    /// Takes the image that is due, if one is.
    fn take(&mut self) {
        let (exposure_s, begun_s) = (self.exposure_s, self.begun_s);
        if self.now_s < begun_s + exposure_s + self.eye.config().sensor.readout_s {
            return;
        }
        let spots = self.trail.make_contiguous().to_vec();
        let exposed = Exposed { number: self.number, start_s: begun_s, exposure_s, spots };
        let taken = Taken { eye: Arc::clone(&self.eye), exposed, stamp_s: begun_s, exposure_s };
        let due_s = begun_s + self.eye.delay_s(exposure_s, self.dice.rand_float());
        // none overtakes another
        let there_s = self.sent.back().map_or(due_s, |(before_s, _)| due_s.max(*before_s));
        if let Some(taken) = self.spoiled(taken) {
            self.sent.push_back((there_s, taken));
        }
        self.number += 1;
        self.begun_s += self.period_s;
        // the sample that holds when the next image begins is one of those before
        while self.trail.get(1).is_some_and(|sample| sample.time_s <= self.begun_s) {
            self.trail.pop_front();
        }
    }

    /// An image as it leaves a camera with which something may be wrong.
    fn spoiled(&mut self, mut taken: Taken) -> Option<Taken> {
        match self.trouble {
            Some(EyeTrouble::Unplugged) => return None,
            Some(EyeTrouble::Frozen) => {
                let Taken { stamp_s, exposure_s, .. } = taken;
                return self.last.clone().map(|last| Taken { stamp_s, exposure_s, ..last });
            }
            Some(EyeTrouble::Black) => {
                taken.exposed = Exposed { exposure_s: 0.0, spots: Vec::new(), ..taken.exposed };
            }
            Some(EyeTrouble::Stamps(off_s)) => taken.stamp_s += off_s * (2.0 * self.dice.rand_float() - 1.0),
            Some(EyeTrouble::Bump(_) | EyeTrouble::Slow(_)) | None => {}
        }
        self.last = Some(taken.clone());
        Some(taken)
    }
}

impl Simulated for Room {
    fn step(&mut self) -> Tick {
        let tick = self.rig.step();
        let number = tick.telemetry.tick;
        let goes_on = number == (self.ticks as u32).wrapping_add(1);
        self.ticks = if goes_on { self.ticks + 1 } else { u64::from(number) };
        self.now_s = self.ticks as f64 * TICK_F64_S;
        let (at, light) = tick.spot.map_or((Point::ORIGIN, false), |at| (at, tick.light));
        self.trail.push_back(SpotSample { time_s: self.now_s, at, light });
        self.take();
        tick
    }

    fn told(&self) -> &Telemetry {
        self.rig.told()
    }

    fn patience_ticks(&self) -> usize {
        self.rig.patience_ticks()
    }
}

impl Rig for Room {
    fn send(&mut self, command: Command) -> Result<(), Command> {
        self.rig.send(command)
    }

    fn next(&mut self) -> Option<Telemetry> {
        Some(self.step().telemetry)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RigConfig;
    use tracelight_aim::{Camera, CameraPose, HeadPose, Lens};
    use tracelight_plant::Wall;

    fn room() -> Room {
        let pose = CameraPose::looking_at([0.1, 0.1, 1.0], [0.0; 3]).unwrap();
        let camera = Camera { lens: Lens::ideal(160, 120, 150.0), pose };
        let wall = Wall { plain: [0.3; 3], posters: vec![] };
        let eye = SimulatedCamera::new(&CameraConfig::webcam(), &camera, &wall, 1);
        Room::new(SimulatedRig::new(&RigConfig::report(), HeadPose::square_on(0.9144), 0), eye, 3)
    }

    #[test]
    fn images_come_thirty_a_second_in_their_order_and_late() {
        let mut room = room();
        room.expose(2e-3);
        let (mut numbers, mut late_s) = (Vec::new(), Vec::new());
        for k in 0..1000 {
            room.step();
            if let Some(taken) = room.taken() {
                numbers.push(taken.exposed.number);
                late_s.push(1e-3 * f64::from(k) - taken.stamp_s);
            }
        }
        assert!((26..=29).contains(&numbers.len()), "{}", numbers.len());
        assert!(numbers.windows(2).all(|pair| pair[1] == pair[0] + 1));
        // 2 ms of exposure, 25 of reading, 30 to 130 on the way
        assert!(late_s.iter().all(|late| (0.0565..0.1585).contains(late)), "{late_s:?}");
        let [least, most] = [f64::min, f64::max].map(|of| late_s.iter().copied().reduce(of).unwrap());
        assert!(most - least > 0.05, "as if always equally late");
    }

    #[test]
    fn a_head_that_stands_elsewhere_draws_elsewhere() {
        let straight = HeadPose::square_on(0.9144);
        let moved = HeadPose { right_m: 0.01, ..straight };
        let mut rig = SimulatedRig::new(&RigConfig::report(), straight, 0).standing(moved);
        let tick = rig.step();
        let (spot, asked) = (tick.spot.unwrap(), tick.asked.unwrap());
        // within a count of where it is believed to be, but for the centimetre
        assert!((spot - asked - tracelight_stroke::Vec2::new(0.01, 0.0)).hypot() < 2e-3, "{spot} {asked}");
    }

    #[test]
    fn what_goes_wrong_with_a_camera_is_seen_in_what_it_sends() {
        let sent = |trouble: EyeTrouble| {
            let mut room = room();
            room.expose(2e-3);
            let mut all = Vec::new();
            for k in 0..3000 {
                if k == 1000 {
                    room.suffer(trouble);
                }
                room.step();
                all.extend(room.taken().map(|taken| (1e-3 * f64::from(k), taken)));
            }
            all
        };
        let late = |all: &[(f64, Taken)]| all.iter().filter(|(at_s, _)| *at_s > 1.3).count();
        assert_eq!(late(&sent(EyeTrouble::Unplugged)), 0);
        assert!((8..=9).contains(&late(&sent(EyeTrouble::Slow(0.2)))));
        let frozen = sent(EyeTrouble::Frozen);
        let [.., (_, one), (_, other)] = frozen.as_slice() else { panic!("too few") };
        assert!(one.shows_same(other) && one.stamp_s < other.stamp_s);
        let mean = |taken: &Taken| {
            let image = taken.image();
            image.rgb.iter().map(|&v| f64::from(v)).sum::<f64>() / image.rgb.len() as f64
        };
        let black = sent(EyeTrouble::Black);
        let (first, last) = (mean(&black[0].1), mean(&black.last().unwrap().1));
        assert!(last < 0.2 * first, "{first} {last}");
        let wrong = |(_, taken): &&(f64, Taken)| (taken.stamp_s - taken.exposed.start_s).abs() > 0.01;
        assert!(sent(EyeTrouble::Stamps(0.1)).iter().filter(wrong).count() > 30);
        let bumped = sent(EyeTrouble::Bump(5.0));
        let middle = |taken: &Taken| taken.eye.camera().pixel(Point::ORIGIN).unwrap();
        let moved = middle(&bumped.last().unwrap().1) - middle(&bumped[0].1);
        assert!((moved.x - 5.0).abs() < 0.3 && moved.y.abs() < 0.3, "{moved:?}");
    }
}
