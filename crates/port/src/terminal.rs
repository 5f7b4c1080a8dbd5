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
        // one that a killed program has left behind; anything else is somebody's
        if std::fs::read_link(link).is_ok_and(|old| old.starts_with("/dev/pts")) {
            std::fs::remove_file(link)?;
        }
        symlink(name.to_string_lossy().as_ref(), link)?;
        Ok(Self { ours: ours.into(), _theirs: theirs.into(), link: link.to_owned() })
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        // who cannot take it away leaves it: it points nowhere then
        let _ = std::fs::remove_file(&self.link);
    }
}
