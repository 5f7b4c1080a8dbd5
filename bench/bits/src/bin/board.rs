//! Prints the hash as an emulated Cortex-M33 computes it, and ends the emulator.

#![no_std]
#![no_main]

use cortex_m_semihosting::{debug, hprintln};
use panic_semihosting as _;

#[cortex_m_rt::entry]
fn main() -> ! {
    hprintln!("{:016x}", tracelight_bench_bits::run(tracelight_bench_bits::TICKS).hash);
    debug::exit(debug::EXIT_SUCCESS);
    loop {
        core::hint::spin_loop();
    }
}
