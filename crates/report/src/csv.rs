//! `trace.csv` and `fault.csv`: a row a tick.

use std::io::Write;

use tracelight_rig::{Darkness, DarknessSet, TICK_F64_S};
use tracelight_task::phase_word;

use crate::finished::Finished;
use crate::sample::{Sample, samples};

/// Columns of `trace.csv`; `lap` follows where there were several.
const HEADER: &str = "t_s,x_m,y_m,laser,pan_rad,tilt_rad,pan_set_rad,tilt_set_rad,pan_count,tilt_count,pan_v,tilt_v,\
                      gate,plan_x_m,plan_y_m,error_mm,phase,dark,pan_est_rad,tilt_est_rad,plan_tick,pan_est_rad_s,tilt_est_rad_s,\
                      pan_est_rad_s2,tilt_est_rad_s2,pan_edge_ms,tilt_edge_ms,pan_lost,tilt_lost";

/// What a fault's log shows of the run: ticks before it,
const BEFORE_FAULT: usize = 200;
/// and after it.
const AFTER_FAULT: usize = 100;

/// `fault.csv`: the rows about the tick in which the last lap's fault was seen; `None` where there was none.
#[must_use]
pub fn fault_csv(job: &Finished<'_>) -> Option<Vec<u8>> {
    let at = job.run.ticks.iter().position(|tick| tick.telemetry.fault().is_some())?;
    let from = at.saturating_sub(BEFORE_FAULT);
    let mut text = format!("{HEADER}\n").into_bytes();
    for sample in samples(job.plan, job.run).skip(from).take(at - from + AFTER_FAULT + 1) {
        row(&mut text, &sample);
        text.pop(); // the last comma
        text.push(b'\n');
    }
    Some(text)
}

/// Writes `trace.csv`: one row a control tick, laps after each other.
///
/// `pan_edge_ms`: how long before the tick the joint's last edge came, if one came in the tick before and was stamped.
/// `pan_lost`: counts that are to be added to `pan_count`, because its encoder lost some.
/// Decimals are fixed (0.1 µm, 0.1 µrad, 0.1 mV, 1 ns), so equal runs give equal bytes. Where the beam misses the plane,
/// `x_m`, `y_m` and `error_mm` are empty.
///
/// # Errors
/// What `out` says.
pub fn trace_csv(out: &mut impl Write, job: &Finished<'_>) -> std::io::Result<()> {
    let laps = job.earlier_laps.iter().chain([job.run]);
    let numbered = !job.earlier_laps.is_empty();
    writeln!(out, "{HEADER}{}", if numbered { ",lap" } else { "" })?;
    let mut line = Vec::with_capacity(256);
    for (lap, run) in laps.enumerate() {
        for sample in samples(job.plan, run) {
            line.clear();
            row(&mut line, &sample);
            if numbered {
                push_integer(&mut line, lap as i64 + 1);
            }
            line.pop(); // the last comma
            line.push(b'\n');
            out.write_all(&line)?;
        }
    }
    Ok(())
}

/// Appends a tick's fields, each with a comma after it.
fn row(line: &mut Vec<u8>, sample: &Sample<'_>) {
    let tick = sample.tick;
    let telemetry = &tick.telemetry;
    push_fixed(line, sample.t_s, 3);
    push_optional(line, tick.spot.map(|p| p.x), 7);
    push_optional(line, tick.spot.map(|p| p.y), 7);
    push_flag(line, tick.light);
    push_fixed(line, tick.angle_rad.pan, 7);
    push_fixed(line, tick.angle_rad.tilt, 7);
    push_fixed(line, telemetry.setpoint.pan.position_rad.into(), 7);
    push_fixed(line, telemetry.setpoint.tilt.position_rad.into(), 7);
    push_integer(line, telemetry.measured.pan.count.into());
    push_integer(line, telemetry.measured.tilt.count.into());
    push_fixed(line, telemetry.actuation.command_v.pan.into(), 4);
    push_fixed(line, telemetry.actuation.command_v.tilt.into(), 4);
    push_flag(line, telemetry.actuation.lights());
    push_fixed(line, sample.asked().x, 7);
    push_fixed(line, sample.asked().y, 7);
    push_optional(line, sample.error_mm(), 4);
    push_word(line, phase_word(telemetry.phase));
    push_darkness(line, telemetry.darkness);
    push_fixed(line, telemetry.position_rad.pan.into(), 7);
    push_fixed(line, telemetry.position_rad.tilt.into(), 7);
    push_integer(line, telemetry.plan_tick.into());
    push_fixed(line, telemetry.velocity_rad_s.pan.into(), 5);
    push_fixed(line, telemetry.velocity_rad_s.tilt.into(), 5);
    push_fixed(line, telemetry.acceleration_rad_s2.pan.into(), 3);
    push_fixed(line, telemetry.acceleration_rad_s2.tilt.into(), 3);
    for measured in [telemetry.measured.pan, telemetry.measured.tilt] {
        let age_ms = measured.edge_age_ticks.map(|ticks| f64::from(ticks) * TICK_F64_S * 1e3);
        push_optional(line, age_ms, 6);
    }
    push_integer(line, telemetry.lost_counts.pan.into());
    push_integer(line, telemetry.lost_counts.tilt.into());
}

fn push_word(line: &mut Vec<u8>, word: &str) {
    line.extend_from_slice(word.as_bytes());
    line.push(b',');
}

fn push_flag(line: &mut Vec<u8>, flag: bool) {
    line.extend_from_slice(if flag { b"1," } else { b"0," });
}

fn push_optional(line: &mut Vec<u8>, value: Option<f64>, decimals: u32) {
    match value {
        Some(value) => push_fixed(line, value, decimals),
        None => line.push(b','),
    }
}

/// The reasons of a set joined by `+`; empty while the gate is open.
fn push_darkness(line: &mut Vec<u8>, set: DarknessSet) {
    for reason in Darkness::ALL.into_iter().filter(|&r| set.contains(r)) {
        line.extend_from_slice(reason.code().as_bytes());
        line.push(b'+');
    }
    match line.last_mut() {
        Some(last) if *last == b'+' => *last = b',',
        _ => line.push(b','),
    }
}

/// `value` with a fixed number of decimals. The general formatter finds the shortest text that reads back exactly,
/// ten times slower, and a million numbers a run make that felt. What is not finite or not below 10⁹ stays empty.
fn push_fixed(line: &mut Vec<u8>, value: f64, decimals: u32) {
    if value.abs() < 1e9 {
        let unit = 10_u64.pow(decimals);
        let scaled = (value.abs() * unit as f64).round() as u64;
        if value < 0.0 && scaled > 0 {
            line.push(b'-');
        }
        push_digits(line, scaled / unit, 1);
        line.push(b'.');
        push_digits(line, scaled % unit, decimals as usize);
    }
    line.push(b',');
}

fn push_integer(line: &mut Vec<u8>, value: i64) {
    if value < 0 {
        line.push(b'-');
    }
    push_digits(line, value.unsigned_abs(), 1);
    line.push(b',');
}

/// Decimal digits, at least `least` of them.
fn push_digits(line: &mut Vec<u8>, mut value: u64, least: usize) {
    let mut digits = [b'0'; 20]; // u64::MAX has 20
    let mut first = digits.len();
    while value > 0 {
        first -= 1;
        digits[first] = b'0' + (value % 10) as u8;
        value /= 10;
    }
    let first = first.min(digits.len() - least);
    line.extend_from_slice(&digits[first..]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    fn text(job: &Finished<'_>) -> String {
        let mut out = Vec::new();
        trace_csv(&mut out, job).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn numbers_are_written_as_they_are() {
        let check = |value: f64, decimals: u32, wanted: &str| {
            let mut line = Vec::new();
            push_fixed(&mut line, value, decimals);
            assert_eq!(String::from_utf8(line).unwrap(), format!("{wanted},"));
        };
        check(0.0, 3, "0.000");
        check(-0.00000001, 7, "0.0000000");
        check(-1.25, 7, "-1.2500000");
        check(0.30480004, 7, "0.3048000");
        check(99.9996, 3, "100.000");
        check(f64::NAN, 3, "");
        check(f64::INFINITY, 3, "");
        check(1e300, 3, "");
    }

    #[test]
    fn fixed_decimals_agree_with_the_general_formatter() {
        let mut seed = 1_u64;
        for _ in 0..20_000 {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let value = (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
            let mut line = Vec::new();
            push_fixed(&mut line, value, 7);
            line.pop();
            let back: f64 = String::from_utf8(line).unwrap().parse().unwrap();
            assert!((back - value).abs() <= 0.5000001e-7, "{value} {back}");
        }
    }

    #[test]
    fn every_tick_is_a_row_with_every_column() {
        let fixture = fixture::star();
        let text = text(&fixture.job());
        let mut lines = text.lines();
        let columns = lines.next().unwrap().split(',').count();
        assert_eq!(columns, 29);
        let rows: Vec<_> = lines.collect();
        assert_eq!(rows.len(), fixture.run.ticks.len());
        assert!(rows.iter().all(|row| row.split(',').count() == columns));
    }

    #[test]
    fn the_ticks_about_a_fault_have_their_own_file() {
        let mut fixture = fixture::star();
        for tick in fixture.run.ticks.iter_mut().skip(300) {
            tick.telemetry.latched = fixture::latched(tracelight_rig::Fault::EncoderDead);
        }
        let written = String::from_utf8(fault_csv(&fixture.job()).unwrap()).unwrap();
        let rows: Vec<&str> = written.lines().collect();
        assert_eq!(rows.len(), 1 + 200 + 1 + 100);
        assert!(
            rows[1].starts_with("0.100,") && rows[301].starts_with("0.400,"),
            "{} {}",
            rows[1],
            rows[301]
        );
        let whole = text(&fixture.job());
        assert!(whole.contains(&written[written.find('\n').unwrap()..]), "the same rows");
        assert_eq!(fault_csv(&fixture::star().job()), None, "no fault, no log of one");
    }

    #[test]
    fn a_row_says_where_the_light_was() {
        let fixture = fixture::star();
        let text = text(&fixture.job());
        let at = fixture.run.ticks.iter().position(|t| t.light).unwrap();
        let row: Vec<_> = text.lines().nth(at + 1).unwrap().split(',').collect();
        let spot = fixture.run.ticks[at].spot.unwrap();
        assert!((row[1].parse::<f64>().unwrap() - spot.x).abs() < 1e-7);
        assert!((row[2].parse::<f64>().unwrap() - spot.y).abs() < 1e-7);
        assert_eq!((row[3], row[12], row[16]), ("1", "1", "tracing"));
    }

    #[test]
    fn laps_are_numbered_from_one() {
        let fixture = fixture::star();
        let laps = [fixture.run.clone(), fixture.run.clone()];
        let text = text(&Finished { earlier_laps: &laps, ..fixture.job() });
        assert!(text.lines().next().unwrap().ends_with(",lap"));
        assert!(text.lines().nth(1).unwrap().ends_with(",1"));
        assert!(text.lines().last().unwrap().ends_with(",3"));
    }

    #[test]
    fn a_beam_that_misses_the_plane_leaves_its_fields_empty() {
        let mut fixture = fixture::star();
        fixture.run.ticks[0].spot = None;
        let text = text(&fixture.job());
        assert!(text.lines().nth(1).unwrap().starts_with("0.000,,,0,"));
    }
}
