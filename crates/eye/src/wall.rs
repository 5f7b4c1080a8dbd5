//! The camera found from markers in sight.

use tracelight_aim::{
    Board, Camera, Doubt, LensBelief, PlacedPage, SeenPlace, SeenTag, Survey, SurveyedCamera, survey,
};
use tracelight_image::Grey;
use tracelight_markers::{Tag, TagPlace, find_tags};
use tracelight_maths::{atan2, powf};
use tracelight_picture::Raster;
use tracelight_rigfile::PageName;
use tracelight_rigfile::camera::{KnownCamera, Stood};
use tracelight_stroke::{Affine, Point};
use tracelight_task::{Failure, Stop};

use crate::{Looks, grey};

/// A wall as one image shows it.
pub struct SeenWall {
    /// Lens and pose.
    pub camera: SurveyedCamera,
    /// The page whose frame is the wall's; `None` where nobody wrote that down.
    pub frame: Option<PageName>,
    /// Pages that are in sight, in the wall's frame: that of the first page when the camera was calibrated, or of the first in sight.
    pub pages: Vec<PlacedPage>,
    /// How many of their markers are in sight.
    pub markers: usize,
    /// How much larger than meant they were printed, as somebody measured.
    pub print_scale: f64,
    /// How far markers are off from where they should be seen; `None` where none are in sight, and the camera is believed to stand where
    /// it stood.
    pub rms_px: Option<f64>,
    /// What does not look as it should, and what became of where the camera stood, in words.
    pub remarks: Vec<String>,
    /// The image.
    pub pixels: Raster,
}

impl SeenWall {
    /// Its camera as one that was found on that day, such as 2026-11-23.
    #[must_use]
    pub fn known(&self, date: &str) -> KnownCamera {
        KnownCamera::standing(self.camera, self.print_scale, &self.pages, date)
    }

    /// By what it is known.
    #[must_use]
    pub fn words(&self) -> String {
        match self.rms_px {
            Some(px) => format!("{} markers, {px:.3} px off, rms", self.markers),
            None => {
                "no markers are in sight: the camera is believed to stand where it was calibrated".to_owned()
            }
        }
    }
}

/// By how many pixels a camera may seem to have moved that did not.
pub const MOVED_PX: f64 = 1.0;

/// Levels between which the brightest hundredth of a well exposed image lies.
const WELL_EXPOSED: [u8; 2] = [190, 245];
/// Share of the pixels that are as bright or less.
const BRIGHTEST: f64 = 0.99;
/// Most images that are taken until one is well exposed.
const MOST_SHOTS: usize = 10;

/// Finds the camera from the markers that an image shows; where it shows none, the camera stands where it stood.
///
/// # Errors
/// `camera-image`: an image of another size than the lens that is known. `camera-not-found`: markers in sight that fit no camera, or none.
pub fn see_wall(pixels: Raster, known: Option<&KnownCamera>) -> Result<SeenWall, Failure> {
    let tags = markers(&grey(&pixels)?);
    wall_by(pixels, tags, known)
}

/// Likewise, from markers that were found in the image already.
///
/// # Errors
/// As of [`see_wall`].
pub(crate) fn wall_by(
    pixels: Raster,
    tags: Vec<SeenTag>,
    known: Option<&KnownCamera>,
) -> Result<SeenWall, Failure> {
    let markers = tags.len();
    let size = (pixels.width() as usize, pixels.height() as usize);
    let belief = known.map_or_else(|| LensBelief::unknown(size.0, size.1), |known| known.lens);
    if belief.lens.size_px != [size.0, size.1] {
        let message = format!(
            "the camera's image has {} × {} px, the lens that is known {:?}",
            size.0, size.1, belief.lens.size_px
        );
        return Err(Failure::usage("camera-image", message));
    }
    let stood = known.and_then(|known| known.stood.as_ref());
    let print_scale = known.map_or(1.0, |known| known.print_scale);
    if let (true, Some(stood)) = (tags.is_empty(), stood) {
        return Ok(SeenWall {
            camera: stood.camera,
            frame: stood.frame(),
            pages: Vec::new(),
            markers,
            print_scale,
            rms_px: None,
            remarks: Vec::new(),
            pixels,
        });
    }
    let survey = survey(&belief, &Board::ALL.map(|board| board.scaled(print_scale)), &[tags])
        .map_err(|e| Failure::failed("camera-not-found", format!("the camera's image of the wall: {e}")))?;
    let found = survey.camera(0).ok_or_else(|| Failure::failed("internal", "a survey without a camera"))?;
    let (frame, wall_from_first, stale) = held_against(&survey, &found, stood);
    let turn_rad = atan2(wall_from_first.as_coeffs()[1], wall_from_first.as_coeffs()[0]);
    let placed = |page: &PlacedPage| PlacedPage {
        middle: wall_from_first * page.middle,
        turn_rad: page.turn_rad + turn_rad,
        ..*page
    };
    Ok(SeenWall {
        camera: found.in_frame(wall_from_first),
        frame,
        pages: survey.pages.iter().map(placed).collect(),
        markers,
        print_scale,
        rms_px: Some(survey.rms_px),
        remarks: doubts(&survey).into_iter().chain(stale).collect(),
        pixels,
    })
}

/// The page whose frame is the wall's, that frame from that of a survey's first page, and what became of where the camera stood.
fn held_against(
    survey: &Survey,
    found: &SurveyedCamera,
    stood: Option<&Stood>,
) -> (Option<PageName>, Affine, Option<String>) {
    let first = survey.pages.first().map(PageName::of);
    let Some(stood) = stood else { return (first, Affine::IDENTITY, None) };
    // by any page that hung there then
    let known = survey.pages.iter().find_map(|page| {
        let first_from_page = page.place();
        Some(stood.wall_from(PageName::of(page))? * first_from_page.inverse())
    });
    let Some(wall_from_first) = known else {
        let name = first.map_or_else(String::new, |page| page.to_string());
        let why = format!(
            "no page in sight hung there on {}, when the camera was calibrated: the wall's frame is now that of page {name}",
            stood.date
        );
        return (first, Affine::IDENTITY, Some(why));
    };
    let moved_px = moved_px(&stood.camera.camera, &found.in_frame(wall_from_first).camera);
    let stale = match moved_px {
        Some(px) if px <= MOVED_PX => None,
        Some(px) => Some(format!(
            "the camera moved {px:.1} px since {}, when it was calibrated, or the page did: it was found anew",
            stood.date
        )),
        None => Some(format!(
            "the camera looks elsewhere since {}, when it was calibrated: it was found anew",
            stood.date
        )),
    };
    (stood.frame(), wall_from_first, stale)
}

/// By how much places of the wall moved in the image from one camera to another, root of the mean square, px.
#[must_use]
pub fn moved_px(from: &Camera, to: &Camera) -> Option<f64> {
    const PLACES: usize = 5;
    let [width, height] = from.lens.size_px.map(|n| n as f64);
    let place = |k: usize| (k as f64 + 0.5) / PLACES as f64;
    let mut sum = 0.0;
    for k in 0..PLACES * PLACES {
        let pixel = Point::new(width * place(k % PLACES), height * place(k / PLACES));
        sum += to.pixel(from.target(pixel)?)?.distance_squared(pixel);
    }
    Some((sum / (PLACES * PLACES) as f64).sqrt())
}

/// Markers of an image.
pub fn markers(grey: &Grey) -> Vec<SeenTag> {
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

/// An image that is neither too dark nor too bright, or as nearly so as the camera can; the next, of a camera that exposes as it likes.
///
/// # Errors
/// The camera sends nothing; or [`Failure::interrupted`].
pub fn well_exposed(eye: &mut dyn Looks, stop: &Stop) -> Result<Raster, Failure> {
    well_exposed_for(eye, stop).map(|taken| taken.0)
}

/// Likewise, and how long its rows were exposed, s.
///
/// # Errors
/// As of [`well_exposed`].
pub fn well_exposed_for(eye: &mut dyn Looks, stop: &Stop) -> Result<(Raster, f64), Failure> {
    let Some(longest_s) = eye.longest() else { return readable(eye, 0.0, stop) };
    let mut exposure_s = 0.5 * longest_s;
    // the longest that was too dark, and the shortest that was too bright
    let (mut dark_s, mut bright_s) = (0.0, f64::INFINITY);
    let (pixels, mut exposed_s) = readable(eye, exposure_s, stop)?;
    let mut best = (brightest(&pixels), pixels, exposed_s);
    let mut brightest_now = best.0;
    for _ in 1..MOST_SHOTS {
        if (WELL_EXPOSED[0]..=WELL_EXPOSED[1]).contains(&brightest_now) {
            break;
        }
        let is_dark = brightest_now < WELL_EXPOSED[0];
        if is_dark && exposed_s >= 0.99 * longest_s {
            if !eye.brighten() {
                break;
            }
            // what was too dark is so no more
            (dark_s, bright_s) = (0.0, f64::INFINITY);
        } else if exposed_s == dark_s || exposed_s == bright_s {
            // there is none between
            break;
        } else {
            let bound = if is_dark { &mut dark_s } else { &mut bright_s };
            *bound = exposed_s;
            exposure_s = next_s(exposed_s, brightest_now, [dark_s, bright_s]).min(longest_s);
        }
        let taken = readable(eye, exposure_s, stop)?;
        (exposed_s, brightest_now) = (taken.1, brightest(&taken.0));
        if worth(brightest_now) > worth(best.0) {
            best = (brightest_now, taken.0, exposed_s);
        }
    }
    Ok((best.1, best.2))
}

/// The next exposure that is tried after one that was too dark or too bright, s.
fn next_s(exposed_s: f64, brightest: u8, [dark_s, bright_s]: [f64; 2]) -> f64 {
    let light = |level: u8| powf(f64::from(level) / 255.0, 2.2);
    let wanted = light(WELL_EXPOSED[0] / 2 + WELL_EXPOSED[1] / 2);
    // how much too bright one is that is full, it does not tell
    let factor = if brightest < WELL_EXPOSED[0] { wanted / light(brightest.max(1)) } else { 0.5 };
    let guess_s = exposed_s * factor.clamp(0.1, 10.0);
    // not every camera's levels go by that power of the light
    if dark_s < guess_s && guess_s < bright_s { guess_s } else { (dark_s * bright_s).sqrt() }
}

/// How good an image is whose brightest hundredth is that bright: the brighter the better, but for one that is full.
fn worth(brightest: u8) -> i32 {
    let level = i32::from(brightest);
    if brightest > WELL_EXPOSED[1] { -level } else { level }
}

/// The next image that can be decoded, and how long it was exposed, s: as long as is told, of a camera that can be.
///
/// # Errors
/// The camera sends nothing, or nothing but spoilt images; or [`Failure::interrupted`].
pub fn readable(eye: &mut dyn Looks, exposure_s: f64, stop: &Stop) -> Result<(Raster, f64), Failure> {
    const MOST_SPOILT: usize = 5;
    let mut spoilt = 0;
    loop {
        stop.check()?;
        let shot = eye.take(exposure_s)?;
        match shot.pixels() {
            Ok(pixels) if shot.exposure_s > 0.0 => return Ok((pixels, shot.exposure_s)),
            Ok(pixels) => return Ok((pixels, exposure_s)),
            Err(failure) if failure.code != "camera-image" || spoilt == MOST_SPOILT => return Err(failure),
            Err(_) => spoilt += 1,
        }
    }
}

/// Whether an image can be measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exposed {
    /// White is grey in it.
    Dark,
    /// As it should be.
    Well,
    /// White is lost in it.
    Bright,
}

impl Exposed {
    /// One word.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Dark => "dark",
            Self::Well => "well",
            Self::Bright => "bright",
        }
    }
}

/// How an image is exposed, by the level that a hundredth of its pixels exceed. Half the light of a well exposed one is enough for its markers.
#[must_use]
pub fn exposed(pixels: &Raster) -> Exposed {
    const DARK: u8 = 110;
    match brightest(pixels) {
        level if level < DARK => Exposed::Dark,
        u8::MAX => Exposed::Bright,
        _ => Exposed::Well,
    }
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

/// What does not look as it should, in words.
#[must_use]
pub fn doubts(survey: &Survey) -> Vec<String> {
    let page =
        |page: usize| survey.pages.get(page).map_or_else(String::new, |page| PageName::of(page).to_string());
    let words = |doubt: &Doubt| match *doubt {
        Doubt::Loose(number, m) => format!(
            "page {} seems to lie {:.1} mm {} the plane of the others: stick it flat on the wall",
            page(number),
            1e3 * m.abs(),
            if m > 0.0 { "in front of" } else { "behind" }
        ),
        Doubt::Scaled(number, share) => format!(
            "page {} seems to be printed {:.2} % {} than page {}: print all of them alike, and measure their bars",
            page(number),
            100.0 * share.abs(),
            if share > 0.0 { "larger" } else { "smaller" },
            page(0)
        ),
        Doubt::Misfit(times) => format!(
            "markers are {times:.1} times as far from where they should be seen as they scatter: is a page loose, or has the lens been zoomed since it was calibrated?"
        ),
        Doubt::Lens(times) => format!(
            "the lens is {times:.1} deviations from what was known of it: has it been zoomed since, or does a page not lie on the wall?"
        ),
    };
    survey.doubts.iter().map(words).collect()
}
