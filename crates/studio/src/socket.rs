//! A page's line to the job that goes on: events one way, wishes and signs of life the other.

use std::sync::Arc;
use std::time::Duration;

use axum::extract::ws::{Message, WebSocket};
use serde::Deserialize;
use serde_json::json;
use tokio::sync::broadcast::Receiver;
use tokio::sync::broadcast::error::RecvError;

use crate::desk::Desk;

/// Longest message of a page, bytes.
pub(crate) const MOST_MESSAGE: usize = 1024;
/// How often is looked whether the operator is there.
const LOOK: Duration = Duration::from_millis(50);

/// What a page says.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Said {
    /// What it asks of the job.
    wish: Option<String>,
    /// Whether it says that it is there.
    #[serde(default)]
    here: bool,
}

/// Asks something of the job, for a page.
///
/// # Errors
/// Why that is refused.
pub(crate) fn ask(desk: &Desk, page: &str, wish: &str) -> Result<(), String> {
    let is_own = ["take", "refuse"].contains(&wish);
    if !is_own && !desk.program.knows(wish) {
        return Err(format!("{wish:?} is nothing that a job can be asked"));
    }
    if wish == "end" && desk.live.may_end(page) && !desk.live.has_begun() {
        // nobody hears wishes before the first tick
        desk.end();
        return Ok(());
    }
    desk.live.ask(page, wish)
}

/// Tells a page what happens, and hears it, until it leaves.
pub(crate) async fn serve_socket(desk: Arc<Desk>, page: String, mut socket: WebSocket) {
    let Some(mut told) = joined(&desk, &mut socket).await else { return };
    loop {
        tokio::select! {
            event = told.recv() => match event {
                Ok(event) => {
                    if socket.send(Message::Text(event.into())).await.is_err() {
                        return;
                    }
                }
                // it is told how things stand, as if it came just now
                Err(RecvError::Lagged(_)) => {
                    let Some(anew) = joined(&desk, &mut socket).await else { return };
                    told = anew;
                }
                Err(RecvError::Closed) => return,
            },
            said = socket.recv() => match said {
                Some(Ok(Message::Text(text))) => {
                    if let Some(answer) = hear(&desk, &page, &text)
                        && socket.send(Message::Text(answer.into())).await.is_err()
                    {
                        return;
                    }
                }
                Some(Ok(Message::Close(_)) | Err(_)) | None => return,
                Some(Ok(_)) => {}
            },
        }
    }
}

/// Tells a page how things stand; what it is told from then on, or nothing if it has left.
async fn joined(desk: &Desk, socket: &mut WebSocket) -> Option<Receiver<String>> {
    let (first, told) = desk.live.join();
    for event in first {
        socket.send(Message::Text(event.into())).await.ok()?;
    }
    Some(told)
}

/// Takes what a page said; what it is answered, if something is wrong with it.
fn hear(desk: &Desk, page: &str, text: &str) -> Option<String> {
    let refused = |why: String| Some(json!({ "event": "refused", "message": why }).to_string());
    let Ok(Said { wish, here }) = serde_json::from_str(text) else {
        return refused("a page says {\"wish\": WORD} or {\"here\": true}".to_owned());
    };
    if here || wish.is_some() {
        desk.live.hear(page);
    }
    wish.and_then(|wish| ask(desk, page, &wish).err()).and_then(refused)
}

/// Looks whether the operator of a job is there, for as long as it goes on.
pub(crate) async fn watch_operator(desk: Arc<Desk>) {
    while desk.live.is_on() {
        desk.live.look();
        tokio::time::sleep(LOOK).await;
    }
}
