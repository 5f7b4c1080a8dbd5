//! Logs as people have them: a made motor of known friction and inertia, written down as many boards do, read back by one command.

use std::fmt::Write;

use serde_json::Value;

use crate::support::{folder, lab, near, run};

/// A motor: speed a volt beyond what friction takes, rad/s; those volts; time constant, s; what its driver gives at most, V.
#[derive(Clone, Copy)]
struct Motor {
    rad_s_per_v: f64,
    beyond_v: f64,
    constant_s: f64,
    limit_v: f64,
}

const MOTOR: Motor = Motor { rad_s_per_v: 12.0, beyond_v: 1.1, constant_s: 0.15, limit_v: f64::INFINITY };

/// Seconds, volts told, speed and angle.
type Row = (f64, f64, f64, f64);

impl Motor {
    /// Rows each so much time under some volts, each held for a second and then let go for another: exact.
    fn rows(self, volts: &[f64], step_s: f64) -> Vec<Row> {
        let (mut all, mut time_s, mut rate, mut angle) = (Vec::new(), 0.0, 0.0_f64, 0.0);
        for told in volts.iter().flat_map(|volts| [*volts, 0.0]) {
            for _ in 0..(1.0 / step_s).round() as usize {
                all.push((time_s, told, rate, angle));
                let volts = told.clamp(-self.limit_v, self.limit_v);
                let way = if rate == 0.0 { volts.signum() } else { rate.signum() };
                let end = self.rad_s_per_v * (volts - way * self.beyond_v);
                let next = end + (rate - end) * (-step_s / self.constant_s).exp();
                let stops = rate == 0.0 && volts.abs() <= self.beyond_v || next * way < 0.0;
                let next = if stops { 0.0 } else { next };
                angle += 0.5 * (rate + next) * step_s;
                rate = next;
                time_s += step_s;
            }
        }
        all
    }
}

/// −8 to 8 V, without those at which it hardly turns.
fn steps() -> Vec<f64> {
    (-8..=8).filter(|k: &i32| k.abs() > 2).map(f64::from).collect()
}

fn written(name: &str, text: impl AsRef<[u8]>) -> String {
    let path = folder(&format!("own-logs-{}", name.replace('.', "-"))).join(name);
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

/// Rows as text, and a head above them.
fn table(head: &str, rows: &[Row], row: impl Fn(&Row) -> String) -> String {
    rows.iter().fold(head.to_owned(), |text, one| text + &row(one) + "\n")
}

fn friction(log: &str, columns: &str) -> Value {
    let out = format!("{log}.out");
    let told = ["friction", log, "--axis", "pan", "--fixture", "--out", &out];
    let columns = ["--columns", columns];
    let found = lab(&[&told[..], if columns[1].is_empty() { &[] } else { &columns }].concat());
    found["pan"].clone()
}

fn check(found: &Value, share: f64) {
    for (side, way) in [(0, 1.0), (1, -1.0)] {
        near(&found["rad_s_per_v"][side], MOTOR.rad_s_per_v, share * MOTOR.rad_s_per_v);
        near(&found["coulomb_v"][side], way * MOTOR.beyond_v, share * MOTOR.beyond_v);
        near(&found["time_constants_s"][side], MOTOR.constant_s, 2.0 * share * MOTOR.constant_s);
    }
    assert!(
        found["r2"].as_f64().unwrap() > 0.999 && found["replayed_r2"].as_f64().unwrap() > 0.999,
        "{found}"
    );
}

/// Turns a minute.
fn rpm(rad_s: f64) -> f64 {
    rad_s * 60.0 / std::f64::consts::TAU
}

#[test]
fn a_motor_is_identified_from_its_log_however_that_is_written() {
    let rows = MOTOR.rows(&steps(), 0.005);
    let comma = |number: f64| format!("{number:.3}").replace('.', ",");
    let micros = |t: f64| (4_290_000_000.0 + 1e6 * t).rem_euclid(4_294_967_296.0).round();
    let day = |t: f64| match t {
        t if t < 10.0 => format!("2026-11-28 23:59:{:06.3}", 50.0 + t),
        t => format!("2026-11-29 00:00:{:06.3}", t - 10.0),
    };
    let logs: [(&str, String, &str); 6] = [
        (
            "board.csv",
            table("Timestamp(ms),Motor_Speed(RPM),Commanded_PWM\n", &rows, |(t, v, w, _)| {
                format!("{:.0},{:.2},{:.0}", 1e3 * t, rpm(*w), v * 255.0 / 12.0)
            }),
            "volt=Commanded_PWM*12/255",
        ),
        (
            "bare.txt",
            table("", &rows, |(_, v, w, _)| format!("{:.4} {:.3}", v / 12.0, w)),
            "time=row*5:ms,volt=1*12,speed=2:rad/s",
        ),
        (
            "german.csv",
            table(
                "\u{feff}# Prüfstand\r\nZeit [s];Spannung [V];Drehzahl [U/min]\r\n",
                &rows,
                |(t, v, w, _)| format!("{};{};{}\r", comma(*t), comma(*v), comma(rpm(*w))),
            ),
            "",
        ),
        (
            "counted.csv",
            table("micros\tvoltage_mV\tencoder\n", &rows, |(t, v, _, a)| {
                format!("{}\t{:.0}\t{}", micros(*t), 1e3 * v, (a * 4096.0 / std::f64::consts::TAU).floor())
            }),
            "",
        ),
        (
            "unsigned.csv",
            table("t,duty,deg\n", &rows, |(t, v, _, a)| {
                format!("{t:.3},{:.2},{:.2}", v.abs() / 0.12, a.to_degrees())
            }),
            "time=t,volt=|duty|*12/100,angle=deg:deg",
        ),
        (
            "dated.csv",
            table("datetime,volt,omega (rad/s)\n", &rows[..3600], |(t, v, w, _)| {
                format!("{},{v},{w:.3}", day(*t))
            }),
            "",
        ),
    ];
    for (name, text, columns) in logs {
        let found = friction(&written(name, text), columns);
        // its last rows are cut off, and with them most of the way forwards
        if name == "dated.csv" {
            near(&found["rad_s_per_v"][1], MOTOR.rad_s_per_v, 0.02 * MOTOR.rad_s_per_v);
        } else {
            check(&found, 0.02);
        }
    }
}

#[test]
fn repeated_missing_and_garbled_rows_are_borne_and_told() {
    let mut text = String::from("ready\ntime_ms,volt,rpm\n");
    for (number, (t, v, w, _)) in MOTOR.rows(&steps(), 0.005).into_iter().enumerate() {
        let row = format!("{:.0},{v},{:.2}\n", 1e3 * t, rpm(w));
        text += match number % 50 {
            7 => "",
            13 => "1,2\n",
            _ => &row,
        };
        if number % 50 == 20 {
            text += &row;
        }
    }
    let found = friction(&written("host.csv", text), "");
    check(&found, 0.02);
    let said = found["read_as"][0].as_str().unwrap();
    for word in
        ["96 rows of a time that was there already", "96 rows without numbers left out, the first in line 15"]
    {
        assert!(said.contains(word), "{said}");
    }
}

#[test]
fn speeds_that_stand_whatever_the_volts_are_left_out() {
    let weak = Motor { limit_v: 6.0, ..MOTOR };
    let volts: Vec<f64> = (-16..=16).filter(|k: &i32| k.abs() > 4).map(|k| 0.5 * f64::from(k)).collect();
    let text =
        table("time_s,volt,rad/s\n", &weak.rows(&volts, 0.005), |(t, v, w, _)| format!("{t:.3},{v},{w:.4}"));
    let found = friction(&written("weak.csv", text), "speed=rad/s:rad/s");
    // 6, 6.5, 7, 7.5 and 8 V each way
    assert_eq!(found["left_out"], 10);
    check(&found, 0.02);
}

#[test]
fn a_direction_that_was_not_seen_is_told_as_none() {
    let rows = MOTOR.rows(&[3.0, 4.0, 5.0, 6.0, 7.0, 8.0], 0.005);
    // it rattles where it stands, by a step of its speed
    let text = table("time_s,volt,rpm\n", &rows, |(t, v, w, _)| {
        format!("{t:.3},{v},{:.2}", if *w == 0.0 { -1.24 } else { rpm(*w) })
    });
    let log = written("forwards.csv", text);
    let output =
        run(&["lab", "friction", &log, "--axis", "pan", "--fixture", "--out", &format!("{log}.out")]);
    let said = String::from_utf8(output.stdout).unwrap();
    let line =
        |what: &str| said.lines().find(|line| line.starts_with(what)).unwrap_or_else(|| panic!("{said}"));
    assert!(line("viscous −").contains('–') && line("Coulomb −").contains('–'), "{said}");
    assert!(line("viscous +").contains('±'), "{said}");
}

#[test]
fn what_could_be_two_things_is_refused_with_both() {
    let log = written("two.csv", "time,leftRpm,rightRpm,pwm\n0,1,1,0\n5,2,2,9\n10,3,3,9\n");
    let refused = |more: &[&str]| {
        let output = run(&[&["lab", "friction", &log], more].concat());
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8(output.stderr).unwrap()
    };
    for (more, wanted) in [
        (&["--axis", "pan"][..], "volt=pwm*12/255 where 255 is 12 V"),
        (&["--axis", "pan", "--columns", "volt=pwm"], "\"leftRpm\" or \"rightRpm\""),
        (&["--axis", "pan", "--columns", "volt=pwm,speed=leftRpm"], "time=time:ms, or :us, or :s"),
        (&["--columns", "volt=pwm,speed=leftRpm,time=time:ms"], "give --axis pan or --axis tilt"),
        (
            &["--axis", "tilt", "--columns", "volt=pwm,speed=leftRpm,time=time:ms"],
            "a log of speeds tells no angle",
        ),
        (&["--axis", "pan", "--columns", "volt=pwm,spead=leftRpm"], "one of time, volt"),
    ] {
        let said = refused(more);
        assert!(said.contains(wanted), "{more:?}: {said}");
    }
}

#[test]
fn a_host_that_loses_one_row_in_fifty_still_measures_a_frequency_response() {
    let dir = folder("own-logs-frequency");
    let [log, lost, foreign] =
        ["log.csv", "lost.csv", "foreign.csv"].map(|name| dir.join(name).to_str().unwrap().to_owned());
    let short = ["frequency", "--period", "2s", "--from", "4rad/s", "--to", "200rad/s", "--sines", "20"];
    lab(&[&short[..], &["--periods", "6", "--record", &log]].concat());
    let whole = lab(&["frequency", &log, "--period", "2s"]);
    let text = std::fs::read_to_string(&log).unwrap();
    let mut lines = text.lines();
    let head = lines.next().unwrap();
    let (mut some, mut other) = (head.to_owned() + "\n", String::from("millis;counts;u\n"));
    for (number, line) in lines.enumerate() {
        // one in fifty, and once a long gap
        if number % 50 == 31 || (2500..2600).contains(&number) {
            continue;
        }
        let _ = writeln!(some, "{line}");
        let cells: Vec<&str> = line.split(',').collect();
        let ms = 1e3 * cells[1].parse::<f64>().unwrap();
        let _ = writeln!(other, "{ms:.0};{};{}", cells[3], cells[2].replace('.', ","));
    }
    std::fs::write(&lost, some).unwrap();
    std::fs::write(&foreign, other).unwrap();
    let by_own = lab(&["frequency", &lost, "--period", "2s"]);
    let by_foreign = lab(&["frequency", &foreign, "--period", "2s", "--axis", "pan", "--columns", "volt=u"]);
    let of = |found: &Value| found["points"].as_array().unwrap().clone();
    for found in [&by_own, &by_foreign] {
        let said = found["read_as"].to_string();
        assert!(
            said.contains("told from those beside them") && said.contains("1 of 6 periods left out"),
            "{said}"
        );
        for (found, whole) in of(found).iter().zip(of(&whole)) {
            let value = |point: &Value, what: &str| point[what].as_f64().unwrap();
            let share = value(found, "magnitude") / value(&whole, "magnitude") - 1.0;
            let within = 3e-3 + 3.0 * value(&whole, "deviation");
            assert!(share.abs() < within, "{share} {found} {whole}");
        }
    }
    assert_eq!(of(&by_own).len(), of(&whole).len());
}

#[test]
fn readings_edges_and_records_of_others_are_read_by_their_commands() {
    let example =
        |name: &str| std::fs::read_to_string(crate::support::root().join("examples").join(name)).unwrap();
    // amplifier: the joint pan alone, millivolts and milliamperes
    let own = example("amplifier.csv");
    let mut other = String::from("U (mV)\tI (mA)\tspeed (deg/s)\n");
    for line in own.lines().filter(|line| line.starts_with("pan")) {
        let cells: Vec<f64> = line.split(',').skip(1).map(|cell| cell.parse().unwrap()).collect();
        let _ = writeln!(other, "{}\t{}\t{}", 1e3 * cells[0], 1e3 * cells[1], cells[2].to_degrees());
    }
    let log = written("amplifier.tsv", other);
    let out = format!("{log}.out");
    let told =
        lab(&["amplifier", &log, "--axis", "pan", "--columns", "volt=U (mV),ampere=I (mA)", "--out", &out]);
    let own_log = written("amplifier.csv", own);
    let wanted = lab(&["amplifier", &own_log, "--axis", "pan", "--out", &out]);
    for name in ["a_per_v", "back_emf_a_s_per_rad"] {
        let value = wanted["pan"][name].as_f64().unwrap();
        near(&told["pan"][name], value, 1e-9 + 1e-6 * value.abs());
    }
    // edges
    let edges = example("edges.csv");
    let other = edges.replace("pan,", "").replace("axis,time_s,count", "t;ticks").replace(',', ";");
    let log = written("edges.txt", other);
    let told = lab(&["encoder", &log, "--axis", "pan", "--out", &out]);
    let own_log = written("edges.csv", edges);
    let wanted = lab(&["encoder", &own_log, "--out", &out]);
    assert_eq!(told["pan"]["kinds_counts"], wanted["pan"]["kinds_counts"]);
    let speeds = written("speeds.csv", "t,rpm\n0.1,1\n0.2,2\n");
    let refused = run(&["lab", "encoder", &speeds, "--axis", "pan"]);
    assert!(String::from_utf8_lossy(&refused.stderr).contains("a log of speeds has none"));
}

#[test]
fn one_joint_is_identified_from_volts_and_counts() {
    let dir = folder("own-logs-identify");
    let out = dir.to_str().unwrap();
    lab(&["identify", "--out", out]);
    let record = std::fs::read_to_string(dir.join("record.csv")).unwrap();
    let mut other = String::from("ms,volts,encoder\n");
    for (number, line) in record.lines().skip(1).enumerate().filter(|(number, _)| number % 500 != 77) {
        let cells: Vec<&str> = line.split(',').collect();
        let _ = writeln!(other, "{number},{},{}", cells[3], cells[1]);
    }
    let log = written("pan.csv", other);
    let again = format!("{log}.out");
    let found = lab(&["identify", &log, "--axis", "pan", "--columns", "time=ms:ms", "--out", &again]);
    assert!(found["tilt"].is_null() && found["read_as"].to_string().contains("are filled in"), "{found}");
    let of = |name: &str| found["pan"]["found"][name].as_f64().unwrap();
    let believed = |name: &str| found["pan"]["believed"][name].as_f64().unwrap();
    // the simulated rig is as it is believed to be, or was found better
    let ratio = |of: &dyn Fn(&str) -> f64| of("torque_nm_per_v") / of("inertia_kg_m2");
    let off = ratio(&of) / ratio(&believed) - 1.0;
    assert!(off.abs() < 0.02, "{off} {found}");
    assert!(found["pan"]["stretches"].as_u64().unwrap() > 50, "{found}");
}
