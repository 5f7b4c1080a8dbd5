//! Any image ends in strokes or in an error.

use tracelight_image::Grey;
use tracelight_vision::{Mode, Options, find_two_marks, trace};

/// Marsaglia's xorshift64.
struct Draw(u64);

impl Draw {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % n
    }

    /// A picture of random boxes, dashes and specks, some over others, some cut by its border.
    fn picture(&mut self) -> Grey {
        let (w, h) = (8 + self.below(90), 8 + self.below(70));
        let mut levels = vec![self.below(256) as u8; w * h];
        for _ in 0..self.below(12) {
            let (x, y, level) = (self.below(w), self.below(h), self.below(256) as u8);
            let (across, down, slope) = (1 + self.below(30), 1 + self.below(30), self.below(5));
            for v in y..(y + down).min(h) {
                let from = (x + (v - y) * slope / 2).min(w);
                levels[v * w + from..v * w + (from + across).min(w)].fill(level);
            }
        }
        Grey::new(w, h, levels).unwrap()
    }
}

#[test]
fn no_image_is_too_odd() {
    let mut draw = Draw(0x9e37_79b9_7f4a_7c15);
    let mut traced = 0;
    for number in 0..3000 {
        let image = draw.picture();
        let _ = find_two_marks(&image);
        for mode in [Mode::Auto, Mode::Centreline, Mode::Outline, Mode::Sweep] {
            let Ok(found) = trace(&image, &Options { mode, ..Options::default() }) else { continue };
            traced += 1;
            assert!(!found.strokes.strokes.is_empty(), "picture {number}, {}", mode.name());
            let (right, low) = (image.width() as f64 + 12.0, image.height() as f64 + 12.0);
            for p in found.strokes.strokes.iter().flat_map(|s| s.path.flatten(0.5)) {
                let near = (-12.0..right).contains(&p.x) && (-12.0..low).contains(&p.y);
                assert!(near, "picture {number}, {}: a point at ({}, {})", mode.name(), p.x, p.y);
            }
        }
    }
    assert!(traced > 3000, "only {traced} traced");
}

#[test]
fn textures_take_seconds_and_not_minutes() {
    type Texture = fn(usize, usize) -> bool;
    let checks: Texture = |x, y| (x / 3 + y / 3) % 2 == 0;
    let hatching: Texture = |x, y| (x + y) % 9 < 3;
    for texture in [checks, hatching] {
        let levels = (0..1_000_000).map(|i| if texture(i % 1000, i / 1000) { 20 } else { 230 }).collect();
        let image = Grey::new(1000, 1000, levels).unwrap();
        for mode in [Mode::Auto, Mode::Centreline, Mode::Outline, Mode::Sweep] {
            let _ = trace(&image, &Options { mode, ..Options::default() });
        }
    }
}
