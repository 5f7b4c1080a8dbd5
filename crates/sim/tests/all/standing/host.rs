//! A host that sends anything.

use tracelight_rig::{Command, PanTilt, Rig, Segment, Telemetry};
use tracelight_sim::{RigConfig, Simulated, SimulatedRig, Tick};

use crate::dice::Dice;
use crate::shapes::POSE;

/// What a sequence of commands is drawn from.
#[derive(Debug)]
pub(crate) struct Course {
    seed: u64,
    config: RigConfig,
    /// How long light may stand, ticks.
    pub(crate) budget_ticks: u32,
    homed: bool,
    /// Whether the host says that it is there: never, always, or until some tick.
    alive_until: Option<u32>,
    ticks: u32,
    /// How near to each other the places are that it goes to, rad.
    spread_rad: f64,
    /// How likely a command is in a tick.
    eager: f64,
}

/// Until the end.
const ALWAYS: u32 = u32::MAX;

impl Course {
    pub(crate) fn drawn(seed: u64) -> Self {
        let mut dice = Dice::of_seed(u128::from(seed));
        let mut config = if dice.one_in(4) { RigConfig::worn() } else { RigConfig::report() };
        config.light.standing_s = dice.of(&[0.03, 0.05, 0.05, 0.1, 0.1, 0.2, 0.5]);
        Self {
            seed,
            homed: !dice.one_in(5),
            alive_until: dice.of(&[None, Some(700), Some(ALWAYS), Some(ALWAYS), Some(ALWAYS), Some(ALWAYS)]),
            ticks: dice.of(&[800, 1500, 3000]),
            spread_rad: dice.of(&[1e-4, 1e-3, 3e-3, 6e-3, 0.03]),
            eager: dice.of(&[0.003, 0.01, 0.03]),
            budget_ticks: (config.light.standing_s * 1e3).round() as u32,
            config,
        }
    }

    /// The same on another rig.
    pub(crate) fn on(mut self, rig: RigConfig) -> Self {
        let light = self.config.light;
        self.config = RigConfig { light, ..rig };
        self
    }

    /// The same on a rig that lets light stand.
    pub(crate) fn careless(mut self) -> Self {
        self.config.light.standing_s = 10.0;
        self
    }
}

/// Runs it; `watch` sees every tick.
pub(crate) fn run(course: &Course, mut watch: impl FnMut(&Tick)) {
    let mut dice = Dice::of_seed(u128::from(course.seed) << 32 | 1);
    let mut rig = match course.homed {
        true => SimulatedRig::new(&course.config, POSE, course.seed),
        false => SimulatedRig::unhomed(&course.config, POSE, PanTilt::new(0.1, -0.05), course.seed),
    };
    let mut host = Host { next: 0, at: PanTilt::new(0.0, 0.0) };
    let mut last = Telemetry::default();
    // most begin with a plan: light needs one
    let _ = rig.send(Command::KeepAlive);
    let _ = rig.send(Command::Arm { acknowledges: 0 });
    (0..4).for_each(|_| host.append(&mut rig, course, &mut dice));
    for tick in 0..course.ticks {
        if course.alive_until.is_some_and(|until| tick < until) {
            let _ = rig.send(Command::KeepAlive);
        }
        if dice.happens(course.eager) {
            host.command(&mut rig, course, &mut dice, &last);
        }
        let now = rig.step();
        last = now.telemetry;
        watch(&now);
    }
}

struct Host {
    /// Where its segments have come to: when, and where, rad.
    next: u32,
    at: PanTilt<f64>,
}

impl Host {
    fn command(&mut self, rig: &mut SimulatedRig, course: &Course, dice: &mut Dice, last: &Telemetry) {
        let command = match dice.below(30) {
            // now and then one that was on its way for long
            0..=6 => Command::Arm { acknowledges: last.fault_number.wrapping_sub(u32::from(dice.one_in(8))) },
            7..=8 => Command::Disarm,
            9..=12 => Command::Point(dice.of(&[1, 20, 100, 1000, u16::MAX])),
            13 => {
                let by = dice.of(&[0, 0, 1, -3, 40]);
                Command::Home(last.measured.map(|measured| measured.count + by))
            }
            14 if dice.one_in(3) => Command::Unhome,
            15 => Command::Abandon,
            16 if dice.one_in(3) => Command::Finish,
            _ => return (0..3).for_each(|_| self.append(rig, course, dice)),
        };
        let taken = rig.send(command).is_ok();
        let begins_anew = matches!(command, Command::Home(_) | Command::Abandon);
        if taken && begins_anew {
            self.next = 0;
            self.at = match command {
                Command::Home(_) => last.position_rad.map(f64::from),
                _ => PanTilt::new(0.0, 0.0),
            };
        }
    }

    /// A rest, or a move from rest to rest, slow or fast, near or far; lit as a rule.
    fn append(&mut self, rig: &mut SimulatedRig, course: &Course, dice: &mut Dice) {
        let near = |dice: &mut Dice| course.spread_rad * dice.either_way();
        let (ticks, to): (u16, _) = match dice.below(4) {
            0 => (dice.of(&[20, 100, 700]), self.at),
            1 => (dice.of(&[30, 60]), PanTilt::new(near(dice), near(dice))),
            _ => (dice.of(&[150, 400, 1500]), PanTilt::new(near(dice), near(dice))),
        };
        let n = f64::from(ticks);
        let quintic = |from: f64, to: f64| {
            let by = to - from;
            [from, 0.0, 0.0, 10.0 * by / n.powi(3), -15.0 * by / n.powi(4), 6.0 * by / n.powi(5)]
                .map(|c| c as f32)
        };
        let segment = Segment {
            start_tick: self.next,
            ticks,
            coefficients: PanTilt::new(quintic(self.at.pan, to.pan), quintic(self.at.tilt, to.tilt)),
            tolerance_rad: PanTilt::new(0.01, 0.01),
            gate: !dice.one_in(4),
            rate_limit: tracelight_rig::RateLimit::PLANNED,
        };
        if rig.send(Command::Append(segment)).is_ok() {
            self.next += u32::from(ticks);
            self.at = to;
        }
    }
}
