//! Joints turned by hobby servos: what a train of pulses makes of them.

use tracelight_maths::exp;
use tracelight_rig::TICK_F64_S;

/// A hobby servo with the board that sends its pulses. It knows its own angle by a potentiometer and tells nobody.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServoDrive {
    /// Angle from end to end, rad; the middle of the pulse's span is zero.
    pub range_rad: f64,
    /// Change of the pulse's width over that range, s.
    pub pulse_span_s: f64,
    /// Step in which the board sets the width, s; zero where it sets any.
    pub pulse_resolution_s: f64,
    /// Change of the width that the servo does not yet answer, s.
    pub dead_band_s: f64,
    /// Time from one pulse to the next, s, in whole ticks: 0.02 at 50 Hz.
    pub refresh_s: f64,
    /// Greatest speed, rad/s: π/3 over the catalogue's seconds for 60°.
    pub speed_rad_s: f64,
    /// Time in which it covers all but 1/e of what is left where that speed does not bind, s; zero for none.
    pub response_s: f64,
    /// Play of its gear, rad: the beam turns freely by that much.
    pub play_rad: f64,
    /// Greatest torque, N m: for whoever plans. The joint here turns as the catalogue says, whatever its load.
    pub stall_torque_nm: f64,
}

/// The place of a joint behind a [`ServoDrive`], tick by tick.
///
/// A pulse takes up the set angle of its own tick, and the servo answers from that tick on; the pulse's own 1 to 2 ms are left out. The gear
/// turns at its greatest speed and comes in exponentially, up to the edge of the dead band, where the motor is switched off. The beam follows the
/// gear with play.
#[derive(Clone, Copy, Debug)]
pub struct ServoJoint {
    drive: ServoDrive,
    ticks_to_pulse: u32,
    asked_rad: f64,
    gear_rad: f64,
    beam_rad: f64,
}

impl ServoDrive {
    /// Returns the angle of the smallest step that the joint makes for sure, rad: a step of the pulse, or the dead band where that is wider.
    pub fn resolution_rad(&self) -> f64 {
        self.angle_rad(self.pulse_resolution_s.max(self.dead_band_s))
    }

    /// Returns the angle of a step in which the board sets the pulse's width, rad; zero where it sets any.
    pub fn pulse_step_rad(&self) -> f64 {
        self.angle_rad(self.pulse_resolution_s)
    }

    /// Returns the angle that it does not yet answer, rad.
    pub fn dead_band_rad(&self) -> f64 {
        self.angle_rad(self.dead_band_s)
    }

    /// Returns how long after its plan rests it rests, too, s: a pulse later, and once its own response has died away to a fiftieth.
    pub fn settles_s(&self) -> f64 {
        self.refresh_s + 4.0 * self.response_s
    }

    /// Returns how far in time the gear is behind an angle that is set at a steady speed, s, dead band left out: its own response, and half of the
    /// time from one pulse to the next.
    pub fn lag_s(&self) -> f64 {
        self.response_s + 0.5 * self.refresh_s
    }

    fn angle_rad(&self, width_s: f64) -> f64 {
        width_s / self.pulse_span_s * self.range_rad
    }

    /// The angle that a pulse asks for, rad: within the range, in steps of the pulse.
    fn asked_rad(&self, set_rad: f64) -> f64 {
        let half_rad = 0.5 * self.range_rad;
        let within_rad = set_rad.max(-half_rad).min(half_rad);
        let step_rad = self.pulse_step_rad();
        if step_rad > 0.0 { (within_rad / step_rad).round() * step_rad } else { within_rad }
    }

    /// How far off the gear still is after a tick, rad, if it is `away_rad` ≥ 0 off now.
    fn left_rad(&self, away_rad: f64) -> f64 {
        let dead_rad = self.dead_band_rad();
        if away_rad <= dead_rad { away_rad } else { self.approached_rad(away_rad).max(dead_rad) }
    }

    /// First at full speed, then from `speed × response` on exponentially; exact over a tick.
    fn approached_rad(&self, away_rad: f64) -> f64 {
        if self.response_s <= 0.0 {
            return (away_rad - self.speed_rad_s * TICK_F64_S).max(0.0);
        }
        let slow_rad = self.speed_rad_s * self.response_s;
        let at_speed_s = ((away_rad - slow_rad) / self.speed_rad_s).max(0.0);
        if at_speed_s >= TICK_F64_S {
            away_rad - self.speed_rad_s * TICK_F64_S
        } else {
            away_rad.min(slow_rad) * exp(-(TICK_F64_S - at_speed_s) / self.response_s)
        }
    }
}

impl ServoJoint {
    /// Returns a joint at rest at angle zero that gets its first pulse in its first tick.
    pub const fn new(drive: ServoDrive) -> Self {
        Self { drive, ticks_to_pulse: 0, asked_rad: 0.0, gear_rad: 0.0, beam_rad: 0.0 }
    }

    /// Lets a tick pass in which the plan sets `set_rad`, and returns the true angle of the beam at its end, rad.
    pub fn turn(&mut self, set_rad: f64) -> f64 {
        if self.ticks_to_pulse == 0 {
            self.asked_rad = self.drive.asked_rad(set_rad);
            self.ticks_to_pulse = ((self.drive.refresh_s / TICK_F64_S).round() as u32).max(1);
        }
        self.ticks_to_pulse -= 1;
        let away_rad = self.asked_rad - self.gear_rad;
        self.gear_rad = self.asked_rad - self.drive.left_rad(away_rad.abs()) * away_rad.signum();
        let free_rad = 0.5 * self.drive.play_rad;
        self.beam_rad = self.beam_rad.max(self.gear_rad - free_rad).min(self.gear_rad + free_rad);
        self.beam_rad
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// 180° over 500 to 2500 µs, 50 Hz, 0.17 s for 60°.
    const DRIVE: ServoDrive = ServoDrive {
        range_rad: PI,
        pulse_span_s: 2e-3,
        pulse_resolution_s: 1e-6,
        dead_band_s: 5e-6,
        refresh_s: 0.02,
        speed_rad_s: PI / 3.0 / 0.17,
        response_s: 0.0,
        play_rad: 0.0,
        stall_torque_nm: 0.9,
    };

    const IDEAL: ServoDrive = ServoDrive {
        pulse_resolution_s: 0.0,
        dead_band_s: 0.0,
        refresh_s: 0.001,
        speed_rad_s: f64::INFINITY,
        ..DRIVE
    };

    fn rest(drive: ServoDrive, set_rad: f64, ticks: usize) -> f64 {
        let mut joint = ServoJoint::new(drive);
        (0..ticks).fold(0.0, |_, _| joint.turn(set_rad))
    }

    #[test]
    fn sixty_degrees_take_the_seconds_of_the_catalogue() {
        let exact = ServoDrive { dead_band_s: 0.0, pulse_resolution_s: 0.0, ..DRIVE };
        assert!(rest(exact, PI / 3.0, 169) < PI / 3.0 - 5e-3);
        assert!((rest(exact, PI / 3.0, 170) - PI / 3.0).abs() < 1e-9);
    }

    #[test]
    fn a_step_inside_the_dead_band_moves_nothing_and_one_beyond_stops_at_its_edge() {
        let dead_rad = 5.0 / 2000.0 * PI;
        assert!((DRIVE.resolution_rad() - dead_rad).abs() < 1e-15);
        assert_eq!(rest(DRIVE, 0.7 * dead_rad, 200), 0.0);
        let end = rest(DRIVE, 10.0 * dead_rad, 200);
        assert!((end - 9.0 * dead_rad).abs() < 1e-12, "{end} rad");
    }

    #[test]
    fn a_set_angle_waits_for_the_next_pulse() {
        let mut joint = ServoJoint::new(ServoDrive { refresh_s: 0.02, ..IDEAL });
        joint.turn(0.0);
        let seen: Vec<f64> = (1..=20).map(|_| joint.turn(0.3)).collect();
        assert!(seen[..19].iter().all(|&angle| angle == 0.0));
        assert_eq!(seen[19], 0.3);
    }

    #[test]
    fn the_board_sets_whole_steps_of_the_pulse() {
        let coarse = ServoDrive { pulse_resolution_s: 10e-6, ..IDEAL };
        let step_rad = PI / 200.0;
        assert!((rest(coarse, 3.4 * step_rad, 2) - 3.0 * step_rad).abs() < 1e-12);
        assert!((rest(coarse, 3.6 * step_rad, 2) - 4.0 * step_rad).abs() < 1e-12);
    }

    #[test]
    fn it_comes_in_exponentially_and_no_faster_than_it_can() {
        let soft = ServoDrive { speed_rad_s: 5.0, response_s: 0.02, ..IDEAL };
        // 0.2 rad off: 0.1 rad at 5 rad/s take 20 ms; 20 ms on, 0.1 rad / e is left
        assert!((rest(soft, 0.2, 20) - 0.1).abs() < 1e-12);
        assert!((rest(soft, 0.2, 40) - (0.2 - 0.1 / 1.0_f64.exp())).abs() < 1e-12);
    }

    #[test]
    fn play_is_lost_at_every_turn_back() {
        let mut joint = ServoJoint::new(ServoDrive { play_rad: 0.02, ..IDEAL });
        assert!((joint.turn(0.5) - 0.49).abs() < 1e-12);
        assert!((joint.turn(0.485) - 0.49).abs() < 1e-12, "the gear turns alone");
        assert!((joint.turn(0.3) - 0.31).abs() < 1e-12);
    }

    #[test]
    fn it_stops_at_the_end_of_its_range() {
        assert!((rest(IDEAL, 3.0, 2) - PI / 2.0).abs() < 1e-12);
    }

    #[test]
    fn an_ideal_servo_is_where_the_plan_is() {
        let mut joint = ServoJoint::new(IDEAL);
        for i in 0..2000 {
            let set = (f64::from(i) * 3e-3).sin();
            assert!((joint.turn(set) - set).abs() < 1e-15);
        }
    }
}
