//! Runs `bench/bits`' `cycles` on an emulated RP2350 and prints its figures: `cycles IMAGE [MEAN MOST]`, with bounds that they may not pass.
//!
//! The emulator counts cycles as its author measured them on silicon. It does not know the moves of register pairs by which compiled functions keep
//! what they use of the floating-point unit; [`pair`] does them, at the cycles that Arm tells of a Cortex-M33.

#[allow(dead_code, reason = "what the firmware takes of memory is nobody's concern here")]
#[path = "../../../../firmware/xtask/src/elf.rs"]
mod elf;

use std::process::ExitCode;

use rp2350_emu::{Config, Emulator, EmulatorBuilder};

/// Where flash begins, and with it the vectors.
const FLASH: u32 = 0x1000_0000;
/// Cycles of the clock, Hz.
const CLOCK_HZ: f64 = 150e6;
/// It is over within so many instructions, or it hangs.
const MOST_STEPS: u64 = 2_000_000_000;
/// Steps between two looks whether it is.
const LOOK_STEPS: u64 = 100_000;
const FIGURES: usize = 9;
const CPACR: u32 = 0xe000_ed88;

fn main() -> ExitCode {
    match run(&std::env::args().skip(1).collect::<Vec<_>>()) {
        Ok(text) => {
            println!("{text}");
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[String]) -> Result<String, String> {
    let [image, bounds @ ..] = arguments else { return Err("usage: cycles IMAGE [MEAN MOST]".to_owned()) };
    let file = std::fs::read(image).map_err(|e| format!("{image}: {e}"))?;
    let elf = elf::read(&file).map_err(|e| format!("{image}: {e}"))?;
    let (_, figures) = elf.symbols.iter().find(|(name, _)| name == "FIGURES").ok_or("it tells no figures")?;
    let mut emulator =
        EmulatorBuilder::new(Config::default()).step_quantum(1).build().map_err(|e| format!("{e:?}"))?;
    emulator.load_flash(&elf.image);
    let (stack, begin) = (emulator.peek(FLASH), emulator.peek(FLASH + 4));
    emulator.core_mut(0).ppb.vtor = FLASH;
    let core = &mut emulator.core_mut(0).regs;
    (core.r[13], core.msp, core.r[15]) = (stack, stack, begin & !1);
    emulator.mmio_write32(CPACR, 0xf << 20);
    let mut extra = 0;
    for step in 0..MOST_STEPS {
        if step % LOOK_STEPS == 0 && emulator.peek(figures + 4 * (FIGURES as u32 - 1)) == 1 {
            break;
        }
        while let Some(cycles) = pair(&mut emulator) {
            extra += cycles;
        }
        emulator.step().map_err(|e| format!("{e:?}"))?;
    }
    let read = |n: u32| emulator.peek(figures + 4 * n);
    if read(FIGURES as u32 - 1) != 1 {
        return Err(format!("{image}: it did not come to its end; at {:08x}", emulator.core(0).regs.r[15]));
    }
    // what was moved here is spread over all ticks
    let more = extra / u64::from(read(0) + read(3));
    let us = |cycles: u64| 1e6 * cycles as f64 / CLOCK_HZ;
    let mut lines = vec![format!("{:08x}{:08x}", read(7), read(6))];
    for (name, first) in [("usual", 0), ("dearest", 3)] {
        let (mean, most) = (u64::from(read(first + 1)) + more, u64::from(read(first + 2)) + more);
        lines.push(format!(
            "{name}: {} ticks of {mean} cycles in the mean ({:.0} µs at 150 MHz), {most} at most ({:.0} µs)",
            read(first),
            us(mean),
            us(most)
        ));
        if let [most_mean, most_most] = bounds {
            let bound = |text: &String| text.parse::<u64>().map_err(|_| format!("{text} is no number"));
            if (first == 0 && mean > bound(most_mean)?) || most > bound(most_most)? {
                return Err(format!("{}: they may be {most_mean} and {most_most}", lines.join("\n")));
            }
        }
    }
    Ok(lines.join("\n"))
}

/// Does a move of pairs of single registers, if that is what comes next; its cycles.
fn pair(emulator: &mut Emulator) -> Option<u64> {
    let at = emulator.core(0).regs.r[15];
    let half = |emulator: &Emulator, at: u32| (emulator.peek(at & !3) >> (8 * (at & 2))) & 0xffff;
    let (first, second) = (half(emulator, at), half(emulator, at + 2));
    // coprocessor 11: register pairs
    if first & 0xee00 != 0xec00 || second & 0x0f00 != 0x0b00 {
        return None;
    }
    let register = (first & 15) as usize;
    let bits = |value: f32| value.to_bits();
    // VMOV of two registers and a pair
    if first & 0x0fe0 == 0x0c40 && second & 0x00d0 == 0x0010 {
        let (pair, other) = (2 * (second & 15) as usize, (second >> 12) as usize);
        let is_to_core = first & 0x10 != 0;
        let regs = &mut emulator.core_mut(0).regs;
        if is_to_core {
            (regs.r[other], regs.r[register]) = (bits(regs.s[pair]), bits(regs.s[pair + 1]));
        } else {
            (regs.s[pair], regs.s[pair + 1]) =
                (f32::from_bits(regs.r[other]), f32::from_bits(regs.r[register]));
        }
        regs.r[15] = at + 4;
        return Some(1);
    }
    let (from, is_load) = (2 * (second >> 12) as usize, first & 0x10 != 0);
    let (is_up, writes_back, is_before) = (first & 0x80 != 0, first & 0x20 != 0, first & 0x100 != 0);
    let offset = 4 * (second & 0xff);
    let base = emulator.core(0).regs.r[register];
    let base = if register == 15 { (at + 4) & !3 } else { base };
    let (count, begin) = match (is_before, writes_back) {
        // VLDR, VSTR
        (true, false) => (2, if is_up { base + offset } else { base - offset }),
        // VSTMDB, VLDMDB: VPUSH
        (true, true) => ((second & 0xff) as usize, base - offset),
        // VLDMIA, VSTMIA: VPOP
        (false, _) => ((second & 0xff) as usize, base),
    };
    for n in 0..count {
        let address = begin + 4 * n as u32;
        if is_load {
            let word = emulator.peek(address);
            emulator.core_mut(0).regs.s[from + n] = f32::from_bits(word);
        } else {
            let word = bits(emulator.core(0).regs.s[from + n]);
            emulator.poke(address, word);
        }
    }
    let regs = &mut emulator.core_mut(0).regs;
    if writes_back {
        let after = if is_before { begin } else { base + offset };
        regs.r[register] = after;
        if register == 13 {
            regs.msp = after;
        }
    }
    regs.r[15] = at + 4;
    Some(1 + count as u64)
}
