use std::fmt::Write;

use tracelight_chart::{STEPS, error_step};
use tracelight_eye::seen::SeenLight;
use tracelight_maths::{log10, powf};

use super::axis::Axis;
use super::html::{escaped, jpeg_uri};
use super::map::{Place, bar, coloured, picture, scale};
use crate::error::EncodeError;
use crate::finished::Finished;

/// What a camera saw while the laser drew, as a section of its own; nothing where none looked.
pub(super) fn section(job: &Finished<'_>) -> Result<String, EncodeError> {
    let Some(seen) = job.seen else { return Ok(String::new()) };
    let mut text = String::from("<section><h2>What the camera saw</h2>");
    if let Some(follow) = job.eye.as_ref().and_then(|eye| eye.follow.as_ref()) {
        let items =
            follow.words().iter().map(|word| format!("<li>{}</li>", escaped(word))).collect::<String>();
        let _ = write!(text, "<ul class=\"notes\">{items}</ul>");
    }
    text += &painting(seen)?;
    if !seen.marks.is_empty() {
        text += &marks(job, seen)?;
    }
    Ok(text + "</section>")
}

fn painting(seen: &SeenLight) -> Result<String, EncodeError> {
    const LONGEST_PX: u32 = 1400;
    const QUALITY: u8 = 84;
    let Some(raster) = &seen.painting else { return Ok(String::new()) };
    Ok(format!(
        "<figure><figcaption><h3>The spot in the camera's images</h3><p class=\"legend\">one piece of light an image, {} of them, on the image in \
         which the figure was found</p></figcaption><img class=\"painting\" src=\"{}\" width=\"{}\" height=\"{}\" alt=\"The wall as the camera saw \
         it, with the spot of every image on it\"></figure>",
        seen.marks.len(),
        jpeg_uri(raster, (LONGEST_PX, QUALITY), "report.html")?,
        raster.width(),
        raster.height(),
    ))
}

/// Where it was seen against where it was asked to be: arrows, many times as long as the errors, coloured by them.
fn marks(job: &Finished<'_>, seen: &SeenLight) -> Result<String, EncodeError> {
    let place = Place::new(job);
    let mut sorted: Vec<f64> = seen.marks.iter().map(|mark| mark.off_mm()).collect();
    sorted.sort_by(f64::total_cmp);
    // a spot that was lost for a moment must not make all others points
    let usual = sorted[(sorted.len() - 1) * 99 / 100];
    let longest = Axis::around([0.0, usual.max(0.01)].into_iter(), 4).high();
    let times = round_times(0.03 * place.width / (longest * 1e-3 * place.units_per_m));
    let mut bins: [String; STEPS] = Default::default();
    for mark in &seen.marks {
        let (from, to) = (place.at(mark.asked), place.at(mark.asked + (mark.seen - mark.asked) * times));
        if !(place.shows(from) && place.shows(to)) {
            continue;
        }
        let _ =
            write!(bins[error_step(mark.off_mm())], "M{:.1} {:.1}L{:.1} {:.1}", from.x, from.y, to.x, to.y);
    }
    let layers = picture(job, &place)? + &coloured(&bins);
    Ok(format!(
        include_str!("seen.html"),
        width = place.width,
        height = place.height,
        layers = layers,
        bar = bar(&place),
        scale = scale("seen from asked"),
        times = times,
        name = escaped(&job.title()),
    ))
}

/// A round number of times, at most what is wanted.
fn round_times(wanted: f64) -> f64 {
    let power = powf(10.0, log10(wanted.max(1.0)).floor());
    let digit = [5.0, 2.0, 1.0].into_iter().find(|digit| digit * power <= wanted).unwrap_or(1.0);
    digit * power
}

#[cfg(test)]
mod tests {
    use tracelight_stroke::{Point, Vec2};

    use super::*;
    use crate::fixture;
    use tracelight_eye::seen::SeenMark;

    #[test]
    fn a_run_nobody_watched_has_no_section_and_a_watched_one_has_its_arrows() {
        let fixture = fixture::star();
        let mut job = fixture.job();
        assert_eq!(section(&job).unwrap(), "");
        let mark = |k: usize| SeenMark {
            time_s: k as f64,
            asked: Point::new(0.01 * k as f64, 0.0),
            seen: Point::new(0.01 * k as f64, 0.0) + Vec2::new(0.0, 2e-4),
        };
        let seen = SeenLight { marks: (0..20).map(mark).collect(), painting: None };
        job.seen = Some(&seen);
        let text = section(&job).unwrap();
        assert!(text.contains("What the camera saw") && text.contains("times as long"));
        let drawn = text.split_once("class=\"trace ").map(|(_, path)| path.matches('L').count());
        assert_eq!(drawn, Some(20));
    }

    #[test]
    fn magnifications_are_round() {
        assert_eq!([0.3, 1.0, 7.2, 49.9, 50.0, 260.0].map(round_times), [1.0, 1.0, 5.0, 20.0, 50.0, 200.0]);
    }
}
