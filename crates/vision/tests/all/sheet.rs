//! A sheet of paper on a table: its corners are found, what lies beside it and over it is none of the drawing, and
//! none of the drawing is lost. A shadow, a frame and a filled shape are no sheets.

use std::f64::consts::TAU;

use tracelight_image::Grey;
use tracelight_maths::planar;
use tracelight_sheet::Page;
use tracelight_stroke::{Point, Vec2, compare_polylines};
use tracelight_vision::{Options, trace, trace_page};

use crate::raster::Canvas;

/// Numbers that look like chance (Marsaglia, "Xorshift RNGs", 2003).
struct Chance(u64);

impl Chance {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        low + (high - low) * (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A sheet with a figure on it, photographed on a table.
struct Photograph {
    size: (usize, usize),
    corners: [Point; 4],
    figure: Vec<Vec<Point>>,
    pen: f64,
    paper: f64,
    table: f64,
    /// How much darker one half of the picture is, and how its edge runs.
    shadow: Option<(f64, f64, f64)>,
    /// A finger's two ends, how bright it is against the paper, and how dark the soft shadow beside it.
    finger: Option<(Point, Point)>,
    finger_tone: (f64, f64),
    /// Another sheet below it, and its level.
    below: Option<([Point; 4], f64)>,
    /// Light from one side: the way to it, and how much of it is left at the other end of the picture.
    light: (Vec2, f64),
}

impl Photograph {
    fn any(chance: &mut Chance) -> Self {
        let size = [(640, 480), (960, 720), (480, 640)][chance.between(0.0, 2.999) as usize];
        let (w, h) = (size.0 as f64, size.1 as f64);
        let corner = |x: f64, y: f64, chance: &mut Chance| {
            Point::new((x + chance.between(-0.05, 0.05)) * w, (y + chance.between(-0.05, 0.05)) * h)
        };
        let corners =
            [(0.16, 0.14), (0.85, 0.15), (0.86, 0.86), (0.15, 0.85)].map(|(x, y)| corner(x, y, chance));
        let side = w.min(h);
        let pen = (0.008 * side * chance.between(0.7, 1.6)).max(2.5);
        let is_bright = chance.between(0.0, 1.0) < 0.2;
        let paper = chance.between(190.0, if is_bright { 215.0 } else { 240.0 });
        let table = if is_bright { 255.0 } else { chance.between(30.0, 0.7 * paper) };
        let turn = chance.between(0.0, TAU);
        let middle = Point::new(0.5 * w, 0.5 * h);
        let round = |at: Vec2, radius: f64, sweep: f64| -> Vec<Point> {
            let on = |k: i32| middle + at + planar::direction(turn + sweep * f64::from(k) / 120.0) * radius;
            (0..=120).map(on).collect()
        };
        let figure = vec![
            round(Vec2::new(-0.13 * side, 0.02 * side), 0.12 * side, TAU),
            round(Vec2::new(0.15 * side, -0.05 * side), 0.1 * side, 2.2),
            vec![middle + Vec2::new(-0.2 * side, 0.22 * side), middle + Vec2::new(0.25 * side, 0.2 * side)],
        ];
        let shadow = (chance.between(0.0, 1.0) < 0.4)
            .then(|| (chance.between(0.5, 0.75), chance.between(0.0, TAU), chance.between(-0.15, 0.15) * h));
        let across = chance.between(0.3, 0.7);
        let finger = (chance.between(0.0, 1.0) < 0.4).then(|| {
            (
                Point::new(across * w, h + 20.0),
                Point::new(across * w, corners[2].y.min(corners[3].y) - 0.03 * h),
            )
        });
        // a table as bright as paper shows no finger's end, and needs none
        let finger = finger.filter(|_| table < 200.0);
        let light = (Vec2::new(1.0, 0.0), 1.0);
        let finger_tone = (0.6, 0.0);
        Self { size, corners, figure, pen, paper, table, shadow, finger, finger_tone, below: None, light }
    }

    /// The same held by a finger that reaches in from any side, dark or as bright as paper, with its own soft shadow.
    fn held(chance: &mut Chance) -> Self {
        let easy = Self { shadow: None, finger: None, ..Self::any(chance) };
        let side = chance.between(0.0, 3.999) as usize;
        let (a, b) = (easy.corners[side], easy.corners[(side + 1) % 4]);
        let on = a.lerp(b, chance.between(0.3, 0.7));
        let inward = (b - a).turn_90() / a.distance(b);
        let way = inward.rotate_scale(planar::direction(chance.between(-0.5, 0.5)));
        let side = easy.size.0.min(easy.size.1) as f64;
        let finger = Some((on - way * (0.5 * side), on + way * (0.02 * side)));
        let finger_tone = (chance.between(0.25, 1.0), chance.between(0.1, 0.4));
        let held = Self { finger, finger_tone, table: easy.table.min(0.6 * easy.paper), ..easy };
        // no ink lies in its shadow
        let clear = 0.08 * held.size.1 as f64;
        let is_clear = held.figure.iter().flatten().all(|p| held.off_finger(*p) > clear);
        if is_clear { held } else { Self::held(chance) }
    }

    /// The same with a deep shadow, or light from one side, or another sheet below it.
    fn hard(chance: &mut Chance) -> Self {
        let easy = Self { shadow: None, finger: None, ..Self::any(chance) };
        let (w, h) = (easy.size.0 as f64, easy.size.1 as f64);
        let way = |chance: &mut Chance| planar::direction(chance.between(0.0, TAU));
        match chance.between(0.0, 2.999) as usize {
            0 => {
                let deep =
                    (chance.between(0.45, 0.6), chance.between(0.0, TAU), chance.between(-0.2, 0.2) * h);
                Self { shadow: Some(deep), table: easy.table.min(0.6 * easy.paper), ..easy }
            }
            1 => Self { light: (way(chance), chance.between(0.35, 0.6)), ..easy },
            _ => {
                let turn = planar::direction(chance.between(0.12, 0.3) * chance.between(-1.0, 1.0).signum());
                let middle = Point::new(0.5 * w, 0.5 * h);
                let below = easy.corners.map(|c| middle + (0.98 * (c - middle)).rotate_scale(turn));
                let level = easy.paper * chance.between(0.88, 1.0);
                Self { below: Some((below, level)), table: easy.table.min(0.6 * easy.paper), ..easy }
            }
        }
    }

    /// How far a place is outside the sheet; none on it.
    fn outside(&self, at: Point) -> f64 {
        let side = |k: usize| {
            let (a, b) = (self.corners[k], self.corners[(k + 1) % 4]);
            (b - a).cross(a - at) / a.distance(b)
        };
        (0..4).map(side).fold(0.0, f64::max)
    }

    /// How far a place is from the middle of the finger.
    fn off_finger(&self, at: Point) -> f64 {
        self.finger.map_or(f64::INFINITY, |(from, tip)| {
            let way = tip - from;
            at.distance(from + way * ((at - from).dot(way) / way.hypot2()).clamp(0.0, 1.0))
        })
    }

    fn taken(&self, chance: &mut Chance) -> Grey {
        let (width, height) = self.size;
        let mut sheet = Canvas::new(width, height);
        sheet.fill(&[self.corners.to_vec()]);
        let mut ink = Canvas::new(width, height);
        self.figure.iter().for_each(|line| ink.pen(line, self.pen));
        let mut finger = Canvas::new(width, height);
        self.finger.iter().for_each(|(from, tip)| finger.pen(&[*from, *tip], 0.07 * height as f64));
        let mut below = Canvas::new(width, height);
        self.below.iter().for_each(|(corners, _)| below.fill(&[corners.to_vec()]));
        let [sheet, ink, finger, below] =
            [sheet, ink, finger, below].map(|drawn| drawn.shares().collect::<Vec<f64>>());
        let middle = Point::new(0.5 * width as f64, 0.5 * height as f64);
        let mut level = |k: usize| {
            let at = Point::new((k % width) as f64 + 0.5, (k / width) as f64 + 0.5);
            let paper = self.paper * (1.0 - 0.85 * ink[k]);
            let other = self.below.map_or(self.table, |(_, level)| level);
            let under = self.table + (other - self.table) * below[k];
            // a sheet on another throws a narrow shadow on it
            let near = 0.3 * (1.0 - self.outside(at) / (0.012 * height as f64)).max(0.0);
            let under = under * (1.0 - if self.below.is_some() { near } else { 0.0 });
            let seen = under + (paper - under) * sheet[k];
            let (tone, shade) = self.finger_tone;
            let off = self.off_finger(at) / (0.035 * height as f64) - 1.0;
            let seen = seen * (1.0 - shade * (1.0 - off.max(0.0)).max(0.0).powi(2));
            let seen = seen + (tone * self.paper - seen) * finger[k];
            let light = self.shadow.map_or(1.0, |(light, turn, off)| {
                let from_edge = (at - middle).dot(planar::direction(turn)) - off;
                light + (1.0 - light) * (from_edge + 0.5).clamp(0.0, 1.0)
            });
            let (way, left) = self.light;
            let share = 0.5 + (at - middle).dot(way) / width as f64;
            let light = light * (left + (1.0 - left) * share).clamp(0.2, 1.0);
            (seen * light + chance.between(-3.0, 3.0)).clamp(0.0, 255.0) as u8
        };
        Grey::new(width, height, (0..width * height).map(&mut level).collect()).unwrap()
    }
}

/// What is wrong with what was found of a photograph.
fn fault(photograph: &Photograph, image: &Grey) -> Option<String> {
    let page = Page::of(image);
    let Some(corners) = page.sheet.as_ref().and_then(|sheet| sheet.corners) else {
        return Some(format!("no sheet with four corners: {:?}", page.sheet));
    };
    let off = corners.iter().zip(&photograph.corners).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    if off > 2.0 {
        return Some(format!("a corner is {off:.1} px off"));
    }
    let traced = match trace_page(&page, &Options::default()) {
        Ok(traced) => traced,
        Err(error) => return Some(error.to_string()),
    };
    let drawn: Vec<Vec<Point>> =
        traced.strokes.strokes.iter().map(|stroke| stroke.path.flatten(0.05)).collect();
    let off = compare_polylines(&drawn, &photograph.figure, 2.0).unwrap();
    (off.max > 2.5 || off.coverage < 0.995).then(|| {
        format!("a stroke is {:.1} px off the figure, {:.3} of which is drawn", off.max, off.coverage)
    })
}

/// What is wrong with some photographs, by number.
fn faults(seed: u64, count: usize, any: impl Fn(&mut Chance) -> Photograph) -> Vec<String> {
    let mut chance = Chance(seed);
    let fault = |k: usize| {
        let photograph = any(&mut chance);
        let image = photograph.taken(&mut chance);
        fault(&photograph, &image).map(|fault| format!("photograph {k}: {fault}"))
    };
    (0..count).filter_map(fault).collect()
}

#[test]
fn two_hundred_photographs_of_sheets_give_their_figures_and_nothing_else() {
    let faults = faults(0x9e37_79b9_7f4a_7c15, 200, Photograph::any);
    assert!(faults.is_empty(), "{} of 200:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn nor_do_deep_shadows_light_from_one_side_and_other_sheets_below_change_that() {
    let faults = faults(0x2545_f491_4f6c_dd1d, 120, Photograph::hard);
    assert!(faults.len() < 6, "{} of 120:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn nor_do_fingers_that_hold_the_sheet_dark_or_as_bright_as_paper() {
    let faults = faults(0x1b87_3593_cc9e_2d51, 60, Photograph::held);
    assert!(faults.is_empty(), "{} of 60:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn a_short_line_on_a_sheet_half_in_deep_shadow_does_not_turn_it_inside_out() {
    let mut chance = Chance(0x0123_4567_89ab_cdef);
    for k in 0..12 {
        let any = Photograph { finger: None, ..Photograph::any(&mut chance) };
        let middle = Point::new(0.5 * any.size.0 as f64, 0.5 * any.size.1 as f64);
        let from = middle + Vec2::new(-60.0, 55.0);
        let figure = vec![vec![from, from + Vec2::new(27.0, 19.0)]];
        let deep = Photograph { figure, pen: 4.0, shadow: Some((0.5, 2.9, 20.0)), table: 60.0, ..any };
        let image = deep.taken(&mut chance);
        assert_eq!(fault(&deep, &image), None, "photograph {k}");
    }
}

/// A picture of 640 × 480 by the level of each place.
fn picture(level: impl Fn(f64, f64) -> f64) -> Grey {
    let at = |k: usize| level((k % 640) as f64 + 0.5, (k / 640) as f64 + 0.5) as u8;
    Grey::new(640, 480, (0..640 * 480).map(at).collect()).unwrap()
}

fn is_ring(x: f64, y: f64) -> bool {
    ((x - 250.0).hypot(y - 240.0) - 90.0).abs() < 2.0
}

#[test]
fn what_is_no_sheet_is_traced_as_it_was() {
    let ink = |x: f64, y: f64| if is_ring(x, y) { 30.0 } else { 230.0 };
    let is_whole = |name: &str, level: &dyn Fn(f64, f64) -> f64| {
        let image = picture(level);
        let page = Page::of(&image);
        assert_eq!(page.sheet, None, "{name}");
    };
    is_whole("paper alone", &|x, y| ink(x, y));
    is_whole("a shadow's edge", &|x, y| ink(x, y) * if x + 0.4 * y > 330.0 { 0.6 } else { 1.0 });
    let frame = |x: f64, y: f64, wide: f64| {
        let near = (x - 320.0).abs().max((y - 240.0).abs() + 80.0);
        (280.0..280.0 + wide).contains(&near)
    };
    for wide in [3.0, 8.0, 16.0] {
        is_whole("a frame about it", &|x, y| if frame(x, y, wide) { 30.0 } else { ink(x, y) });
    }
    is_whole("a floor between walls", &|x, y| {
        let floor = if x < 360.0 { 200.0 } else { 255.0 };
        let is_in = (52.0..588.0).contains(&x) && (52.0..340.0).contains(&y);
        let is_wall = !is_in && (40.0..600.0).contains(&x) && (40.0..352.0).contains(&y);
        if is_wall {
            0.0
        } else if is_in {
            floor
        } else {
            255.0
        }
    });
    is_whole("a frame along the border", &|x, y| {
        if !(5.0..635.0).contains(&x) || !(5.0..475.0).contains(&y) { 30.0 } else { ink(x, y) }
    });
    // how the shadow's edge lies, how far apart and how far turned the rules, and where they begin
    for ((slope, off, shade), (gap, turn, pale), (left, top), wide) in [
        ((0.476, 197.289, 0.525), (40.961, 0.049, 0.66), (8.66, 27.037), 3.642),
        ((0.275, 289.785, 0.53), (40.689, -0.04, 0.532), (38.231, 34.636), 3.67),
        ((0.586, 167.333, 0.673), (55.891, 0.003, 0.623), (47.054, 8.251), 3.782),
    ] {
        is_whole("squared paper on which a shadow falls", &|x, y| {
            let is_rule = |at: f64| at.rem_euclid(gap) < wide;
            let is_on = is_rule(x + turn * y - left) || is_rule(y - turn * x - top);
            let ring = ((x - 250.0).hypot(y - 240.0) - 90.0).abs() < 3.0;
            let lit = if y > off + slope * x { shade } else { 1.0 };
            lit * if ring { 30.0 } else { 230.0 } * if is_on { pale } else { 1.0 }
        });
    }
    is_whole("a filled shape", &|x, y| {
        if (380.0..600.0).contains(&x) && (80.0..400.0).contains(&y) { 40.0 } else { ink(x, y) }
    });
    is_whole("ground below", &|x, y| if y > 400.0 + 20.0 * (0.02 * x).sin() { 40.0 } else { ink(x, y) });
}

#[test]
fn sun_through_a_window_makes_no_sheet_and_takes_nothing_of_the_drawing() {
    let soft = |aside: f64, wide: f64| {
        let into = ((0.5 * wide - aside.abs()) / 30.0 + 0.5).clamp(0.0, 1.0);
        into * into * (3.0 - 2.0 * into)
    };
    // in the sun, half in it, and in the shade
    let rings = [(170.0, 130.0), (330.0, 250.0), (500.0, 360.0)];
    let is_ink = |x: f64, y: f64| rings.iter().any(|&(cx, cy)| ((x - cx).hypot(y - cy) - 60.0).abs() < 2.5);
    for (shade, turn) in [(0.5, 0.0_f64), (0.5, 0.3), (0.7, -0.5), (0.6, 1.2)] {
        let (sin, cos) = turn.sin_cos();
        let sun = |x: f64, y: f64| {
            let (across, down) = (x - 160.0, y - 120.0);
            soft(across * cos + down * sin, 330.0) * soft(down * cos - across * sin, 250.0)
        };
        for (inside, outside) in [(1.0, shade), (shade, 1.0)] {
            let lit = |x: f64, y: f64| outside + (inside - outside) * sun(x, y);
            let image = picture(|x, y| lit(x, y) * if is_ink(x, y) { 90.0 } else { 235.0 });
            let found = trace(&image, &Options::default()).unwrap();
            let closed = found.strokes.strokes.iter().filter(|stroke| stroke.path.is_closed()).count();
            let told = (Page::of(&image).sheet, found.strokes.strokes.len(), closed);
            assert_eq!(told, (None, 3, 3), "{inside} in the pane, {outside} beside it, turned by {turn}");
        }
    }
}

#[test]
fn a_scan_that_lies_a_little_askew_has_no_rim() {
    let level = |x: f64, y: f64| {
        if y > 470.0 + 0.015 * x {
            25.0
        } else if is_ring(x, y) {
            30.0
        } else {
            235.0
        }
    };
    let found = trace(&picture(level), &Options::default()).unwrap();
    assert_eq!(found.strokes.strokes.len(), 1);
    assert!(found.strokes.strokes[0].path.is_closed());
}

#[test]
fn corners_that_are_given_bound_what_is_traced() {
    let image = picture(|x, y| if is_ring(x, y) || (x - 560.0).abs() < 2.0 { 30.0 } else { 230.0 });
    let corners = [(120.0, 110.0), (420.0, 120.0), (410.0, 380.0), (110.0, 370.0)].map(Point::from);
    let page = Page::within(&image, corners).unwrap();
    let found = trace_page(&page, &Options::default()).unwrap();
    assert_eq!(found.strokes.strokes.len(), 1);
    assert_eq!((found.width_px, found.height_px), (640, 480));
    let at = found.strokes.strokes[0].path.start();
    assert!((at.distance(Point::new(250.0, 240.0)) - 90.0).abs() < 0.5, "{at:?}");
    // folded over, and next to nothing
    let [a, b, c, d] = corners;
    assert!(Page::within(&image, [a, c, b, d]).is_none());
    assert!(Page::within(&image, [a, b, c, d].map(|p| Point::new(0.1 * p.x, 0.1 * p.y))).is_none());
}

#[test]
fn a_page_copied_with_a_black_margin_is_a_sheet_and_a_blank_card_is_drawn() {
    // turned by two degrees, in black and white and nothing between
    let on_page = |x: f64, y: f64| {
        let (along, across) = (x - 0.035 * (y - 240.0), y + 0.035 * (x - 320.0));
        (70.0..570.0).contains(&along) && (60.0..420.0).contains(&across)
    };
    let page = picture(|x, y| if on_page(x, y) && !is_ring(x, y) { 255.0 } else { 0.0 });
    assert_eq!(Page::of(&page).sheet.and_then(|sheet| sheet.corners).map(|corners| corners.len()), Some(4));
    let found = trace(&page, &Options::default()).unwrap();
    assert_eq!(found.strokes.strokes.len(), 1);
    assert!(!found.quality.light_on_dark);
    let card = picture(|x, y| if on_page(x, y) { 255.0 } else { 0.0 });
    assert!(Page::of(&card).sheet.is_none());
    let found = trace(&card, &Options::default()).unwrap();
    assert!(found.quality.light_on_dark && found.strokes.strokes.len() == 1);
}

/// Hardly anything is drawn on the sheet, with a pencil, and cloth or grain shows all over the table, which ends at its far edge.
#[test]
fn a_table_with_a_grain_is_none_of_the_drawing_however_little_is_drawn() {
    for (paper, table, bottom) in [(190.0, 136.0, 600.0), (190.0, 136.0, 430.0), (173.0, 208.0, 430.0)] {
        let image = picture(|x, y| {
            let (along, across) = (x - 0.05 * (y - 240.0), y + 0.05 * (x - 320.0));
            let on_sheet = (60.0..460.0).contains(&along) && (90.0..bottom).contains(&across);
            let weave = 16.0 * (0.9 * along).sin() * (0.8 * across).sin();
            if on_sheet && ((along - 160.0).hypot(across - 300.0) - 40.0).abs() < 1.2 {
                paper - 50.0
            } else if on_sheet {
                paper
            } else if across < 40.0 {
                0.45 * table
            } else {
                table + weave
            }
        });
        let sheet = Page::of(&image).sheet.unwrap();
        let beside = 1.0 - 400.0 * (f64::min(bottom, 480.0) - 90.0) / (640.0 * 480.0);
        assert!((sheet.beside - beside).abs() < 0.03, "paper {paper}: {sheet:?}");
        let found = trace(&image, &Options::default()).unwrap();
        assert_eq!(found.strokes.strokes.len(), 1, "paper {paper}");
    }
}
