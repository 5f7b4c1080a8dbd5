//! Heads that a page may choose, by their names: presets, and rig files of the studio's folder.

use std::fs;
use std::path::PathBuf;

use crate::folder::{Folder, Kind, is_plain};

/// How a rig file's name ends.
pub(crate) const KIND: &str = ".toml";
/// Longest name.
const MOST_LETTERS: usize = 60;

/// Heads that a page may choose: presets of the program, and files of the folder.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rigs {
    pub(crate) presets: Vec<String>,
    /// Name and path.
    pub(crate) own: Vec<(String, String)>,
}

impl Rigs {
    /// Presets alone.
    #[cfg(test)]
    pub(crate) fn of_presets(names: &[&str]) -> Self {
        Self { presets: names.iter().map(|&name| name.to_owned()).collect(), own: Vec::new() }
    }

    /// The value of `--rig` for a name; `None` of one that there is not.
    pub(crate) fn value(&self, name: &str) -> Option<&str> {
        let preset = self.presets.iter().find(|preset| *preset == name).map(String::as_str);
        preset.or_else(|| self.own.iter().find(|(own, _)| own == name).map(|(_, path)| path.as_str()))
    }

    /// The name for a value of `--rig`; `None` of a head that a page cannot choose.
    pub(crate) fn name_of(&self, value: &str) -> Option<&str> {
        let own = self.own.iter().find(|(_, path)| path == value).map(|(name, _)| name.as_str());
        own.or_else(|| self.presets.iter().find(|preset| *preset == value).map(String::as_str))
    }

    /// All names.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.presets.iter().map(String::as_str).chain(self.own.iter().map(|(name, _)| name.as_str()))
    }
}

impl Folder {
    pub(crate) fn rigs(&self) -> PathBuf {
        self.dir().join(Kind::Rigs.word())
    }

    /// Where a rig file lies; `None` where there is none of that name.
    pub(crate) fn rig(&self, name: &str) -> Option<PathBuf> {
        let path = self.rigs().join(name);
        (is_rig_name(name) && path.is_file()).then_some(path)
    }

    /// Names of the rig files, in their order.
    pub(crate) fn rig_names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.rigs()).into_iter().flatten().flatten();
        let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
        let mut all: Vec<String> = names.filter(|name| self.rig(name).is_some()).collect();
        all.sort();
        all
    }
}

pub(crate) fn is_rig_name(name: &str) -> bool {
    let stem = name.strip_suffix(KIND).unwrap_or_default();
    !stem.is_empty() && name.len() <= MOST_LETTERS && is_plain(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rig_is_chosen_by_its_name_and_nothing_else_of_this_computer() {
        let own = vec![("garage.toml".to_owned(), "/s/rigs/garage.toml".to_owned())];
        let rigs = Rigs { own, ..Rigs::of_presets(&["report", "worn"]) };
        assert_eq!(rigs.value("worn"), Some("worn"));
        assert_eq!(rigs.value("garage.toml"), Some("/s/rigs/garage.toml"));
        for other in ["/s/rigs/garage.toml", "../garage.toml", "COM3", "emulated", ""] {
            assert_eq!(rigs.value(other), None, "{other}");
        }
        assert_eq!(rigs.name_of("/s/rigs/garage.toml"), Some("garage.toml"));
        assert_eq!(rigs.name_of("/elsewhere/garage.toml"), None);
        assert_eq!(rigs.names().collect::<Vec<_>>(), ["report", "worn", "garage.toml"]);
    }

    #[test]
    fn names_of_rig_files_lead_nowhere() {
        assert!(is_rig_name("garage.toml") && is_rig_name("my-head_2.toml"));
        for name in [
            ".toml",
            "garage",
            "../x.toml",
            "a/b.toml",
            ".hidden.toml",
            "x y.toml",
            &format!("{}.toml", "x".repeat(80)),
        ] {
            assert!(!is_rig_name(name), "{name}");
        }
    }
}
