//! Prints the hash as this machine computes it.

#![allow(clippy::print_stdout, reason = "that is what it is for")]

fn main() {
    println!("{:016x}", tracelight_bench_bits::run(tracelight_bench_bits::TICKS).hash);
}
