//! What a job was asked to do, in words: the report's and the log's table.

use crate::cli::request::TraceArgs;
use tracelight_camera::shown;
use tracelight_pipeline::{Driving, Placed};
use tracelight_report::Setting;
use tracelight_sim::RigConfig;

/// In the order to show.
pub(crate) fn of(args: &TraceArgs, driving: &Driving, placed: &Placed) -> Vec<Setting> {
    let mm = |m: f64| format!("{:.1} mm", m * 1e3);
    let rows = [
        (if args.eye.camera.is_some() { "camera" } else { "picture" }, shown(args.name())),
        ("size", format!("{} × {}", mm(placed.size_m.0), mm(placed.size_m.1))),
        ("offset", args.placement.offset.map_or("none".into(), |o| format!("{}, {}", mm(o.0.0), mm(o.1.0)))),
        ("rotate", args.placement.rotate.map_or("none".into(), |a| a.to_string())),
        ("flip", if args.placement.flip { "yes" } else { "no" }.into()),
        ("distance", mm(driving.pose.distance_m)),
        (
            "speed",
            format!("{:.4} m/s ({:.2} ft/s)", driving.request.speed_m_s, driving.request.speed_m_s / 0.3048),
        ),
        ("lit speed", args.driving.lit_speed.name().into()),
        ("corners", args.driving.corner.map_or("sharp".into(), |c| format!("rounded by up to {}", mm(c.0)))),
        ("order", args.sequence.order.name().into()),
        ("profile", args.driving.profile.name().into()),
        ("rig", format!("{} ({})", driving.rig.name, driving.rig.description)),
        ("law", law_of(&driving.rig)),
        ("tolerance", mm(driving.request.tolerance_m)),
        ("seed", args.seed.to_string()),
        ("laps", args.laps.to_string()),
        ("dry run", if args.dry_run { "yes" } else { "no" }.into()),
    ];
    let all = rows
        .into_iter()
        .chain(args.wall.settings())
        .chain(args.tracing.settings())
        .chain(args.seen_settings());
    all.map(|(name, value)| Setting { name: name.into(), value }).collect()
}

/// The law, and what it is told of the joints by.
fn law_of(rig: &RigConfig) -> String {
    format!("{} on {}", rig.control.law.name(), rig.control.observer_in_use().name())
}
