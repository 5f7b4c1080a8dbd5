//! What each colour stands for, in everything the program draws: plots, previews, pages. A colour is nowhere else made of numbers.

use crate::rgb::Rgb;
use crate::theme::Theme;

/// A colour with one meaning; or one of those that mean nothing but "another curve". The latter keep clear of the former, and differ in
/// lightness too, for people who see red and green alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colour {
    /// The laser's light, and nothing else: red.
    Light,
    /// Of the joint pan: blue.
    Pan,
    /// Of the joint tilt: orange.
    Tilt,
    /// A limit that is reached, and what went wrong: magenta.
    Limit,
    /// What went well.
    Good,
    /// Of a curve.
    Violet,
    /// Of a curve.
    Ochre,
    /// Of a curve.
    Green,
    /// Of a curve.
    Sky,
    /// Of a curve.
    Slate,
    /// Of a curve.
    Olive,
    /// The ink of the ground.
    Black,
    /// Of what only helps.
    Grey,
}

/// The laser's light as a camera's three channels see it, linear: 650 nm that is overexposed spills into the others and whitens.
pub const LIGHT_LINEAR: [f32; 3] = [1.0, 0.034, 0.040];

impl Colour {
    /// All there are.
    pub const ALL: [Self; 13] = [
        Self::Light,
        Self::Pan,
        Self::Tilt,
        Self::Limit,
        Self::Good,
        Self::Violet,
        Self::Ochre,
        Self::Green,
        Self::Sky,
        Self::Slate,
        Self::Olive,
        Self::Black,
        Self::Grey,
    ];

    /// Of curves that have none of their own, again from the first once there are no more.
    pub fn in_turn() -> impl Iterator<Item = Self> + Clone {
        [Self::Violet, Self::Ochre, Self::Green, Self::Sky, Self::Slate, Self::Olive].into_iter().cycle()
    }

    /// As it is shown on a ground.
    #[must_use]
    pub const fn rgb(self, theme: Theme) -> Rgb {
        let (light, dark) = self.shades();
        Rgb::of(if matches!(theme, Theme::Dark) { dark } else { light })
    }

    /// On a light ground and on a dark one: at least three to one against either.
    const fn shades(self) -> (u32, u32) {
        match self {
            Self::Light => (0xd1_1a2a, 0xff_4d5a),
            Self::Pan => (0x1f_63c6, 0x71_a8ff),
            Self::Tilt => (0xb3_541e, 0xf3_a065),
            Self::Limit => (0xa8_328c, 0xee_8fd8),
            Self::Good => (0x1d_7a46, 0x5f_c88d),
            Self::Violet => (0x76_50c0, 0xac_8df0),
            Self::Ochre => (0xa3_7a00, 0xd9_b13c),
            Self::Green => (0x00_855c, 0x3d_bf95),
            Self::Sky => (0x2f_8fc8, 0x76_c2ee),
            Self::Slate => (0x53_657d, 0x9f_b0c6),
            Self::Olive => (0x7a_8f1c, 0xb3_c656),
            Self::Black => (0x14_1414, 0xf4_f2ee),
            Self::Grey => (0x7d_7d7d, 0x96_9696),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contrast of two colours, WCAG 2.2.
    #[allow(
        clippy::disallowed_methods,
        reason = "a test may ask the C library: it allows for the last digit"
    )]
    fn contrast(a: Rgb, b: Rgb) -> f64 {
        let linear = |v: u8| {
            let v = f64::from(v) / 255.0;
            if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
        };
        let light = |c: Rgb| 0.2126 * linear(c.0) + 0.7152 * linear(c.1) + 0.0722 * linear(c.2) + 0.05;
        let (a, b) = (light(a), light(b));
        a.max(b) / a.min(b)
    }

    #[test]
    fn every_colour_is_seen_on_its_ground() {
        for theme in [Theme::Light, Theme::Dark] {
            for colour in Colour::ALL {
                let seen = contrast(colour.rgb(theme), theme.ground());
                assert!(seen >= 3.0, "{colour:?} on {theme:?}: {seen:.2}");
            }
            for written in [theme.ink(), theme.soft()] {
                let seen = contrast(written, theme.ground()).min(contrast(written, theme.page()));
                assert!(seen >= 4.5, "{written} on {theme:?}: {seen:.2}");
            }
        }
    }

    #[test]
    fn no_two_meanings_share_a_colour() {
        for theme in [Theme::Light, Theme::Dark] {
            for (i, a) in Colour::ALL.into_iter().enumerate() {
                for b in &Colour::ALL[..i] {
                    let (p, q) = (a.rgb(theme), b.rgb(theme));
                    let apart = p.0.abs_diff(q.0).max(p.1.abs_diff(q.1)).max(p.2.abs_diff(q.2));
                    assert!(apart >= 24, "{a:?} and {b:?} on {theme:?}");
                }
            }
        }
    }

    #[test]
    fn nothing_but_light_is_as_red() {
        for theme in [Theme::Light, Theme::Dark] {
            for colour in Colour::ALL.into_iter().filter(|&colour| colour != Colour::Light) {
                let Rgb(r, g, b) = colour.rgb(theme);
                let red = i32::from(r) - i32::from(g.max(b));
                assert!(red < 100, "{colour:?} on {theme:?}");
            }
        }
    }
}
