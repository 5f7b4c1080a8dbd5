use tracelight_image::{Grey, Mask};
use tracelight_stroke::{Point, Stroke, StrokeKind, Vec2};

/// How far beyond a line's edge its paper is looked at, px: beyond what blur leaves of the ink.
const BEYOND_PX: f64 = 2.5;
/// Spacing of the places that are looked at, px.
const SPACING_PX: f64 = 2.0;
/// Share of a stroke that may stand out less than is told: where it meets or crosses others, nothing tells it from them.
const LESS: f64 = 0.25;

/// Share of an edge at which it is seen to be one; so many places tell.
const EDGE: f64 = 0.9;
const MOST_PLACES: f64 = 64.0;
/// Paper is looked for beside a line's ink, px, up to so many pens and px away, and at so many places.
const NEXT_PX: f64 = 1.0;
const FURTHER_PENS: f64 = 2.0;
const FURTHER_PX: f64 = 4.0;
const LOOKS: u8 = 8;

/// By how much the ink along a stroke stands out from what is beside it, on *both* sides of a pen's line, in levels: but for a quarter of
/// its length at least so much. The edge of a sheet of paper or of a shadow stands out from one side only, and a patch that is cut out of
/// a gentle slope of light for part of its outline only: of such there is next to nothing left.
pub(crate) fn stands_out(grey: &Grey, stroke: &Stroke, light_on_dark: bool) -> f64 {
    let sign = if light_on_dark { -1.0 } else { 1.0 };
    let half = 0.5 * stroke.pen.unwrap_or(0.0);
    let of = |Place { at, across }: Place| {
        let level = |off: f64| grey.plane().at(at + across * off);
        match stroke.kind {
            StrokeKind::Centreline => {
                let beside = [half + BEYOND_PX, -half - BEYOND_PX].map(|off| sign * level(off));
                beside[0].min(beside[1]) - sign * level(0.0)
            }
            StrokeKind::Outline => level(BEYOND_PX) - level(-BEYOND_PX),
        }
    };
    let mut found: Vec<f64> = places(stroke, SPACING_PX).map(of).collect();
    if found.is_empty() {
        return 0.0;
    }
    let place = |share: f64| ((share * found.len() as f64) as usize).min(found.len() - 1);
    let (middle, low) = (place(0.5), place(LESS));
    // on which side of an outline its ink is, most of it tells
    if stroke.kind == StrokeKind::Outline && *found.select_nth_unstable_by(middle, f64::total_cmp).1 < 0.0 {
        found.iter_mut().for_each(|v| *v = -*v);
    }
    found.select_nth_unstable_by(low, f64::total_cmp).1.max(0.0)
}

/// What a line that nobody drew is an edge of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Edge {
    /// Of a sheet, of a table or of a shadow.
    Seen,
    /// Of what the picture's border cuts there: left, at the top, on the right or at the bottom.
    AtBorder(usize),
}

impl Edge {
    /// Of what a pen's line is the edge, if of anything. It was taken for a line because the light was evened: nearly everywhere one and the
    /// same side of it is as dark, as far as paper would be seen there, as what is ink on the other side's paper; or one and the same
    /// border of the picture is there.
    pub(crate) fn of(grey: &Grey, stroke: &Stroke, light_on_dark: bool) -> Option<Self> {
        let pen = stroke.pen.filter(|_| stroke.kind == StrokeKind::Centreline)?;
        let spacing = (stroke.path.length(0.1) / MOST_PLACES).max(SPACING_PX);
        let places: Vec<Place> = places(stroke, spacing).collect();
        let most_other = ((1.0 - EDGE) * places.len() as f64) as usize;
        let ways = Across { grey, light_on_dark, pen };
        // places at which either side is paper, and those that are not at each border
        let (mut paper, mut off) = ([0; 2], [0; 4]);
        for place in &places {
            let is_dark = ways.dark_sides(place);
            (0..2).for_each(|side| paper[side] += usize::from(!is_dark[side]));
            let is_at = ways.at_borders(place);
            (0..4).for_each(|border| off[border] += usize::from(!is_at[border]));
            if paper.iter().chain(&off).all(|&other| other > most_other) {
                return None;
            }
        }
        if paper.iter().any(|&other| other <= most_other) {
            return Some(Self::Seen);
        }
        off.iter().position(|&other| other <= most_other).map(Self::AtBorder)
    }
}

/// A shape that was cut off with what lies beside its sheet runs along there on this share of its outline, and for so many places: so
/// near, px. A letter that ends there is smaller.
const CUT_OFF: f64 = 0.3;
const CUT_PLACES: usize = 12;
const CUT_PX: isize = 2;

/// Whether a shape is what is left of the table within a sheet's corners: much of its outline is where the sheet was cut out.
pub(crate) fn is_cut_off(stroke: &Stroke, beside: &Mask) -> bool {
    if stroke.kind != StrokeKind::Outline {
        return false;
    }
    let points: Vec<Point> = places(stroke, SPACING_PX).map(|place| place.at).collect();
    let is_near = |at: &&Point| {
        let (x, y) = (at.x as isize, at.y as isize);
        [-CUT_PX, 0, CUT_PX]
            .into_iter()
            .any(|dy| [-CUT_PX, 0, CUT_PX].into_iter().any(|dx| beside.get(x + dx, y + dy)))
    };
    let cut = points.iter().filter(is_near).count();
    cut >= CUT_PLACES && cut as f64 >= CUT_OFF * points.len() as f64
}

/// What is seen on ways across a pen's line.
struct Across<'a> {
    grey: &'a Grey,
    light_on_dark: bool,
    pen: f64,
}

impl Across<'_> {
    /// How dark it is so far beside a place; `None` beyond the picture's border.
    fn dark(&self, place: &Place, off: f64) -> Option<f64> {
        let at = place.at + place.across * off;
        let (width, height) = (self.grey.width() as f64, self.grey.height() as f64);
        let is_seen = (0.0..width).contains(&at.x) && (0.0..height).contains(&at.y);
        let level = is_seen.then(|| self.grey.plane().at(at))?;
        Some(if self.light_on_dark { level } else { 255.0 - level })
    }

    /// Whether one side, or the other, is no paper.
    fn dark_sides(&self, place: &Place) -> [bool; 2] {
        let half = 0.5 * self.pen;
        let line = [-0.5 * half, 0.0, 0.5 * half].into_iter().filter_map(|off| self.dark(place, off));
        let line = line.fold(0.0, f64::max);
        let (near, far) = (half + NEXT_PX, half + FURTHER_PENS * self.pen + FURTHER_PX);
        let paper = [1.0, -1.0].map(|side| {
            let offs = (0..LOOKS).map(|k| near + (far - near) * f64::from(k) / f64::from(LOOKS - 1));
            offs.filter_map(|off| self.dark(place, side * off)).reduce(f64::min)
        });
        // beyond the picture's border nothing is known
        let is_dark = |this: Option<f64>, other: Option<f64>| {
            this.zip(other).is_some_and(|(this, other)| this > 0.5 * (line + other))
        };
        [is_dark(paper[0], paper[1]), is_dark(paper[1], paper[0])]
    }

    /// Whether each border of the picture cuts the line there.
    fn at_borders(&self, place: &Place) -> [bool; 4] {
        let (width, height) = (self.grey.width() as f64, self.grey.height() as f64);
        let off = [place.at.x, place.at.y, width - place.at.x, height - place.at.y];
        off.map(|off| off < 0.5 * self.pen + NEXT_PX)
    }
}

/// A place on a stroke, and the way across it there.
struct Place {
    at: Point,
    across: Vec2,
}

/// Places along a stroke, about so far from each other, px.
fn places(stroke: &Stroke, spacing: f64) -> impl Iterator<Item = Place> {
    stroke.path.pieces().flat_map(move |piece| {
        let count = (piece.length(0.1) / spacing).ceil().max(1.0) as usize;
        (0..count).filter_map(move |k| {
            let place = |k: f64| piece.at((k / count as f64).min(1.0));
            let ahead = place(k as f64 + 0.6) - place(k as f64 + 0.4);
            let length = ahead.hypot();
            (length > 0.0).then(|| Place { at: place(k as f64 + 0.5), across: ahead.turn_90() / length })
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_stroke::Path;

    /// 100 × 60 px: paper of 200 left of column 60, wall of 150 right of it; a pen's line of 40 along row 30, 4 px wide.
    fn wall() -> Grey {
        let level = |i: usize| match (i % 100, i / 100) {
            (10..50, 28..32) => 40,
            (0..60, _) => 200,
            _ => 150,
        };
        Grey::new(100, 60, (0..6000).map(level).collect()).unwrap()
    }

    fn line(points: &[(f64, f64)], closed: bool) -> Stroke {
        let points: Vec<Point> = points.iter().map(|&p| p.into()).collect();
        Stroke { pen: Some(4.0), ..Stroke::new(Path::polyline(&points, closed).unwrap()) }
    }

    #[test]
    fn ink_stands_out_and_the_edge_of_a_sheet_does_not() {
        assert!(stands_out(&wall(), &line(&[(12.0, 30.0), (48.0, 30.0)], false), false) > 155.0);
        assert!(stands_out(&wall(), &line(&[(60.0, 2.0), (60.0, 58.0)], false), false) < 1.0);
        // light ink on dark is the other way round
        assert!(stands_out(&wall(), &line(&[(12.0, 30.0), (48.0, 30.0)], false), true) < 1.0);
    }

    #[test]
    fn the_edge_of_a_sheet_is_one_and_ink_beside_it_is_none() {
        let edge = |points: &[(f64, f64)]| Edge::of(&wall(), &line(points, false), false);
        assert_eq!(edge(&[(61.0, 2.0), (61.0, 58.0)]), Some(Edge::Seen));
        assert_eq!(edge(&[(12.0, 30.0), (48.0, 30.0)]), None);
        // half of it is ink
        assert_eq!(edge(&[(30.0, 30.0), (48.0, 30.0), (61.0, 30.0), (61.0, 50.0)]), None);
        // what lies beyond the picture's border is not known
        assert_eq!(edge(&[(98.0, 2.0), (98.0, 58.0)]), Some(Edge::AtBorder(2)));
        assert_eq!(edge(&[(90.0, 58.0), (98.0, 58.0), (98.0, 50.0)]), None);
    }

    #[test]
    fn an_outline_stands_out_all_round_or_not() {
        let mut ink = line(&[(10.0, 28.0), (50.0, 28.0), (50.0, 32.0), (10.0, 32.0)], true);
        ink.kind = StrokeKind::Outline;
        assert!(stands_out(&wall(), &ink, false) > 100.0);
        // one side of it along the sheet's edge, the others nowhere
        let mut patch = line(&[(60.0, 40.0), (60.0, 58.0), (75.0, 50.0)], true);
        patch.kind = StrokeKind::Outline;
        assert!(stands_out(&wall(), &patch, false) < 1.0);
    }

    #[test]
    fn a_patch_along_a_sheets_edge_is_cut_off_and_a_shape_that_touches_it_is_not() {
        let mut beside = Mask::empty(100, 60);
        (0..60).for_each(|y| beside.fill(y, 80, 100));
        let of = |corners: &[(f64, f64)]| {
            let corners: Vec<Point> = corners.iter().map(|&at| Point::from(at)).collect();
            let path = Path::polyline(&corners, true).unwrap();
            is_cut_off(&Stroke { kind: StrokeKind::Outline, ..Stroke::new(path) }, &beside)
        };
        assert!(of(&[(80.0, 10.0), (80.0, 50.0), (60.0, 50.0)]));
        assert!(!of(&[(74.0, 10.0), (74.0, 50.0), (60.0, 50.0)]), "some way inside");
        assert!(!of(&[(80.0, 10.0), (80.0, 20.0), (72.0, 20.0)]), "a small one");
        assert!(
            !of(&[(80.0, 15.0), (80.0, 40.0), (20.0, 50.0), (20.0, 10.0)]),
            "a large one that ends there"
        );
    }
}
