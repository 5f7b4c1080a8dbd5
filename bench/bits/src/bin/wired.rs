//! Prints the hash of all that a board says as an emulated Cortex-M33 computes it, how many instructions its ticks take and how many bytes it keeps, and ends the
//! emulator. See `board`.

#![no_std]
#![no_main]

#[path = "../count.rs"]
mod count;

use cortex_m_semihosting::{debug, hprintln};
use panic_semihosting as _;
use tracelight_bench_bits::{Firmware, IDENTITY, WIRED_TICKS, run_wired};

use count::{Count, start_clock};

#[cortex_m_rt::entry]
fn main() -> ! {
    start_clock();
    let mut count = Count::new();
    let mut board = Firmware::new(IDENTITY);
    let said = run_wired(&mut board, WIRED_TICKS, &mut count);
    hprintln!("{:016x} {} bytes {}", said, count, core::mem::size_of::<Firmware>());
    debug::exit(debug::EXIT_SUCCESS);
    loop {
        core::hint::spin_loop();
    }
}
