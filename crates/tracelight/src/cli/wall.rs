//! Where on a wall a drawing goes: the flags of every command that places one.

use clap::{Args, ValueEnum};
use tracelight_pipeline::{
    AskedMark, Corner, DEFAULT_DISTANCE_M, Driving, Fit, MarkedAt, Origin, Placing, spot_radius_m,
};
use tracelight_rig::PanTilt;
use tracelight_stroke::{Point, Vec2};
use tracelight_task::Failure;
use tracelight_units::{ANGLES, LENGTHS, Offset, PIXELS, parse};

/// Where on a wall a drawing goes, and where it must not.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct WallArgs {
    /// A mark of the drawing, and where it belongs on the wall: "X,Y=U,V", such as "0mm,0mm=1.2m,0.4m"; give it again for more marks. X,Y: of a DXF or
    /// CSV its own coordinates; of an SVG and a picture from the top left, such as "120px,340px". U,V: right and up of the target's middle, or from the
    /// edges that --from names; or the joint angles pan,tilt at which the head's dot is on the mark, such as "12deg,-3deg". One mark sets the place, two
    /// also turn and size (with --width they check it), three skew, four keystone; more are averaged
    #[arg(long, value_name = "X,Y=U,V", allow_hyphen_values = true, value_parser = marks)]
    pub(crate) align: Vec<Marks>,
    /// What --offset, U,V of --align and --no-go are measured from: an edge corner of the wall, inwards, so that bottom-left measures from the left edge and
    /// from the floor. --offset then goes to the same corner of the drawing
    #[arg(long, value_enum, value_name = "CORNER")]
    pub(crate) from: Option<CornerName>,
    /// Where that corner of the wall is, right and up of the point straight ahead of the head: -1.5m,-1.2m [default: by the head file of `calibrate corners`,
    /// else straight ahead]
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, requires = "from")]
    pub(crate) origin: Option<Offset>,
    /// What --width, --height and --offset are those of: the page with its margins, or the drawing on it
    #[arg(long, value_enum, default_value_t)]
    pub(crate) fit: FitName,
    /// Never lit: the closed paths on a layer of the drawing, which are not drawn; or an area of the wall by its corner and size, such as 10cm,20cm,8cm,8cm.
    /// Strokes are cut there, and dark moves may pass. Give it again for more
    #[arg(long, value_name = "LAYER|X,Y,W,H", allow_hyphen_values = true, value_parser = no_go)]
    pub(crate) no_go: Vec<NoGo>,
}

/// A corner of a wall, or its middle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CornerName {
    /// Floor and left edge
    BottomLeft,
    /// Floor and right edge
    BottomRight,
    /// Top and left edge
    TopLeft,
    /// Top and right edge
    TopRight,
    /// The middle, as without --from
    #[value(alias = "center")]
    Centre,
}

impl CornerName {
    const fn corner(self) -> Corner {
        match self {
            Self::BottomLeft => Corner::BottomLeft,
            Self::BottomRight => Corner::BottomRight,
            Self::TopLeft => Corner::TopLeft,
            Self::TopRight => Corner::TopRight,
            Self::Centre => Corner::Centre,
        }
    }
}

/// What sizes and corners are those of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum FitName {
    /// What is drawn, without the empty margins
    Drawing,
    /// All of the picture or page
    #[default]
    Page,
}

/// Marks of one flag.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Marks(Vec<TypedMark>);

/// A mark as it was typed.
#[derive(Clone, Debug, PartialEq)]
struct TypedMark {
    text: String,
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
pub(crate) enum NoGo {
    /// The closed paths of a layer.
    Layer(String),
    /// An area: corner and size, m.
    Area(Vec2, Vec2),
}

impl WallArgs {
    /// Whether any of it is asked for.
    pub(crate) const fn is_given(&self) -> bool {
        !self.align.is_empty()
            || self.from.is_some()
            || !self.no_go.is_empty()
            || matches!(self.fit, FitName::Drawing)
    }

    /// Adds what they mean to where a drawing goes otherwise; `area_m` is what is known of the wall: its width and height about the target's middle.
    pub(crate) fn placing(
        &self,
        placing: Placing,
        driving: Option<&Driving>,
        area_m: Option<(f64, f64)>,
    ) -> Result<Placing, Failure> {
        let corner = self.from.map_or(Corner::Centre, CornerName::corner);
        let told = self.origin.map(|Offset(x, y)| Point::new(x.0, y.0));
        let from = Origin { corner, at: told.or_else(|| area_m.map(|size| corner.of_centred(size))) };
        self.check(&placing)?;
        let marks = self.align.iter().flat_map(|marks| &marks.0).map(|mark| asked(mark, &from, driving));
        let areas = self.no_go.iter().filter_map(|no_go| match no_go {
            NoGo::Area(corner, size) => Some(from.area(*corner, *size)),
            NoGo::Layer(_) => None,
        });
        let mut placing = Placing {
            from,
            fit: match self.fit {
                FitName::Drawing => Fit::Drawing,
                FitName::Page => Fit::Page,
            },
            marks: marks.collect::<Result<_, _>>()?,
            no_go: areas.collect(),
            margin_m: spot_radius_m(driving.map_or(DEFAULT_DISTANCE_M, |driving| driving.pose.distance_m)),
            ..placing
        };
        placing.choice.no_go = self.no_go.iter().filter_map(layer).collect();
        Ok(placing)
    }

    /// What was set, flag and value; nothing where nothing was.
    pub(crate) fn settings(&self) -> Vec<(&'static str, String)> {
        let mut rows = Vec::new();
        let marks = self.align.iter().flat_map(|marks| &marks.0).map(|mark| mark.text.as_str());
        let marks = marks.collect::<Vec<_>>().join(" ");
        let no_go = self.no_go.iter().map(NoGo::to_string).collect::<Vec<_>>().join("; ");
        rows.extend((!marks.is_empty()).then_some(("marks", marks)));
        rows.extend(self.from.map(|from| ("measured from", from.corner().name().to_owned())));
        rows.extend(self.origin.map(|Offset(x, y)| ("where that is", format!("{x}, {y}"))));
        rows.extend(
            (self.fit == FitName::Drawing).then(|| ("size of", "the drawing without its margins".to_owned())),
        );
        rows.extend((!no_go.is_empty()).then_some(("never lit", no_go)));
        rows
    }

    /// Refuses what marks tell and another flag too.
    fn check(&self, placing: &Placing) -> Result<(), Failure> {
        let marks: usize = self.align.iter().map(|marks| marks.0.len()).sum();
        let wrong = |flag: &str| {
            let message =
                format!("--align says where the drawing goes, and {flag} too: leave one of them out");
            Err(Failure::usage("usage", message))
        };
        match marks {
            0 => Ok(()),
            _ if placing.offset_m.is_some() => wrong("--offset"),
            2.. if placing.rotation_rad != 0.0 => wrong("--rotate"),
            _ => Ok(()),
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

fn layer(no_go: &NoGo) -> Option<String> {
    match no_go {
        NoGo::Layer(name) => Some(name.clone()),
        NoGo::Area(..) => None,
    }
}

/// A mark with its place on the target.
fn asked(mark: &TypedMark, from: &Origin, driving: Option<&Driving>) -> Result<AskedMark, Failure> {
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

const MARK: &str = "a mark is X,Y=U,V, such as \"0mm,0mm=1.2m,0.4m\" or \"120px,340px=12deg,-3deg\"";

/// One mark, or several with semicolons or spaces between them.
fn marks(text: &str) -> Result<Marks, String> {
    let parts: Vec<&str> = match text.matches('=').count() {
        0 => return Err(format!("{text} has no =: {MARK}")),
        1 => vec![text],
        _ if text.contains(';') => text.split(';').collect(),
        _ => text.split_whitespace().collect(),
    };
    parts.into_iter().map(|part| mark(part.trim())).collect::<Result<_, _>>().map(Marks)
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
fn no_go(text: &str) -> Result<NoGo, String> {
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
        let one = |text: &str| marks(text).map(|Marks(mut all)| all.remove(0));
        let found = one("0mm, 1200mm = 1.2m,0.4m").unwrap();
        assert_eq!(found.at, MarkedAt::Metres(Point::new(0.0, 1.2)));
        assert_eq!(found.wall, OnWall::Lengths(Vec2::new(1.2, 0.4)));
        assert_eq!(one("120px,340px=1m,2m").unwrap().at, MarkedAt::Pixels(Point::new(120.0, 340.0)));
        assert!(
            matches!(one("0mm,0mm=12deg,-3deg").unwrap().wall, OnWall::Angles(angle) if angle.tilt < 0.0)
        );
        assert_eq!(marks("0mm,0mm=0m,0m 1m,0m=1m,0m").unwrap().0.len(), 2);
        assert_eq!(marks("0 mm,0mm=0m,0m; 1m,0m=1m,0m").unwrap().0.len(), 2);
        for (text, why) in [
            ("0mm,0mm", "has no ="),
            ("0mm=1m,1m", "is no pair"),
            ("0,0=1m,1m", "has no unit"),
            ("0mm,0mm=1m,3deg", "does not fit"),
            ("5px,3mm=1m,3m", "does not fit"),
        ] {
            let error = marks(text).unwrap_err();
            assert!(error.contains(why) && error.contains("X,Y=U,V"), "{text}: {error}");
        }
    }

    #[test]
    fn an_area_has_four_lengths_and_all_else_is_a_layer() {
        assert_eq!(no_go("10cm,-20cm,8cm,1m"), Ok(NoGo::Area(Vec2::new(0.1, -0.2), Vec2::new(0.08, 1.0))));
        assert_eq!(no_go("DOORS"), Ok(NoGo::Layer("DOORS".into())));
        assert_eq!(no_go("a,b,c,d"), Ok(NoGo::Layer("a,b,c,d".into())));
        assert!(no_go("10cm,20cm").unwrap_err().contains("X,Y,W,H"));
        assert!(no_go("1cm,2cm,0cm,3cm").unwrap_err().contains("above zero"));
        assert!(no_go("1cm,2cm,3,3cm").unwrap_err().contains("no unit"));
    }
}
