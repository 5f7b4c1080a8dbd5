//! What a camera saw, as figures that scripts read.

use serde::Serialize;
use tracelight_task::counted;

/// What a camera saw of a job: `camera` of its summary.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EyeFigures {
    /// Which camera.
    pub source: String,
    /// Markers it saw.
    pub markers: usize,
    /// How far they are from where they should be, root of the mean square, px; `null` where there were none and it was believed to
    /// stand where it stood.
    pub markers_rms_px: Option<f64>,
    /// Images that were refused.
    pub refused_images: u32,
    /// How a head that was just powered up was homed; `null` where it was homed before.
    pub homed: Option<HomedFigures>,
    /// The head as dots told it; `null` where it was known before.
    pub head: Option<HeadFigures>,
    /// What was seen of the spot while it drew; `null` where nobody looked.
    pub follow: Option<FollowFigures>,
    /// How far the lit trace truly is from the figure on the wall; `null` where nobody knows.
    pub figure_mm: Option<FigureMatch>,
}

impl EyeFigures {
    /// What was seen, a line each.
    pub fn words(&self) -> Vec<String> {
        let mut camera = match self.markers_rms_px {
            Some(px) => format!("camera: {} markers, {px:.3} px off, rms", self.markers),
            None => "camera: believed to stand where it was calibrated, no markers are in sight".to_owned(),
        };
        if let Some(head) = &self.head {
            camera += &format!(
                "; head found from {} dots in {} images, {:.3} mm off, rms",
                head.dots, head.spots, head.rms_mm
            );
        }
        let homed = self.homed.map(|homed| format!("homed: {}", homed.words()));
        let figure = self.figure_mm.as_ref().map(|figure| {
            format!(
                "figure: the light is {:.3} mm from it, rms, 99 % within {:.3} mm, on {:.1} % of it (known because the room is simulated)",
                figure.rms,
                figure.p99,
                100.0 * figure.covered_share
            )
        });
        let follow = self.follow.iter().flat_map(FollowFigures::words);
        [camera].into_iter().chain(homed).chain(follow).chain(figure).collect()
    }
}

/// See [`EyeFigures::follow`].
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FollowFigures {
    /// Whether what was off was trimmed.
    pub closed: bool,
    /// Images in which the spot was seen.
    pub spots: usize,
    /// Images in which it was not where it should have been.
    pub lost_images: usize,
    /// How far it was seen from where it was asked to be; `null` if it was not seen.
    pub off_mm: Option<SeenOff>,
    /// What was trimmed in the end.
    pub trim: TrimFigures,
    /// Dots by which a head that was jolted was looked after.
    pub checks: usize,
    /// What was suddenly off, and found again.
    pub recoveries: Vec<RecoveryFigures>,
    /// What was said on the way.
    pub remarks: Vec<String>,
}

/// See [`FollowFigures::off_mm`]; by the camera alone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SeenOff {
    /// Root of the mean square.
    pub rms: f64,
    /// Ninety-nine of a hundred are nearer.
    pub p99: f64,
    /// The furthest.
    pub max: f64,
}

impl SeenOff {
    /// Of distances, mm.
    pub fn of(mut mm: Vec<f64>) -> Option<Self> {
        mm.sort_by(f64::total_cmp);
        let max = *mm.last()?;
        let p99 = mm[((mm.len() - 1) as f64 * 0.99).round() as usize];
        let rms = (mm.iter().map(|v| v * v).sum::<f64>() / mm.len() as f64).sqrt();
        Some(Self { rms, p99, max })
    }
}

/// See [`FollowFigures::trim`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct TrimFigures {
    /// Of pan's zero.
    pub pan_mrad: f64,
    /// Of tilt's zero.
    pub tilt_mrad: f64,
    /// Of pan's angles.
    pub pan_scale_percent: f64,
    /// Of tilt's angles.
    pub tilt_scale_percent: f64,
}

/// See [`FollowFigures::recoveries`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RecoveryFigures {
    /// Since power-up.
    pub t_s: f64,
    /// What was off, in words.
    pub what: String,
    /// Dots that were drawn.
    pub dots: usize,
    /// How long nothing was drawn.
    pub lasted_s: f64,
}

impl FollowFigures {
    /// What was seen, a line each.
    #[must_use]
    pub fn words(&self) -> Vec<String> {
        let seen = match &self.off_mm {
            Some(SeenOff { rms, p99, max }) => format!(
                "spot: seen in {} images {rms:.3} mm from where it was asked to be, rms, 99 % within {p99:.3} mm, {max:.3} mm at most{}",
                self.spots,
                if self.closed { "" } else { "; the loop was open" }
            ),
            None => "spot: never seen while it drew".to_owned(),
        };
        std::iter::once(seen).chain(self.remarks.iter().cloned()).collect()
    }
}

/// See [`EyeFigures::homed`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HomedFigures {
    /// Dots that were lit until one was seen.
    pub sought: usize,
    /// How often something was in a joint's way meanwhile.
    pub stops: usize,
    /// Where pan's zero is, from where it was powered up, counts.
    pub pan_counts: i32,
    /// Where tilt's is.
    pub tilt_counts: i32,
}

impl HomedFigures {
    /// How it was homed, in words.
    #[must_use]
    pub fn words(&self) -> String {
        let dots = match self.sought {
            1 => "the first dot was in sight".to_owned(),
            n => format!("dot {n} was in sight"),
        };
        let stops = match self.stops {
            0 => String::new(),
            n => format!(", something was in its way {}", counted(n, "time")),
        };
        format!(
            "{dots}{stops}; zero is {:+} and {:+} counts from where it was powered up, pan and tilt",
            self.pan_counts, self.tilt_counts
        )
    }
}

/// See [`EyeFigures::head`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HeadFigures {
    /// Dots that were drawn.
    pub dots: usize,
    /// Images in which they were seen.
    pub spots: usize,
    /// How far they are from where the head as found has them.
    pub rms_mm: f64,
    /// How far off the spot is likely to be with both joints at zero.
    pub straight_ahead_mm: Option<f64>,
    /// How far off it truly is over the picture's place, root of the mean square; `null` where nobody knows.
    pub truth_rms_mm: Option<f64>,
    /// At most.
    pub truth_max_mm: Option<f64>,
}

/// See [`EyeFigures::figure_mm`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FigureMatch {
    /// Root of the mean square.
    pub rms: f64,
    /// Ninety-nine of a hundred are nearer.
    pub p99: f64,
    /// The furthest.
    pub max: f64,
    /// Share of the figure that was lit.
    pub covered_share: f64,
}
