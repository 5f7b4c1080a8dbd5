//! Ruled and squared paper: its rules are none of the drawing, whatever their darkness, and what is drawn over them
//! stays whole. A drawing's own parallel lines stay.

use std::f64::consts::TAU;

use tracelight_image::Grey;
use tracelight_maths::planar;
use tracelight_stroke::{Point, Vec2, compare_polylines};
use tracelight_vision::{Options, Traced, trace};

use crate::raster::Canvas;

const WIDTH: usize = 640;
const HEIGHT: usize = 480;

/// A sheet of rules: how far apart and how wide they are, px, and the tangent of their turn.
struct Paper {
    spacing: f64,
    width: f64,
    turn: f64,
    squared: bool,
    /// Where a rule leads across the others, px from the left at the top.
    margin: Option<f64>,
}

impl Paper {
    /// From border to border, and beyond.
    fn rules(&self) -> Vec<Vec<Point>> {
        let (w, h) = (WIDTH as f64, HEIGHT as f64);
        let count = |length: f64| (length / self.spacing) as i32 + 3;
        let at = |k: i32| (f64::from(k) - 1.4) * self.spacing;
        let level = (0..count(h))
            .map(|k| vec![Point::new(-9.0, at(k)), Point::new(w + 9.0, at(k) + self.turn * (w + 18.0))]);
        let upright = (0..count(w) * i32::from(self.squared))
            .map(|k| vec![Point::new(at(k), -9.0), Point::new(at(k) - self.turn * (h + 18.0), h + 9.0)]);
        let margin = self
            .margin
            .map(|at| vec![Point::new(at, -9.0), Point::new(at - self.turn * (h + 18.0), h + 9.0)]);
        level.chain(upright).chain(margin).collect()
    }
}

/// A circle, a bow across several rules and a slanted line.
fn figure() -> Vec<Vec<Point>> {
    let round = |centre: Point, radius: f64, from: f64, sweep: f64| -> Vec<Point> {
        (0..=160).map(|k| centre + planar::direction(from + sweep * f64::from(k) / 160.0) * radius).collect()
    };
    let line = vec![Point::new(420.0, 60.0), Point::new(560.0, 410.0)];
    vec![
        round(Point::new(180.0, 170.0), 95.3, 0.0, TAU),
        round(Point::new(230.0, 300.0), 110.7, 0.4, 1.9),
        line,
    ]
}

/// What is found of pen lines of level 40 over rules of some level, and of noise a little.
fn traced(paper: &Paper, level: f64, figure: &[Vec<Point>]) -> Traced {
    traced_over((&paper.rules(), paper.width), level, figure)
}

/// The same over these rules, so wide.
fn traced_over((lines, width): (&[Vec<Point>], f64), level: f64, figure: &[Vec<Point>]) -> Traced {
    let (mut rules, mut ink) = (Canvas::new(WIDTH, HEIGHT), Canvas::new(WIDTH, HEIGHT));
    lines.iter().for_each(|rule| rules.pen(rule, width));
    figure.iter().for_each(|line| ink.pen(line, 4.0));
    let pixel = |(k, (rule, ink)): (usize, (f64, f64))| {
        let noise = ((k * 7919 + k / 640 * 104_729) % 7) as f64 - 3.0;
        let under = 240.0 - (240.0 - level) * rule;
        (under + (40.0_f64.min(under) - under) * ink + noise).clamp(0.0, 255.0) as u8
    };
    let levels = rules.shares().zip(ink.shares()).enumerate().map(pixel).collect();
    trace(&Grey::new(WIDTH, HEIGHT, levels).unwrap(), &Options::default()).unwrap()
}

#[test]
fn rules_of_any_darkness_are_no_strokes_and_what_crosses_them_is_whole() {
    let papers = [
        Paper { spacing: 24.0, width: 1.6, turn: 0.0, squared: false, margin: None },
        Paper { spacing: 31.0, width: 2.4, turn: 0.02, squared: false, margin: None },
        Paper { spacing: 22.0, width: 1.5, turn: 0.013, squared: true, margin: None },
        // sharp rules, steps of pixels at every fifth column; a margin whose upper end lies under a rule
        Paper { spacing: 43.0, width: 1.2, turn: 0.05, squared: true, margin: None },
        Paper { spacing: 33.0, width: 3.0, turn: 0.02, squared: false, margin: Some(52.0) },
    ];
    for paper in &papers {
        for level in [190.0, 140.0, 90.0, 45.0] {
            let found = traced(paper, level, &figure());
            let drawn: Vec<_> = found.strokes.strokes.iter().map(|s| s.path.flatten(0.02)).collect();
            let comparison = compare_polylines(&drawn, &figure(), 2.0).unwrap();
            let which = format!("{} px apart, level {level}: {comparison:?}", paper.spacing);
            assert!(comparison.coverage > 0.985, "{which}");
            assert!(comparison.precision > 0.985, "{which}");
            let combs = found.rules.map_or(0, |rules| rules.combs.len());
            assert_eq!(combs, if paper.squared { 2 } else { 1 }, "{which}");
        }
    }
}

#[test]
fn what_is_told_of_the_rules_is_so() {
    let paper = Paper { spacing: 31.0, width: 2.4, turn: 0.02, squared: false, margin: None };
    let comb = traced(&paper, 120.0, &figure()).rules.unwrap().combs[0];
    let spacing = paper.spacing * paper.turn.atan().cos();
    assert!((comb.spacing_px - spacing).abs() < 0.1, "{comb:?}");
    assert!((comb.turned_rad + paper.turn.atan()).abs() < 1e-3 && !comb.upright, "{comb:?}");
    assert!((14..=17).contains(&comb.count), "{comb:?}");
}

#[test]
fn a_drawings_own_parallel_lines_stay() {
    let none = Paper { spacing: 1e4, width: 0.0, turn: 0.0, squared: false, margin: None };
    let line = |from: (f64, f64), to: (f64, f64)| vec![Point::from(from), Point::from(to)];
    let hatching =
        (0..9).map(|k| line((120.0 + 20.0 * f64::from(k), 90.0), (60.0 + 20.0 * f64::from(k), 390.0)));
    let ladder =
        (0..12).map(|k| line((400.0, 60.0 + 30.0 * f64::from(k)), (560.0, 60.0 + 30.0 * f64::from(k))));
    // a grid that is the drawing: it stops short of the border
    let grid = (0..9).flat_map(|k| {
        let at = f64::from(k);
        [
            line((24.0, 30.0 + 52.0 * at), (616.0, 30.0 + 52.0 * at)),
            line((24.0 + 74.0 * at, 30.0), (24.0 + 74.0 * at, 446.0)),
        ]
    });
    let drawings: [Vec<Vec<Point>>; 3] = [hatching.collect(), ladder.collect(), grid.collect()];
    for lines in drawings {
        let found = traced(&none, 240.0, &lines);
        assert_eq!(found.rules, None);
        let drawn: Vec<_> = found.strokes.strokes.iter().map(|s| s.path.flatten(0.02)).collect();
        let comparison = compare_polylines(&drawn, &lines, 2.0).unwrap();
        assert!(comparison.coverage > 0.99 && comparison.precision > 0.99, "{comparison:?}");
    }
}

/// A ruled or squared sheet that lies turned on a dark table, and is seen at a slant; its rules end at its edges, not at the picture's.
#[test]
fn rules_of_a_sheet_that_lies_aslant_on_a_table_are_no_strokes() {
    let turned = [-11.0, -4.0, 3.0, 9.0, 14.0].map(|degrees| (degrees, (0.0, 0.0), 26.0, false));
    // by this share a px along, and across, it is further away
    let slants = [
        (0.0, (0.0006, 0.0), 26.0, true),
        (8.0, (-0.0006, 0.0008), 18.0, true),
        (-12.0, (0.0008, 0.001), 20.0, true),
        (5.0, (0.0, -0.0014), 16.0, false),
        (-3.0, (0.0015, 0.0), 20.0, true),
    ];
    for (degrees, (right, down), spacing, is_squared) in turned.into_iter().chain(slants) {
        let along = planar::direction(f64::to_radians(degrees));
        let across = Vec2::new(-along.y, along.x);
        let at = |x: f64, y: f64| {
            Point::new(320.0, 240.0) + (along * x + across * y) / (1.0 + right * x + down * y)
        };
        let sheet: Vec<Point> = [(-220.0, -160.0), (220.0, -160.0), (220.0, 160.0), (-220.0, 160.0)]
            .map(|(x, y)| at(x, y))
            .to_vec();
        let (mut paper, mut rules, mut ink) =
            (Canvas::new(WIDTH, HEIGHT), Canvas::new(WIDTH, HEIGHT), Canvas::new(WIDTH, HEIGHT));
        paper.fill(&[sheet]);
        let rule = |first: f64, k: i32| first + spacing * (f64::from(k) + 0.5);
        for y in (0..(320.0 / spacing) as i32).map(|k| rule(-160.0, k)) {
            rules.pen(&[at(-220.0, y), at(220.0, y)], 2.0);
        }
        for x in (0..(440.0 / spacing) as i32 * i32::from(is_squared)).map(|k| rule(-220.0, k)) {
            rules.pen(&[at(x, -160.0), at(x, 160.0)], 2.0);
        }
        // along no rule
        let middle = |first: f64, most: f64| first + spacing * ((most - first) / spacing).floor();
        let radius = spacing * (60.0 / spacing).round();
        let figure: Vec<Vec<Point>> = vec![
            (0..=120)
                .map(|k| planar::direction(TAU * f64::from(k) / 120.0) * radius)
                .map(|off| at(off.x + middle(-220.0, -78.0), off.y + middle(-160.0, -10.0)))
                .collect(),
            vec![at(60.0, -110.0), at(150.0, 90.0)],
        ];
        figure.iter().for_each(|line| ink.pen(line, 4.0));
        let pixel = |((paper, rule), ink): ((f64, f64), f64)| {
            let on_sheet = 225.0 - 105.0 * rule;
            let seen = 70.0 + (on_sheet - 70.0) * paper;
            (seen + (35.0 - seen) * ink) as u8
        };
        let levels = paper.shares().zip(rules.shares()).zip(ink.shares()).map(pixel).collect();
        let found = trace(&Grey::new(WIDTH, HEIGHT, levels).unwrap(), &Options::default()).unwrap();
        let rules = found.rules.map(|rules| rules.combs.len());
        let combs = if is_squared { 2 } else { 1 };
        let which = format!("turned by {degrees}°, slant {right} {down}");
        assert_eq!((found.strokes.strokes.len(), rules), (2, Some(combs)), "{which}");
    }
}

/// Dots on a lattice are the paper's, also as large as the pen's, and those that touch a line.
#[test]
fn the_dots_of_dotted_paper_are_no_strokes() {
    for (spacing, dot, rise) in [(24.0, 3.0, 0.0), (40.0, 3.0, 0.0), (24.0, 4.5, 1.7), (32.0, 5.0, 2.9)] {
        let mut canvas = Canvas::new(WIDTH, HEIGHT);
        let count = |length: usize| (length as f64 / spacing) as i32;
        for (k, l) in (0..count(HEIGHT)).flat_map(|k| (0..count(WIDTH)).map(move |l| (k, l))) {
            let at = Point::new((f64::from(l) + 0.61) * spacing, (f64::from(k) + 0.42) * spacing);
            canvas.pen(&[at, at], dot);
        }
        // between the dots, or over some
        let figure: Vec<Vec<Point>> = [4.1, 7.1]
            .map(|k| {
                vec![
                    Point::new(1.1 * spacing, (k + 0.8) * spacing),
                    Point::new(11.1 * spacing, (k + 0.8 + rise) * spacing),
                ]
            })
            .to_vec();
        figure.iter().for_each(|line| canvas.pen(line, 4.0));
        let levels = canvas.shares().map(|share| (240.0 - 200.0 * share) as u8).collect();
        let found = trace(&Grey::new(WIDTH, HEIGHT, levels).unwrap(), &Options::default()).unwrap();
        assert_eq!(found.strokes.strokes.len(), 2, "{spacing} px apart");
        let dots = found.left_out.dots.unwrap();
        assert!(dots.count > 100 && (dots.spacing_px - spacing).abs() < 0.5, "{spacing} px apart: {dots:?}");
    }
}

/// A page that curls: the nearer to its upper edge, the more its rules bend, and words stand on them.
#[test]
fn rules_of_a_page_that_curls_are_no_strokes_where_words_stand_on_them() {
    let rule = |k: i32, x: f64| {
        let curl = 9.0 * (1.0 - f64::from(k) / 9.0).powi(3);
        30.0 + 48.0 * f64::from(k) + curl * (1.5 * TAU * (x / 640.0 - 0.1)).sin()
    };
    let (mut rules, mut ink) = (Canvas::new(WIDTH, HEIGHT), Canvas::new(WIDTH, HEIGHT));
    for k in 0..10 {
        let points: Vec<Point> =
            (-1..=65).map(|i| 10.0 * f64::from(i)).map(|x| Point::new(x, rule(k, x))).collect();
        rules.pen(&points, 1.8);
    }
    let letters: Vec<Vec<Point>> = (0..10)
        .flat_map(|k| (0..26).map(move |i| (k, 150.0 + 12.0 * f64::from(i))))
        .map(|(k, x)| {
            let foot = rule(k, x) - 5.0;
            [(x - 2.0, foot - 12.0), (x, foot), (x + 6.0, foot)].map(Point::from).to_vec()
        })
        .collect();
    letters.iter().for_each(|letter| ink.pen(letter, 2.5));
    let pixel = |(rule, ink): (f64, f64)| {
        let under = 235.0 - 75.0 * rule;
        (under + (60.0 - under) * ink) as u8
    };
    let levels = rules.shares().zip(ink.shares()).map(pixel).collect();
    // so many equal letters look like a screen
    let options = Options { force: true, ..Options::default() };
    let found = trace(&Grey::new(WIDTH, HEIGHT, levels).unwrap(), &options).unwrap();
    assert_eq!(found.rules.map(|rules| rules.combs.len()), Some(1));
    let drawn: Vec<_> = found.strokes.strokes.iter().map(|s| s.path.flatten(0.02)).collect();
    let comparison = compare_polylines(&drawn, &letters, 2.0).unwrap();
    assert!(
        comparison.coverage > 0.97 && comparison.precision > 0.97,
        "{} strokes: {comparison:?}",
        drawn.len()
    );
}

#[test]
fn squares_that_end_before_the_border_are_rules_unless_they_are_drawn_in_ink() {
    let at = |k: i32| 22.0 * f64::from(k);
    let level = (2..20).map(|k| vec![Point::new(40.0, at(k)), Point::new(600.0, at(k))]);
    let upright = (2..28).map(|k| vec![Point::new(at(k), 40.0), Point::new(at(k), 440.0)]);
    let squares: Vec<Vec<Point>> = level.chain(upright).collect();
    let strokes = |level: f64| {
        let found = traced_over((&squares, 1.8), level, &figure());
        (found.rules.map_or(0, |rules| rules.combs.len()), found.strokes.strokes.len())
    };
    assert_eq!(strokes(150.0), (2, 3));
    let (combs, drawn) = strokes(40.0);
    assert!(combs == 0 && drawn > 20, "{combs} combs, {drawn} strokes");
}
