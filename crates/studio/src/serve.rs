//! The server as a whole: a port, a folder, and its end.

use std::future::IntoFuture as _;
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use tracelight_task::{Failure, Stop};

use crate::desk::Desk;
use crate::folder::Folder;
use crate::program::Program;
use crate::server::router;

/// How often is looked whether it is to end.
const LOOK: Duration = Duration::from_millis(50);

/// A studio whose port is open.
pub struct Studio {
    listener: TcpListener,
    port: u16,
    desk: Arc<Desk>,
}

impl std::fmt::Debug for Studio {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Studio").field("port", &self.port).finish_non_exhaustive()
    }
}

/// Opens a port of this computer, 0 for any that is free, and a folder, which is made.
///
/// # Errors
/// `port` where it is another program's; `cannot-write` where the folder cannot be made.
pub fn open(port: u16, folder: &Path, program: Box<dyn Program>) -> Result<Studio, Failure> {
    let at = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
    let cannot = |e: std::io::Error| {
        let message = format!(
            "cannot listen at {at}: {e}; is a studio open already? --port 0 takes any port that is free"
        );
        Failure::failed("port", message)
    };
    let listener = TcpListener::bind(at).map_err(cannot)?;
    listener.set_nonblocking(true).map_err(cannot)?;
    let port = listener.local_addr().map_err(cannot)?.port();
    Ok(Studio { listener, port, desk: Arc::new(Desk::new(program, Folder::open(folder)?)) })
}

impl Studio {
    /// Where its page is.
    #[must_use]
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }

    /// Takes a picture in, to be shown first; its id.
    ///
    /// # Errors
    /// `not-a-picture` by its name; `cannot-write`.
    pub fn add(&self, name: &str, bytes: &[u8]) -> Result<String, Failure> {
        self.desk.folder.add(name, bytes)
    }

    /// Answers until it is stopped, or for so long, s; what is traced then is stopped first.
    ///
    /// # Errors
    /// `internal` where this computer gives no threads.
    pub fn serve(self, lasts_s: Option<f64>, stop: &Stop) -> Result<(), Failure> {
        let failed = |e: std::io::Error| Failure::failed("internal", format!("cannot serve the studio: {e}"));
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(2)
            .enable_all()
            .build()
            .map_err(failed)?;
        // who ends it waits until what is traced is dark, and its results are whole
        let _kept = stop.keep();
        let (desk, stop) = (Arc::clone(&self.desk), stop.clone());
        let done = runtime.block_on(async move {
            let listener = tokio::net::TcpListener::from_std(self.listener)?;
            let server = axum::serve(listener, router(self.desk, self.port)).into_future();
            tokio::select! {
                ended = server => ended,
                () = wanted(&stop, lasts_s) => Ok(()),
            }
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
