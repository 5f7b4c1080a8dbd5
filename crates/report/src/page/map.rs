use std::fmt::Write;

use tracelight_chart::{ERROR_STEPS_MM, STEPS, error_step};
use tracelight_stroke::{Affine, Point};

use super::axis::round_step;
use super::curve::tenth;
use super::html::{escaped, jpeg_uri, number};
use crate::error::EncodeError;
use crate::finished::Finished;
use crate::origin::words;
use crate::sample::{Sample, samples};

/// The longer side of the map in its own units; a tenth of one is kept.
const SIDE: f64 = 1000.0;
/// Ways shorter than this many units are joined: a third of a pixel on a large screen.
const SHORTEST: f64 = 0.4;
/// More strokes than this go without a number beside their start.
const NUMBERED: usize = 24;

/// The picture with the lit trace on it, coloured by its error, and its legend, as HTML.
pub(super) fn map(job: &Finished<'_>) -> Result<String, EncodeError> {
    let (place, words) = (Place::new(job), words(job.origin.light_from));
    let samples = || samples(job.plan, job.run);
    let mut drawn = Trace { bins: Default::default(), travel: String::new(), place: &place };
    drawn.follow(samples());
    let mut layers = picture(job, &place)?;
    let _ = write!(layers, r#"<path class="travel" d="{}"/>"#, drawn.travel);
    layers += &coloured(&drawn.bins);
    Ok(format!(
        include_str!("map.html"),
        width = place.width,
        height = place.height,
        layers = layers,
        numbers = numbers(job, &place) + &worst(job, &place),
        bar = bar(&place),
        scale = scale(&format!("tracking error{}", words.by)),
        heading = words.map,
        name = escaped(&job.title()),
    ))
}

/// Path data as paths, each in its error's colour.
pub(super) fn coloured(bins: &[String; STEPS]) -> String {
    let drawn = bins.iter().enumerate().filter(|(_, data)| !data.is_empty());
    drawn.map(|(bin, data)| format!(r#"<path class="trace e{bin}" d="{data}"/>"#)).collect()
}

/// From target metres to the map's units, y down.
pub(super) fn frame(job: &Finished<'_>) -> Affine {
    Place::new(job).map_from_target
}

/// The map's sizes and frame.
pub(super) struct Place {
    map_from_target: Affine,
    pub(super) units_per_m: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Place {
    pub(super) fn new(job: &Finished<'_>) -> Self {
        let (low, high) = job.bounds();
        let size = high - low;
        let air = 0.04 * size.x.max(size.y);
        let units_per_m = SIDE / (size.x.max(size.y) + 2.0 * air);
        let map_from_target = Affine::scale_non_uniform(units_per_m, -units_per_m)
            * Affine::translate((air - low.x, -high.y - air));
        let (width, height) = ((size.x + 2.0 * air) * units_per_m, (size.y + 2.0 * air) * units_per_m);
        Self { map_from_target, units_per_m, width: tenth(width), height: tenth(height) }
    }

    pub(super) fn at(&self, target: Point) -> Point {
        self.map_from_target * target
    }

    /// Whether a point is near enough to be drawn at all.
    pub(super) fn shows(&self, p: Point) -> bool {
        (-SIDE..2.0 * SIDE).contains(&p.x) && (-SIDE..2.0 * SIDE).contains(&p.y)
    }
}

/// Path data of what was drawn, growing tick by tick.
struct Trace<'a> {
    bins: [String; STEPS],
    travel: String,
    place: &'a Place,
}

/// Where the last piece of path data ended.
#[derive(Clone, Copy)]
struct Pen {
    at: Point,
    /// Colour of the piece before; `None` for a travel.
    bin: Option<usize>,
    worst_mm: f64,
}

impl Trace<'_> {
    fn follow<'s>(&mut self, samples: impl Iterator<Item = Sample<'s>>) {
        let mut pen: Option<(Pen, bool)> = None;
        for sample in samples {
            let spot = sample.tick.spot.map(|p| self.place.at(p)).filter(|&p| self.place.shows(p));
            let light = sample.tick.light;
            pen = match (spot, pen) {
                (None, _) => None,
                (Some(at), Some((before, was_lit))) if was_lit == light => {
                    Some((self.go_on(before, at, &sample), light))
                }
                (Some(at), _) => Some((self.begin(at, &sample), light)),
            };
        }
    }

    fn begin(&mut self, at: Point, sample: &Sample<'_>) -> Pen {
        if !sample.tick.light {
            push(&mut self.travel, 'M', at);
        }
        Pen { at, bin: None, worst_mm: 0.0 }
    }

    fn go_on(&mut self, before: Pen, at: Point, sample: &Sample<'_>) -> Pen {
        let worst_mm = before.worst_mm.max(sample.error_mm().unwrap_or(0.0));
        if before.at.distance(at) < SHORTEST {
            return Pen { worst_mm, ..before };
        }
        if !sample.tick.light {
            push(&mut self.travel, 'L', at);
            return Pen { at, bin: None, worst_mm: 0.0 };
        }
        let bin = error_step(worst_mm);
        if before.bin != Some(bin) {
            push(&mut self.bins[bin], 'M', before.at);
        }
        push(&mut self.bins[bin], 'L', at);
        Pen { at, bin: Some(bin), worst_mm: 0.0 }
    }
}

fn push(data: &mut String, letter: char, at: Point) {
    let _ = write!(data, "{letter}{} {}", tenth(at.x), tenth(at.y));
}

/// The picture itself, faint, or its strokes where there are no pixels.
pub(super) fn picture(job: &Finished<'_>, place: &Place) -> Result<String, EncodeError> {
    const LONGEST_PX: u32 = 1100;
    const QUALITY: u8 = 82;
    let Some(picture) = job.picture else { return Ok(strokes(job, place)) };
    let jpeg = jpeg_uri(picture.raster, (LONGEST_PX, QUALITY), job.picture_path)?;
    let (w, h) = (f64::from(picture.raster.width()), f64::from(picture.raster.height()));
    let [a, b, c, d, e, f] = (place.map_from_target * picture.target_from_pixel).as_coeffs();
    Ok(format!(
        r#"<image class="picture" width="{w}" height="{h}" preserveAspectRatio="none" transform="matrix({a} {b} {c} {d} {e} {f})" href="{jpeg}"/>"#
    ))
}

fn strokes(job: &Finished<'_>, place: &Place) -> String {
    let mut data = String::new();
    for stroke in &job.drawing.strokes {
        let points = stroke.path.flatten(SHORTEST / place.units_per_m);
        let shown = points.into_iter().map(|p| place.at(p)).filter(|&p| place.shows(p));
        shown.enumerate().for_each(|(i, p)| push(&mut data, if i == 0 { 'M' } else { 'L' }, p));
    }
    format!(r#"<path class="drawn" d="{data}"/>"#)
}

/// Each stroke's number at its start, in tracing order.
fn numbers(job: &Finished<'_>, place: &Place) -> String {
    let strokes = &job.drawing.strokes;
    if strokes.len() > NUMBERED {
        return String::new();
    }
    let number = |(i, p): (usize, Point)| {
        let (left, top) = (p.x / place.width * 100.0, p.y / place.height * 100.0);
        format!(r#"<b style="left:{left:.2}%;top:{top:.2}%">{}</b>"#, i + 1)
    };
    strokes.iter().map(|s| place.at(s.path.start())).enumerate().map(number).collect()
}

/// A flag where the lit spot was furthest from its planned place.
fn worst(job: &Finished<'_>, place: &Place) -> String {
    let lit = samples(job.plan, job.run).filter(|s| s.tick.light);
    let errors = lit.filter_map(|s| Some((place.at(s.tick.spot?), s.error_mm()?)));
    let worst = errors.filter(|e| e.1.is_finite() && place.shows(e.0)).max_by(|a, b| a.1.total_cmp(&b.1));
    let Some((p, error_mm)) = worst else { return String::new() };
    let (left, top) = (p.x / place.width * 100.0, p.y / place.height * 100.0);
    let side = if left > 70.0 { "worst left" } else { "worst" };
    format!(r#"<i class="{side}" style="left:{left:.2}%;top:{top:.2}%">⚑ {} mm</i>"#, number(error_mm, 4))
}

/// A scale bar of a round length.
pub(super) fn bar(place: &Place) -> String {
    let length_mm = round_step(place.width / place.units_per_m * 1e3 * 0.1);
    let share = length_mm / 1e3 * place.units_per_m / place.width * 100.0;
    let text = if length_mm >= 1000.0 {
        format!("{} m", number(length_mm / 1e3, 1))
    } else if length_mm >= 10.0 {
        format!("{} cm", number(length_mm / 10.0, 1))
    } else {
        format!("{} mm", number(length_mm, 1))
    };
    format!(r#"<div class="bar" style="width:{share:.2}%"><span>{text}</span></div>"#)
}

/// What the colours say: where each begins, the same on every page.
pub(super) fn scale(of: &str) -> String {
    let swatches: String = (0..STEPS).map(|i| format!(r#"<i class="e{i}"></i>"#)).collect();
    let from =
        |mm: &f64| format!("<i>{}</i>", number(*mm, if *mm < 1.0 { 3 } else { 1 }).trim_end_matches('0'));
    let marks: String = ERROR_STEPS_MM.iter().map(from).collect();
    format!(
        r#"<div class="scale"><span>{of}, mm</span><span class="swatches">{swatches}</span><span class="scale-marks">{marks}</span></div>"#
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn the_whole_lit_way_is_on_the_map() {
        let fixture = fixture::star();
        let job = fixture.job();
        let place = Place::new(&job);
        let mut drawn = Trace { bins: Default::default(), travel: String::new(), place: &place };
        drawn.follow(samples(job.plan, job.run));
        let length: f64 = drawn.bins.iter().map(|data| way(data)).sum();
        let wanted = job.drawing.length(1e-6) * place.units_per_m;
        assert!((length / wanted - 1.0).abs() < 0.02, "{length} {wanted}");
        assert!(way(&drawn.travel) > 100.0);
    }

    fn way(data: &str) -> f64 {
        let moves = data.split('M').filter(|m| !m.is_empty());
        let length = |line: &str| {
            let points: Vec<Point> = line.split('L').map(point).collect();
            points.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>()
        };
        moves.map(length).sum()
    }

    fn point(text: &str) -> Point {
        let (x, y) = text.split_once(' ').unwrap();
        Point::new(x.parse().unwrap(), y.parse().unwrap())
    }
}
