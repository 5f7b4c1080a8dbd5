//! A rectangle of an image's pixels.

/// A rectangle of an image's pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Its first column and row.
    pub left: usize,
    /// See `left`.
    pub top: usize,
    /// Columns and rows it has.
    pub width: usize,
    /// See `width`.
    pub height: usize,
}

impl Part {
    /// All of an image.
    pub const fn whole([width, height]: [usize; 2]) -> Self {
        Self { left: 0, top: 0, width, height }
    }

    /// Extends the part by one pixel on each side, within the image.
    pub(super) fn wider(&self, [width, height]: [usize; 2]) -> Self {
        let (left, top) = (self.left.saturating_sub(1), self.top.saturating_sub(1));
        let right = (self.left + self.width + 1).min(width);
        let bottom = (self.top + self.height + 1).min(height);
        Self { left, top, width: right - left, height: bottom - top }
    }
}
