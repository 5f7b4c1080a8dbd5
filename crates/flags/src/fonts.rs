//! Fonts of this computer, found by the names of their families.

use std::path::PathBuf;

use fontdb::{Database, Source};
use tracelight_files as files;
use tracelight_formats::Font;

/// The fonts of this computer.
pub(crate) struct SystemFonts(Database);

/// Files of one family at most: a weight and a slant each.
const MOST_FILES: usize = 24;

impl SystemFonts {
    /// Looks for fonts where the system has them. Their files are read for their names only.
    pub(crate) fn look() -> Self {
        let mut all = Database::new();
        all.load_system_fonts();
        Self(all)
    }

    /// The fonts of a family, whole; those that cannot be read are none.
    pub(crate) fn find(&self, family: &str) -> Vec<Font> {
        let is_own = |(name, _): &(String, _)| name.eq_ignore_ascii_case(family);
        let own = self.0.faces().filter(|face| face.families.iter().any(is_own));
        let mut paths: Vec<PathBuf> = own
            .filter_map(|face| match &face.source {
                Source::File(path) => Some(path.clone()),
                Source::Binary(_) => None,
            })
            .collect();
        // folders are listed in any order
        paths.sort_by_key(|path| (path.as_os_str().len(), path.clone()));
        paths.dedup();
        let fonts = paths.iter().take(MOST_FILES).filter_map(|path| {
            let name = path.to_str()?;
            Some(Font { name: name.to_owned(), bytes: files::read(name).ok()?.into() })
        });
        fonts.collect()
    }
}
