//! Figures of curves as SVG, and that as PNG: panels in a grid under one title and one legend. Values in, text out: what the curves
//! are is nobody's business here. And what colours stand for, in everything that is drawn: [`Colour`], [`Ramp`], [`Theme`].

mod arrow;
mod colour;
mod css;
mod figure;
mod label;
mod legend;
mod lettering;
mod linear;
mod pixels;
mod ramp;
mod range;
mod rgb;
mod shape;
mod theme;
mod words;

pub use arrow::Arrows;
pub use colour::{Colour, LIGHT_LINEAR};
pub use css::{dark_style, page_colours};
pub use figure::{Figure, Key, Panel, Scale};
pub use label::Label;
pub use pixels::pixels;
pub use ramp::{ERROR_STEPS_MM, Ramp, STEPS, error_step, share_step};
pub use rgb::Rgb;
pub use shape::{Band, Curve, Guide, Mark, Pen, Sign};
pub use theme::Theme;
