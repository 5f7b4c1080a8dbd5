//! A figure as PNG.

use std::sync::Arc;

use resvg::{tiny_skia, usvg};

/// Pixels of a PNG for one of the SVG's: 144 to the inch.
const SCALE: f32 = 1.5;

/// An SVG of ours as a PNG. Its letters are DejaVu Sans, whatever fonts there are.
///
/// # Errors
/// Where it is no SVG, or has no pixels.
pub fn pixels(svg: &str) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_source(usvg::fontdb::Source::Binary(Arc::new(dejavu::sans::regular())));
    fonts.set_sans_serif_family("DejaVu Sans");
    let options = usvg::Options { fontdb: Arc::new(fonts), ..usvg::Options::default() };
    let tree = usvg::Tree::from_str(svg, &options)?;
    let size = tree.size().to_int_size().scale_by(SCALE).ok_or("a plot without pixels")?;
    let mut map = tiny_skia::Pixmap::new(size.width(), size.height()).ok_or("a plot without pixels")?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(SCALE, SCALE), &mut map.as_mut());
    // the ground covers all: what is see-through is nowhere
    let colours: Vec<u8> = map.pixels().iter().flat_map(|p| [p.red(), p.green(), p.blue()]).collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size.width(), size.height());
    encoder.set_color(png::ColorType::Rgb);
    // half the time of the best, and 1.3 times its bytes
    encoder.set_compression(png::Compression::Fast);
    let per_m = (SCALE * 96.0 / 0.0254) as u32;
    encoder.set_pixel_dims(Some(png::PixelDimensions { xppu: per_m, yppu: per_m, unit: png::Unit::Meter }));
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&colours)?;
    writer.finish()?;
    Ok(bytes)
}
