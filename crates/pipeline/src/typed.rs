//! Marks and areas of a wall as people write them: `0mm,0mm=1.2m,0.4m`, `10cm,20cm,8cm,8cm`.

use tracelight_rig::PanTilt;
use tracelight_stroke::{Point, Rect, Vec2};
use tracelight_task::Failure;
use tracelight_units::{ANGLES, LENGTHS, PIXELS, parse};

use crate::align::{AskedMark, MarkedAt};
use crate::driving::Driving;
use crate::edges::Origin;

/// A mark as it was typed.
#[derive(Clone, Debug, PartialEq)]
pub struct TypedMark {
    /// Its own words.
    pub text: String,
    at: MarkedAt,
    wall: OnWall,
}

/// Where a mark belongs.
#[derive(Clone, Copy, Debug, PartialEq)]
enum OnWall {
    /// So far from what is measured from, m.
    Lengths(Vec2),
    /// Where the beam falls at these angles, rad.
    Angles(PanTilt<f64>),
}

/// What is to be kept dark.
#[derive(Clone, Debug, PartialEq)]
pub enum NoGo {
    /// The closed paths of a layer.
    Layer(String),
    /// An area: corner and size, m.
    Area(Vec2, Vec2),
}

impl NoGo {
    /// The layer whose closed paths it is.
    #[must_use]
    pub fn layer(&self) -> Option<String> {
        match self {
            Self::Layer(name) => Some(name.clone()),
            Self::Area(..) => None,
        }
    }

    /// The area that it is, on the target, m.
    #[must_use]
    pub fn area(&self, from: &Origin) -> Option<Rect> {
        match self {
            Self::Area(corner, size) => Some(from.area(*corner, *size)),
            Self::Layer(_) => None,
        }
    }
}

impl std::fmt::Display for NoGo {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Layer(name) => write!(f, "layer {name}"),
            Self::Area(at, size) => write!(f, "{} × {} m at {}, {} m", size.x, size.y, at.x, at.y),
        }
    }
}

impl TypedMark {
    /// With its place on the target.
    ///
    /// # Errors
    /// `align` where its angles are of no head, or their beam meets no wall.
    pub fn placed(&self, from: &Origin, driving: Option<&Driving>) -> Result<AskedMark, Failure> {
        let mark = self;
        let wrong = |why: &str| Failure::usage("align", format!("--align \"{}\": {why}", mark.text));
        let wall = match (mark.wall, driving) {
            (OnWall::Lengths(lengths), _) => from.place(lengths),
            (OnWall::Angles(angle), Some(driving)) => {
                let spot = driving.rig.model.geometry.spot(&driving.pose, angle);
                spot.filter(|spot| spot.is_finite())
                    .ok_or_else(|| wrong("at these angles the beam does not meet the wall"))?
            }
            (OnWall::Angles(_), None) => {
                return Err(wrong(
                    "angles are those of a head, and no head is used here: give lengths, or use plan or trace",
                ));
            }
        };
        Ok(AskedMark { text: mark.text.clone(), at: mark.at, wall })
    }
}

const MARK: &str = "a mark is X,Y=U,V, such as \"0mm,0mm=1.2m,0.4m\" or \"120px,340px=12deg,-3deg\"";

/// One mark, or several with semicolons or spaces between them.
///
/// # Errors
/// What is wrong, and what a mark is.
pub fn typed_marks(text: &str) -> Result<Vec<TypedMark>, String> {
    let parts: Vec<&str> = match text.matches('=').count() {
        0 => return Err(format!("{text} has no =: {MARK}")),
        1 => vec![text],
        _ if text.contains(';') => text.split(';').collect(),
        _ => text.split_whitespace().collect(),
    };
    parts.into_iter().map(|part| mark(part.trim())).collect()
}

fn mark(text: &str) -> Result<TypedMark, String> {
    let (at, wall) = text.split_once('=').ok_or_else(|| format!("{text} has no =: {MARK}"))?;
    let pair = |text: &str| {
        let (x, y) = text.split_once(',').ok_or_else(|| format!("{text} is no pair: {MARK}"))?;
        Ok::<_, String>((x.trim().to_owned(), y.trim().to_owned()))
    };
    let (x, y) = pair(at)?;
    let at = match (parse(&x, PIXELS), parse(&y, PIXELS)) {
        (Ok(x), Ok(y)) => MarkedAt::Pixels(Point::new(x, y)),
        _ => MarkedAt::Metres(Point::new(
            parse(&x, LENGTHS).map_err(|e| format!("{e}; or px of a picture: {MARK}"))?,
            parse(&y, LENGTHS).map_err(|e| format!("{e}; or px of a picture: {MARK}"))?,
        )),
    };
    let (u, v) = pair(wall)?;
    let wall = match (parse(&u, ANGLES), parse(&v, ANGLES)) {
        (Ok(pan), Ok(tilt)) => OnWall::Angles(PanTilt::new(pan, tilt)),
        _ => OnWall::Lengths(Vec2::new(
            parse(&u, LENGTHS).map_err(|e| format!("{e}; or two angles: {MARK}"))?,
            parse(&v, LENGTHS).map_err(|e| format!("{e}; or two angles: {MARK}"))?,
        )),
    };
    Ok(TypedMark { text: text.to_owned(), at, wall })
}

/// Four lengths are an area; all else names a layer.
///
/// # Errors
/// What is wrong with an area.
pub fn typed_no_go(text: &str) -> Result<NoGo, String> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let is_number = |part: &str| part.starts_with(|c: char| c.is_ascii_digit() || c == '-' || c == '.');
    let [x, y, width, height] = parts[..] else {
        return match parts.len() > 1 && parts.iter().all(|part| is_number(part)) {
            true => Err(format!(
                "{text} is no area: give its corner and its size, X,Y,W,H, such as 10cm,20cm,8cm,8cm"
            )),
            false if text.trim().is_empty() => {
                Err("give a layer's name, or an area such as 10cm,20cm,8cm,8cm".to_owned())
            }
            false => Ok(NoGo::Layer(text.trim().to_owned())),
        };
    };
    if !is_number(x) {
        return Ok(NoGo::Layer(text.trim().to_owned()));
    }
    let length = |text: &str| parse(text, LENGTHS).map_err(|e| e.to_string());
    let (corner, size) = (Vec2::new(length(x)?, length(y)?), Vec2::new(length(width)?, length(height)?));
    match size.x > 0.0 && size.y > 0.0 {
        true => Ok(NoGo::Area(corner, size)),
        false => {
            Err(format!("{text}: width and height of an area are above zero, such as 10cm,20cm,8cm,8cm"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_have_units_on_both_sides() {
        let one = |text: &str| typed_marks(text).map(|mut all| all.remove(0));
        let found = one("0mm, 1200mm = 1.2m,0.4m").unwrap();
        assert_eq!(found.at, MarkedAt::Metres(Point::new(0.0, 1.2)));
        assert_eq!(found.wall, OnWall::Lengths(Vec2::new(1.2, 0.4)));
        assert_eq!(one("120px,340px=1m,2m").unwrap().at, MarkedAt::Pixels(Point::new(120.0, 340.0)));
        assert!(
            matches!(one("0mm,0mm=12deg,-3deg").unwrap().wall, OnWall::Angles(angle) if angle.tilt < 0.0)
        );
        assert_eq!(typed_marks("0mm,0mm=0m,0m 1m,0m=1m,0m").unwrap().len(), 2);
        assert_eq!(typed_marks("0 mm,0mm=0m,0m; 1m,0m=1m,0m").unwrap().len(), 2);
        for (text, why) in [
            ("0mm,0mm", "has no ="),
            ("0mm=1m,1m", "is no pair"),
            ("0,0=1m,1m", "has no unit"),
            ("0mm,0mm=1m,3deg", "does not fit"),
            ("5px,3mm=1m,3m", "does not fit"),
        ] {
            let error = typed_marks(text).unwrap_err();
            assert!(error.contains(why) && error.contains("X,Y=U,V"), "{text}: {error}");
        }
    }

    #[test]
    fn an_area_has_four_lengths_and_all_else_is_a_layer() {
        assert_eq!(
            typed_no_go("10cm,-20cm,8cm,1m"),
            Ok(NoGo::Area(Vec2::new(0.1, -0.2), Vec2::new(0.08, 1.0)))
        );
        assert_eq!(typed_no_go("DOORS"), Ok(NoGo::Layer("DOORS".into())));
        assert_eq!(typed_no_go("a,b,c,d"), Ok(NoGo::Layer("a,b,c,d".into())));
        assert!(typed_no_go("10cm,20cm").unwrap_err().contains("X,Y,W,H"));
        assert!(typed_no_go("1cm,2cm,0cm,3cm").unwrap_err().contains("above zero"));
        assert!(typed_no_go("1cm,2cm,3,3cm").unwrap_err().contains("no unit"));
    }
}
