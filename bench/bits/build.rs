//! Tells the linker where the emulated boards have their memory: QEMU's `mps2-an505`, a Cortex-M33, and `mps2-an386`, a Cortex-M4F; an RP2350.

#![allow(clippy::unwrap_used, reason = "a build that cannot go on may panic")]

use std::path::PathBuf;

const M33: &str =
    "MEMORY { FLASH : ORIGIN = 0x10000000, LENGTH = 512K\n RAM : ORIGIN = 0x38000000, LENGTH = 512K }";
const M4F: &str =
    "MEMORY { FLASH : ORIGIN = 0x00000000, LENGTH = 4M\n RAM : ORIGIN = 0x20000000, LENGTH = 4M }";

const PICO: &str =
    "MEMORY { FLASH : ORIGIN = 0x10000000, LENGTH = 4M\n RAM : ORIGIN = 0x20000000, LENGTH = 512K }";

fn main() {
    if std::env::var_os("CARGO_FEATURE_BOARD").is_none() {
        return;
    }
    let out = PathBuf::from(std::env::var_os("OUT_DIR").unwrap());
    let is_m4f = std::env::var("TARGET").is_ok_and(|target| target.starts_with("thumbv7em"));
    let is_pico = std::env::var_os("CARGO_FEATURE_PICO").is_some();
    let memory = match (is_pico, is_m4f) {
        (true, _) => PICO,
        (false, true) => M4F,
        (false, false) => M33,
    };
    std::fs::write(out.join("memory.x"), memory).unwrap();
    println!("cargo:rustc-link-search={}", out.display());
    for board in ["board", "wired", "cycles"] {
        println!("cargo:rustc-link-arg-bin={board}=--nmagic");
        println!("cargo:rustc-link-arg-bin={board}=-Tlink.x");
    }
}
