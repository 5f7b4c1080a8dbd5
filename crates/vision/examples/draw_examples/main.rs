//! Draws the pictures of `examples/` and writes down exactly what it drew.
//!
//! ```text
//! cargo run --release -p tracelight-vision --example draw_examples -- examples
//! ```
//!
//! Each picture is strokes first; pixels and truth both come from those strokes, so that a tracer can be scored
//! against what the pen did and not against what another program saw. Equal code, equal bytes.

mod boat;
mod canvas;
mod cat;
mod figures;
mod grain;
mod hello;
mod house;
mod pen;
mod ruler;
mod sheet;
mod spline;
mod truth;

use std::{error::Error, fs, path::Path};

use canvas::Canvas;
use sheet::Sheet;
use tracelight_stroke::Drawing;

/// Size of a picture, pixels.
const SIZE: [usize; 2] = [640, 480];

/// Chords of a flattened curve stay this close to it, pixels: both in the picture and in the truth.
const TOLERANCE_PX: f64 = 0.01;

/// What is drawn, on what.
struct Picture {
    name: &'static str,
    drawing: Drawing,
    sheet: Sheet,
}

fn pictures() -> [Picture; 6] {
    [
        Picture { name: "star", drawing: figures::star(), sheet: Sheet::WHITE },
        Picture { name: "shapes", drawing: figures::shapes(), sheet: Sheet::WHITE },
        Picture { name: "house", drawing: house::house(), sheet: Sheet::PAPER },
        Picture { name: "silhouette", drawing: cat::cat(), sheet: Sheet::WHITE },
        Picture { name: "handwriting", drawing: hello::hello(), sheet: Sheet::WHITE },
        Picture { name: "chalk", drawing: boat::boat(), sheet: Sheet::BOARD },
    ]
}

/// A file's path below `examples/`, and its bytes.
pub(crate) type Example = (String, Vec<u8>);

/// All files that this program makes.
pub(crate) fn files() -> Result<Vec<Example>, Box<dyn Error>> {
    let mut files = Vec::new();
    for picture in pictures() {
        let coverage = Canvas::inked(SIZE, &picture.drawing);
        let truth = truth::of_drawing(SIZE, &picture.drawing);
        files.extend(pair(picture.name, picture.sheet.png(&coverage)?, truth));
    }
    for ruler in ruler::RULERS {
        files.extend(pair(ruler.name, ruler.png()?, truth::of_marks(ruler.marks())));
    }
    Ok(files)
}

/// A picture and its truth.
fn pair(name: &str, png: Vec<u8>, truth: String) -> [Example; 2] {
    [(format!("{name}.png"), png), (format!("truth/{name}.json"), truth.into_bytes())]
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder =
        std::env::args_os().nth(1).ok_or("name the folder for the pictures, for example `examples`")?;
    let folder = Path::new(&folder);
    fs::create_dir_all(folder.join("truth"))?;
    for (name, bytes) in files()? {
        fs::write(folder.join(name), bytes)?;
    }
    Ok(())
}
