//! From a source to strokes on their sheet.

use tracelight_formats::{Coordinates, Reading};
use tracelight_picture::{Pixels, Raster, Source};
use tracelight_stroke::{Drawing, Place, Point, without_doubles};
use tracelight_task::{Failure, counted};
use tracelight_vision::{Comb, Dots, Quality, Traced, VisionError};

use crate::choice::Choice;
use crate::sheet::{self, PaperSeen};
use crate::tracing::Tracing;
use crate::twice;

/// Strokes on the sheet they came from.
#[derive(Clone, Debug)]
pub struct Sketch {
    /// In the sheet's unit, x right, y down.
    pub drawing: Drawing,
    /// The sheet's size in that unit.
    pub size: (f64, f64),
    /// The sheet of paper in the picture, where there is something beside it.
    pub paper: Option<PaperSeen>,
    /// The sheet's true width, m, where the file says it.
    pub true_width_m: Option<f64>,
    /// In which coordinates people say where a place of the sheet is.
    pub coordinates: Coordinates,
    /// Nobody says what its file's unit is: it was taken for the millimetre.
    pub unit_guessed: bool,
    /// Closed paths that light keeps out of.
    pub no_go: Drawing,
    /// Points and places of blocks that the file has.
    pub places: Vec<Place>,
    /// The picture as it was read, for display: see [`Self::shown`].
    pub picture: Option<Raster>,
    /// How it was traced.
    pub mode: &'static str,
    /// What the user should know about it: one sentence each.
    pub remarks: Vec<String>,
    /// What its pixels are worth; none of a drawing.
    pub quality: Option<Quality>,
    /// Share of the ink that lies on no stroke; none where there was no ink.
    pub missed_ink: Option<f64>,
}

impl Sketch {
    /// The strokes in the picture's pixels, x right, y down, and its size.
    #[must_use]
    pub fn in_picture(&self) -> (&Drawing, (f64, f64)) {
        match &self.paper {
            Some(PaperSeen { picture_px, slanted: Some(slanted), .. }) => (slanted, *picture_px),
            _ => (&self.drawing, self.size),
        }
    }

    /// Where on the sheet a pixel of the picture is.
    pub(crate) fn straightened(&self, pixel: Point) -> Option<Point> {
        match self.paper.as_ref().and_then(|paper| paper.straight.as_ref()) {
            Some(straight) => straight.on_sheet(pixel),
            None => Some(pixel),
        }
    }

    /// Where in the picture a place of the sheet is, px.
    pub(crate) fn in_photograph(&self, at: Point) -> Option<Point> {
        match self.paper.as_ref().and_then(|paper| paper.straight.as_ref()) {
            Some(straight) => straight.in_picture(at),
            None => Some(at),
        }
    }

    /// Takes the strokes from the picture to its sheet seen from straight ahead.
    fn lay_square(&mut self) {
        if let Some(PaperSeen { straight: Some(straight), slanted, .. }) = &mut self.paper {
            let drawing = straight.drawing(&self.drawing);
            *slanted = Some(std::mem::replace(&mut self.drawing, drawing));
        }
    }

    /// Leaves out what lies on earlier lines, and says so.
    fn draw_once(&mut self) {
        let (drawing, doubles) = without_doubles(std::mem::take(&mut self.drawing));
        self.drawing = drawing;
        let metres_per_unit = self.true_width_m.map(|width_m| width_m / self.size.0);
        self.remarks.extend(twice::remarks(&doubles, metres_per_unit));
    }

    /// With the picture as its strokes lie on it: of a sheet that is laid square, from straight ahead. That takes longer than all else,
    /// so that only who shows the picture asks for it.
    #[must_use]
    pub fn shown(mut self) -> Self {
        let straight = self.paper.as_ref().and_then(|paper| paper.straight.as_ref());
        if let (Some(straight), Some(picture)) = (straight, &self.picture) {
            self.picture = Some(straight.picture(picture));
        }
        self
    }

    /// All that the user should know of it.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let weak = self.quality.iter().flat_map(Quality::remarks);
        self.remarks
            .iter()
            .cloned()
            .chain(weak.map(|remark| format!("the picture is usable: {remark}")))
            .collect()
    }
}

/// Share of the ink that may be missed without a word: what blots at junctions and ends make of a clean drawing.
const MISSED_SILENTLY: f64 = 0.01;

/// Shorter ways over paper that were cut are not spoken of, px: a corner cut off between two hairs.
const CUT_SILENTLY_PX: f64 = 8.0;

/// Less of a pencil's lines that was drawn again is not spoken of, px.
const AGAIN_SILENTLY_PX: f64 = 8.0;

/// Of strokes of both kinds less than this share of the length as outlines is not spoken of.
const OUTLINED_SILENTLY: f64 = 0.05;

/// What of a picture is in no stroke, or drawn round its edge, and what to do about it.
fn doubts(traced: &Traced) -> Vec<String> {
    let Traced { missed_ink, left_out, rules, .. } = traced;
    let missed = (*missed_ink > MISSED_SILENTLY).then(|| {
        format!(
            "{:.1} % of the ink of its lines lies on no stroke, where lines run together or are of uneven width: \
             compare the strokes with the picture (-o FILE.svg)",
            100.0 * missed_ink
        )
    });
    let specks = (left_out.specks > 0).then(|| {
        format!(
            "{} of up to {} px² {} taken for dust: --despeckle 0 keeps them",
            counted(left_out.specks, "speck"),
            left_out.largest_speck_px2,
            if left_out.specks == 1 { "was" } else { "were" }
        )
    });
    let cut = (left_out.over_paper_px > CUT_SILENTLY_PX)
        .then(|| format!("{:.0} px of strokes led over paper and were cut out", left_out.over_paper_px));
    let again = (left_out.again_px > AGAIN_SILENTLY_PX).then(|| {
        format!(
            "{:.0} px of the lines were drawn again beside them, in pencil, and are one with them: --despeckle 0 keeps \
             each",
            left_out.again_px
        )
    });
    let edges = (left_out.edges > 0)
        .then(|| format!("{} of paper or of a shadow left out", counted(left_out.edges, "edge")));
    let areas = (left_out.areas > 0).then(|| {
        let are = if left_out.areas == 1 { "that was coloured in is" } else { "that were coloured in are" };
        format!("{} {are} drawn by the lines about them alone", counted(left_out.areas, "area"))
    });
    let ruled = rules.iter().flat_map(|rules| &rules.combs).map(ruled);
    let dotted = left_out.dots.map(|Dots { count, spacing_px }| {
        format!(
            "{count} dots of the paper, {spacing_px:.0} px apart, were left out: --despeckle 0 keeps them"
        )
    });
    ruled
        .chain(dotted)
        .chain(missed)
        .chain(outlined(&traced.strokes))
        .chain(specks)
        .chain(cut)
        .chain(again)
        .chain(edges)
        .chain(areas)
        .collect()
}

/// That a comb of rules was taken out.
fn ruled(comb: &Comb) -> String {
    let way = if comb.upright { "upright" } else { "level" };
    format!("{} {way} rules of the paper, {:.0} px apart, were left out", comb.count, comb.spacing_px)
}

/// How much of a drawing of lines is drawn round its edge.
fn outlined(drawing: &Drawing) -> Option<String> {
    let share = drawing.outlined(CHORDS_PX);
    (OUTLINED_SILENTLY..1.0).contains(&share).then(|| {
        format!(
            "{:.0} % of the light goes round filled shapes: --mode centreline draws their middle instead",
            100.0 * share
        )
    })
}

/// Chords that measure a share of the light stay this close to their path, px.
const CHORDS_PX: f64 = 0.1;

/// Traces pixels, takes strokes as they are; of these, the chosen ones that are long enough, each line of a drawing once. `metres_per_unit` says how long the unit of
/// a sheet is on the target, by its size and its true width, such as [`Placing::metres_per_unit`](crate::Placing::metres_per_unit).
///
/// # Errors
/// Why there are no strokes in it: it is no drawing, an option leaves nothing, or no stroke is what was chosen.
pub fn sketch_at(
    name: &str,
    source: Source,
    tracing: &Tracing,
    choice: &Choice,
    metres_per_unit: &dyn Fn((f64, f64), Option<f64>) -> f64,
) -> Result<Sketch, Failure> {
    let is_drawing = matches!(source, Source::Strokes(Reading { is_list: false, .. }));
    let mut sketch = match source {
        Source::Strokes(reading) => taken(reading),
        Source::Pixels(pixels) => traced(name, pixels, tracing, metres_per_unit)?,
    };
    (sketch.drawing, sketch.no_go) = choice.of(name, sketch.drawing, &sketch.places)?;
    sketch.places.retain(|place| choice.takes_place(place));
    // after the choice: a line that two layers have is needed where only one of them is drawn
    if is_drawing {
        sketch.draw_once();
    }
    sketch.lay_square();
    let refused = |why: &str| Err(Failure::failed("no-strokes-found", format!("{name}: {why}")));
    if choice.places && !sketch.places.is_empty() && sketch.drawing.strokes.is_empty() {
        return Ok(sketch);
    }
    if sketch.drawing.strokes.is_empty() {
        return refused("it has no strokes; give a picture with at least one line");
    }
    let least = tracing.min_length.in_units(metres_per_unit(sketch.size, sketch.true_width_m));
    if least > 0.0 {
        // a thousandth of the length asked for is as good as all of it
        sketch.drawing.strokes.retain(|stroke| stroke.path.length(1e-3 * least) >= least);
    }
    if sketch.drawing.strokes.is_empty() {
        return refused("all its strokes are shorter than --min-length; set it lower");
    }
    Ok(sketch)
}

/// Strokes as they are.
fn taken(Reading { sheet, remarks, unit_guessed, .. }: Reading) -> Sketch {
    Sketch {
        unit_guessed,
        size: (sheet.width, sheet.height),
        true_width_m: sheet.metres_per_unit.map(|m| m * sheet.width),
        drawing: sheet.drawing,
        coordinates: sheet.coordinates,
        no_go: Drawing::default(),
        places: sheet.places,
        paper: None,
        picture: None,
        mode: "strokes",
        remarks,
        quality: None,
        missed_ink: None,
    }
}

/// Pixels traced, where they are in the picture; the size is that of the sheet laid square, where it is.
fn traced(
    name: &str,
    Pixels { colour, grey }: Pixels,
    tracing: &Tracing,
    metres_per_unit: &dyn Fn((f64, f64), Option<f64>) -> f64,
) -> Result<Sketch, Failure> {
    let picture_px = (f64::from(colour.width()), f64::from(colour.height()));
    let page = sheet::page(name, &grey, tracing)?;
    let straight = sheet::straight(name, &page, tracing)?;
    let size = straight.as_ref().map_or(picture_px, |straight| straight.size_px);
    let true_width_m = match &straight {
        Some(straight) => straight.width_m,
        None => tracing.paper.map(|paper| paper.lying_m(size.0 / size.1).0),
    };
    let options = tracing.options(metres_per_unit(size, true_width_m));
    let refused = |e: VisionError| match e {
        VisionError::Option { .. } => Failure::usage("usage", format!("{name}: {e}")),
        _ => Failure::failed("no-strokes-found", format!("{name}: {e}")),
    };
    let traced = tracelight_vision::trace_page(&page, &options).map_err(refused)?;
    let laid = page.sheet.as_ref().map(|sheet| sheet::remark(sheet, straight.as_ref()));
    let remarks = laid.into_iter().chain(doubts(&traced)).collect();
    Ok(Sketch {
        size,
        true_width_m,
        unit_guessed: false,
        coordinates: Coordinates::Page { unit_m: true_width_m.map(|m| m / size.0) },
        no_go: Drawing::default(),
        places: Vec::new(),
        remarks,
        drawing: traced.strokes,
        paper: page.sheet.map(|sheet| PaperSeen { sheet, picture_px, straight, slanted: None }),
        picture: Some(colour),
        mode: options.mode.name(),
        quality: Some(traced.quality),
        missed_ink: Some(traced.missed_ink),
    })
}
