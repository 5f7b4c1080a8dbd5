//! The moves of a course, as they are shown.

use std::fmt::Write;

use serde_json::{Value, json};
use tracelight_chart::Figure;
use tracelight_rig::{Joint, PanTilt};
use tracelight_task::Failure;
use tracelight_trajectory::{Pace, Peaks};

use super::figure::figure;
use super::{Entry, Finding, OnRig, failure};
use crate::finding::{self, Plotted};
use crate::profile_name::ProfileName;

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let limits = &self.wish.limits;
        let mut text = format!(
            "{}, rig {}\n{:.1} mm, at most {:.4} m/s, {:.4} m/s² speeding up, {:.4} m/s² braking\n",
            self.wish.title,
            self.rig.name,
            1e3 * self.length_m,
            limits.speed,
            limits.acceleration,
            limits.deceleration
        );
        asked(&mut text, self);
        if !self.as_asked {
            on_rig(&mut text, self);
        }
        text.push_str("\nA sigmoid starts and stops with a jump of the speed; no torque is counted for it.");
        text
    }

    fn json(&self) -> String {
        let limits = &self.wish.limits;
        let moves: Vec<_> = self.entries.iter().map(|entry| figures(self, entry)).collect();
        json!({
            "length_m": self.length_m,
            "limits": {
                "speed_m_s": limits.speed,
                "acceleration_m_s2": limits.acceleration,
                "deceleration_m_s2": limits.deceleration,
            },
            "moves": moves,
        })
        .to_string()
    }
}

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        figure(self)
    }

    /// A row a tick: along the course, on the target, at the joints, and as encoder counts.
    fn csv(&self) -> Result<String, Failure> {
        let mut text = String::from(
            "t_s,s_m,v_m_s,a_m_s2,x_m,y_m,pan_rad,tilt_rad,pan_rad_s,tilt_rad_s,pan_rad_s2,tilt_rad_s2,pan_count,tilt_count,pan_nm,\
             tilt_nm\n",
        );
        let Some(pace) = self.chosen().next().and_then(Entry::pace) else { return Ok(text) };
        for p in self.course()?.ticks(pace).map_err(failure)? {
            let (pan, tilt) = (&p.joints.pan, &p.joints.tilt);
            let count = self.counts(p.joints.map(|j| j.position_rad));
            let _ = writeln!(
                text,
                "{:.3},{:.9},{:.9},{:.9},{:.9},{:.9},{:.9},{:.9},{:.9},{:.9},{:.9},{:.9},{},{},{:.6},{:.6}",
                p.t_s,
                p.along.position,
                p.along.velocity,
                p.along.acceleration,
                p.spot.x,
                p.spot.y,
                pan.position_rad,
                tilt.position_rad,
                pan.velocity_rad_s,
                tilt.velocity_rad_s,
                pan.acceleration_rad_s2,
                tilt.acceleration_rad_s2,
                count.pan,
                count.tilt,
                p.torque_nm.pan,
                p.torque_nm.tilt
            );
        }
        Ok(text)
    }
}

fn asked(text: &mut String, finding: &Finding) {
    let rows: Vec<(&Entry, &Pace, &PanTilt<f64>)> = finding
        .entries
        .iter()
        .filter_map(|e| e.asked.as_ref().map(|(pace, torque)| (e, pace, torque)))
        .collect();
    let trapezoid = duration_of(&rows.iter().map(|row| (row.0.name, row.1)).collect::<Vec<_>>());
    *text += &heads("as asked", ["takes of the motors", ""]);
    for (entry, pace, torque) in &rows {
        // writing to a String cannot fail
        let _ = writeln!(text, "{}  {}", columns(entry.name, pace, trapezoid), demand(finding, torque));
    }
    if let Some(verdict) = verdict(finding, &rows) {
        let _ = writeln!(text, "{verdict}");
    }
}

fn on_rig(text: &mut String, finding: &Finding) {
    let rows: Vec<(&Entry, &OnRig)> =
        finding.entries.iter().filter_map(|e| Some((e, e.on_rig.as_ref()?))).collect();
    let trapezoid = duration_of(&rows.iter().map(|row| (row.0.name, &row.1.pace)).collect::<Vec<_>>());
    *text += &heads("on the rig", ["error of the spot, mm", "rms / max / at rest"]);
    for (entry, OnRig { pace, tracking, held, .. }) in rows {
        let _ = writeln!(
            text,
            "{}  {:.3} / {:.3} / {:.3}{}",
            columns(entry.name, pace, trapezoid),
            tracking.rms_mm,
            tracking.max_mm,
            tracking.final_error_mm,
            if *held { "\n           left its course, and went back dark" } else { "" }
        );
    }
}

/// Two lines above a table whose last column has these heads.
fn heads(what: &str, last: [&str; 2]) -> String {
    let lines = [
        [what, "duration", "over the", "peak", "peak", last[0]],
        ["", "s", "trapezoid", "m/s", "m/s²", last[1]],
    ];
    let line = |[a, b, c, d, e, f]: [&str; 6]| {
        format!("{a:10} {b:>8} {c:>10} {d:>9} {e:>9}  {f}").trim_end().to_owned()
    };
    format!("\n{}\n{}\n", line(lines[0]), line(lines[1]))
}

/// What both tables begin with.
fn columns(name: ProfileName, pace: &Pace, trapezoid_s: Option<f64>) -> String {
    let Peaks { speed, acceleration, deceleration, .. } = *pace.peaks();
    format!(
        "{:10} {:8.4} {:>10} {:9.4} {:9.3}",
        name.name(),
        pace.duration_s(),
        over(pace.duration_s(), trapezoid_s),
        speed,
        acceleration.max(deceleration)
    )
}

fn duration_of(rows: &[(ProfileName, &Pace)]) -> Option<f64> {
    rows.iter().find(|(name, _)| *name == ProfileName::Trapezoid).map(|(_, pace)| pace.duration_s())
}

/// How much longer than the trapezoid, in words.
fn over(duration_s: f64, trapezoid_s: Option<f64>) -> String {
    match trapezoid_s.map(|t| 100.0 * (duration_s / t - 1.0)) {
        Some(percent) if percent.abs() >= 5e-3 => format!("{percent:+.2} %").replace('-', "−"),
        Some(_) => "0".to_owned(),
        None => "–".to_owned(),
    }
}

/// The joint whose motor is asked most, and its command.
fn demand(finding: &Finding, torque_nm: &PanTilt<f64>) -> String {
    let share = finding.machine.fraction(*torque_nm);
    let joint = if share.pan >= share.tilt { Joint::Pan } else { Joint::Tilt };
    let motor = &finding.machine.motors[joint];
    let words = format!("{:.1} V on {joint}", motor.volts_for(torque_nm[joint]));
    if share[joint] > 1.0 {
        format!("{words}: {} at most", motor.limit_v)
    } else {
        format!("{words}, of {}", motor.limit_v)
    }
}

/// Why trapezoid and S-curve take as long as they do.
fn verdict(finding: &Finding, rows: &[(&Entry, &Pace, &PanTilt<f64>)]) -> Option<String> {
    let of = |name| rows.iter().find(|row| row.0.name == name).map(|row| row.1);
    let (trapezoid, s_curve) = (of(ProfileName::Trapezoid)?, of(ProfileName::SCurve)?);
    let limits = &finding.wish.limits;
    let cruise_s = |pace: &Pace| {
        let Peaks { speed, .. } = *pace.peaks();
        pace.duration_s() - speed / limits.acceleration - speed / limits.deceleration
    };
    let share = cruise_s(trapezoid) / trapezoid.duration_s();
    let later_s = s_curve.duration_s() - trapezoid.duration_s();
    Some(if share < 1e-9 {
        "The highest speed is never reached: then the S-curve takes the same share longer on every path and length, line \
         or arc."
            .to_owned()
    } else {
        format!(
            "{:.0} % of the trapezoid is at the highest speed, where profiles do not differ: the S-curve is later by \
             {later_s:.4} s, however long the path.",
            100.0 * share
        )
    })
}

fn figures(finding: &Finding, entry: &Entry) -> Value {
    let of = |pace: &Pace| {
        let Peaks { speed, acceleration, deceleration, jerk, speed_jump } = *pace.peaks();
        json!({
            "duration_s": pace.duration_s(),
            "peak_m_s": speed,
            "peak_m_s2": acceleration.max(deceleration),
            "peak_m_s3": jerk,
            "jump_m_s": speed_jump,
        })
    };
    let asked = entry.asked.as_ref().map(|(pace, torque_nm)| {
        let share = finding.machine.fraction(*torque_nm);
        let mut figures = of(pace);
        figures["torque_fraction"] = json!({ "pan": share.pan, "tilt": share.tilt });
        figures
    });
    let on_rig = entry.on_rig.as_ref().map(|OnRig { pace, tracking, held, .. }| {
        let mut figures = of(pace);
        figures["tracking"] = json!({
            "rms_mm": tracking.rms_mm,
            "max_mm": tracking.max_mm,
            "final_error_mm": tracking.final_error_mm,
        });
        figures["held"] = (*held).into();
        figures
    });
    json!({ "profile": entry.name.name(), "asked": asked, "rig": on_rig })
}
