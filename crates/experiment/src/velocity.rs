//! How far off each way is to tell velocity and acceleration from counts, by interval and speed.

mod view;

use std::ops::ControlFlow;

use tracelight_lab::{Peaks, VelocityError, highest, peaks, peaks_seen, velocity_error};
use tracelight_maths::{exp, ln};
use tracelight_pipeline::Driving;
use tracelight_rig::PanTilt;
use tracelight_sim::{ObserverName, RigConfig, Run, SimulatedRig};
use tracelight_task::{Failure, Task};
use tracelight_trajectory::Plan;

use crate::finding::Experiment;
use crate::numbers::why_unfinished;
use crate::shape::Shape;

/// A shape that is drawn at several speeds, and what of it is played to observers.
#[derive(Clone, Debug)]
pub struct Request {
    /// What is drawn.
    pub shape: Shape,
    /// By what, and how; its speed is one of `speeds_m_s` each time.
    pub driving: Driving,
    /// Speeds of the lit spot, m/s.
    pub speeds_m_s: Vec<f64>,
    /// Over how long observers compare that have such a time, ticks.
    pub intervals_ticks: Vec<usize>,
    /// Of what differs from head to head.
    pub seed: u64,
}

/// What each observer said at each speed, beside the truth.
pub struct Finding {
    shape: String,
    rig: RigConfig,
    speeds_m_s: Vec<f64>,
    rows: Vec<Row>,
    /// Highest rates that the default law's observer saw at any speed,
    seen: PanTilt<Peaks>,
    /// and what they truly were.
    truly: PanTilt<Peaks>,
}

/// Those that have an interval.
const WITH_INTERVAL: [ObserverName; 4] =
    [ObserverName::Differences, ObserverName::Washout, ObserverName::EdgeTimes, ObserverName::TrackingLoop];

/// Those that have none.
const WITHOUT_INTERVAL: [ObserverName; 2] = [ObserverName::KalmanModel, ObserverName::Kalman];

/// One observer at one interval: its error at every speed.
struct Row {
    observer: ObserverName,
    interval_ticks: usize,
    errors: Vec<VelocityError>,
}

impl Row {
    /// Geometric mean over the speeds, rad/s: what is wrong by half counts the same at every speed.
    fn overall(&self) -> f64 {
        let logs = self.errors.iter().map(|error| ln(error.velocity_rms_rad_s.max(1e-12)));
        exp(logs.sum::<f64>() / self.errors.len().max(1) as f64)
    }
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(mut self, task: Task<'_>) -> Result<Finding, Failure> {
        let name = self.shape.name().to_owned();
        let mut runs = Vec::new();
        task.stage("runs", self.speeds_m_s.len() as u64);
        task.check()?;
        let shape = self.shape.on_target()?;
        for (number, &speed_m_s) in self.speeds_m_s.iter().enumerate() {
            task.check()?;
            self.driving.request.speed_m_s = speed_m_s;
            self.driving.asked.speed = true;
            runs.push(draw(&self.driving, &shape.plan(&self.driving)?, self.seed)?);
            task.at(number as u64 + 1);
        }
        let rig = self.driving.rig;
        let rows = rows(&rig, &runs, &self.intervals_ticks, task)?;
        let seen = highest(runs.iter().map(|run| peaks_seen(&rig, run, ObserverName::Kalman, 1)));
        let truly = highest(runs.iter().map(peaks));
        Ok(Finding { shape: name, rig, speeds_m_s: self.speeds_m_s, rows, seen, truly })
    }
}

fn draw(driving: &Driving, plan: &Plan, seed: u64) -> Result<Run, Failure> {
    // hops would be all that is seen of a slow motion
    let mut rig = SimulatedRig::new(&driving.rig.following(), driving.pose, seed);
    let run = tracelight_sim::run(&mut rig, plan, false, |_, _| ControlFlow::Continue(()));
    if run.is_done() {
        return Ok(run);
    }
    let message = format!(
        "the head did not finish at {:.4} m/s ({}), so there is nothing to compare with; choose another --law or speed",
        driving.request.speed_m_s,
        why_unfinished(run.fault())
    );
    Err(Failure::failed("unfinished", message))
}

fn rows(
    rig: &RigConfig,
    runs: &[Run],
    intervals_ticks: &[usize],
    task: Task<'_>,
) -> Result<Vec<Row>, Failure> {
    let with = WITH_INTERVAL
        .into_iter()
        .flat_map(|observer| intervals_ticks.iter().map(move |&interval| (observer, interval)));
    let without = WITHOUT_INTERVAL.map(|observer| (observer, 1));
    let mut rows = Vec::new();
    for (observer, interval_ticks) in with.chain(without) {
        task.check()?;
        let error = |run| velocity_error(rig, run, observer, interval_ticks);
        rows.push(Row { observer, interval_ticks, errors: runs.iter().map(error).collect() });
    }
    Ok(rows)
}

impl Finding {
    /// The best interval of each observer.
    fn recommended(&self) -> Vec<&Row> {
        let best = |observer: ObserverName| {
            let of = self.rows.iter().filter(|row| row.observer == observer);
            of.min_by(|a, b| a.overall().total_cmp(&b.overall()))
        };
        WITH_INTERVAL.into_iter().chain(WITHOUT_INTERVAL).filter_map(best).collect()
    }

    /// Every row at every speed, m/s.
    fn entries(&self) -> impl Iterator<Item = (&Row, f64, &VelocityError)> {
        let speeds = &self.speeds_m_s;
        self.rows.iter().flat_map(move |row| row.errors.iter().zip(speeds).map(move |(e, &v)| (row, v, e)))
    }
}
