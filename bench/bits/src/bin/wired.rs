//! Prints the hash of all that a board says as an emulated Cortex-M33 computes it, how many instructions its ticks take, how many bytes it keeps, how many
//! of its stack its ticks use and how many a new configuration, and ends the emulator. See `board`.

#![no_std]
#![no_main]

#[path = "../count.rs"]
mod count;
#[path = "../stack.rs"]
mod stack;

use cortex_m_semihosting::{debug, hprintln};
use panic_semihosting as _;
use tracelight_bench_bits::{Firmware, IDENTITY, Meter, WIRED_TICKS, run_wired};

use count::{Count, start_clock};
use stack::Stack;

/// Tick from which on the stack is looked at: the configuration is in force then.
const FROM_TICK: u32 = 100;

/// Counts instructions, and looks at the stack of all ticks but the first.
struct Metered {
    count: Count,
    begun: u32,
    ticks: Option<Stack>,
}

impl Meter for Metered {
    fn begin(&mut self) {
        self.begun += 1;
        if self.begun == FROM_TICK {
            self.ticks = Some(Stack::painted());
        }
        self.count.begin();
    }

    fn tick(&mut self) {
        self.count.tick();
    }

    fn append(&mut self) {
        self.count.append();
    }
}

#[cortex_m_rt::entry]
fn main() -> ! {
    start_clock();
    let mut board = Firmware::new(IDENTITY);
    let whole = Stack::painted();
    let begun = run_wired(&mut board, FROM_TICK, &mut ());
    let configured = whole.used();
    let mut board = Firmware::new(IDENTITY);
    let mut metered = Metered { count: Count::new(), begun: 0, ticks: None };
    let said = run_wired(&mut board, WIRED_TICKS, &mut metered);
    let ticks = metered.ticks.map_or(0, |stack| stack.used());
    let bytes = core::mem::size_of::<Firmware>();
    hprintln!(
        "{:016x} {} bytes {} stack {} configured {} {:x}",
        said,
        metered.count,
        bytes,
        ticks,
        configured,
        begun
    );
    debug::exit(debug::EXIT_SUCCESS);
    loop {
        core::hint::spin_loop();
    }
}
