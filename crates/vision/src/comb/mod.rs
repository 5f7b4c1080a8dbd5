//! Ruled, squared paper: its rules found, told of, and taken out from under the ink.
//!
//! Printed rules are thin, straight but for the page's own bend, parallel, equally spaced, of one darkness, and run from border to border
//! all over the page; a drawing's lines rarely do one of these things and never all. `strips` finds thin lines in narrow strips
//! across the page, `track` follows them over it, `family` asks of those whether they are rules, `template` learns what each looks
//! like, `wipe` takes it off and leaves what is drawn over it.

mod family;
mod runs;
mod strips;
mod template;
mod track;
mod wipe;

use family::{Ends, Family};
use strips::Strips;
use template::Template;
use track::{Track, tracks};
use wipe::{Levels, wipe};

use crate::plane::Plane;

/// Rules of paper that were taken out of an image.
#[derive(Clone, Debug, PartialEq)]
pub struct Rules {
    /// One for ruled paper, two for squared.
    pub combs: Vec<Comb>,
}

impl Rules {
    /// In pixels of another size.
    pub(crate) fn scaled(mut self, by: f64) -> Self {
        for comb in &mut self.combs {
            comb.spacing_px *= by;
            comb.width_px *= by;
        }
        self
    }
}

/// Parallel rules.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comb {
    /// How many.
    pub count: usize,
    /// From one's middle to the next one's, px.
    pub spacing_px: f64,
    /// Their width where they are half as dark as at their darkest, px.
    pub width_px: f64,
    /// Whether they lead from top to bottom, or from left to right.
    pub upright: bool,
    /// How far they are turned from that, counter-clockwise as seen, rad.
    pub turned_rad: f64,
}

/// Most families of rules in one direction.
const MOST_FAMILIES: usize = 3;

/// Shortest side of a picture in which rules are looked for, px.
const LEAST_SIDE: usize = 96;

/// A plane of darkness without the rules of its paper, and which they were. `noise` is its pixels' deviation, `strongest` how dark the
/// strongest ink is. `None` where the paper is plain.
pub(crate) fn without_rules(dark: &Plane<u8>, noise: f64, strongest: f64) -> Option<(Plane<u8>, Rules)> {
    if dark.width.min(dark.height) < LEAST_SIDE {
        return None;
    }
    let sides = [Strips::of_level(dark, noise), Strips::of_upright(dark, noise)];
    if !sides.iter().any(|strips| strips.are_crossed_by(family::FEWEST - 1)) {
        return None;
    }
    let [level, upright] = sides.map(Side::of);
    let [level_rules, upright_rules] = families(&level, &upright)?;
    let levels = Levels { noise: noise as f32, ink: strongest as f32 };
    let mut plane = dark.clone();
    let mut combs = level.taken_out(&mut plane, &level_rules, levels);
    let mut turned = transposed(&plane);
    let over = upright.taken_out(&mut turned, &upright_rules, levels);
    combs.extend(over.into_iter().map(|comb| Comb { upright: true, turned_rad: -comb.turned_rad, ..comb }));
    (!combs.is_empty()).then(|| (transposed(&turned), Rules { combs }))
}

/// The rules of either direction; `None` where there are none at all.
fn families(level: &Side, upright: &Side) -> Option<[Vec<Family>; 2]> {
    let mut level_rules = level.families(Ends::At(&upright.margins()));
    let mut upright_rules = upright.families(Ends::At(&level.margins()));
    match (level_rules.first(), upright_rules.first()) {
        (None, None) => return None,
        (Some(rules), None) => upright_rules = upright.families(Ends::Squared(rules.spacing)),
        (None, Some(rules)) => level_rules = level.families(Ends::Squared(rules.spacing)),
        (Some(_), Some(_)) => (),
    }
    Some([level_rules, upright_rules])
}

/// What crosses the strips of one direction.
struct Side {
    strips: Strips,
    tracks: Vec<Track>,
}

impl Side {
    fn of(strips: Strips) -> Self {
        let tracks = tracks(&strips);
        Self { strips, tracks }
    }

    /// The lines that lead from border to border.
    fn whole(&self) -> impl Iterator<Item = &Track> {
        self.tracks.iter().filter(|track| track.is_whole(&self.strips))
    }

    /// Where they are.
    fn margins(&self) -> Vec<f64> {
        self.whole().map(|track| track.middle(&self.strips)).collect()
    }

    /// Rules of this direction: those of the page, and those of its back that shine through.
    fn families(&self, ends: Ends<'_>) -> Vec<Family> {
        let (mut left, mut found) = (self.tracks.clone(), Vec::new());
        while let Some(family) = family::family(&self.strips, &left, ends) {
            let before = left.len();
            left.retain(|track| !family.has(track.middle(&self.strips)));
            found.push(family);
            if left.len() == before || found.len() == MOST_FAMILIES {
                break;
            }
        }
        found
    }

    /// Takes rules off a plane on which they are level, and the other lines from border to border, as margins have them.
    fn taken_out(&self, plane: &mut Plane<u8>, families: &[Family], levels: Levels) -> Vec<Comb> {
        let at: Vec<f64> = self.strips.strips.iter().map(|strip| strip.at).collect();
        let widest = (plane.height / 40).max(6);
        let take = |plane: &mut Plane<u8>, rule: &[f64], reach: usize| {
            let centre = courses(&at, rule, plane.width);
            let template = Template::of(plane, &centre, reach)?;
            wipe(plane, &centre, &template, levels);
            Some(template)
        };
        let mut combs = Vec::new();
        for family in families {
            let reach = ((0.45 * family.spacing) as usize).clamp(3, widest);
            let mut templates: Vec<Template> =
                family.rules.iter().filter_map(|rule| take(plane, &rule.at, reach)).collect();
            templates.sort_by(|a, b| a.width().total_cmp(&b.width()));
            let Some(usual) = templates.get(templates.len() / 2) else { continue };
            combs.push(family.told(usual.width()));
            for rule in &family.cut {
                // too little of it is seen to know it by itself
                let centre = courses(&at, &rule.at, plane.width);
                wipe(plane, &centre, usual, levels);
                continue_over(plane, &centre, usual.width());
            }
        }
        let is_new = |track: &&Track| !families.iter().any(|f| f.has(track.middle(&self.strips)));
        self.whole().filter(is_new).for_each(|track| {
            take(plane, &track.smoothed(&self.strips), widest);
        });
        combs
    }
}

/// Covers a rule, where it lies on the plane's upper or lower border, with what is just within: half a rule has no other
/// side.
fn continue_over(plane: &mut Plane<u8>, centre: &[f32], width: f64) {
    let (columns, last) = (plane.width, plane.height - 1);
    let on_border = |at: f32| at.abs().min((at - last as f32).abs()) <= family::CUT_PX as f32;
    for (x, &at) in centre.iter().enumerate().filter(|(_, at)| on_border(**at)) {
        let reach = (width as f32 + 1.5).ceil();
        let is_upper = at < 0.5 * last as f32;
        let within = if is_upper { at + reach } else { at - reach }.clamp(0.0, last as f32) as usize;
        let rows = if is_upper { 0..within } else { within + 1..last + 1 };
        let level = plane.values[within * columns + x];
        rows.for_each(|y| plane.values[y * columns + x] = level);
    }
}

/// Between places where it is known, and beyond them, by column.
fn courses(at: &[f64], values: &[f64], width: usize) -> Vec<f32> {
    let mut k = 0;
    let value = |x: usize| {
        let x = x as f64;
        while k + 2 < at.len() && x > at[k + 1] {
            k += 1;
        }
        let share = (x - at[k]) / (at[k + 1] - at[k]);
        (values[k] + (values[k + 1] - values[k]) * share) as f32
    };
    (0..width).map(value).collect()
}

/// Rows and columns exchanged.
fn transposed(plane: &Plane<u8>) -> Plane<u8> {
    const BLOCK: usize = 32;
    let mut out = Plane::filled(plane.height, plane.width, 0);
    for top in (0..plane.height).step_by(BLOCK) {
        for left in (0..plane.width).step_by(BLOCK) {
            for y in top..(top + BLOCK).min(plane.height) {
                for x in left..(left + BLOCK).min(plane.width) {
                    out.values[x * plane.height + y] = plane.values[y * plane.width + x];
                }
            }
        }
    }
    out
}
