//! Tells the linker where the emulated board has its memory: QEMU's `mps2-an505`, a Cortex-M33.

#![allow(clippy::unwrap_used, reason = "a build that cannot go on may panic")]

use std::path::PathBuf;

const MEMORY: &str =
    "MEMORY { FLASH : ORIGIN = 0x10000000, LENGTH = 512K\n RAM : ORIGIN = 0x38000000, LENGTH = 512K }";

fn main() {
    if std::env::var_os("CARGO_FEATURE_BOARD").is_none() {
        return;
    }
    let out = PathBuf::from(std::env::var_os("OUT_DIR").unwrap());
    std::fs::write(out.join("memory.x"), MEMORY).unwrap();
    println!("cargo:rustc-link-search={}", out.display());
    for board in ["board", "wired"] {
        println!("cargo:rustc-link-arg-bin={board}=--nmagic");
        println!("cargo:rustc-link-arg-bin={board}=-Tlink.x");
    }
}
