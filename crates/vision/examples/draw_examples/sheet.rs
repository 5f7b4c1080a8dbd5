use tracelight_maths::hypot;

use super::{canvas::Canvas, grain::grain};

/// What is drawn on, and with what.
///
/// Ink is mixed with the ground in encoded 8-bit values, not in linear light: the level half way between the two
/// then lies where a pixel is half covered, on the line's true edge.
pub(crate) struct Sheet {
    /// Tone of the bare sheet, 0 to 255.
    ground: f64,
    /// Tone of the ink.
    ink: f64,
    /// How much darker the sheet is in the corner furthest from the light, share.
    shade: f64,
    /// Standard deviation of the grain, tones.
    grain: f64,
    /// Colours of the tones 0, [`SHADED`] and 255 where they are not greys.
    colours: Option<[[u8; 3]; 3]>,
}

/// Tone of a sheet in the shade: from here up the palette is bare sheet, from here down ink runs into it.
const SHADED: u16 = 205;

/// Seed of the grain.
const SEED: u64 = 1;

impl Sheet {
    /// Black on white, nothing else.
    pub(crate) const WHITE: Sheet = Sheet { ground: 255.0, ink: 0.0, shade: 0.0, grain: 0.0, colours: None };

    /// Blue-black ink on warm paper in the light of a window at the top left.
    pub(crate) const PAPER: Sheet = Sheet {
        ground: 250.0,
        ink: 8.0,
        shade: 0.12,
        grain: 1.1,
        colours: Some([[19, 27, 58], [212, 208, 197], [255, 252, 242]]),
    };

    /// Chalk on a dark board.
    pub(crate) const BOARD: Sheet = Sheet { ground: 35.0, ink: 235.0, shade: 0.0, grain: 0.0, colours: None };

    /// A plain painted wall, evenly enough lit, seen by a plain camera.
    pub(crate) const WALL: Sheet = Sheet { ground: 226.0, ink: 26.0, shade: 0.07, grain: 1.2, colours: None };

    /// The inked sheet as a PNG file: 8 bits a pixel, grey or with a palette.
    pub(crate) fn png(&self, ink: &Canvas) -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, ink.size[0] as u32, ink.size[1] as u32);
        encoder.set_compression(png::Compression::High);
        encoder.set_color(png::ColorType::Grayscale);
        if let Some(ends) = self.colours {
            encoder.set_color(png::ColorType::Indexed);
            encoder.set_palette(palette(ends));
        }
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.tones(ink))?;
        writer.finish()?;
        Ok(bytes)
    }

    fn tones(&self, canvas: &Canvas) -> Vec<u8> {
        let width = canvas.size[0];
        let inked = canvas.coverage.iter().enumerate();
        inked.map(|(i, &share)| self.tone(canvas.size, i % width, i / width, share)).collect()
    }

    fn tone(&self, size: [usize; 2], u: usize, v: usize, inked: f64) -> u8 {
        let away = hypot(u as f64 / size[0] as f64, v as f64 / size[1] as f64) / 2_f64.sqrt();
        let light = 1.0 - self.shade * away * away * (3.0 - 2.0 * away);
        let tone = self.ground + (self.ink - self.ground) * inked.min(1.0);
        (tone * light + self.grain * grain(u, v, SEED)).round().clamp(0.0, 255.0) as u8
    }
}

/// A colour for each of the 256 tones. The shaded colour is as light as an even ramp has it there, so that tones
/// stay in proportion to lightness; it only keeps the sheet's warmth.
fn palette([ink, shaded, bare]: [[u8; 3]; 3]) -> Vec<u8> {
    let up = (0..SHADED).map(|tone| (ink, shaded, f64::from(tone) / f64::from(SHADED)));
    let on = (SHADED..256).map(|tone| (shaded, bare, f64::from(tone - SHADED) / f64::from(255 - SHADED)));
    up.chain(on).flat_map(|(from, to, share)| [0, 1, 2].map(|k| between(from[k], to[k], share))).collect()
}

fn between(from: u8, to: u8, share: f64) -> u8 {
    (f64::from(from) + (f64::from(to) - f64::from(from)) * share).round() as u8
}
