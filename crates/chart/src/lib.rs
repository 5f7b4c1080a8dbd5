//! Figures of curves as SVG, and that as PNG: panels in a grid under one title and one legend. Values in, text out: what the curves
//! are is nobody's business here. And what colours stand for, in everything that is drawn: [`Colour`], [`Ramp`], [`Theme`].

mod colour;
mod css;
mod figure;
mod legend;
mod linear;
mod pixels;
mod ramp;
mod range;
mod rgb;
mod theme;
mod words;

pub use colour::{Colour, LIGHT_LINEAR};
pub use css::{dark_style, page_colours};
pub use figure::{Curve, Figure, Guide, Key, Mark, Panel, Pen, Scale, Sign};
pub use pixels::pixels;
pub use ramp::{ERROR_STEPS_MM, Ramp, STEPS, error_step, share_step};
pub use rgb::Rgb;
pub use theme::Theme;
