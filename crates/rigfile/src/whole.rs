//! Whether a rig file is whole: it has every key, or says whose the others are.

use tracelight_sim::{DriveKind, RigConfig};

use crate::drives::{drive_keys, follows};
use crate::hand_tuned::rig_keys;
use crate::keys::{Key, Slot, model_keys};
use crate::safety::STANDING;

/// The key that names the preset whose the keys are that a file leaves out.
pub(crate) const BASE: &str = "base";

/// Keys, or beginnings of keys, that came when rig files without them were about already. A file that has none of a row is older
/// than the row, not cut off: what is written today ends with keys that are older than all of them.
const CAME_LATER: [&str; 15] = [
    "model.pan.motor.back_emf",
    "model.pan.motor.dead_band",
    "model.tilt.motor.back_emf",
    "model.tilt.motor.dead_band",
    "model.enable.",
    "model.foot.",
    "truth.gyroscope.",
    "control.scale_tolerance",
    "control.host_lost",
    "laser.",
    "laser.operated_class",
    "safety.jolt",
    "safety.turned",
    "stepper.pan_axis",
    "stepper.tilt_axis",
];

/// The preset of a name; what may be given instead, where it is none.
pub(crate) fn preset(name: &str) -> Result<RigConfig, String> {
    RigConfig::preset(name).ok_or_else(|| {
        let known: Vec<String> = RigConfig::presets().into_iter().map(|preset| preset.name).collect();
        format!("must be one of the presets {}", known.join(", "))
    })
}

/// What a file that names no base leaves out, of keys that a rig cannot do without.
pub(crate) struct LeftOut {
    /// What every file of its kind had, in the order in which they are written.
    missing: Vec<String>,
    /// What came later than the file.
    newer: Vec<String>,
}

impl LeftOut {
    /// What is left out by a file that has the keys of these paths.
    pub(crate) fn of(given: &[&str], kind: DriveKind) -> Self {
        let is_older_than = |row: &&&str| !given.iter().any(|path| path.starts_with(**row));
        let older: Vec<&&str> = CAME_LATER.iter().filter(is_older_than).collect();
        let left_out = needed(kind).into_iter().filter(|path| !given.contains(&path.as_str()));
        let (newer, missing) = left_out.partition(|path| older.iter().any(|row| path.starts_with(**row)));
        Self { missing, newer }
    }

    /// Why a file of that name and text is not whole.
    pub(crate) fn trouble(&self, file: &str, text: &str) -> Option<String> {
        let first = self.missing.first()?;
        let lines = text.lines().count();
        let more = match self.missing.len() {
            1 => String::new(),
            all => format!(" and {} more", all - 1),
        };
        Some(format!(
            "{file}: it ends after {lines} lines and has no {first}{more}: was it cut off? Then get it whole again; if it is to hold only \
             what differs from a preset, begin it with {BASE} = \"report\""
        ))
    }

    /// What to say of a file of that name that is older than some keys.
    pub(crate) fn remark(&self, file: &str) -> Option<String> {
        let (first, last) = (self.newer.first()?, self.newer.last()?);
        let all = self.newer.len();
        Some(format!(
            "{file} is older than {all} of today's keys ({first} to {last}), which are taken from the preset report; `tracelight rigs show \
             {file}` prints it with all of them"
        ))
    }
}

/// Paths of all keys of a rig with that drive but those of what need not be: what was identified, a truth that differs, where a head is parked, where its joints end, and how long
/// light may stand, which follows from its power.
fn needed(kind: DriveKind) -> Vec<String> {
    let models = model_keys().into_iter().map(|key| format!("model.{}", key.path));
    let drive = drive_keys(kind).iter().map(|key| key.path.to_owned());
    let own = rig_keys().into_iter().filter(is_needed).map(|key| key.path.to_owned());
    drive.chain(models).chain(own).filter(|path| !follows(path, kind)).collect()
}

fn is_needed(key: &Key<RigConfig>) -> bool {
    key.path != STANDING && !matches!(key.slot, Slot::Maybe(_) | Slot::Day(_))
}

#[cfg(test)]
mod tests {
    use tracelight_plant::Wear;
    use tracelight_sim::Identified;

    use super::*;
    use crate::{parse, read, saved, write};

    /// As many rigs as there are things that need not be in a file.
    fn rigs() -> Vec<RigConfig> {
        let mut own = RigConfig::worn();
        own.name = "own".into();
        own.truth.model.motors.pan.torque_nm_per_v *= 0.9;
        own.identified = Some(Identified { date: "2026-11-28".into(), ..Identified::NONE });
        own.light.standing_s = 0.5;
        (own.safety.park_rad.pan, own.safety.park_rad.tilt) = (Some(0.5), Some(0.7));
        (own.stops_rad.pan, own.stops_rad.tilt) = ((Some(-3.5), Some(3.5)), (Some(-2.0), Some(2.1)));
        RigConfig::presets().into_iter().chain([own]).collect()
    }

    /// Cuts a text off at every byte; where that is read, it must be as the whole of it.
    fn check_cut_anywhere(text: &str, whole: &RigConfig) {
        for end in 0..text.len() {
            if let Ok(file) = read("cut.toml", text.as_bytes()[..end].to_vec()) {
                assert_eq!(&file.rig, whole, "cut off after {end} of {} bytes", text.len());
                assert_eq!(file.remark, None, "cut off after {end} bytes");
            }
        }
        let half = text.lines().take(text.lines().count() / 2).collect::<Vec<_>>().join("\n");
        assert!(parse("cut.toml", &half).unwrap_err().contains("was it cut off?"));
    }

    #[test]
    fn a_file_that_was_cut_off_anywhere_is_refused() {
        for rig in rigs() {
            let text = write(&rig);
            assert_eq!(parse("whole.toml", &text).unwrap(), rig);
            check_cut_anywhere(&text, &rig);
        }
    }

    #[test]
    fn so_is_one_into_which_something_was_saved() {
        let old = RigConfig::report();
        let mut new = RigConfig { identified: rigs()[2].identified.clone(), ..old.clone() };
        new.model.motors.pan.torque_nm_per_v *= 1.1;
        let text = saved("my.toml", &write(&old), &old, &new).unwrap();
        let whole = parse("my.toml", &text).unwrap();
        assert_eq!((whole.model, whole.truth.model), (new.model, old.model));
        check_cut_anywhere(&text, &whole);
    }

    #[test]
    fn the_first_key_that_is_missing_is_named_and_what_to_do() {
        let text = write(&RigConfig::report());
        for (from, to, named) in [
            ("gravity = ", "# ", "after 127 lines and has no model.gravity:"),
            ("limit = ", "# ", "has no model.pan.motor.limit:"),
            ("power = ", "# ", "has no laser.power:"),
            ("settle = ", "# ", "has no motion.settle:"),
        ] {
            let without = text.replacen(&format!("\n{from}"), &format!("\n{to}{from}"), 1);
            let error = parse("my.toml", &without).unwrap_err();
            let named = named.replace("127", &text.lines().count().to_string());
            assert!(error.starts_with("my.toml: it ends after ") && error.contains(&named), "{error}");
            assert!(error.contains("begin it with base = \"report\""), "{error}");
        }
        let none = parse("my.toml", "").unwrap_err();
        assert!(none.contains("after 0 lines and has no model.gravity and "), "{none}");
    }

    #[test]
    fn a_file_with_a_base_leaves_out_what_is_as_in_that_preset() {
        let of = |text: &str| parse("my.toml", text).unwrap();
        for preset in RigConfig::presets() {
            assert_eq!(of(&format!("base = \"{}\"", preset.name)), preset);
            assert_eq!(preset.truth.model, preset.model, "a truth that is left out is as the model");
        }
        let wide = of("name = \"wide\"\nbase = \"worn\"\n[control]\ntolerance = \"5mm\"\n");
        let worn = RigConfig::worn();
        assert_eq!((wide.name.as_str(), wide.control.tolerance_m), ("wide", 5e-3));
        assert_eq!((wide.truth, wide.motion), (worn.truth, worn.motion));
        assert_ne!(wide.truth.wear, Wear::NONE);
        let none = parse("my.toml", "base = \"brand-new\"\n").unwrap_err();
        assert!(
            none.contains("my.toml:1:8")
                && none.contains("one of the presets report, report-b, worn, bridge, stepper, servo"),
            "{none}"
        );
        assert!(parse("my.toml", "base = 3\n").unwrap_err().contains("base must be text"));
    }

    /// A line of the text, and what it is under, for each key that stands in it.
    fn without(text: &str, left_out: impl Fn(&str) -> bool) -> String {
        let mut table = String::new();
        let mut kept = String::new();
        for line in text.lines() {
            if let Some(name) = line.strip_prefix('[') {
                table = format!("{}.", name.trim_end_matches(']'));
            }
            let path = format!("{table}{}", line.split(" = ").next().unwrap_or_default());
            if !left_out(&path) {
                kept += &format!("{line}\n");
            }
        }
        kept
    }

    #[test]
    fn a_file_older_than_some_keys_is_read_and_says_so() {
        let whole = write(&RigConfig::report());
        let old = without(&whole, |path| CAME_LATER.iter().any(|row| path.starts_with(row)));
        let file = read("old.toml", old.clone().into_bytes()).unwrap();
        assert_eq!(file.rig, RigConfig::report());
        let remark = file.remark.unwrap();
        assert!(
            remark.contains("older than 19 of today's keys (model.enable.on to safety.turned)"),
            "{remark}"
        );
        assert_eq!(read("new.toml", whole.clone().into_bytes()).unwrap().remark, None);
        // it is whole for what it is, and half a row is not older than the row
        assert!(parse("old.toml", &without(&old, |path| path == "control.hand_tuned.tilt.kp")).is_err());
        let half = parse("my.toml", &without(&whole, |path| path == "laser.power")).unwrap_err();
        assert!(half.contains("has no laser.power"), "{half}");
    }
}
