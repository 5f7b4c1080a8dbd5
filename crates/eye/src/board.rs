//! Pages of a board of markers, to be printed.

use std::fmt::Write;

use pdf_writer::{Content, Finish, Name, Pdf, Rect, Ref, Str};
use tracelight_aim::Board;
use tracelight_markers::tag_cells;
use tracelight_maths::powf;
use tracelight_pipeline::Paper;
use tracelight_stroke::Point;

/// Length of the bar by which a print is checked, m.
pub const BAR_M: f64 = 0.150;

/// From the paper's upper edge to the markers, mm: printers leave 5 mm, and white must be about markers.
const TOP_MM: f64 = 13.0;
/// From the paper's lower edge to the bar, mm, and how thick that is.
const BAR_AT_MM: f64 = 14.0;
const BAR_THICK_MM: f64 = 2.0;

/// A rectangle on the page, mm from the upper left.
struct Patch {
    left: f64,
    top: f64,
    width: f64,
    height: f64,
}

/// Rectangles filled at once: where two meet no seam shows.
struct Fill {
    patches: Vec<Patch>,
    black: bool,
}

/// A line of text on the page: where it begins, mm from the upper left, how high its letters are.
struct Label {
    left: f64,
    base: f64,
    size: f64,
    text: String,
}

/// What is on a page.
struct Page {
    paper: Paper,
    fills: Vec<Fill>,
    labels: Vec<Label>,
}

impl Page {
    /// Page number `page` of a board, from 0.
    fn of(board: &Board, page: u16, paper: Paper) -> Self {
        let (mut black, mut white) = (Vec::new(), Vec::new());
        let cell = 1e3 * board.tag_m / 8.0;
        let rows = rows_mm(board);
        for number in 0..board.tags() {
            let corner = board.corners(number)[0];
            let (left, top) = (paper.width_mm / 2.0 + 1e3 * corner.x, TOP_MM + rows / 2.0 - 1e3 * corner.y);
            black.push(Patch { left, top, width: 8.0 * cell, height: 8.0 * cell });
            let Some(cells) = tag_cells(board.id(page, number)) else { continue };
            for (row, cells) in cells.iter().enumerate() {
                let mut column = 0;
                for run in cells.chunk_by(|a, b| a == b) {
                    let (left, top) = (left + column as f64 * cell, top + row as f64 * cell);
                    column += run.len();
                    if !run[0] {
                        white.push(Patch { left, top, width: run.len() as f64 * cell, height: cell });
                    }
                }
            }
        }
        let bar = 1e3 * BAR_M;
        let (left, base) = ((paper.width_mm - bar) / 2.0, paper.height_mm - BAR_AT_MM);
        black.push(Patch { left, top: base - BAR_THICK_MM, width: bar, height: BAR_THICK_MM });
        let label = |base: f64, size: f64, text: String| Label { left, base, size, text };
        let labels = vec![
            label(
                base - BAR_THICK_MM - 2.0,
                3.6,
                format!("Tracelight, page {} of {}", page + 1, board.pages),
            ),
            label(
                base + 4.4,
                3.0,
                format!(
                    "This bar is {bar:.0} mm long. Print at 100 %, measure it, and stick the page flat on the wall."
                ),
            ),
        ];
        // white on black: black cells that meet are one
        let fills = vec![Fill { patches: black, black: true }, Fill { patches: white, black: false }];
        Self { paper, fills, labels }
    }
}

/// A page as SVG, in true millimetres.
#[must_use]
pub fn page_svg(board: &Board, page: u16, paper: Paper) -> String {
    let page = Page::of(board, page, paper);
    let Paper { width_mm, height_mm } = paper;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width_mm}mm\" height=\"{height_mm}mm\" viewBox=\"0 0 {width_mm} {height_mm}\" \
         font-family=\"Helvetica, Arial, sans-serif\">\n<rect width=\"{width_mm}\" height=\"{height_mm}\" fill=\"white\"/>\n"
    );
    for Fill { patches, black } in &page.fills {
        let mut path = String::new();
        for Patch { left, top, width, height } in patches {
            _ = write!(path, "M{left:.3} {top:.3}h{width:.3}v{height:.3}h-{width:.3}z");
        }
        let fill = if *black { "black" } else { "white" };
        _ = writeln!(svg, "<path d=\"{path}\" fill=\"{fill}\"/>");
    }
    for Label { left, base, size, text } in &page.labels {
        _ = writeln!(svg, "<text x=\"{left:.2}\" y=\"{base:.2}\" font-size=\"{size}\">{text}</text>");
    }
    svg + "</svg>\n"
}

/// A page as grey levels, pixels of `pixel_m` a side: how many there are in a row, row by row from the upper left, and where the middle of
/// its markers is, px. Text is left out.
#[must_use]
pub fn page_raster(board: &Board, page: u16, paper: Paper, pixel_m: f64) -> (usize, Vec<u8>, Point) {
    /// Light that paper and ink throw back, shares.
    const PAPER: f64 = 0.9;
    const INK: f64 = 0.05;
    let page = Page::of(board, page, paper);
    let pixel_mm = 1e3 * pixel_m;
    let count = |mm: f64| (mm / pixel_mm).round() as usize;
    let (width, height) = (count(paper.width_mm), count(paper.height_mm));
    let mut ink = vec![0.0_f64; width * height];
    for Fill { patches, black } in &page.fills {
        for patch in patches {
            // how much of each row and each column it covers
            let covers = |from_mm: f64, length_mm: f64, n: usize| {
                let (from, to) = (from_mm / pixel_mm, (from_mm + length_mm) / pixel_mm);
                let cells = (from.max(0.0) as usize)..(to.ceil().max(0.0) as usize).min(n);
                cells.map(move |i| (i, (to.min(i as f64 + 1.0) - from.max(i as f64)).max(0.0)))
            };
            for (y, down) in covers(patch.top, patch.height, height) {
                for (x, across) in covers(patch.left, patch.width, width) {
                    ink[y * width + x] += if *black { across * down } else { -across * down };
                }
            }
        }
    }
    let level = |ink: f64| {
        let light = PAPER + (INK - PAPER) * ink.clamp(0.0, 1.0);
        (255.0 * powf(light, 1.0 / 2.2)).round() as u8
    };
    let middle = Point::new(paper.width_mm / 2.0 / pixel_mm, (TOP_MM + rows_mm(board) / 2.0) / pixel_mm);
    (width, ink.into_iter().map(level).collect(), middle)
}

/// How far paper reaches from the middle of a board's markers, m: left and right, below and above; on the largest of several papers.
#[must_use]
pub fn printed_m(board: &Board, papers: &[Paper]) -> ([f64; 2], [f64; 2]) {
    let largest = |of: fn(&Paper) -> f64| papers.iter().map(of).fold(0.0, f64::max);
    let half_mm = 0.5 * largest(|paper| paper.width_mm);
    let above_mm = TOP_MM + 0.5 * rows_mm(board);
    let below_mm = largest(|paper| paper.height_mm) - above_mm;
    ([-1e-3 * half_mm, 1e-3 * half_mm], [-1e-3 * below_mm, 1e-3 * above_mm])
}

/// From the upper edge of a board's markers to the lower, mm.
fn rows_mm(board: &Board) -> f64 {
    1e3 * (f64::from(board.rows - 1) * board.pitch_m + board.tag_m)
}

/// Points of a printer a millimetre.
const POINTS: f64 = 72.0 / 25.4;

/// Pages as one PDF.
#[must_use]
pub fn page_pdf(board: &Board, pages: &[u16], paper: Paper) -> Vec<u8> {
    let mut pdf = Pdf::new();
    let mut last = 0;
    let mut fresh = || {
        last += 1;
        Ref::new(last)
    };
    let (catalogue, tree, font) = (fresh(), fresh(), fresh());
    let ids: Vec<(Ref, Ref)> = pages.iter().map(|_| (fresh(), fresh())).collect();
    pdf.catalog(catalogue).pages(tree);
    pdf.pages(tree).kids(ids.iter().map(|id| id.0)).count(pages.len() as i32);
    pdf.type1_font(font).base_font(Name(b"Helvetica"));
    for (&number, &(id, content)) in pages.iter().zip(&ids) {
        let drawn = Page::of(board, number, paper);
        let (width, height) = ((POINTS * paper.width_mm) as f32, (POINTS * paper.height_mm) as f32);
        let mut page = pdf.page(id);
        page.media_box(Rect::new(0.0, 0.0, width, height)).parent(tree).contents(content);
        page.resources().fonts().pair(Name(b"F1"), font);
        page.finish();
        pdf.stream(content, &contents(&drawn));
    }
    pdf.finish()
}

/// The commands that draw a page; PDF counts from the lower left.
fn contents(page: &Page) -> Vec<u8> {
    let mut content = Content::new();
    let point = |mm: f64| (POINTS * mm) as f32;
    let up = |mm: f64| point(page.paper.height_mm - mm);
    for Fill { patches, black } in &page.fills {
        content.set_fill_gray(if *black { 0.0 } else { 1.0 });
        for Patch { left, top, width, height } in patches {
            content.rect(point(*left), up(top + height), point(*width), point(*height));
        }
        content.fill_nonzero();
    }
    content.set_fill_gray(0.0);
    for Label { left, base, size, text } in &page.labels {
        content.begin_text().set_font(Name(b"F1"), point(*size)).next_line(point(*left), up(*base));
        content.show(Str(text.as_bytes())).end_text();
    }
    content.finish().into_vec()
}
