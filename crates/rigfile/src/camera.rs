//! What is known of a camera, as a file: its lens and, in front of a wall, its pose, with what they hold for.

use nalgebra::SMatrix;
use serde::{Deserialize, Serialize};
use toml_edit::{Array, Item};
use tracelight_aim::{Camera, CameraPose, Lens, LensBelief, PlacedPage, Survey, SurveyedCamera};
use tracelight_stroke::{Affine, Point};
use tracelight_task::Failure;

use crate::calibrated::{Calibrated, Of};
use crate::pages::{PageName, PageTable};
use crate::text::{Kind, text_of};

/// Largest camera file, bytes: twenty times what is written.
const MOST_BYTES: usize = 1 << 18;
const KIND: Kind = Kind { name: "camera", code: "camera-file", most_bytes: MOST_BYTES };

/// A camera file.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraFile {
    /// Day it was found, as 2026-11-23.
    date: String,
    lens: LensTable,
    /// Where the camera stands; none of a lens alone.
    pose: Option<PoseTable>,
    score: ScoreTable,
    /// Pages that were seen, where the pose is in the frame of the first.
    #[serde(default)]
    pages: Vec<PageTable>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct LensTable {
    size_px: [usize; 2],
    focal_px: [f64; 2],
    centre_px: [f64; 2],
    /// k1, k2, k3.
    radial: [f64; 3],
    /// p1, p2.
    tangential: [f64; 2],
    /// Covariance of focal_px, centre_px, k1, k2, p1, p2, k3, row by row.
    covariance: Vec<Vec<f64>>,
}

/// camera_from_target.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PoseTable {
    turn_rad: [f64; 3],
    translation_m: [f64; 3],
    /// Covariance of a turn about the camera's axes, rad, of the translation, m, and of the lens as above, row by row.
    covariance: Vec<Vec<f64>>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ScoreTable {
    /// What a point of the wall is likely to be off, root of the mean square: between the pages, and all over the image.
    between_pages_mm: Option<f64>,
    image_mm: Option<f64>,
    /// How far places on the markers are off from where they should be seen.
    rms_px: f64,
    /// How many there were.
    places: usize,
    /// How much larger than meant the pages were printed.
    print_scale: f64,
}

/// What points of the wall are likely to be off, root of the mean square.
#[derive(Clone, Copy)]
pub struct Wall {
    /// Between the middles of the pages, or on the one there is.
    pub between_m: Option<f64>,
    /// All over the image, but for a twentieth at its borders; `None` if it shows more than the wall.
    pub image_m: Option<f64>,
}

impl Wall {
    /// Of a camera that a survey found.
    #[must_use]
    pub fn of(survey: &Survey, camera: &SurveyedCamera) -> Self {
        let [width, height] = camera.camera.lens.size_px.map(|n| n as f64);
        let place = |k: usize| 0.05 + 0.1 * k as f64;
        let all: Vec<Point> =
            (0..100).map(|i| Point::new(width * place(i % 10), height * place(i / 10))).collect();
        let middles = || survey.pages.iter().map(|page| page.middle);
        let ways = middles()
            .flat_map(|a| middles().flat_map(move |b| [0.0, 0.25, 0.5].map(|share| a.lerp(b, share))));
        let between: Vec<Point> = ways.filter_map(|at| camera.camera.pixel(at)).collect();
        Self { between_m: camera.wall_deviation_m(&between), image_m: camera.wall_deviation_m(&all) }
    }
}

impl CameraFile {
    /// Of a survey on a day, such as 2026-11-23, with the camera of one of its images, or of its lens alone.
    #[must_use]
    pub fn of(
        survey: &Survey,
        camera: Option<(&SurveyedCamera, Wall)>,
        print_scale: f64,
        date: &str,
    ) -> Self {
        let lens = &survey.belief.lens;
        let pose = |camera: &SurveyedCamera| PoseTable {
            turn_rad: camera.camera.pose.turn_rad(),
            translation_m: camera.camera.pose.translation_m(),
            covariance: rows(&camera.covariance),
        };
        Self {
            date: date.to_owned(),
            lens: LensTable {
                size_px: lens.size_px,
                focal_px: lens.focal_px,
                centre_px: [lens.centre_px.x, lens.centre_px.y],
                radial: lens.radial,
                tangential: lens.tangential,
                covariance: rows(&survey.belief.covariance),
            },
            pose: camera.map(|(camera, _)| pose(camera)),
            score: ScoreTable {
                between_pages_mm: camera.and_then(|(_, wall)| wall.between_m).map(|m| 1e3 * m),
                image_mm: camera.and_then(|(_, wall)| wall.image_m).map(|m| 1e3 * m),
                rms_px: survey.rms_px,
                places: survey.places,
                print_scale,
            },
            pages: survey.pages.iter().map(PageTable::of).collect(),
        }
    }

    /// What the file says of the lens.
    fn lens(&self) -> Result<LensBelief, String> {
        let table = &self.lens;
        let lens = Lens {
            size_px: table.size_px,
            focal_px: table.focal_px,
            centre_px: Point::new(table.centre_px[0], table.centre_px[1]),
            radial: table.radial,
            tangential: table.tangential,
        };
        if lens.size_px.iter().any(|n| !(8..=100_000).contains(n)) {
            return Err(format!(
                "lens.size_px is {:?}; an image has 8 to 100000 px either way",
                lens.size_px
            ));
        }
        if lens.focal_px.iter().any(|f| !(1.0..1e7).contains(f)) {
            return Err(format!("lens.focal_px is {:?}; a focal length is 1 to 1e7 px", lens.focal_px));
        }
        let [fx, fy] = lens.focal_px;
        if !(0.5..=2.0).contains(&(fx / fy)) {
            return Err(format!(
                "lens.focal_px is {:?}; pixels are at most twice as long as wide",
                lens.focal_px
            ));
        }
        let inside = |v: f64, size: usize| (-(size as f64)..=2.0 * size as f64).contains(&v);
        if !(inside(lens.centre_px.x, lens.size_px[0]) && inside(lens.centre_px.y, lens.size_px[1])) {
            return Err(format!("lens.centre_px is {:?}; it lies in the image or near it", table.centre_px));
        }
        if lens.radial.iter().chain(&lens.tangential).any(|k| !(-10.0..=10.0).contains(k)) {
            return Err(format!(
                "lens.radial {:?} and lens.tangential {:?} are -10 to 10",
                lens.radial, lens.tangential
            ));
        }
        let covariance = square::<9>(&table.covariance).filter(|c| {
            let usual = |v: &f64| (1e-20..1e14).contains(v);
            c.diagonal().iter().all(usual) && c.cholesky().is_some()
        });
        let covariance = covariance
            .ok_or("lens.covariance is no covariance: nine rows of nine numbers, positive definite")?;
        Ok(LensBelief { lens, covariance })
    }
}

impl PoseTable {
    /// The camera that stands there.
    fn camera(&self, lens: &LensBelief) -> Result<SurveyedCamera, String> {
        let within = |values: &[f64], most: f64| values.iter().all(|v| v.abs() <= most);
        if !(within(&self.turn_rad, 7.0) && within(&self.translation_m, 1e3)) {
            return Err(format!(
                "pose: no camera stands at {:?} m, turned by {:?} rad; calibrate it again",
                self.translation_m, self.turn_rad
            ));
        }
        let covariance = square::<15>(&self.covariance).filter(|c| c.cholesky().is_some());
        let covariance = covariance
            .ok_or("pose.covariance is no covariance: fifteen rows of fifteen numbers, positive definite")?;
        let pose = CameraPose::new(self.turn_rad, self.translation_m);
        Ok(SurveyedCamera { camera: Camera { lens: lens.lens, pose }, covariance })
    }
}

fn rows<const N: usize>(matrix: &SMatrix<f64, N, N>) -> Vec<Vec<f64>> {
    (0..N).map(|i| (0..N).map(|k| matrix[(i, k)]).collect()).collect()
}

fn square<const N: usize>(rows: &[Vec<f64>]) -> Option<SMatrix<f64, N, N>> {
    let whole = rows.len() == N && rows.iter().all(|row| row.len() == N && row.iter().all(|v| v.is_finite()));
    whole.then(|| SMatrix::from_fn(|i, k| rows[i][k]))
}

/// A camera as a file.
///
/// # Errors
/// `internal`: of what is in a file there is nothing that cannot be written.
pub fn write(file: &CameraFile) -> Result<String, Failure> {
    let mut document = toml_edit::ser::to_document(file).map_err(|e| Failure::failed("internal", e))?;
    for (_, item) in document.iter_mut() {
        if let Some(table) = item.as_inline_table() {
            *item = Item::Table(table.clone().into_table());
        }
        // a row of a covariance a line
        for row in
            item.get_mut("covariance").and_then(Item::as_array_mut).into_iter().flat_map(Array::iter_mut)
        {
            row.decor_mut().set_prefix("\n  ");
        }
    }
    Ok(format!(
        "# Tracelight: a camera. Lengths in m, angles in rad, pixels from the upper left corner of the image.\n\n{document}"
    ))
}

/// What is known of a camera before it looks.
#[derive(Clone, Debug)]
pub struct KnownCamera {
    /// Its lens, and how well that is known.
    pub lens: LensBelief,
    /// How much larger than meant the pages were printed.
    pub print_scale: f64,
    /// Where it stood; none of a lens alone.
    pub stood: Option<Stood>,
}

/// Where a camera stood.
#[derive(Clone, Debug)]
pub struct Stood {
    /// Lens and pose in the wall's frame.
    pub camera: SurveyedCamera,
    /// On which day.
    pub date: String,
    /// Pages that hung there then, and the wall's frame from theirs; the wall's is that of the first.
    pages: Vec<(PageName, Affine)>,
}

impl KnownCamera {
    /// Of a camera that was found on that day, before pages printed so much larger than meant that hang in the wall's frame.
    #[must_use]
    pub fn standing(camera: SurveyedCamera, print_scale: f64, pages: &[PlacedPage], date: &str) -> Self {
        let covariance = camera.covariance.fixed_view::<9, 9>(6, 6).into_owned();
        let pages = pages.iter().map(|page| (PageName::of(page), page.place())).collect();
        let stood = Stood { camera, date: date.to_owned(), pages };
        Self { lens: LensBelief { lens: camera.camera.lens, covariance }, print_scale, stood: Some(stood) }
    }
}

impl Stood {
    /// The wall's frame from that of a page, if that hung there.
    #[must_use]
    pub fn wall_from(&self, page: PageName) -> Option<Affine> {
        self.pages.iter().find(|(name, _)| *name == page).map(|(_, wall_from_page)| *wall_from_page)
    }

    /// The page whose frame is the wall's.
    #[must_use]
    pub fn frame(&self) -> Option<PageName> {
        self.pages.first().map(|(name, _)| *name)
    }
}

fn parsed(path: &str, bytes: Vec<u8>) -> Result<CameraFile, Failure> {
    let text = text_of(&KIND, path, bytes)?;
    toml_edit::de::from_str(&text)
        .map_err(|e| KIND.wrong(path, &format!("no camera file: {}", e.to_string().trim_end())))
}

/// What a camera file says of how well its camera is known.
pub(crate) fn calibrated(path: &str, bytes: Vec<u8>) -> Result<Calibrated, Failure> {
    let file = parsed(path, bytes)?;
    let stands = file.pose.is_some();
    let off_mm = file.score.between_pages_mm.or(file.score.image_mm).filter(|_| stands);
    Ok(Calibrated {
        of: if stands { Of::Camera } else { Of::Lens },
        date: file.date,
        off_m: off_mm.map(|mm| 1e-3 * mm),
        size_px: Some(file.lens.size_px),
        pages: file.pages.len(),
        rig: None,
        area_m: None,
    })
}

/// What a camera file's bytes say.
///
/// # Errors
/// `camera-file`, with the key that is wrong.
pub fn read(path: &str, bytes: Vec<u8>) -> Result<KnownCamera, Failure> {
    let wrong = |what: String| KIND.wrong(path, &what);
    let file = parsed(path, bytes)?;
    let lens = file.lens().map_err(wrong)?;
    let camera = file.pose.as_ref().map(|pose| pose.camera(&lens)).transpose().map_err(wrong)?;
    let pages: Result<Vec<_>, String> = file.pages.iter().map(PageTable::placed).collect();
    let pages = pages.map_err(wrong)?;
    if let Some((name, _)) = pages
        .iter()
        .enumerate()
        .find(|(k, (name, _))| pages[..*k].iter().any(|p| p.0 == *name))
        .map(|(_, p)| p)
    {
        return Err(wrong(format!("pages: page {name} is there twice")));
    }
    if file.date.len() > 40 || file.date.chars().any(char::is_control) {
        return Err(wrong("date: is none, such as 2026-11-23".to_owned()));
    }
    let stood = camera.map(|camera| Stood { camera, date: file.date.clone(), pages });
    let print_scale = file.score.print_scale;
    if !(0.5..=2.0).contains(&print_scale) {
        return Err(wrong(format!(
            "score.print_scale is {print_scale}; pages are printed 0.5 to 2 times as large as meant"
        )));
    }
    Ok(KnownCamera { lens, print_scale, stood })
}
