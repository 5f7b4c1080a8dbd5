//! Which file each picture's strokes go to: no two pictures to the same, none over a picture.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::path::{Component, Path, PathBuf};

use tracelight_files::Picture;
use tracelight_task::Failure;

/// A file for each picture, as paths from `folder`: the picture's name, below a named folder its way from there; where
/// these meet, with the folders that tell them apart.
///
/// # Errors
/// Two pictures that only differ in what a file of strokes has not, such as their extension; a file that would lie
/// over one of the pictures.
pub fn files(pictures: &[Picture], folder: &Path, extension: &str) -> Result<Vec<PathBuf>, Failure> {
    let mut files: Vec<_> = pictures.iter().map(|picture| file(picture, extension)).collect();
    for same in meeting(&files) {
        let apart = told_apart(&same.iter().map(|&i| pictures[i].name.as_str()).collect::<Vec<_>>());
        same.iter().zip(apart).for_each(|(&i, dir)| {
            let name = files[i].file_name().map(PathBuf::from).unwrap_or_default();
            files[i] = dir.join(name);
        });
    }
    if let Some([one, other]) = meeting(&files).first().map(|same| [same[0], same[1]]) {
        return Err(clash(&pictures[one].name, &pictures[other].name, &folder.join(&files[one])));
    }
    check_sources(pictures, &files, folder)?;
    Ok(files)
}

/// The file of a picture that stands alone.
pub(crate) fn file(picture: &Picture, extension: &str) -> PathBuf {
    if picture.name == "-" {
        return PathBuf::from(format!("stdin.{extension}"));
    }
    let path = picture.within.as_deref().unwrap_or_else(|| Path::new(&picture.name));
    let stem = path.file_stem().unwrap_or_else(|| "strokes".as_ref()).to_string_lossy();
    let below = picture.within.as_deref().and_then(Path::parent).unwrap_or_else(|| Path::new(""));
    below.join(format!("{stem}.{extension}"))
}

/// Groups of equal files, in the order of their first.
fn meeting(files: &[PathBuf]) -> Vec<Vec<usize>> {
    let mut by_file: HashMap<PathBuf, Vec<usize>> = HashMap::new();
    for (index, file) in files.iter().enumerate() {
        by_file.entry(as_the_system_sees(file)).or_default().push(index);
    }
    let mut groups: Vec<_> = by_file.into_values().filter(|same| same.len() > 1).collect();
    groups.sort_unstable();
    groups
}

/// Windows and macOS take `House.svg` and `house.svg` for the same file.
fn as_the_system_sees(file: &Path) -> PathBuf {
    match cfg!(any(windows, target_os = "macos")) {
        true => file.to_string_lossy().to_lowercase().into(),
        false => file.to_owned(),
    }
}

/// The folders of these paths from the last one that they share.
fn told_apart(names: &[&str]) -> Vec<PathBuf> {
    let folder = |name: &&str| {
        let whole = std::path::absolute(name).unwrap_or_else(|_| PathBuf::from(name));
        whole.parent().map(Path::to_owned).unwrap_or_default()
    };
    let folders: Vec<_> = names.iter().map(folder).collect();
    let shared = folders.iter().skip(1).fold(folders[0].components().count(), |least, folder| {
        least.min(folder.components().zip(folders[0].components()).take_while(|(a, b)| a == b).count())
    });
    // only names: a path that leads up, or to another drive, must not lead out of the folder
    let plain = |c: &Component<'_>| matches!(c, Component::Normal(_));
    folders.iter().map(|folder| folder.components().skip(shared).filter(plain).collect()).collect()
}

fn clash(one: &str, other: &str, file: &Path) -> Failure {
    let message = match one == other {
        true => format!("{one} is given twice; name it once"),
        false => format!(
            "{one} and {other} would both be written to {}; rename one, or trace them into two folders",
            file.display()
        ),
    };
    Failure::usage("usage", message)
}

fn check_sources(pictures: &[Picture], files: &[PathBuf], folder: &Path) -> Result<(), Failure> {
    let there: Vec<_> =
        files.iter().filter_map(|file| Some((file, fs::canonicalize(folder.join(file)).ok()?))).collect();
    if there.is_empty() {
        return Ok(());
    }
    let sources: HashSet<_> = pictures.iter().filter_map(|p| fs::canonicalize(&p.name).ok()).collect();
    match there.iter().find(|(_, path)| sources.contains(path)) {
        Some((file, _)) => {
            let file = folder.join(file);
            let message = format!(
                "{} is one of the pictures: --out would write strokes over it; give another folder",
                file.display()
            );
            Err(Failure::usage("usage", message))
        }
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(name: &str) -> Picture {
        Picture { name: name.to_owned(), within: None }
    }

    fn check(names: &[&str], expected: &[&str]) {
        let pictures: Vec<_> = names.iter().map(|name| named(name)).collect();
        let found = files(&pictures, Path::new("no/such/folder"), "svg").unwrap();
        assert_eq!(found, expected.iter().map(PathBuf::from).collect::<Vec<_>>(), "{names:?}");
    }

    #[test]
    fn a_file_is_named_after_its_picture() {
        check(
            &["a/house.png", "b/star.jpg", "v1.2.png", "-"],
            &["house.svg", "star.svg", "v1.2.svg", "stdin.svg"],
        );
    }

    #[test]
    fn pictures_of_one_name_keep_the_folders_that_tell_them_apart() {
        check(&["a/x.png", "b/x.png", "b/y.png"], &["a/x.svg", "b/x.svg", "y.svg"]);
        check(&["x.png", "a/x.jpg"], &["x.svg", "a/x.svg"]);
        check(&["/p/1/q/x.png", "/p/2/q/x.png"], &["1/q/x.svg", "2/q/x.svg"]);
    }

    #[test]
    fn pictures_that_cannot_be_told_apart_are_refused_with_both_names() {
        for (names, words) in [
            (["a/x.png", "a/x.jpg"], "a/x.png and a/x.jpg would both"),
            (["a/x.png", "a/x.png"], "a/x.png is given twice"),
        ] {
            let error = files(&names.map(named), Path::new("out"), "svg").unwrap_err();
            assert!(error.message.contains(words), "{}", error.message);
        }
    }

    #[test]
    fn strokes_are_never_written_over_a_picture() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let source = folder.join("Cargo.toml").to_string_lossy().into_owned();
        let error = files(&[named(&source), named("x.png")], folder, "toml").unwrap_err();
        assert!(error.message.contains("is one of the pictures"), "{}", error.message);
    }
}
