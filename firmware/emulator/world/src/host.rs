//! A host that homes the head, arms it and has a circle drawn, and says so as long as it is let.

use std::cell::RefCell;

use tracelight_device::{Host, Stage};
use tracelight_rig::{Command, PanTilt, Phase, Telemetry};

use crate::circle::segment;
use crate::rig;

/// Room for what is heard and said in one go, bytes.
const ROOM: usize = 1 << 14;

/// A host, and how far it is.
struct Drawing {
    host: Host,
    bytes: Vec<u8>,
    told: Option<Telemetry>,
    is_homed: bool,
    arms: bool,
    is_armed: bool,
    next: u32,
}

thread_local! {
    static DRAWING: RefCell<Option<Drawing>> = const { RefCell::new(None) };
}

fn with<T: Default>(what: impl FnOnce(&mut Drawing) -> T) -> T {
    DRAWING.with_borrow_mut(|drawing| drawing.as_mut().map(what)).unwrap_or_default()
}

/// A host that was just started, with a number that none had before; it arms the head or does not.
// SAFETY: nothing else of the module has that name, here and below
#[unsafe(no_mangle)]
pub extern "C" fn host(session: u32, arms: u32) {
    let host = Host::new(rig().control_config(), session);
    let bytes = vec![0; ROOM];
    DRAWING.set(Some(Drawing {
        host,
        bytes,
        told: None,
        is_homed: false,
        arms: arms != 0,
        is_armed: false,
        next: 0,
    }));
}

/// Where bytes that are heard are to be put, and where those lie that are said.
#[unsafe(no_mangle)]
pub extern "C" fn bytes() -> *mut u8 {
    DRAWING.with_borrow_mut(|drawing| drawing.as_mut().map_or(std::ptr::null_mut(), |d| d.bytes.as_mut_ptr()))
}

/// Hears so many bytes, and says what is to be said now, µs; how many bytes that is.
#[unsafe(no_mangle)]
pub extern "C" fn hear(length: u32, now_us: f64) -> u32 {
    with(|drawing| {
        let now_us = now_us as u64;
        let heard = drawing.bytes.get(..length as usize).unwrap_or_default().to_vec();
        drawing.host.take(&heard, now_us);
        drawing.go_on();
        let mut said = Vec::new();
        drawing.host.give(now_us, &mut said);
        said.truncate(ROOM);
        drawing.bytes[..said.len()].copy_from_slice(&said);
        said.len() as u32
    })
}

impl Drawing {
    fn go_on(&mut self) {
        let Self { host, told, is_homed, arms, is_armed, next, .. } = self;
        while let Some(telemetry) = host.telemetry() {
            *told = Some(telemetry);
            let _ = host.send(Command::KeepAlive);
        }
        let Some(telemetry) = told.filter(|_| host.stage() == Stage::Running) else { return };
        if !*is_homed {
            *is_homed = host.send(Command::Home(PanTilt::new(0, 0))).is_ok();
            return;
        }
        if *arms && !*is_armed && telemetry.homed && host.opens_in_ticks() == 0 {
            *is_armed = host.send(Command::Arm { acknowledges: telemetry.fault_number }).is_ok();
        }
        while *is_armed && host.send(Command::Append(segment(*next))).is_ok() {
            *next += 1;
        }
    }
}

/// 0 as long as it greets and configures, 1 while the board runs, 2 once something is wrong between them.
#[unsafe(no_mangle)]
pub extern "C" fn stage() -> u32 {
    with(|drawing| match drawing.host.stage() {
        Stage::Greeting | Stage::Configuring => 0,
        Stage::Running => 1,
        Stage::Failed(_) => 2,
    })
}

/// Whether the plan is being drawn, by the last tick that the host knows of.
#[unsafe(no_mangle)]
pub extern "C" fn draws() -> u32 {
    with(|drawing| drawing.told.is_some_and(|told| told.phase == Phase::Tracing).into())
}

/// Puts the name of the latched fault where bytes lie; how long it is, 0 if there is none.
#[unsafe(no_mangle)]
pub extern "C" fn fault() -> u32 {
    with(|drawing| {
        let Some(record) = drawing.told.and_then(|told| told.latched) else { return 0 };
        let name = record.fault.code().as_bytes();
        drawing.bytes[..name.len()].copy_from_slice(name);
        name.len() as u32
    })
}

/// Puts what is wrong between host and board where bytes lie; how long that is.
#[unsafe(no_mangle)]
pub extern "C" fn trouble() -> u32 {
    with(|drawing| {
        let Stage::Failed(trouble) = drawing.host.stage() else { return 0 };
        let text = trouble.to_string().into_bytes();
        let length = text.len().min(ROOM);
        drawing.bytes[..length].copy_from_slice(&text[..length]);
        length as u32
    })
}
