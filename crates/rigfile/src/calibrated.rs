//! What a calibration file says of itself: what it is of, from which day, and how far it is likely to be off.

/// Up to where what is drawn looks as if nothing were off, and up to where most work bears it, m: the width of a fine pencil line, and of a spot's edge.
const GREAT_M: f64 = 0.2e-3;
const USABLE_M: f64 = 1e-3;

/// What is known of a calibration.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibrated {
    /// What was calibrated.
    pub of: Of,
    /// The day, as 2026-11-23.
    pub date: String,
    /// What a point of the wall is likely to be off, m, root of the mean square; `None` of a lens alone, or where nobody knows.
    pub off_m: Option<f64>,
    /// Columns and rows of the camera's images, px.
    pub size_px: Option<[usize; 2]>,
    /// Pages of markers that were in sight.
    pub pages: usize,
    /// Name of the head's rig.
    pub rig: Option<String>,
    /// Width and height of the rectangle by whose corners a head was found, m.
    pub area_m: Option<(f64, f64)>,
}

/// What a calibration is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Of {
    /// A camera in front of a wall.
    Camera,
    /// A camera's lens, wherever it stands.
    Lens,
    /// A head in front of a wall.
    Head,
}

/// How good a calibration is for drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Off by at most 0.2 mm.
    Great,
    /// Off by at most 1 mm.
    Usable,
    /// Off by more.
    Poor,
}

impl Of {
    /// One word.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Camera => "camera",
            Self::Lens => "lens",
            Self::Head => "head",
        }
    }
}

impl Verdict {
    /// By how far a point of the wall is likely to be off, m.
    #[must_use]
    pub fn of(off_m: f64) -> Self {
        match off_m {
            m if m <= GREAT_M => Self::Great,
            m if m <= USABLE_M => Self::Usable,
            _ => Self::Poor,
        }
    }

    /// One word.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Great => "great",
            Self::Usable => "usable",
            Self::Poor => "poor",
        }
    }
}

impl Calibrated {
    /// How good it is, where that is known.
    #[must_use]
    pub fn verdict(&self) -> Option<Verdict> {
        self.off_m.map(Verdict::of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_verdict_goes_by_millimetres() {
        let word = |mm: f64| Verdict::of(1e-3 * mm).word();
        assert_eq!([0.05, 0.2, 0.21, 1.0, 1.01].map(word), ["great", "great", "usable", "usable", "poor"]);
    }
}
