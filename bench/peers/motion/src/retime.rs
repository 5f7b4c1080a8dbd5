use std::path::{Path, PathBuf};
use std::time::Instant;

use tracelight_aim::{HeadGeometry, HeadPose, JointPath};
use tracelight_dynamics::{Friction, Lumped, Motor};
use tracelight_rig::PanTilt;
use tracelight_trajectory::{JointLimits, Machine, PathSample, retime, retime_smooth};

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Files of sampled joint paths: s, both angles, first and second derivatives a line, after a first line of names.
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Cells to take of each, evenly.
    #[arg(long, value_delimiter = ',', default_values_t = [100, 1000])]
    cells: Vec<usize>,
    /// Coulomb friction of both joints, N m.
    #[arg(long, default_value_t = 0.05)]
    coulomb: f64,
    /// Viscous friction of both joints, N m s/rad.
    #[arg(long, default_value_t = 0.0)]
    viscous: f64,
    /// With bounded jerk instead of torque: highest joint speed, acceleration and jerk, such as 24,100,2000.
    #[arg(long, value_delimiter = ',')]
    smooth: Option<Vec<f64>>,
    /// How often each is timed; the shortest time counts.
    #[arg(long, default_value_t = 50)]
    times: u32,
}

/// Prints the duration of the fastest motion along each path, and how long finding it took.
pub(crate) fn run(arguments: &Arguments) -> Result<(), String> {
    let machine = rig(arguments);
    println!("{:16} {:>7} {:>12} {:>9}", "path", "cells", "duration s", "took ms");
    for file in &arguments.files {
        let all = read(file)?;
        for &cells in &arguments.cells {
            if (all.len() - 1) % cells != 0 {
                continue;
            }
            let samples: Vec<PathSample> = all.iter().step_by((all.len() - 1) / cells).copied().collect();
            let mut took = f64::INFINITY;
            let mut duration_s = 0.0;
            for _ in 0..arguments.times {
                let start = Instant::now();
                let motion_s = timed(&machine, &samples, arguments.smooth.as_deref())?;
                took = took.min(start.elapsed().as_secs_f64());
                duration_s = motion_s;
            }
            let name = file.file_stem().unwrap_or_default().to_string_lossy();
            println!("{name:16} {cells:7} {duration_s:12.6} {:9.4}", 1e3 * took);
        }
    }
    Ok(())
}

/// The duration of the fastest motion, s.
fn timed(machine: &Machine, samples: &[PathSample], smooth: Option<&[f64]>) -> Result<f64, String> {
    match smooth {
        Some(&[speed_rad_s, acceleration_rad_s2, jerk_rad_s3]) => {
            let limits = JointLimits { speed_rad_s, acceleration_rad_s2, jerk_rad_s3 };
            let motion = retime_smooth(samples, &PanTilt::new(limits, limits));
            Ok(motion.map_err(|e| e.to_string())?.duration_s())
        }
        _ => Ok(retime(machine, samples).map_err(|e| e.to_string())?.duration_s()),
    }
}

/// The 2006 rig: inertia and friction alone, at full torque.
fn rig(arguments: &Arguments) -> Machine {
    const GEARED_NM_PER_A: f64 = 0.0432 * 6.3 * 2.8435;
    let motor = |a_per_v: f64| Motor::by_current(a_per_v * GEARED_NM_PER_A, 10.0);
    let friction = Friction::symmetric(arguments.viscous, arguments.coulomb);
    let none = PanTilt::new(f64::INFINITY, f64::INFINITY);
    Machine {
        lumped: Lumped { m11_fixed: 0.075, m22: 0.075, ..Lumped::default() },
        friction: PanTilt::new(friction, friction),
        motors: PanTilt::new(motor(0.08), motor(0.1)),
        torque_share: 1.0,
        speed_limit_rad_s: PanTilt::new(24.0, 24.0),
        acceleration_limit_rad_s2: none,
        jerk_limit_rad_s3: none,
        tolerance_limit_rad: f64::INFINITY,
        geometry: HeadGeometry::centred(PanTilt::new((-3.1, 3.1), (-3.1, 3.1))),
        pose: HeadPose::square_on(0.9),
        relay_on_ticks: 0,
        relay_off_ticks: 0,
    }
}

fn read(file: &Path) -> Result<Vec<PathSample>, String> {
    let text = std::fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))?;
    let sample = |(number, line): (usize, &str)| {
        let values: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
        match values.as_deref() {
            Ok(&[s, pan, tilt, d_pan, d_tilt, dd_pan, dd_tilt, ..]) => Ok(PathSample {
                s,
                joints: JointPath {
                    angle_rad: PanTilt::new(pan, tilt),
                    first: PanTilt::new(d_pan, d_tilt),
                    second: PanTilt::new(dd_pan, dd_tilt),
                },
                cap: f64::INFINITY,
            }),
            _ => Err(format!("{}:{}: seven numbers are needed", file.display(), number + 1)),
        }
    };
    text.lines().enumerate().skip(1).map(sample).collect()
}
