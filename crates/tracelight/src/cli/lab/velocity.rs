use std::fmt::Write;
use std::ops::ControlFlow;

use clap::Args;
use tracelight_chart::{Colour, Curve, Figure, Key, Panel, Pen, Scale, Theme};
use tracelight_lab::{Peaks, VelocityError, highest, peaks, peaks_seen, velocity_error};
use tracelight_pipeline::Driving;
use tracelight_rig::{Joint, PanTilt, TICK_F64_S};
use tracelight_sim::{LONGEST_INTERVAL_TICKS, ObserverName, Run, SimulatedRig};
use tracelight_task::{Failure, Stop, Task};
use tracelight_units as units;
use tracelight_units::{Speed, TIMES};

use super::shape::ShapeArgs;
use super::{OutFile, out_file, why_unfinished, write_all};
use crate::bar::Bar;
use crate::cli::driving::positive_speed;
use crate::cli::{Answer, Voice};

/// Ask of each way to tell velocity and acceleration from counts how far off it is, by interval and speed
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab velocity --speeds 0.1ft/s,1ft/s,3ft/s -o velocity.svg\n\n\
                  The head draws the shape once at each speed; its counts, edges and volts are then played to every observer, and \
                  what it says is compared with the truth. The interval is the time over which counts or edges are compared; \
                  washout and tracking-loop have a corner at its reciprocal.")]
pub(crate) struct VelocityArgs {
    #[command(flatten)]
    shape: ShapeArgs,
    /// Speeds of the lit spot
    #[arg(long, value_name = "SPEED,…", value_delimiter = ',', default_value = "0.03ft/s,0.1ft/s,0.3ft/s,1ft/s,3ft/s", value_parser = positive_speed)]
    speeds: Vec<Speed>,
    /// Intervals, whole milliseconds
    #[arg(long, value_name = "TIME,…", value_delimiter = ',', default_value = "1ms,2ms,5ms,10ms,20ms,40ms,64ms", value_parser = interval)]
    intervals: Vec<usize>,
    /// Seed of what differs from head to head
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Plot the errors over interval and speed into an SVG or PNG, or write a row each to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    pub(super) voice: Voice,
}

/// An interval in ticks.
pub(super) fn interval(text: &str) -> Result<usize, String> {
    let time_s = units::parse(text, TIMES).map_err(|e| e.to_string())?;
    let ticks = (time_s / TICK_F64_S).round();
    if (ticks * TICK_F64_S - time_s).abs() < 1e-9 && (1.0..=LONGEST_INTERVAL_TICKS as f64).contains(&ticks) {
        Ok(ticks as usize)
    } else {
        Err(format!("{text} is not a whole number of milliseconds from 1ms to {LONGEST_INTERVAL_TICKS}ms"))
    }
}

/// Those that have an interval.
const WITH_INTERVAL: [ObserverName; 4] =
    [ObserverName::Differences, ObserverName::Washout, ObserverName::EdgeTimes, ObserverName::TrackingLoop];

/// One observer at one interval: its error at every speed.
struct Row {
    observer: ObserverName,
    interval_ticks: usize,
    errors: Vec<VelocityError>,
}

impl Row {
    /// Geometric mean over the speeds, rad/s: what is wrong by half counts the same at every speed.
    fn overall(&self) -> f64 {
        let logs = self.errors.iter().map(|error| error.velocity_rms_rad_s.max(1e-12).ln());
        (logs.sum::<f64>() / self.errors.len().max(1) as f64).exp()
    }
}

pub(crate) fn run(args: &VelocityArgs, stop: &Stop) -> Result<Answer, Failure> {
    let bar = Bar::new(args.voice.quiet);
    let task = Task { progress: &bar, stop };
    let mut driving = args.shape.resolve()?;
    let mut runs = Vec::new();
    task.stage("runs", args.speeds.len() as u64);
    for (number, speed) in args.speeds.iter().enumerate() {
        stop.check()?;
        driving.request.speed_m_s = speed.0;
        driving.asked.speed = true;
        runs.push(draw(args, &driving)?);
        task.at(number as u64 + 1);
    }
    let rows = rows(args, &driving, &runs, stop)?;
    let seen = highest(runs.iter().map(|run| peaks_seen(&driving.rig, run, ObserverName::Kalman, 1)));
    let truly = highest(runs.iter().map(peaks));
    let found = Found { args, driving: &driving, rows: &rows, seen, truly };
    write_all(&args.out, || found.figure(), || Ok(found.csv()))?;
    Ok(Answer::new(found.table(), found.json()))
}

fn draw(args: &VelocityArgs, driving: &Driving) -> Result<Run, Failure> {
    let plan = args.shape.plan(driving)?;
    // hops would be all that is seen of a slow motion
    let mut rig = SimulatedRig::new(&driving.rig.following(), driving.pose, args.seed);
    let run = tracelight_sim::run(&mut rig, &plan, false, |_, _| ControlFlow::Continue(()));
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

fn rows(args: &VelocityArgs, driving: &Driving, runs: &[Run], stop: &Stop) -> Result<Vec<Row>, Failure> {
    let with = WITH_INTERVAL
        .into_iter()
        .flat_map(|observer| args.intervals.iter().map(move |&interval| (observer, interval)));
    let without = [ObserverName::KalmanModel, ObserverName::Kalman].map(|observer| (observer, 1));
    let mut rows = Vec::new();
    for (observer, interval_ticks) in with.chain(without) {
        stop.check()?;
        let error = |run| velocity_error(&driving.rig, run, observer, interval_ticks);
        rows.push(Row { observer, interval_ticks, errors: runs.iter().map(error).collect() });
    }
    Ok(rows)
}

/// All that is shown.
struct Found<'a> {
    args: &'a VelocityArgs,
    driving: &'a Driving,
    rows: &'a [Row],
    /// Highest rates that the default law's observer saw at any speed,
    seen: PanTilt<Peaks>,
    /// and what they truly were.
    truly: PanTilt<Peaks>,
}

impl Found<'_> {
    /// The best interval of each observer.
    fn recommended(&self) -> Vec<&Row> {
        let best = |observer: ObserverName| {
            let of = self.rows.iter().filter(|row| row.observer == observer);
            of.min_by(|a, b| a.overall().total_cmp(&b.overall()))
        };
        let all = WITH_INTERVAL.into_iter().chain([ObserverName::KalmanModel, ObserverName::Kalman]);
        all.filter_map(best).collect()
    }

    fn table(&self) -> String {
        let stamps = if self.driving.rig.truth.model.encoder.edge_stamps { "stamped" } else { "not stamped" };
        let mut text = format!(
            "{} on rig {}, edges {stamps}; error of the velocity while lit, rms over both joints, rad/s\n\n{:14} {:>10}",
            self.args.shape.shape, self.driving.rig.name, "observer", "best at"
        );
        self.args.speeds.iter().for_each(|speed| text += &format!("{:>11}", in_words(*speed)));
        for row in self.recommended() {
            text += &format!("\n{:14} {:>10}", row.observer.name(), interval_of(row));
            row.errors.iter().for_each(|error| text += &format!("{:11.5}", error.velocity_rms_rad_s));
        }
        text += "\n\nerror of the acceleration, rad/s²\n";
        for row in self.recommended() {
            text += &format!("\n{:14} {:>10}", row.observer.name(), interval_of(row));
            row.errors.iter().for_each(|error| text += &format!("{:11.3}", error.acceleration_rms_rad_s2));
        }
        text += "\n\nhighest:";
        for joint in Joint::BOTH {
            let (seen, truly) = (self.seen[joint], self.truly[joint]);
            // writing to a String cannot fail
            let _ = write!(
                text,
                " {joint} {:.3} rad/s and {:.2} rad/s² seen ({:.3} and {:.2} true){}",
                seen.velocity_rad_s,
                seen.acceleration_rad_s2,
                truly.velocity_rad_s,
                truly.acceleration_rad_s2,
                if joint == Joint::Pan { ";" } else { "" }
            );
        }
        text
    }

    fn json(&self) -> String {
        let recommended: serde_json::Map<_, _> = self
            .recommended()
            .iter()
            .filter(|row| WITH_INTERVAL.contains(&row.observer))
            .map(|row| (row.observer.name().to_owned(), (row.interval_ticks as f64).into()))
            .collect();
        let errors: Vec<_> = self
            .entries()
            .map(|(row, speed, error)| {
                serde_json::json!({
                    "observer": row.observer.name(),
                    "interval_ms": WITH_INTERVAL.contains(&row.observer).then_some(row.interval_ticks),
                    "speed_m_s": speed,
                    "velocity_rms_rad_s": error.velocity_rms_rad_s,
                    "velocity_max_rad_s": error.velocity_max_rad_s,
                    "acceleration_rms_rad_s2": error.acceleration_rms_rad_s2,
                })
            })
            .collect();
        let highest = |joint: Joint| {
            let (seen, truly) = (self.seen[joint], self.truly[joint]);
            serde_json::json!({
                "velocity_rad_s": seen.velocity_rad_s, "acceleration_rad_s2": seen.acceleration_rad_s2,
                "true_velocity_rad_s": truly.velocity_rad_s, "true_acceleration_rad_s2": truly.acceleration_rad_s2,
            })
        };
        serde_json::json!({
            "recommended_interval_ms": recommended,
            "highest": { "pan": highest(Joint::Pan), "tilt": highest(Joint::Tilt) },
            "errors": errors,
        })
        .to_string()
    }

    /// Every row at every speed, m/s.
    fn entries(&self) -> impl Iterator<Item = (&Row, f64, &VelocityError)> {
        let speeds = &self.args.speeds;
        self.rows.iter().flat_map(move |row| row.errors.iter().zip(speeds).map(move |(e, v)| (row, v.0, e)))
    }

    fn csv(&self) -> String {
        let mut text = String::from(
            "observer,interval_s,speed_m_s,velocity_rms_rad_s,velocity_max_rad_s,acceleration_rms_rad_s2\n",
        );
        for (row, speed, error) in self.entries() {
            let interval = if WITH_INTERVAL.contains(&row.observer) {
                format!("{:.3}", row.interval_ticks as f64 * TICK_F64_S)
            } else {
                String::new()
            };
            let _ = writeln!(
                text,
                "{},{interval},{speed:.6},{:.7},{:.7},{:.5}",
                row.observer.name(),
                error.velocity_rms_rad_s,
                error.velocity_max_rad_s,
                error.acceleration_rms_rad_s2
            );
        }
        text
    }

    fn figure(&self) -> Result<String, Failure> {
        let key = |(number, speed): (usize, &Speed)| Key { colour: colour(number), name: in_words(*speed) };
        let velocity: ErrorValue = |e| e.velocity_rms_rad_s;
        let acceleration: ErrorValue = |e| e.acceleration_rms_rad_s2;
        let panels = WITH_INTERVAL.into_iter().flat_map(|observer| {
            [
                self.panel(observer, format!("{}: velocity, rad/s", observer.name()), velocity),
                self.panel(observer, format!("{}: acceleration, rad/s²", observer.name()), acceleration),
            ]
        });
        let figure = Figure {
            title: "Error rms of velocity and acceleration over the interval (dashed: the Kalman filter)"
                .into(),
            legend: self.args.speeds.iter().enumerate().map(key).collect(),
            panels: panels.collect(),
            columns: 2,
            panel: (520, 260),
            theme: Theme::Light,
        };
        figure.svg().map_err(|e| Failure::failed("internal", e))
    }

    fn panel(&self, observer: ObserverName, title: String, value: ErrorValue) -> Panel {
        let rows: Vec<&Row> = self.rows.iter().filter(|row| row.observer == observer).collect();
        let kalman = self.rows.iter().find(|row| row.observer == ObserverName::Kalman);
        let at = |row: &Row| row.interval_ticks as f64;
        let mut curves = Vec::new();
        for number in 0..self.args.speeds.len() {
            let points = rows.iter().map(|row| (at(row), value(&row.errors[number])));
            curves.push(Curve { colour: colour(number), pen: Pen::Solid, points: points.collect() });
            let flat = kalman.iter().flat_map(|k| rows.iter().map(|row| (at(row), value(&k.errors[number]))));
            curves.push(Curve { colour: colour(number), pen: Pen::Dashed, points: flat.collect() });
        }
        Panel {
            x_title: "interval, ms".into(),
            y_title: title,
            curves,
            levels: Vec::new(),
            scale: Scale::Log,
            ..Panel::default()
        }
    }
}

/// An error that is plotted.
type ErrorValue = fn(&VelocityError) -> f64;

fn interval_of(row: &Row) -> String {
    if WITH_INTERVAL.contains(&row.observer) {
        format!("{} ms", row.interval_ticks)
    } else {
        "–".to_owned()
    }
}

fn in_words(speed: Speed) -> String {
    format!("{:.4} m/s", speed.0)
}

/// The colour of a speed, slowest first.
const fn colour(number: usize) -> Colour {
    const COLOURS: [Colour; 6] =
        [Colour::Black, Colour::Blue, Colour::Green, Colour::Orange, Colour::Vermilion, Colour::Purple];
    COLOURS[number % COLOURS.len()]
}
