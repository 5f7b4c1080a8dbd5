use std::path::{Path as FilePath, PathBuf};
use std::time::Instant;

use tracelight_stroke::{
    Drawing, Effort, OrderOptions, Ordered, Path, Point, Stroke, StrokeEnd, Travel, order,
};

const EFFORTS: [(&str, Effort); 3] =
    [("quick", Effort::Quick), ("normal", Effort::Normal), ("best", Effort::Best)];

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Files of stroke ends, `x0,y0,x1,y1` a line after the first, in metres.
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// What the order is to save.
    #[arg(long, value_enum, default_value = "distance")]
    by: By,
    /// What a lift costs beside its length, m.
    #[arg(long, default_value_t = 0.0)]
    lift_m: f64,
    /// Only this effort.
    #[arg(long)]
    effort: Option<String>,
    /// How often each is ordered; the shortest time counts.
    #[arg(long, default_value_t = 3)]
    times: u32,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum By {
    Distance,
    Time,
}

/// Prints, for each file and effort, the travel, lifts, time of travel, the bound and the time it took.
///
/// The order starts in the middle of the canvas, where the head rests; the way to the first stroke, which is free for
/// the peers, is left out of the figures.
pub(crate) fn run(arguments: &Arguments) -> Result<(), String> {
    println!(
        "{:20} {:7} {:>9} {:>6} {:>9} {:>8} {:>6} {:>8}",
        "case", "effort", "travel m", "lifts", "travel s", "bound m", "gap %", "took s"
    );
    for file in &arguments.files {
        let drawing = read(file)?;
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        for (effort_name, effort) in EFFORTS {
            if arguments.effort.as_ref().is_some_and(|wanted| wanted != effort_name) {
                continue;
            }
            let (ordered, took_s) = timed(arguments.times, || ordered(&drawing, arguments, effort));
            let seen = travels(&ordered.drawing);
            println!(
                "{name:20} {effort_name:7} {:9.4} {:6} {:9.3} {:8.4} {:6.2} {took_s:8.3}",
                seen.length_m,
                seen.lifts,
                seen.time_s,
                ordered.lower_bound,
                ordered.gap_percent().unwrap_or(f64::NAN),
            );
        }
    }
    Ok(())
}

fn ordered(drawing: &Drawing, arguments: &Arguments, effort: Effort) -> Ordered {
    let options = OrderOptions { effort, seed: 0 };
    let lift_m = arguments.lift_m;
    match arguments.by {
        By::Distance => order(drawing, Point::ORIGIN, options, &|a: Point, b: Point| {
            a.distance(b) + if a == b { 0.0 } else { lift_m }
        }),
        By::Time => order(drawing, Point::ORIGIN, options, &RestToRest),
    }
}

struct Travels {
    length_m: f64,
    lifts: usize,
    time_s: f64,
}

fn travels(drawing: &Drawing) -> Travels {
    let ways = drawing.strokes.windows(2).map(|pair| (pair[0].path.end(), pair[1].path.start()));
    ways.fold(Travels { length_m: 0.0, lifts: 0, time_s: 0.0 }, |sum, (from, to)| Travels {
        length_m: sum.length_m + from.distance(to),
        lifts: sum.lifts + usize::from(from.distance(to) > 1e-9),
        time_s: sum.time_s + rest_to_rest_s(from, to),
    })
}

/// Time of a move from rest to rest, each joint of the 2006 rig at full torque against Coulomb friction alone, 0.9 m
/// from the wall: the measure of the research's table.
struct RestToRest;

fn rest_to_rest_s(from: Point, to: Point) -> f64 {
    let [from, to] = [from, to].map(|at| RestToRest.place(StrokeEnd::resting(at)));
    RestToRest.cost(&from, &to)
}

impl Travel for RestToRest {
    type Place = [f64; 2];

    fn place(&self, end: StrokeEnd) -> [f64; 2] {
        let at = end.point;
        const WALL_M: f64 = 0.9;
        [at.x.atan2(WALL_M), at.y.atan2(at.x.hypot(WALL_M))]
    }

    fn cost(&self, from: &[f64; 2], to: &[f64; 2]) -> f64 {
        const INERTIA: f64 = 0.075;
        const COULOMB_NM: f64 = 0.05;
        const GEARED_NM_PER_A: f64 = 0.0432 * 6.3 * 2.8435;
        let joint = |span: f64, amplifier_a_per_v: f64| {
            let torque = amplifier_a_per_v * 10.0 * GEARED_NM_PER_A;
            let pace = INERTIA / (torque - COULOMB_NM) + INERTIA / (torque + COULOMB_NM);
            (2.0 * span.abs() * pace).sqrt()
        };
        joint(to[0] - from[0], 0.08).max(joint(to[1] - from[1], 0.1))
    }
}

fn timed<T>(times: u32, run: impl Fn() -> T) -> (T, f64) {
    let once = || {
        let start = Instant::now();
        let result = run();
        (result, start.elapsed().as_secs_f64())
    };
    (1..times).fold(once(), |(result, best), _| {
        let (_, seconds) = once();
        (result, best.min(seconds))
    })
}

fn read(file: &FilePath) -> Result<Drawing, String> {
    let text = std::fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))?;
    let stroke = |(number, line): (usize, &str)| {
        let values: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
        let Ok([x0, y0, x1, y1]) = values.as_deref() else {
            return Err(format!("{}:{}: four numbers are needed", file.display(), number + 1));
        };
        let ends = [Point::new(*x0, *y0), Point::new(*x1, *y1)];
        let path = Path::polyline(&ends, false);
        path.map(Stroke::new).ok_or_else(|| format!("{}:{}: no line", file.display(), number + 1))
    };
    let strokes = text.lines().enumerate().skip(1).map(stroke).collect::<Result<_, _>>()?;
    Ok(Drawing { strokes })
}
