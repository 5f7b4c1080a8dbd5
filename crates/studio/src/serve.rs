//! The server as a whole: its doors, a folder, and its end.

use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use tokio_rustls::TlsAcceptor;
use tracelight_task::{Failure, Stop};

use crate::desk::Desk;
use crate::devices::{Devices, Role};
use crate::door;
use crate::folder::Folder;
use crate::guard::Door;
use crate::house::House;
use crate::lan::{self, Lan};
use crate::program::Program;
use crate::server::router;
use crate::session::links;

/// Threads for what computes or reads files: a job, a plan, an experiment, a move, and files that are read meanwhile.
const THREADS: usize = 12;
/// How often is looked whether it is to end.
const LOOK: Duration = Duration::from_millis(50);
/// Connections at once: of this computer, and of the network, whose devices take no room from it.
const MOST_LOCAL: usize = 256;
const MOST_LAN: usize = 128;

/// A studio whose doors are open.
pub struct Studio {
    listener: TcpListener,
    port: u16,
    network: Option<(TcpListener, TlsAcceptor)>,
    house: House,
}

/// What a device of the network joins by.
#[derive(Clone, Debug)]
pub struct Invitation {
    /// The address, by the likeliest name of this computer; it holds for one device, ten minutes.
    pub link: String,
    /// A code for cameras that says so, in letters of a terminal, light on dark.
    pub code: String,
    /// Of the server's certificate, SHA-256.
    pub fingerprint: String,
}

impl std::fmt::Debug for Studio {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Studio").field("port", &self.port).finish_non_exhaustive()
    }
}

/// Opens a port of this computer, 0 for any that is free, and a folder, which is made. With `on_lan` the next port is open too, to devices of the network that are
/// invited, in private.
///
/// # Errors
/// `port` where it is another program's; `cannot-write` where the folder cannot be made; `certificate`.
pub fn open(port: u16, on_lan: bool, folder: &Path, program: Box<dyn Program>) -> Result<Studio, Failure> {
    let (listener, port) = listen(Ipv4Addr::LOCALHOST, port)?;
    let folder = Folder::open(folder)?;
    let (network, lan) = if on_lan {
        let (private, fingerprint) = lan::private(folder.dir())?;
        // the next one, so that it is the same another time; where that is taken, any
        let next = port.checked_add(1).unwrap_or(0);
        let (listener, port) =
            listen(Ipv4Addr::UNSPECIFIED, next).or_else(|_| listen(Ipv4Addr::UNSPECIFIED, 0))?;
        (Some((listener, private)), Some(Arc::new(Lan { port, fingerprint })))
    } else {
        (None, None)
    };
    let house =
        House { desk: Arc::new(Desk::new(program, folder)), devices: Arc::new(Devices::default()), lan };
    Ok(Studio { listener, port, network, house })
}

fn listen(address: Ipv4Addr, port: u16) -> Result<(TcpListener, u16), Failure> {
    let at = SocketAddr::from((address, port));
    let cannot = |e: std::io::Error| {
        let message = format!(
            "cannot listen at {at}: {e}; is a studio open already? --port 0 takes any port that is free"
        );
        Failure::failed("port", message)
    };
    let listener = TcpListener::bind(at).map_err(cannot)?;
    listener.set_nonblocking(true).map_err(cannot)?;
    let port = listener.local_addr().map_err(cannot)?.port();
    Ok((listener, port))
}

impl Studio {
    /// Where its page is.
    #[must_use]
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }

    /// Invites a device of the network to operate it; nothing where it is open to none.
    ///
    /// # Errors
    /// `internal` where this computer gives no random numbers.
    pub fn invite(&self) -> Result<Option<Invitation>, Failure> {
        let Some(lan) = &self.house.lan else { return Ok(None) };
        let link = links(lan, &self.house.devices, Role::Operator)?.remove(0);
        let code = lan::code_text(&link).unwrap_or_default();
        Ok(Some(Invitation { link, code, fingerprint: lan.fingerprint.clone() }))
    }

    /// Takes a picture in, to be shown first; its id.
    ///
    /// # Errors
    /// `not-a-picture` by its name; `cannot-write`.
    pub fn add(&self, name: &str, bytes: &[u8]) -> Result<String, Failure> {
        self.house.desk.folder.add(name, bytes)
    }

    /// Answers until it is stopped, or for so long, s; what is traced then is stopped first.
    ///
    /// # Errors
    /// `internal` where this computer gives no threads.
    pub fn serve(self, lasts_s: Option<f64>, stop: &Stop) -> Result<(), Failure> {
        let failed = |e: std::io::Error| Failure::failed("internal", format!("cannot serve the studio: {e}"));
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(2)
            // few that stay: each has memory of its own, which comes back to nobody else
            .max_blocking_threads(THREADS)
            .thread_keep_alive(Duration::from_secs(3600))
            .enable_all()
            .build()
            .map_err(failed)?;
        // who ends it waits until what is traced is dark, and its results are whole
        let _kept = stop.keep();
        let (desk, stop) = (Arc::clone(&self.house.desk), stop.clone());
        let done = runtime.block_on(async move {
            let Self { listener, port, network, house } = self;
            let own = tokio::net::TcpListener::from_std(listener)?;
            drop(tokio::spawn(door::serve(own, None, router(house.clone(), Door::Local(port)), MOST_LOCAL)));
            if let Some((listener, private)) = network {
                let listener = tokio::net::TcpListener::from_std(listener)?;
                let by = Door::Lan(Arc::clone(&house.devices));
                drop(tokio::spawn(door::serve(listener, Some(private), router(house, by), MOST_LAN)));
            }
            wanted(&stop, lasts_s).await;
            Ok(())
        });
        desk.close();
        // who is stopped ends soon, with its results whole
        runtime.shutdown_timeout(Duration::from_secs(5));
        done.map_err(failed)
    }
}

async fn wanted(stop: &Stop, lasts_s: Option<f64>) {
    let began = Instant::now();
    while !stop.is_wanted() && lasts_s.is_none_or(|lasts_s| began.elapsed().as_secs_f64() < lasts_s) {
        tokio::time::sleep(LOOK).await;
    }
}
