//! How a drawing looks to a camera: levels of paper and ink, light, and what spoils a picture.

use tracelight_stroke::Point;

use crate::desk::Desk;
use crate::grain::Grain;
use crate::ink::{dot, draw};
use crate::light::{Light, one_sided, shadow, soft};
use crate::medium::Medium;
use crate::paper::Paper;
use crate::picture::through_jpeg;
use crate::plane::{Plane, blur};
use crate::random::Normal;
use crate::shapes::line;
use crate::warp::Warp;
use crate::{Degradation, Ink, Kind, Nib, Page, Random, Size};

/// Share of pixels that speckle hits.
const SPECKS: f64 = 0.0006;
/// Strongest blur, σ in px on 240 rows.
const BLUR_240: f64 = 0.8;
/// Blur stays below these shares of the pen and of the least paper between lines: more undoes them.
const BLUR_OF_PEN: f64 = 0.45;
const BLUR_OF_PAPER: f64 = 0.27;
/// Least difference of the levels of tinted ink and paper.
const LEAST_TINT: f64 = 90.0;
/// This share of the sheets on tables is ruled or squared.
const RULED_ON_A_TABLE: f64 = 0.3;

/// Everything about how a picture looks, decided.
pub(crate) struct Look {
    paper: [f64; 3],
    ink: [f64; 3],
    light: Light,
    blur_px: f64,
    noise: f64,
    specks: f64,
    jpeg: Option<u8>,
    rules: Option<f64>,
    dust: usize,
    /// What the second ink has of the first one's darkness.
    second: Option<f64>,
    medium: Medium,
    /// The paper's own grain, and how many levels it is deep.
    tooth: Option<(Grain, f64)>,
    printed: Option<Paper>,
    desk: Option<Desk>,
    /// Whether it has two tones and nothing between.
    is_cut: bool,
}

impl Look {
    pub(crate) fn clean(paper: f64, ink: f64) -> Self {
        Self {
            paper: [paper; 3],
            ink: [ink; 3],
            light: Light::Even,
            blur_px: 0.0,
            noise: 0.0,
            specks: 0.0,
            jpeg: None,
            rules: None,
            dust: 0,
            second: None,
            medium: Medium::Pen,
            tooth: None,
            printed: None,
            desk: None,
            is_cut: false,
        }
    }

    /// As a webcam sees black ink on white paper: `quality.py`'s recipe.
    pub(crate) fn webcam(size: Size, paper: f64, ink: f64) -> Self {
        let blur_px = BLUR_240 * size.height as f64 / 240.0;
        let light = Light::Lamp(0.15, 0.1);
        Self { light, blur_px, noise: 6.0, specks: SPECKS, ..Self::clean(paper, ink) }
    }

    /// A degradation's look for a page; some of it is drawn at random.
    pub(crate) fn of(degradation: Degradation, random: &mut Random, size: Size, page: &Page) -> Self {
        let most_blur = (BLUR_240 * size.height as f64 / 240.0)
            .min(BLUR_OF_PEN * page.pen)
            .min(BLUR_OF_PAPER * page.paper);
        let look = Self::clean(random.between(225.0, 255.0), random.between(0.0, 60.0));
        match degradation {
            Degradation::Clean | Degradation::Perspective => look,
            Degradation::Light => Self { light: one_sided(random), ..look },
            Degradation::Shadow => Self { light: shadow(random), ..look },
            Degradation::Vignette => Self { light: Light::Vignette(random.between(0.3, 0.55)), ..look },
            Degradation::Blur => Self { blur_px: most_blur * random.between(0.5, 1.0), ..look },
            Degradation::Noise => Self { noise: random.between(2.0, 6.0), ..look },
            Degradation::Noise10 => Self { noise: 10.0, ..look },
            Degradation::Speckle => Self { specks: SPECKS, ..look },
            Degradation::Jpeg => Self { jpeg: Some(random.whole(55, 85) as u8), ..look },
            Degradation::Tint => tinted(random),
            Degradation::Inverted => Self { paper: look.ink, ink: look.paper, ..look },
            Degradation::Pencil => pencil(random),
            Degradation::Ruled => Self { rules: Some(random.between(0.15, 0.3)), ..look },
            Degradation::Dust => Self { dust: random.whole(4, 20), ..look },
            Degradation::Webcam => {
                let light = one_sided(random);
                Self { light, blur_px: most_blur, noise: 6.0, specks: SPECKS, ..look }
            }
            Degradation::Photo => {
                let noise = random.between(1.0, 4.0);
                Self { light: shadow(random), noise, jpeg: Some(random.whole(60, 90) as u8), ..look }
            }
            Degradation::Sun => {
                let pale = random.between(0.0, 0.5);
                let ink = look.paper.map(|paper| pale * paper);
                Self { light: soft(random, size.height as f64), ink, noise: random.between(1.0, 3.0), ..look }
            }
            Degradation::Inks => {
                Self { second: Some(random.between(0.3, 0.6)), noise: random.between(1.0, 3.0), ..look }
            }
        }
    }

    /// The same, with the pen, the paper and the table that a kind of the world has.
    pub(crate) fn of_kind(
        self,
        random: &mut Random,
        (kind, size): (Kind, Size),
        page: &Page,
        warp: Option<&Warp>,
    ) -> Self {
        match kind {
            Kind::Graphite => self.pencilled(random, page.pen),
            Kind::Sketched => self.pencilled(random, crate::kinds::sketched::OWN_PEN * page.pen),
            Kind::Crayon => self.crayoned(random, page.pen),
            Kind::Retouched if random.chance(0.4) => self.pencilled(random, page.pen),
            Kind::Silhouette => self.cut(random),
            Kind::Felt => self.felt(random),
            Kind::Ballpoint => Self { medium: Medium::ballpoint(random, page.pen), ..self },
            Kind::Ruled | Kind::Squared | Kind::Dotted => {
                Self { printed: Paper::under(random, kind, size, &page.strokes(), page.pen), ..self }
            }
            Kind::Table => self.on_a_table(random, size, page, warp),
            _ => self,
        }
    }

    /// A pencil on paper with a grain: pressed fully 30 to 65 % contrast, on the grain and lightly pressed down to 15 %.
    fn pencilled(self, random: &mut Random, pen: f64) -> Self {
        let paper = random.between(200.0, 245.0);
        let ink = paper * (1.0 - random.between(0.3, 0.65));
        let grain = Grain::new(random.bits(), (2.0, 2.0));
        Self {
            paper: [paper; 3],
            ink: [ink; 3],
            medium: Medium::graphite(random, pen),
            tooth: Some((grain, random.between(2.0, 8.0))),
            noise: self.noise.min(2.0),
            specks: 0.0,
            ..self
        }
    }

    /// A crayon on paper with a grain, 40 to 85 % contrast where it is pressed fully.
    fn crayoned(self, random: &mut Random, pen: f64) -> Self {
        let pencilled = self.pencilled(random, pen);
        let ink = pencilled.paper[0] * (1.0 - random.between(0.4, 0.85));
        Self { ink: [ink; 3], medium: Medium::crayon(random, pen), ..pencilled }
    }

    fn felt(self, random: &mut Random) -> Self {
        let paper = random.between(190.0, 250.0);
        let ink = random.between(0.0, 70.0);
        Self { paper: [paper; 3], ink: [ink; 3], medium: Medium::Felt(random.between(0.6, 0.9)), ..self }
    }

    /// White on black now and then; what nothing spoils has no shades as often as not.
    fn cut(self, random: &mut Random) -> Self {
        let is_clean = matches!(self.light, Light::Even) && self.noise == 0.0 && self.jpeg.is_none();
        let is_cut = is_clean && random.chance(0.5);
        let (paper, ink) = if random.chance(0.4) { (self.ink, self.paper) } else { (self.paper, self.ink) };
        Self { paper, ink, is_cut, ..self }
    }

    fn on_a_table(self, random: &mut Random, size: Size, page: &Page, warp: Option<&Warp>) -> Self {
        let Some(warp) = warp else { return self };
        let paper = random.between(170.0, 245.0);
        let seen = page.figures.iter().flat_map(|f| &f.strokes).map(|s| warp.path(&s.path));
        let points: Vec<Point> = seen.flat_map(|p| p.flatten(0.5)).collect();
        let light = if random.chance(0.5) { shadow(random) } else { self.light };
        let desk = Some(Desk::around(random, size, paper, (warp, &points)));
        let ink = [random.between(0.0, 0.4) * paper; 3];
        let pattern = if random.chance(0.5) { Kind::Ruled } else { Kind::Squared };
        let printed = random
            .chance(RULED_ON_A_TABLE)
            .then(|| Paper::under(random, pattern, size, &page.strokes(), page.pen))
            .flatten();
        Self { paper: [paper; 3], ink, light, desk, printed, ..self }
    }

    /// The grey levels of a picture with this ink on it.
    pub(crate) fn levels(
        &self,
        random: &mut Random,
        size: Size,
        ink: &[Vec<&Ink>],
        warp: Option<&Warp>,
    ) -> Vec<u8> {
        let (width, height) = (size.width, size.height);
        let mut covered = self.covered(random, size, ink, warp);
        (0..self.dust).for_each(|_| {
            let at = Point::new(random.between(0.0, width as f64), random.between(0.0, height as f64));
            dot(&mut covered, at, 0.5 * random.between(1.0, 3.0));
        });
        let mut ruled = Plane::filled(width, height, 0.0);
        if self.rules.is_some() {
            rules(random, size).iter().for_each(|ink| draw(&mut ruled, ink, warp));
        }
        if let Some(paper) = &self.printed {
            let mut printed = Plane::filled(width, height, 0.0);
            paper.ink().iter().for_each(|ink| draw(&mut printed, ink, warp));
            printed.values.iter_mut().for_each(|v| *v *= paper.dark as f32);
            covered.at_least(&printed);
        }
        let mut seen = self.composed(&covered, &ruled);
        self.textured(&mut seen);
        if let (Some(desk), Some(warp)) = (&self.desk, warp) {
            desk.cover(&mut seen, warp);
        }
        self.lit(&mut seen);
        blur(&mut seen, self.blur_px);
        self.spoil(random, &mut seen);
        if self.is_cut {
            let (paper, ink) = (self.paper[0] as f32, self.ink[0] as f32);
            let is_ink = |level: f32| (level - ink).abs() < (level - paper).abs();
            seen.values.iter_mut().for_each(|v| *v = if is_ink(*v) { ink } else { paper });
        }
        let levels = seen.values.iter().map(|v| v.round().clamp(0.0, 255.0) as u8).collect();
        match self.jpeg {
            Some(quality) => through_jpeg(levels, width, height, quality),
            None => levels,
        }
    }

    /// How much of the first ink's darkness each pixel has from the ink, what one stroke is of together.
    fn covered(&self, random: &mut Random, size: Size, ink: &[Vec<&Ink>], warp: Option<&Warp>) -> Plane {
        if !matches!(self.medium, Medium::Pen) {
            return self.medium.covered(size, ink, warp);
        }
        let mut inks = [(); 2].map(|()| Plane::filled(size.width, size.height, 0.0));
        // by turns and not by chance: a picture with two strokes has both inks
        let first = self.second.map_or(0, |_| random.whole(0, 1));
        for (number, together) in ink.iter().enumerate() {
            let which = if self.second.is_some() { (first + number) % 2 } else { 0 };
            together.iter().for_each(|ink| draw(&mut inks[which], ink, warp));
        }
        let [mut covered, mut pale] = inks;
        pale.values.iter_mut().for_each(|v| *v *= self.second.unwrap_or(0.0) as f32);
        covered.at_least(&pale);
        covered
    }

    /// Paper, rules and ink by their coverage, red, green and blue rounded and then made grey as the host does it.
    fn composed(&self, covered: &Plane, ruled: &Plane) -> Plane {
        let share = self.rules.unwrap_or(0.0);
        let level = |(&ink, &rule): (&f32, &f32)| {
            let (ink, rule) = (f64::from(ink), share * f64::from(rule));
            let colour = |i: usize| {
                let under = self.paper[i] + (self.ink[i] - self.paper[i]) * rule;
                under + (self.ink[i] - under) * ink
            };
            if self.paper[0] == self.paper[1] && self.paper[1] == self.paper[2] {
                colour(0) as f32
            } else {
                luma([0, 1, 2].map(|i| colour(i).round() as u32)) as f32
            }
        };
        let values = covered.values.iter().zip(&ruled.values).map(level).collect();
        Plane { values, ..*covered }
    }

    fn textured(&self, seen: &mut Plane) {
        let Some((grain, depth)) = self.tooth else { return };
        for (i, value) in seen.values.iter_mut().enumerate() {
            let (x, y) = ((i % seen.width) as f64, (i / seen.width) as f64);
            *value += (depth * (grain.at(x, y) - 0.5)) as f32;
        }
    }

    fn lit(&self, seen: &mut Plane) {
        if matches!(self.light, Light::Even) {
            return;
        }
        let (width, height) = (seen.width as f64, seen.height as f64);
        for (i, value) in seen.values.iter_mut().enumerate() {
            let (x, y) = ((i % seen.width) as f64, (i / seen.width) as f64);
            *value *= self.light.at(x, y, width, height) as f32;
        }
    }

    fn spoil(&self, random: &mut Random, seen: &mut Plane) {
        if self.noise > 0.0 {
            let normal = Normal::new();
            for four in seen.values.chunks_mut(4) {
                let draws = normal.four(random);
                four.iter_mut().zip(draws).for_each(|(v, d)| *v += d * self.noise as f32);
            }
        }
        let specks = (seen.values.len() as f64 * self.specks) as usize;
        for _ in 0..specks {
            let at = random.whole(0, seen.values.len() - 1);
            seen.values[at] = random.pick(&[0.0, 255.0]);
        }
    }
}

fn pencil(random: &mut Random) -> Look {
    let paper = random.between(215.0, 245.0);
    Look { noise: 1.5, ..Look::clean(paper, paper * (1.0 - random.between(0.2, 0.3))) }
}

/// Pastel paper and dark ink of any colours that still differ enough in grey.
fn tinted(random: &mut Random) -> Look {
    let mut colour = |least: f64, most: f64| [0; 3].map(|_| random.between(least, most));
    let mut found = Look::clean(240.0, 20.0);
    for _ in 0..100 {
        let (paper, ink) = (colour(150.0, 255.0), colour(0.0, 190.0));
        let grey = |c: [f64; 3]| f64::from(luma(c.map(|v| v as u32)));
        if grey(paper) - grey(ink) >= LEAST_TINT {
            found = Look { paper, ink, ..found };
            break;
        }
    }
    found
}

/// ITU-R BT.601 luma in integers, as the host program makes grey of colours.
fn luma([r, g, b]: [u32; 3]) -> u32 {
    (299 * r + 587 * g + 114 * b + 500) / 1000
}

/// Level lines across the page, squared now and then.
fn rules(random: &mut Random, size: Size) -> Vec<Ink> {
    let (width, height) = (size.width as f64, size.height as f64);
    let pitch = height * random.between(1.0 / 22.0, 1.0 / 12.0);
    let pen = (height / 240.0).max(1.0) * random.between(0.8, 1.2);
    let first = pitch * random.between(0.2, 1.0);
    let ink = |from: Point, to: Point| Ink::Line { path: line(from, to), pen, nib: Nib::Round };
    let count = |length: f64| ((length - first) / pitch) as usize + 1;
    let level = (0..count(height)).map(|i| first + pitch * i as f64);
    let mut rules: Vec<_> = level.map(|y| ink(Point::new(-9.0, y), Point::new(width + 9.0, y))).collect();
    if random.chance(0.4) {
        let upright = (0..count(width)).map(|i| first + pitch * i as f64);
        rules.extend(upright.map(|x| ink(Point::new(x, -9.0), Point::new(x, height + 9.0))));
    }
    rules
}
