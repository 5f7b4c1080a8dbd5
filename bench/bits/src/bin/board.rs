//! Prints the hash as an emulated Cortex-M33 computes it, then how many instructions its ticks take, and ends the emulator.
//!
//! QEMU counts instructions as time where it is started with `-icount shift=10`: each takes 1024 ns, and SysTick counts at 20 MHz.

#![no_std]
#![no_main]

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_semihosting::{debug, hprintln};
use panic_semihosting as _;
use tracelight_bench_bits::{Load, Meter, TICKS, run_metered};

/// Ticks that are made dear.
const DEAR_TICKS: u32 = 20_000;
/// SysTick wraps there.
const WRAP: u32 = 0x00ff_ffff;

/// Instructions from a call to its return: those that read the counter are among them.
struct Count {
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
    fn new() -> Self {
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

#[cortex_m_rt::entry]
fn main() -> ! {
    if let Some(mut peripherals) = cortex_m::Peripherals::take() {
        let clock = &mut peripherals.SYST;
        clock.set_clock_source(SystClkSource::Core);
        clock.set_reload(WRAP);
        clock.clear_current();
        clock.enable_counter();
    }
    let (mut usual, mut dear) = (Count::new(), Count::new());
    let outcome = run_metered(TICKS, Load::Usual, &mut usual);
    hprintln!("{:016x}", outcome.hash);
    run_metered(DEAR_TICKS, Load::Dearest, &mut dear);
    for (name, count) in [("usual", &usual), ("dearest", &dear)] {
        let Count { ticks, appends, .. } = count;
        hprintln!("{} tick_mean {} tick_most {} append_most {}", name, ticks.mean(), ticks.most, appends.most);
    }
    debug::exit(debug::EXIT_SUCCESS);
    loop {
        core::hint::spin_loop();
    }
}
