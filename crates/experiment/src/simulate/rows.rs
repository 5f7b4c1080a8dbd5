//! A motion as a table: `t,pan,tilt`.

use tracelight_rig::{Joint, PanTilt, TICK_F64_S};
use tracelight_sim::{Between, MotionArray};
use tracelight_task::Failure;

use crate::table::{self, Log};

/// Most rows.
const MOST_ROWS: usize = 1_000_000;
/// Longest motion, s.
pub const LONGEST_S: f64 = 600.0;

/// What rounding may add to an angle at the end of a range, rad.
const ROUNDED_RAD: f64 = 1e-6;

/// Where time and angles stand, and what an angle there is in radians.
struct Columns {
    time: usize,
    angle: PanTilt<(usize, f64)>,
}

impl Columns {
    /// Without names: time, pan and tilt, in s and rad.
    const PLAIN: Self = Self { time: 0, angle: PanTilt::new((1, 1.0), (2, 1.0)) };

    /// Of the first row, if it has names.
    fn of(first: &csv::ByteRecord) -> Result<Option<Self>, String> {
        let text = |field: &[u8]| String::from_utf8_lossy(field).trim().to_owned();
        let names: Vec<String> = first.iter().map(text).collect();
        if names.first().is_some_and(|name| name.parse::<f64>().is_ok()) {
            return Ok(None);
        }
        let find = |wanted: &str| names.iter().position(|name| name == wanted);
        let time = ["t", "t_s", "time_s", "time"].into_iter().find_map(find);
        let angle = |joint: Joint| {
            let with = |ending: &str, scale: f64| Some((find(&format!("{joint}{ending}"))?, scale));
            // what was asked of a run comes before where it was
            with("_set_rad", 1.0)
                .or_else(|| with("_rad", 1.0))
                .or_else(|| with("", 1.0))
                .or_else(|| with("_deg", 1f64.to_radians()))
        };
        let all = time.zip(angle(Joint::Pan)).zip(angle(Joint::Tilt));
        let ((time, pan), tilt) =
            all.ok_or(": its columns must be t,pan,tilt (s and rad; pan_deg,tilt_deg for degrees)")?;
        Ok(Some(Self { time, angle: PanTilt::new(pan, tilt) }))
    }
}

/// Reads a motion whose angles lie within the joints' range, rad.
pub(super) fn read(
    log: &Log,
    between: Between,
    range_rad: PanTilt<(f64, f64)>,
) -> Result<MotionArray, Failure> {
    parse(&log.bytes, between, range_rad)
        .map_err(|what| Failure::usage("motion-array", format!("{}{what}", log.name)))
}

fn parse(bytes: &[u8], between: Between, range_rad: PanTilt<(f64, f64)>) -> Result<MotionArray, String> {
    let mut columns = None;
    let mut rows: Vec<(f64, PanTilt<f64>)> = Vec::new();
    table::parse_plain(bytes, |row| {
        let line = row.line;
        let columns = match &columns {
            Some(columns) => columns,
            None => {
                let named = Columns::of(row.fields)?;
                let has_names = named.is_some();
                let known = columns.insert(named.unwrap_or(Columns::PLAIN));
                if has_names {
                    return Ok(());
                }
                known
            }
        };
        let time_s = row.number(columns.time)?;
        let mut angle_rad = PanTilt::default();
        for joint in Joint::BOTH {
            let (column, scale) = columns.angle[joint];
            angle_rad[joint] = scale * row.number(column)?;
            let (lower, upper) = range_rad[joint];
            if !(lower - ROUNDED_RAD..=upper + ROUNDED_RAD).contains(&angle_rad[joint]) {
                let at = angle_rad[joint];
                return Err(format!(
                    ":{line}: {joint} at {at} rad is out of its range, {lower:.4} to {upper:.4} rad"
                ));
            }
        }
        let (begun_s, before_s) = (rows.first().map_or(time_s, |r| r.0), rows.last().map(|r| r.0));
        if before_s.is_some_and(|before| time_s < before + MotionArray::CLOSEST_S) {
            return Err(format!(
                ":{line}: its time, {time_s} s, does not come after the row before, by a microsecond at least"
            ));
        }
        if rows.len() >= MOST_ROWS || time_s - begun_s > LONGEST_S {
            return Err(format!(
                ":{line}: a motion has at most {MOST_ROWS} rows and {LONGEST_S} s; give a part of it"
            ));
        }
        rows.push((time_s, angle_rad));
        Ok(())
    })?;
    let array = MotionArray::new(&rows, between).map_err(|e| format!(": {e}"))?;
    stays_within(&array, range_rad).map(|()| array)
}

/// What goes between the rows may leave the range though no row does.
fn stays_within(array: &MotionArray, range_rad: PanTilt<(f64, f64)>) -> Result<(), String> {
    const BEYOND_RAD: f64 = 0.01;
    for tick in 0..=(array.length_s() / TICK_F64_S).ceil() as usize {
        let time_s = tick as f64 * TICK_F64_S;
        let at = array.at(time_s);
        for joint in Joint::BOTH {
            let (angle, (lower, upper)) = (at[joint].position_rad, range_rad[joint]);
            if !(lower - BEYOND_RAD..=upper + BEYOND_RAD).contains(&angle) {
                return Err(format!(
                    ": {time_s:.3} s from its start, between two rows, the spline takes {joint} to {angle:.3} rad, out of its range, {lower:.4} to \
                     {upper:.4} rad; give more rows, or --between lines"
                ));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    use super::*;

    const RANGE: PanTilt<(f64, f64)> = PanTilt::new((-3.2, 3.2), (-1.7, 1.7));

    fn end(text: &str) -> Result<PanTilt<f64>, String> {
        let array = parse(text.as_bytes(), Between::Lines, RANGE)?;
        Ok(array.at(array.length_s()).map(|motion| motion.position_rad))
    }

    #[test]
    fn arrays_are_read_with_names_and_without() {
        assert_eq!(end("0,0,0\n1,0.5,-0.25\n"), Ok(PanTilt::new(0.5, -0.25)));
        assert_eq!(end("t,pan,tilt\n0,0,0\n1,0.5,-0.25\n"), Ok(PanTilt::new(0.5, -0.25)));
        let degrees = end("tilt_deg,t_s,pan_deg\n0,0,0\n-45,1,90\n").unwrap();
        assert!((degrees.pan - FRAC_PI_2).abs() < 1e-12 && (degrees.tilt + FRAC_PI_4).abs() < 1e-12);
        // a run's table: what was asked, not what became of it
        assert_eq!(
            end("t_s,pan_rad,tilt_rad,pan_set_rad,tilt_set_rad\n0,9,9,0,0\n1,9,9,1,1\n"),
            Ok(PanTilt::new(1.0, 1.0))
        );
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let error = |text: &str| end(text).unwrap_err();
        assert!(error("a,b,c\n0,0,0\n").contains("t,pan,tilt"));
        assert!(error("0,0,0\n0,1,1\n").contains(":2: its time, 0 s"));
        assert!(error("0,0,0\n1,x,1\n").contains(":2: \"x\" in column 2 is no number"));
        assert!(error("0,0,0\n1,0,2\n").contains(":2: tilt at 2 rad is out of its range"));
        assert!(error("0,0,0\n").contains("two rows"));
        assert!(error("").contains("two rows"));
    }
}
