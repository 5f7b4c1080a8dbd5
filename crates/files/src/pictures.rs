//! Which pictures a command line means: files, folders of them, patterns.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use image::ImageFormat;
use tracelight_task::Failure;

use crate::inputs::protect;

/// One picture that was asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Its path as the user would type it.
    pub name: String,
    /// The same from the folder that was named instead of it.
    pub within: Option<PathBuf>,
}

/// Pictures in the order of the command line, and remarks about arguments that held none.
#[derive(Debug, Default)]
pub struct Found {
    /// Each that was found.
    pub pictures: Vec<Picture>,
    /// What arguments held none.
    pub remarks: Vec<String>,
}

/// Whether an argument stands for other names than its own. A pattern that matches nothing is a name.
#[must_use]
pub fn stands_for_several(argument: &str) -> bool {
    let matches = || glob::glob(argument).is_ok_and(|mut found| found.next().is_some());
    argument != "-" && (Path::new(argument).is_dir() || is_pattern(argument) && matches())
}

/// Files as they are; folders as the pictures in them, by name; patterns that no shell expanded as what they match.
///
/// # Errors
/// `unreadable` where a folder cannot be read or nothing was found, `usage` where a pattern is none.
pub fn find(arguments: &[String], recursive: bool) -> Result<Found, Failure> {
    let mut found = Found::default();
    for argument in arguments {
        if argument != "-" && Path::new(argument).is_dir() {
            found.add_folder(argument, recursive)?;
        } else if is_pattern(argument) {
            found.add_pattern(argument, recursive)?;
        } else {
            found.add_file(argument);
        }
    }
    if found.pictures.is_empty() {
        let message = format!("{}; name pictures or a folder that has some", found.remarks.join("; "));
        return Err(Failure::usage("unreadable", message));
    }
    // the first results are written before the last pictures are read
    found.pictures.iter().for_each(|picture| protect(Path::new(&picture.name)));
    Ok(found)
}

impl Found {
    fn add_file(&mut self, name: &str) {
        self.pictures.push(Picture { name: name.to_owned(), within: None });
    }

    fn add_folder(&mut self, folder: &str, recursive: bool) -> Result<(), Failure> {
        let unreadable = |e| {
            let message =
                format!("cannot read the folder {folder}: {e}; check its permissions and those below it");
            Failure::usage("unreadable", message)
        };
        let files = pictures_in(Path::new(folder), Path::new(""), recursive).map_err(unreadable)?;
        if files.is_empty() {
            let below = if recursive { "" } else { " (--recursive looks into the folders in it too)" };
            self.remarks.push(format!("{folder} has no pictures{below}"));
        }
        self.pictures.extend(files.into_iter().map(|within| Picture {
            name: Path::new(folder).join(&within).to_string_lossy().into_owned(),
            within: Some(within),
        }));
        Ok(())
    }

    fn add_pattern(&mut self, pattern: &str, recursive: bool) -> Result<(), Failure> {
        let wrong = |e| Failure::usage("usage", format!("{pattern} is neither a file nor a pattern: {e}"));
        let matches: Vec<_> = glob::glob(pattern).map_err(wrong)?.filter_map(Result::ok).collect();
        if matches.is_empty() {
            // named like this it fails like any other file that is not there
            self.add_file(pattern);
        }
        for path in matches {
            let name = path.to_string_lossy();
            if path.is_dir() { self.add_folder(&name, recursive)? } else { self.add_file(&name) }
        }
        Ok(())
    }
}

fn is_pattern(argument: &str) -> bool {
    argument.contains(['*', '?', '[']) && !fs::exists(argument).unwrap_or(false)
}

/// Pictures below `root/at`, as paths from `root`, by name; a folder's own before those of the folders in it.
fn pictures_in(root: &Path, at: &Path, recursive: bool) -> io::Result<Vec<PathBuf>> {
    let (mut files, mut folders) = (Vec::new(), Vec::new());
    for entry in fs::read_dir(root.join(at))? {
        let entry = entry?;
        let path = at.join(entry.file_name());
        // links to folders are not followed: they may lead round in circles
        if entry.file_type()?.is_dir() {
            folders.push(path);
        } else if is_picture(&path) {
            files.push(path);
        }
    }
    files.sort_unstable();
    folders.sort_unstable();
    if recursive {
        for folder in folders.iter().filter(|f| !is_hidden(f)) {
            files.extend(pictures_in(root, folder, recursive)?);
        }
    }
    Ok(files)
}

/// Whether a file's name says that pixels are in it. Drawings are left out: results lie in folders too.
fn is_picture(path: &Path) -> bool {
    let named = ImageFormat::from_path(path).is_ok_and(|format| format.reading_enabled());
    named && !is_hidden(path)
}

/// Names that begin with a dot are nobody's pictures: macOS leaves `._photo.jpg` beside `photo.jpg`.
fn is_hidden(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example(name: &str) -> String {
        format!("{}/../../examples/{name}", env!("CARGO_MANIFEST_DIR"))
    }

    fn names(arguments: &[String]) -> Vec<String> {
        find(arguments, false).unwrap().pictures.into_iter().map(|p| p.name).collect()
    }

    #[test]
    fn a_folder_stands_for_its_pictures_by_name_and_for_nothing_else() {
        let found = find(&[example("")], false).unwrap().pictures;
        assert!(found.len() >= 8 && found.is_sorted_by(|a, b| a.name < b.name), "{found:?}");
        assert!(found.iter().all(|p| [".png", ".jpg"].iter().any(|end| p.name.ends_with(end))), "{found:?}");
    }

    #[test]
    fn a_pattern_that_no_shell_expanded_stands_for_what_it_matches() {
        assert_eq!(names(&[example("ruler-*.png")]), ["ruler-level.png", "ruler-upright.png"].map(example));
        assert_eq!(names(&[example("zebra-*.png")]), [example("zebra-*.png")]);
    }

    #[test]
    fn a_folder_without_pictures_is_said_to_have_none() {
        let error = find(&[example("../crates")], false).unwrap_err();
        assert!(error.message.contains("has no pictures (--recursive"), "{}", error.message);
    }

    #[test]
    fn files_stay_in_the_order_they_were_named_in() {
        let asked = ["star.png", "house.png", "missing.png"].map(example);
        assert_eq!(names(&asked), asked);
    }
}
