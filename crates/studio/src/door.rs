//! A door: where connections come in, how many at once, and how long one may take to say what it wants and to take what it is told.

use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, ready};
use std::time::Duration;

use axum::{Extension, Router};
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::time::{Instant, Sleep};
use tokio_rustls::TlsAcceptor;

/// How long a connection may take to become private, to say what it asks, and to take any part of what it is told; one that asks nothing any more is closed after that.
const PATIENCE: Duration = Duration::from_secs(15);
/// What a listener that fails waits until it tries again: it has too many files open, for example.
const AGAIN: Duration = Duration::from_millis(50);

/// A connection's place among those that there is room for, held for as long as anything of it lives: a socket outlives the request that opened it.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    _held: Arc<OwnedSemaphorePermit>,
}

/// Answers at a port, in private where there is a certificate, up to so many connections at once; those beyond are closed.
pub(crate) async fn serve(listener: TcpListener, private: Option<TlsAcceptor>, router: Router, most: usize) {
    let room = Arc::new(Semaphore::new(most));
    loop {
        let Ok((stream, _)) = listener.accept().await else {
            tokio::time::sleep(AGAIN).await;
            continue;
        };
        let Ok(held) = Arc::clone(&room).try_acquire_owned() else { continue };
        let place = Place { _held: Arc::new(held) };
        drop(tokio::spawn(welcome(stream, private.clone(), router.clone().layer(Extension(place)))));
    }
}

async fn welcome(stream: TcpStream, private: Option<TlsAcceptor>, router: Router) {
    // what is said to stop does not wait for more to be said
    let _ = stream.set_nodelay(true);
    let stream = Patient::new(stream);
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

/// A stream that ends where nothing of what is sent is taken for a while.
struct Patient {
    stream: TcpStream,
    /// When it ends, where it waits.
    until: Option<Pin<Box<Sleep>>>,
}

impl Patient {
    const fn new(stream: TcpStream) -> Self {
        Self { stream, until: None }
    }

    /// What a write came to, which does not wait for ever.
    fn patiently<T>(
        &mut self,
        context: &mut Context<'_>,
        done: Poll<std::io::Result<T>>,
    ) -> Poll<std::io::Result<T>> {
        if done.is_ready() {
            self.until = None;
            return done;
        }
        let until =
            self.until.get_or_insert_with(|| Box::pin(tokio::time::sleep_until(Instant::now() + PATIENCE)));
        ready!(until.as_mut().poll(context));
        Poll::Ready(Err(std::io::ErrorKind::TimedOut.into()))
    }
}

impl AsyncRead for Patient {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        into: &mut ReadBuf<'_>,
    ) -> Poll<std::io::Result<()>> {
        Pin::new(&mut self.stream).poll_read(context, into)
    }
}

impl AsyncWrite for Patient {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<std::io::Result<usize>> {
        let done = Pin::new(&mut self.stream).poll_write(context, bytes);
        self.patiently(context, done)
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<std::io::Result<()>> {
        let done = Pin::new(&mut self.stream).poll_flush(context);
        self.patiently(context, done)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<std::io::Result<()>> {
        let done = Pin::new(&mut self.stream).poll_shutdown(context);
        self.patiently(context, done)
    }
}
