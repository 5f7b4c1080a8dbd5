//! In which order the strokes are drawn.

use tracelight_stroke::Effort;

/// What the order is to save.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OrderBy {
    /// Seconds of dark moves.
    #[default]
    Time,
    /// Metres of dark moves.
    Distance,
}

/// What order somebody at the wall can follow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sequence {
    /// Any: the one that saves most.
    #[default]
    Free,
    /// Layer by layer, as the drawing has them; within a layer, the one that saves most.
    Layers,
    /// As a page is read: rows from the top, each from the left.
    Reading,
}

/// What is asked of an order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OrderRequest {
    /// What may come after what.
    pub sequence: Sequence,
    /// What it is to save.
    pub by: OrderBy,
    /// How much work goes into it.
    pub effort: Effort,
}
