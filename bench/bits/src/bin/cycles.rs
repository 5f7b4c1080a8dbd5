//! Counts cycles that a tick takes, for an emulated RP2350 (`bench/bits/cycles`), which reads them in memory.

#![no_std]
#![no_main]

use core::sync::atomic::{AtomicU32, Ordering::Relaxed};

use cortex_m::peripheral::DWT;
use panic_semihosting as _;
use tracelight_bench_bits::{Load, Meter, run_metered};

/// Ticks as they come, and ticks that are made dear.
const USUAL_TICKS: u32 = 10_000;
const DEAR_TICKS: u32 = 10_000;

/// Of each load: ticks, mean and most cycles of a tick; then the hash of the usual one, low and high, and 1 once all is there.
#[unsafe(no_mangle)]
static FIGURES: [AtomicU32; 9] = [const { AtomicU32::new(0) }; 9];

#[derive(Default)]
struct Cycles {
    begun: u32,
    ticks: u32,
    sum: u64,
    most: u32,
}

impl Meter for Cycles {
    fn begin(&mut self) {
        self.begun = DWT::cycle_count();
    }

    fn tick(&mut self) {
        let cycles = DWT::cycle_count().wrapping_sub(self.begun);
        self.ticks += 1;
        self.sum += u64::from(cycles);
        self.most = self.most.max(cycles);
    }
}

#[cortex_m_rt::entry]
fn main() -> ! {
    if let Some(mut core) = cortex_m::Peripherals::take() {
        core.DCB.enable_trace();
        core.DWT.enable_cycle_counter();
    }
    let mut figures = FIGURES.iter();
    let mut tell = |figure: u32| figures.next().iter().for_each(|place| place.store(figure, Relaxed));
    let mut hash = 0;
    for (ticks, load) in [(USUAL_TICKS, Load::Usual), (DEAR_TICKS, Load::Dearest)] {
        let mut cycles = Cycles::default();
        let outcome = run_metered(ticks, load, &mut cycles);
        if load == Load::Usual {
            hash = outcome.hash;
        }
        let mean = cycles.sum.checked_div(cycles.ticks.into()).unwrap_or_default();
        [cycles.ticks, mean as u32, cycles.most].into_iter().for_each(&mut tell);
    }
    [hash as u32, (hash >> 32) as u32, 1].into_iter().for_each(&mut tell);
    loop {
        core::hint::spin_loop();
    }
}
