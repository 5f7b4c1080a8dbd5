//! What the lines of a board say, and what is said by them: edges of encoders, switches in loops, bridges, converters, a gyroscope.

use tracelight_rig::{Capabilities, Input, InputState, Inputs, Joint, Measurement};

/// Safety inputs of a board, in the order of its lines: each has to say all the time that all is well, if only by a wire.
pub const INPUTS: [Input; 5] = [
    Input::EmergencyStop,
    Input::Lid,
    Input::Key,
    Input::Amplifier(Joint::Pan),
    Input::Amplifier(Joint::Tilt),
];

/// Rate of a gyroscope's steps, rad/s: 8.75 thousandths of a degree a second, as an LSM6DSO has within 250°/s.
const GYROSCOPE_STEP_RAD_S: f32 = 8.75e-3 * core::f32::consts::PI / 180.0;
/// Steps of a converter with 12 bits, half of them below 0 V.
const CONVERTER_STEPS: f32 = 4096.0;
/// What such a converter's amplifier gives either way, V.
const CONVERTER_V: f32 = 10.0;

/// What a board with such lines has, which sees the light or does not, and has a gyroscope or has none.
pub fn capabilities(light_watched: bool, gyroscope: bool) -> Capabilities {
    let inputs = INPUTS.into_iter().fold(Inputs::ABSENT, |all, input| all.with(input, InputState::Fine));
    Capabilities {
        stamps: true,
        gate_watched: false,
        light_watched,
        gyroscope,
        times_ticks: true,
        absolute: false,
        inputs,
    }
}

/// An encoder whose every edge comes with the count after it and the time of it, by a clock that wraps.
#[derive(Clone, Copy, Debug, Default)]
pub struct Quadrature {
    count: i32,
    /// Time of the last edge, until a tick has passed.
    edge: Option<u32>,
}

impl Quadrature {
    /// Takes the next edge: the count after it, and when it was. False for one that comes after now, which is for a later tick.
    pub fn take(&mut self, count: i32, at: u32, now: u32) -> bool {
        let is_past = now.wrapping_sub(at) <= u32::MAX / 2;
        if is_past {
            (self.count, self.edge) = (count, Some(at));
        }
        is_past
    }

    /// What it says now, with ticks of so many units of its clock.
    pub fn read(&mut self, now: u32, tick: u32) -> Measurement {
        let age = self.edge.map(|at| now.wrapping_sub(at)).filter(|&age| age < tick);
        if age.is_none() {
            // before the clock comes round to it again
            self.edge = None;
        }
        Measurement { count: self.count, edge_age_ticks: age.map(|age| age as f32 / tick as f32) }
    }
}

/// Switches of which each has a bit in the order of [`INPUTS`], looked at several times a tick: one is open if it was in two looks that follow each other. What is shorter is a spark.
#[derive(Clone, Copy, Debug, Default)]
pub struct Switches {
    before: u8,
    open: u8,
}

impl Switches {
    /// Looks at them: those that are open now.
    pub const fn look(&mut self, open: u8) {
        self.open |= open & self.before;
        self.before = open;
    }

    /// Those that were open since this was asked last.
    pub const fn take(&mut self) -> u8 {
        let open = self.open;
        self.open = 0;
        open
    }
}

/// Times for which both inputs of an H-bridge are high, of so many, for a command of volts of which `limit_v` is all the bridge gives. The motor is shorted for the
/// rest, so that its mean voltage is what is asked for whichever way it turns.
pub fn bridge(command_v: f32, limit_v: f32, of: u16) -> (u16, u16) {
    let share = command_v / limit_v;
    // no number is no volts
    let share = if share.is_finite() { share.clamp(-1.0, 1.0) } else { 0.0 };
    let most = f32::from(of);
    let low = of.saturating_sub((share.abs() * most + 0.5) as u16);
    if share >= 0.0 { (of, low) } else { (low, of) }
}

/// Both inputs of a bridge that lets its motor go.
pub const LET_GO: (u16, u16) = (0, 0);

/// What a converter of 12 bits is told for a command of volts, whose amplifier gives 10 V either way.
pub fn converter(command_v: f32) -> u16 {
    let half = 0.5 * CONVERTER_STEPS;
    let step = half + command_v / CONVERTER_V * half + 0.5;
    let step = if step.is_finite() { step.clamp(0.0, CONVERTER_STEPS - 1.0) } else { half };
    step as u16
}

/// How fast a gyroscope's foot turns, by its steps, rad/s.
pub fn turning_rad_s(steps: [i16; 3]) -> [f32; 3] {
    steps.map(|steps| f32::from(steps) * GYROSCOPE_STEP_RAD_S)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Units of the clock in a tick.
    const TICK: u32 = 1000;

    #[test]
    fn an_edge_is_stamped_in_the_tick_in_which_it_came() {
        let mut encoder = Quadrature::default();
        // the clock comes round between both
        let now = 100_u32;
        assert!(encoder.take(5, now.wrapping_sub(350), now));
        assert!(encoder.take(6, now.wrapping_sub(250), now));
        assert!(!encoder.take(7, now + 1, now), "that is after the tick");
        assert_eq!(encoder.read(now, TICK), Measurement { count: 6, edge_age_ticks: Some(0.25) });
        let now = now + TICK;
        assert!(encoder.take(7, now - TICK + 1, now));
        assert_eq!(encoder.read(now, TICK).edge_age_ticks, Some(0.999));
        // nothing comes, though the clock comes round to that edge
        for waited in [TICK, 2 * TICK, u32::MAX] {
            let now = now.wrapping_add(waited);
            assert_eq!(encoder.read(now, TICK), Measurement { count: 7, edge_age_ticks: None });
        }
    }

    #[test]
    fn a_switch_is_open_in_two_looks_that_follow_each_other() {
        let mut switches = Switches::default();
        [0b01, 0b10, 0b00, 0b01].into_iter().for_each(|open| switches.look(open));
        assert_eq!(switches.take(), 0, "sparks");
        switches.look(0b01);
        switches.look(0b00);
        assert_eq!(switches.take(), 0b01, "it was open, though it no longer is");
        assert_eq!(switches.take(), 0);
    }

    #[test]
    fn each_switch_has_the_bit_of_its_input() {
        let has = capabilities(true, false);
        for (bit, input) in INPUTS.into_iter().enumerate() {
            let opened = has.inputs.opened_by(1 << bit);
            assert!(opened.opened().eq([input]), "{input:?}");
        }
        assert_eq!(has.inputs.present_bits().count_ones() as usize, INPUTS.len());
    }

    #[test]
    fn a_bridge_gives_what_is_asked_for_in_the_mean() {
        for command_v in [-12.0, -11.9, -0.01, 0.0, 3.0, 12.0, 99.0] {
            let (a, b) = bridge(command_v, 12.0, 7500);
            let mean_v = 12.0 * (f32::from(a) - f32::from(b)) / 7500.0;
            let asked_v = command_v.clamp(-12.0, 12.0);
            assert!((mean_v - asked_v).abs() <= 12.0 / 7500.0 / 2.0 + 1e-4, "{mean_v} of {command_v}");
            assert!(a == 7500 || b == 7500, "shorted for the rest");
        }
        assert_eq!(bridge(f32::NAN, 12.0, 7500), bridge(0.0, 12.0, 7500));
        assert_eq!(bridge(1.0, 0.0, 7500), (7500, 7500));
    }

    #[test]
    fn a_converter_gives_what_is_asked_for() {
        assert_eq!([-10.0, -20.0, 0.0, 5.0, 10.0, f32::NAN].map(converter), [0, 0, 2048, 3072, 4095, 2048]);
    }

    #[test]
    fn a_gyroscope_counts_steps_of_a_rate() {
        let [x, y, z] = turning_rad_s([0, 200, -200]);
        assert!(x == 0.0 && (y - 1.75_f32.to_radians()).abs() < 1e-6 && y == -z, "{y}");
    }
}
