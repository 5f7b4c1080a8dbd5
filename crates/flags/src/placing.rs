use clap::Args;
use tracelight_aim::SizeRequest;
use tracelight_pipeline::Placing;
use tracelight_units::{Angle, Length, Offset};

use crate::choosing::ChoiceArgs;

/// What of a picture is drawn, where and how large it lies on the target.
#[derive(Args, Clone, Debug, Default)]
pub struct PlacementArgs {
    /// Width on the target, such as 24in or 0.6m; the height follows [default: the drawing's own size if the file has one, otherwise
    /// 24in]
    #[arg(long, value_name = "LENGTH", conflicts_with = "height", allow_hyphen_values = true,
          value_parser = positive_length)]
    pub width: Option<Length>,
    /// Height on the target; the width follows
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = positive_length)]
    pub height: Option<Length>,
    /// Offset of the picture's centre from the target's centre, right and up: 10cm,-2in
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true)]
    pub offset: Option<Offset>,
    /// Turn the picture anticlockwise: 15deg
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true)]
    pub rotate: Option<Angle>,
    /// Mirror the picture left to right
    #[arg(long)]
    pub flip: bool,
    #[command(flatten, next_help_heading = "Picture")]
    #[allow(missing_docs, reason = "a comment here would be the group's help")]
    pub choice: ChoiceArgs,
}

impl PlacementArgs {
    /// What they mean.
    pub fn placing(&self) -> Placing {
        let size = match (self.width, self.height) {
            (Some(width), _) => Some(SizeRequest::Width(width.0)),
            (None, Some(height)) => Some(SizeRequest::Height(height.0)),
            (None, None) => None,
        };
        Placing {
            size,
            offset_m: self.offset.map(|o| (o.0.0, o.1.0).into()),
            rotation_rad: self.rotate.map_or(0.0, |a| a.0),
            flip: self.flip,
            choice: self.choice.choice(),
            ..Placing::default()
        }
    }
}

/// A length between a millimetre and a kilometre.
pub fn positive_length(text: &str) -> Result<Length, String> {
    const LEAST_M: f64 = 1e-3;
    const MOST_M: f64 = 1e3;
    let length: Length = text.parse().map_err(|e| format!("{e}"))?;
    if LEAST_M <= length.0 && length.0 <= MOST_M {
        Ok(length)
    } else {
        Err(format!("{text} is not between {LEAST_M} and {MOST_M} m; give a length such as 24in or 0.6m"))
    }
}
