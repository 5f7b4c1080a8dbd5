//! A run as a moving picture: an SVG that plays by itself, over and over, wherever pictures are shown.

use std::fmt::Write as _;

use tracelight_chart::{Colour, Rgb, Theme};
use tracelight_rig::TICK_F64_S;
use tracelight_sim::Run;
use tracelight_stroke::Point;

use crate::finished::Target;
use crate::page::html::escaped;

/// Width of the wall, px, and what is around it.
const WIDE: f64 = 800.0;
const MARGIN: f64 = 40.0;
/// Room for the line below the wall, px.
const FOOT: f64 = 44.0;
/// Longest film, s; what takes longer is shown faster. How long it stands at its end.
const LONGEST_S: f64 = 12.0;
const STANDS_S: f64 = 2.0;
/// How far what is shown may be from what was, px; a drawing of very many strokes is shown coarser.
const TOLERANCE: f64 = 0.35;
/// Most places of the spot in a film.
const MOST_PLACES: usize = 20_000;

/// What a film is of.
#[derive(Clone, Copy, Debug)]
pub struct Film<'a> {
    /// What was drawn, as people call it.
    pub name: &'a str,
    /// Where, and how large.
    pub target: Target,
    /// The run that is shown.
    pub run: &'a Run,
    /// Nothing of it is real.
    pub simulated: bool,
}

/// A place of the spot, px, and when, s.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    t_s: f64,
    x: f64,
    y: f64,
    lit: bool,
}

/// Draws a run as an SVG that plays by itself; nothing of a run in which the spot was nowhere on the wall. Viewers that play nothing show the whole light.
#[must_use]
pub fn film(of: &Film<'_>) -> Option<String> {
    let scale = WIDE / of.target.width_m.max(f64::MIN_POSITIVE);
    let high = of.target.height_m * scale;
    let at = |spot: Point| {
        let (x, y) = (spot.x - of.target.middle.x, of.target.middle.y - spot.y);
        (MARGIN + 0.5 * WIDE + scale * x, MARGIN + 0.5 * high + scale * y)
    };
    let all: Vec<Place> = of
        .run
        .ticks
        .iter()
        .zip(0_u32..)
        .filter_map(|(tick, number)| {
            let (x, y) = at(tick.spot?);
            Some(Place { t_s: f64::from(number) * TICK_F64_S, x, y, lit: tick.light })
        })
        .collect();
    let lasts_s = all.last()?.t_s;
    let faster = faster(lasts_s);
    let shown_s = lasts_s / faster + STANDS_S;
    let strokes = strokes(&all);
    let share = |t_s: f64| (t_s / faster / shown_s).clamp(0.0, 1.0);
    let (width, height) = (WIDE + 2.0 * MARGIN, high + 2.0 * MARGIN + FOOT);
    let mut svg = head(of, (width, height), (lasts_s, faster));
    paths(&mut svg, &strokes, shown_s, share);
    let (below, rule, light) = (height - FOOT, Theme::Dark.rule(), light());
    let end = share(lasts_s);
    // writing to a String cannot fail
    let _ = write!(
        svg,
        "<rect x=\"{MARGIN}\" y=\"{below:.1}\" width=\"{WIDE}\" height=\"3\" fill=\"{rule}\"/>\n\
         <rect x=\"{MARGIN}\" y=\"{below:.1}\" width=\"{WIDE}\" height=\"3\" fill=\"{light}\">\
         <animate attributeName=\"width\" dur=\"{shown_s:.2}s\" repeatCount=\"indefinite\" keyTimes=\"0;{end:.4};1\" values=\"0;{WIDE};{WIDE}\"/></rect>\n"
    );
    spot(&mut svg, &thinned_all(&all, &strokes), shown_s, share);
    svg.push_str("</svg>\n");
    Some(svg)
}

/// The light's colour on a dark wall.
const fn light() -> Rgb {
    Colour::Light.rgb(Theme::Dark)
}

/// How many times as fast a run is shown that lasts so long: 1, 2, 5, 10, 20 …
fn faster(lasts_s: f64) -> f64 {
    let mut decade = 1.0;
    loop {
        for step in [1.0, 2.0, 5.0] {
            // a run is not longer than days
            if lasts_s <= LONGEST_S * decade * step || decade > 1e9 {
                return decade * step;
            }
        }
        decade *= 10.0;
    }
}

/// What was lit without a break, as few places of each.
fn strokes(all: &[Place]) -> Vec<Vec<Place>> {
    let whole: Vec<&[Place]> = all.chunk_by(|a, b| a.lit == b.lit).filter(|run| run[0].lit).collect();
    let mut tolerance = TOLERANCE;
    loop {
        let strokes: Vec<Vec<Place>> = whole.iter().map(|run| thinned(run, tolerance)).collect();
        let places: usize = strokes.iter().map(Vec::len).sum();
        if places <= MOST_PLACES || places <= 2 * whole.len() {
            return strokes;
        }
        tolerance *= 2.0;
    }
}

/// The way of the spot through all of it: the lit strokes as they are shown, and what is dark between them.
fn thinned_all(all: &[Place], strokes: &[Vec<Place>]) -> Vec<Place> {
    let mut strokes = strokes.iter();
    let mut way = Vec::new();
    for run in all.chunk_by(|a, b| a.lit == b.lit) {
        match run[0].lit {
            true => way.extend(strokes.next().into_iter().flatten().copied()),
            // nobody looks closely where it is dark
            false => way.extend(thinned(run, 4.0 * TOLERANCE)),
        }
    }
    way
}

/// The fewest places between which the spot goes straight on, evenly in time, to within a tolerance, px.
fn thinned(run: &[Place], tolerance: f64) -> Vec<Place> {
    let mut keeps = vec![false; run.len()];
    let mut spans = vec![(0, run.len().saturating_sub(1))];
    while let Some((from, to)) = spans.pop() {
        (keeps[from], keeps[to]) = (true, true);
        let (a, b) = (run[from], run[to]);
        let off = |place: &Place| {
            let share = (place.t_s - a.t_s) / (b.t_s - a.t_s).max(f64::MIN_POSITIVE);
            let (x, y) = (place.x - (a.x + share * (b.x - a.x)), place.y - (a.y + share * (b.y - a.y)));
            x * x + y * y
        };
        let between = run[from..=to].iter().map(off).zip(from..).skip(1);
        let worst = between.max_by(|one, other| one.0.total_cmp(&other.0));
        if let Some((_, at)) = worst.filter(|(off, at)| *at < to && *off > tolerance * tolerance) {
            spans.extend([(from, at), (at, to)]);
        }
    }
    run.iter().zip(keeps).filter(|(_, keep)| *keep).map(|(place, _)| *place).collect()
}

fn head(of: &Film<'_>, (width, height): (f64, f64), (lasts_s, faster): (f64, f64)) -> String {
    // wherever it lies
    let name = escaped(of.name.rsplit(['/', '\\']).next().unwrap_or(of.name));
    let (wall, soft) = (Theme::Dark.wall(), Theme::Dark.soft());
    let size = format!("{:.0} × {:.0} cm", 100.0 * of.target.width_m, 100.0 * of.target.height_m);
    let times = if faster > 1.0 { format!(", shown {faster} times as fast") } else { String::new() };
    let by = if of.simulated { " · simulated" } else { "" };
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" height=\"{height:.0}\" font-family=\"sans-serif\" role=\"img\">\n\
         <title>{name}, drawn by a spot of light</title>\n\
         <desc>{size} on a wall in {lasts_s:.1} s{times}{by}</desc>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"{wall}\"/>\n\
         <text x=\"{MARGIN}\" y=\"{:.1}\" font-size=\"14\" fill=\"{soft}\">{name} · {size} in {lasts_s:.1} s{times}{by}</text>\n",
        height - 0.35 * FOOT,
    )
}

/// The strokes: faint as they will be, and lit as the spot goes along them.
fn paths(svg: &mut String, strokes: &[Vec<Place>], shown_s: f64, share: impl Fn(f64) -> f64) {
    let (ink, light) = (Theme::Dark.ink(), light());
    let join = "fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\"";
    let mut faint = String::new();
    let mut lit = String::new();
    for (stroke, number) in strokes.iter().zip(1..) {
        let mut way = String::new();
        for (place, n) in stroke.iter().zip(0..) {
            let _ = write!(way, "{}{:.1} {:.1}", if n == 0 { "M" } else { " " }, place.x, place.y);
        }
        // a stroke of one place is a dot
        if stroke.len() == 1 {
            way.push_str("h.1");
        }
        let _ = writeln!(faint, "<path d=\"{way}\"/>");
        let (times, offsets) = drawn(stroke, &share);
        let _ = writeln!(
            lit,
            "<path id=\"s{number}\" d=\"{way}\" pathLength=\"1000\" stroke-dasharray=\"1000 1002\">\
             <animate attributeName=\"stroke-dashoffset\" dur=\"{shown_s:.2}s\" repeatCount=\"indefinite\" keyTimes=\"{times}\" values=\"{offsets}\"/></path>"
        );
    }
    let glow: String = (1..=strokes.len()).map(|number| format!("<use href=\"#s{number}\"/>")).collect();
    let _ = write!(
        svg,
        "<g {join} stroke=\"{ink}\" stroke-opacity=\"0.14\" stroke-width=\"1.5\">\n{faint}</g>\n\
         <defs>\n{lit}</defs>\n\
         <g {join} stroke=\"{light}\" stroke-opacity=\"0.12\" stroke-width=\"17\">{glow}</g>\n\
         <g {join} stroke=\"{light}\" stroke-opacity=\"0.3\" stroke-width=\"9\">{glow}</g>\n\
         <g {join} stroke=\"{light}\" stroke-width=\"4\">{glow}</g>\n\
         <g {join} stroke=\"{ink}\" stroke-width=\"1.6\">{glow}</g>\n"
    );
}

/// When how much of a stroke is drawn: shares of the film, and what of 1000 is left. Before it begins nothing of it is there, not even an end.
fn drawn(stroke: &[Place], share: impl Fn(f64) -> f64) -> (String, String) {
    let step = |pair: &[Place]| {
        let (x, y) = (pair[1].x - pair[0].x, pair[1].y - pair[0].y);
        (x * x + y * y).sqrt()
    };
    let lengths: Vec<f64> = stroke.windows(2).map(step).collect();
    let whole: f64 = lengths.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let begins = share(stroke[0].t_s);
    let (mut times, mut offsets) = (format!("0;{begins:.4}"), "1001;1001".to_owned());
    let mut gone = 0.0;
    for (place, length) in stroke.iter().skip(1).zip(&lengths) {
        gone += length;
        let _ = write!(times, ";{:.4}", share(place.t_s));
        let _ = write!(offsets, ";{:.0}", 1000.0 * (1.0 - gone / whole));
    }
    times.push_str(";1");
    offsets.push_str(";0");
    if stroke.len() == 1 {
        // as soon as it is lit
        return (format!("0;{begins:.4};{begins:.4};1"), "1001;1001;0;0".to_owned());
    }
    (times, offsets)
}

/// The spot, bright where it is lit, a ring where it is dark.
fn spot(svg: &mut String, way: &[Place], shown_s: f64, share: impl Fn(f64) -> f64) {
    let mut times = "0".to_owned();
    let (mut xs, mut ys) =
        way.first().map_or_else(Default::default, |p| (format!("{:.1}", p.x), format!("{:.1}", p.y)));
    for place in way {
        let _ = write!(times, ";{:.4}", share(place.t_s));
        let _ = write!(xs, ";{:.1}", place.x);
        let _ = write!(ys, ";{:.1}", place.y);
    }
    let (x, y) = way.last().map_or((0.0, 0.0), |place| (place.x, place.y));
    let _ = write!(times, ";1");
    let _ = write!(xs, ";{x:.1}");
    let _ = write!(ys, ";{y:.1}");
    let (mut turns, mut shown) = ("0".to_owned(), "0".to_owned());
    for turn in way.windows(2).filter(|pair| pair[0].lit != pair[1].lit).map(|pair| pair[1]) {
        let _ = write!(turns, ";{:.4}", share(turn.t_s));
        shown.push_str(if turn.lit { ";1" } else { ";0" });
    }
    let along = |name: &str, values: &str| {
        format!(
            "<animate attributeName=\"{name}\" dur=\"{shown_s:.2}s\" repeatCount=\"indefinite\" keyTimes=\"{times}\" values=\"{values}\"/>"
        )
    };
    let (ink, light, dark) = (Theme::Dark.ink(), light(), Theme::Dark.dark_way());
    let (along_x, along_y) = (along("cx", &xs), along("cy", &ys));
    let _ = write!(
        svg,
        "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"none\" stroke=\"{dark}\" stroke-width=\"1.5\">{along_x}{along_y}</circle>\n\
         <g opacity=\"0\"><animate attributeName=\"opacity\" calcMode=\"discrete\" dur=\"{shown_s:.2}s\" repeatCount=\"indefinite\" keyTimes=\"{turns}\" values=\"{shown}\"/>\
         <circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"13\" fill=\"{light}\" fill-opacity=\"0.35\">{along_x}{along_y}</circle>\
         <circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"5\" fill=\"{ink}\">{along_x}{along_y}</circle></g>\n"
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(t_s: f64, x: f64, lit: bool) -> Place {
        Place { t_s, x, y: 0.0, lit }
    }

    #[test]
    fn a_film_is_no_longer_than_it_may_be_and_says_how_fast_it_is() {
        for (lasts_s, times) in
            [(3.0, 1.0), (12.0, 1.0), (20.7, 2.0), (59.0, 5.0), (600.0, 50.0), (1e5, 10_000.0)]
        {
            assert!((faster(lasts_s) - times).abs() < 1e-9, "{lasts_s}: {}", faster(lasts_s));
        }
    }

    #[test]
    fn places_are_left_out_where_the_spot_goes_evenly_on_and_kept_where_it_turns_or_slows() {
        let even: Vec<Place> = (0..100).map(|n| place(f64::from(n), f64::from(n), true)).collect();
        assert_eq!(thinned(&even, 0.1), [even[0], even[99]]);
        // half as fast from the middle on
        let slows = |n: i32| if n < 50 { f64::from(n) } else { 25.0 + 0.5 * f64::from(n) };
        let slow: Vec<Place> = (0..100).map(|n| place(f64::from(n), slows(n), true)).collect();
        assert_eq!(thinned(&slow, 0.1).len(), 3);
        assert_eq!(thinned(&even[..1], 0.1), [even[0]]);
    }

    #[test]
    fn a_stroke_is_drawn_as_the_spot_goes_and_nothing_of_it_before() {
        let stroke = [place(2.0, 0.0, true), place(3.0, 30.0, true), place(4.0, 40.0, true)];
        let (times, offsets) = drawn(&stroke, |t_s| t_s / 10.0);
        assert_eq!(times, "0;0.2000;0.3000;0.4000;1");
        assert_eq!(offsets, "1001;1001;250;0;0");
        let lit =
            [place(0.0, 0.0, false), place(1.0, 1.0, true), place(2.0, 2.0, true), place(3.0, 3.0, false)];
        assert_eq!(strokes(&lit).len(), 1);
        assert_eq!(thinned_all(&lit, &strokes(&lit)).len(), 4);
    }
}
