//! A board's program on a Raspberry Pi Pico 2: pins, clocks and USB. What the board does is in `tracelight-board`.

#![no_std]
#![no_main]

mod encoders;
mod head;
mod tick;

use core::cell::RefCell;
use core::panic::PanicInfo;

use embassy_executor::Spawner;
use embassy_futures::join::join5;
use embassy_rp::gpio::{AnyPin, Input, Level, Output, Pull};
use embassy_rp::peripherals::{PIO0, USB};
use embassy_rp::pio::{Pio, PioBatch};
use embassy_rp::pwm::{self, Pwm};
use embassy_rp::spi::{self, Spi};
use embassy_rp::watchdog::{ResetReason, Watchdog};
use embassy_rp::{Peri, bind_interrupts, pac, pio, usb};
use embassy_time::{Duration, Ticker as Every};
use embassy_usb::class::cdc_acm::{CdcAcmClass, Sender, State};
use embassy_usb::{Builder, Config};
use static_cell::StaticCell;
use tracelight_board::lines::{Switches, capabilities};
use tracelight_board::{Between, Identity, Machine, Server, Speaker, version};
use tracelight_rig::wire::{Greeting, MOST_PACKET, Reset};
use tracelight_rig::{Capabilities, PanTilt};

use encoders::Encoders;
use head::{Head, bridge_steps};
use tick::{Looking, Ticking, now_us};

/// Segments that are kept ahead, and ticks that can be told again.
const SEGMENTS: usize = if cfg!(feature = "double") { 256 } else { 320 };
const ROWS: usize = if cfg!(feature = "double") { 1024 } else { 2048 };
/// Bytes of a USB packet.
const PACKET: usize = 64;

type AnyLine = Peri<'static, AnyPin>;
type Speaking = RefCell<Speaker<'static, SEGMENTS, ROWS>>;

bind_interrupts!(struct Irqs {
    PIO0_IRQ_0 => pio::InterruptHandler<PIO0>;
    USBCTRL_IRQ => usb::InterruptHandler<USB>;
});

/// Lines of the laser: its enable and its gate.
const LIGHT: u32 = 1 << 13 | 1 << 14;

/// Nothing is left to do but to go dark: the heartbeat stops, and the watchdog starts it anew.
fn dark() -> ! {
    cortex_m::interrupt::disable();
    pac::SIO.gpio_out(0).value_clr().write_value(LIGHT);
    loop {
        core::hint::spin_loop();
    }
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    dark()
}

#[cortex_m_rt::exception]
unsafe fn HardFault(_: &cortex_m_rt::ExceptionFrame) -> ! {
    dark()
}

#[embassy_executor::main(executor = "embassy_rp::executor::Executor", entry = "cortex_m_rt::entry")]
async fn main(_spawner: Spawner) {
    let p = embassy_rp::init(Default::default());
    let watchdog = Watchdog::new(p.WATCHDOG);
    let reset = why_reset(&watchdog);
    // dark, whatever comes
    let low = |pin: AnyLine| Output::new(pin, Level::Low);
    let (gate, enable, amplifiers) = (low(p.PIN_14.into()), low(p.PIN_13.into()), low(p.PIN_12.into()));
    let (heartbeat, lamp) = (low(p.PIN_15.into()), low(p.PIN_25.into()));
    let pulled_up = |pin: AnyLine| Input::new(pin, Pull::Up);
    // closed to ground as long as all is well
    let [stop, lid, key] = [p.PIN_16.into(), p.PIN_17.into(), p.PIN_18.into()].map(pulled_up);
    // high as long as all is well, pulled down where their cable ends
    let [pan_fault, tilt_fault] = [p.PIN_20.into(), p.PIN_21.into()].map(|pin: AnyLine| {
        let mut input = Input::new(pin, Pull::None);
        input.set_inversion(true);
        input
    });
    // bridged to ground where something is fitted
    let fitted = [p.PIN_0.into(), p.PIN_1.into()].map(pulled_up);
    embassy_time::block_for(Duration::from_micros(100));
    let [sees_light, has_converter] = fitted.map(|pin| pin.is_low());
    let mut bus_config = spi::Config::default();
    bus_config.frequency = 8_000_000;
    let mut bus = Spi::new_blocking(p.SPI1, p.PIN_26, p.PIN_27, p.PIN_28, bus_config);
    let mut select = Output::new(p.PIN_22, Level::High);
    let gyroscope = Head::start_gyroscope(&mut bus, &mut select).then_some(select);
    let converter = has_converter.then(|| Output::new(p.PIN_7, Level::High));
    // motors are let go until a tick says otherwise
    let mut switching = pwm::Config::default();
    switching.top = bridge_steps() - 1;
    let bridges = PanTilt::new(
        Pwm::new_output_ab(p.PWM_SLICE4, p.PIN_8, p.PIN_9, switching.clone()),
        Pwm::new_output_ab(p.PWM_SLICE5, p.PIN_10, p.PIN_11, switching),
    );
    let Pio { mut common, mut sm0, mut sm1, .. } = Pio::new(p.PIO0, Irqs);
    let lines = PanTilt::new(
        [common.make_pio_pin(p.PIN_2), common.make_pio_pin(p.PIN_3)],
        [common.make_pio_pin(p.PIN_4), common.make_pio_pin(p.PIN_5)],
    );
    let encoders = Encoders::new(&mut common, (&mut sm0, &mut sm1), lines);
    let identity = identity(capabilities(sees_light, gyroscope.is_some()), reset);
    static SERVER: StaticCell<Server<SEGMENTS, ROWS>> = StaticCell::new();
    static MACHINE: StaticCell<Machine<SEGMENTS>> = StaticCell::new();
    static BETWEEN: StaticCell<Between> = StaticCell::new();
    let (server, machine) = (SERVER.init_with(|| Server::new(identity)), MACHINE.init_with(Machine::new));
    let (speaker, ticker) = BETWEEN.init_with(Between::new).halves(server, machine);
    let light = sees_light.then(|| Input::new(p.PIN_19, Pull::None));
    let head =
        Head { encoders, light, gate, enable, amplifiers, _bridges: bridges, bus, gyroscope, converter };
    let stops = [stop, lid, key, pan_fault, tilt_fault];
    let looking = Looking { stops, switches: Switches::default(), looks: 0, due_us: 0 };
    let inputs = identity.capabilities.inputs;
    let ticking = Ticking { ticker, head, inputs, heartbeat, lamp, watchdog, last_us: now_us() };
    tick::start(looking, ticking, || {
        let mut batch = PioBatch::new();
        batch.set_enable(&mut sm0, true);
        batch.set_enable(&mut sm1, true);
        batch.execute();
    });
    speak(usb::Driver::new(p.USB, Irqs), identity.serial(), RefCell::new(speaker)).await;
}

/// What USB keeps.
struct Memory {
    serial: [u8; 16],
    descriptor: [u8; 256],
    bos: [u8; 256],
    control: [u8; 64],
    state: State<'static>,
}

/// Speaks with hosts over USB, for ever.
async fn speak(driver: usb::Driver<'static, USB>, serial: [u8; 16], speaking: Speaking) {
    static MEMORY: StaticCell<Memory> = StaticCell::new();
    let Memory { serial, descriptor, bos, control, state } = MEMORY.init(Memory {
        serial,
        descriptor: [0; 256],
        bos: [0; 256],
        control: [0; 64],
        state: State::new(),
    });
    // of pid.codes, for programs that are not sold
    let mut config = Config::new(0x1209, 0x0001);
    config.manufacturer = Some("Tracelight");
    config.product = Some("Tracelight board");
    config.serial_number = core::str::from_utf8(serial).ok();
    let mut builder = Builder::new(driver, config, descriptor, bos, &mut [], control);
    let class = CdcAcmClass::new(&mut builder, state, PACKET as u16);
    let mut device = builder.build();
    let (mut sender, mut receiver, changed) = class.split_with_control();
    let rounds = async {
        let mut every = Every::every(Duration::from_millis(1));
        loop {
            every.next().await;
            speaking.borrow_mut().round();
        }
    };
    let hears = async {
        let mut packet = [0; PACKET];
        loop {
            receiver.wait_connection().await;
            while let Ok(length) = receiver.read_packet(&mut packet).await {
                speaking.borrow_mut().take(packet.get(..length).unwrap_or_default(), now_us());
            }
            speaking.borrow_mut().hang_up();
        }
    };
    let says = async {
        loop {
            sender.wait_connection().await;
            say(&mut sender, &speaking).await;
        }
    };
    let ends = async {
        loop {
            changed.control_changed().await;
            // whoever had the port open closed it
            if !changed.dtr() {
                speaking.borrow_mut().hang_up();
            }
        }
    };
    join5(device.run(), rounds, hears, says, ends).await;
}

/// Says what is to be said, until the line is gone.
async fn say(sender: &mut Sender<'static, usb::Driver<'static, USB>>, speaking: &Speaking) {
    let mut every = Every::every(Duration::from_millis(1));
    let mut bytes = [0; 4 * MOST_PACKET];
    loop {
        every.next().await;
        let length = speaking.borrow_mut().give(&mut bytes);
        let said = bytes.get(..length).unwrap_or_default();
        for packet in said.chunks(PACKET) {
            if sender.write_packet(packet).await.is_err() {
                return;
            }
        }
        // whoever reads waits for a short one
        if length > 0 && length.is_multiple_of(PACKET) && sender.write_packet(&[]).await.is_err() {
            return;
        }
    }
}

/// What the board says that it is.
fn identity(capabilities: Capabilities, reset: Reset) -> Identity {
    let source = u64::from_str_radix(env!("SOURCE"), 16).unwrap_or_default().to_be_bytes();
    #[cfg(feature = "pico-2")]
    let (board, id) = (Greeting::PICO_2, embassy_rp::otp::get_chipid().unwrap_or_default().to_be_bytes());
    #[cfg(feature = "double")]
    let (board, id) = (Greeting::DOUBLE, Greeting::EMULATED_ID);
    Identity { firmware: version(env!("CARGO_PKG_VERSION")), source, board, id, capabilities, reset }
}

/// Why the chip started.
fn why_reset(watchdog: &Watchdog) -> Reset {
    match watchdog.reset_reason() {
        Some(ResetReason::TimedOut) => return Reset::Watchdog,
        Some(ResetReason::Forced) => return Reset::Told,
        None => {}
    }
    #[cfg(feature = "pico-2")]
    {
        let why = pac::POWMAN.chip_reset().read();
        match () {
            () if why.had_bor() => Reset::BrownOut,
            () if why.had_por() => Reset::PowerUp,
            () if why.had_run_low() => Reset::Button,
            () => Reset::Unknown,
        }
    }
    #[cfg(feature = "double")]
    Reset::PowerUp
}
