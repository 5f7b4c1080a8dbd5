//! `sign.svg`: a sign for a wall, 600 × 360 mm, in three layers; its letters are paths, as "object to path" makes them.

use std::fmt::Write;

/// A letter 100 high and its width, in a frame with y down, from its upper left corner.
struct Letter {
    width: f64,
    path: &'static str,
}

/// C, A, F, É: each a line down the middle of its strokes.
const LETTERS: [Letter; 4] = [
    Letter { width: 78.0, path: "M78 18A50 50 0 1 0 78 82" },
    Letter { width: 80.0, path: "M0 100L40 0L80 100M14 65H66" },
    Letter { width: 60.0, path: "M60 0H0V100M0 48H50" },
    Letter { width: 60.0, path: "M60 0H0V100H60M0 48H50M22 -12L42 -30" },
];
/// From a letter to the next, mm.
const GAP_MM: f64 = 22.0;
/// Upper left corner of the word, mm.
const WORD_MM: (f64, f64) = (126.0, 84.0);

/// The drawing's text.
pub(super) fn svg() -> String {
    let frame = "<rect x=\"10\" y=\"10\" width=\"580\" height=\"340\" rx=\"30\"/>";
    let cup = "<path d=\"M230 220H350C350 280 330 310 290 310S230 280 230 220Z\"/>\
               <path d=\"M349 234C380 226 392 240 384 256S356 278 342 276\"/>\
               <path d=\"M200 322C240 334 340 334 380 322\"/>";
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"\n     \
         width=\"600mm\" height=\"360mm\" viewBox=\"0 0 600 360\" fill=\"none\" stroke-width=\"2\">\n{}{}{}</svg>\n",
        layer("Frame", "#808080", frame),
        layer("Letters", "#c00000", &word()),
        layer("Cup", "#0040c0", cup)
    )
}

fn layer(name: &str, colour: &str, inside: &str) -> String {
    format!(
        "<g inkscape:groupmode=\"layer\" id=\"{}\" inkscape:label=\"{name}\" stroke=\"{colour}\">\n{inside}\n</g>\n",
        name.to_lowercase()
    )
}

fn word() -> String {
    let (mut x, y) = WORD_MM;
    let mut text = String::new();
    for Letter { width, path } in &LETTERS {
        // writing to a string cannot fail
        let _ = write!(text, "<path transform=\"translate({x} {y})\" d=\"{path}\"/>");
        x += width + GAP_MM;
    }
    text
}
