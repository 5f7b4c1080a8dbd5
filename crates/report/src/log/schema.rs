//! The log's messages: what their fields are called, and how a tick fills them.

use tracelight_rig::{Darkness, DarknessSet, Joint, Telemetry};
use tracelight_sim::Tick;
use tracelight_task::phase_word;
use tracelight_trajectory::PlanPoint;

use super::protobuf::{Encoder, Kind, Message, ProtoFile};
use crate::Event;
use crate::sample::Sample;

/// Log time counts from power-up, not from a date: equal runs give equal logs.
pub(super) const fn time_ns(tick: u64) -> u64 {
    tick * 1_000_000
}

/// The program's own messages. Fields may be added at the ends; numbers never change.
pub(super) const TRACELIGHT: ProtoFile = ProtoFile {
    name: "tracelight.proto",
    package: "tracelight",
    imports: &[],
    messages: &[
        Message {
            name: "Joint",
            fields: &[
                ("count", Kind::SInt32),
                ("angle_rad", Kind::Double),
                ("set_rad", Kind::Double),
                ("set_rad_s", Kind::Double),
                ("set_rad_s2", Kind::Double),
                ("estimate_rad", Kind::Double),
                ("estimate_rad_s", Kind::Double),
                ("following_error_rad", Kind::Double),
                ("command_v", Kind::Double),
                ("estimate_rad_s2", Kind::Double),
                ("lost_counts", Kind::SInt32),
            ],
            choice: None,
        },
        Message {
            name: "Telemetry",
            fields: &[
                ("t_s", Kind::Double),
                ("tick", Kind::UInt32),
                ("plan_tick", Kind::UInt32),
                ("phase", Kind::Text),
                ("gate", Kind::Bool),
                ("light", Kind::Bool),
                ("dark", Kind::Text),
                ("fault", Kind::Text),
                ("pan", Kind::Message(".tracelight.Joint")),
                ("tilt", Kind::Message(".tracelight.Joint")),
                ("lap", Kind::UInt32),
                ("foot_turned_ahead_rad", Kind::Double),
                ("foot_turned_left_rad", Kind::Double),
                ("foot_turned_up_rad", Kind::Double),
            ],
            choice: None,
        },
        Message {
            name: "Spot",
            fields: &[
                ("x_m", Kind::Double),
                ("y_m", Kind::Double),
                ("error_mm", Kind::Double),
                ("on_plane", Kind::Bool),
                ("light", Kind::Bool),
            ],
            choice: None,
        },
        Message {
            name: "Plan",
            fields: &[
                ("x_m", Kind::Double),
                ("y_m", Kind::Double),
                ("lit", Kind::Bool),
                ("stroke", Kind::SInt32),
                ("pan_rad", Kind::Double),
                ("tilt_rad", Kind::Double),
                ("pan_rad_s", Kind::Double),
                ("tilt_rad_s", Kind::Double),
                ("pan_torque_fraction", Kind::Double),
                ("tilt_torque_fraction", Kind::Double),
            ],
            choice: None,
        },
    ],
};

/// What [`FOXGLOVE_LOG`] imports.
pub(super) const TIMESTAMP: ProtoFile = ProtoFile {
    name: "google/protobuf/timestamp.proto",
    package: "google.protobuf",
    imports: &[],
    messages: &[Message {
        name: "Timestamp",
        fields: &[("seconds", Kind::Int64), ("nanos", Kind::Int32)],
        choice: None,
    }],
};

/// Foxglove's schema of a log line, which its viewers show as such:
/// <https://docs.foxglove.dev/docs/sdk/schemas/log>.
pub(super) const FOXGLOVE_LOG: ProtoFile = ProtoFile {
    name: "foxglove/Log.proto",
    package: "foxglove",
    imports: &["google/protobuf/timestamp.proto"],
    messages: &[Message {
        name: "Log",
        fields: &[
            ("timestamp", Kind::Message(".google.protobuf.Timestamp")),
            ("level", Kind::Enum(".foxglove.Log.Level")),
            ("message", Kind::Text),
            ("name", Kind::Text),
        ],
        choice: Some(("Level", &["UNKNOWN", "DEBUG", "INFO", "WARNING", "ERROR", "FATAL"])),
    }],
};

/// `tracelight.Telemetry`: the controller's side of a tick, and the joints' angles.
pub(super) fn telemetry(out: &mut Encoder, sample: &Sample<'_>, lap: u32) {
    let seen = &sample.tick.telemetry;
    out.double(1, sample.t_s);
    out.unsigned(2, seen.tick.into());
    out.unsigned(3, seen.plan_tick.into());
    out.text(4, phase_word(seen.phase));
    out.flag(5, seen.actuation.lights());
    out.flag(6, sample.tick.light);
    out.text(7, &reasons(seen.darkness));
    out.text(8, seen.fault().map_or("", |fault| fault.code()));
    out.message(9, |joint| joint_state(joint, sample.tick, seen, Joint::Pan));
    out.message(10, |joint| joint_state(joint, sample.tick, seen, Joint::Tilt));
    out.unsigned(11, lap.into());
    // about the head's x, y and z; nothing without a gyroscope
    let turned = seen.foot_turned_rad.into_iter().flatten();
    (12..).zip(turned).for_each(|(field, rad)| out.double(field, rad.into()));
}

fn joint_state(out: &mut Encoder, tick: &Tick, seen: &Telemetry, joint: Joint) {
    let set = seen.setpoint[joint];
    out.signed(1, seen.measured[joint].count);
    out.double(2, tick.angle_rad[joint]);
    out.double(3, set.position_rad.into());
    out.double(4, set.velocity_rad_s.into());
    out.double(5, set.acceleration_rad_s2.into());
    out.double(6, seen.position_rad[joint].into());
    out.double(7, seen.velocity_rad_s[joint].into());
    out.double(8, f64::from(set.position_rad) - f64::from(seen.position_rad[joint]));
    out.double(9, seen.actuation.command_v[joint].into());
    out.double(10, seen.acceleration_rad_s2[joint].into());
    out.signed(11, seen.lost_counts[joint]);
}

/// `tracelight.Spot`: where the beam met the target.
pub(super) fn spot(out: &mut Encoder, sample: &Sample<'_>) {
    if let Some(spot) = sample.tick.spot {
        out.double(1, spot.x);
        out.double(2, spot.y);
    }
    out.double(3, sample.error_mm().unwrap_or(0.0));
    out.flag(4, sample.tick.spot.is_some());
    out.flag(5, sample.tick.light);
}

/// `tracelight.Plan`: where it should have; `stroke` counts from one and is zero between strokes.
pub(super) fn plan(out: &mut Encoder, planned: &PlanPoint) {
    out.double(1, planned.spot.x);
    out.double(2, planned.spot.y);
    out.flag(3, planned.lit);
    out.signed(4, planned.stroke.map_or(0, |number| number as i32 + 1));
    out.double(5, planned.joints.pan.position_rad);
    out.double(6, planned.joints.tilt.position_rad);
    out.double(7, planned.joints.pan.velocity_rad_s);
    out.double(8, planned.joints.tilt.velocity_rad_s);
    out.double(9, planned.torque_fraction.pan.into());
    out.double(10, planned.torque_fraction.tilt.into());
}

/// `foxglove.Log`: an event in words.
pub(super) fn fault(out: &mut Encoder, event: &Event, tick: u64) {
    const WARNING: u64 = 3;
    const FATAL: u64 = 5;
    let time = time_ns(tick);
    out.message(1, |stamp| {
        stamp.unsigned(1, time / 1_000_000_000);
        stamp.unsigned(2, time % 1_000_000_000);
    });
    out.unsigned(2, if event.stops { FATAL } else { WARNING });
    out.text(3, &format!("{}: {}", event.code, event.told()));
    out.text(4, "interlock");
}

fn reasons(set: DarknessSet) -> String {
    let codes: Vec<_> = Darkness::ALL.into_iter().filter(|&r| set.contains(r)).map(Darkness::code).collect();
    codes.join("+")
}
