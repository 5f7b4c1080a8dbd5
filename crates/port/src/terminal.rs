//! A pseudo-terminal: a port that a program makes for another one.

use std::fs::File;
use std::io;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

use rustix::fs::{Mode, OFlags};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};

use crate::port::raw;

/// Our end of it, with a link to the other under a name of its own.
#[derive(Debug)]
pub(crate) struct Terminal {
    pub(crate) ours: File,
    /// The other end is held open, so that nobody's going is taken for the end of the line.
    _theirs: File,
    link: PathBuf,
    /// Name of the other end.
    name: PathBuf,
}

impl Terminal {
    /// Makes one, and a link to it where there is nothing yet, or an old one.
    pub(crate) fn new(link: &Path) -> io::Result<Self> {
        let ours = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY)?;
        grantpt(&ours)?;
        unlockpt(&ours)?;
        let name = ptsname(&ours, Vec::new())?;
        let theirs = rustix::fs::open(name.as_c_str(), OFlags::RDWR | OFlags::NOCTTY, Mode::empty())?;
        raw(&theirs)?;
        rustix::fs::fcntl_setfl(&ours, OFlags::NONBLOCK)?;
        if let Some(folder) = link.parent() {
            std::fs::create_dir_all(folder)?;
        }
        // one that a killed program has left behind points nowhere; anything else is somebody's
        if std::fs::read_link(link).is_ok_and(|old| !old.exists()) {
            std::fs::remove_file(link)?;
        }
        let name = PathBuf::from(name.to_string_lossy().into_owned());
        symlink(&name, link)?;
        Ok(Self { ours: ours.into(), _theirs: theirs.into(), link: link.to_owned(), name })
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        if std::fs::read_link(&self.link).is_ok_and(|to| to == self.name) {
            // who cannot take it away leaves it: it points nowhere then
            let _ = std::fs::remove_file(&self.link);
        }
    }
}
