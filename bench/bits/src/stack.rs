//! How much of its stack a board's program uses.

use cortex_m::register::msp;

/// Bytes below the caller's that are looked at.
const DEEPEST: usize = 96 * 1024;
/// What nobody writes.
const PAINT: u32 = 0x5AC7_1DEA;

/// A stack below its caller's, painted: what is written to it later shows.
pub(crate) struct Stack {
    top: usize,
}

impl Stack {
    /// Paints what lies below.
    #[inline(never)]
    pub(crate) fn painted() -> Self {
        // its own variables and return address stay
        let top = (msp::read() as usize - 256) & !3;
        for at in (top - DEEPEST..top).step_by(4) {
            // SAFETY: it is memory of this stack that nobody uses yet, and no interrupt is enabled
            unsafe { (at as *mut u32).write_volatile(PAINT) };
        }
        Self { top }
    }

    /// Bytes of it that were used since.
    pub(crate) fn used(&self) -> usize {
        let words = (self.top - DEEPEST..self.top).step_by(4);
        // SAFETY: as above
        let is_painted = |at: &usize| unsafe { (*at as *const u32).read_volatile() } == PAINT;
        DEEPEST - 4 * words.take_while(is_painted).count()
    }
}
