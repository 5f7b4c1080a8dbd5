use tracelight_board::Start;
use tracelight_control::{Config, Controller, State};
use tracelight_rig::wire::{Order, Row};
use tracelight_rig::{Command, Phase, Telemetry};

use crate::trouble::{Divergence, Trouble};

/// Segments that a board may hold ahead.
pub(crate) const MOST_SEGMENTS: usize = 1024;

/// The host's own controller, which does what the board's did.
#[derive(Clone, Debug)]
pub struct Twin {
    controller: Controller,
    start: Start,
    state: Option<Box<State<MOST_SEGMENTS>>>,
}

impl Twin {
    /// Of a board that begins so with a configuration.
    pub(crate) const fn new(config: Config, start: Start) -> Self {
        Self { controller: Controller::new(config), start, state: None }
    }

    /// The controller's configuration is the board's; so is its state, once a row was followed.
    pub fn state(&self) -> Option<&State<MOST_SEGMENTS>> {
        self.state.as_deref()
    }

    /// In how many dark ticks the board may light again where it did not yet, as far as is known.
    pub(crate) fn opens_in_ticks(&self) -> u32 {
        self.state().map_or(0, |state| state.opens_in_ticks(self.controller.config()))
    }

    /// Whether the board is disarmed, as far as is known, and no dot is wanted.
    pub(crate) fn is_off(&self, told: &Telemetry) -> bool {
        told.phase == Phase::Dark && self.state().is_some_and(|state| !state.is_pointing())
    }

    /// Whether a command would be refused by what is known of the board now, and then is.
    pub(crate) fn refuses(&self, command: Command) -> bool {
        self.state().is_some_and(|state| self.controller.accept(&mut state.clone(), command).is_err())
    }

    /// Does a tick as the board did it, which took these orders.
    ///
    /// # Errors
    /// Where it does not come to the same.
    pub(crate) fn follow(&mut self, tick: u32, row: &Row, orders: &[Order]) -> Result<Telemetry, Trouble> {
        let Self { controller, start, state } = self;
        let state = state.get_or_insert_with(|| Box::new(start.state(controller, &row.sensed)));
        // what the board refuses is refused here, too
        if row.heard {
            let _ = controller.accept(state, Command::KeepAlive);
        }
        // one a tick lets light out
        for order in orders.iter().filter(|order| !(row.void && order.ask.lights())) {
            let _ = controller.accept(state, order.ask.command());
        }
        if row.disarmed {
            let _ = controller.accept(state, Command::Disarm);
        }
        let told = controller.tick(state, &row.sensed);
        differs(tick, row, &told).map_or(Ok(told), |difference| Err(Trouble::Diverged(difference)))
    }
}

/// The first thing in which a board's tick is not as here, if any.
fn differs(tick: u32, row: &Row, told: &Telemetry) -> Option<Divergence> {
    let flag = |is: bool| f64::from(u8::from(is));
    let (theirs, ours) = (&row.actuation, &told.actuation);
    // the bits count: a zero that is negative is another one
    let differs_in_bits = |a: f32, b: f32| a.to_bits() != b.to_bits();
    let volts = |what, here: f32, there: f32| (what, differs_in_bits(here, there), here.into(), there.into());
    let fault =
        |fault: Option<tracelight_rig::Fault>| f64::from(fault.map_or(0, tracelight_rig::Fault::number));
    let numbers = [
        volts("pan_v", ours.command_v.pan, theirs.command_v.pan),
        volts("tilt_v", ours.command_v.tilt, theirs.command_v.tilt),
        ("gate", ours.gate != theirs.gate, flag(ours.gate), flag(theirs.gate)),
        ("enable", ours.enable != theirs.enable, flag(ours.enable), flag(theirs.enable)),
        ("darkness", told.darkness != row.darkness, told.darkness.bits().into(), row.darkness.bits().into()),
        ("phase", told.phase != row.phase, f64::from(told.phase as u8), f64::from(row.phase as u8)),
        ("fault", told.fault() != row.fault, fault(told.fault()), fault(row.fault)),
        ("homed", told.homed != row.homed, flag(told.homed), flag(row.homed)),
        ("plan_tick", told.plan_tick != row.plan_tick, told.plan_tick.into(), row.plan_tick.into()),
        ("tick", told.tick != tick, told.tick.into(), tick.into()),
    ];
    let (what, _, host, board) = numbers.into_iter().find(|(_, is_other, ..)| *is_other)?;
    Some(Divergence { tick, what, host, board })
}
