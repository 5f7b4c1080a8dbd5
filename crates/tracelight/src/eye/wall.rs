//! The camera found from markers in sight.

use tracelight_aim::{Board, LensBelief, SeenPlace, SeenTag, Survey, SurveyedCamera, survey};
use tracelight_sim::Simulated;
use tracelight_vision::{Grey, Tag, TagPlace, find_tags};

use super::{Eye, Shot, grey};
use crate::failure::Failure;
use crate::output::Raster;

/// A wall with markers on it as one image shows it.
pub(crate) struct SeenWall {
    pub(crate) survey: Survey,
    pub(crate) camera: SurveyedCamera,
    pub(crate) markers: usize,
    /// The image.
    pub(crate) pixels: Raster,
}

/// Longest that an image is waited for, ticks: the slowest cameras there are send one a second.
const PATIENCE_TICKS: u32 = 3000;
/// Levels between which the brightest hundredth of a well exposed image lies.
const WELL_EXPOSED: [u8; 2] = [190, 245];
/// Share of the pixels that are as bright or less.
const BRIGHTEST: f64 = 0.99;
/// Most images that are taken until one is well exposed.
const MOST_SHOTS: usize = 10;

/// Finds the camera from the markers that an image shows.
pub(crate) fn see_wall(pixels: Raster, lens: Option<&LensBelief>) -> Result<SeenWall, Failure> {
    let tags = markers(&grey(&pixels)?);
    let count = tags.len();
    let size = (pixels.width() as usize, pixels.height() as usize);
    let belief = lens.copied().unwrap_or_else(|| LensBelief::unknown(size.0, size.1));
    if belief.lens.size_px != [size.0, size.1] {
        let message = format!(
            "the camera's image has {} × {} px, the lens that is known {:?}",
            size.0, size.1, belief.lens.size_px
        );
        return Err(Failure::usage("camera-image", message));
    }
    let survey = survey(&belief, &Board::ALL, &[tags])
        .map_err(|e| Failure::failed("camera-not-found", format!("the camera's image of the wall: {e}")))?;
    let camera = survey.camera(0).ok_or_else(|| Failure::failed("internal", "a survey without a camera"))?;
    Ok(SeenWall { survey, camera, markers: count, pixels })
}

/// Markers of an image.
pub(crate) fn markers(grey: &Grey) -> Vec<SeenTag> {
    find_tags(grey).iter().map(seen).collect()
}

/// A marker in cells as one in sides.
fn seen(tag: &Tag) -> SeenTag {
    let place = |place: &TagPlace| SeenPlace {
        on_tag: (place.cell.to_vec2() / 8.0).to_point(),
        upright: place.upright,
        black_behind: place.black_behind,
        at: place.at,
    };
    let places = tag.places.iter().map(place).collect();
    SeenTag { id: tag.id, corners: tag.corners, places, deviation_px: tag.deviation_px }
}

/// The next image whose rows are exposed so long; the head rests in the dark.
pub(crate) fn take<R: Simulated + Eye>(rig: &mut R, exposure_s: f64) -> Result<Shot, Failure> {
    rig.expose(exposure_s);
    for _ in 0..PATIENCE_TICKS {
        rig.step();
        while let Some(shot) = rig.shot() {
            // those taken before it was told are exposed otherwise
            if (shot.exposure_s - exposure_s).abs() <= 0.01 * exposure_s {
                return Ok(shot);
            }
        }
    }
    let waited_s = f64::from(PATIENCE_TICKS) * tracelight_rig::TICK_F64_S;
    Err(Failure::failed(
        "no-image",
        format!("the camera sent no image for {waited_s:.0} s: is it plugged in, and used by nobody else?"),
    ))
}

/// An image that is neither too dark nor too bright; as bright as the camera can, where there is little light.
pub(crate) fn well_exposed<R: Simulated + Eye>(rig: &mut R) -> Result<Raster, Failure> {
    let longest_s = rig.longest_s();
    let mut exposure_s = 0.5 * longest_s;
    for _ in 0..MOST_SHOTS {
        let pixels = take(rig, exposure_s)?.pixels()?;
        let brightest = brightest(&pixels);
        if (WELL_EXPOSED[0]..=WELL_EXPOSED[1]).contains(&brightest)
            || (brightest < WELL_EXPOSED[0] && exposure_s >= longest_s)
        {
            return Ok(pixels);
        }
        let light = |level: u8| (f64::from(level) / 255.0).powf(2.2);
        let wanted = light(WELL_EXPOSED[0] / 2 + WELL_EXPOSED[1] / 2);
        // how much too bright one is that is full, it does not tell
        let factor = if brightest > WELL_EXPOSED[1] { 0.5 } else { wanted / light(brightest.max(1)) };
        exposure_s = (exposure_s * factor.clamp(0.1, 10.0)).min(longest_s);
    }
    let message = format!(
        "of {MOST_SHOTS} images none is well exposed: is a lamp in sight that is switched, or flickers?"
    );
    Err(Failure::failed("no-image", message))
}

/// The level that a hundredth of the pixels exceed.
fn brightest(pixels: &Raster) -> u8 {
    let mut counts = [0_usize; 256];
    for pixel in pixels.rgb().chunks_exact(3) {
        counts[usize::from(pixel[0].max(pixel[1]).max(pixel[2]))] += 1;
    }
    let wanted = BRIGHTEST * f64::from(pixels.width()) * f64::from(pixels.height());
    let mut below = 0;
    for (level, count) in (0..=u8::MAX).zip(counts) {
        below += count;
        if below as f64 >= wanted {
            return level;
        }
    }
    u8::MAX
}
