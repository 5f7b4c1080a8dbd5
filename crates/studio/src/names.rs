//! Files that a page may choose, by their names: rigs, calibrations of cameras, and heads; of rigs also the program's presets.

use std::fs;
use std::path::PathBuf;

use crate::folder::{Folder, Kind, is_plain};

/// How the name of such a file ends.
pub(crate) const KIND: &str = ".toml";
/// Longest name.
const MOST_LETTERS: usize = 60;

/// What a page may choose by a name.
#[derive(Clone, Debug, Default)]
pub(crate) struct Names {
    /// Of the program.
    pub(crate) presets: Vec<String>,
    /// Name and path of each file.
    pub(crate) rigs: Vec<(String, String)>,
    pub(crate) cameras: Vec<(String, String)>,
    pub(crate) heads: Vec<(String, String)>,
}

impl Names {
    /// Presets alone.
    #[cfg(test)]
    pub(crate) fn of_presets(names: &[&str]) -> Self {
        Self { presets: names.iter().map(|&name| name.to_owned()).collect(), ..Self::default() }
    }

    /// The files that a flag's value is one of; `None` of a flag that names none.
    pub(crate) fn kind_of(flag: &str) -> Option<Kind> {
        match flag {
            "rig" => Some(Kind::Rigs),
            "calibration" | "lens" => Some(Kind::Cameras),
            "head" => Some(Kind::Heads),
            _ => None,
        }
    }

    fn own(&self, kind: Kind) -> &[(String, String)] {
        match kind {
            Kind::Rigs => &self.rigs,
            Kind::Cameras => &self.cameras,
            Kind::Heads => &self.heads,
            Kind::Pictures | Kind::Runs => &[],
        }
    }

    fn presets(&self, kind: Kind) -> &[String] {
        if kind == Kind::Rigs { &self.presets } else { &[] }
    }

    /// The value on a command line for a name; `None` of one that there is not.
    pub(crate) fn value(&self, kind: Kind, name: &str) -> Option<&str> {
        let preset = self.presets(kind).iter().find(|preset| *preset == name).map(String::as_str);
        preset.or_else(|| self.own(kind).iter().find(|(own, _)| own == name).map(|(_, path)| path.as_str()))
    }

    /// The name for a value on a command line; `None` of what a page cannot choose.
    pub(crate) fn name_of(&self, kind: Kind, value: &str) -> Option<&str> {
        let own = self.own(kind).iter().find(|(_, path)| path == value).map(|(name, _)| name.as_str());
        own.or_else(|| self.presets(kind).iter().find(|preset| *preset == value).map(String::as_str))
    }

    /// All names of a kind.
    pub(crate) fn all(&self, kind: Kind) -> impl Iterator<Item = &str> {
        self.presets(kind)
            .iter()
            .map(String::as_str)
            .chain(self.own(kind).iter().map(|(name, _)| name.as_str()))
    }
}

impl Folder {
    /// Where a file of a kind lies; `None` where there is none of that name.
    pub(crate) fn own(&self, kind: Kind, name: &str) -> Option<PathBuf> {
        let path = self.place(kind).join(name);
        // links lead out of the folder
        let is_file = || fs::symlink_metadata(&path).is_ok_and(|meta| meta.is_file());
        (is_own_name(name) && is_file()).then_some(path)
    }

    /// Names of the files of a kind, in their order.
    pub(crate) fn own_names(&self, kind: Kind) -> Vec<String> {
        let entries = fs::read_dir(self.place(kind)).into_iter().flatten().flatten();
        let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
        let mut all: Vec<String> = names.filter(|name| self.own(kind, name).is_some()).collect();
        all.sort();
        all
    }

    /// Names and paths of the files of a kind.
    pub(crate) fn own_files(&self, kind: Kind) -> Vec<(String, String)> {
        let path = |name: &String| self.own(kind, name).map(|path| path.to_string_lossy().into_owned());
        self.own_names(kind).into_iter().filter_map(|name| Some((name.clone(), path(&name)?))).collect()
    }
}

pub(crate) fn is_own_name(name: &str) -> bool {
    let stem = name.strip_suffix(KIND).unwrap_or_default();
    !stem.is_empty() && name.len() <= MOST_LETTERS && is_plain(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_chosen_by_its_name_and_nothing_else_of_this_computer() {
        let rigs = vec![("garage.toml".to_owned(), "/s/rigs/garage.toml".to_owned())];
        let heads = vec![("shed.toml".to_owned(), "/s/heads/shed.toml".to_owned())];
        let names = Names { rigs, heads, ..Names::of_presets(&["report", "worn"]) };
        assert_eq!(names.value(Kind::Rigs, "worn"), Some("worn"));
        assert_eq!(names.value(Kind::Rigs, "garage.toml"), Some("/s/rigs/garage.toml"));
        assert_eq!(names.value(Kind::Heads, "shed.toml"), Some("/s/heads/shed.toml"));
        // a kind's names are its own
        assert_eq!(names.value(Kind::Heads, "worn"), None);
        assert_eq!(names.value(Kind::Rigs, "shed.toml"), None);
        for other in ["/s/rigs/garage.toml", "../garage.toml", "COM3", "emulated", ""] {
            assert_eq!(names.value(Kind::Rigs, other), None, "{other}");
        }
        assert_eq!(names.name_of(Kind::Rigs, "/s/rigs/garage.toml"), Some("garage.toml"));
        assert_eq!(names.name_of(Kind::Rigs, "/elsewhere/garage.toml"), None);
        assert_eq!(names.all(Kind::Rigs).collect::<Vec<_>>(), ["report", "worn", "garage.toml"]);
    }

    #[test]
    fn names_of_files_lead_nowhere() {
        assert!(is_own_name("garage.toml") && is_own_name("my-head_2.toml"));
        for name in [
            ".toml",
            "garage",
            "../x.toml",
            "a/b.toml",
            ".hidden.toml",
            "x y.toml",
            &format!("{}.toml", "x".repeat(80)),
        ] {
            assert!(!is_own_name(name), "{name}");
        }
    }
}
