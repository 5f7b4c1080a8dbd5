//! The rows of the last seconds.

use tracelight_rig::wire::RowBytes;

/// Rows of ticks that follow each other; the newest ones stay.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ring<const ROWS: usize> {
    rows: [RowBytes; ROWS],
    /// Tick after the newest row.
    end: u32,
    length: u32,
}

impl<const ROWS: usize> Ring<ROWS> {
    pub(crate) const fn new() -> Self {
        // ticks wrap: only then do they keep their places
        const { assert!(ROWS.is_power_of_two()) };
        Self { rows: [RowBytes::NONE; ROWS], end: 0, length: 0 }
    }

    /// Tick after the newest row.
    pub(crate) const fn end(&self) -> u32 {
        self.end
    }

    /// Tick of the oldest row.
    pub(crate) const fn begin(&self) -> u32 {
        self.end.wrapping_sub(self.length)
    }

    /// Keeps the row of a tick; those before a gap are forgotten.
    pub(crate) fn push(&mut self, tick: u32, row: RowBytes) {
        if tick != self.end {
            self.length = 0;
        }
        if let Some(place) = self.rows.get_mut(Self::place(tick)) {
            *place = row;
        }
        self.end = tick.wrapping_add(1);
        self.length = (self.length + 1).min(ROWS as u32);
    }

    /// Rows from a tick on, if that is still there; none from the newest on.
    pub(crate) fn from(&self, tick: u32) -> impl Iterator<Item = &RowBytes> + Clone {
        let count = self.end.wrapping_sub(tick);
        let count = if count <= self.length { count } else { 0 };
        (0..count).filter_map(move |at| self.rows.get(Self::place(tick.wrapping_add(at))))
    }

    const fn place(tick: u32) -> usize {
        tick as usize % ROWS
    }
}
