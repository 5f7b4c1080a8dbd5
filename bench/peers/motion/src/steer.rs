use std::path::{Path, PathBuf};
use std::time::Instant;

use rsruckig::prelude::*;
use tracelight_trajectory::{Bounds, MovePoint, Steered, steer};

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// File of moves of two joints: places, velocities and accelerations at the start, the same at the end, a line,
    /// after a first line of names.
    file: PathBuf,
    /// Highest velocity, acceleration and jerk of both joints.
    #[arg(long, value_delimiter = ',', default_values_t = [24.0, 100.0, 2000.0])]
    bounds: Vec<f64>,
    /// How often each move is timed; the shortest time counts.
    #[arg(long, default_value_t = 20)]
    times: u32,
}

/// A move's start and end.
struct Case {
    from: [MovePoint; 2],
    to: [MovePoint; 2],
}

/// Prints how long the fastest moves are and how long finding them took, ours and rsruckig's.
pub(crate) fn run(arguments: &Arguments) -> Result<(), String> {
    let cases = read(&arguments.file)?;
    let &[velocity, acceleration, jerk] = arguments.bounds.as_slice() else {
        return Err("--bounds asks for three numbers: velocity, acceleration, jerk".to_string());
    };
    let bounds = [Bounds::symmetric(velocity, acceleration, jerk); 2];
    let ours = all(cases.len(), arguments.times, |i| {
        let way: Steered<2> = steer(&cases[i].from, &cases[i].to, &bounds).map_err(|e| e.to_string())?;
        Ok(way.duration_s())
    });
    let mut peer = Ruckig::<2, ThrowErrorHandler>::new(None, 0.001);
    let mut trajectory = Trajectory::new(None);
    let inputs: Vec<InputParameter<2>> = cases.iter().map(|case| input(case, &bounds[0])).collect();
    let theirs = all(cases.len(), arguments.times, |i| {
        peer.calculate(&inputs[i], &mut trajectory).map_err(|e| format!("{e:?}"))?;
        Ok(trajectory.get_duration())
    });
    print(&[("tracelight", &ours), ("rsruckig", &theirs)]);
    let apart = ours.iter().zip(&theirs).filter_map(|(a, b)| Some((a.duration_s? - b.duration_s?).abs()));
    println!("durations at most {:.2e} s apart", apart.fold(0.0, f64::max));
    Ok(())
}

struct Solved {
    duration_s: Option<f64>,
    took_s: f64,
}

fn all(count: usize, times: u32, mut solve: impl FnMut(usize) -> Result<f64, String>) -> Vec<Solved> {
    let one = |i| {
        let mut solved = Solved { duration_s: None, took_s: f64::INFINITY };
        for _ in 0..times {
            let start = Instant::now();
            let duration = std::hint::black_box(solve(std::hint::black_box(i)));
            solved.took_s = solved.took_s.min(start.elapsed().as_secs_f64());
            solved.duration_s = duration.ok();
        }
        solved
    };
    (0..count).map(one).collect()
}

fn print(rows: &[(&str, &[Solved])]) {
    println!(
        "{:12} {:>8} {:>9} {:>16} {:>9} {:>9}",
        "", "moves", "failures", "durations s", "median us", "p99 us"
    );
    for (name, solved) in rows {
        let mut took: Vec<f64> = solved.iter().map(|s| 1e6 * s.took_s).collect();
        took.sort_by(f64::total_cmp);
        let durations: Vec<f64> = solved.iter().filter_map(|s| s.duration_s).collect();
        let at = |share: f64| took[((took.len() - 1) as f64 * share) as usize];
        println!(
            "{name:12} {:8} {:9} {:16.9} {:9.2} {:9.2}",
            solved.len(),
            solved.len() - durations.len(),
            durations.iter().sum::<f64>(),
            at(0.5),
            at(0.99)
        );
    }
}

fn input(case: &Case, bounds: &Bounds) -> InputParameter<2> {
    let mut input = InputParameter::new(None);
    let each =
        |points: &[MovePoint; 2], of: fn(&MovePoint) -> f64| daov_stack![of(&points[0]), of(&points[1])];
    input.current_position = each(&case.from, |p| p.position);
    input.current_velocity = each(&case.from, |p| p.velocity);
    input.current_acceleration = each(&case.from, |p| p.acceleration);
    input.target_position = each(&case.to, |p| p.position);
    input.target_velocity = each(&case.to, |p| p.velocity);
    input.target_acceleration = each(&case.to, |p| p.acceleration);
    input.max_velocity = daov_stack![bounds.velocity[1], bounds.velocity[1]];
    input.max_acceleration = daov_stack![bounds.acceleration[1], bounds.acceleration[1]];
    input.max_jerk = daov_stack![bounds.jerk, bounds.jerk];
    input
}

fn read(file: &Path) -> Result<Vec<Case>, String> {
    let text = std::fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))?;
    let case = |(number, line): (usize, &str)| {
        let values: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
        let values = values.ok().filter(|values| values.len() == 12);
        let values = values.ok_or(format!("{}:{}: twelve numbers are needed", file.display(), number + 1))?;
        let points = |first: usize| {
            [0, 1].map(|joint| MovePoint {
                position: values[first + joint],
                velocity: values[first + 2 + joint],
                acceleration: values[first + 4 + joint],
            })
        };
        Ok(Case { from: points(0), to: points(6) })
    };
    text.lines().enumerate().skip(1).map(case).collect()
}
