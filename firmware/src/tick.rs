//! What the timer's interrupts do: four looks at the switches a tick, and the tick.

use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicU8, AtomicU32, Ordering::Relaxed};

use embassy_rp::gpio::{Input, Output};
use embassy_rp::interrupt::{self, InterruptExt as _, Priority};
#[cfg(feature = "double")]
use embassy_rp::interrupt::{PWM_IRQ_WRAP as LOOK, TIMER_IRQ_0 as CLOCK};
#[cfg(feature = "pico-2")]
use embassy_rp::interrupt::{PWM_IRQ_WRAP_0 as LOOK, TIMER0_IRQ_0 as CLOCK};
use embassy_rp::pac;
#[cfg(feature = "double")]
use embassy_rp::pac::TIMER;
#[cfg(feature = "pico-2")]
use embassy_rp::pac::TIMER0 as TIMER;
use embassy_rp::watchdog::Watchdog;
use embassy_time::Duration;
use tracelight_board::Ticker;
use tracelight_board::lines::Switches;
use tracelight_rig::Inputs;

use crate::SEGMENTS;
use crate::head::Head;

/// Looks a tick, and their rate.
const LOOKS: u32 = 4;
const LOOK_HZ: u32 = 4_000;
const LOOK_US: u32 = 1_000_000 / LOOK_HZ;
/// By so much the clock that counts µs may be behind that of the looks.
const EARLY_US: u32 = 2;
/// Their slice; its pins are none of its.
const SLICE: usize = 7;
/// The chip starts anew if nobody feeds it for so long.
const HUNG: Duration = Duration::from_millis(20);
/// Ticks for which the lamp is on, and off.
const LAMP_TICKS: u32 = 500;

/// What a look needs.
pub struct Looking {
    /// Lines that are high when they say stop, in the order of [`tracelight_board::lines::INPUTS`].
    pub stops: [Input<'static>; 5],
    pub switches: Switches,
    /// Looks since the beginning.
    pub looks: u32,
    /// When the last one was due, µs.
    pub due_us: u32,
}

/// What a tick needs.
pub struct Ticking {
    pub ticker: Ticker<'static, SEGMENTS>,
    pub head: Head,
    /// Which safety inputs there are.
    pub inputs: Inputs,
    /// A square wave as long as it ticks: without it, other hardware shuts the gate.
    pub heartbeat: Output<'static>,
    pub lamp: Output<'static>,
    pub watchdog: Watchdog,
    /// When the last one began, µs.
    pub last_us: u32,
}

/// Something that one interrupt has for itself once it is there.
struct Own<T>(UnsafeCell<Option<T>>);

// SAFETY: written before the interrupt is unmasked, used by it alone from then on, and no interrupt interrupts itself
unsafe impl<T> Sync for Own<T> {}

static LOOKING: Own<Looking> = Own(UnsafeCell::new(None));
static TICKING: Own<Ticking> = Own(UnsafeCell::new(None));
/// What a look leaves for the tick that it begins: switches that are open, cycles since the encoders began, µs.
static OPEN: AtomicU8 = AtomicU8::new(0);
static CYCLES: AtomicU32 = AtomicU32::new(0);
static BEGAN_US: AtomicU32 = AtomicU32::new(0);

/// The clock, µs.
pub fn now_us() -> u32 {
    TIMER.timerawl().read()
}

/// Cycles between two looks.
fn look_cycles() -> u32 {
    embassy_rp::clocks::clk_sys_freq() / LOOK_HZ
}

/// Begins to look and to tick. `begin_encoders` is called at the same time.
pub fn start(looking: Looking, mut ticking: Ticking, begin_encoders: impl FnOnce()) {
    let slice = pac::PWM.ch(SLICE);
    slice.top().write(|w| w.set_top((look_cycles() - 1) as u16));
    ticking.watchdog.start(HUNG);
    // SAFETY: neither interrupt is unmasked yet
    unsafe {
        *LOOKING.0.get() = Some(looking);
        *TICKING.0.get() = Some(ticking);
    }
    LOOK.set_priority(Priority::P0);
    interrupt::SWI_IRQ_0.set_priority(Priority::P1);
    CLOCK.set_priority(Priority::P3);
    interrupt::USBCTRL_IRQ.set_priority(Priority::P3);
    #[cfg(feature = "pico-2")]
    pac::PWM.irq0_inte().modify(|w| w.set_ch7(true));
    #[cfg(feature = "double")]
    pac::PWM.inte().modify(|w| w.set_ch7(true));
    // SAFETY: what they use is there
    unsafe {
        LOOK.enable();
        interrupt::SWI_IRQ_0.enable();
    }
    cortex_m::interrupt::free(|_| {
        begin_encoders();
        slice.csr().write(|w| w.set_en(true));
        // SAFETY: the interrupt is masked here
        if let Some(looking) = unsafe { &mut *LOOKING.0.get() } {
            looking.due_us = now_us();
        }
    });
}

/// Looks at the switches, and has every fourth look begin a tick.
// SAFETY: nothing else has the name of that interrupt
#[cfg_attr(feature = "pico-2", unsafe(export_name = "PWM_IRQ_WRAP_0"))]
#[cfg_attr(feature = "double", unsafe(export_name = "PWM_IRQ_WRAP"))]
extern "C" fn look() {
    pac::PWM.intr().write(|w| w.set_ch7(true));
    // SAFETY: this interrupt's own
    let Some(looking) = (unsafe { &mut *LOOKING.0.get() }) else { return };
    let now_us = now_us();
    // looks are late, never early; one that was held up until after the next counts for both
    let passed = (now_us.wrapping_sub(looking.due_us) + EARLY_US) / LOOK_US;
    let before = looking.looks;
    looking.looks = before.wrapping_add(passed);
    looking.due_us = looking.due_us.wrapping_add(passed * LOOK_US);
    let open = (0..).zip(&looking.stops).fold(0, |open, (bit, line)| open | u8::from(line.is_high()) << bit);
    looking.switches.look(open);
    if before / LOOKS != looking.looks / LOOKS {
        OPEN.store(looking.switches.take(), Relaxed);
        CYCLES.store((looking.looks / LOOKS * LOOKS).wrapping_mul(look_cycles()), Relaxed);
        BEGAN_US.store(now_us, Relaxed);
        interrupt::SWI_IRQ_0.pend();
    }
}

#[embassy_rp::interrupt]
fn SWI_IRQ_0() {
    // SAFETY: this interrupt's own
    let Some(ticking) = (unsafe { &mut *TICKING.0.get() }) else { return };
    let Ticking { ticker, head, inputs, heartbeat, lamp, watchdog, last_us } = ticking;
    let began_us = BEGAN_US.load(Relaxed);
    let mut sensed = head.sensed(CYCLES.load(Relaxed), LOOKS * look_cycles());
    sensed.inputs = inputs.opened_by(OPEN.load(Relaxed));
    let lasted_us = began_us.wrapping_sub(core::mem::replace(last_us, began_us));
    sensed.lasted_ticks = Some(lasted_us as f32 * 1e-3);
    let done = ticker.tick(&sensed, began_us);
    head.apply(&done);
    if done.is_well {
        watchdog.feed(HUNG);
    }
    heartbeat.toggle();
    lamp.set_level((ticker.machine().tick_number() / LAMP_TICKS).is_multiple_of(2).into());
}
