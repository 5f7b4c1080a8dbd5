use tracelight_maths::planar;
use tracelight_stroke::{Affine, Point, Stroke, Vec2};

use crate::habit::Habit;
use crate::kinds::frame;
use crate::rules::broken_within;
use crate::{Figure, Hand, Ink, Kind, Nib, Random, Set, Size};

/// Paper between figures, in pens and in px.
const CLEAR_PENS: f64 = 2.5;
const CLEAR_PX: f64 = 6.0;
/// Paper at the border, as a share of the rows.
const MARGIN: f64 = 0.04;
/// Figures drawn, and places tried, for each that ends on the page.
const FIGURES_TRIED: usize = 12;
const PLACES_TRIED: usize = 12;
/// Pens tried until something fits.
const PAGES_TRIED: usize = 40;

/// Figures placed clear of each other.
pub struct Page {
    /// Everything that is drawn.
    pub figures: Vec<Figure>,
    /// Its thinnest pen, px.
    pub pen: f64,
    /// Its least paper between lines, px.
    pub paper: f64,
}

impl Page {
    /// The strokes of all its figures.
    pub(crate) fn strokes(&self) -> Vec<Stroke> {
        self.figures.iter().flat_map(|figure| figure.strokes.clone()).collect()
    }

    /// A page of a kind. Lengths that the rules bound from below are kept `roomy` times as large.
    pub fn draw(random: &mut Random, kind: Kind, size: Size, roomy: f64) -> Self {
        // a straight line always fits
        Self::of(random, kind, size, roomy).unwrap_or_else(|| Self::draw(random, Kind::Lines, size, roomy))
    }

    /// The same, or none if no pen was found with which a figure of this kind fits.
    pub fn of(random: &mut Random, kind: Kind, size: Size, roomy: f64) -> Option<Self> {
        let habit = Habit::of(kind);
        let paper = habit.paper_px * roomy;
        (0..PAGES_TRIED).find_map(|_| {
            let pen = habit.pen(random, size, roomy);
            let figures = figures(random, (kind, &habit), size, (pen, paper));
            if figures.is_empty() {
                return None;
            }
            let thinnest = figures.iter().filter_map(Figure::thinnest).fold(pen, f64::min);
            Some(Self { figures, pen: if kind.set() == Set::Plain { pen } else { thinnest }, paper })
        })
    }

    /// Width of its widest line, px; none if there are only shapes.
    pub fn widest(&self) -> Option<f64> {
        self.figures.iter().flat_map(Figure::widths).reduce(f64::max)
    }
}

fn figures(
    random: &mut Random,
    (kind, habit): (Kind, &Habit),
    size: Size,
    (pen, paper): (f64, f64),
) -> Vec<Figure> {
    let (fewest, most) = habit.figures;
    let wanted = random.whole(fewest, most);
    let sharp = random.chance(0.15) && kind.set() == Set::Plain;
    let nib = if sharp { Nib::Sharp } else { Nib::Round };
    let mut sheet = Sheet::new(size, pen, MARGIN * size.height as f64 + habit.margin_pens * pen);
    let (mut placed, mut strokes) = (Vec::new(), 0);
    for _ in 0..wanted {
        let hand = Hand { pen, nib, paper, size: 0.0 };
        let found = one(random, (kind, habit), size, hand, (wanted, &mut sheet));
        let found = found.filter(|f| strokes + f.strokes.len() <= habit.strokes);
        if let Some(figure) = found {
            strokes += figure.strokes.len();
            sheet.occupy(&figure);
            placed.push(figure);
        }
    }
    if kind == Kind::Frame && !placed.is_empty() {
        placed.push(frame(random, size, pen));
    }
    placed
}

/// A figure that keeps the rules, where there is room for it.
fn one(
    random: &mut Random,
    (kind, habit): (Kind, &Habit),
    size: Size,
    hand: Hand,
    (wanted, sheet): (usize, &mut Sheet),
) -> Option<Figure> {
    let rows = size.height as f64;
    let largest = habit.half.1 / (wanted as f64).powf(0.3);
    for _ in 0..FIGURES_TRIED {
        let half = rows * random.log_between(habit.half.0, largest.max(habit.half.0 + 0.02));
        let hand = Hand { size: half.max(habit.half_pens * hand.pen), ..hand };
        let figure = kind.figure(random, &hand);
        let turn = random.angle();
        let figure = figure.moved(planar::rotation(habit.turn(turn)));
        let (pen, bounds) = habit.bounds(&figure, &hand);
        if figure.strokes.is_empty() || broken_within(&figure, (pen, hand.paper), &bounds).is_some() {
            continue;
        }
        let place = (0..PLACES_TRIED).find_map(|_| sheet.place(random, &figure));
        if place.is_some() {
            return place;
        }
    }
    None
}

/// Which part of the page is taken, in cells of a pixel at 240 rows.
struct Sheet {
    size: Size,
    pen: f64,
    margin: f64,
    cell: f64,
    columns: usize,
    taken: Vec<bool>,
}

impl Sheet {
    fn new(size: Size, pen: f64, margin: f64) -> Self {
        let cell = (size.height as f64 / 240.0).max(1.0);
        let count = |px: usize| (px as f64 / cell).ceil() as usize + 1;
        let columns = count(size.width);
        Self { size, pen, margin, cell, columns, taken: vec![false; columns * count(size.height)] }
    }

    /// The figure somewhere within the margins and clear of the others, or not.
    fn place(&self, random: &mut Random, figure: &Figure) -> Option<Figure> {
        let margin = self.margin + 0.5 * self.pen;
        let (low, high) = bounds(figure);
        let room = Vec2::new(self.size.width as f64, self.size.height as f64) - (high - low);
        let room = room - Vec2::new(2.0 * margin, 2.0 * margin);
        if room.x < 0.0 || room.y < 0.0 {
            return None;
        }
        let corner = Point::new(
            margin + room.x * random.between(0.0, 1.0),
            margin + room.y * random.between(0.0, 1.0),
        );
        let figure = figure.moved(Affine::translate(corner - low));
        self.footprint(&figure).iter().all(|&cell| !self.taken[cell]).then_some(figure)
    }

    /// Cells with ink in them.
    fn footprint(&self, figure: &Figure) -> Vec<usize> {
        let mut cells = Vec::new();
        for ink in &figure.ink {
            match ink {
                Ink::Line { path, .. } => self.along(&path.flatten(0.1), &mut cells),
                Ink::Fill(paths) => {
                    paths.first().into_iter().for_each(|p| self.within(&p.flatten(0.1), &mut cells))
                }
                Ink::Touches(touches) => {
                    self.along(&touches.iter().map(|t| t.at).collect::<Vec<_>>(), &mut cells);
                }
                Ink::Scribble { outline, .. } | Ink::Wash { outline, .. } => {
                    self.within(&outline.flatten(0.1), &mut cells)
                }
            }
        }
        cells.sort_unstable();
        cells.dedup();
        cells
    }

    fn index(&self, p: Point) -> usize {
        (p.y / self.cell) as usize * self.columns + (p.x / self.cell) as usize
    }

    fn along(&self, points: &[Point], cells: &mut Vec<usize>) {
        for pair in points.windows(2) {
            let steps = (pair[0].distance(pair[1]) / (0.5 * self.cell)).ceil().max(1.0) as usize;
            cells.extend((0..=steps).map(|i| self.index(pair[0].lerp(pair[1], i as f64 / steps as f64))));
        }
    }

    /// The outline and, row by row, what lies inside it.
    fn within(&self, outline: &[Point], cells: &mut Vec<usize>) {
        self.along(outline, cells);
        let rows = self.taken.len() / self.columns;
        for row in 0..rows {
            let y = (row as f64 + 0.5) * self.cell;
            for span in crossings(outline, y).chunks_exact(2) {
                let columns = (span[0] / self.cell) as usize..=(span[1] / self.cell) as usize;
                cells.extend(columns.map(|column| row * self.columns + column));
            }
        }
    }

    /// Takes the figure's cells and those too near to it.
    fn occupy(&mut self, figure: &Figure) {
        let reach = (self.pen + (CLEAR_PENS * self.pen).max(CLEAR_PX)) / self.cell + 1.0;
        let whole = reach.ceil() as isize;
        let around = (-whole..=whole).flat_map(|y| (-whole..=whole).map(move |x| (x, y)));
        let around: Vec<_> = around.filter(|(x, y)| ((x * x + y * y) as f64) < reach * reach).collect();
        let rows = (self.taken.len() / self.columns) as isize;
        for cell in self.footprint(figure) {
            let (x, y) = ((cell % self.columns) as isize, (cell / self.columns) as isize);
            for (x, y) in around.iter().map(|(dx, dy)| (x + dx, y + dy)) {
                if (0..self.columns as isize).contains(&x) && (0..rows).contains(&y) {
                    self.taken[y as usize * self.columns + x as usize] = true;
                }
            }
        }
    }
}

/// Where a closed outline crosses a row, from left to right.
pub(crate) fn crossings(outline: &[Point], y: f64) -> Vec<f64> {
    let crosses = outline.windows(2).filter(|w| (w[0].y > y) != (w[1].y > y));
    let mut at: Vec<f64> =
        crosses.map(|w| w[0].x + (y - w[0].y) / (w[1].y - w[0].y) * (w[1].x - w[0].x)).collect();
    at.sort_by(f64::total_cmp);
    at
}

fn bounds(figure: &Figure) -> (Point, Point) {
    let points = figure.strokes.iter().flat_map(|s| s.path.flatten(0.1));
    let start = (Point::new(f64::MAX, f64::MAX), Point::new(f64::MIN, f64::MIN));
    points.fold(start, |(low, high), p| {
        (Point::new(low.x.min(p.x), low.y.min(p.y)), Point::new(high.x.max(p.x), high.y.max(p.y)))
    })
}
