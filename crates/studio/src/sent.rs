//! A file that is sent piece by piece: a run's log may be larger than the memory.

use std::fs::File;

use axum::body::{Body, Bytes};
use http_body_util::channel::Channel;
use tokio::io::AsyncReadExt as _;

/// Bytes of a piece, and pieces that wait to be taken.
const PIECE: usize = 1 << 16;
const WAITING: usize = 4;

/// A file's bytes as they are when it is asked for: one that grows meanwhile ends there.
pub(crate) fn sent(file: File) -> Body {
    let length = file.metadata().map_or(0, |meta| meta.len());
    let (mut to, body) = Channel::<Bytes, std::io::Error>::new(WAITING);
    drop(tokio::spawn(async move {
        let mut file = tokio::fs::File::from_std(file).take(length);
        loop {
            let mut piece = Vec::with_capacity(PIECE);
            match file.read_buf(&mut piece).await {
                Ok(0) => return,
                Ok(_) => {
                    if to.send_data(Bytes::from(piece)).await.is_err() {
                        return;
                    }
                }
                Err(error) => return to.abort(error),
            }
        }
    }));
    Body::new(body)
}
