//! The columns of a log that were asked for, found, and their numbers in SI.

use tracelight_rig::{Joint, PanTilt};
use tracelight_task::{Failure, counted};

use super::asked::Columns;
use super::clock::{of_day, unwrapped};
use super::dialect::text;
use super::expression::{Source, title};
use super::quantity::Quantity;
use super::taken::{Kind, Resolved, Table, Taken};
use crate::table::{Log, MOST_ROWS};

/// A row, in SI.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Reading {
    /// Of the file.
    pub(crate) line: u64,
    /// Begins anew: the first of its joint, or a header stands before it, or its time falls back.
    pub(crate) fresh: bool,
    pub(crate) joint: Joint,
    values: [f64; Quantity::ALL.len()],
}

impl Reading {
    /// Of a quantity that was found; no number where it was not.
    pub(crate) const fn get(&self, quantity: Quantity) -> f64 {
        self.values[quantity as usize]
    }
}

/// What was found in a log.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Found {
    pub(crate) readings: Vec<Reading>,
    /// What was taken for what, in one line, without the log's name.
    pub(crate) said: String,
    /// Volts are sizes: their sign is that of the motion.
    pub(crate) unsigned: bool,
    has: Vec<Quantity>,
}

impl Found {
    pub(crate) fn has(&self, quantity: Quantity) -> bool {
        self.has.contains(&quantity)
    }

    /// What was found of one joint, in order.
    pub(crate) fn of(&self, joint: Joint) -> impl Iterator<Item = &Reading> {
        self.readings.iter().filter(move |reading| reading.joint == joint)
    }
}

/// A share of rows without numbers that is no accident.
const TOO_MANY: f64 = 0.1;

/// Reads a log of some kind by the columns that were asked for and those that its headers tell. Rows are of `axis` where no column says.
///
/// # Errors
/// The kind's code: a column that is missing or could be two, a unit that nobody tells, rows that are none.
pub(crate) fn read(log: &Log, columns: &Columns, axis: Option<Joint>, kind: &Kind) -> Result<Found, Failure> {
    let text = text(&log.bytes);
    Table::of(&text)
        .and_then(|table| table.resolved(columns, axis, kind))
        .and_then(|taken| taken.found(&text))
        .map_err(|what| {
            // who said nothing of columns may mean this program's
            let own =
                if columns.is_empty() { format!("; this program's are {}", kind.own) } else { String::new() };
            Failure::usage(kind.code, format!("{}{what}{own}", log.name))
        })
}

/// What was left out of a log, and why.
#[derive(Default)]
struct LeftOut {
    /// Rows in which something was no number, and the first of them.
    bad: usize,
    first: Option<(u64, String)>,
    /// Rows of a time that was there already.
    repeated: usize,
    /// How often a counter of time began again.
    wrapped: usize,
}

impl Resolved {
    fn found(mut self, text: &str) -> Result<Found, String> {
        let mut left = LeftOut::default();
        let (mut readings, of_day) = self.rows(text, &mut left)?;
        if let Some(time) = self.taken.iter().position(|taken| taken.quantity == Quantity::Time) {
            self.timed(time, of_day, &mut readings, &mut left)?;
        }
        let said = self.said(&left);
        let unsigned = self.taken.iter().any(|taken| taken.how.unsigned);
        Ok(Found { readings, said, unsigned, has: self.taken.iter().map(|taken| taken.quantity).collect() })
    }

    /// All rows whose cells are numbers, in SI but for times, which are as they stand; and whether those are times of day.
    fn rows(&self, text: &str, left: &mut LeftOut) -> Result<(Vec<Reading>, bool), String> {
        let mut readings = Vec::new();
        let (mut number, mut days, mut begun) = (0_usize, 0_usize, PanTilt::new(false, false));
        let mut anew = PanTilt::new(false, false);
        self.table.0.each(text, |line, fresh, cells| {
            if number == MOST_ROWS {
                return Err(format!(":{line}: a table has at most {MOST_ROWS} rows; give a part of it"));
            }
            number += 1;
            if fresh {
                anew = PanTilt::new(true, true);
            }
            let joint = self.joint_of(line, cells)?;
            let mut values = [f64::NAN; Quantity::ALL.len()];
            for taken in &self.taken {
                let cell = match taken.how.source {
                    Source::Row => Some((number - 1) as f64),
                    Source::Column(place) => self.value(taken.quantity, cells.get(place).copied(), &mut days),
                };
                let Some(cell) = cell else {
                    left.bad += 1;
                    left.first.get_or_insert_with(|| (line, cells.join(" ")));
                    return Ok(());
                };
                values[taken.quantity as usize] = taken.si(cell, line)?;
            }
            let first = !std::mem::replace(&mut begun[joint], true);
            let fresh = std::mem::take(&mut anew[joint]) || first;
            readings.push(Reading { line, fresh, joint, values });
            Ok(())
        })?;
        let bad = left.bad as f64;
        if let Some((line, row)) = left.first.as_ref().filter(|_| bad > TOO_MANY * number as f64) {
            return Err(format!(
                ":{line}: {:?} has no numbers where they are wanted, as {} of {number} rows: are these the right columns?",
                row.chars().take(60).collect::<String>(),
                left.bad
            ));
        }
        if days > 0 && days < readings.len() {
            return Err(": some of its times are times of day, and others are numbers".into());
        }
        Ok((readings, days > 0))
    }

    fn value(&self, quantity: Quantity, cell: Option<&str>, days: &mut usize) -> Option<f64> {
        let cell = cell?;
        self.table.0.number(cell).or_else(|| {
            let day = of_day(cell).filter(|_| quantity == Quantity::Time)?;
            *days += 1;
            Some(day)
        })
    }

    fn joint_of(&self, line: u64, cells: &[&str]) -> Result<Joint, String> {
        let place = match self.joint {
            Ok(place) => place,
            Err(joint) => return Ok(joint),
        };
        let said = cells.get(place).copied().unwrap_or_default();
        Joint::BOTH
            .into_iter()
            .find(|joint| joint.name() == said)
            .ok_or_else(|| format!(":{line}: axis {said:?} is neither pan nor tilt"))
    }

    /// Makes seconds of the times of each joint, leaves out rows of a time that was there already, and finds where time falls back.
    fn timed(
        &mut self,
        time: usize,
        of_day: bool,
        readings: &mut Vec<Reading>,
        left: &mut LeftOut,
    ) -> Result<(), String> {
        const TIME: usize = Quantity::Time as usize;
        for joint in Joint::BOTH {
            let mut raw: Vec<f64> =
                readings.iter().filter(|r| r.joint == joint).map(|r| r.values[TIME]).collect();
            self.with_unit(time, of_day, &raw)?;
            left.wrapped += unwrapped(&mut raw, of_day);
            let how = &self.taken[time].how;
            let factor = how.unit.map_or(1.0, |unit| unit.1);
            let own = readings.iter_mut().filter(|r| r.joint == joint);
            own.zip(raw).for_each(|(reading, raw)| reading.values[TIME] = factor * how.of(raw));
        }
        let mut last = PanTilt::new(None, None);
        readings.retain_mut(|reading| {
            let now = reading.values[TIME];
            let before = last[reading.joint].replace(now);
            let repeats = before == Some(now) && !reading.fresh;
            reading.fresh |= before.is_none_or(|before| now < before);
            left.repeated += usize::from(repeats);
            !repeats
        });
        Ok(())
    }

    /// Times of day are seconds; whole numbers without a unit could be anything.
    fn with_unit(&mut self, time: usize, of_day: bool, raw: &[f64]) -> Result<(), String> {
        let how = &mut self.taken[time].how;
        if how.unit.is_some() || raw.is_empty() {
            return Ok(());
        }
        if !of_day && raw.iter().all(|time| time.fract() == 0.0) && how.of(1.0) - how.of(0.0) == 1.0 {
            return Err(format!(
                ": the times in {} are whole numbers, and nothing tells their unit: say --columns time={}:ms, or :us, or :s",
                how.said,
                how.said.trim_matches('"').trim_start_matches("column ")
            ));
        }
        how.unit = Some(("s", 1.0));
        Ok(())
    }

    /// What was taken for what.
    fn said(&self, left: &LeftOut) -> String {
        let one = |taken: &Taken| {
            let unit = taken.how.unit.map_or("", |unit| unit.0);
            let unit = if unit.is_empty() { String::new() } else { format!(" in {unit}") };
            format!("{} = {}{unit}", taken.quantity.name(), taken.how.said)
        };
        let mut said = self.taken.iter().map(one).collect::<Vec<_>>().join(", ");
        match self.joint {
            Ok(place) => said += &format!(", axis = {}", title(&self.table.0.names, place)),
            Err(joint) => said += &format!(", of {joint}"),
        }
        let guessed: Vec<&str> =
            self.taken.iter().filter(|taken| taken.guessed).map(|taken| taken.quantity.name()).collect();
        if !guessed.is_empty() {
            said += &format!(" ({} by the header)", guessed.join(", "));
        }
        if left.wrapped > 0 {
            said += &format!("; its counter of time began again {}", counted(left.wrapped, "time"));
        }
        if left.repeated > 0 {
            said += &format!("; {} of a time that was there already left out", counted(left.repeated, "row"));
        }
        if let Some((line, _)) = &left.first {
            said +=
                &format!("; {} without numbers left out, the first in line {line}", counted(left.bad, "row"));
        }
        said
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTION: Kind = Kind {
        code: "log",
        must: &[&[Quantity::Time], &[Quantity::Volt], &[Quantity::Count, Quantity::Angle, Quantity::Speed]],
        may: &[],
        own: "axis,volt,time_s,count",
    };

    fn found(text: &str, columns: &str, axis: Option<Joint>) -> Result<Found, String> {
        let columns = if columns.is_empty() { Columns::default() } else { columns.parse().unwrap() };
        let log = Log { name: "a.csv".into(), bytes: text.as_bytes().to_vec() };
        read(&log, &columns, axis, &MOTION).map_err(|failure| failure.message)
    }

    fn rows(found: &Found, of: Quantity) -> Vec<(f64, f64, f64)> {
        let row = |r: &Reading| (r.get(Quantity::Time), r.get(Quantity::Volt), r.get(of));
        found.readings.iter().map(row).collect()
    }

    #[test]
    fn a_board_s_log_is_read_with_a_word_about_its_drive() {
        let head = "Timestamp(ms),Motor_Speed(RPM),Commanded_PWM\n0,0,0\n10,30,255\n10,30,255\n20,boot,255\n";
        let rest: String = (3..30).map(|k| format!("{k}0,60,255\n")).collect();
        let found = found(&format!("{head}{rest}"), "volt=Commanded_PWM*12/255", Some(Joint::Tilt)).unwrap();
        let (rps, rows) = (std::f64::consts::TAU / 60.0, rows(&found, Quantity::Speed));
        assert!(
            (rows[1].0 - 0.01).abs() < 1e-12 && rows[1].1 == 12.0 && (rows[1].2 - 30.0 * rps).abs() < 1e-12
        );
        assert_eq!(rows.len(), 29);
        assert_eq!(
            found.said,
            "time = \"Timestamp(ms)\" in ms, volt = \"Commanded_PWM\" × 12 / 255 in V, speed = \"Motor_Speed(RPM)\" in rpm, \
             of tilt (time, speed by the header); 1 row of a time that was there already left out; 1 row without numbers left \
             out, the first in line 5"
        );
        assert!(found.readings[0].fresh && found.readings[1..].iter().all(|r| !r.fresh));
    }

    #[test]
    fn columns_go_by_number_and_rows_by_their_period() {
        let found =
            found("12,0.5\n12,0.75\n", "time=row*5:ms,volt=1/12,speed=2:rad/s", Some(Joint::Pan)).unwrap();
        assert_eq!(rows(&found, Quantity::Speed), [(0.0, 1.0, 0.5), (0.005, 1.0, 0.75)]);
    }

    #[test]
    fn each_joint_has_a_time_of_its_own() {
        let text = "axis;volt;time_s;count\npan;1;0;0\ntilt;2;0;5\npan;1;0,1;4\ntilt;2;0,1;6\npan;1;0;0\n";
        let found = found(text, "", None).unwrap();
        let fresh: Vec<bool> = found.readings.iter().map(|r| r.fresh).collect();
        assert_eq!(fresh, [true, true, false, false, true]);
        assert_eq!(found.of(Joint::Tilt).map(|r| r.get(Quantity::Count)).collect::<Vec<_>>(), [5.0, 6.0]);
    }

    #[test]
    fn what_is_not_told_is_asked_for() {
        let axis = Some(Joint::Pan);
        for (text, columns, axis, wanted) in [
            (
                "t,pwm,rpm\n0.1,1,2\n0.2,1,2\n",
                "",
                axis,
                "\"pwm\" drives the motor, and nothing says how many volts",
            ),
            ("t,volt,rpm\n0.1,1,2\n0.2,1,2\n", "", None, "give --axis pan or --axis tilt"),
            ("time,volt,rpm\n1,1,2\n2,1,2\n", "", axis, "say --columns time=time:ms, or :us, or :s"),
            ("1,1,2\n2,1,2\n", "time=1,volt=2,speed=3:rpm", axis, "say --columns time=1:ms, or :us, or :s"),
            (
                "t,volt,speed\n0.1,1,2\n0.2,1,2\n",
                "",
                axis,
                "say --columns speed=speed:UNIT, one of rad/s, deg/s, rpm",
            ),
            (
                "0.1,1,2\n0.2,1,2\n",
                "",
                axis,
                "no header: no column tells time; say which, such as --columns time=…; there are column 1",
            ),
            ("t,volt,left_rpm,right_rpm\n0.1,1,2,3\n0.2,1,2,3\n", "", axis, "\"left_rpm\" or \"right_rpm\""),
            (
                "t,volt,rpm\n0.1,1,2\n0.2,1,2\n",
                "torque=rpm",
                axis,
                "torque is not asked here; a log of this kind holds time, volt, count",
            ),
            ("t,volt,rpm\n0.1,1,2\n0.2,1,2\n", "speed=rpm,count=rpm", axis, "count and speed are both given"),
            (
                "t,volt,rpm\n0.1,9999,2\n0.2,1,2\n",
                "",
                axis,
                ":2: volt = 9999 V is more than any amplifier takes",
            ),
            (
                "t,volt,rpm\n0.1,1,2\n0.2,x,2\n0.3,1,y\n",
                "",
                axis,
                ":3: \"0.2 x 2\" has no numbers where they are wanted, as 2 of 3 rows",
            ),
            ("a\nb\n", "", axis, "no separator"),
        ] {
            let error = found(text, columns, axis).unwrap_err();
            assert!(error.contains(wanted), "{text}\n{error}");
        }
    }
}
