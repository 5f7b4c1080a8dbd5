//! The hashes as a browser's tab computes them: the module is built for wasm32, and Node calls [`controller`] and [`board`].

#![no_main]

use tracelight_bench_bits::{Firmware, IDENTITY, TICKS, WIRED_TICKS, run, run_wired};

/// Hash of the controller.
// SAFETY: nothing else of the module has that name
#[unsafe(no_mangle)]
pub extern "C" fn controller() -> u64 {
    run(TICKS).hash
}

/// Hash of all that a board says.
// SAFETY: nothing else of the module has that name
#[unsafe(no_mangle)]
pub extern "C" fn board() -> u64 {
    run_wired(&mut Box::new(Firmware::new(IDENTITY)), WIRED_TICKS, &mut ())
}
