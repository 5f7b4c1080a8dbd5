//! How long a crowded SVG takes to be read as it is seen: 20 000 paths, 2 MB, that cover, clip and cross each other.

use std::fmt::Write;

use divan::Bencher;
use oorandom::Rand64;
use tracelight_formats::svg;

fn main() {
    divan::main();
}

#[divan::bench(args = [1_000, 5_000, 20_000], sample_count = 10, sample_size = 1)]
fn crowd_of_paths(bencher: Bencher, paths: usize) {
    let text = crowd(paths, 1);
    bencher.bench(|| svg::read(text.as_bytes()).map(|reading| reading.sheet.drawing.strokes.len()));
}

/// Side of the page, px.
const PAGE: f64 = 1000.0;

/// Paths of a group. Every fifth group is clipped by a circle.
const GROUP: usize = 100;

/// An SVG of that many paths: half blobs of one colour, a third curved lines, the rest outlined plates; in groups, each
/// group about a place of its own. A large plate covers part of the page before every twentieth group.
pub(crate) fn crowd(paths: usize, seed: u64) -> String {
    let mut draw = Draw(Rand64::new(u128::from(seed)));
    let mut text = format!("<svg xmlns='http://www.w3.org/2000/svg' width='{PAGE}' height='{PAGE}'>\n");
    for group in 0..paths.div_ceil(GROUP) {
        draw.group(group, GROUP.min(paths - group * GROUP), &mut text);
    }
    text + "</svg>\n"
}

struct Draw(Rand64);

impl Draw {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.rand_float()
    }

    fn colour(&mut self) -> String {
        format!("#{:03x}", self.0.rand_range(0..0xfff))
    }

    fn group(&mut self, number: usize, paths: usize, text: &mut String) {
        let [x, y] = [self.between(0.0, PAGE), self.between(0.0, PAGE)];
        let mut looks = String::new();
        if number.is_multiple_of(5) {
            let radius = self.between(60.0, 150.0);
            let circle = format!("<circle cx='{x:.1}' cy='{y:.1}' r='{radius:.1}'/>");
            writeln!(text, "<clipPath id='c{number}'>{circle}</clipPath>").unwrap_or_default();
            looks = format!(" clip-path='url(#c{number})'");
        }
        if number % 20 == 19 {
            let fill = self.colour();
            writeln!(text, "<path d='M{:.1} {:.1}h300v300h-300z' fill='{fill}'/>", x - 150.0, y - 150.0)
                .unwrap_or_default();
        }
        writeln!(text, "<g{looks}>").unwrap_or_default();
        for _ in 0..paths {
            let at = [x + self.between(-150.0, 150.0), y + self.between(-150.0, 150.0)];
            self.path(at, text);
        }
        text.push_str("</g>\n");
    }

    fn path(&mut self, [x, y]: [f64; 2], text: &mut String) {
        let size = self.between(3.0, 40.0);
        let colour = self.colour();
        let near = |draw: &mut Self| draw.between(-size, size);
        match self.0.rand_range(0..6) {
            0..=2 => {
                let [a, b, c] = [size, 0.6 * size, near(self)];
                writeln!(
                    text,
                    "<path d='M{x:.1} {y:.1}c{a:.1} {b:.1} {c:.1} {a:.1} 0 {a:.1}s-{a:.1}-{b:.1} 0-{a:.1}z' fill='{colour}'/>"
                )
            }
            3 | 4 => {
                let [a, b, c, d] = [near(self), near(self), near(self), near(self)];
                writeln!(
                    text,
                    "<path d='M{x:.1} {y:.1}c{a:.1} {b:.1} {c:.1} {d:.1} {b:.1} {a:.1}s{d:.1} {c:.1} {a:.1} {d:.1}' fill='none' stroke='{colour}'/>"
                )
            }
            _ => {
                let [a, b] = [near(self), near(self)];
                writeln!(
                    text,
                    "<path d='M{x:.1} {y:.1}l{a:.1} {b:.1} {b:.1} {a:.1}-{size:.1} {b:.1}z' fill='{colour}' stroke='#000'/>"
                )
            }
        }
        .unwrap_or_default();
    }
}
