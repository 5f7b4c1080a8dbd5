//! Which picture: kind × degradation × size × seed.

use std::fmt;
use std::str::FromStr;

use tracelight_stroke::Drawing;

use crate::kinds::sketched::OWN_PEN;
use crate::look::Look;
use crate::warp::Warp;
use crate::{Degradation, Figure, Ink, Kind, Page, Picture, Random, Set, desk};

/// Furthest a page is seen aside, degrees.
const MOST_TILT_DEG: f64 = 5.0;
/// Seen so far aside, lengths of the far edge shrink by up to this.
const ROOMY: f64 = 1.08;

/// Pixels of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Size {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

impl Size {
    /// The sizes that pictures have, each as often as its weight: many small ones, few of 4K.
    pub const USUAL: [(Self, usize); 5] = [
        (Self { width: 320, height: 240 }, 28),
        (Self { width: 640, height: 480 }, 34),
        (Self { width: 1280, height: 720 }, 24),
        (Self { width: 1920, height: 1080 }, 10),
        (Self { width: 3840, height: 2160 }, 4),
    ];

    /// The sizes of the world: also stamps of a web page, and what a phone takes.
    pub const OF_THE_WORLD: [(Self, usize); 9] = [
        (Self { width: 70, height: 70 }, 3),
        (Self { width: 96, height: 96 }, 3),
        (Self { width: 160, height: 120 }, 4),
        (Self { width: 320, height: 240 }, 24),
        (Self { width: 640, height: 480 }, 30),
        (Self { width: 1280, height: 720 }, 22),
        (Self { width: 1920, height: 1080 }, 9),
        (Self { width: 3840, height: 2160 }, 3),
        (Self { width: 4000, height: 3000 }, 2),
    ];

    /// What phones take.
    pub const OF_A_PHONE: [(Self, usize); 4] = [
        (Self { width: 1280, height: 960 }, 40),
        (Self { width: 1600, height: 1200 }, 30),
        (Self { width: 2560, height: 1920 }, 20),
        (Self { width: 4000, height: 3000 }, 10),
    ];

    /// The sizes of a kind's pictures, and how often each comes.
    pub fn of(kind: Kind) -> &'static [(Self, usize)] {
        match (kind, kind.set()) {
            (_, Set::Plain) => &Self::USUAL,
            (Kind::Crayon | Kind::Ballpoint, Set::World) => &Self::OF_A_PHONE,
            (_, Set::World) => &Self::OF_THE_WORLD,
        }
    }

    /// What a drawn line may be off and still be the true one, px: 2, and more where the picture has over 720 rows.
    pub fn tolerance_px(self) -> f64 {
        (self.height as f64 / 360.0).max(2.0)
    }

    fn usual(kind: Kind, random: &mut Random) -> Self {
        let sizes = Self::of(kind);
        let sum = sizes.iter().map(|(_, weight)| weight).sum::<usize>();
        let mut left = random.whole(0, sum - 1);
        for &(size, weight) in sizes {
            if left < weight {
                return size;
            }
            left -= weight;
        }
        sizes[0].0
    }
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}", self.width, self.height)
    }
}

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let sides = text.split_once('x').and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
        let known = sides.filter(|(w, h)| (64..=8000).contains(w) && (64..=8000).contains(h));
        let (width, height) =
            known.ok_or_else(|| format!("{text}: give a size such as 640x480, 64 to 8000 px"))?;
        Ok(Self { width, height })
    }
}

/// One picture's name: it is the same wherever it is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Case {
    /// What is drawn.
    pub kind: Kind,
    /// What is done to it.
    pub degradation: Degradation,
    /// How large it is.
    pub size: Size,
    /// What decides the rest.
    pub seed: u128,
}

/// What may be asked of cases.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Of this set; a kind that is wanted brings its own.
    pub set: Set,
    /// Only this kind.
    pub kind: Option<Kind>,
    /// Only this degradation.
    pub degradation: Option<Degradation>,
    /// Only this size.
    pub size: Option<Size>,
}

impl Case {
    /// `count` cases: kinds in turn, degradations in turn within each, sizes by their weights.
    pub fn series(seed: u64, count: usize, wanted: &Wanted) -> Vec<Self> {
        let set = wanted.kind.map_or(wanted.set, Kind::set);
        let kinds = wanted.kind.map_or_else(|| Kind::of(set).to_vec(), |k| vec![k]);
        let degradations = wanted.degradation.map_or_else(|| Degradation::of(set).to_vec(), |d| vec![d]);
        let case = |i: usize| {
            let seed = mixed(seed, i as u64);
            let kind = kinds[i % kinds.len()];
            Self {
                kind,
                degradation: degradations[i / kinds.len() % degradations.len()],
                size: wanted.size.unwrap_or_else(|| Size::usual(kind, &mut Random::new(seed))),
                seed,
            }
        };
        (0..count).map(case).collect()
    }

    /// The page, before anything is done to it.
    pub fn page(&self) -> Page {
        let roomy = match self.laid() {
            Some(warp) => 1.0 / warp.least_scale(self.size),
            None if self.is_tilted() => ROOMY,
            None => 1.0,
        };
        Page::draw(&mut Random::new(self.seed ^ 1), self.kind, self.size, roomy)
    }

    /// What a drawn line may be off and still be the true one, px: that of the picture's size, and anywhere between the passes of a sketch.
    pub fn tolerance_px(&self, picture: &Picture) -> f64 {
        let least = self.size.tolerance_px();
        match self.kind {
            Kind::Sketched => {
                let passes = picture.truth.strokes.iter().filter_map(|stroke| stroke.pen).fold(0.0, f64::max);
                least.max(0.5 * (1.0 - OWN_PEN) * passes)
            }
            _ => least,
        }
    }

    /// How a sheet on a table lies.
    fn laid(&self) -> Option<Warp> {
        (self.kind == Kind::Table).then(|| desk::lay(&mut Random::new(self.seed ^ 3), self.size))
    }

    /// A frame along the border would leave the picture.
    fn is_tilted(&self) -> bool {
        self.degradation.is_tilted() && self.kind != Kind::Frame
    }

    /// The picture with its truth.
    pub fn draw(&self) -> Picture {
        let page = self.page();
        let random = &mut Random::new(self.seed ^ 2);
        let look = Look::of(self.degradation, random, self.size, &page);
        let tilt = random.between(2.0, MOST_TILT_DEG).to_radians() * random.sign();
        let tilted = self.is_tilted().then(|| Warp::new(self.size, random.angle(), tilt));
        let warp = self.laid().or(tilted);
        let look = match self.kind.set() {
            Set::Plain => look,
            Set::World => look.of_kind(random, (self.kind, self.size), &page, warp.as_ref()),
        };
        let ink: Vec<Vec<&Ink>> = page.figures.iter().flat_map(Figure::by_stroke).collect();
        let strokes = page.strokes();
        Picture {
            width: self.size.width,
            height: self.size.height,
            levels: look.levels(random, self.size, &ink, warp.as_ref()),
            truth: warp.map_or_else(|| Drawing { strokes: strokes.clone() }, |w| w.drawing(&strokes)),
        }
    }
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}-{}-{}-{:08x}", self.kind.name(), self.degradation.name(), self.size, self.seed as u32)
    }
}

/// Two words mixed so that neighbours have nothing in common: Steele, Lea and Flood, *Fast splittable pseudorandom number
/// generators*, 2014 (SplitMix64's finalizer).
fn mixed(seed: u64, number: u64) -> u128 {
    let mix = |z: u64| {
        let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    };
    let word = |salt: u64| {
        mix(mix(seed.wrapping_add(salt)).wrapping_add(number.wrapping_mul(0x9E37_79B9_7F4A_7C15)))
    };
    // the lowest bits stay free: one seed for each use
    (u128::from(word(1)) << 64 | u128::from(word(2))) << 2
}
