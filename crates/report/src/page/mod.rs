//! `report.html`: the whole job on one page that needs nothing but itself.
//!
//! No request leaves the page (its own policy forbids it); the script only looks closer, plays, and darkens the wall. Everything that came from
//! outside, names above all, is escaped.

mod axis;
mod cells;
mod curve;
mod diagrams;
pub mod html;
mod map;
mod plot;
mod seen;
mod strokes;
mod tables;

use std::fmt::Write;

use tracelight_picture::Raster;

use self::html::{escaped, jpeg_uri};
use crate::error::EncodeError;
use crate::finished::Finished;
use crate::origin::words;
use crate::sample::samples;
use crate::summary::Summary;

/// The page, with the light-painting on it.
///
/// # Errors
/// Where a picture on it cannot be encoded.
pub fn page(job: &Finished<'_>, figures: &Summary, painting: &Raster) -> Result<String, EncodeError> {
    const PAINTING_PX: u32 = 1400;
    const QUALITY: u8 = 84;
    let jpeg = jpeg_uri(painting, (PAINTING_PX, QUALITY), "report.html")?;
    let (class, verdict) = tables::verdict(job);
    let words = words(job.origin.light_from);
    Ok(format!(
        include_str!("page.html"),
        style = tracelight_chart::page_colours() + include_str!("style.css"),
        script = include_str!("run.js"),
        track = track(job),
        title = escaped(&job.title()),
        subtitle = tables::subtitle(job),
        class = class,
        verdict = escaped(&verdict),
        origin = tables::origin(job),
        painting = jpeg,
        painting_width = painting.width(),
        painting_height = painting.height(),
        tiles = tables::tiles(job, figures),
        happenings = tables::happenings(job),
        map = map::map(job)?,
        seen = seen::section(job)?,
        diagrams = diagrams::diagrams(job),
        schedule = diagrams::schedule(job),
        figures = tables::figures(job, figures),
        settings = tables::settings(job),
        strokes = strokes::section(job),
        by = words.by,
        spot = words.spot,
        version = env!("CARGO_PKG_VERSION"),
    ))
}

/// Where the spot was, thinned, for the cursor: `[[t_s, x_mm, y_mm, error_mm, lit], …]`, and the map's frame.
fn track(job: &Finished<'_>) -> String {
    const MOST: usize = 4000;
    let every = job.run.ticks.len().div_ceil(MOST).max(1);
    let mut rows = String::new();
    for sample in samples(job.plan, job.run).step_by(every) {
        let Some(spot) = sample.tick.spot.filter(|p| p.is_finite()) else { continue };
        let comma = if rows.is_empty() { "" } else { "," };
        let error = sample.error_mm().filter(|e| e.is_finite()).unwrap_or(0.0);
        let _ = write!(
            rows,
            "{comma}[{:.3},{:.1},{:.1},{error:.3},{}]",
            sample.t_s,
            spot.x * 1e3,
            spot.y * 1e3,
            u8::from(sample.tick.light)
        );
    }
    let [a, _, _, d, e, f] = map::frame(job).as_coeffs();
    format!("const track=[{rows}],frame=[{},{},{e},{f}];", a / 1e3, d / 1e3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{fixture, painting};
    use tracelight_sim::{LightFrom, Origin};

    fn text(job: &Finished<'_>) -> String {
        page(job, &Summary::new(job), &painting::paint(job)).unwrap()
    }

    #[test]
    fn the_page_asks_nobody_for_anything() {
        let fixture = fixture::star();
        let text = text(&fixture.job());
        for outside in ["http://", "https://", "src=\"//", "url(", "@import", "<link"] {
            assert!(!text.contains(outside), "{outside}");
        }
        assert!(text.contains("default-src 'none'"));
        assert!(text.len() < 3_000_000, "{}", text.len());
    }

    #[test]
    fn names_from_outside_are_text_not_markup() {
        let fixture = fixture::star();
        let text = text(&fixture.job());
        assert!(!text.contains("<script>alert"));
        assert!(text.contains("star &lt;&amp;&gt; &quot;friends&quot;.png"));
    }

    #[test]
    fn every_diagram_is_there_with_its_unit() {
        let fixture = fixture::star();
        let text = text(&fixture.job());
        for words in [
            "Where the light fell",
            "Pan angle",
            "Tilt angle",
            "angle, °",
            "Tracking error",
            "planned place, mm",
            "Pan torque",
            "Tilt torque",
            "share of the limit, %",
            "Time plan and speed",
            "Quality of the picture",
            "edges are blurred over 1.51 pen widths",
            "m/s",
        ] {
            assert!(text.contains(words), "{words}");
        }
    }

    #[test]
    fn the_page_says_who_tells_where_the_spot_was() {
        let fixture = fixture::star();
        let mut job = fixture.job();
        let known = text(&job);
        assert!(known.contains(">simulated</span>") && known.contains("tracking error: true spot against"));
        job.origin = Origin { simulated: false, light_from: LightFrom::Encoders };
        let believed = text(&job);
        for words in [
            ">by its encoders</span>",
            "tracking error, rms, by the encoders",
            "<caption>Tracking, by the encoders</caption>",
            "Where the encoders had the spot while lit",
            "the laser's gate was open for",
            "tracking error, by the encoders: where the encoders say that the spot is",
        ] {
            assert!(believed.contains(words) && !known.contains(words), "{words}");
        }
        for words in ["Where the light fell", "light left the head", "true spot", ">simulated"] {
            assert!(!believed.contains(words), "{words}");
        }
    }

    #[test]
    fn a_long_run_stays_a_small_page() {
        let mut fixture = fixture::star();
        for _ in 0..3 {
            let again = fixture.run.ticks.clone();
            fixture.run.ticks.extend(again);
        }
        for (i, tick) in fixture.run.ticks.iter_mut().enumerate() {
            tick.telemetry.tick = i as u32;
        }
        assert!(fixture.run.ticks.len() > 60_000);
        assert!(text(&fixture.job()).len() < 3_000_000);
    }

    #[test]
    fn a_job_that_never_ran_has_a_page() {
        let fixture = fixture::nothing();
        let text = text(&fixture.job());
        assert!(text.contains("not run") && text.contains("Nothing was run"));
    }
}
