//! A door: where connections come in, how many at once, and how long one may take to say what it wants.

use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;
use tokio_rustls::TlsAcceptor;

/// How long a connection may take to become private, and to say what it asks; one that asks nothing any more is closed after that.
const PATIENCE: Duration = Duration::from_secs(15);
/// What a listener that fails waits until it tries again: it has too many files open, for example.
const AGAIN: Duration = Duration::from_millis(50);

/// Answers at a port, in private where there is a certificate, up to so many connections at once; those beyond are closed.
pub(crate) async fn serve(listener: TcpListener, private: Option<TlsAcceptor>, router: Router, most: usize) {
    let room = Arc::new(Semaphore::new(most));
    loop {
        let Ok((stream, _)) = listener.accept().await else {
            tokio::time::sleep(AGAIN).await;
            continue;
        };
        let Ok(place) = Arc::clone(&room).try_acquire_owned() else { continue };
        let (private, router) = (private.clone(), router.clone());
        drop(tokio::spawn(async move {
            let _place = place;
            welcome(stream, private, router).await;
        }));
    }
}

async fn welcome(stream: TcpStream, private: Option<TlsAcceptor>, router: Router) {
    // what is said to stop does not wait for more to be said
    let _ = stream.set_nodelay(true);
    match private {
        None => answer(stream, router).await,
        Some(private) => {
            if let Ok(Ok(stream)) = tokio::time::timeout(PATIENCE, private.accept(stream)).await {
                answer(stream, router).await;
            }
        }
    }
}

async fn answer(stream: impl AsyncRead + AsyncWrite + Unpin + Send + 'static, router: Router) {
    let mut http = http1::Builder::new();
    http.timer(TokioTimer::new()).header_read_timeout(PATIENCE);
    let service = TowerToHyperService::new(router);
    // whoever breaks off is gone: there is nobody to tell
    let _ = http.serve_connection(TokioIo::new(stream), service).with_upgrades().await;
}
