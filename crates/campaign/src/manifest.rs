//! What a folder of strokes says of how they were made, so that a batch can go on where it was stopped.
//!
//! A journal: one JSON object a line, appended as each picture is done, the last one of a file counts. So a process
//! that is killed loses at most the line it was writing, and a thousand pictures cost a thousand short writes.

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use serde::{Deserialize, Serialize};
use tracelight_task::Failure;

use crate::figures::Figures;

/// The journal's name in the folder.
const NAME: &str = ".tracelight-strokes.jsonl";
/// Longest journal that is read, bytes: some hundred thousand pictures. What is beyond is traced again.
const MOST_BYTES: u64 = 256 << 20;

/// What a file's system says of it: enough to see that it changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Stamp {
    pub(crate) bytes: u64,
    /// Since 1970, ns.
    pub(crate) modified_ns: u64,
}

impl Stamp {
    /// Of a plain file; none of pipes, folders and what is not there.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        let data = fs::metadata(path).ok().filter(fs::Metadata::is_file)?;
        let modified = data.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
        Some(Self { bytes: data.len(), modified_ns: u64::try_from(modified.as_nanos()).ok()? })
    }
}

/// How one file of strokes was made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Entry {
    /// The file, from the folder.
    pub(crate) file: PathBuf,
    /// As it was written.
    pub(crate) file_stamp: Stamp,
    /// The picture, from the system's root.
    pub(crate) picture: PathBuf,
    /// As it was read.
    pub(crate) picture_stamp: Stamp,
    /// Version and options.
    pub(crate) made_with: String,
    /// What came out.
    pub(crate) figures: Figures,
    /// Time it took, ms.
    pub(crate) timing_ms: f64,
}

impl Entry {
    /// Whether the file would come out the same if it was made again from this picture. A file that was changed since
    /// is its owner's, and stays.
    pub(crate) fn holds(&self, folder: &Path, picture: &str, made_with: &str) -> bool {
        let written = |now: Stamp| {
            let touched = now.modified_ns > self.file_stamp.modified_ns;
            now.bytes > 0 && (touched || now.bytes == self.file_stamp.bytes)
        };
        self.made_with == made_with
            && std::path::absolute(picture).is_ok_and(|path| path == self.picture)
            && Stamp::of(Path::new(picture)) == Some(self.picture_stamp)
            && Stamp::of(&folder.join(&self.file)).is_some_and(written)
    }
}

/// The journal of a folder, open and locked.
pub(crate) struct Manifest {
    journal: File,
    entries: BTreeMap<PathBuf, Entry>,
}

impl Manifest {
    /// Opens the folder's journal, or begins one; makes the folder.
    ///
    /// # Errors
    /// Folders that cannot be written, or are being written by another batch.
    pub(crate) fn open(folder: &Path) -> Result<Self, Failure> {
        let path = folder.join(NAME);
        let failed = |e: io::Error| {
            Failure::failed(
                "cannot-write",
                format!("cannot write {}: {e}; check the folder, or give another one", path.display()),
            )
        };
        fs::create_dir_all(folder).map_err(failed)?;
        let mut journal =
            OpenOptions::new().read(true).append(true).create(true).open(&path).map_err(failed)?;
        if let Err(TryLockError::WouldBlock) = journal.try_lock() {
            let message = format!(
                "another batch is writing to {}; wait for its end, or give another folder",
                folder.display()
            );
            return Err(Failure::failed("cannot-write", message));
        }
        let mut bytes = Vec::new();
        (&journal).take(MOST_BYTES).read_to_end(&mut bytes).map_err(failed)?;
        let text = String::from_utf8_lossy(&bytes);
        let entries: BTreeMap<_, _> = text.lines().filter_map(parsed).collect();
        if entries.len() != text.lines().count() || !(text.is_empty() || text.ends_with('\n')) {
            journal = tidied(&path, &entries).map_err(failed)?;
        }
        Ok(Self { journal, entries })
    }

    /// What is known of a file.
    pub(crate) fn entry(&self, file: &Path) -> Option<&Entry> {
        self.entries.get(file)
    }

    /// Adds what was made, in one write.
    pub(crate) fn append(&mut self, entry: &Entry) -> io::Result<()> {
        self.journal.write_all(line(entry)?.as_bytes())
    }
}

/// Lines of other versions, and one that a killed process left half, say nothing.
fn parsed(line: &str) -> Option<(PathBuf, Entry)> {
    let entry: Entry = serde_json::from_str(line).ok()?;
    Some((entry.file.clone(), entry))
}

fn line(entry: &Entry) -> io::Result<String> {
    Ok(serde_json::to_string(entry)? + "\n")
}

/// The journal anew, without what no longer counts; whole at any moment. Locked before it gets its name.
fn tidied(path: &Path, entries: &BTreeMap<PathBuf, Entry>) -> io::Result<File> {
    let new = path.with_extension("new");
    drop(fs::remove_file(&new)); // what an earlier process may have left
    let mut journal = OpenOptions::new().append(true).create(true).open(&new)?;
    drop(journal.try_lock()); // where there are no locks it goes without
    let lines: Vec<_> = entries.values().map(line).collect::<Result<_, _>>()?;
    journal.write_all(lines.concat().as_bytes())?;
    fs::rename(&new, path)?;
    Ok(journal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::Unit;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("tracelight-manifest-{name}-{}", std::process::id()));
        drop(fs::remove_dir_all(&folder));
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    /// An entry of a picture and a file that are really there.
    fn made(folder: &Path) -> (Entry, String) {
        let picture = folder.join("a.png");
        fs::write(&picture, "picture").unwrap();
        fs::write(folder.join("a.svg"), "strokes").unwrap();
        let entry = Entry {
            file: "a.svg".into(),
            file_stamp: Stamp::of(&folder.join("a.svg")).unwrap(),
            picture_stamp: Stamp::of(&picture).unwrap(),
            picture: picture.clone(),
            made_with: "1".to_owned(),
            figures: Figures {
                strokes: 3,
                closed: 1,
                length: 1_234.5,
                sheet: (640.0, 480.0),
                unit: Unit::Px,
                missed_ink: Some(0.001_234),
                doubt: None,
                quality: None,
            },
            timing_ms: 12.5,
        };
        (entry, picture.to_str().unwrap().to_owned())
    }

    #[test]
    fn what_was_appended_is_read_again_past_a_line_that_was_cut_off() {
        let folder = folder("cut");
        let (entry, _) = made(&folder);
        Manifest::open(&folder).unwrap().append(&entry).unwrap();
        let journal = folder.join(NAME);
        let whole = fs::read_to_string(&journal).unwrap();
        fs::write(&journal, format!("{whole}{}", &whole[..whole.len() / 2])).unwrap();
        assert_eq!(Manifest::open(&folder).unwrap().entry(Path::new("a.svg")), Some(&entry));
        assert_eq!(fs::read_to_string(&journal).unwrap(), whole, "the half line is gone");
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn the_last_line_of_a_file_counts_and_the_others_go() {
        let folder = folder("last");
        let (entry, _) = made(&folder);
        let newer = Entry { made_with: "2".to_owned(), ..entry.clone() };
        let mut manifest = Manifest::open(&folder).unwrap();
        [&entry, &newer].iter().for_each(|e| manifest.append(e).unwrap());
        drop(manifest);
        assert_eq!(Manifest::open(&folder).unwrap().entry(Path::new("a.svg")), Some(&newer));
        assert_eq!(fs::read_to_string(folder.join(NAME)).unwrap().lines().count(), 1);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_folder_is_written_by_one_batch_at_a_time() {
        let folder = folder("locked");
        let first = Manifest::open(&folder).unwrap();
        let error = Manifest::open(&folder).err().unwrap();
        assert!(error.message.contains("another batch"), "{}", error.message);
        drop(first);
        assert!(Manifest::open(&folder).is_ok());
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn an_entry_holds_until_picture_options_or_file_change() {
        let folder = folder("holds");
        let (entry, picture) = made(&folder);
        assert!(entry.holds(&folder, &picture, "1"));
        assert!(!entry.holds(&folder, &picture, "2"), "other options");
        let moved = Entry { picture: "/elsewhere/a.png".into(), ..entry.clone() };
        assert!(!moved.holds(&folder, &picture, "1"), "another picture of that name");
        let cut = Stamp { bytes: 1000, ..entry.file_stamp };
        assert!(
            !Entry { file_stamp: cut, ..entry.clone() }.holds(&folder, &picture, "1"),
            "a file cut short"
        );
        let edited = Stamp { bytes: 1000, modified_ns: 5 };
        assert!(Entry { file_stamp: edited, ..entry.clone() }.holds(&folder, &picture, "1"), "its owner's");
        fs::write(&picture, "another").unwrap();
        fs::write(&picture, "another one").unwrap();
        assert!(!entry.holds(&folder, &picture, "1"), "the picture changed");
        fs::remove_dir_all(folder).unwrap();
    }
}
