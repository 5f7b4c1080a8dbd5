use clap::ValueEnum;

use crate::Set;

/// What is done to a clean picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub enum Degradation {
    /// Nothing.
    Clean,
    /// Light from one side, 1 falling to 0.35.
    Light,
    /// A shadow with a hard edge, 0.5 to 0.7 of the light.
    Shadow,
    /// Corners darker, down to 0.45.
    Vignette,
    /// Out of focus, up to 0.8 px per 240 rows.
    Blur,
    /// Noise up to σ 6 levels.
    Noise,
    /// Noise of σ 10.
    Noise10,
    /// Single pixels black or white, 0.06 %.
    Speckle,
    /// JPEG of quality 55 to 85.
    Jpeg,
    /// Coloured ink on coloured paper.
    Tint,
    /// Light ink on dark paper.
    Inverted,
    /// Faint pencil: contrast 20 to 30 %.
    Pencil,
    /// Ruled paper, its rules at 15 to 30 % of the ink's contrast.
    Ruled,
    /// A few specks of 1 to 3 px.
    Dust,
    /// Seen up to 5° aside.
    Perspective,
    /// Light from one side, blur, noise of σ 6, speckle.
    Webcam,
    /// Shadow, perspective, JPEG, noise.
    Photo,
    /// A pen and a pencil on one sheet: some figures at 30 to 60 % of the others' contrast; noise.
    Inks,
    /// Sun through a window, or a soft shadow: 0.45 to 0.75 of the light beside it; a pen up to half as pale as the paper, noise.
    Sun,
}

impl Degradation {
    /// What is done to the drawings of a set. The kinds of the world bring pens, papers and tables of their own; cameras
    /// are all that is left to spoil them.
    pub fn of(set: Set) -> &'static [Self] {
        match set {
            // `Sun` came later
            Set::Plain => &Self::value_variants()[..Self::Sun as usize],
            Set::World => &[
                Self::Clean,
                Self::Light,
                Self::Blur,
                Self::Noise,
                Self::Jpeg,
                Self::Webcam,
                Self::Photo,
                Self::Sun,
            ],
        }
    }

    /// As it is typed.
    pub fn name(self) -> String {
        self.to_possible_value().map(|v| v.get_name().to_owned()).unwrap_or_default()
    }

    pub(crate) fn is_tilted(self) -> bool {
        matches!(self, Self::Perspective | Self::Photo)
    }
}
