//! The controller of a head on a board without a law, which runs ahead of what the board has done.
//!
//! Its ticks are told to the board as moves before they are due, and kept until the board has done them. If it is halted on its way, the controller goes back
//! to the tick up to which it came: nothing counts as done that was only sent.

use std::collections::VecDeque;

use tracelight_control::{Carried, Controller, State};
use tracelight_rig::{Command, Measurement, PanTilt, Sensed, Telemetry};

use crate::axis::BoardAxis;
use crate::moves::{Builder, Item, Point};

/// With less of a plan than this, ticks, the controller waits for more.
const FEW_TICKS: u32 = 40;
/// Ticks that are done and kept: a board may turn out to be behind what was thought.
const MOST_PAST: usize = 200;
/// Commands that wait until the controller has room for them.
const MOST_WAITING: usize = 8;

/// The head as the controller and the board count it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gear {
    pub(crate) axes: PanTilt<BoardAxis>,
    /// A step, rad.
    pub(crate) step_rad: PanTilt<f64>,
    /// Furthest that the lit spot may be from where it is told to be, rad.
    pub(crate) lit_rad: f64,
}

impl Gear {
    /// Steps of an axis for the counts of its joint.
    fn steps(&self, counts: PanTilt<f64>) -> PanTilt<f64> {
        PanTilt::from_fn(|j| self.axes[j].sign() * counts[j])
    }

    fn counts(&self, steps: PanTilt<i64>) -> PanTilt<i32> {
        PanTilt::from_fn(|j| (self.axes[j].sign() * steps[j] as f64) as i32)
    }
}

/// A tick that was told.
#[derive(Clone, Debug)]
struct Tick {
    telemetry: Telemetry,
    /// Where it begins, in steps.
    at: PanTilt<f64>,
    after: Kept,
}

/// The controller after a tick, and what it was told since.
#[derive(Clone, Debug)]
struct Kept {
    state: Box<State>,
    since: Vec<Command>,
}

#[derive(Clone, Debug)]
pub(crate) struct Teller {
    controller: Controller,
    gear: Gear,
    state: Box<State>,
    sensed: Sensed,
    builder: Builder,
    /// In order: some that are done, then those that are not.
    told: VecDeque<Tick>,
    done: usize,
    /// Before the first of them.
    before: Kept,
    waiting: VecDeque<Command>,
    tick: u32,
}

impl Teller {
    /// Of a head that rests at these steps of its axes, which are that many counts of the joints if it is known where it points, and has been dark for so long, ticks.
    pub(crate) fn new(
        controller: Controller,
        gear: Gear,
        at: PanTilt<i64>,
        homed: Option<PanTilt<i32>>,
        shut_ticks: u32,
    ) -> Self {
        let sensed = sensed(gear.counts(at));
        let mut state = Box::new(controller.start(&sensed));
        controller.carry(&mut state, &Carried { shut_ticks, ..Carried::default() });
        if let Some(counts) = homed {
            // taken of a head that rests
            let _ = controller.accept(&mut state, Command::Home(counts));
        }
        let builder = Builder::new(at, 0, gear.step_rad, gear.lit_rad);
        let before = Kept { state: state.clone(), since: Vec::new() };
        Self {
            controller,
            gear,
            state,
            sensed,
            builder,
            told: VecDeque::new(),
            done: 0,
            before,
            waiting: VecDeque::new(),
            tick: 0,
        }
    }

    pub(crate) const fn state(&self) -> &State {
        &self.state
    }

    pub(crate) const fn controller(&self) -> &Controller {
        &self.controller
    }

    /// Whether all that was told is done, and nothing moves.
    pub(crate) fn is_still(&self) -> bool {
        self.ahead() == 0 && self.builder.pending() == 0
    }

    /// Ticks that were told and are not done.
    pub(crate) fn ahead(&self) -> usize {
        self.told.len() - self.done
    }

    /// The tick that is told next.
    pub(crate) const fn next(&self) -> u32 {
        self.tick
    }

    /// The first tick that is in no move yet.
    pub(crate) fn settled(&self) -> u32 {
        self.tick.wrapping_sub(1).wrapping_sub(self.builder.pending() as u32)
    }

    /// Whether it would better wait for more of the plan before it goes on.
    pub(crate) fn is_short(&self) -> bool {
        !self.state.has_ahead(FEW_TICKS) && !self.state.is_pointing()
    }

    pub(crate) fn accept(&mut self, command: Command) -> Result<(), Command> {
        if is_of_plan(command) && !self.waiting.is_empty() {
            if self.waiting.len() >= MOST_WAITING {
                return Err(command);
            }
            self.waiting.push_back(command);
            return Ok(());
        }
        self.hand_over(command)
    }

    /// Whoever drives it is there.
    pub(crate) fn hear(&mut self) {
        // always taken
        let _ = self.controller.accept(&mut self.state, Command::KeepAlive);
    }

    fn hand_over(&mut self, command: Command) -> Result<(), Command> {
        self.controller.accept(&mut self.state, command)?;
        if is_of_plan(command) || matches!(command, Command::Speed(_)) {
            self.told.back_mut().map_or(&mut self.before, |tick| &mut tick.after).since.push(command);
        }
        Ok(())
    }

    /// Lets the controller do a tick, by somebody who is there or not, and adds to the items what is settled by that. Whether it moves nothing and lights nothing, and
    /// will not for a while.
    pub(crate) fn tell(&mut self, is_alive: bool, items: &mut VecDeque<Item>) -> bool {
        while let Some(&command) = self.waiting.front() {
            if self.hand_over(command).is_err() {
                break;
            }
            self.waiting.pop_front();
        }
        if is_alive {
            self.hear();
        }
        let telemetry = self.controller.tick(&mut self.state, &self.sensed);
        let at = self.told_at();
        self.sensed.encoders = sensed(self.gear.counts(at.map(|at| at.round() as i64))).encoders;
        let point = Point { at, lit: telemetry.actuation.lights() };
        let tick = self.tick;
        self.tick = tick.wrapping_add(1);
        let after = Kept { state: self.state.clone(), since: Vec::new() };
        self.told.push_back(Tick { telemetry, at, after });
        if self.builder.is_still(&point) {
            self.builder.wait(tick);
            return true;
        }
        self.builder.push(point, items)
    }

    /// Makes items of all that was told. Whether nothing moves and nothing is lit.
    pub(crate) fn settle(&mut self, items: &mut VecDeque<Item>) -> bool {
        self.builder.settle(items)
    }

    /// Where the joints are told to be at the start of the last tick, in steps.
    fn told_at(&self) -> PanTilt<f64> {
        let (told, home) = (self.state.told(), self.state.home());
        let counts = PanTilt::from_fn(|j| {
            f64::from(told[j].position_rad) / self.gear.step_rad[j] - f64::from(home[j])
        });
        self.gear.steps(counts)
    }

    /// Where the joints are told to be at the start of the last tick, whole steps.
    pub(crate) fn raw_steps(&self) -> PanTilt<i64> {
        self.told_at().map(|at| at.round() as i64)
    }

    /// The next tick, if it begins before that one: it is done.
    pub(crate) fn release(&mut self, before: u32) -> Option<Telemetry> {
        let next = self.first().wrapping_add(self.done as u32);
        if before.wrapping_sub(next).cast_signed() <= 0 {
            return None;
        }
        let telemetry = self.told.get(self.done)?.telemetry;
        self.done += 1;
        if self.done > MOST_PAST
            && let Some(tick) = self.told.pop_front()
        {
            self.done -= 1;
            self.before = tick.after;
        }
        Some(telemetry)
    }

    /// The first tick that is kept.
    fn first(&self) -> u32 {
        self.tick.wrapping_sub(self.told.len() as u32)
    }

    /// The last tick that is done.
    pub(crate) fn last_done(&self) -> u32 {
        self.first().wrapping_add(self.done as u32).wrapping_sub(1)
    }

    /// The tick in which the head was at these steps, of those that are known and begin before `until`; of several the one next to `expected`.
    pub(crate) fn tick_at(&self, at: PanTilt<f64>, expected: u32, until: u32) -> u32 {
        let first = self.first();
        let off = |place: &PanTilt<f64>| {
            let of = PanTilt::from_fn(|j| place[j] - at[j]);
            of.pan * of.pan + of.tilt * of.tilt
        };
        let among = || {
            (0_u32..)
                .zip(&self.told)
                .map(|(i, tick)| (first.wrapping_add(i), off(&tick.at)))
                .filter(|(tick, _)| until.wrapping_sub(*tick).cast_signed() > 0)
        };
        let least = among().map(|(_, off)| off.sqrt()).fold(f64::INFINITY, f64::min);
        let near = among().filter(|(_, off)| off.sqrt() <= least + 1.0);
        let away = |tick: u32| expected.wrapping_sub(tick).cast_signed().unsigned_abs();
        near.map(|(tick, _)| tick).min_by_key(|&tick| away(tick)).unwrap_or(expected)
    }

    /// Goes back to the end of a tick, of a head that rests at these steps.
    pub(crate) fn rewind(&mut self, tick: u32, at: PanTilt<i64>) {
        let kept = (tick.wrapping_sub(self.first()).cast_signed() + 1).max(0) as usize;
        let mut rest = std::iter::once(&self.before)
            .chain(self.told.iter().map(|tick| &tick.after))
            .skip(kept.min(self.told.len()));
        let from = rest.next().unwrap_or(&self.before);
        let mut state = from.state.clone();
        // taken once more, before what waits
        let mut since = from.since.clone();
        since.extend(rest.flat_map(|later| &later.since));
        since.extend(self.waiting.drain(..));
        // no tick is told twice
        state.count_from(self.tick);
        self.sensed.encoders = sensed(self.gear.counts(at)).encoders;
        self.builder = Builder::new(at, self.tick.wrapping_sub(1), self.gear.step_rad, self.gear.lit_rad);
        self.before = Kept { state: state.clone(), since: Vec::new() };
        (self.state, self.waiting) = (state, since.into());
        (self.told, self.done) = (VecDeque::new(), 0);
    }
}

/// Whether a command is a part of a plan.
const fn is_of_plan(command: Command) -> bool {
    matches!(command, Command::Append(_) | Command::Finish)
}

/// What a head of these counts senses.
fn sensed(counts: PanTilt<i32>) -> Sensed {
    let encoders = counts.map(|count| Measurement { count, edge_age_ticks: None });
    Sensed { encoders, ..Sensed::default() }
}
