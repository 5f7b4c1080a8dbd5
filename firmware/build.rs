//! Where the linker finds flash and memory, and which source this is.

#![allow(clippy::unwrap_used, reason = "a build that cannot go on may panic")]

use std::path::{Path, PathBuf};

const PICO_2: &str = "\
MEMORY {
    FLASH : ORIGIN = 0x10000000, LENGTH = 4096K
    RAM : ORIGIN = 0x20000000, LENGTH = 512K
}
SECTIONS {
    /* what the boot loader looks for in the first 4 kB */
    .start_block : ALIGN(4) { __start_block_addr = .; KEEP(*(.start_block)); KEEP(*(.boot_info)); } > FLASH
} INSERT AFTER .vector_table;
_stext = ADDR(.start_block) + SIZEOF(.start_block);
SECTIONS {
    .bi_entries : ALIGN(4) { __bi_entries_start = .; KEEP(*(.bi_entries)); . = ALIGN(4); __bi_entries_end = .; } > FLASH
} INSERT AFTER .text;
SECTIONS { .end_block : ALIGN(4) { __end_block_addr = .; KEEP(*(.end_block)); } > FLASH } INSERT AFTER .uninit;
PROVIDE(start_to_end = __end_block_addr - __start_block_addr);
PROVIDE(end_to_start = __start_block_addr - __end_block_addr);
";
const DOUBLE: &str = "\
MEMORY {
    BOOT2 : ORIGIN = 0x10000000, LENGTH = 0x100
    FLASH : ORIGIN = 0x10000100, LENGTH = 2048K - 0x100
    RAM : ORIGIN = 0x20000000, LENGTH = 256K
}
";

fn main() {
    let out = PathBuf::from(std::env::var_os("OUT_DIR").unwrap());
    let is_double = std::env::var_os("CARGO_FEATURE_DOUBLE").is_some();
    std::fs::write(out.join("memory.x"), if is_double { DOUBLE } else { PICO_2 }).unwrap();
    println!("cargo:rustc-link-search={}", out.display());
    println!("cargo:rustc-link-arg-bins=--nmagic");
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    if is_double {
        println!("cargo:rustc-link-arg-bins=-Tlink-rp.x");
    }
    println!("cargo:rustc-env=SOURCE={:016x}", source_hash());
}

/// FNV-1a of all that the program is made of, file by file in the order of their names.
fn source_hash() -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325;
    for part in
        ["Cargo.lock", "build.rs", "src", "../crates/board/src", "../crates/control/src", "../crates/rig/src"]
    {
        println!("cargo:rerun-if-changed={part}");
        take(Path::new(part), &mut hash);
    }
    hash
}

fn take(path: &Path, hash: &mut u64) {
    if path.is_dir() {
        let mut inside: Vec<_> = path.read_dir().unwrap().map(|entry| entry.unwrap().path()).collect();
        inside.sort();
        inside.iter().for_each(|path| take(path, hash));
        return;
    }
    for byte in std::fs::read(path).unwrap() {
        *hash = (*hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    }
}
