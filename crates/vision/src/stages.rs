use tracelight_sheet::Page;

use crate::VisionError;
use crate::options::Options;
use crate::seen::Seen;

/// Intermediate images between a picture and its strokes.
#[derive(Clone, Debug)]
pub struct Stages {
    /// Width of both planes, px: the image's, or less if the image is so large that pixels are averaged.
    pub width: usize,
    /// Height of both planes, px.
    pub height: usize,
    /// Row by row: how dark each pixel is beside its paper, the light evened out and the paper's rules taken out; 0 is paper, 255 total darkness. Of light ink on dark
    /// paper, how light.
    pub darkness: Vec<u8>,
    /// What is darker is ink.
    pub threshold: u8,
    /// Row by row: what is taken for ink. More than the threshold says where there is a second, paler ink.
    pub ink: Vec<bool>,
}

impl Stages {
    /// Of a page, as it would be traced.
    ///
    /// # Errors
    /// As [`trace`](crate::trace): an image without ink.
    pub fn of(page: &Page<'_>, options: &Options) -> Result<Self, VisionError> {
        let Seen { ink, mask, .. } = Seen::of(page, options)?;
        let (width, height) = (ink.darkness.width, ink.darkness.height);
        let at = |i: usize| mask.get((i % width) as isize, (i / width) as isize);
        Ok(Self {
            width,
            height,
            ink: (0..width * height).map(at).collect(),
            threshold: ink.threshold,
            darkness: ink.darkness.values,
        })
    }

    /// How many pixels there are of each darkness.
    pub fn histogram(&self) -> [usize; 256] {
        let mut counts = [0; 256];
        self.darkness.iter().for_each(|&level| counts[usize::from(level)] += 1);
        counts
    }
}

#[cfg(test)]
mod tests {
    use tracelight_image::Grey;

    use super::*;

    #[test]
    fn stages_of_a_line_are_its_own() {
        let line = |x: usize, y: usize| y == 20 && (10..50).contains(&x) || y == 21 && (10..50).contains(&x);
        let levels = (0..60 * 40).map(|i| if line(i % 60, i / 60) { 40 } else { 220 }).collect();
        let stages =
            Stages::of(&Page::whole(&Grey::new(60, 40, levels).unwrap()), &Options::default()).unwrap();
        assert_eq!((stages.width, stages.height), (60, 40));
        let counts = stages.histogram();
        assert_eq!(counts.iter().sum::<usize>(), 60 * 40);
        assert_eq!(stages.ink.iter().filter(|ink| **ink).count(), 80);
        assert!((0..60 * 40).all(|i| stages.ink[i] == line(i % 60, i / 60)));
        let over: usize = counts[usize::from(stages.threshold) + 1..].iter().sum();
        assert_eq!(over, 80, "threshold {}", stages.threshold);
    }

    #[test]
    fn stages_are_of_what_is_traced_where_slits_look_like_light_lines() {
        // a disc filled with a felt pen, under light from one side
        let level = |x: usize, y: usize| {
            let (x, y) = (x as f64, y as f64);
            let paper = 235.0 - 0.55 * x;
            let slit = (x / 12.0).fract() < 0.17 && (y - 120.0).abs() < 52.0;
            let is_ink = (x - 110.0).hypot(y - 120.0) < 60.0 && !slit;
            if is_ink { 0.25 * paper } else { paper }
        };
        let levels = (0..320 * 240).map(|i| level(i % 320, i / 320) as u8).collect();
        let image = Grey::new(320, 240, levels).unwrap();
        let stages = Stages::of(&Page::whole(&image), &Options::default()).unwrap();
        let ink = |x: usize, y: usize| stages.ink[y * 320 + x];
        assert!(ink(106, 120) && !ink(10, 10) && !ink(300, 120));
    }
}
