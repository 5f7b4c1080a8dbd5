//! Colours of a ground, and of what is written on it.

use crate::rgb::Rgb;

/// Light or dark ground.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    /// White.
    #[default]
    Light,
    /// Nearly black.
    Dark,
}

impl Theme {
    /// What plots and cards of a page stand on.
    #[must_use]
    pub const fn ground(self) -> Rgb {
        self.pick(0xff_ffff, 0x1b_1c1f)
    }

    /// A page around its cards.
    #[must_use]
    pub const fn page(self) -> Rgb {
        self.pick(0xfa_f9f7, 0x13_1416)
    }

    /// A wall that is drawn on.
    #[must_use]
    pub const fn wall(self) -> Rgb {
        self.pick(0xff_fffe, 0x0c_0d0f)
    }

    /// What is written.
    #[must_use]
    pub const fn ink(self) -> Rgb {
        self.pick(0x1c_1b19, 0xeb_e8e2)
    }

    /// What is written beside that.
    #[must_use]
    pub const fn soft(self) -> Rgb {
        self.pick(0x6b_6862, 0xa5_a198)
    }

    /// Lines around things.
    #[must_use]
    pub const fn rule(self) -> Rgb {
        self.pick(0xe4_e1db, 0x33_353b)
    }

    /// Lines that only help.
    #[must_use]
    pub const fn grid(self) -> Rgb {
        self.pick(0xec_e9e4, 0x2a_2c30)
    }

    /// Lines between those.
    pub(crate) const fn fainter(self) -> Rgb {
        self.pick(0xf5_f3f0, 0x22_2327)
    }

    /// A way without light, and axes.
    #[must_use]
    pub const fn dark_way(self) -> Rgb {
        self.pick(0xb9_b5ad, 0x5e_6066)
    }

    const fn pick(self, light: u32, dark: u32) -> Rgb {
        Rgb::of(if matches!(self, Self::Dark) { dark } else { light })
    }
}
