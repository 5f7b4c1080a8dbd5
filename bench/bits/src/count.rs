//! Counts instructions on an emulated board.

use core::fmt;

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use tracelight_bench_bits::Meter;

/// SysTick wraps there.
const WRAP: u32 = 0x00ff_ffff;

/// Instructions from a call to its return: those that read the counter are among them.
pub(crate) struct Count {
    since: u32,
    ticks: Figures,
    appends: Figures,
}

#[derive(Default)]
struct Figures {
    number: u32,
    sum: u64,
    most: u32,
}

impl Count {
    pub(crate) fn new() -> Self {
        Self { since: 0, ticks: Figures::default(), appends: Figures::default() }
    }

    fn instructions(&self) -> u32 {
        let counted = self.since.wrapping_sub(SYST::get_current()) & WRAP;
        counted * 50 / 1024
    }
}

impl Figures {
    fn add(&mut self, instructions: u32) {
        self.number += 1;
        self.sum += u64::from(instructions);
        self.most = self.most.max(instructions);
    }

    fn mean(&self) -> u64 {
        self.sum / u64::from(self.number.max(1))
    }
}

impl Meter for Count {
    fn begin(&mut self) {
        self.since = SYST::get_current();
    }

    fn tick(&mut self) {
        let instructions = self.instructions();
        self.ticks.add(instructions);
    }

    fn append(&mut self) {
        let instructions = self.instructions();
        self.appends.add(instructions);
    }
}

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { ticks, appends, .. } = self;
        write!(f, "tick_mean {} tick_most {} append_most {}", ticks.mean(), ticks.most, appends.most)
    }
}

/// Lets the counter run.
pub(crate) fn start_clock() {
    if let Some(mut peripherals) = cortex_m::Peripherals::take() {
        let clock = &mut peripherals.SYST;
        clock.set_clock_source(SystClkSource::Core);
        clock.set_reload(WRAP);
        clock.clear_current();
        clock.enable_counter();
    }
}
