use tracelight_dynamics::Motor;
use tracelight_maths::{exp, sin};
use tracelight_rig::{
    Actuation, Head, Input, InputState, Inputs, Joint, Measurement, PanTilt, Sensed, TICK_F64_S,
};

use crate::dice::Dice;
use crate::encoder::Encoder;
use crate::foot::Foot;
use crate::gain::{Gain, Weakening};
use crate::light::{Relay, play};
use crate::mechanism::Mechanism;
use crate::stops::Stops;
use crate::teeth::{LooseBelt, Teeth};
use crate::{JointState, PlantConfig, Wear};

/// Plant substeps in a tick. Measured on a traced polygon: four times as many change the rms and the largest
/// error by less than 0.02 % on the preset `report` and by 0.02 % on `worn`.
const SUBSTEPS: u32 = 10;
/// Twice the mains frequency: what a rectifier leaves of it.
const SUPPLY_HZ: f64 = 100.0;
/// How far from straight ahead cables may hang at rest, rad.
const CABLE_REST_RAD: f64 = 0.3;

/// A simulated head: [`Head`] on the controller's side, the truth on the other.
#[derive(Clone, Debug)]
pub struct Plant {
    // what it is
    mechanism: Mechanism,
    torque_nm_per_v: PanTilt<f64>,
    motors: PanTilt<Motor>,
    rotor_kg_m2: PanTilt<f64>,
    wear: Wear,
    /// Where cables do not pull, rad.
    cable_rest_rad: PanTilt<f64>,
    // where it is
    state: JointState,
    beam_rad: PanTilt<f64>,
    encoders: PanTilt<Encoder>,
    relay: Relay,
    /// What the enable drives, in series with the relay.
    enable: Relay,
    inputs: Inputs,
    foot: Foot,
    push_nm: PanTilt<f64>,
    /// What the joints come up against either way, if anything is there.
    stops: Option<PanTilt<Stops>>,
    supply_left: f64,
    gains: PanTilt<Gain>,
    /// What the motors give, N m: it follows the command.
    current_nm: PanTilt<f64>,
    time_s: f64,
    /// How late the present tick began, s.
    late_s: f64,
    /// How much longer the next tick lasts, s.
    held_up_s: f64,
    dice: Dice,
}

impl Plant {
    /// A head at rest, homed to within one count of straight ahead. What differs from head to head (where in that
    /// count it rests, phases of ripple, edge table, gains within their spread, how discs and cables sit) is drawn from `seed`.
    pub fn new(config: &PlantConfig, seed: u64) -> Self {
        Self::resting_at(config, PanTilt::default(), seed)
    }

    /// Starts at rest at other angles, within one count of `angle_rad`.
    pub fn resting_at(config: &PlantConfig, angle_rad: PanTilt<f64>, seed: u64) -> Self {
        let mut dice = Dice::new(seed);
        let wear = &config.wear;
        let count_rad = config.encoder.count_rad();
        let rest = PanTilt::from_fn(|j| angle_rad[j] + 0.5 * count_rad * dice.signed());
        let ripple_phase = PanTilt::from_fn(|_| std::f64::consts::PI * dice.signed());
        let encoders = PanTilt::from_fn(|j| {
            let table = [0; 4].map(|_| wear.edge_error_counts * dice.signed());
            Encoder::new(count_rad, config.encoder.edge_stamps, table, rest[j])
        });
        let gain = |j: Joint| config.motors[j].torque_nm_per_v * (1.0 + wear.gain_spread * dice.signed());
        let torque_nm_per_v = PanTilt::from_fn(gain);
        // what is drawn from here on was not there once: the same seeds give the same heads as then
        let cable_rest_rad = PanTilt::from_fn(|_| CABLE_REST_RAD * dice.signed());
        let encoders = PanTilt::from_fn(|j: Joint| {
            let direction = std::f64::consts::PI * dice.signed();
            let worn = encoders[j].eccentric(wear.eccentricity_counts, direction);
            worn.missing(wear.lost_counts, seed.wrapping_mul(2).wrapping_add(j as u64))
        });
        Self {
            mechanism: Mechanism::new(config, ripple_phase, rest),
            torque_nm_per_v,
            motors: config.motors,
            rotor_kg_m2: config.bodies.rotor_kg_m2,
            wear: *wear,
            cable_rest_rad,
            state: JointState { angle_rad: rest, rate_rad_s: PanTilt::default() },
            beam_rad: rest,
            encoders,
            relay: Relay::new(config.relay),
            enable: Relay::new(config.enable),
            inputs: Input::ALL
                .into_iter()
                .fold(Inputs::ABSENT, |all, input| all.with(input, InputState::Fine)),
            foot: Foot::new(config.foot, config.gyroscope, carried_kg_m2(config), seed),
            push_nm: PanTilt::default(),
            stops: None,
            supply_left: 1.0,
            gains: PanTilt::new(Gain::FULL, Gain::FULL),
            current_nm: PanTilt::default(),
            time_s: 0.0,
            late_s: 0.0,
            held_up_s: 0.0,
            dice,
        }
    }

    /// Adds end stops to the joints, lower and upper, rad.
    #[must_use]
    pub fn between_stops(mut self, config: &PlantConfig, stops_rad: PanTilt<(f64, f64)>) -> Self {
        let inertia_kg_m2 = match self.mechanism {
            Mechanism::Rigid(_) => config.bodies.lumped().mass(0.0).own_inertia(),
            Mechanism::Belted { .. } => carried_kg_m2(config),
        };
        let stops = |j: Joint| Stops { at_rad: stops_rad[j], inertia_kg_m2: inertia_kg_m2[j] };
        self.stops = Some(PanTilt::from_fn(stops));
        self
    }

    /// What the encoders read, before anything moves.
    pub fn measured(&self) -> PanTilt<Measurement> {
        self.encoders.map(|encoder| encoder.measurement())
    }

    /// True joint angles at the encoders, rad.
    pub const fn angle_rad(&self) -> PanTilt<f64> {
        self.state.angle_rad
    }

    /// True rates of what the encoders sit on, rad/s.
    pub const fn rate_rad_s(&self) -> PanTilt<f64> {
        self.state.rate_rad_s
    }

    /// True direction of the beam, rad: the joints' angles less the play.
    pub const fn beam_rad(&self) -> PanTilt<f64> {
        self.beam_rad
    }

    /// Whether light leaves the head.
    pub const fn light(&self) -> bool {
        self.relay.is_closed() && self.enable.is_closed()
    }

    /// What its safety inputs say.
    pub const fn inputs(&self) -> Inputs {
        self.inputs
    }

    /// A safety input says that from now on.
    pub const fn set_input(&mut self, input: Input, state: InputState) {
        self.inputs = self.inputs.with(input, state);
    }

    /// The controller's processor is held up: the next tick lasts so much longer, s.
    pub const fn hold_up(&mut self, time_s: f64) {
        self.held_up_s = time_s;
    }

    /// Freezes the laser's relay in its present state, whatever the gate.
    pub const fn stick_laser(&mut self) {
        self.relay.stick(true);
    }

    /// Replaces the laser's relay by a working one.
    pub const fn free_laser(&mut self) {
        self.relay.stick(false);
    }

    /// Freezes the laser's second switch in its present state, whatever the enable.
    pub const fn stick_enable(&mut self) {
        self.enable.stick(true);
    }

    /// Whether the relay that the gate drives is closed.
    pub const fn laser_on(&self) -> bool {
        self.relay.is_closed()
    }

    /// The disc of a joint's encoder slips from now on: it turns by that share of what it sits on.
    pub fn slip_disc(&mut self, joint: Joint, share: f64) {
        self.encoders[joint].slips(self.state.angle_rad[joint], share);
    }

    /// A joint's belt jumps teeth from now on. Encoders at the motors do not see that, those at the joints do. Nothing happens to a head whose
    /// rotors have no inertia: a belt needs some on both sides.
    pub fn loosen_belt(&mut self, joint: Joint, belt: LooseBelt) {
        if self.rotor_kg_m2.pan.min(self.rotor_kg_m2.tilt) <= 0.0 {
            return;
        }
        let limit_nm = self.motors[joint].most_v() * self.torque_nm_per_v[joint];
        let mut belted = self.mechanism.on_belts(&self.state, self.rotor_kg_m2);
        belted.loosen(joint, Teeth::new(belt, limit_nm));
        let encoders_at_motors = self.wear.encoders_at_motors;
        self.mechanism = Mechanism::Belted { belted, encoders_at_motors };
    }

    /// A joint's amplifier weakens from now on.
    pub fn weaken(&mut self, joint: Joint, weakening: Weakening) {
        self.gains[joint].weaken(weakening);
    }

    /// What the motors' currents make at the joints now, N m.
    pub fn motor_nm(&self) -> PanTilt<f64> {
        // what their own voltages take from the torque is stepped as friction is
        let own = |j: Joint| self.motors[j].back_emf_nm_s_per_rad() * self.state.rate_rad_s[j];
        PanTilt::from_fn(|j| self.current_nm[j] - own(j))
    }

    /// Somebody leans on the head: torque at the joints from now on, N m.
    pub fn push(&mut self, torque_nm: PanTilt<f64>) {
        self.push_nm = torque_nm;
    }

    /// Somebody bumps into what the head stands on: it turns by so much about pan's and tilt's axes within 30 ms, rad, and stays so.
    pub const fn bump(&mut self, by_rad: PanTilt<f64>) {
        self.foot.bump(by_rad);
    }

    /// How far what it stands on has turned about pan's and tilt's axes since the beginning, rad.
    pub fn foot_rad(&self) -> PanTilt<f64> {
        self.foot.angle_rad()
    }

    /// The supply gives that share of what it should from now on: so much is left of every volt's torque.
    pub const fn sag(&mut self, left: f64) {
        self.supply_left = left;
    }

    /// A tick in which something else than its motors turns the joints to these angles, rad: laser, inputs, foot and gyroscope are as ever. What
    /// somebody leans on the head with is whoever turns them to withstand: see [`pushed_nm`](Self::pushed_nm). The encoders read nothing new.
    pub fn turned_to(&mut self, actuation: &Actuation, to_rad: PanTilt<f64>) -> Sensed {
        let lasts_s = self.tick_s();
        let before_rad_s = self.state.rate_rad_s;
        let rate_rad_s = PanTilt::from_fn(|j| (to_rad[j] - self.state.angle_rad[j]) / lasts_s);
        let sped_up_rad_s2 = PanTilt::from_fn(|j| (rate_rad_s[j] - before_rad_s[j]) / lasts_s);
        self.foot.begin_tick();
        let part_s = lasts_s / f64::from(SUBSTEPS);
        for _ in 0..SUBSTEPS {
            self.foot.substep(sped_up_rad_s2, part_s);
            self.switch(actuation, part_s);
        }
        self.time_s += lasts_s;
        self.state = JointState { angle_rad: to_rad, rate_rad_s };
        self.beam_rad = to_rad;
        self.sensed(lasts_s)
    }

    /// What somebody leans on the joints with, N m.
    pub const fn pushed_nm(&self) -> PanTilt<f64> {
        self.push_nm
    }

    fn switch(&mut self, actuation: &Actuation, time_s: f64) {
        self.relay.drive(actuation.gate, time_s);
        self.enable.drive(actuation.enable, time_s);
    }

    /// What is told of a tick that lasted so long, s.
    fn sensed(&mut self, lasts_s: f64) -> Sensed {
        Sensed {
            encoders: self.encoders.map(|e| e.measurement()),
            laser_on: Some(self.laser_on()),
            light: Some(self.light()),
            inputs: self.inputs,
            foot_rad_s: self.foot.read_rad_s(),
            lasted_ticks: Some((lasts_s / TICK_F64_S) as f32),
        }
    }

    /// A part of a tick that lasts `tick_s`.
    fn substep(
        &mut self,
        asked_nm: PanTilt<f64>,
        (tick_s, number): (f64, u32),
        mut seen: impl FnMut(Joint, i32, f64),
    ) {
        const LENGTH: f64 = 1.0 / SUBSTEPS as f64;
        let (length_s, ticks) = (LENGTH * tick_s, tick_s / TICK_F64_S);
        let from = self.state.angle_rad;
        self.follow_command(asked_nm, length_s);
        let pull = self.wear.cable_nm_per_rad;
        let joints = self.mechanism.joints(&self.state);
        // what comes up against a stop is what hangs on a belt, not its motor
        let stopped = |j: Joint| {
            self.stops.map_or(0.0, |stops| stops[j].torque_nm(joints.angle_rad[j], joints.rate_rad_s[j]))
        };
        let thrown = self.foot.torque_nm();
        let others = PanTilt::from_fn(|j| {
            self.push_nm[j] + thrown[j] - pull * (from[j] - self.cable_rest_rad[j]) + stopped(j)
        });
        let before = joints.rate_rad_s;
        let carried = self.mechanism.step(&mut self.state, self.current_nm, others, length_s);
        let after = self.mechanism.joints(&self.state).rate_rad_s;
        self.foot.substep(PanTilt::from_fn(|j| (after[j] - before[j]) / length_s), length_s);
        let to = self.state.angle_rad;
        let end_age = 1.0 - f64::from(number + 1) * LENGTH;
        for joint in Joint::BOTH {
            let told = |count, age| seen(joint, count, age);
            self.encoders[joint].follow((from[joint], to[joint]), (end_age * ticks, LENGTH * ticks), told);
            self.beam_rad[joint] = play(self.beam_rad[joint], carried[joint], self.wear.backlash_rad);
        }
        self.time_s += length_s;
    }

    /// Torque of the motors: what is asked for, as much of it as the supply has, once the current is there.
    fn follow_command(&mut self, asked_nm: PanTilt<f64>, length_s: f64) {
        let ripple = self.wear.supply_ripple * sin(std::f64::consts::TAU * SUPPLY_HZ * self.time_s);
        let supply = self.supply_left * (1.0 + ripple);
        let own = self.state.rate_rad_s.map(|rate| self.wear.back_emf_nm_s_per_rad * rate);
        let gains = PanTilt::from_fn(|j| self.gains[j].after(length_s));
        let there = PanTilt::from_fn(|j| gains[j] * (supply * asked_nm[j]) - own[j]);
        let lag_s = self.wear.current_lag_s;
        if lag_s == 0.0 {
            self.current_nm = there;
            return;
        }
        let share = 1.0 - exp(-length_s / lag_s);
        for joint in Joint::BOTH {
            self.current_nm[joint] += share * (there[joint] - self.current_nm[joint]);
        }
    }

    fn begin_tick(&mut self) {
        for joint in Joint::BOTH {
            self.encoders[joint].begin_tick();
        }
        self.foot.begin_tick();
    }

    /// A part of a tick in which this is done, and what its encoders say in it: joint, count, and ticks until the tick's end.
    fn part(
        &mut self,
        actuation: &Actuation,
        (lasts_s, number): (f64, u32),
        seen: impl FnMut(Joint, i32, f64),
    ) {
        let asked = PanTilt::from_fn(|j| {
            self.motors[j].beyond_v(f64::from(actuation.command_v[j])) * self.torque_nm_per_v[j]
        });
        self.substep(asked, (lasts_s, number), seen);
        self.switch(actuation, lasts_s / f64::from(SUBSTEPS));
    }

    /// Some time passes for whoever sees lines instead of ticks, of a tenth of a millisecond at most: this is done meanwhile. Told are the counts of each joint's encoder, in
    /// turn, each with how long after the beginning it was reached, s. Returned is what the head senses at the end.
    pub fn pass(
        &mut self,
        actuation: &Actuation,
        lasts_s: f64,
        mut seen: impl FnMut(Joint, i32, f64),
    ) -> Sensed {
        self.begin_tick();
        let lasts_s = lasts_s.min(TICK_F64_S / f64::from(SUBSTEPS));
        let seen = |joint, count, age| seen(joint, count, lasts_s - age * TICK_F64_S);
        self.part(actuation, (f64::from(SUBSTEPS) * lasts_s, SUBSTEPS - 1), seen);
        self.sensed(TICK_F64_S)
    }

    /// How long this tick lasts, s: ticks come early or late, each by itself.
    fn tick_s(&mut self) -> f64 {
        let proper_s = TICK_F64_S + std::mem::take(&mut self.held_up_s);
        if self.wear.jitter_s == 0.0 {
            return proper_s;
        }
        let before = std::mem::replace(&mut self.late_s, self.wear.jitter_s * self.dice.signed());
        proper_s + self.late_s - before
    }
}

impl Head for Plant {
    fn exchange(&mut self, actuation: &Actuation) -> Sensed {
        self.begin_tick();
        let lasts_s = self.tick_s();
        for number in 0..SUBSTEPS {
            self.part(actuation, (lasts_s, number), |_, _, _| {});
        }
        self.sensed(lasts_s)
    }
}

/// Inertia of what joints carry, without their rotors, kg m².
fn carried_kg_m2(config: &PlantConfig) -> PanTilt<f64> {
    let own = config.bodies.lumped().mass(0.0).own_inertia();
    PanTilt::from_fn(|j| own[j] - config.bodies.rotor_kg_m2[j])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{EncoderConfig, FootConfig, GyroscopeConfig, RelayConfig};
    use tracelight_dynamics::{Friction, HeadBodies};

    fn config() -> PlantConfig {
        let motor = Motor::by_current(0.0774, 10.0);
        let friction = Friction::symmetric(0.001, 0.05);
        PlantConfig {
            bodies: HeadBodies::set_a(),
            friction: PanTilt::new(friction, friction),
            motors: PanTilt::new(motor, motor),
            encoder: EncoderConfig { counts_per_rev: 4096, edge_stamps: true },
            relay: RelayConfig { on_s: 5e-3, off_s: 3e-3 },
            enable: RelayConfig { on_s: 0.0, off_s: 0.0 },
            foot: FootConfig::FIRM,
            gyroscope: GyroscopeConfig::NONE,
            wear: Wear::NONE,
        }
    }

    fn drive(plant: &mut Plant, pan_v: f32, ticks: usize) -> Sensed {
        let actuation = Actuation { command_v: PanTilt::new(pan_v, -1.94), gate: true, enable: true };
        (0..ticks).map(|_| plant.exchange(&actuation)).last().unwrap()
    }

    #[test]
    fn counts_follow_the_angle_within_half_a_count() {
        let mut plant = Plant::new(&config(), 3);
        let seen = drive(&mut plant, 3.0, 500);
        let counts = plant.angle_rad().pan / config().encoder.count_rad();
        assert!((counts - f64::from(seen.encoders.pan.count)).abs() <= 0.5 && seen.encoders.pan.count > 100);
    }

    #[test]
    fn equal_seeds_give_equal_heads_and_others_do_not() {
        let mut worn = config();
        worn.wear = Wear { gain_spread: 0.1, edge_error_counts: 0.1, friction_ripple: 0.1, ..Wear::NONE };
        let end = |seed| {
            let mut plant = Plant::new(&worn, seed);
            drive(&mut plant, 2.0, 300);
            plant.angle_rad()
        };
        assert_eq!(end(1), end(1));
        assert_ne!(end(1), end(2));
    }

    #[test]
    fn a_joint_ends_at_its_stops_and_comes_off_them_as_it_went() {
        let mut plant =
            Plant::new(&config(), 0).between_stops(&config(), PanTilt::new((-0.3, 0.4), (-1.0, 1.0)));
        drive(&mut plant, 10.0, 2000);
        let pressed = plant.angle_rad().pan;
        assert!((0.4..0.401).contains(&pressed) && plant.rate_rad_s().pan.abs() < 1e-6, "{pressed}");
        drive(&mut plant, -10.0, 2000);
        let pressed = plant.angle_rad().pan;
        assert!((-0.301..-0.3).contains(&pressed), "{pressed}");
        // between them they are not there
        let (mut free, mut bound) = (Plant::new(&config(), 1), Plant::new(&config(), 1));
        bound = bound.between_stops(&config(), PanTilt::new((-9.0, 9.0), (-9.0, 9.0)));
        drive(&mut free, 3.0, 300);
        drive(&mut bound, 3.0, 300);
        assert_eq!(free.angle_rad(), bound.angle_rad());
    }

    #[test]
    fn an_amplifier_gives_no_more_than_its_limit() {
        let mut ten = Plant::new(&config(), 0);
        let mut hundred = Plant::new(&config(), 0);
        drive(&mut ten, 10.0, 100);
        drive(&mut hundred, 100.0, 100);
        assert_eq!(ten.angle_rad(), hundred.angle_rad());
        assert!(ten.light());
    }

    #[test]
    fn light_needs_both_switches() {
        let mut plant = Plant::new(&config(), 0);
        let mut light = |gate, enable| {
            let actuation = Actuation { gate, enable, ..Actuation::default() };
            (0..10).for_each(|_| {
                plant.exchange(&actuation);
            });
            plant.light()
        };
        assert!(!light(false, false) && !light(true, false) && !light(false, true));
        assert!(light(true, true));
        assert!(!light(true, false), "the relay is still closed");
    }

    #[test]
    fn a_tick_that_is_held_up_says_how_long_it_was() {
        let mut plant = Plant::new(&config(), 0);
        plant.hold_up(1e-3);
        let lasted = |plant: &mut Plant| plant.exchange(&Actuation::default()).lasted_ticks;
        assert_eq!((lasted(&mut plant), lasted(&mut plant)), (Some(2.0), Some(1.0)));
    }
}
