//! What happens every tick.

use tracelight_control::{AxisConfig, Config, Controller, State};
use tracelight_rig::wire::{Ask, Configured, Order, Row, RowBytes, as_told, is_before};
use tracelight_rig::{Actuation, Command, FaultRecord, Joint, PanTilt, Phase, Sensed, Telemetry};

use crate::configuration::{MOST_CONFIGURATION, read_configuration, write_configuration};
use crate::start::Start;

/// Orders that are taken before a tick at most: each takes some of its time.
pub const MOST_ORDERS_A_TICK: u8 = 8;

/// So far ahead of the last one the number of an Arm may be.
const MOST_NONCES: u32 = 1 << 16;

/// What came for a tick, beside orders.
#[derive(Clone, Copy, Debug, Default)]
pub struct Inbox {
    /// A keep-alive.
    pub heard: bool,
    /// A Disarm.
    pub disarm: Option<Disarm>,
}

/// A Disarm that came.
#[derive(Clone, Copy, Debug)]
pub struct Disarm {
    /// Of the orders before that number those that let light out are void if they come later.
    pub before: u16,
    /// Its own number.
    pub number: u16,
}

/// A configuration that is to be in force.
#[derive(Clone, Copy, Debug)]
pub struct NewConfiguration {
    /// What the controller is told.
    pub config: Config,
    /// Whether the encoders know where they are.
    pub is_absolute: bool,
    /// Its checksum.
    pub crc: u32,
    /// Hash of its law.
    pub law: u32,
}

/// What orders may be taken now.
#[derive(Clone, Copy, Debug)]
pub struct May {
    /// A segment.
    pub append: bool,
    /// One that lets light out.
    pub light: bool,
}

/// What a tick was, for the host.
#[derive(Clone, Copy, Debug)]
pub struct Told {
    /// Number of the tick since power-up.
    pub tick: u32,
    /// All that a host needs to do it again.
    pub row: RowBytes,
    /// Segments that there is room for.
    pub free: u16,
    /// Supervisor's state.
    pub phase: Phase,
    /// The latched fault.
    pub latched: Option<FaultRecord>,
    /// How many faults were latched since power-up.
    pub fault_number: u32,
    /// Number of the Disarm that acted before this tick, if one did.
    pub disarm: Option<u16>,
    /// In the first tick of a configuration: what the host is told of it.
    pub began: Option<Configured>,
}

/// The controller, and which orders it takes.
#[derive(Clone, Debug)]
pub struct Machine<const SEGMENTS: usize> {
    running: Option<(Controller, State<SEGMENTS>)>,
    /// Ticks since power-up.
    tick: u32,
    /// Number of the last Arm that was taken.
    nonce: u32,
    /// Orders before it that let light out are void.
    void_before: Option<u16>,
}

impl<const SEGMENTS: usize> Machine<SEGMENTS> {
    /// At power-up.
    pub const fn new() -> Self {
        Self { running: None, tick: 0, nonce: 0, void_before: None }
    }

    /// Number of the tick that comes next.
    pub const fn tick_number(&self) -> u32 {
        self.tick
    }

    /// Number of the last Arm that was taken.
    pub const fn nonce(&self) -> u32 {
        self.nonce
    }

    /// What the controller remembers; `None` without a configuration.
    pub fn state(&self) -> Option<&State<SEGMENTS>> {
        self.running.as_ref().map(|(_, state)| state)
    }

    /// Volts that are all that an amplifier gives, as it was configured; `None` before that.
    pub fn limit_v(&self) -> Option<PanTilt<f32>> {
        // what a law asks for comes after the dead band
        let most = |axis: AxisConfig| axis.limit_v + axis.dead_band_v;
        self.running.as_ref().map(|(controller, _)| controller.config().axes.map(most))
    }

    /// Turns a bit of the configuration in force into the other, as a memory fault does: word, counted from 0, and bit. False if there is none, or if that
    /// makes a value that no configuration may have.
    pub fn spoil(&mut self, word: usize, bit: u32) -> bool {
        let Some((controller, _)) = &mut self.running else { return false };
        let mut bytes = [0; MOST_CONFIGURATION];
        let spoilt = write_configuration(controller.config(), &mut bytes).and_then(|length| {
            let at = 4 * word + bit as usize / 8;
            *bytes.get_mut(at).filter(|_| at < length)? ^= 1 << (bit % 8);
            read_configuration(bytes.get(..length)?).ok()
        });
        if let Some(config) = spoilt {
            *controller = Controller::new(config);
        }
        spoilt.is_some()
    }

    /// One tick: begins anew with a configuration if there is one, takes what came, `next` order by order, and lets the controller run. `next` is told what it may
    /// give: a segment only if there is room for one, and one order a tick that lets light out. Without a configuration nothing moves and nothing is lit, and there is nothing to tell.
    pub fn tick(
        &mut self,
        sensed: &Sensed,
        (new, inbox): (Option<&NewConfiguration>, &Inbox),
        mut next: impl FnMut(May) -> Option<Order>,
    ) -> (Actuation, Option<Told>) {
        let tick = self.tick;
        self.tick = tick.wrapping_add(1);
        let sensed = as_told(sensed);
        let began = new.map(|new| self.begin(new, &sensed, tick));
        let Some((controller, state)) = &mut self.running else { return (Actuation::default(), None) };
        if inbox.heard {
            // none of what is taken here can fail for want of room
            let _ = controller.accept(state, Command::KeepAlive);
        }
        let (mut taken, mut void, mut may_light) = (0, false, true);
        while taken < MOST_ORDERS_A_TICK
            && let Some(order) = next(May { append: state.room() > 0, light: may_light })
        {
            taken += 1;
            // one a tick, so that a row tells whether it was void
            may_light &= !order.ask.lights();
            self.void_before = self.void_before.filter(|&before| is_before(order.sequence, before));
            if order.ask.lights() && self.void_before.is_some() {
                void = true;
            } else {
                void |= !obey(controller, state, order.ask, &mut self.nonce);
            }
        }
        if let Some(Disarm { before, .. }) = inbox.disarm {
            let _ = controller.accept(state, Command::Disarm);
            self.void_before = Some(before);
        }
        let telemetry = controller.tick(state, &sensed);
        let row = row(&sensed, &telemetry, (taken, void), inbox);
        let free = u16::try_from(state.room()).unwrap_or(u16::MAX);
        let Telemetry { actuation, phase, latched, fault_number, .. } = telemetry;
        let disarm = inbox.disarm.map(|disarm| disarm.number);
        (actuation, Some(Told { tick, row: row.told(), free, phase, latched, fault_number, disarm, began }))
    }

    /// Begins with the first configuration since the board started.
    #[inline(never)]
    #[cold]
    fn begin_first(&mut self, controller: Controller, start: &Start, sensed: &Sensed) {
        let (_, state) = self.running.insert((controller, controller.start(sensed)));
        start.apply(&controller, state);
    }

    /// Begins anew with a configuration. A head that was homed is told where it stands, if it is held to be where it was; what is known of motors and light is kept.
    // its state, which is large, is not to lie in the stack of every tick
    #[inline(never)]
    fn begin(&mut self, new: &NewConfiguration, sensed: &Sensed, tick: u32) -> Configured {
        let &NewConfiguration { config, is_absolute, crc, law } = new;
        let before = self.state();
        let is_alike =
            self.running.as_ref().is_some_and(|(before, _)| counts_alike(before.config(), &config));
        let home = before.filter(|_| is_alike && !is_absolute).and_then(|state| state.homed_at(sensed));
        let carried = before.map(State::carried);
        let controller = Controller::new(config);
        let start = Start { tick, is_absolute, home, carried };
        match &mut self.running {
            Some((running, state)) => {
                *running = controller;
                start.renew(&controller, sensed, state);
            }
            None => self.begin_first(controller, &start, sensed),
        }
        let home = home.filter(|_| self.state().is_some_and(State::is_homed));
        self.void_before = None;
        let shut_ticks = carried.map_or(u32::MAX, |carried| carried.shut_ticks);
        Configured { crc, tick, law, home, heat: carried.map(|carried| carried.heat), shut_ticks }
    }
}

/// Whether counts mean the same angles by both configurations, so that a head that was homed by one is by the other.
fn counts_alike(before: &Config, after: &Config) -> bool {
    let is_alike = |j: Joint| before.axes[j].count_rad == after.axes[j].count_rad;
    before.drive.is_open_loop() == after.drive.is_open_loop() && is_alike(Joint::Pan) && is_alike(Joint::Tilt)
}

impl<const SEGMENTS: usize> Default for Machine<SEGMENTS> {
    fn default() -> Self {
        Self::new()
    }
}

/// Does what an order asks; false if it is an Arm with a number that is not greater than all before it.
fn obey<const SEGMENTS: usize>(
    controller: &Controller,
    state: &mut State<SEGMENTS>,
    ask: Ask,
    last_nonce: &mut u32,
) -> bool {
    if let Ask::Arm { nonce, .. } = ask {
        // nor is one that is far ahead: it would leave none for those that come
        if nonce <= *last_nonce || nonce - *last_nonce > MOST_NONCES {
            return false;
        }
        *last_nonce = nonce;
    }
    // a head that cannot be homed now says so by not being homed
    let _ = controller.accept(state, ask.command());
    true
}

fn row(sensed: &Sensed, telemetry: &Telemetry, (taken, void): (u8, bool), inbox: &Inbox) -> Row {
    Row {
        sensed: *sensed,
        plan_tick: telemetry.plan_tick,
        actuation: telemetry.actuation,
        darkness: telemetry.darkness,
        phase: telemetry.phase,
        fault: telemetry.fault(),
        homed: telemetry.homed,
        taken,
        void,
        heard: inbox.heard,
        disarmed: inbox.disarm.is_some(),
    }
}
