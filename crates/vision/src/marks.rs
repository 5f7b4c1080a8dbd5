//! Finds the two marks on a ruler, for scale.

use tracelight_image::levels::histogram;
use tracelight_image::threshold::over;
use tracelight_image::{Grey, Plane, Region, regions};
use tracelight_maths::atan2;
use tracelight_sheet::Page;
use tracelight_stroke::{Point, Vec2};

use crate::VisionError;
use crate::ink::Ink;
use crate::split::Split;

/// Most the line through the marks may be off upright or level, degrees: at 3° the scale is 0.14 % off already, but
/// which of the two it is stays clear up to here.
const MOST_SLANT_DEG: f64 = 20.0;

/// Two marks of one ruler differ less than this in area and in either side, as a ratio.
const LIKE: f64 = 1.35;

/// A mark covers at least this share of the picture: 25 px of 320 × 240.
const LEAST_SHARE: f64 = 3e-4;

/// The two marks of a ruler, pixel frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marks {
    /// Middle of the upper mark of an upright ruler, of the left mark of a level one.
    pub a: Point,
    /// Middle of the other mark.
    pub b: Point,
}

impl Marks {
    /// Distance between the marks, px.
    pub fn distance_px(&self) -> f64 {
        self.a.distance(self.b)
    }

    /// Whether the ruler stands upright.
    pub fn upright(&self) -> bool {
        let along = self.b - self.a;
        along.y.abs() > along.x.abs()
    }
}

/// Finds the two tape marks on a picture of a ruler: the two largest patches of one size and shape, darker or lighter
/// than the ruler, one above or beside the other. Their middles are centroids of grey levels, good to a few
/// hundredths of a pixel.
///
/// # Errors
/// When the picture has no contrast, there are not two such patches, or they lie on a slant.
pub fn find_two_marks(image: &Grey) -> Result<Marks, VisionError> {
    let ink = Ink::of(&Page::whole(image), None, false)?;
    // the ruler itself may be what the threshold parts from the wall: then the tapes are what is darker still
    let darker = Split::of(&darker_half(&ink)).threshold;
    let mut most = 0;
    for threshold in [ink.threshold, darker] {
        let found = candidates(&ink.darkness, threshold);
        most = most.max(found.len());
        if let Some((a, b)) = pair(&found) {
            return marks(a, b, ink.scale);
        }
    }
    Err(VisionError::Marks { found: most })
}

/// The histogram of what is darker than the threshold.
fn darker_half(ink: &Ink) -> [u32; 256] {
    let mut counts = histogram(std::iter::once(&ink.darkness.values[..]));
    counts[..=usize::from(ink.threshold)].fill(0);
    counts
}

/// A patch that may be a mark.
#[derive(Clone, Copy, Debug)]
struct Patch {
    middle: Point,
    area: f64,
    /// Sides of its bounding box, px.
    sides: Vec2,
}

/// Patches that are large enough and filled, largest first.
fn candidates(dark: &Plane<u8>, threshold: u8) -> Vec<Patch> {
    let least = LEAST_SHARE * dark.values.len() as f64;
    let all = regions(&over(dark, threshold));
    let large = all.iter().filter(|r| r.area() as f64 >= least);
    let mut found: Vec<Patch> = large.map(|r| patch(dark, r)).collect();
    // a bar, even a slanted one, or a blob fills its box; a ruler's outline does not
    found.retain(|p| p.area > 0.15 * p.sides.x * p.sides.y);
    found.sort_by(|a, b| b.area.total_cmp(&a.area));
    found
}

fn patch(dark: &Plane<u8>, region: &Region) -> Patch {
    let (mut low, mut high) = (Point::new(f64::MAX, f64::MAX), Point::ORIGIN);
    for run in &region.runs {
        low = Point::new(low.x.min(f64::from(run.from)), low.y.min(f64::from(run.y)));
        high = Point::new(high.x.max(f64::from(run.to)), high.y.max(f64::from(run.y + 1)));
    }
    Patch { middle: centroid(dark, low, high), area: region.area() as f64, sides: high - low }
}

/// The centroid of what is darker than the surroundings of a box, in the box and 2 px about it, where the edges'
/// grey levels still are.
fn centroid(dark: &Plane<u8>, low: Point, high: Point) -> Point {
    const MARGIN: isize = 2;
    let range = |low: f64, high: f64| low as isize - MARGIN..high as isize + MARGIN;
    let cells: Vec<(isize, isize)> =
        range(low.y, high.y).flat_map(|y| range(low.x, high.x).map(move |x| (x, y))).collect();
    let level = |&(x, y): &(isize, isize)| f64::from(dark.get(x, y));
    let full = cells.iter().map(level).fold(0.0, f64::max);
    let (mut mass, mut moment) = (0.0, Vec2::ZERO);
    for cell in &cells {
        // under half of the mark's darkness is its edge or the ruler; the ruler's share is the same on both sides
        let weight = (level(cell) - ruler_level(full)).max(0.0);
        mass += weight;
        moment += Vec2::new(cell.0 as f64 + 0.5, cell.1 as f64 + 0.5) * weight;
    }
    (moment / mass.max(1e-9)).to_point()
}

/// Darkness from which on a pixel counts, of a mark of darkness `full`: above any ruler.
fn ruler_level(full: f64) -> f64 {
    0.35 * full
}

/// The two largest patches that are alike.
fn pair(found: &[Patch]) -> Option<(Patch, Patch)> {
    let like = |a: f64, b: f64| a.max(b) <= LIKE * a.min(b);
    let alike = |a: &Patch, b: &Patch| {
        like(a.area, b.area)
            && like(a.sides.x + 1.0, b.sides.x + 1.0)
            && like(a.sides.y + 1.0, b.sides.y + 1.0)
    };
    let pairs = (1..found.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
    let (i, j) = pairs.into_iter().find(|&(i, j)| alike(&found[i], &found[j]))?;
    // a third one like them: which two are meant?
    let others = found.iter().enumerate().filter(|&(k, p)| k != i && k != j && alike(p, &found[i]));
    (others.count() == 0).then_some((found[i], found[j]))
}

fn marks(a: Patch, b: Patch, scale: f64) -> Result<Marks, VisionError> {
    let along = b.middle - a.middle;
    let (less, more) = (along.x.abs().min(along.y.abs()), along.x.abs().max(along.y.abs()));
    let slant_deg = atan2(less, more).to_degrees();
    if slant_deg > MOST_SLANT_DEG {
        return Err(VisionError::Slant { slant_deg, most_deg: MOST_SLANT_DEG });
    }
    let swapped = if along.y.abs() > along.x.abs() { along.y < 0.0 } else { along.x < 0.0 };
    let (first, second) = if swapped { (b.middle, a.middle) } else { (a.middle, b.middle) };
    let scaled = |p: Point| (p.to_vec2() * scale).to_point();
    Ok(Marks { a: scaled(first), b: scaled(second) })
}
