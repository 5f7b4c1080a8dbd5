//! A port that several programs have to do with: one drives the board, any number watch, and anybody may disarm it.
//!
//! Whoever has the port open answers at a socket of this user's, [`socket_of`] the port. He greets each visitor with a line of JSON that says who drives, and takes lines:
//!
//! ```text
//! watch     a line of JSON 20 times a second, and at once whenever phase, gate or fault change
//! disarm    the board is disarmed, whoever drives it
//! drive     bytes of the wire from here on, of a port that is shared and that nobody drives
//! ```

use std::io::{self, Read as _, Write as _};
use std::os::unix::fs::{DirBuilderExt as _, MetadataExt as _};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tracelight_task::Failure;

use crate::seen::Seen;

/// Visitors at once, and for how long one may be silent before he has said what he wants.
const MOST_VISITORS: usize = 64;
const GUEST: Duration = Duration::from_secs(5);
/// For how long a port that is shared is lent to nobody after somebody stopped its board: whoever drove it is to end, and not to come back.
const STOPPED: Duration = Duration::from_secs(12);
/// Longest line that a visitor says, bytes, and what waits for one that does not read.
const MOST_LINE: usize = 64;
const MOST_WAITING: usize = 1 << 16;
/// How often those who watch are told.
const EACH: Duration = Duration::from_millis(50);
/// For how long who drives may say nothing before another one may: a host says that it is there every 5 ms.
const LEASE: Duration = Duration::from_secs(2);

/// What who may drive is answered.
const YOURS: &[u8] = b"{\"yours\": true}\n";

/// The folder of sockets of this user's.
///
/// # Errors
/// It cannot be made, or is somebody else's.
pub(crate) fn folder() -> io::Result<PathBuf> {
    let own = rustix::process::geteuid().as_raw();
    let folder = match std::env::var_os("XDG_RUNTIME_DIR").filter(|dir| Path::new(dir).is_dir()) {
        Some(dir) => Path::new(&dir).join("tracelight"),
        None => std::env::temp_dir().join(format!("tracelight-{own}")),
    };
    std::fs::DirBuilder::new().recursive(true).mode(0o700).create(&folder)?;
    let is = std::fs::symlink_metadata(&folder)?;
    if is.is_dir() && is.uid() == own {
        return Ok(folder);
    }
    let message = format!("{} is not a folder of yours", folder.display());
    Err(io::Error::new(io::ErrorKind::PermissionDenied, message))
}

/// The socket at which the owner of a port answers, by whatever name the port is called.
///
/// # Errors
/// As of [`folder`].
pub(crate) fn socket_of(port: &Path) -> io::Result<PathBuf> {
    let port = std::fs::canonicalize(port).unwrap_or_else(|_| port.to_owned());
    let name: String = port
        .to_string_lossy()
        .trim_start_matches('/')
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' })
        .collect();
    Ok(folder()?.join(format!("{name}.sock")))
}

/// The owner's side.
#[derive(Debug)]
pub(crate) struct Shared {
    listener: UnixListener,
    at: PathBuf,
    port: PathBuf,
    visitors: Vec<Visitor>,
    /// What the owner does, as people call it.
    does: String,
    /// Whether a visitor may drive: the owner himself does otherwise.
    lends: bool,
    /// What was told last, and when.
    told: Option<(Seen, Instant)>,
    /// When somebody last stopped the board.
    stopped: Option<Instant>,
    /// Which socket is this one, whatever lies there by its name later.
    inode: u64,
}

#[derive(Debug)]
struct Visitor {
    stream: UnixStream,
    /// Bytes of a line that is not over.
    line: Vec<u8>,
    waiting: Vec<u8>,
    role: Role,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    /// Has come then, and said nothing yet.
    Guest(Instant),
    /// Is told what is seen.
    Watcher,
    /// Drives the board, and was last heard then.
    Driver(Instant),
    /// Gone.
    Gone,
}

/// What visitors want.
#[derive(Debug, Default)]
pub(crate) struct Wanted {
    /// Whether it is to be disarmed.
    pub(crate) disarm: bool,
    /// Bytes of who drives, for the board.
    pub(crate) bytes: Vec<u8>,
}

impl Shared {
    /// Answers for a port that is open here, and nowhere else: what another one has left behind at its socket is old.
    ///
    /// # Errors
    /// The socket cannot be made.
    pub(crate) fn new(port: &Path, lends: bool) -> io::Result<Self> {
        let at = socket_of(port)?;
        match std::fs::remove_file(&at) {
            Err(e) if e.kind() != io::ErrorKind::NotFound => return Err(e),
            _ => {}
        }
        let listener = UnixListener::bind(&at)?;
        listener.set_nonblocking(true)?;
        let inode = std::fs::symlink_metadata(&at)?.ino();
        let does: Vec<String> = std::env::args_os().map(|word| word.to_string_lossy().into_owned()).collect();
        let program = does.first().map(Path::new).and_then(Path::file_name).unwrap_or_default();
        let first = does.get(1).map_or_else(String::new, |word| format!(" {word}"));
        let does = format!("{}{first}", program.to_string_lossy());
        let (visitors, port) = (Vec::new(), port.to_owned());
        Ok(Self { listener, at, port, visitors, does, lends, told: None, stopped: None, inode })
    }

    /// Lets visitors in, and hears what they want.
    pub(crate) fn hear(&mut self) -> Wanted {
        while let Ok((stream, _)) = self.listener.accept() {
            if self.visitors.len() < MOST_VISITORS && stream.set_nonblocking(true).is_ok() {
                let greeting = format!("{}\n", self.greeting());
                let waiting = greeting.into_bytes();
                self.visitors.push(Visitor {
                    stream,
                    line: Vec::new(),
                    waiting,
                    role: Role::Guest(Instant::now()),
                });
            }
        }
        let mut wanted = Wanted::default();
        for number in 0..self.visitors.len() {
            self.hear_one(number, &mut wanted);
        }
        self.visitors.iter_mut().for_each(Visitor::flush);
        let stays = |visitor: &Visitor| match visitor.role {
            Role::Gone => false,
            Role::Guest(came) => came.elapsed() < GUEST,
            Role::Watcher | Role::Driver(_) => true,
        };
        self.visitors.retain(stays);
        wanted
    }

    fn hear_one(&mut self, number: usize, wanted: &mut Wanted) {
        let mut bytes = [0; 4096];
        let Some(visitor) = self.visitors.get_mut(number) else { return };
        let count = match visitor.stream.read(&mut bytes) {
            Ok(0) => return visitor.role = Role::Gone,
            Ok(count) => count,
            Err(e) if matches!(e.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted) => return,
            Err(_) => return visitor.role = Role::Gone,
        };
        let mut rest = &bytes[..count];
        while !rest.is_empty() {
            let Some(visitor) = self.visitors.get_mut(number) else { return };
            if matches!(visitor.role, Role::Driver(_)) {
                visitor.role = Role::Driver(Instant::now());
                return wanted.bytes.extend_from_slice(rest);
            }
            let end = rest.iter().position(|byte| *byte == b'\n');
            let (now, later) = end.map_or((rest, &[][..]), |end| (&rest[..end], &rest[end + 1..]));
            visitor.line.extend_from_slice(now);
            rest = later;
            if visitor.line.len() > MOST_LINE {
                return visitor.role = Role::Gone;
            }
            if end.is_some() {
                let line = std::mem::take(&mut visitor.line);
                self.obey(number, &line, wanted);
            }
        }
    }

    fn obey(&mut self, number: usize, line: &[u8], wanted: &mut Wanted) {
        let is_in_use = !self.lends || self.is_driven();
        let is_free = self.lends && !self.is_driven() && !self.is_stopped();
        let greeting = format!("{}\n", self.greeting());
        let Some(visitor) = self.visitors.get_mut(number) else { return };
        match line {
            b"watch" => visitor.role = Role::Watcher,
            b"disarm" => {
                wanted.disarm = true;
                self.stopped = is_in_use.then(Instant::now).or(self.stopped);
            }
            b"drive" if is_free => {
                visitor.role = Role::Driver(Instant::now());
                visitor.say(YOURS);
                // who was silent for so long drives no more, though he speaks again
                let others = self.visitors.iter_mut().enumerate().filter(|(other, _)| *other != number);
                let expired = others.filter(|(_, other)| matches!(other.role, Role::Driver(_)));
                expired.for_each(|(_, other)| other.role = Role::Gone);
            }
            // who drives it is in there
            b"drive" => visitor.say(greeting.as_bytes()),
            _ => visitor.role = Role::Gone,
        }
    }

    /// Whether a visitor drives, who was heard of late.
    pub(crate) fn is_driven(&self) -> bool {
        let drives =
            |visitor: &Visitor| matches!(visitor.role, Role::Driver(heard) if heard.elapsed() < LEASE);
        self.visitors.iter().any(drives)
    }

    /// Whether somebody stopped the board a moment ago.
    fn is_stopped(&self) -> bool {
        self.stopped.is_some_and(|at| at.elapsed() < STOPPED)
    }

    /// Sends away whoever drives the board: it was stopped.
    pub(crate) fn send_away(&mut self) {
        let drivers = self.visitors.iter_mut().filter(|visitor| matches!(visitor.role, Role::Driver(_)));
        drivers.for_each(|visitor| visitor.role = Role::Gone);
    }

    fn greeting(&self) -> Value {
        json!({
            "tracelight": env!("CARGO_PKG_VERSION"), "port": self.port.to_string_lossy(), "owner": self.does, "pid": std::process::id(),
            "lends": self.lends, "driven": !self.lends || self.is_driven(), "stopped": self.is_stopped(),
        })
    }

    /// Passes what the board said to who drives it.
    pub(crate) fn pass(&mut self, bytes: &[u8]) {
        for visitor in &mut self.visitors {
            match visitor.role {
                // who was silent for so long has nothing to say any more
                Role::Driver(heard) if heard.elapsed() > LEASE => visitor.role = Role::Gone,
                Role::Driver(_) => visitor.say(bytes),
                _ => {}
            }
        }
    }

    /// Tells those who watch what was seen, now and then, and at once where it is something else.
    pub(crate) fn tell(&mut self, seen: &Seen) {
        let is_due =
            self.told.as_ref().is_none_or(|(before, at)| at.elapsed() >= EACH || before.differs(seen));
        if !is_due {
            return;
        }
        self.told = Some((seen.clone(), Instant::now()));
        if self.visitors.iter().any(|visitor| visitor.role == Role::Watcher) {
            let line = format!("{}\n", seen.json());
            let watchers = self.visitors.iter_mut().filter(|visitor| visitor.role == Role::Watcher);
            watchers.for_each(|visitor| visitor.say(line.as_bytes()));
        }
    }
}

impl Drop for Shared {
    fn drop(&mut self) {
        // another program may answer there meanwhile
        if std::fs::symlink_metadata(&self.at).is_ok_and(|is| is.ino() == self.inode) {
            // who cannot take it away leaves it: nobody answers there
            let _ = std::fs::remove_file(&self.at);
        }
    }
}

impl Visitor {
    /// Says something, once there is room for it; who does not read is sent away.
    fn say(&mut self, bytes: &[u8]) {
        if self.waiting.len() + bytes.len() > MOST_WAITING {
            self.role = Role::Gone;
            return;
        }
        self.waiting.extend_from_slice(bytes);
        self.flush();
    }

    fn flush(&mut self) {
        if self.waiting.is_empty() {
            return;
        }
        match self.stream.write(&self.waiting) {
            Ok(count) => drop(self.waiting.drain(..count)),
            Err(e) if matches!(e.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted) => {}
            Err(_) => self.role = Role::Gone,
        }
    }
}

/// What is told of a board that somebody else stopped.
pub(crate) fn stopped(port: &str) -> Failure {
    let message = format!(
        "{port}: another program made the head dark (`tracelight stop`): it stays dark; `tracelight resume` with the folder of this run draws what is left"
    );
    Failure::failed("disarmed", message)
}

/// Who has a port, as he greets.
#[derive(Debug)]
pub(crate) struct Owner {
    pub(crate) stream: UnixStream,
    pub(crate) greeting: Value,
}

/// How long an owner may take to answer.
const PATIENCE: Duration = Duration::from_millis(500);

impl Owner {
    /// Visits whoever has a port, at its socket; `None` where there is nobody.
    ///
    /// # Errors
    /// Somebody is there, and does not answer.
    pub(crate) fn of(socket: &Path) -> io::Result<Option<Self>> {
        let mut stream = match UnixStream::connect(socket) {
            Err(e) if matches!(e.kind(), io::ErrorKind::NotFound | io::ErrorKind::ConnectionRefused) => {
                return Ok(None);
            }
            connected => connected?,
        };
        stream.set_read_timeout(Some(PATIENCE))?;
        stream.set_write_timeout(Some(PATIENCE))?;
        let greeting = serde_json::from_str(&line_of(&mut stream)?)?;
        Ok(Some(Self { stream, greeting }))
    }

    /// The port.
    pub(crate) fn port(&self) -> &str {
        self.greeting["port"].as_str().unwrap_or("a port")
    }

    /// Whether anybody drives the board.
    pub(crate) fn is_driven(&self) -> bool {
        self.greeting["driven"].as_bool() != Some(false)
    }

    /// Who he is, for people.
    pub(crate) fn words(&self) -> String {
        let owner = self.greeting["owner"].as_str().unwrap_or("another program");
        format!("{owner} (pid {})", self.greeting["pid"])
    }

    /// Asks to drive the board; who drives it, if another one does.
    ///
    /// # Errors
    /// `port`: another one drives it.
    pub(crate) fn drive(mut self) -> Result<UnixStream, Failure> {
        let refused = |words: String, port: &str| {
            let message = format!(
                "{port}: it is in use by {words}: end that, or wait; `tracelight watch {port}` shows what it does, `tracelight stop {port}` makes it dark"
            );
            Failure::usage("port", message)
        };
        let is_driven = self.is_driven();
        let mut is_lent = || {
            self.stream.write_all(b"drive\n")?;
            line_of(&mut self.stream).map(|line| line.as_bytes() == &YOURS[..YOURS.len() - 1])
        };
        if self.greeting["stopped"] == true {
            return Err(stopped(self.port()));
        }
        if is_driven || !is_lent().unwrap_or(false) {
            return Err(refused(self.words(), self.port()));
        }
        Ok(self.stream)
    }
}

/// A line that somebody says.
pub(crate) fn line_of(stream: &mut UnixStream) -> io::Result<String> {
    const MOST: usize = 4096;
    let (mut line, mut byte) = (Vec::new(), [0]);
    while line.len() < MOST {
        stream.read_exact(&mut byte)?;
        if byte[0] == b'\n' {
            return String::from_utf8(line).map_err(io::Error::other);
        }
        line.push(byte[0]);
    }
    Err(io::ErrorKind::InvalidData.into())
}
