//! The lines of the head: motors, laser, switches, gyroscope.

use embassy_rp::gpio::{Input, Output};
use embassy_rp::pac;
use embassy_rp::peripherals::SPI1;
use embassy_rp::pwm::Pwm;
use embassy_rp::spi::{Blocking, Spi};
use tracelight_board::Done;
use tracelight_board::lines::{LET_GO, bridge, converter, turning_rad_s};
use tracelight_rig::{Joint, PanTilt, Sensed};

use crate::encoders::Encoders;

/// Slices of the bridges, whose both inputs are their channels.
const BRIDGES: [usize; 2] = [4, 5];
/// How often a bridge switches, Hz: nobody hears it.
const BRIDGE_HZ: u32 = 20_000;
/// Channels of the converter: buffered, gain 1, on.
const CONVERTER: [u16; 2] = [0x7000, 0xf000];
/// Registers of the gyroscope, an LSM6DSO, and what it says that it is.
const WHO_AM_I: (u8, u8) = (0x8f, 0x6c);
const GYROSCOPE_FROM: u8 = 0xa2;
/// 1.66 kHz within 250°/s.
const GYROSCOPE_ON: [u8; 2] = [0x11, 0x80];

/// All of them.
pub struct Head {
    pub encoders: Encoders,
    /// Light is seen; `None` where nothing looks.
    pub light: Option<Input<'static>>,
    pub gate: Output<'static>,
    /// The laser's second switch.
    pub enable: Output<'static>,
    pub amplifiers: Output<'static>,
    /// They switch as long as they are held; a tick sets their duties.
    pub _bridges: PanTilt<Pwm<'static>>,
    pub bus: Spi<'static, SPI1, Blocking>,
    /// Selects the gyroscope, if there is one.
    pub gyroscope: Option<Output<'static>>,
    /// Selects the converter that drives the amplifiers instead of the bridges, if there is one.
    pub converter: Option<Output<'static>>,
}

impl Head {
    /// Turns the gyroscope on; whether there is one.
    pub fn start_gyroscope(bus: &mut Spi<'static, SPI1, Blocking>, select: &mut Output<'static>) -> bool {
        let mut said = [WHO_AM_I.0, 0];
        select.set_low();
        let is_there = bus.blocking_transfer_in_place(&mut said).is_ok() && said[1] == WHO_AM_I.1;
        select.set_high();
        if is_there {
            select.set_low();
            let _ = bus.blocking_write(&GYROSCOPE_ON);
            select.set_high();
        }
        is_there
    }

    /// What the head senses: encoders at a time, cycles since they began, the rest now.
    pub fn sensed(&mut self, now: u32, tick: u32) -> Sensed {
        let foot_rad_s = self.gyroscope.as_mut().map(|select| {
            let mut said = [GYROSCOPE_FROM, 0, 0, 0, 0, 0, 0];
            select.set_low();
            let _ = self.bus.blocking_transfer_in_place(&mut said);
            select.set_high();
            let axis = |n: usize| i16::from_le_bytes([said[1 + 2 * n], said[2 + 2 * n]]);
            turning_rad_s([axis(0), axis(1), axis(2)])
        });
        let light = self.light.as_ref().map(Input::is_high);
        Sensed { encoders: self.encoders.read(now, tick), light, foot_rad_s, ..Sensed::default() }
    }

    /// Does what a tick decided, the laser first.
    pub fn apply(&mut self, done: &Done) {
        self.gate.set_level(done.actuation.gate.into());
        self.enable.set_level(done.actuation.enable.into());
        self.amplifiers.set_level(done.drives.into());
        for joint in Joint::BOTH {
            let command_v = done.actuation.command_v[joint];
            if let Some(select) = &mut self.converter {
                let word = CONVERTER[joint as usize] | converter(command_v);
                select.set_low();
                let _ = self.bus.blocking_write(&word.to_be_bytes());
                select.set_high();
                continue;
            }
            let limit_v = done.limit_v.filter(|_| done.drives);
            let (a, b) = limit_v.map_or(LET_GO, |limit_v| bridge(command_v, limit_v[joint], bridge_steps()));
            // both at once, when the slice begins anew
            pac::PWM
                .ch(BRIDGES[joint as usize])
                .cc()
                .write_value(pac::pwm::regs::ChCc(u32::from(b) << 16 | u32::from(a)));
        }
    }
}

/// Steps of a bridge's duty.
pub fn bridge_steps() -> u16 {
    (embassy_rp::clocks::clk_sys_freq() / BRIDGE_HZ) as u16
}
