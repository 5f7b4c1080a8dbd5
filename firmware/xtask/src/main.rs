//! `cargo xtask firmware`: the firmware as a file that a Pico 2's boot loader takes.
//!
//! Cargo builds an ELF file, a boot loader takes UF2. What is in between is done here, so that nobody has to install anything but Rust's own target.

mod elf;
mod uf2;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Flash and memory that the program may take, bytes.
const MOST_FLASH: usize = 128 << 10;
const MOST_MEMORY: usize = 160 << 10;
/// What the stack needs beside what is static: a tick takes 10 kB of it, and may interrupt what takes another one a new configuration.
const STACK: usize = 24 << 10;

/// A board that the firmware is built for.
struct Board {
    name: &'static str,
    target: &'static str,
    flags: &'static [&'static str],
    /// Which chip a UF2 block is for.
    family: u32,
}

const PICO_2: Board =
    Board { name: "pico-2", target: "thumbv8m.main-none-eabihf", flags: &[], family: 0xe48b_ff59 };
const DOUBLE: Board = Board {
    name: "double",
    target: "thumbv6m-none-eabi",
    flags: &["--no-default-features", "--features", "double"],
    family: 0xe48b_ff56,
};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let result = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["firmware"] => firmware(&PICO_2, false),
        ["firmware", "--double"] => firmware(&DOUBLE, false),
        ["firmware", "--build-core"] => firmware(&PICO_2, true),
        ["firmware", "--double", "--build-core"] => firmware(&DOUBLE, true),
        _ => Err("usage: cargo xtask firmware [--double] [--build-core]".to_owned()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Builds it, and writes `out/firmware/tracelight-NAME.uf2` and `.bin`.
fn firmware(board: &Board, builds_core: bool) -> Result<(), String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let target = root.join("target/firmware");
    build(board, builds_core, &root.join("firmware"), &target)?;
    let built = target.join(board.target).join("release/tracelight-firmware");
    let file = std::fs::read(&built).map_err(|e| format!("{}: {e}", built.display()))?;
    let elf = elf::read(&file).map_err(|e| format!("{}: {e}", built.display()))?;
    if let Some((name, _)) = elf.symbols.iter().find(|(name, _)| computes_in_double(name)) {
        return Err(format!("{}: {name} computes in f64, which the processor cannot", built.display()));
    }
    let (flash, memory) = (elf.image.len(), elf.memory + STACK);
    if flash > MOST_FLASH || memory > MOST_MEMORY {
        return Err(format!(
            "{flash} bytes of flash and {memory} of memory: they may be {MOST_FLASH} and {MOST_MEMORY}"
        ));
    }
    let out = root.join("out/firmware");
    std::fs::create_dir_all(&out).map_err(|e| format!("{}: {e}", out.display()))?;
    let write = |ending: &str, bytes: &[u8]| -> Result<PathBuf, String> {
        let path = out.join(format!("tracelight-{}.{ending}", board.name));
        std::fs::write(&path, bytes).map_err(|e| format!("{}: {e}", path.display()))?;
        Ok(path)
    };
    write("bin", &elf.image)?;
    if board.name == DOUBLE.name {
        write("json", routines(&elf.symbols).as_bytes())?;
    }
    let path = write("uf2", &uf2::blocks(&elf.image, board.family))?;
    println!(
        "out/firmware/{}: {flash} bytes of flash, {memory} of memory with its stack",
        path.file_name().unwrap_or_default().display()
    );
    Ok(())
}

/// Where routines are that compute in f32 for a processor that cannot, as JSON: an emulator does it for them.
fn routines(symbols: &[(String, u32)]) -> String {
    let lines: Vec<String> = symbols
        .iter()
        .filter(|(name, _)| name.starts_with("__aeabi_f") || name.ends_with("i2f"))
        .map(|(name, at)| format!("  \"{name}\": {}", at & !1))
        .collect();
    format!("{{\n{}\n}}\n", lines.join(",\n"))
}

/// Whether a routine computes in double precision: the name of one of the compiler's own.
fn computes_in_double(name: &str) -> bool {
    let arithmetic = ["add", "sub", "rsub", "mul", "div", "cmp", "2"];
    name.strip_prefix("__aeabi_d").is_some_and(|rest| arithmetic.iter().any(|kind| rest.starts_with(kind)))
        || name.starts_with("__") && name.ends_with("df3") && !name.contains("aeabi")
}

/// Has cargo build it, so that where the sources lie is not in the file. A compiler without the board's target builds its library too, and links with LLVM's
/// linker: that of Debian, with `RUSTC_BOOTSTRAP=1`.
fn build(board: &Board, builds_core: bool, firmware: &Path, target: &Path) -> Result<(), String> {
    let home = |variable: &str, folder: &str| {
        let home = std::env::var_os("HOME").map(|home| PathBuf::from(home).join(folder));
        std::env::var_os(variable).map(PathBuf::from).or(home)
    };
    let root = firmware.parent().and_then(|root| root.canonicalize().ok());
    let places = [
        (root, "/tracelight"),
        (home("CARGO_HOME", ".cargo"), "/cargo"),
        (home("RUSTUP_HOME", ".rustup"), "/rustup"),
    ];
    let core: (&[&str], &[&str]) = if builds_core {
        (&["-Zbuild-std=core", "--ignore-rust-version"], &["-Clinker=ld.lld-19", "-Clinker-flavor=ld.lld"])
    } else {
        (&[], &[])
    };
    let remapped = places
        .into_iter()
        .filter_map(|(place, name)| Some(format!("--remap-path-prefix={}={name}", place?.display())));
    let flags: Vec<String> = core.1.iter().map(|&flag| flag.to_owned()).chain(remapped).collect();
    let status = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .current_dir(firmware)
        .args(["build", "--release", "--locked", "--target", board.target, "--target-dir"])
        .arg(target)
        .args(board.flags)
        .args(core.0)
        .env("CARGO_ENCODED_RUSTFLAGS", flags.join("\x1f"))
        .status()
        .map_err(|e| format!("cargo: {e}"))?;
    if status.success() {
        return Ok(());
    }
    Err(format!("the firmware was not built; is the target there? rustup target add {}", board.target))
}
