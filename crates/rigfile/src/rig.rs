//! A rig as text and back.

use std::ops::Range;

use toml_edit::{Document, Item, TableLike, Value};
use tracelight_sim::{Day, DriveKind, Identified, LightSettings, Model, RigConfig};
use tracelight_task::Failure;
use tracelight_units as units;

use crate::caret::Mark;
use crate::drives::{DRIVE, all_drive_keys, drive_key, drive_keys, follows, of_other_drive};
use crate::found::identified_keys;
use crate::hand_tuned::rig_keys;
use crate::keys::{Choice, Key, Slot, model_keys};
use crate::possible::possible;
use crate::safety::STANDING;
use crate::text::{Kind, text_of};
use crate::whole::{BASE, LeftOut, preset};

/// Largest rig file, bytes: a hundred times what `rigs show` prints.
const MOST_BYTES: usize = 1 << 20;

const KIND: Kind = Kind { name: "rig", code: "rig-file", most_bytes: MOST_BYTES };

/// What is in a rig file.
#[derive(Clone, Debug, PartialEq)]
pub struct RigFile {
    /// The rig.
    pub rig: RigConfig,
    /// What its owner should know of the file: that it is older than some keys.
    pub remark: Option<String>,
}

/// The rig of a file's bytes: one that has every key, or that names with `base` the preset whose the others are.
///
/// # Errors
/// `rig-file`, with file, line and caret, or the first key that is missing.
pub fn read(file: &str, bytes: Vec<u8>) -> Result<RigFile, Failure> {
    let text = text_of(&KIND, file, bytes)?;
    parsed(file, &text).map_err(|message| Failure::usage(KIND.code, message))
}

/// One value of a file with where it stands.
struct Entry<'a> {
    path: String,
    value: &'a Value,
    /// Of the key, for unknown ones.
    key_span: Option<Range<usize>>,
}

/// Parses a file, as [`read`] does.
///
/// # Errors
/// The whole message, with file, line and caret.
pub fn parse(file: &str, text: &str) -> Result<RigConfig, String> {
    parsed(file, text).map(|file| file.rig)
}

fn parsed(file: &str, text: &str) -> Result<RigFile, String> {
    let document = Document::parse(text).map_err(|e| {
        let place = Mark { file, text, span: e.span() };
        place.message(&format!("not valid TOML: {}", e.message().trim()))
    })?;
    let mut entries = Vec::new();
    flatten("", document.as_table(), &mut entries);
    let base = based(file, text, &entries)?;
    let mut config = base.clone().unwrap_or_else(RigConfig::report);
    let models = model_keys();
    // the model first: the truth starts from it, wherever it stands in the file
    for entry in &entries {
        let Some(path) = entry.path.strip_prefix("model.") else { continue };
        let place = Mark { file, text, span: entry.value.span() };
        let Some(key) = models.iter().find(|k| k.path == path) else {
            return Err(unknown(file, text, entry));
        };
        set(key, &mut config.model, entry, &place)?;
    }
    config.truth.model = config.model;
    for entry in entries.iter().filter(|e| !e.path.starts_with("model.")) {
        let place = Mark { file, text, span: entry.value.span() };
        set_other(&models, &mut config, entry, &place).unwrap_or_else(|| Err(unknown(file, text, entry)))?;
    }
    for entry in &entries {
        if let Some(trouble) = of_other_drive(&entry.path, config.drive.kind) {
            return Err(Mark { file, text, span: entry.key_span.clone() }.message(&trouble));
        }
    }
    config = config.driven();
    let remark = if base.is_none() { whole(file, text, &entries, config.drive.kind)? } else { None };
    if !entries.iter().any(|entry| entry.path == STANDING) {
        config.light.standing_s = LightSettings::usual_standing_s(config.light.power_w);
    }
    possible(&config).map_err(|trouble| format!("{file}: {trouble}"))?;
    Ok(RigFile { rig: config, remark })
}

/// The preset that a file names as its base, if it does.
fn based(file: &str, text: &str, entries: &[Entry<'_>]) -> Result<Option<RigConfig>, String> {
    let Some(entry) = entries.iter().find(|entry| entry.path == BASE) else { return Ok(None) };
    let place = Mark { file, text, span: entry.value.span() };
    let name = entry.value.as_str().ok_or_else(|| place.message(&format!("{BASE} must be text")))?;
    preset(name).map(Some).map_err(|what| place.message(&format!("{BASE}: {what}")))
}

/// What to remark of a file without a base that is whole.
fn whole(file: &str, text: &str, entries: &[Entry<'_>], kind: DriveKind) -> Result<Option<String>, String> {
    let given: Vec<&str> = entries.iter().map(|entry| entry.path.as_str()).collect();
    let left_out = LeftOut::of(&given, kind);
    left_out.trouble(file, text).map_or_else(|| Ok(left_out.remark(file)), Err)
}

/// Sets a key outside `[model]`; `None` if there is no such key.
fn set_other(
    models: &[Key<Model>],
    config: &mut RigConfig,
    entry: &Entry<'_>,
    place: &Mark<'_>,
) -> Option<Result<(), String>> {
    match (entry.path.as_str(), entry.value) {
        ("name", Value::String(s)) => {
            config.name = s.value().clone();
            return Some(Ok(()));
        }
        ("description", Value::String(s)) => {
            config.description = s.value().clone();
            return Some(Ok(()));
        }
        ("identified.date", Value::String(s)) => {
            config.identified.get_or_insert(Identified::NONE).date = s.value().clone();
            return Some(Ok(()));
        }
        (BASE, _) => return Some(Ok(())), // what everything else started from
        ("name" | "description" | "identified.date", _) => {
            return Some(Err(place.message(&format!("{} must be text", entry.path))));
        }
        _ => {}
    }
    if let Some(path) = entry.path.strip_prefix("identified.") {
        let keys = identified_keys();
        let key = keys.iter().find(|k| k.path == path)?;
        return Some(set(key, config.identified.get_or_insert(Identified::NONE), entry, place));
    }
    if let Some(key) = own_keys().find(|k| k.path == entry.path) {
        return Some(set(&key, config, entry, place));
    }
    let path = entry.path.strip_prefix("truth.")?;
    let key = models.iter().find(|k| k.path == path)?;
    Some(set(key, &mut config.truth.model, entry, place))
}

/// Every value under a table with its dotted path.
fn flatten<'a>(prefix: &str, table: &'a dyn TableLike, into: &mut Vec<Entry<'a>>) {
    for (name, item) in table.iter() {
        let path = if prefix.is_empty() { name.to_owned() } else { format!("{prefix}.{name}") };
        match item {
            Item::Table(inner) => flatten(&path, inner, into),
            Item::Value(Value::InlineTable(inner)) => flatten(&path, inner, into),
            Item::Value(value) => {
                let key_span = table.key(name).and_then(|k| k.span());
                into.push(Entry { path, value, key_span });
            }
            // no key here is an array: whatever stands in one is reported as unknown under this name
            Item::ArrayOfTables(tables) => tables.iter().for_each(|t| flatten(&format!("{path}[]"), t, into)),
            Item::None => {}
        }
    }
}

fn unknown(file: &str, text: &str, entry: &Entry<'_>) -> String {
    const MOST_AWAY: usize = 2; // letters that are wrong, missing, too many, or in each other's place
    const LONGEST: usize = 80; // no key is longer, and comparing takes the product of the lengths
    let place = Mark { file, text, span: entry.key_span.clone() };
    if entry.path.len() > LONGEST {
        let start: String = entry.path.chars().take(LONGEST).collect();
        return place.message(&format!("unknown key {start}…"));
    }
    let near = known_paths().into_iter().map(|path| (strsim::damerau_levenshtein(&entry.path, &path), path));
    let hint = match near.filter(|(away, _)| *away <= MOST_AWAY).min() {
        Some((_, path)) => format!("did you mean {path}?"),
        None => members(&entry.path),
    };
    place.message(&format!("unknown key {}; {hint}", entry.path))
}

/// What stands in the table that a key is in, or in the last of the tables around it that there is.
fn members(path: &str) -> String {
    let known = known_paths();
    let mut table = path;
    loop {
        table = table.rsplit_once('.').map_or("", |(table, _)| table);
        let prefix = if table.is_empty() { String::new() } else { format!("{table}.") };
        let inside = known.iter().filter_map(|path| path.strip_prefix(&prefix));
        let mut names: Vec<&str> = inside.map(|rest| rest.split('.').next().unwrap_or(rest)).collect();
        names.sort_unstable();
        names.dedup();
        if names.is_empty() && !table.is_empty() {
            continue;
        }
        let names = names.join(", ");
        return if table.is_empty() {
            format!("there are {names}")
        } else {
            format!("[{table}] has {names}")
        };
    }
}

/// Every key that is of no model, whatever the drive.
fn own_keys() -> impl Iterator<Item = Key<RigConfig>> {
    rig_keys().into_iter().chain(all_drive_keys())
}

fn known_paths() -> Vec<String> {
    let halves =
        ["model", "truth"].map(|half| model_keys().into_iter().map(move |k| format!("{half}.{}", k.path)));
    let found = identified_keys().into_iter().map(|k| format!("identified.{}", k.path));
    let texts = [BASE, "name", "description", "identified.date"].map(str::to_owned);
    let own = own_keys().map(|k| k.path.to_owned()).chain(texts);
    halves.into_iter().flatten().chain(found).chain(own).collect()
}

fn set<T>(key: &Key<T>, target: &mut T, entry: &Entry<'_>, place: &Mark<'_>) -> Result<(), String> {
    let complain = |what: String| place.message(&format!("{}: {what}", entry.path));
    if let Slot::Flag(field) = key.slot {
        let flag = entry.value.as_bool().ok_or_else(|| complain("must be true or false".into()))?;
        *field(target) = flag;
        return Ok(());
    }
    if let Slot::Choice(Choice { names, set, .. }) = key.slot {
        let known = names();
        let name = entry.value.as_str().filter(|name| known.contains(name));
        let name = name.ok_or_else(|| complain(format!("must be one of {}", known.join(", "))))?;
        set(target, name);
        return Ok(());
    }
    if let Slot::Day(field) = key.slot {
        let day = entry.value.as_str().and_then(Day::read);
        *field(target) =
            Some(day.ok_or_else(|| complain("must be a day as a text, such as \"2026-11-30\"".into()))?);
        return Ok(());
    }
    let value = number(key, entry.value).map_err(&complain)?;
    let (low, high) = key.bounds;
    if !(low <= value && value <= high) {
        let unit = key.units.first().map_or("", |u| u.0);
        let given = entry.value.to_string();
        return Err(complain(format!("{} must be from {low}{unit} to {high}{unit}", given.trim())));
    }
    match key.slot {
        Slot::Real(field) => *field(target) = value,
        Slot::Maybe(field) => *field(target) = Some(value),
        Slot::Count(field) if value.fract() == 0.0 => *field(target) = value as u32,
        Slot::Count(_) => return Err(complain("must be a whole number".into())),
        Slot::Flag(_) | Slot::Choice(_) | Slot::Day(_) => {}
    }
    Ok(())
}

/// A value in SI: a text with its unit, or a bare number where there is none.
fn number<T>(key: &Key<T>, value: &Value) -> Result<f64, String> {
    let fits = || key.units.iter().map(|u| u.0).collect::<Vec<_>>().join(", ");
    let bare = value.as_float().or_else(|| value.as_integer().map(|i| i as f64));
    match (value.as_str(), bare) {
        (Some(text), _) if !key.units.is_empty() => units::parse(text, key.units).map_err(|e| e.to_string()),
        (None, Some(number)) if key.units.is_empty() => Ok(number),
        (_, Some(number)) => Err(format!("{number} has no unit; write it as a text with one of {}", fits())),
        _ if key.units.is_empty() => Err("must be a bare number".into()),
        _ => Err(format!("must be a text with a number and one of {}", fits())),
    }
}

/// A rig as a file, every key with its meaning. What need not be there comes before the last keys that must, so that what is cut off
/// anywhere is not whole.
#[must_use]
pub fn write(config: &RigConfig) -> String {
    let mut config = config.clone();
    let mut text = String::from(
        "# A rig file for Tracelight. [model]: what planner and controller believe. [truth]: what the simulated head\n\
         # is; keys left out there are as in [model]. This file has all other keys; one that begins\n\
         # with `base = \"report\"` may leave out what is as in that preset.\n\n",
    );
    text += &format!("name = {}\ndescription = {}\n", quoted(&config.name), quoted(&config.description));
    let drive = format!("{DRIVE} = {}", shown(&drive_key(), &mut config));
    text += &format!("{drive:50} # {}\n", drive_key().meaning);
    let kind = config.drive.kind;
    section(&mut text, "", drive_keys(kind), &mut config);
    let models: Vec<_> =
        model_keys().into_iter().filter(|key| !follows(&format!("model.{}", key.path), kind)).collect();
    let (mut model, mut truth) = (config.model, config.truth.model);
    section(&mut text, "model", &models, &mut model);
    let differs = |key: &Key<Model>| shown(key, &mut config.model.clone()) != shown(key, &mut truth.clone());
    let different: Vec<_> = models.iter().copied().filter(differs).collect();
    section(&mut text, "truth", &different, &mut truth);
    if let Some(identified) = &mut config.identified {
        text += &format!("\n[identified]\ndate = {}\n", quoted(&identified.date));
        section(&mut text, "identified", &identified_keys(), identified);
    }
    let own: Vec<_> = rig_keys().into_iter().filter(|key| !follows(key.path, kind)).collect();
    section(&mut text, "", &own, &mut config);
    follow_power(&mut text, &config.light);
    text
}

/// Makes a comment of what follows from the laser's power, so that it goes on doing so when somebody changes that.
fn follow_power(text: &mut String, light: &LightSettings) {
    if light.standing_s == LightSettings::usual_standing_s(light.power_w) {
        *text = text.replacen("\nstanding = ", "\n# standing = ", 1);
    }
}

fn quoted(text: &str) -> String {
    Value::from(text).to_string()
}

/// Keys grouped under their tables, tables in the order in which they first appear.
fn section<T>(text: &mut String, prefix: &str, keys: &[Key<T>], from: &mut T) {
    let table_of = |key: &Key<T>| {
        let own = key.path.rsplit_once('.').map_or("", |(table, _)| table);
        [prefix, own].into_iter().filter(|p| !p.is_empty()).collect::<Vec<_>>().join(".")
    };
    let mut tables: Vec<String> = Vec::new();
    keys.iter().map(&table_of).for_each(|table| {
        if !tables.contains(&table) {
            tables.push(table);
        }
    });
    for table in tables {
        *text += &format!("\n[{table}]\n");
        for key in keys.iter().filter(|k| table_of(k) == table) {
            let name = key.path.rsplit_once('.').map_or(key.path, |(_, name)| name);
            let left_out = if is_absent(key, from) { "# " } else { "" };
            *text +=
                &format!("{:50} # {}\n", format!("{left_out}{name} = {}", shown(key, from)), key.meaning);
        }
    }
}

/// Whether a rig does not have what the key sets.
fn is_absent<T>(key: &Key<T>, from: &mut T) -> bool {
    match key.slot {
        Slot::Maybe(field) => field(from).is_none(),
        Slot::Day(field) => field(from).is_none(),
        _ => false,
    }
}

/// A value as it stands in a file: shortest digits that read back to the same bits; 0 of what the rig does not have.
pub(crate) fn shown<T>(key: &Key<T>, from: &mut T) -> String {
    let quantity = |value: f64| match key.units.first() {
        Some((unit, _)) => format!("\"{value}{unit}\""),
        None => format!("{value:?}"),
    };
    match key.slot {
        Slot::Real(field) => quantity(*field(from)),
        Slot::Maybe(field) => quantity(field(from).unwrap_or_default()),
        Slot::Day(field) => quoted(&field(from).map_or_else(|| "2026-11-30".into(), |day| day.to_string())),
        Slot::Count(field) => field(from).to_string(),
        Slot::Flag(field) => field(from).to_string(),
        Slot::Choice(Choice { get, .. }) => quoted(get(from)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With what it leaves out from the preset `report`.
    fn based(text: &str) -> Result<RigConfig, String> {
        parse("my.toml", &format!("base = \"report\"\n{text}"))
    }

    fn refused(text: &str) -> String {
        based(text).unwrap_err()
    }

    fn error(text: &str) -> String {
        parse("my.toml", text).unwrap_err()
    }

    #[test]
    fn every_preset_reads_back_to_the_same_bits() {
        for preset in RigConfig::presets() {
            assert_eq!(parse("rig.toml", &write(&preset)).unwrap(), preset);
        }
    }

    #[test]
    fn the_truth_starts_from_the_model_wherever_that_stands() {
        let text = "[truth.pan.motor]\nlimit = \"9V\"\n[model.pan.motor]\ntorque_per_volt = \"0.05Nm/V\"\n";
        let rig = based(text).unwrap();
        assert_eq!(rig.truth.model.motors.pan.torque_nm_per_v, 0.05);
        assert_eq!((rig.model.motors.pan.limit_v, rig.truth.model.motors.pan.limit_v), (10.0, 9.0));
    }

    #[test]
    fn a_host_may_be_silent_for_a_second_and_light_stray_by_50_mm_at_most() {
        let control = |key: &str, value: &str| format!("[control]\n{key} = \"{value}\"\n");
        assert!(based(&control("host_silence", "1s")).is_ok());
        assert!(based(&control("tolerance", "50mm")).is_ok());
        let silence = error(&control("host_silence", "1.01s"));
        assert!(silence.contains("must be from 0.005s to 1s"), "{silence}");
        let lost = refused("[control]\nhost_silence = \"0.5s\"\nhost_lost = \"0.4s\"\n");
        assert!(lost.contains("host_lost must be no less than host_silence"), "{lost}");
        let tolerance = error(&control("tolerance", "51mm"));
        assert!(tolerance.contains("must be from 0.00001m to 0.05m"), "{tolerance}");
    }

    #[test]
    fn a_wrong_unit_is_shown_with_line_and_caret() {
        let message = error("name = \"x\"\n[model.pan.motor]\nlimit = \"10A\"\n");
        assert!(message.contains("my.toml:3:9"), "{message}");
        assert!(message.contains("the unit A does not fit") && message.contains("^^^^^"), "{message}");
    }

    #[test]
    fn a_bare_number_a_bound_and_a_typo_say_what_to_do() {
        assert!(error("[model.pan.motor]\nlimit = 10\n").contains("one of V, mV"));
        let bound = error("[model.pan.motor]\nlimit = \"-10V\"\n");
        assert!(bound.contains("must be from 0.001V to 1000V"), "{bound}");
        let typo = error("[model.pan.motr]\nlimit = \"10V\"\n");
        assert!(typo.contains("did you mean model.pan.motor.limit?"), "{typo}");
    }

    #[test]
    fn a_head_without_inertia_or_of_nothing_but_coupling_is_refused() {
        let none = "mass = \"0kg\"\ninertia_xx = \"0kgm2\"\ninertia_yy = \"0kgm2\"\ninertia_zz = \"0kgm2\"\n";
        let massless = format!("[truth.tilt]\nrotor_inertia = \"0kgm2\"\n[truth.tilt.body]\n{none}");
        assert!(refused(&massless).contains("[truth] the inertia at a joint"), "{}", refused(&massless));
        assert!(refused("[truth.tilt.body]\ninertia_yz = \"10kgm2\"\n").contains("coupling"));
    }

    #[test]
    fn belts_that_cannot_be_simulated_are_refused() {
        let belt = "[truth.wear]\nbelt_resonance = ";
        assert!(based(&format!("{belt}\"60Hz\"\n")).is_ok());
        assert!(refused(&format!("{belt}\"900Hz\"\nbelt_damping = 2.0\n")).contains("at most 48Hz"));
        let none = format!("{belt}\"25Hz\"\n[truth.pan]\nrotor_inertia = \"0kgm2\"\n");
        assert!(refused(&none).contains("inertia on both sides"), "{}", refused(&none));
    }

    #[test]
    fn light_may_stand_as_long_as_its_power_allows_or_as_somebody_says() {
        let stands = |text: &str| based(text).unwrap().light.standing_s;
        assert_eq!((stands(""), stands("[laser]\npower = \"0.2mW\"\n")), (1.0, 1.0));
        assert_eq!(stands("[laser]\nclass = \"3R\"\npower = \"5 mW\"\n"), 0.2);
        assert_eq!(stands("[laser]\npower = \"5 mW\"\nclass = \"4\"\n[safety]\nstanding = \"30ms\"\n"), 0.03);
        assert_eq!(stands("[laser]\nclass = \"4\"\npower = \"2W\"\n"), 0.02);
        let beyond = refused("[laser]\npower = \"5mW\"\n");
        assert!(beyond.contains("[laser] power: 5 mW is more than the 1 mW of class 2"), "{beyond}");
        let slow = refused("[laser]\nclass = \"4\"\npower = \"2W\"\n[model.relay]\noff = \"30ms\"\n");
        assert!(slow.contains("[safety] standing: light may stand for 0.02 s"), "{slow}");
        assert!(error("[safety]\nstanding = \"20s\"\n").contains("must be from 0.02s to 10s"));
        assert!(error("[laser]\nclass = 2\n").contains("must be one of 1, 1M, 2"));
        let said = based("[laser]\nwavelength = \"650nm\"\nmeasured_on = \"2026-11-30\"\n").unwrap();
        assert_eq!((said.light.unfit(), parsed("", &write(&said)).unwrap().rig.light), (None, said.light));
        assert!(error("[laser]\nmeasured_on = \"yesterday\"\n").contains("must be a day"));
        // a file that is written goes on following
        let text = write(&RigConfig::report());
        let weaker =
            text.replace("class = \"2\"", "class = \"3R\"").replace("power = \"0.001W\"", "power = \"5mW\"");
        assert_eq!(stands(&weaker), 0.2, "{text}");
        let own = RigConfig {
            light: LightSettings { standing_s: 0.5, ..LightSettings::POINTER },
            ..RigConfig::report()
        };
        assert_eq!(parse("my.toml", &write(&own)).unwrap(), own);
    }

    #[test]
    fn a_laser_that_stays_on_is_parked_where_both_joints_reach_or_nowhere() {
        let parked = |text: &str| {
            let park = based(text).unwrap().safety.park_rad;
            (park.pan, park.tilt)
        };
        assert_eq!(parked(""), (None, None));
        let park = "[safety]\npark_pan = \"-0.5rad\"\npark_tilt = \"0.7rad\"\n";
        assert_eq!(parked(park), (Some(-0.5), Some(0.7)));
        let own = based(park).unwrap();
        assert_eq!(parse("my.toml", &write(&own)).unwrap(), own);
        let half = refused("[safety]\npark_tilt = \"0.7rad\"\n");
        assert!(half.contains("safety.park_tilt without safety.park_pan"), "{half}");
        let beyond = refused(&format!("{park}[model.tilt]\nrange_max = \"0.6rad\"\n"));
        assert!(beyond.contains("safety.park_tilt: 0.7 rad is outside of what tilt turns"), "{beyond}");
        // what a rig does not have stands in its file as a comment
        assert!(write(&RigConfig::report()).contains("\n# park_pan = \"0rad\""));
    }

    #[test]
    fn broken_toml_is_shown_where_it_breaks() {
        let message = error("[model\nname = 3");
        assert!(message.contains("my.toml:1:") && message.contains("not valid TOML"), "{message}");
        assert!(error("[[model.pan.motor]]\nlimit = \"9V\"\n").contains("unknown key"));
        assert!(error("[model.model.pan.motor]\nlimit = \"9V\"\n").contains("unknown key"));
    }
}
