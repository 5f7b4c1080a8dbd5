//! Locates the middle of a pen line to subpixel accuracy.
//!
//! The centroid of the darkness along a cut across the line is the middle of the pen, whatever the pixels' grid does to
//! its edges (sampling by pixel areas keeps first moments; Steger, "An unbiased detector of curvilinear structures",
//! 1998, discusses the others). That needs neither the threshold nor the skeleton to be right to a pixel.

use tracelight_image::Plane;
use tracelight_image::median::{median, middle};
use tracelight_stroke::{Point, Vec2};

/// Distance of the samples across a hair line, px; across a thick one a tenth of it.
const STEP: f64 = 0.5;
/// How far beyond the expected edge the line's edge is looked for, px.
const BEYOND: f64 = 2.5;
/// Samples either side of the middle: no line needs more, as its radius is five of them at most and what lies beyond
/// is five at most.
const MOST_HALF: usize = 10;

/// The line's cross-section at one place.
#[derive(Clone, Copy, Debug)]
struct Section {
    /// From the place to the line's middle along the normal, px.
    offset: f64,
    width: f64,
}

/// A place on a line: which of the given points it came from, where it is, and the line's width there.
#[derive(Clone, Copy, Debug)]
struct Place {
    index: usize,
    at: Point,
    width: f64,
}

/// Places either side with whose median width a place's is compared: a pen's width changes slowly.
const LOCAL: usize = 15;
/// Pairs of places, one on each side, that give the width of a line that swells: most and fewest.
const NEAR_PAIRS: usize = 4;
const LEAST_PAIRS: usize = 2;

/// More places than this left out in a row are a gap: the line cannot be seen there.
const GAP: usize = 2;

/// A row of points moved on to the middle of their line.
#[derive(Clone, Debug)]
pub(crate) struct Ridge {
    /// Between two of them the line cannot be seen.
    pub(crate) stretches: Vec<Stretch>,
    /// The line's width in the median, px.
    pub(crate) width: f64,
    /// Points further apart than this are two stretches', px.
    pub(crate) gap: f64,
}

/// Points of a row where the line can be seen.
#[derive(Clone, Debug)]
pub(crate) struct Stretch {
    pub(crate) points: Vec<Point>,
    /// The numbers of the given points from which the first and the last one came.
    pub(crate) from: [usize; 2],
}

/// Moves points on to the middle of their line, one for every third of its width; those whose cross-section is not
/// that of one line are left out. `radius` is about half the line's width, `radii` are the half widths of the ink at the
/// points. A ring's first stretch may go on after its last.
pub(crate) fn centred(
    dark: &Plane<u8>,
    (points, radii): (&[Point], &[f64]),
    radius: f64,
    ring: bool,
    reach: usize,
) -> Ridge {
    let stride = spacing(2.0 * radius);
    // first across the pixels' own row, then across what became of it: the pixels lead round corners and wobble
    let cuts = Cuts::of(radius, radii, CUT_PX);
    let first: Vec<Place> = (0..points.len())
        .step_by(stride)
        .filter_map(|i| place(dark, i, points[i], normal(points, i, reach, ring)?, cuts.at(i)))
        .collect();
    let width = usual_width(&first).unwrap_or(2.0 * radius);
    let first = of_usual_width(&first, cuts.swell());
    let row: Vec<Point> = first.iter().map(|p| p.at).collect();
    let halves: Vec<f64> = first.iter().map(|p| 0.5 * p.width).collect();
    let cuts = Cuts::of(0.5 * width, &halves, (CUT_PX / stride).max(1));
    let again = |i: usize| place(dark, first[i].index, row[i], normal(&row, i, 3, ring)?, cuts.at(i));
    let second: Vec<Place> = (0..row.len()).filter_map(again).collect();
    let width = usual_width(&second).unwrap_or(width);
    let mut places = without_lone(of_usual_width(&second, cuts.swell()), stride);
    if !ring && add_lost(dark, points, Cut::of(0.5 * width), &mut places) {
        places = without_lone(places, stride);
    }
    // a step from pixel to pixel is up to √2 long
    let gap = std::f64::consts::SQRT_2 * (GAP * stride) as f64;
    let stretch = |row: &[Place]| Stretch {
        points: row.iter().map(|p| p.at).collect(),
        from: [row[0].index, row[row.len() - 1].index],
    };
    let stretches = rows(&places, stride).map(stretch).collect();
    Ridge { stretches, width, gap }
}

/// Points from one place of a line of this width to the next: its bends have at least its width as radius.
fn spacing(width: f64) -> usize {
    ((0.35 * width).round() as usize).clamp(1, 16)
}

/// The middle of the line near `at`.
fn place(dark: &Plane<u8>, index: usize, at: Point, normal: Vec2, cut: Cut) -> Option<Place> {
    let section = section(dark, at, normal, cut)?;
    Some(Place { index, at: at + normal * section.offset, width: section.width })
}

/// The median width; `None` of no places.
fn usual_width(places: &[Place]) -> Option<f64> {
    middle(places.iter().map(|p| p.width).collect())
}

/// Those as wide as the line usually is thereabouts.
fn of_usual_width(places: &[Place], swells: bool) -> Vec<Place> {
    if swells {
        return of_width_between(places);
    }
    let mut kept = Vec::with_capacity(places.len());
    let mut near = Vec::with_capacity(2 * LOCAL + 3);
    // three places at a time: the median of 31 moves by less than the bound in between
    for (i, three) in places.chunks(3).enumerate() {
        let range = (3 * i).saturating_sub(LOCAL)..(3 * i + LOCAL + 1).min(places.len());
        let widths = places[range.clone()].iter().map(|p| p.width);
        let (least, most) = widths.fold((f64::INFINITY, 0.0_f64), |(a, b), w| (a.min(w), b.max(w)));
        // then none is further than that from a median of them
        if most - least <= bound(least) {
            kept.extend_from_slice(three);
            continue;
        }
        near.clear();
        near.extend(places[range].iter().map(|p| p.width));
        let middle = near.len() / 2;
        let usual = *near.select_nth_unstable_by(middle, f64::total_cmp).1;
        kept.extend(three.iter().filter(|place| (place.width - usual).abs() <= bound(usual)));
    }
    kept
}

/// Selects the places of a swelling line that are about as wide as the mean of places equally far before and behind.
fn of_width_between(places: &[Place]) -> Vec<Place> {
    let is_usual = |i: usize| {
        let pair = |k: usize| {
            let (before, after) = (i.checked_sub(k)?, i + k);
            Some(0.5 * (places[before].width + places.get(after)?.width))
        };
        let pairs: Vec<f64> = (1..=NEAR_PAIRS).map_while(pair).collect();
        let near = || places[i.saturating_sub(NEAR_PAIRS)..].iter().take(2 * NEAR_PAIRS + 1).map(|p| p.width);
        // at its ends there are none on one side
        let usual = median(&if pairs.len() < LEAST_PAIRS { near().collect() } else { pairs });
        (places[i].width - usual).abs() <= bound(usual)
    };
    (0..places.len()).filter(|&i| is_usual(i)).map(|i| places[i]).collect()
}

/// Fewer places than this in a row, between two gaps, tell no direction.
const LEAST_STRETCH: usize = 4;

/// Without the stretches that are too short for a direction, unless there is but one.
fn without_lone(places: Vec<Place>, stride: usize) -> Vec<Place> {
    if rows(&places, stride).nth(1).is_none() {
        return places;
    }
    let long = |row: &&[Place]| row.len() >= LEAST_STRETCH;
    rows(&places, stride).filter(long).flatten().copied().collect()
}

/// Corners and blots reach no further than this from the next place, or from a row's end, pen widths.
const CORNER_PENS: f64 = 1.5;
const END_PENS: f64 = 1.0;
/// Fewer places than this in a row, or over less than this share of the pen's width, tell no line.
const LEAST_EVEN: usize = 4;
const LEAST_EVEN_PENS: f64 = 0.8;

/// Adds places to a row of `points` where there are none for long, if several in a row are about as wide as each other:
/// a line goes on thinner or thicker there, as those of letters do. Tells whether it added any.
fn add_lost(dark: &Plane<u8>, points: &[Point], cut: Cut, places: &mut Vec<Place>) -> bool {
    let width = 2.0 * cut.radius;
    let kept: Vec<usize> = places.iter().map(|p| p.index).collect();
    let gaps = std::iter::once(None).chain(kept.iter().map(Some)).zip(kept.iter().map(Some).chain([None]));
    let seen = |i: usize| place(dark, i, points[i], normal(points, i, 4, false)?, cut);
    let least = LEAST_EVEN.max((LEAST_EVEN_PENS * width) as usize);
    let mut lost: Vec<Place> = Vec::new();
    for (before, after) in gaps {
        let (from, to) = (before.map_or(0, |i| i + 1), after.copied().unwrap_or(points.len()));
        let most = width * if before.is_some() && after.is_some() { CORNER_PENS } else { END_PENS };
        if (to - from) as f64 <= most {
            continue;
        }
        // what goes on from a place that is left and is as wide was left out for leaning to a corner
        let leans = |row: &[Place]| {
            let widths: Vec<f64> = row.iter().map(|p| p.width).collect();
            let goes_on = (before.is_some() && row[0].index == from)
                || (after.is_some() && row[row.len() - 1].index + 1 == to);
            goes_on && (median(&widths) - width).abs() <= bound(width)
        };
        let between: Vec<Place> = (from..to).filter_map(seen).collect();
        lost.extend(even_rows(&between).filter(|row| row.len() >= least && !leans(row)).flatten());
    }
    if lost.is_empty() {
        return false;
    }
    places.extend(lost);
    places.sort_unstable_by_key(|p| p.index);
    true
}

/// Rows of places next to each other, as long as they can be, in which each is about as wide as all others.
fn even_rows(places: &[Place]) -> impl Iterator<Item = &[Place]> {
    let mut left = places;
    std::iter::from_fn(move || {
        let first = left.first()?;
        let (mut least, mut most, mut index) = (first.width, first.width, first.index);
        let even = |p: &&Place| {
            (least, most) = (least.min(p.width), most.max(p.width));
            index += 1;
            most - least <= bound(least) && p.index < index
        };
        let (row, rest) = left.split_at(left.iter().take_while(even).count());
        left = rest;
        Some(row)
    })
}

/// How far from the usual width a place of a line may be.
fn bound(usual: f64) -> f64 {
    (0.15 * usual).max(0.5)
}

/// The places parted where more than two in a row are missing.
fn rows(places: &[Place], stride: usize) -> impl Iterator<Item = &[Place]> {
    places.chunk_by(move |a, b| b.index - a.index <= GAP * stride)
}

/// Unit normal of a row of points at one of them, from means of up to `reach` points either side.
fn normal(points: &[Point], i: usize, reach: usize, ring: bool) -> Option<Vec2> {
    let n = points.len();
    let mean = |ahead: bool| {
        let at = |k: usize| match (ahead, ring) {
            (true, false) => points.get(i + k),
            (false, false) => points.get(i.wrapping_sub(k)),
            (true, true) => points.get((i + k) % n),
            (false, true) => points.get((i + n - k % n) % n),
        };
        let (mut sum, mut count) = (Vec2::ZERO, 0.0);
        for p in (1..=reach).map_while(at) {
            (sum, count) = (sum + p.to_vec2(), count + 1.0);
        }
        if count > 0.0 { sum / count } else { points[i].to_vec2() }
    };
    let along = mean(true) - mean(false);
    (along.hypot() > 1e-9).then(|| Vec2::new(-along.y, along.x) / along.hypot())
}

/// How lines of about one width are cut across.
#[derive(Clone, Copy, Debug)]
struct Cut {
    /// About half the line's width, px.
    radius: f64,
    /// Distance of the samples, px.
    step: f64,
    /// Samples either side of the middle.
    half: usize,
}

impl Cut {
    fn of(radius: f64) -> Self {
        let step = STEP.max(radius / 5.0);
        Self { radius, step, half: (((radius + BEYOND) / step).ceil() as usize).min(MOST_HALF) }
    }
}

/// The cuts along a line, which may swell and taper.
struct Cuts {
    usual: Cut,
    /// Half widths, px, of every so many places; none where the line is about as wide all along.
    local: Vec<f64>,
    every: usize,
}

/// Over so many pixels half widths go into one.
const CUT_PX: usize = 16;
/// A line swells whose half width is, over so many places, so much more or less than elsewhere, as a ratio and px: pixels and
/// blots change it by less.
const SWELLS: f64 = 1.3;
const SWELLS_PX: f64 = 1.0;

impl Cuts {
    fn of(radius: f64, radii: &[f64], every: usize) -> Self {
        let local: Vec<f64> = radii.chunks(every).map(median).collect();
        let swells = |r: &f64| {
            let (less, more) = (r.min(radius), r.max(radius));
            more > SWELLS * less && more - less > SWELLS_PX
        };
        let local = if local.iter().any(swells) { local } else { Vec::new() };
        Self { usual: Cut::of(radius), local, every }
    }

    /// Whether the line swells or tapers.
    fn swell(&self) -> bool {
        !self.local.is_empty()
    }

    fn at(&self, place: usize) -> Cut {
        self.local.get(place / self.every).map_or(self.usual, |&radius| Cut::of(radius.max(0.5)))
    }
}

/// A line leads along the picture's border whose normal has at least this share in the border's.
const ALONG_BORDER: f64 = 0.9;

/// The darkness across a line, sample by sample.
struct Profile {
    values: [f32; 2 * MOST_HALF + 1],
    half: usize,
}

impl Profile {
    fn across(dark: &Plane<u8>, at: Point, normal: Vec2, cut: Cut) -> Self {
        let Cut { step, half, .. } = cut;
        let mut values = [0.0; 2 * MOST_HALF + 1];
        let from = at - normal * (half as f64 * step);
        dark.along(from, normal * step, &mut values[..=2 * half]);
        // of a line along the picture's border nothing is seen behind it; one that leads over it goes on there
        let beyond =
            |v: f64, most: usize, way: f64| way.abs() > ALONG_BORDER && !(0.0..=most as f64).contains(&v);
        let is_beyond =
            |place: Point| beyond(place.x, dark.width, normal.x) || beyond(place.y, dark.height, normal.y);
        let place = |k: usize| from + normal * (k as f64 * step);
        // a cut leaves the picture at its ends first
        if is_beyond(place(0)) || is_beyond(place(2 * half)) {
            let cut = values[..=2 * half].iter_mut().enumerate();
            cut.filter(|(k, _)| is_beyond(place(*k))).for_each(|(_, value)| *value = 0.0);
        }
        Self { values, half }
    }

    fn samples(&self) -> &[f32] {
        &self.values[..=2 * self.half]
    }

    /// Where the line is darkest near the middle, and how dark.
    fn peak(&self, inner: usize) -> (usize, f32) {
        let core = self.half - inner..=self.half + inner;
        let darker =
            |best: (usize, f32), i: usize| if self.values[i] > best.1 { (i, self.values[i]) } else { best };
        core.fold((self.half, 0.0), darker)
    }
}

/// The cross-section through `at`; `None` where the line has no two edges near the expected ones or lies elsewhere.
fn section(dark: &Plane<u8>, at: Point, normal: Vec2, cut: Cut) -> Option<Section> {
    let Cut { radius, step, .. } = cut;
    let profile = Profile::across(dark, at, normal, cut);
    let inner = (((0.7 * radius).max(1.0) / step).round() as usize).min(profile.half);
    let (top, peak) = profile.peak(inner);
    let level = 0.5 * peak;
    let start = if profile.values[profile.half] >= level { profile.half } else { top };
    let samples = profile.samples();
    let reach = (2.0 / step) as usize;
    let right = foot(samples[start..].iter(), level, reach)?;
    let left = foot(samples[..=start].iter().rev(), level, reach)?;
    let (mut mass, mut moment) = (0.0, 0.0);
    for (k, &v) in samples.iter().enumerate().take(start + right + 1).skip(start - left) {
        (mass, moment) = (mass + v, moment + (k as f32 - profile.half as f32) * v);
    }
    let section = Section { offset: f64::from(moment / mass) * step, width: f64::from(mass / peak) * step };
    (section.offset.abs() <= radius + 1.0).then_some(section)
}

/// Samples from the first one to where the line's darkness has run out: the profile fell through `level` and falls
/// no further, `reach` samples on at most. `None` where it never falls through.
fn foot<'a>(profile: impl Iterator<Item = &'a f32>, level: f32, reach: usize) -> Option<usize> {
    let mut through = None;
    let mut before = f32::INFINITY;
    for (i, &v) in profile.enumerate() {
        if let Some(first) = through
            && (v > before || i > first + reach)
        {
            return Some(i - 1);
        }
        if through.is_none() && v < level {
            through = Some(i);
        }
        before = v;
    }
    through
}

/// How far from the first sample the profile falls through half of it, px.
fn edge(profile: impl Iterator<Item = f64>) -> Option<f64> {
    let mut before: Option<f64> = None;
    let mut level = 0.0;
    for (i, v) in profile.enumerate() {
        match before {
            Some(b) if v < level => return Some((i as f64 - 1.0 + (b - level) / (b - v)) * STEP),
            Some(_) => {}
            None => level = 0.5 * v,
        }
        before = Some(v);
    }
    None
}

/// How far a line runs on along `way` (a place for each distance ahead, px) before its pen is lifted: half its width
/// less than the ink does, for a pen's end is round. `None` when there is no end within `reach`; beyond the picture
/// is paper.
pub(crate) fn pen_end(dark: &Plane<u8>, way: impl Fn(f64) -> Point, width: f64, reach: f64) -> Option<f64> {
    let steps = (reach / STEP).ceil() as usize;
    let level = |p: Point| if dark.clamp(p) == p { dark.at(p) } else { 0.0 };
    Some(edge((0..=steps).map(|k| level(way(k as f64 * STEP))))? - 0.5 * width)
}
