use std::collections::VecDeque;

use tracelight_plant::{CameraConfig, Image, SimulatedCamera, SpotSample};
use tracelight_rig::{Command, Rig, TICK_F64_S, Telemetry};
use tracelight_stroke::Point;

use crate::run::{Simulated, SimulatedRig, Tick};

/// A simulated rig in front of a wall, and a simulated camera that looks at it: one clock, that of the rig's ticks.
///
/// The camera takes one image after the other, and each is there only some time after it was taken.
#[derive(Clone, Debug)]
pub struct Room {
    rig: SimulatedRig,
    eye: SimulatedCamera,
    exposure_s: f64,
    /// Where the beam met the wall since the image that is being taken was begun.
    trail: VecDeque<SpotSample>,
    /// When that was, s.
    begun_s: f64,
    /// Images on their way, and when they are there, s.
    sent: VecDeque<(f64, Image)>,
    now_s: f64,
    dice: oorandom::Rand64,
}

impl Room {
    /// `seed` draws how long images are on their way.
    pub fn new(rig: SimulatedRig, eye: SimulatedCamera, seed: u64) -> Self {
        Self {
            rig,
            exposure_s: eye.config().period_s,
            eye,
            trail: VecDeque::new(),
            begun_s: 0.0,
            sent: VecDeque::new(),
            now_s: 0.0,
            dice: oorandom::Rand64::new(u128::from(seed)),
        }
    }

    /// The oldest image that is there and was not asked for yet.
    pub fn image(&mut self) -> Option<Image> {
        let is_there = self.sent.front().is_some_and(|(there_s, _)| *there_s <= self.now_s);
        if is_there { self.sent.pop_front().map(|(_, image)| image) } else { None }
    }

    /// How long each row is exposed from the next image on, s; no longer than from one image to the next.
    pub fn expose(&mut self, exposure_s: f64) {
        self.exposure_s = exposure_s.clamp(0.0, self.eye.config().period_s);
    }

    /// What its camera is made of.
    pub const fn eye_config(&self) -> &CameraConfig {
        self.eye.config()
    }

    /// The rig by itself.
    pub const fn rig(&mut self) -> &mut SimulatedRig {
        &mut self.rig
    }

    /// The camera by itself.
    pub const fn eye(&mut self) -> &mut SimulatedCamera {
        &mut self.eye
    }

    /// Takes the image that is due, if one is.
    fn take(&mut self) {
        let (exposure_s, begun_s) = (self.exposure_s, self.begun_s);
        if self.now_s < begun_s + exposure_s + self.eye.config().sensor.readout_s {
            return;
        }
        let image = self.eye.expose(begun_s, exposure_s, self.trail.make_contiguous());
        let due_s = begun_s + self.eye.delay_s(exposure_s, self.dice.rand_float());
        // none overtakes another
        let there_s = self.sent.back().map_or(due_s, |(before_s, _)| due_s.max(*before_s));
        self.sent.push_back((there_s, image));
        self.begun_s += self.eye.config().period_s;
        // the sample that holds when the next image begins is one of those before
        while self.trail.get(1).is_some_and(|sample| sample.time_s <= self.begun_s) {
            self.trail.pop_front();
        }
    }
}

impl Simulated for Room {
    fn step(&mut self) -> Tick {
        let tick = self.rig.step();
        self.now_s = f64::from(tick.telemetry.tick) * TICK_F64_S;
        let (at, light) = tick.spot.map_or((Point::ORIGIN, false), |at| (at, tick.light));
        self.trail.push_back(SpotSample { time_s: self.now_s, at, light });
        self.take();
        tick
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
            if let Some(image) = room.image() {
                numbers.push(image.number);
                late_s.push(1e-3 * f64::from(k) - image.start_s);
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
}
