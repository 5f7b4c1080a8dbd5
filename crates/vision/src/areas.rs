//! Coloured areas, paler than the lines on and around them; treated as paper.
//!
//! An area is broad and of one tone, and what is darker on it is as dark as the picture's lines. It is taken out of the ink, so that its
//! lines are left; where they do not run along its edge, that is drawn as well.

use tracelight_image::levels::percentile;
use tracelight_image::threshold::over;
use tracelight_image::{Mask, Plane, Region, mask_of, regions};
use tracelight_stroke::Stroke;

use crate::options::Options;
use crate::outline::Outliner;

/// An area holds a regular octagon of this share of the picture's shorter side, and of so many px.
const BROAD: usize = 24;
const LEAST_PX: usize = 9;
/// And that is at least so many times as wide as the ink's edges.
const LEAST_EDGES: f64 = 3.0;
/// Its tone is the darkness of half of it, which is at most this share of what all of it but so much has about it.
const MOST_DARK: f64 = 0.6;
const LINES: f64 = 0.005;
/// Lines on it are darker by so many levels, and times the noise's deviation.
const LEAST_DARKER: f64 = 38.0;
const NOISE: f64 = 6.0;
/// Half of it differs by at most this share of that: a blurred line's middle differs more.
const UNEVEN: f64 = 0.35;
/// Of what they are darker a line has at least this share.
const LINE: f64 = 0.4;
/// What is paler than lines beside them is their edge, narrower than so many times that edge, and px.
const EDGE: f64 = 1.5;
const LEAST_EDGE_PX: usize = 3;
/// Beside paper it is blurred so many times as wide.
const BLURRED: f64 = 2.0;
/// Where dark lines run along this share of its edge they are all that is drawn of it.
const MOST_LINED: f64 = 0.5;
/// Its edge is so wide, px.
const ABOUT_PX: usize = 2;

/// How dark the picture is, and its ink.
pub(crate) struct Picture<'a> {
    pub(crate) dark: &'a mut Plane<u8>,
    pub(crate) ink: &'a mut Mask,
    /// How wide the ink's edges are, px.
    pub(crate) edge_px: f64,
    /// The noise's deviation, levels.
    pub(crate) noise: f64,
}

/// What was coloured in.
#[derive(Clone, Debug, Default)]
pub(crate) struct Areas {
    /// The outlines of those along whose edge no lines run.
    pub(crate) outlines: Vec<Stroke>,
    /// How many others there are.
    pub(crate) lined: usize,
}

/// How dark an area is, and the lines on it.
struct Fill {
    tone: f64,
    lines: f64,
}

impl Picture<'_> {
    /// Takes the areas out.
    pub(crate) fn take_areas(self, options: &Options) -> Areas {
        let side = (self.ink.width().min(self.ink.height()) / BROAD).max(LEAST_PX);
        // in a blurred picture a line's middle is darker than its sides
        if (side as f64) < LEAST_EDGES * self.edge_px {
            return Areas::default();
        }
        let parts = self.parts(&self.ink.clone().opened(side));
        if parts.is_empty() {
            return Areas::default();
        }
        let (dark, ink) = (self.dark.clone(), self.ink.clone());
        let mut areas = Mask::empty(ink.width(), ink.height());
        parts.iter().for_each(|(_, part)| part.add_to(&mut areas));
        let reach = (EDGE * self.edge_px).ceil() as usize;
        let mut done = Mask::empty(ink.width(), ink.height());
        for (fill, part) in parts {
            let near = Part { mask: part.mask.dilated_by(reach), ..part };
            for (x, y) in near.cells().filter(|&(x, y)| ink.get(x as isize, y as isize)) {
                let cell = done.cell(x, y);
                if !done.has(cell) {
                    done.set(cell);
                    let level = &mut self.dark.row_mut(y)[x];
                    *level = fill.of_paper(*level);
                }
            }
        }
        *self.ink = ink.clone().without(&areas);
        // what is drawn on an area is no edge of it, and what pales outside of a line about it is none of it
        let solid = areas.opened(self.thin());
        let whole = solid.closed(side / 2 + 1).and(&ink);
        let mut drawn = self.ink.clone();
        drawn.add(&whole);
        let mut outliner = Outliner::new(&dark, &whole, &drawn, self.edge_px);
        let (lined, bare): (Vec<Region>, Vec<Region>) =
            regions(&whole).into_iter().partition(|area| is_lined(area, &whole, &ink));
        let outlines = bare.iter().flat_map(|area| outliner.strokes(area, options)).collect();
        Areas { outlines, lined: lined.len() }
    }

    /// So narrow is what is paler than a line beside it, px.
    fn thin(&self) -> usize {
        ((EDGE * self.edge_px) as usize).max(LEAST_EDGE_PX)
    }

    /// The areas, by what is broad.
    fn parts(&self, broad: &Mask) -> Vec<(Fill, Part)> {
        let mut parts = Vec::new();
        // darker than this nothing is paler than lines, however dark they are
        let palest = |core: &Region| percentile(&core.histogram(self.dark), 0.5);
        if !regions(broad).iter().any(|core| palest(core) <= MOST_DARK * 255.0) {
            return parts;
        }
        for patch in regions(self.ink).iter().filter(|patch| patch.cells(broad).next().is_some()) {
            let Some((columns, rows)) = patch.bounds(0, (self.ink.width(), self.ink.height())) else {
                continue;
            };
            let (left, top) = (columns.start, rows.start);
            let levels = self.dark.part(columns.clone(), rows.clone());
            let mut rest = Mask::empty(columns.len(), rows.len());
            patch.seen_from(left, top).fill_into(&mut rest);
            let cores = broad.part(&columns, &rows).and(&rest);
            let lines = percentile(&patch.histogram(self.dark), 1.0 - LINES);
            for core in regions(&cores) {
                // an area may have several
                if core.cells(&rest).next().is_none() {
                    continue;
                }
                let Some(fill) = self.fill(&core, &levels, lines) else { continue };
                let mask = self.area(&core, &fill, &levels, &rest);
                rest = rest.without(&mask);
                parts.push((fill, Part { mask, left, top }));
            }
        }
        parts
    }

    /// Returns the fill of a broad part of a region, if it is a coloured area; `lines` is the darkness of its lines.
    fn fill(&self, core: &Region, levels: &Plane<u8>, lines: f64) -> Option<Fill> {
        let of_core = core.histogram(levels);
        let [least, tone, most] = [0.25, 0.5, 0.75].map(|share| percentile(&of_core, share));
        let is_even = most - least <= UNEVEN * (lines - tone);
        let is_area =
            is_even && tone <= MOST_DARK * lines && lines - tone >= LEAST_DARKER.max(NOISE * self.noise);
        is_area.then_some(Fill { tone, lines })
    }

    /// What of a patch an area covers that has this core.
    fn area(&self, core: &Region, fill: &Fill, levels: &Plane<u8>, patch: &Mask) -> Mask {
        let least = fill.tone + LINE * (fill.lines - fill.tone);
        let pale = patch.clone().without(&over(levels, least as u8));
        let thin = self.thin();
        let core = mask_of(&pale, [core]).and(&pale);
        let patches = regions(&pale.clone().opened(thin));
        let met = patches.iter().filter(|patch| patch.cells(&core).next().is_some());
        let reach = (BLURRED * self.edge_px).ceil() as usize + 2;
        mask_of(&pale, met).dilated_by(reach.max(thin)).and(&pale)
    }
}

/// An area, from the pixel on in which its own upper left one lies.
struct Part {
    mask: Mask,
    left: usize,
    top: usize,
}

impl Part {
    fn cells(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let places = self.mask.cells().map(|cell| self.mask.place(cell));
        places.map(|(x, y)| (x + self.left, y + self.top))
    }

    fn add_to(&self, areas: &mut Mask) {
        self.cells().for_each(|(x, y)| areas.set(areas.cell(x, y)));
    }
}

impl Fill {
    /// A level, with the area's tone as paper.
    fn of_paper(&self, level: u8) -> u8 {
        let gain = self.lines / (self.lines - self.tone);
        ((f64::from(level) - self.tone) * gain).clamp(0.0, 255.0) as u8
    }
}

/// Whether lines run along an area's edge.
fn is_lined(area: &Region, areas: &Mask, ink: &Mask) -> bool {
    // no more of the picture than is looked at
    let Some((columns, rows)) = area.bounds(ABOUT_PX, (ink.width(), ink.height())) else { return false };
    let areas = areas.part(&columns, &rows);
    let about =
        mask_of(&areas, [&area.seen_from(columns.start, rows.start)]).dilated_by(ABOUT_PX).without(&areas);
    let all = about.count();
    about.and(&ink.part(&columns, &rows)).count() as f64 >= MOST_LINED * all as f64
}

#[cfg(test)]
mod tests {
    use tracelight_image::Grey;
    use tracelight_stroke::StrokeKind;

    use crate::options::Options;
    use crate::trace;

    const SIDE: usize = 320;

    /// Lines, shapes and areas that are not drawn of a disc of 90 px with a line on it, of such a tone, and with such a line about it.
    fn drawn(tone: f64, about: f64) -> (usize, usize, usize) {
        let level = |i: usize| {
            let (x, y) = ((i % SIDE) as f64 - 159.5, (i / SIDE) as f64 - 159.5);
            let within = |off: f64| (0.5 - off).clamp(0.0, 1.0);
            let disc = tone * within(x.hypot(y) - 90.0);
            let ring = about * within((x.hypot(y) - 90.0).abs() - 2.5);
            let line = within((y - 0.4 * x).abs() / 1.077 - 2.5) * within(x.abs() - 45.0);
            (240.0 * (1.0 - 0.9 * disc.max(ring).max(line))) as u8
        };
        let image = Grey::new(SIDE, SIDE, (0..SIDE * SIDE).map(level).collect()).unwrap();
        let traced = trace(&image, &Options::default()).unwrap();
        let strokes = traced.strokes.strokes;
        let shapes = strokes.iter().filter(|stroke| stroke.kind == StrokeKind::Outline).count();
        (strokes.len() - shapes, shapes, traced.left_out.areas)
    }

    #[test]
    fn lines_on_what_was_coloured_in_are_lines_and_its_edge_is_drawn_once() {
        for tone in [0.3, 0.4, 0.5] {
            assert_eq!(drawn(tone, 1.0), (2, 0, 1), "a tone of {tone} with a line about it");
            assert_eq!(drawn(tone, 0.0), (1, 1, 0), "a tone of {tone} alone");
        }
        assert_eq!(drawn(1.0, 0.0), (0, 1, 0), "as dark as the line on it");
        assert_eq!(drawn(0.0, 1.0), (2, 0, 0), "nothing coloured in");
    }
}
