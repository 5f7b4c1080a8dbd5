//! Sizes of paper.

/// What is drawn or printed on, upright, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paper {
    /// The shorter side.
    pub width_mm: f64,
    /// The longer side.
    pub height_mm: f64,
}

impl Paper {
    /// 148 × 210 mm.
    pub const A5: Self = Self { width_mm: 148.0, height_mm: 210.0 };
    /// 210 × 297 mm.
    pub const A4: Self = Self { width_mm: 210.0, height_mm: 297.0 };
    /// 297 × 420 mm.
    pub const A3: Self = Self { width_mm: 297.0, height_mm: 420.0 };
    /// 8.5 × 11 in.
    pub const LETTER: Self = Self { width_mm: 215.9, height_mm: 279.4 };
    /// 8.5 × 14 in.
    pub const LEGAL: Self = Self { width_mm: 215.9, height_mm: 355.6 };

    /// Width and height, m.
    #[must_use]
    pub const fn size_m(&self) -> (f64, f64) {
        (1e-3 * self.width_mm, 1e-3 * self.height_mm)
    }

    /// Width and height, m, if it lies upright or across, whichever is nearer to such proportions.
    pub(crate) fn lying_m(&self, ratio: f64) -> (f64, f64) {
        let (width, height) = self.size_m();
        if ratio < 1.0 { (width, height) } else { (height, width) }
    }
}
