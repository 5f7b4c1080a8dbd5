//! Figures of curves as SVG, and that as PNG: panels in a grid under one title and one legend. Values in, text out: what the curves
//! are is nobody's business here.

mod colour;
mod figure;
mod linear;
mod pixels;
mod range;
mod theme;

pub use colour::Colour;
pub use figure::{Curve, Figure, Guide, Key, Mark, Panel, Pen, Scale, Sign};
pub use pixels::pixels;
pub use theme::Theme;
