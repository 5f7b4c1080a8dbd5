//! Both encoders, decoded by PIO: every edge with the count after it and its time, kept in a ring by DMA.

use core::cell::UnsafeCell;

use embassy_rp::pac;
use embassy_rp::pac::dma::vals::{DataSize, TreqSel};
use embassy_rp::peripherals::PIO0;
use embassy_rp::pio::program::pio_file;
use embassy_rp::pio::{Common, Config, FifoJoin, Pin, ShiftDirection, StateMachine};
use tracelight_board::lines::Quadrature;
use tracelight_rig::{Measurement, PanTilt};

/// Edges that are kept of each encoder: at 24 rad/s and 8192 counts a turn 32 come in a tick.
const EDGES: usize = 64;
/// The program looks at both lines every so many cycles, and counts them.
const LOOK_CYCLES: u32 = 6;

/// Where DMA writes: count and clock by turns.
#[repr(C, align(512))]
struct Ring(UnsafeCell<[u32; 2 * EDGES]>);

// SAFETY: only the tick reads it, word by word and volatile; nothing but DMA writes it
unsafe impl Sync for Ring {}

static RINGS: [Ring; 2] = [const { Ring(UnsafeCell::new([0; 2 * EDGES])) }; 2];

/// One encoder: what it said last, and up to where its ring was read.
struct Encoder {
    channel: usize,
    read: usize,
    quadrature: Quadrature,
}

/// Both encoders.
pub struct Encoders(PanTilt<Encoder>);

impl Encoders {
    /// Loads the program. Its lines begin with these pins, the other line of each follows.
    pub fn new(
        common: &mut Common<'static, PIO0>,
        (pan, tilt): (&mut StateMachine<'static, PIO0, 0>, &mut StateMachine<'static, PIO0, 1>),
        lines: PanTilt<[Pin<'static, PIO0>; 2]>,
    ) -> Self {
        let program = pio_file!("src/quadrature.pio");
        let loaded = common.load_program(&program.program);
        let mut lines = lines;
        for line in lines.pan.iter_mut().chain(&mut lines.tilt) {
            line.set_pull(embassy_rp::gpio::Pull::Up);
            line.set_schmitt(true);
        }
        let config = |[a, b]: &[Pin<'static, PIO0>; 2]| {
            let mut config = Config::default();
            config.use_program(&loaded, &[]);
            config.set_in_pins(&[a, b]);
            config.shift_in.direction = ShiftDirection::Left;
            config.shift_out.direction = ShiftDirection::Right;
            config.fifo_join = FifoJoin::RxOnly;
            config
        };
        pan.set_config(&config(&lines.pan));
        tilt.set_config(&config(&lines.tilt));
        for machine in 0..2 {
            // X and Y from 0, the lines as they are, jmp to the first look
            for instruction in [0xe020, 0xe040, 0xa0e0, program.public_defines.sample as u16] {
                pac::PIO0.sm(machine).instr().write(|w| w.set_instr(instruction));
            }
        }
        RINGS.iter().enumerate().for_each(|(channel, ring)| keep(channel, ring));
        let encoder = |channel| Encoder { channel, read: 0, quadrature: Quadrature::default() };
        Self(PanTilt::new(encoder(0), encoder(1)))
    }
}

impl Encoders {
    /// What both say at a time that was not long ago, in cycles since their program began, with ticks of so many cycles.
    pub fn read(&mut self, now: u32, tick: u32) -> PanTilt<Measurement> {
        let Self(PanTilt { pan, tilt }) = self;
        PanTilt::new(pan.read(now, tick), tilt.read(now, tick))
    }
}

impl Encoder {
    fn read(&mut self, now: u32, tick: u32) -> Measurement {
        let ring = RINGS[self.channel].0.get().cast::<u32>();
        let written = (pac::DMA.ch(self.channel).write_addr().read() as usize - ring as usize) / 8 % EDGES;
        while self.read != written {
            // SAFETY: both are within the ring
            let (count, clock) = unsafe {
                (ring.add(2 * self.read).read_volatile(), ring.add(2 * self.read + 1).read_volatile())
            };
            // an edge came between the look that saw it and the one before
            let at = clock.wrapping_neg().wrapping_mul(LOOK_CYCLES).wrapping_sub(LOOK_CYCLES / 2);
            if !self.quadrature.take(count as i32, at, now) {
                break;
            }
            self.read = (self.read + 1) % EDGES;
        }
        self.quadrature.read(now, tick)
    }
}

/// Has DMA keep all that a machine says in its ring, for ever.
fn keep(channel: usize, ring: &'static Ring) {
    let dma = pac::DMA.ch(channel);
    dma.read_addr().write_value(pac::PIO0.rxf(channel).as_ptr() as u32);
    dma.write_addr().write_value(ring.0.get() as u32);
    #[cfg(feature = "pico-2")]
    dma.trans_count().write(|w| w.set_mode(pac::dma::vals::TransCountMode::ENDLESS));
    // days, which no test lasts
    #[cfg(feature = "double")]
    dma.trans_count().write_value(i32::MAX as u32);
    dma.ctrl_trig().write(|w| {
        w.set_treq_sel(TreqSel::from_bits(TreqSel::PIO0_RX0 as u8 + channel as u8));
        w.set_data_size(DataSize::SIZE_WORD);
        w.set_incr_write(true);
        w.set_ring_sel(true);
        w.set_ring_size(size_of::<Ring>().trailing_zeros() as u8);
        w.set_chain_to(channel as u8);
        w.set_en(true);
    });
}
