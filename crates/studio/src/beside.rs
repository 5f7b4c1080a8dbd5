//! What answers to requests have in common.

use std::sync::Arc;

use axum::Json;
use axum::extract::State;
use serde_json::{Value, json};
use tokio::task::spawn_blocking;
use tracelight_task::Failure;

use crate::desk::Desk;
use crate::devices::Caller;
use crate::folder::Kind;
use crate::guard::forbidden;
use crate::refused::Refused;
use crate::tasks::broken;

pub(crate) type Shared = State<Arc<Desk>>;

/// Does work that computes or reads files beside what answers.
pub(crate) async fn beside<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, Failure> + Send + 'static,
) -> Result<T, Refused> {
    let done = spawn_blocking(work).await;
    done.unwrap_or_else(|_| Err(broken())).map_err(Refused::from)
}

/// Refuses devices that look on.
pub(crate) fn only_operators(caller: &Caller) -> Result<(), Refused> {
    let why = "this device may look on: cameras, and what takes long, are for who operates";
    if caller.operates() { Ok(()) } else { Err(forbidden(why)) }
}

/// Puts something into the trash.
pub(crate) async fn discard(State(desk): Shared, kind: Kind, id: String) -> Result<Json<Value>, Refused> {
    let done = beside(move || desk.folder.discard(kind, &id)).await;
    done.map(|name| Json(json!({ "in_trash": name }))).map_err(Refused::of_path)
}
