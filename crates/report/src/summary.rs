//! A job's figures, as `summary.json` and `--json` have them.

use serde::Serialize;
use tracelight_eye::figures::EyeFigures;
use tracelight_pipeline::{AlignFigures, LeftOut, QualityFigures, Standing};
use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::{LightFrom, Run};
use tracelight_stroke::Drawing;
use tracelight_trajectory::Plan;

use crate::events::{Event, events};
use crate::finished::{Finished, PointFigures};
use crate::sample::lit_s;

/// The figures of a job: `summary.json` and the `--json` of `trace`. Lengths in m unless the name says mm.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// What was traced.
    pub picture: PictureFigures,
    /// What its pixels are worth; `null` for a vector file.
    pub quality: Option<QualityFigures>,
    /// Where.
    pub target: TargetFigures,
    /// How the head stands to it.
    pub head: Standing,
    /// How it lies by its marks; not there without any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub align: Option<AlignFigures>,
    /// What of it is left out of no-go areas; not there without any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub no_go: Option<LeftOut>,
    /// The points that it marked; not there where it drew strokes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<PointFigures>,
    /// What it became.
    pub strokes: StrokeFigures,
    /// What was meant to happen.
    pub plan: PlanFigures,
    /// Whether it was done, and how long that took.
    pub run: RunFigures,
    /// What happened instead.
    pub tracking: TrackingFigures,
    /// Light and what kept it away.
    pub laser: LaserFigures,
    /// What a camera saw; not there where none looked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub camera: Option<EyeFigures>,
    /// The run log that these are the figures of; not there where none was kept.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub log: Option<LogFigures>,
    /// Remarks and warnings, one sentence or two each.
    pub notes: Vec<String>,
    /// Nothing of this was measured on a head: the rig was one of equations.
    pub simulated: bool,
    /// Who tells where the spot was, and so what the errors are of: `simulation`; `encoders` where nobody saw the light, `commands` where nobody
    /// measured the head either.
    #[serde(serialize_with = "by_name")]
    pub light_from: LightFrom,
    /// Wall-clock time of the stages, ms.
    pub timing_ms: TimingFigures,
    /// Seed of the run.
    pub seed: u64,
    /// Version of the program.
    pub version: &'static str,
}

/// See [`Summary::picture`]; sizes are `null` for a vector file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PictureFigures {
    pub path: String,
    pub width_px: Option<u32>,
    pub height_px: Option<u32>,
}

/// See [`Summary::target`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TargetFigures {
    pub width_m: f64,
    pub height_m: f64,
    pub distance_m: f64,
}

/// See [`Summary::strokes`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StrokeFigures {
    /// How many.
    pub count: usize,
    /// How long all of them are.
    pub length_m: f64,
    /// How far the spot goes in the dark.
    pub travel_m: f64,
}

/// See [`Summary::plan`]; `speed_m_s` is the mean planned speed while lit, `set_speed_m_s` what lit strokes are run at where
/// nothing holds them back.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PlanFigures {
    /// Of all of it.
    pub duration_s: f64,
    /// Of what is lit.
    pub lit_s: f64,
    /// In the mean while lit.
    pub speed_m_s: f64,
    /// Where nothing holds it back.
    pub set_speed_m_s: f64,
    /// Most torque, as a share of what the motor has.
    pub torque_peak_fraction: f64,
}

/// See [`Summary::run`]; of the last lap.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RunFigures {
    pub duration_s: f64,
    pub finished: bool,
    pub lost_counts: JointCounts,
}

/// One figure a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct JointCounts {
    pub pan: i32,
    pub tilt: i32,
}

/// See [`Summary::tracking`] and [`tracelight_sim::Tracking`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TrackingFigures {
    pub rms_mm: f64,
    pub max_mm: f64,
    pub off_stroke_rms_mm: f64,
    pub off_stroke_max_mm: f64,
    pub overshoot_percent: f64,
    /// `None` of a run that ended before its drawing did: nothing rests there.
    pub final_error_mm: Option<f64>,
    pub lit_speed_m_s: f64,
    pub at_speed_share: f64,
}

/// See [`Summary::laser`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LaserFigures {
    pub lit_s: f64,
    pub faults: Vec<FaultFigures>,
}

/// A fault, or a darkening by the interlock.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FaultFigures {
    pub code: &'static str,
    pub t_s: f64,
    pub lasted_s: f64,
    pub stops: bool,
    /// Joint that showed it, where one did.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joint: Option<&'static str>,
    /// What was measured of a fault, what it may be, and the unit of both, where that is a number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bound: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<&'static str>,
    /// How far what the head stands on was turned, about the head's x, y and z (ahead, left, up), by its gyroscope.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub foot_turned_deg: Option<[f64; 3]>,
}

/// See [`Summary::log`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LogFigures {
    /// Its name in the folder of the summary.
    pub file: &'static str,
    /// How long it is.
    pub bytes: u64,
    /// Of all of it, in hexadecimal digits.
    pub sha256: String,
}

/// See [`Summary::timing_ms`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TimingFigures {
    pub vision: f64,
    pub plan: f64,
    pub run: f64,
    pub report: f64,
}

impl Summary {
    /// All figures of a job.
    pub fn new(job: &Finished<'_>) -> Self {
        Self {
            picture: picture(job),
            quality: job.quality.map(QualityFigures::of),
            target: TargetFigures {
                width_m: round(job.target.width_m),
                height_m: round(job.target.height_m),
                distance_m: round(job.target.distance_m),
            },
            head: job.standing,
            align: job.align.cloned(),
            no_go: job.left_out,
            points: job.points,
            strokes: StrokeFigures::of(job.drawing, job.plan),
            plan: PlanFigures::of(job.plan),
            run: RunFigures::of(job.run, job.finished),
            tracking: tracking(job),
            laser: LaserFigures {
                lit_s: round(lit_s(job.run)),
                faults: events(job.run).iter().map(FaultFigures::new).collect(),
            },
            camera: job.eye.clone(),
            log: None,
            notes: job.notes.to_vec(),
            simulated: job.origin.simulated,
            light_from: job.origin.light_from,
            timing_ms: TimingFigures {
                vision: job.timing.vision_ms,
                plan: job.timing.plan_ms,
                run: job.timing.run_ms,
                report: job.timing.report_ms,
            },
            seed: job.seed,
            version: env!("CARGO_PKG_VERSION"),
        }
    }

    /// The figures as JSON text, indented for people.
    #[must_use]
    pub fn json(&self) -> String {
        // numbers, texts and options cannot fail to become JSON
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}

impl FaultFigures {
    fn new(event: &Event) -> Self {
        let told = event.latched.and_then(|record| record.told());
        Self {
            code: event.code,
            t_s: round(event.t_s),
            lasted_s: round(event.lasted_s),
            stops: event.stops,
            joint: event.latched.and_then(|record| record.joint).map(Joint::name),
            value: told.map(|told| round(told.value.into())),
            bound: told.map(|told| round(told.bound.into())),
            unit: told.map(|told| told.unit),
            foot_turned_deg: event
                .foot_turned_rad
                .map(|axes| axes.map(|rad| round(f64::from(rad).to_degrees()))),
        }
    }
}

fn picture(job: &Finished<'_>) -> PictureFigures {
    PictureFigures {
        path: job.picture_path.to_owned(),
        width_px: job.picture.map(|p| p.raster.width()),
        height_px: job.picture.map(|p| p.raster.height()),
    }
}

impl RunFigures {
    fn of(run: &Run, finished: bool) -> Self {
        let lost = run.ticks.last().map(|tick| tick.telemetry.lost_counts).unwrap_or_default();
        Self {
            duration_s: round(run.ticks.len().saturating_sub(1) as f64 * TICK_F64_S),
            finished,
            lost_counts: JointCounts { pan: lost.pan, tilt: lost.tilt },
        }
    }
}

impl StrokeFigures {
    /// Of a drawing in tracing order and its plan.
    pub fn of(drawing: &Drawing, plan: &Plan) -> Self {
        const LENGTH_TOLERANCE_M: f64 = 1e-6;
        let start = plan.points.first().map_or_else(Default::default, |p| p.spot);
        Self {
            count: drawing.strokes.len(),
            length_m: round(drawing.length(LENGTH_TOLERANCE_M)),
            travel_m: round(drawing.travel(start)),
        }
    }
}

impl PlanFigures {
    /// Of a plan.
    #[must_use]
    pub fn of(plan: &Plan) -> Self {
        Self {
            duration_s: round(plan.duration_s()),
            lit_s: round(plan.lit_s()),
            speed_m_s: round(planned_speed(plan)),
            set_speed_m_s: round(plan.set_speed_m_s),
            torque_peak_fraction: round(plan.torque_peak_fraction()),
        }
    }
}

/// Planned way of the lit spot over its time, m/s; zero for a plan without light.
fn planned_speed(plan: &Plan) -> f64 {
    let lit = plan.points.windows(2).filter(|pair| pair[0].lit && pair[1].lit);
    let (way, ticks) =
        lit.fold((0.0, 0_u32), |(way, ticks), pair| (way + pair[0].spot.distance(pair[1].spot), ticks + 1));
    way / (f64::from(ticks.max(1)) * TICK_F64_S)
}

fn tracking(job: &Finished<'_>) -> TrackingFigures {
    let t = &job.tracking;
    TrackingFigures {
        rms_mm: round(t.rms_mm),
        max_mm: round(t.max_mm),
        off_stroke_rms_mm: round(t.off_stroke_rms_mm),
        off_stroke_max_mm: round(t.off_stroke_max_mm),
        overshoot_percent: round(t.overshoot_percent),
        final_error_mm: job.finished.then(|| round(t.final_error_mm)),
        lit_speed_m_s: round(t.lit_speed_m_s),
        at_speed_share: round(t.at_speed_share),
    }
}

fn by_name<S: serde::Serializer>(light_from: &LightFrom, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(light_from.name())
}

/// Six decimals: a micrometre, a nanometre in mm, a microsecond.
pub(crate) fn round(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn the_summary_has_every_name_scripts_rely_on() {
        let fixture = fixture::star();
        let value: serde_json::Value = serde_json::from_str(&Summary::new(&fixture.job()).json()).unwrap();
        let check = |object: &str, names: &[&str]| {
            for name in names {
                assert!(value[object].get(name).is_some(), "{object}.{name}");
            }
        };
        check("picture", &["path", "width_px", "height_px"]);
        check("quality", &["ink_percent", "contrast_percent", "contrast_to_noise", "noise_levels"]);
        check("quality", &["light_evenness", "edge_px", "clipped_percent", "pen_px", "verdict", "remarks"]);
        check("target", &["width_m", "height_m", "distance_m"]);
        check("strokes", &["count", "length_m", "travel_m"]);
        check("plan", &["duration_s", "lit_s", "speed_m_s", "torque_peak_fraction"]);
        check("tracking", &["rms_mm", "max_mm", "overshoot_percent", "final_error_mm"]);
        check("tracking", &["off_stroke_rms_mm", "off_stroke_max_mm", "lit_speed_m_s", "at_speed_share"]);
        check("laser", &["lit_s", "faults"]);
        check("timing_ms", &["vision", "plan", "run", "report"]);
        assert!(value["simulated"] == true && value["light_from"] == "simulation");
        assert!(value["seed"].is_u64() && value["version"].is_string());
    }

    #[test]
    fn the_planned_speed_is_that_of_the_lit_spot() {
        let fixture = fixture::star();
        let speed = Summary::new(&fixture.job()).plan.speed_m_s;
        assert!((speed - fixture::SPEED_M_S).abs() < 2e-3, "{speed}");
    }

    #[test]
    fn a_job_that_never_ran_has_figures_too() {
        let fixture = fixture::nothing();
        let summary = Summary::new(&fixture.job());
        assert_eq!((summary.strokes.count, summary.plan.speed_m_s, summary.laser.lit_s), (0, 0.0, 0.0));
        assert!(summary.json().contains("\"width_px\": null"));
    }
}
