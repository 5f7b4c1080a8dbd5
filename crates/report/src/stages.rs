//! What a picture is on its way to strokes, as one SVG: grey, evened out, its histogram with the threshold, ink.

use std::fmt::Write;
use std::io::Cursor;

use image::{GrayImage, ImageFormat};
use tracelight_chart::{Colour, Curve, Figure, Panel, Pen, Theme, dark_style};
use tracelight_image::Grey;
use tracelight_maths::log10;
use tracelight_task::Failure;
use tracelight_vision::Stages;

use crate::page::html::{data_uri, escaped};

/// Width of a panel and of what is between, px.
const PANEL: f64 = 520.0;
const GAP: f64 = 40.0;
/// Room for a title.
const TITLE: f64 = 26.0;

/// The figure.
///
/// # Errors
/// A figure that cannot be drawn, which is a mistake of the program.
pub fn figure(name: &str, grey: &Grey, stages: &Stages) -> Result<String, Failure> {
    let evened: Vec<u8> = stages.darkness.iter().map(|level| 255 - level).collect();
    let ink: Vec<u8> = stages.ink.iter().map(|&ink| if ink { 0 } else { 255 }).collect();
    let size = (stages.width, stages.height);
    let pictures = [
        ("grey, as read", png((grey.width(), grey.height()), grey.levels())?),
        ("light and paper evened out", png(size, &evened)?),
        ("ink", png(size, &ink)?),
    ];
    let high = PANEL * grey.height() as f64 / grey.width() as f64;
    // a very tall picture is shown smaller
    let (wide, high) =
        if high > 2.0 * PANEL { (PANEL * 2.0 * PANEL / high, 2.0 * PANEL) } else { (PANEL, high) };
    let row = TITLE + high.max(0.55 * PANEL) + GAP;
    let (width, height) = (2.0 * PANEL + 3.0 * GAP, 2.0 * row + 2.0 * GAP);
    let (ground, ink, soft) = (Theme::Light.ground(), Theme::Light.ink(), Theme::Light.soft());
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" viewBox=\"0 0 {width:.0} {height:.0}\" \
         font-family=\"sans-serif\" role=\"img\">\n\
         <title>{name}: from grey to ink</title>\n\
         <desc>The picture as grey levels, with light and paper evened out, the histogram of its darkness, and its ink.</desc>\n<rect width=\"100%\" height=\"100%\" fill=\"{ground}\"/>\n\
         <text x=\"{GAP}\" y=\"{GAP}\" font-size=\"18\" fill=\"{ink}\">{name}: from grey to ink</text>\n",
        name = escaped(name)
    );
    let place =
        |number: usize| (GAP + (PANEL + GAP) * (number % 2) as f64, 1.6 * GAP + row * (number / 2) as f64);
    for ((title, png), number) in pictures.iter().zip([0, 1, 3]) {
        let (x, y) = place(number);
        let top = y + TITLE;
        // writing to a String cannot fail
        let _ = write!(
            svg,
            "<text x=\"{x:.1}\" y=\"{:.1}\" font-size=\"14\" fill=\"{ink}\">{title}</text>\n\
             <image x=\"{x:.1}\" y=\"{top:.1}\" width=\"{wide:.1}\" height=\"{high:.1}\" href=\"{png}\"/>\n\
             <rect x=\"{x:.1}\" y=\"{top:.1}\" width=\"{wide:.1}\" height=\"{high:.1}\" fill=\"none\" stroke=\"{soft}\"/>\n",
            y + 0.6 * TITLE
        );
    }
    let (x, y) = place(2);
    let histogram = histogram(stages)?;
    let nested = histogram.replacen("<svg ", &format!("<svg x=\"{:.1}\" y=\"{:.1}\" ", x - 0.25 * GAP, y), 1);
    let _ = write!(svg, "{nested}\n</svg>\n");
    let style = dark_style(&svg);
    Ok(svg.replacen("</desc>\n", &format!("</desc>\n{style}\n"), 1))
}

/// Grey levels as a PNG in a link.
fn png((width, height): (usize, usize), levels: &[u8]) -> Result<String, Failure> {
    let internal = || Failure::failed("internal", "a picture's size is not that of its levels");
    let picture = GrayImage::from_raw(width as u32, height as u32, levels.to_vec()).ok_or_else(internal)?;
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, ImageFormat::Png).map_err(|e| Failure::failed("internal", e))?;
    Ok(data_uri("image/png", &bytes.into_inner()))
}

/// How many pixels are how dark, in powers of ten, and from where on they are ink.
fn histogram(stages: &Stages) -> Result<String, Failure> {
    let counts = stages.histogram();
    let high = |count: usize| log10(1.0 + count as f64);
    let steps = counts
        .iter()
        .enumerate()
        .flat_map(|(level, &count)| [(level as f64 - 0.5, high(count)), (level as f64 + 0.5, high(count))]);
    let most = counts.iter().map(|&count| high(count)).fold(0.0, f64::max);
    let threshold = f64::from(stages.threshold) + 0.5;
    let figure = Figure {
        title: format!("darkness; ink from {} on", u32::from(stages.threshold) + 1),
        legend: Vec::new(),
        panels: vec![Panel {
            x_title: "0: paper, 255: total darkness".into(),
            y_title: "pixels, powers of ten".into(),
            curves: vec![
                Curve { colour: Colour::Violet, pen: Pen::Solid, points: steps.collect() },
                Curve {
                    colour: Colour::Limit,
                    pen: Pen::Dashed,
                    points: vec![(threshold, 0.0), (threshold, most)],
                },
            ],
            ..Panel::default()
        }],
        columns: 1,
        panel: (PANEL as i32, (0.5 * PANEL) as i32),
        theme: Theme::Light,
    };
    figure.svg().map_err(|e| Failure::failed("internal", e))
}
