//! Prints the hashes as this machine computes them: of the controller, and of all that a board says; with a number of ticks that of the controller alone.

#![allow(clippy::print_stdout, reason = "that is what it is for")]

use tracelight_bench_bits::{Firmware, IDENTITY, TICKS, WIRED_TICKS, run, run_wired};

fn main() {
    if let Some(ticks) = std::env::args().nth(1).and_then(|text| text.parse().ok()) {
        println!("{:016x}", run(ticks).hash);
        return;
    }
    let mut board = Box::new(Firmware::new(IDENTITY));
    println!("{:016x} {:016x}", run(TICKS).hash, run_wired(&mut board, WIRED_TICKS, &mut ()));
}
