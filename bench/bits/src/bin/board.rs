//! Prints the hash as an emulated Cortex-M33 computes it, then how many instructions its ticks take, and ends the emulator.
//!
//! QEMU counts instructions as time where it is started with `-icount shift=10`: each takes 1024 ns, and SysTick counts at 20 MHz.

#![no_std]
#![no_main]

#[path = "../count.rs"]
mod count;

use cortex_m_semihosting::{debug, hprintln};
use panic_semihosting as _;
use tracelight_bench_bits::{Load, TICKS, run_metered};

use count::{Count, start_clock};

/// Ticks that are made dear.
const DEAR_TICKS: u32 = 20_000;
#[cortex_m_rt::entry]
fn main() -> ! {
    start_clock();
    let (mut usual, mut dear) = (Count::new(), Count::new());
    let outcome = run_metered(TICKS, Load::Usual, &mut usual);
    hprintln!("{:016x}", outcome.hash);
    run_metered(DEAR_TICKS, Load::Dearest, &mut dear);
    for (name, count) in [("usual", &usual), ("dearest", &dear)] {
        hprintln!("{} {}", name, count);
    }
    debug::exit(debug::EXIT_SUCCESS);
    loop {
        core::hint::spin_loop();
    }
}
