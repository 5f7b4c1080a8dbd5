//! What was identified or tuned, written into the text of a user's own rig file: only what changed, comments kept.

use toml_edit::{DocumentMut, Item, Table, TableLike, Value};
use tracelight_sim::RigConfig;

use crate::found::identified_keys;
use crate::hand_tuned::rig_keys;
use crate::keys::{Key, Slot, model_keys};
use crate::rig::{parse, shown};

/// The text of a rig file with another rig's model, what was identified of it and how it is driven, which can be read again.
///
/// # Errors
/// Where the text is no rig file, or what was found is no head that one takes.
pub fn saved(file: &str, text: &str, old: &RigConfig, new: &RigConfig) -> Result<String, String> {
    let saved = updated(text, old, new)?;
    parse(file, &saved).map_err(|e| format!("what was found is no head that a rig file takes: {e}"))?;
    Ok(saved)
}

/// As [`saved`], not read again. What is simulated stays what it was:
/// keys of `[model]` that change are written into `[truth]` with their old value where they do not stand there.
fn updated(text: &str, old: &RigConfig, new: &RigConfig) -> Result<String, String> {
    let mut document: DocumentMut = text.parse().map_err(|e| format!("not valid TOML: {e}"))?;
    let root = document.as_table_mut();
    for key in model_keys() {
        let (before, after) = (shown(&key, &mut old.model.clone()), shown(&key, &mut new.model.clone()));
        if before == after {
            continue;
        }
        let truth = format!("truth.{}", key.path);
        if !stands(root, &truth) {
            put(root, &truth, &shown(&key, &mut old.truth.model.clone()))?;
        }
        put(root, &format!("model.{}", key.path), &after)?;
    }
    for key in rig_keys().iter().filter(|key| !key.path.starts_with("truth.")) {
        let (before, after) = (shown(key, &mut old.clone()), shown(key, &mut new.clone()));
        if before != after {
            put(root, key.path, &after)?;
        }
    }
    if let Some(found) = &new.identified {
        put(root, "identified.date", &Value::from(found.date.as_str()).to_string())?;
        for key in identified_keys() {
            put(root, &format!("identified.{}", key.path), &rounded(&key, &mut found.clone()))?;
        }
    }
    Ok(document.to_string())
}

/// As in [`shown`], but for the digits nobody measured.
fn rounded<T>(key: &Key<T>, from: &mut T) -> String {
    if let Slot::Real(field) = key.slot {
        let value = field(from);
        *value = format!("{value:.6e}").parse().unwrap_or(*value);
    }
    shown(key, from)
}

/// Whether a key stands in a file.
fn stands(root: &Table, path: &str) -> bool {
    let mut table: Option<&dyn TableLike> = Some(root);
    let mut names = path.split('.').peekable();
    while let (Some(name), Some(here)) = (names.next(), table) {
        let item = here.get(name);
        if names.peek().is_none() {
            return item.is_some_and(|item| !item.is_none());
        }
        table = item.and_then(Item::as_table_like);
    }
    false
}

/// Sets a key, in place of the value that stands there, or at the end of its table.
fn put(root: &mut Table, path: &str, text: &str) -> Result<(), String> {
    let mut value: Value = text.parse().map_err(|e| format!("{path} = {text}: {e}"))?;
    let (tables, name) = path.rsplit_once('.').unwrap_or(("", path));
    let mut table: &mut dyn TableLike = root;
    for part in tables.split('.').filter(|part| !part.is_empty()) {
        if table.get(part).is_none() {
            let mut fresh = Table::new();
            // only the last of them gets a header
            fresh.set_implicit(true);
            table.insert(part, Item::Table(fresh));
        }
        let item = table.get_mut(part).and_then(Item::as_table_like_mut);
        table = item.ok_or_else(|| format!("{part} in {path} is no table"))?;
    }
    if let Some(old) = table.get_mut(name).and_then(Item::as_value_mut) {
        *value.decor_mut() = old.decor().clone();
        *old = value;
    } else {
        table.insert(name, Item::Value(value));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_sim::Identified;

    #[test]
    fn what_was_identified_is_written_with_comments_kept_and_the_simulated_head_as_it_was() {
        let text = "# my rig\nbase = \"report\"\n[model.pan.motor] # weak\ntorque_per_volt = \"0.07Nm/V\" # guessed\nlimit = \"9V\"\n\n\
                    [truth.wear]\nbacklash = \"0.001rad\" # seen\n";
        let old = parse("my.toml", text).unwrap();
        let mut new = old.clone();
        new.model.motors.pan.torque_nm_per_v = 0.0625;
        new.model.friction.tilt.coulomb_pos_nm = 0.05;
        let mut found = Identified { date: "2026-11-22".into(), ..Identified::NONE };
        found.quirks.pan.edges_counts = [0.01, -0.02, 0.03, -0.02];
        new.identified = Some(found);
        let saved = updated(text, &old, &new).unwrap();
        for kept in ["# my rig", "# weak", "# guessed", "limit = \"9V\"", "# seen"] {
            assert!(saved.contains(kept), "{kept} is lost:\n{saved}");
        }
        let read = parse("my.toml", &saved).unwrap();
        assert_eq!(read.model, new.model, "{saved}");
        assert_eq!(read.truth, old.truth, "{saved}");
        assert_eq!(read.identified, new.identified, "{saved}");
    }
}
