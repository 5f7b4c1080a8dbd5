//! Scales of colours for what is more or less.

use crate::rgb::Rgb;
use crate::theme::Theme;

/// Colours of a scale.
pub const STEPS: usize = 8;

/// Where the scale of errors changes its colour, mm: the same in every picture, so that two can be compared by eye.
pub const ERROR_STEPS_MM: [f64; STEPS - 1] = [0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0];

/// A scale: what is more stands out more from its ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ramp {
    /// How far something is from where it should be: from green-blue to indigo.
    Error,
    /// Anything else that is more or less, or earlier or later: from pale to deep violet.
    Amount,
    /// Kinds of a thing that is not looked for: greys.
    Grey,
}

const ERROR: [(u32, u32); STEPS] = [
    (0x52_b3a6, 0x34_8490),
    (0x3f_a4a8, 0x43_959f),
    (0x2f_91a9, 0x57_a7af),
    (0x27_7aa2, 0x70_b9bd),
    (0x25_6396, 0x8d_cbc9),
    (0x26_4b84, 0xae_dcd6),
    (0x24_336b, 0xcf_ece4),
    (0x1a_1a49, 0xf3_fcf7),
];
const AMOUNT: [(u32, u32); STEPS] = [
    (0xc9_bbe8, 0x4d_4172),
    (0xb5_a2df, 0x60_5190),
    (0xa0_88d4, 0x74_62ad),
    (0x8b_6ec8, 0x8a_76c9),
    (0x75_56b6, 0xa3_8fe0),
    (0x5e_409c, 0xbd_acf0),
    (0x48_2d7e, 0xd7_ccfa),
    (0x31_1c5c, 0xf0_ebff),
];
const GREY: [(u32, u32); STEPS] = [
    (0xd8_d5cf, 0x3e_4046),
    (0xc4_c1bb, 0x50_5258),
    (0xaf_aca6, 0x63_656b),
    (0x98_958f, 0x78_7a80),
    (0x81_7e79, 0x8f_9196),
    (0x69_6762, 0xa8_a9ad),
    (0x51_4f4b, 0xc3_c4c6),
    (0x39_3835, 0xde_dee0),
];

impl Ramp {
    /// All there are.
    pub const ALL: [Self; 3] = [Self::Error, Self::Amount, Self::Grey];

    /// The colour of a step, from 0; the last one for all beyond.
    #[must_use]
    pub fn rgb(self, step: usize, theme: Theme) -> Rgb {
        let colours = match self {
            Self::Error => &ERROR,
            Self::Amount => &AMOUNT,
            Self::Grey => &GREY,
        };
        let (light, dark) = colours[step.min(STEPS - 1)];
        Rgb::of(if theme == Theme::Dark { dark } else { light })
    }
}

/// The step of an error.
#[must_use]
pub fn error_step(error_mm: f64) -> usize {
    ERROR_STEPS_MM.iter().filter(|&&from| error_mm >= from).count()
}

/// The step of a share of all, 0 to 1.
#[must_use]
pub fn share_step(share: f64) -> usize {
    ((STEPS as f64 * share) as usize).min(STEPS - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_is_further_from_the_ground() {
        let weight = |c: Rgb| 299 * u32::from(c.0) + 587 * u32::from(c.1) + 114 * u32::from(c.2);
        for ramp in Ramp::ALL {
            for step in 1..STEPS {
                for theme in [Theme::Light, Theme::Dark] {
                    let away = |step: usize| weight(ramp.rgb(step, theme)).abs_diff(weight(theme.ground()));
                    assert!(away(step) > away(step - 1) + 8000, "{ramp:?} {step} {theme:?}");
                }
            }
        }
    }

    #[test]
    fn steps_are_fixed_and_their_ends_are_open() {
        let of = [0.0, 0.049, 0.05, 0.3, 4.99, 5.0, 1e9, f64::NAN].map(error_step);
        assert_eq!(of, [0, 0, 1, 3, 6, 7, 7, 0]);
        assert_eq!([-1.0, 0.0, 0.13, 0.99, 1.0, 7.0].map(share_step), [0, 0, 1, 7, 7, 7]);
    }
}
