//! Description of the paper's rules for reports.

/// Rules of paper that were taken out of an image.
#[derive(Clone, Debug, PartialEq)]
pub struct Rules {
    /// One for ruled paper, two for squared.
    pub combs: Vec<Comb>,
}

impl Rules {
    /// In pixels of another size.
    pub(crate) fn scaled(mut self, by: f64) -> Self {
        for comb in &mut self.combs {
            comb.spacing_px *= by;
            comb.width_px *= by;
        }
        self
    }
}

/// Parallel rules.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comb {
    /// How many.
    pub count: usize,
    /// From one's middle to the next one's, px.
    pub spacing_px: f64,
    /// Their width where they are half as dark as at their darkest, px.
    pub width_px: f64,
    /// Whether they lead from top to bottom, or from left to right.
    pub upright: bool,
    /// How far they are turned from that, counter-clockwise as seen, rad.
    pub turned_rad: f64,
}
