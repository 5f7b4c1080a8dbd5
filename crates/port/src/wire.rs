//! What bytes go by to a board that speaks Grbl: a serial line, or the net.

use std::io::{self, ErrorKind, Read as _, Write as _};
use std::net::{TcpStream, ToSocketAddrs as _};
use std::path::Path;
use std::time::Duration;

use tracelight_task::Failure;

use crate::port::Port;

/// Speed of the serial line of every Grbl 1.1.
const BAUD: u32 = 115_200;
/// The port at which boards with a net answer: that of Telnet.
const TELNET: u16 = 23;
/// How long a board on the net may take to answer, and to take what is written.
const PATIENCE: Duration = Duration::from_secs(3);

/// A line to a board.
#[derive(Debug)]
pub(crate) enum Wire {
    Serial(Port),
    Net(TcpStream),
}

impl Wire {
    /// Opens a serial port by its path, or a connection by `tcp:HOST` or `tcp:HOST:PORT`.
    ///
    /// # Errors
    /// `port`: it cannot be opened, why, and what to do.
    pub(crate) fn open(at: &str) -> Result<Self, Failure> {
        let Some(host) = at.strip_prefix("tcp:") else {
            return Ok(Self::Serial(Port::open_alone(Path::new(at))?.at_speed(BAUD)?));
        };
        let wrong = |e: &dyn std::fmt::Display| {
            Failure::usage(
                "port",
                format!(
                    "{at}: {e}: see whether the board is on, in this network, and listens there (port {TELNET} unless you say another one)"
                ),
            )
        };
        let has_port = host.rsplit_once(':').is_some_and(|(_, port)| port.parse::<u16>().is_ok());
        let address = if has_port { host.to_owned() } else { format!("{host}:{TELNET}") };
        let all = address.to_socket_addrs().map_err(|e| wrong(&e))?;
        let mut last = io::Error::from(ErrorKind::NotFound);
        for one in all {
            match TcpStream::connect_timeout(&one, PATIENCE) {
                Ok(stream) => {
                    let ready = || {
                        stream.set_nodelay(true)?;
                        stream.set_write_timeout(Some(PATIENCE))
                    };
                    ready().map_err(|e| wrong(&e))?;
                    return Ok(Self::Net(stream));
                }
                Err(e) => last = e,
            }
        }
        Err(wrong(&last))
    }

    /// Reads what is there, after waiting for something up to that long.
    ///
    /// # Errors
    /// The line is gone.
    pub(crate) fn read(&mut self, out: &mut Vec<u8>, wait: Duration) -> io::Result<()> {
        match self {
            Self::Serial(port) => port.read(out, wait),
            Self::Net(stream) => {
                stream.set_read_timeout(Some(wait))?;
                let mut bytes = [0; 4096];
                match stream.read(&mut bytes) {
                    Ok(0) => Err(ErrorKind::UnexpectedEof.into()),
                    Ok(count) => {
                        out.extend_from_slice(&bytes[..count]);
                        Ok(())
                    }
                    Err(e)
                        if matches!(
                            e.kind(),
                            ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
                        ) =>
                    {
                        Ok(())
                    }
                    Err(e) => Err(e),
                }
            }
        }
    }

    /// Writes bytes.
    ///
    /// # Errors
    /// The line is gone, or held up.
    pub(crate) fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::Serial(port) => port.write(bytes),
            Self::Net(stream) => stream.write_all(bytes),
        }
    }
}
