//! A serial port or a pseudo-terminal, held by one program at a time.

use std::fs::File;
use std::io::{self, Read as _, Write as _};
use std::os::fd::{AsFd, OwnedFd};
use std::path::{Path, PathBuf};
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{FlockOperation, Mode, OFlags};
use rustix::io::Errno;
use rustix::termios::{ControlModes, OptionalActions, tcgetattr, tcsetattr};
use tracelight_task::Failure;

use crate::shared::{Owner, socket_of};

/// A line to a board.
#[derive(Debug)]
pub struct Port {
    file: File,
    path: PathBuf,
}

/// Every byte as it is: no echo, no line ends, no signals.
pub(crate) fn raw(terminal: impl AsFd) -> io::Result<()> {
    let mut settings = tcgetattr(&terminal)?;
    settings.make_raw();
    Ok(tcsetattr(&terminal, OptionalActions::Now, &settings)?)
}

impl Port {
    /// Opens a port that nobody else has open with this program; one that another program shares is used through that.
    ///
    /// # Errors
    /// `port`: it is not there, no port, may not be opened, or is in use, by whom, and what to do.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        match Self::open_alone(path) {
            Err(refused) => match socket_of(path).ok().and_then(|socket| Owner::of(&socket).ok().flatten()) {
                Some(owner) => {
                    let stream = owner.drive()?;
                    let wrong = |e: io::Error| Failure::failed("port", format!("{}: {e}", path.display()));
                    stream.set_nonblocking(true).map_err(wrong)?;
                    Ok(Self { file: OwnedFd::from(stream).into(), path: path.to_owned() })
                }
                None => Err(refused),
            },
            opened => opened,
        }
    }

    /// Opens a port that nobody else has open with this program.
    ///
    /// # Errors
    /// `port`: it is not there, no port, may not be opened, or is in use, and what to do.
    pub fn open_alone(path: &Path) -> Result<Self, Failure> {
        let at = path.display();
        let wrong = |e: io::Error| {
            let what = match e.kind() {
                io::ErrorKind::NotFound => "there is no such port: is the board plugged in?".to_owned(),
                io::ErrorKind::PermissionDenied => {
                    "you may not open it: become a member of the group dialout (sudo usermod -aG dialout $USER), log in again".to_owned()
                }
                io::ErrorKind::WouldBlock => "another program has it open: end that, or use its own way to the board".to_owned(),
                _ => e.to_string(),
            };
            Failure::usage("port", format!("{at}: {what}"))
        };
        let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK;
        let file = rustix::fs::open(path, flags, Mode::empty()).map_err(|e| wrong(e.into()))?;
        if tcgetattr(&file).is_err() {
            return Err(Failure::usage("port", format!("{at} is no serial port")));
        }
        rustix::fs::flock(&file, FlockOperation::NonBlockingLockExclusive).map_err(|e| wrong(e.into()))?;
        raw(&file).map_err(wrong)?;
        Ok(Self { file: file.into(), path: path.to_owned() })
    }

    /// Sets the speed of a serial line, which stays ready for it when it is closed: boards that start anew when somebody opens their port do so once.
    ///
    /// # Errors
    /// `port`: it has no such speed.
    pub fn at_speed(self, baud: u32) -> Result<Self, Failure> {
        let set = || -> io::Result<()> {
            let mut settings = tcgetattr(&self.file)?;
            settings.set_speed(baud)?;
            settings.control_modes.remove(ControlModes::HUPCL | ControlModes::CRTSCTS);
            settings.control_modes.insert(ControlModes::CLOCAL);
            Ok(tcsetattr(&self.file, OptionalActions::Now, &settings)?)
        };
        let wrong = |e| Failure::usage("port", format!("{}: no {baud} baud: {e}", self.path.display()));
        set().map_err(wrong)?;
        Ok(self)
    }

    /// Whether it was opened here, and not through another program that shares it.
    #[must_use]
    pub fn is_own(&self) -> bool {
        tcgetattr(&self.file).is_ok()
    }

    /// Whether another program of this computer is at its other end, and no cable.
    #[must_use]
    pub fn is_pseudo_terminal(&self) -> bool {
        // a program that shares a port answers at a socket: what it has is told by its path too
        let path = self.path.canonicalize().unwrap_or_default();
        ["/dev/pts/", "/dev/ttys"].iter().any(|begin| path.to_string_lossy().starts_with(begin))
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Reads what is there, after waiting for something up to that long; nothing if nothing came.
    ///
    /// # Errors
    /// The line is gone.
    pub fn read(&mut self, out: &mut Vec<u8>, wait: Duration) -> io::Result<()> {
        let wait = Timespec::try_from(wait).map_err(io::Error::other)?;
        let is_ready = match poll(&mut [PollFd::new(&self.file, PollFlags::IN)], Some(&wait)) {
            Ok(ready) => ready > 0,
            // a signal, such as of a window that changes its size, is no broken line
            Err(Errno::INTR) => return Ok(()),
            Err(e) => return Err(e.into()),
        };
        let mut bytes = [0; 4096];
        match self.file.read(&mut bytes) {
            // a terminal whose other end was closed says so by no bytes, though it is ready
            Ok(0) if is_ready => Err(io::ErrorKind::UnexpectedEof.into()),
            Ok(count) => {
                out.extend_from_slice(&bytes[..count]);
                Ok(())
            }
            Err(e) if matches!(e.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted) => Ok(()),
            Err(e) => Err(e),
        }
    }

    /// Writes bytes; what the line does not take in time is an error.
    ///
    /// # Errors
    /// The line is gone, or held up.
    pub fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        const LONGEST: Timespec = Timespec { tv_sec: 1, tv_nsec: 0 };
        let mut left = bytes;
        while !left.is_empty() {
            match self.file.write(left) {
                Ok(count) => left = &left[count..],
                Err(e) if e.kind() == io::ErrorKind::WouldBlock => {
                    let mut ready = [PollFd::new(&self.file, PollFlags::OUT)];
                    match poll(&mut ready, Some(&LONGEST)) {
                        Ok(0) => return Err(io::ErrorKind::TimedOut.into()),
                        Ok(_) | Err(Errno::INTR) => {}
                        Err(e) => return Err(e.into()),
                    }
                }
                Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
                Err(e) => return Err(e),
            }
        }
        Ok(())
    }
}
