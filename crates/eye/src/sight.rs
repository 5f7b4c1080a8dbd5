//! What one image tells of a wall before anything is measured by it: which pages of markers are in sight, how bright it is, and whether a camera stands where it was
//! calibrated.

use serde_json::{Value, json};
use tracelight_aim::{Board, SeenTag};
use tracelight_picture::Raster;
use tracelight_rigfile::PageName;
use tracelight_rigfile::camera::KnownCamera;
use tracelight_task::Failure;

use crate::grey;
use crate::wall::{Exposed, exposed, markers, wall_by};

/// What one image tells.
#[derive(Clone, Debug)]
pub struct Sight {
    /// Columns and rows.
    pub size_px: [u32; 2],
    /// Whether it is too dark or too bright to be measured.
    pub exposed: Exposed,
    /// Markers in it.
    pub markers: Vec<SeenTag>,
    /// Pages that these are on, in the order of their numbers.
    pub pages: Vec<PageInSight>,
    /// How its markers fit a calibration, where one was given.
    pub held: Option<Held>,
}

/// A page of markers in an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PageInSight {
    /// Which one.
    pub name: PageName,
    /// Its number, from 1.
    pub number: u16,
    /// Whether it is one of the coarse board.
    pub is_coarse: bool,
    /// Markers of it in the image, and on the page.
    pub markers: [u16; 2],
}

/// How an image fits a calibration.
#[derive(Clone, Debug)]
pub struct Held {
    /// Root of the mean square of how far its markers are from where the camera as found anew has them, px; `None` where none is in sight, or none fits.
    pub rms_px: Option<f64>,
    /// What is not as it was, such as a camera that has moved, in words.
    pub remarks: Vec<String>,
}

impl Sight {
    /// Looks at an image, and holds it against what is known of its camera.
    ///
    /// # Errors
    /// An image that is too large, or has no pixels.
    pub fn of(pixels: &Raster, known: Option<&KnownCamera>) -> Result<Self, Failure> {
        let markers = markers(&grey(pixels)?);
        Ok(Self {
            size_px: [pixels.width(), pixels.height()],
            exposed: exposed(pixels),
            pages: pages(&markers),
            held: known.map(|known| held(pixels, &markers, known)),
            markers,
        })
    }

    /// What to do so that the wall can be measured, if anything.
    #[must_use]
    pub fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        match self.exposed {
            Exposed::Dark => {
                remarks.push("the image is dark: more light on the wall makes its markers surer".to_owned())
            }
            Exposed::Bright => remarks.push(
                "the image is too bright, white is lost in it: less light on the wall, or none behind it"
                    .to_owned(),
            ),
            Exposed::Well => {}
        }
        let missing = self.missing();
        if self.pages.is_empty() {
            remarks.push("no page of markers is in sight: print some, and stick them on the wall near the corners of where you will draw".to_owned());
        } else if !missing.is_empty() {
            let names: Vec<String> = missing.iter().map(u16::to_string).collect();
            let (s, is) = if missing.len() == 1 { ("", "is") } else { ("s", "are") };
            remarks.push(format!(
                "page{s} {} {is} not in sight, but pages before and behind {}: covered, out of the image, or not on the wall?",
                names.join(", "),
                if missing.len() == 1 { "it" } else { "them" }
            ));
        } else if self.pages.len() == 1 {
            remarks.push(
                "one page is in sight: with four of them, near the corners of where you will draw, the wall is known several times better".to_owned(),
            );
        }
        let part = self.pages.iter().filter(|page| page.markers[0] < page.markers[1]);
        remarks.extend(part.map(|page| {
            let [seen, of] = page.markers;
            format!("page {}: {seen} of its {of} markers are in sight", page.name)
        }));
        remarks.extend(self.held.iter().flat_map(|held| held.remarks.clone()));
        remarks
    }

    /// Numbers of pages that are not in sight between others that are, of the board of the first page.
    fn missing(&self) -> Vec<u16> {
        let Some(first) = self.pages.first() else { return Vec::new() };
        let of_board = self.pages.iter().filter(|page| page.is_coarse == first.is_coarse);
        let seen: Vec<u16> = of_board.map(|page| page.number).collect();
        let last = seen.last().copied().unwrap_or_default();
        (first.number..last).filter(|number| !seen.contains(number)).collect()
    }

    /// For people.
    #[must_use]
    pub fn words(&self) -> String {
        let [width, height] = self.size_px;
        let names: Vec<String> = self.pages.iter().map(|page| page.name.to_string()).collect();
        let on = match names.len() {
            0 => String::new(),
            1 => format!(" on page {}", names[0]),
            _ => format!(" on pages {}", names.join(", ")),
        };
        let fits = self.held.as_ref().and_then(|held| held.rms_px);
        let fits = fits.map_or_else(String::new, |px| format!("; {px:.3} px off, rms"));
        let remarks = self.remarks().into_iter().map(|remark| format!("\nnote:     {remark}"));
        format!(
            "image:    {width} × {height} px\nmarkers:  {}{on}{fits}{}",
            if self.markers.is_empty() { "none".to_owned() } else { self.markers.len().to_string() },
            remarks.collect::<String>()
        )
    }

    /// For scripts.
    #[must_use]
    pub fn json(&self) -> Value {
        let page_of =
            |tag: &SeenTag| Board::ALL.iter().find_map(|board| board.find(tag.id)).map(|(page, _)| page + 1);
        let marker = |tag: &SeenTag| json!({ "id": tag.id, "page": page_of(tag), "corners_px": tag.corners.map(|corner| [corner.x, corner.y]) });
        let page = |page: &PageInSight| json!({ "page": page.number, "board": page.board(), "markers": page.markers[0], "of": page.markers[1] });
        json!({
            "width_px": self.size_px[0],
            "height_px": self.size_px[1],
            "exposed": self.exposed.word(),
            "markers": self.markers.iter().map(marker).collect::<Vec<_>>(),
            "pages": self.pages.iter().map(page).collect::<Vec<_>>(),
            "calibration": self.held.as_ref().map(|held| json!({ "rms_px": held.rms_px, "holds": held.remarks.is_empty() })),
            "remarks": self.remarks(),
        })
    }
}

impl PageInSight {
    const fn board(&self) -> &'static str {
        if self.is_coarse { "coarse" } else { "fine" }
    }
}

/// Pages that markers are on.
fn pages(markers: &[SeenTag]) -> Vec<PageInSight> {
    let mut pages: Vec<PageInSight> = Vec::new();
    for (number, board) in Board::ALL.iter().enumerate() {
        for page in 0..board.pages {
            let on_it = |tag: &&SeenTag| board.find(tag.id).is_some_and(|(of, _)| of == page);
            let seen = markers.iter().filter(on_it).count() as u16;
            if seen > 0 {
                let markers = [seen, board.tags()];
                let name = PageName::on(number, page);
                pages.push(PageInSight { name, number: page + 1, is_coarse: number > 0, markers });
            }
        }
    }
    pages
}

/// Holds an image against a calibration.
fn held(pixels: &Raster, markers: &[SeenTag], known: &KnownCamera) -> Held {
    match wall_by(pixels.clone(), markers.to_vec(), Some(known)) {
        Ok(wall) if wall.rms_px.is_none() => Held {
            rms_px: None,
            remarks: vec![
                "without markers in sight nobody can tell whether the camera stands where it was calibrated"
                    .to_owned(),
            ],
        },
        Ok(wall) => Held { rms_px: wall.rms_px, remarks: wall.remarks },
        Err(failure) => Held { rms_px: None, remarks: vec![failure.message] },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_stroke::Point;

    fn tag(id: u16) -> SeenTag {
        SeenTag { id, corners: [Point::ZERO; 4], places: Vec::new(), deviation_px: 0.1 }
    }

    fn of(ids: impl IntoIterator<Item = u16>) -> Sight {
        let markers: Vec<SeenTag> = ids.into_iter().map(tag).collect();
        Sight { size_px: [640, 480], exposed: Exposed::Well, pages: pages(&markers), markers, held: None }
    }

    #[test]
    fn a_page_that_is_missing_between_others_is_named_and_one_behind_them_is_not() {
        // pages 1, 2 and 4 of twenty markers each, of page 2 a part
        let sight = of((0..20).chain(25..40).chain(60..80));
        let seen: Vec<String> = sight.pages.iter().map(|page| page.name.to_string()).collect();
        assert_eq!(seen, ["1", "2", "4"]);
        let told = sight.remarks();
        assert!(told[0].starts_with("page 3 is not in sight"), "{told:?}");
        assert!(told[1].starts_with("page 2: 15 of its 20"), "{told:?}");
        assert_eq!(told.len(), 2);
        assert!(of(0..80).remarks().is_empty());
    }

    #[test]
    fn what_is_too_little_is_told_with_what_to_do() {
        assert!(of([]).remarks()[0].contains("print some"));
        assert!(of(0..20).remarks()[0].contains("with four of them"));
        let dark = Sight { exposed: Exposed::Dark, ..of(0..80) };
        assert!(dark.remarks()[0].contains("more light"));
        // the coarse board has markers and pages of its own
        let coarse = of(480..488);
        assert_eq!(coarse.pages[1].name.to_string(), "2 (coarse)");
        assert!(coarse.words().contains("markers:  8 on pages 1 (coarse), 2 (coarse)"), "{}", coarse.words());
    }
}
