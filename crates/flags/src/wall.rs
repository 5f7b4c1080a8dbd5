//! Where on a wall a drawing goes: the flags of every command that places one.

use clap::{Args, ValueEnum};
use tracelight_pipeline::{
    Corner, DEFAULT_DISTANCE_M, Driving, Fit, NoGo, Origin, Placing, TypedMark, spot_radius_m, typed_marks,
    typed_no_go,
};
use tracelight_stroke::Point;
use tracelight_task::Failure;
use tracelight_units::Offset;

/// Where on a wall a drawing goes, and where it must not.
#[derive(Args, Clone, Debug, Default)]
pub struct WallArgs {
    /// A mark of the drawing, and where it belongs on the wall: "X,Y=U,V", such as "0mm,0mm=1.2m,0.4m"; give it again for more marks. X,Y: of a DXF or
    /// CSV its own coordinates; of an SVG and a picture from the top left, such as "120px,340px". U,V: right and up of the target's middle, or from the
    /// edges that --from names; or the joint angles pan,tilt at which the head's dot is on the mark, such as "12deg,-3deg". One mark sets the place, two
    /// also turn and size (with --width they check it), three skew, four keystone; more are averaged
    #[arg(long, value_name = "X,Y=U,V", allow_hyphen_values = true, value_parser = marks)]
    pub align: Vec<Marks>,
    #[command(flatten)]
    #[allow(missing_docs, reason = "a comment here would be the group's help")]
    pub from: FromArgs,
    /// What --width, --height and --offset are those of: the page with its margins, or the drawing on it
    #[arg(long, value_enum, default_value_t)]
    pub fit: FitName,
    /// Never lit: the closed paths on a layer of the drawing, which are not drawn; or an area of the wall by its corner and size, such as 10cm,20cm,8cm,8cm.
    /// Strokes are cut there, and dark moves may pass. Give it again for more
    #[arg(long, value_name = "LAYER|X,Y,W,H", allow_hyphen_values = true, value_parser = typed_no_go)]
    pub no_go: Vec<NoGo>,
}

/// From where places on a wall are measured.
#[derive(Args, Clone, Copy, Debug, Default)]
pub struct FromArgs {
    /// What places on the wall (--offset, U,V of --align, --no-go, X,Y of `point`) are measured from: an edge corner of the wall, inwards, so that bottom-left measures from the left edge and
    /// from the floor. --offset then goes to the same corner of the drawing
    #[arg(long, value_enum, value_name = "CORNER")]
    from: Option<CornerName>,
    /// Where that corner of the wall is, right and up of the point straight ahead of the head: -1.5m,-1.2m [default: by the head file of `calibrate corners`,
    /// else straight ahead]
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, requires = "from")]
    origin: Option<Offset>,
}

/// A corner of a wall, or its middle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum CornerName {
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
pub enum FitName {
    /// What is drawn, without the empty margins
    Drawing,
    /// All of the picture or page
    #[default]
    Page,
}

/// Marks of one flag.
#[derive(Clone, Debug, PartialEq)]
pub struct Marks(Vec<TypedMark>);

impl WallArgs {
    /// Whether any of it is asked for.
    pub const fn is_given(&self) -> bool {
        !self.align.is_empty()
            || self.from.from.is_some()
            || !self.no_go.is_empty()
            || matches!(self.fit, FitName::Drawing)
    }

    /// Adds what they mean to where a drawing goes otherwise; `area_m` is what is known of the wall: its width and height about the target's middle.
    pub fn placing(
        &self,
        placing: Placing,
        driving: Option<&Driving>,
        area_m: Option<(f64, f64)>,
    ) -> Result<Placing, Failure> {
        let corner = self.from.from.map_or(Corner::Centre, CornerName::corner);
        let told = self.from.origin.map(|Offset(x, y)| Point::new(x.0, y.0));
        let from = Origin { corner, at: told.or_else(|| area_m.map(|size| corner.of_centred(size))) };
        self.check(&placing)?;
        let marks = self.align.iter().flat_map(|marks| &marks.0).map(|mark| mark.placed(&from, driving));
        let areas = self.no_go.iter().filter_map(|no_go| no_go.area(&from));
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
        placing.choice.no_go = self.no_go.iter().filter_map(NoGo::layer).collect();
        Ok(placing)
    }

    /// What was set, flag and value; nothing where nothing was.
    pub fn settings(&self) -> Vec<(&'static str, String)> {
        let mut rows = Vec::new();
        let marks = self.align.iter().flat_map(|marks| &marks.0).map(|mark| mark.text.as_str());
        let marks = marks.collect::<Vec<_>>().join(" ");
        let no_go = self.no_go.iter().map(NoGo::to_string).collect::<Vec<_>>().join("; ");
        rows.extend((!marks.is_empty()).then_some(("marks", marks)));
        rows.extend(self.from.from.map(|from| ("measured from", from.corner().name().to_owned())));
        rows.extend(self.from.origin.map(|Offset(x, y)| ("where that is", format!("{x}, {y}"))));
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

fn marks(text: &str) -> Result<Marks, String> {
    typed_marks(text).map(Marks)
}
