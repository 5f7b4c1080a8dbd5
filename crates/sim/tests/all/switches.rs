//! The second way to dark: both switches of the laser are tried before the first light, found where one of them is stuck, and where light goes
//! on although both are told to open the head turns to where it may fall.

#![allow(clippy::print_stdout, reason = "a test shows its figures")]

use tracelight_control::{Controller, State};
use tracelight_plant::Plant;
use tracelight_rig::{
    Actuation, Command, Darkness, Fault, Head, Joint, PanTilt, Phase, Rig, Segment, Sensed, Telemetry,
};
use tracelight_session::Feeder;
use tracelight_sim::{RigConfig, SimulatedRig, Tick, Trouble};
use tracelight_trajectory::Plan;

use crate::shapes::{POSE, alive, circle, lit_ticks, plan_of};

/// Where light that goes on may fall, rad: a corner of the room.
const PARK_RAD: PanTilt<f64> = PanTilt::new(-0.6, 0.4);

/// A preset that parks its head there.
fn parking() -> RigConfig {
    let mut config = RigConfig::report();
    config.safety.park_rad = PARK_RAD.map(Some);
    config
}

/// A run on which `meddle` acts before every tick, to its end or for `most` ticks.
fn run_with(
    config: &RigConfig,
    plan: &Plan,
    (seed, most): (u64, usize),
    mut meddle: impl FnMut(&mut SimulatedRig, usize),
) -> Vec<Tick> {
    let mut rig = SimulatedRig::new(config, POSE, seed);
    let mut feeder = Feeder::new(plan.segments.as_slice(), false);
    let mut ticks: Vec<Tick> = Vec::new();
    rig.send(Command::KeepAlive).unwrap();
    rig.send(Command::Arm { acknowledges: 0 }).unwrap();
    while ticks.len() < most && ticks.last().is_none_or(|t| t.telemetry.phase != Phase::Done) {
        meddle(&mut rig, ticks.len());
        feeder.feed(&mut rig);
        ticks.push(alive(&mut rig));
    }
    ticks
}

/// Ticks in which the switches are told that.
fn told(ticks: &[Tick], gate: bool, enable: bool) -> usize {
    let is = |a: &Actuation| (a.gate, a.enable) == (gate, enable);
    ticks.iter().filter(|t| is(&t.telemetry.actuation)).count()
}

fn first_fault(ticks: &[Tick]) -> Option<(usize, Fault)> {
    ticks.iter().enumerate().find_map(|(at, t)| Some((at, t.telemetry.fault()?)))
}

/// Before a plan's first light each switch was closed by itself for as long as it takes, and no light was seen; the plan's clock did not wait.
#[test]
fn both_switches_are_tried_in_the_dark_before_the_first_light() {
    let config = RigConfig::report();
    let plan = plan_of(&config, circle(0.2));
    let ticks = run_with(&config, &plan, (0, 20_000), |_, _| {});
    let lit = ticks.iter().position(|t| t.telemetry.actuation.lights()).unwrap();
    let before = &ticks[..lit];
    assert!(before.iter().all(|t| !t.light));
    // relay: 5 ms on, 3 ms off, 2 of slack; what the enable drives takes no time
    assert_eq!(told(before, true, false), 8);
    let tried = before.iter().position(|t| t.telemetry.actuation.enable).unwrap();
    assert_eq!((tried, told(&before[..tried], false, false)), (20, 12));
    assert!(before[tried..].iter().all(|t| t.telemetry.actuation.enable), "and stays closed");
    assert!(before[..tried].iter().all(|t| t.telemetry.darkness.contains(Darkness::Untested)));
    // once is enough, and it takes the plan no tick
    assert_eq!(told(&ticks[lit..], true, false), 0);
    assert!(ticks.iter().take(plan.points.len()).enumerate().all(|(i, t)| t.telemetry.plan_tick == i as u32));
    assert_eq!(first_fault(&ticks), None);
}

/// What of the laser is watched, the gate's switch or the light.
#[derive(Clone, Copy, Debug)]
struct Watched {
    switch: bool,
    light: bool,
}

/// What is wrong with a head from the start.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stuck {
    Nothing,
    /// The relay does not open, or not close.
    Relay {
        closed: bool,
    },
    /// The second switch does not open.
    Enable,
    /// The photodiode sees nothing.
    Blind,
}

/// A controller with a head of which only that much is seen.
struct Partly {
    controller: Controller,
    state: State,
    plant: Plant,
    sensed: Sensed,
    watched: Watched,
    stuck: Stuck,
}

/// What is seen of what there is.
fn seen(sensed: Sensed, watched: Watched, stuck: Stuck) -> Sensed {
    Sensed {
        laser_on: sensed.laser_on.filter(|_| watched.switch),
        light: sensed.light.filter(|_| watched.light).map(|light| light && stuck != Stuck::Blind),
        ..sensed
    }
}

impl Partly {
    fn new(config: &RigConfig, watched: Watched, stuck: Stuck, seed: u64) -> Self {
        let mut plant = Plant::new(&config.plant_config(), seed);
        let closes = |gate, enable| Actuation { gate, enable, ..Actuation::default() };
        let mut close = |actuation| {
            (0..10).for_each(|_| {
                plant.exchange(&actuation);
            });
        };
        match stuck {
            Stuck::Relay { closed } => close(closes(closed, false)),
            Stuck::Enable => close(closes(false, true)),
            Stuck::Nothing | Stuck::Blind => {}
        }
        match stuck {
            Stuck::Relay { .. } => plant.stick_laser(),
            Stuck::Enable => plant.stick_enable(),
            Stuck::Nothing | Stuck::Blind => {}
        }
        let controller = Controller::new(config.control_config());
        let sensed = seen(
            Sensed { laser_on: Some(plant.laser_on()), light: Some(plant.light()), ..Sensed::default() },
            watched,
            stuck,
        );
        Self { state: controller.start_homed(&sensed), controller, plant, sensed, watched, stuck }
    }

    /// A tick, and whether light leaves the head at its end.
    fn step(&mut self) -> (Telemetry, bool) {
        let telemetry = self.controller.tick(&mut self.state, &self.sensed);
        self.sensed = seen(self.plant.exchange(&telemetry.actuation), self.watched, self.stuck);
        (telemetry, self.plant.light())
    }

    /// The first ticks of a plan, by a host that arms as often as it hears of a fault.
    fn draw(&mut self, plan: &Plan) -> Vec<(Telemetry, bool)> {
        let mut feeder = Feeder::new(plan.segments.as_slice(), false);
        let mut ticks: Vec<(Telemetry, bool)> = Vec::new();
        while ticks.len() < 2000 {
            let acknowledges = ticks.last().map_or(0, |(t, _)| t.fault_number);
            self.send(Command::KeepAlive).unwrap();
            self.send(Command::Arm { acknowledges }).unwrap();
            feeder.feed(self);
            ticks.push(self.step());
        }
        ticks
    }
}

impl Rig for Partly {
    fn send(&mut self, command: Command) -> Result<(), Command> {
        self.controller.accept(&mut self.state, command)
    }

    fn next(&mut self) -> Option<Telemetry> {
        Some(self.step().0)
    }
}

/// What becomes of ten heads that draw: the faults they begin with, for how many ticks on end there was light before any was wanted, and whether any
/// ever was.
fn drawn(watched: Watched, stuck: Stuck) -> (Vec<Fault>, usize, bool) {
    let config = RigConfig::report();
    let plan = plan_of(&config, circle(0.2));
    let (mut faults, mut stray, mut wanted) = (Vec::new(), 0, false);
    for seed in 0..10 {
        let ticks = Partly::new(&config, watched, stuck, seed).draw(&plan);
        let is_wanted = |t: &(Telemetry, bool)| t.0.actuation.lights();
        let before = &ticks[..ticks.iter().position(is_wanted).unwrap_or(ticks.len())];
        stray = before.split(|(_, light)| !light).map(<[_]>::len).fold(stray, usize::max);
        wanted |= before.len() < ticks.len();
        faults.extend(ticks.iter().find_map(|(t, _)| t.fault()));
    }
    assert!(faults.is_empty() || faults.len() == 10, "{watched:?}, {stuck:?}: in some only");
    faults.dedup();
    (faults, stray, wanted)
}

const SWITCH: Watched = Watched { switch: true, light: false };
const LIGHT: Watched = Watched { switch: false, light: true };
const BOTH: Watched = Watched { switch: true, light: true };
const NEITHER: Watched = Watched { switch: false, light: false };

/// Whoever arms again and again gets no light by it.
#[test]
fn a_switch_that_does_not_open_is_found_before_any_light_is_wanted() {
    let welded = Stuck::Relay { closed: true };
    // its contact tells before the other switch closes; light tells of it once that does
    for (watched, stuck, most) in [
        (BOTH, welded, 0),
        (SWITCH, welded, 0),
        (LIGHT, welded, 1),
        (BOTH, Stuck::Enable, 4),
        (LIGHT, Stuck::Enable, 4),
    ] {
        let (faults, stray, wanted) = drawn(watched, stuck);
        println!("{watched:?}, {stuck:?}: {faults:?}, light for {stray} ms");
        assert_eq!((faults, wanted), (vec![Fault::LaserStuck], false), "{watched:?}, {stuck:?}");
        assert!(stray <= most, "{watched:?}, {stuck:?}: light for {stray} ms");
    }
    // nothing but light tells of the second one
    assert_eq!(drawn(SWITCH, Stuck::Enable).0, []);
}

#[test]
fn a_switch_that_does_not_close_and_an_eye_that_sees_nothing_are_found() {
    let open = Stuck::Relay { closed: false };
    for watched in [BOTH, SWITCH] {
        assert_eq!(drawn(watched, open), (vec![Fault::LaserDark], 0, false), "{watched:?}");
    }
    // where light alone is watched it has to be missed
    for (watched, stuck) in [(LIGHT, open), (LIGHT, Stuck::Blind), (BOTH, Stuck::Blind)] {
        assert_eq!(drawn(watched, stuck), (vec![Fault::LaserDark], 0, true), "{watched:?}, {stuck:?}");
    }
}

/// It is not tested, so nobody says that it is fine.
#[test]
fn a_rig_that_sees_neither_switch_nor_light_tries_nothing() {
    let config = RigConfig::report();
    let plan = plan_of(&config, circle(0.2));
    let ticks = Partly::new(&config, NEITHER, Stuck::Nothing, 0).draw(&plan);
    let armed = |t: &Telemetry| matches!(t.phase, Phase::Armed | Phase::Tracing | Phase::Holding);
    assert!(ticks.iter().all(|(t, _)| t.actuation.enable == armed(t)));
    assert!(ticks.iter().all(|(t, _)| t.actuation.enable || !t.actuation.gate));
    assert_eq!(drawn(NEITHER, Stuck::Relay { closed: true }).0, []);
    assert_eq!(drawn(NEITHER, Stuck::Enable).0, []);
}

#[test]
fn a_plan_that_begins_with_light_waits_until_the_switches_were_tried_and_a_dry_one_tries_nothing() {
    // encoders are believed, so that nothing else is waited for
    let config = RigConfig::report().trusting();
    let still = |start_tick| Segment {
        start_tick,
        ticks: 200,
        coefficients: PanTilt::default(),
        tolerance_rad: PanTilt::new(0.01, 0.01),
        gate: true,
        rate_limit: tracelight_rig::RateLimit::PLANNED,
    };
    for dark in [false, true] {
        let mut rig = SimulatedRig::new(&config, POSE, 0);
        let segments = [still(0), still(200)];
        let mut feeder = Feeder::new(segments, dark);
        rig.send(Command::KeepAlive).unwrap();
        rig.send(Command::Arm { acknowledges: 0 }).unwrap();
        let ticks: Vec<Tick> = (0..600)
            .map(|_| {
                feeder.feed(&mut rig);
                alive(&mut rig)
            })
            .collect();
        assert_eq!(told(&ticks, true, false), if dark { 0 } else { 8 });
        let lit = ticks.iter().position(|t| t.telemetry.actuation.lights());
        assert_eq!(lit.is_some(), !dark);
        let before = &ticks[..lit.unwrap_or(ticks.len())];
        assert!(
            before
                .iter()
                .all(|t| !t.light && (!t.telemetry.actuation.gate || t.telemetry.phase == Phase::Holding))
        );
        assert_eq!(ticks.last().map(|t| t.telemetry.phase), Some(Phase::Done));
    }
}

/// The longest that light stayed within 1 mm of where it was, ticks.
fn stood(ticks: &[Tick]) -> usize {
    let near = |from: &Tick, tick: &&Tick| {
        tick.light && tick.spot.zip(from.spot).is_some_and(|(a, b)| a.distance(b) <= 1e-3)
    };
    (0..ticks.len())
        .map(|at| ticks[at..].iter().take_while(|t| near(&ticks[at], t)).count())
        .max()
        .unwrap_or(0)
}

/// Both switches stick in the middle of a run, and nobody comes for two seconds after that was seen.
fn both_stuck(config: &RigConfig, seed: u64) -> (Vec<Tick>, usize) {
    let plan = plan_of(config, circle(0.2));
    let lit = lit_ticks(&plan);
    let mut dice = oorandom::Rand64::new(u128::from(seed));
    let when = lit[dice.rand_range(0..lit.len() as u64) as usize];
    let most = plan.points.len() + 2500;
    let ticks = run_with(config, &plan, (seed, most), |rig, at| {
        if at == when {
            rig.suffer(Trouble::LaserStuck);
            rig.suffer(Trouble::EnableStuck);
        }
    });
    let (seen, fault) = first_fault(&ticks).unwrap();
    assert_eq!(fault, Fault::LaserStuck, "seed {seed}");
    assert!(ticks[seen..].iter().all(|t| t.light && !t.telemetry.actuation.lights()), "seed {seed}");
    (ticks[seen..seen + 2000].to_vec(), seen - when)
}

#[test]
fn a_laser_that_nothing_darkens_is_turned_away_at_once() {
    let is_parked = |t: &Tick| Joint::BOTH.iter().all(|&j| (t.angle_rad[j] - PARK_RAD[j]).abs() < 5e-3);
    let (mut longest, mut latest, mut unparked) = (0, 0, usize::MAX);
    for seed in 0..20 {
        let (ticks, _) = both_stuck(&parking(), seed);
        let parked = ticks.iter().position(is_parked).unwrap();
        assert!(ticks[parked..].iter().all(is_parked), "seed {seed}: it does not stay");
        (longest, latest) = (longest.max(stood(&ticks[..parked])), latest.max(parked));
        unparked = unparked.min(stood(&both_stuck(&RigConfig::report(), seed).0));
    }
    println!(
        "both switches stuck: light within 1 mm for {longest} ms at most, parked after {latest} ms; unparked {unparked} ms of 2000"
    );
    assert!(longest <= 60 && latest <= 1000, "{longest} ms, {latest} ms");
    assert!(unparked > 1500, "it is held where it was: {unparked} ms");
}

/// Armed or not: light that nobody asked for is a fault, from the tick on in which both switches must have opened.
#[test]
fn light_that_goes_on_after_somebody_disarmed_is_a_fault_and_parks() {
    let config = parking();
    let plan = plan_of(&config, circle(0.2));
    let when = lit_ticks(&plan)[500];
    let ticks = run_with(&config, &plan, (3, when + 1500), |rig, at| {
        if at == when {
            rig.suffer(Trouble::LaserStuck);
            rig.suffer(Trouble::EnableStuck);
            rig.send(Command::Disarm).unwrap();
        }
    });
    assert_eq!(ticks[when].telemetry.phase, Phase::Dark);
    // the relay's 3 ms, 2 of slack
    let (seen, fault) = first_fault(&ticks).unwrap();
    assert_eq!(fault, Fault::LaserStuck);
    assert!(seen - when <= 6, "{}", seen - when);
    let last = ticks.last().unwrap();
    assert!(
        Joint::BOTH.iter().all(|&j| (last.angle_rad[j] - PARK_RAD[j]).abs() < 5e-3),
        "{:?}",
        last.angle_rad
    );
}

#[test]
fn what_was_stuck_is_tried_again_before_the_job_goes_on() {
    let config = parking();
    let plan = plan_of(&config, circle(0.2));
    let when = lit_ticks(&plan)[500];
    let mut dark = None;
    let mut rig = SimulatedRig::new(&config, POSE, 5);
    let mut feeder = Feeder::new(plan.segments.as_slice(), false);
    rig.send(Command::KeepAlive).unwrap();
    rig.send(Command::Arm { acknowledges: 0 }).unwrap();
    let mut ticks: Vec<Tick> = Vec::new();
    while ticks.len() < 30_000 && ticks.last().is_none_or(|t| t.telemetry.phase != Phase::Done) {
        feeder.feed(&mut rig);
        // the gate's switch does not open, and is then mended
        if ticks.len() == when {
            rig.suffer(Trouble::LaserStuck);
            rig.send(Command::Disarm).unwrap();
        }
        let tick = alive(&mut rig);
        ticks.push(tick);
        let (now, at) = (tick.telemetry, ticks.len());
        dark = dark.or(now.fault().map(|_| at));
        if dark.is_some_and(|dark| at == dark + 800) {
            rig.suffer(Trouble::LaserMended);
        }
        if dark.is_some_and(|dark| at == dark + 1000) {
            rig.send(Command::Arm { acknowledges: now.fault_number }).unwrap();
        }
    }
    let armed = dark.unwrap() + 1000;
    assert_eq!(told(&ticks[armed..], true, false), 8, "tried once more");
    let again = armed + ticks[armed..].iter().position(|t| t.telemetry.actuation.lights()).unwrap();
    assert_eq!(told(&ticks[again..], true, false), 0);
    assert!(ticks[armed..again].iter().all(|t| !t.light));
    assert_eq!(ticks.last().map(|t| (t.telemetry.phase, t.telemetry.fault())), Some((Phase::Done, None)));
}
