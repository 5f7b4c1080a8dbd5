//! Cameras and calibrations, as they are asked for by HTTP.

use std::sync::Arc;

use axum::Json;
use axum::body::Bytes;
use axum::extract::{Extension, Path, Query, State};
use axum::http::header::{CACHE_CONTROL, CONTENT_DISPOSITION, CONTENT_SECURITY_POLICY, CONTENT_TYPE};
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use serde_json::{Map, Value, json};

use crate::beside::{Shared, beside, discard as to_trash, only_operators};
use crate::calibrations::Wanted;
use crate::devices::Caller;
use crate::folder::Kind;
use crate::guard::SHOWN;
use crate::refused::Refused;
use crate::tasks::Wanting;

/// All cameras.
pub(crate) async fn cameras(
    State(desk): Shared,
    Extension(caller): Extension<Caller>,
) -> Result<Json<Value>, Refused> {
    only_operators(&caller)?;
    beside(move || Ok(desk.cameras())).await.map(Json)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Looks {
    /// The number of the image that was seen last: a newer one is waited for.
    #[serde(default)]
    after: u64,
    /// The calibration that it is held against.
    #[serde(default)]
    calibration: String,
}

/// What a camera sees next.
pub(crate) async fn look(
    State(desk): Shared,
    Extension(caller): Extension<Caller>,
    Path(id): Path<String>,
    Query(Looks { after, calibration }): Query<Looks>,
) -> Result<Json<Value>, Refused> {
    only_operators(&caller)?;
    desk.look(&id, &calibration, after).await.map(Json).map_err(Refused::from)
}

/// An image of a camera that is looked through.
pub(crate) async fn image(
    State(desk): Shared,
    Extension(caller): Extension<Caller>,
    Path((id, number)): Path<(String, u64)>,
) -> Result<Response, Refused> {
    only_operators(&caller)?;
    let jpeg = desk.watching.image(&id, number).ok_or_else(|| Refused::missing("image"))?;
    Ok(([(CONTENT_TYPE, "image/jpeg"), (CACHE_CONTROL, "no-store"), (CONTENT_SECURITY_POLICY, SHOWN)], jpeg)
        .into_response())
}

/// All calibrations.
pub(crate) async fn calibrations(State(desk): Shared) -> Result<Json<Value>, Refused> {
    beside(move || Ok(desk.calibrations())).await.map(Json)
}

/// Calibrates.
pub(crate) async fn calibrate(
    State(desk): Shared,
    Extension(caller): Extension<Caller>,
    bytes: Bytes,
) -> Result<Json<Value>, Refused> {
    let wanted: Wanted = serde_json::from_slice(&bytes).map_err(|e| {
        Refused::usage(format!(
            "a calibration is asked for by {{\"of\": \"markers\", \"lens\", \"head\" or \"corners\", \"name\": \"wall.toml\", \"camera\": ID, \"flags\": {{…}}}}: {e}"
        ))
    })?;
    let _waits = desk.waits(&caller)?;
    let work = desk.work();
    // who leaves wants nothing of it any more
    let _wanted = Wanting(Arc::clone(&work));
    let turn = Arc::clone(&desk.experimenting).lock_owned().await;
    if let Some(camera) = wanted.camera() {
        desk.watching.free(camera).await;
    }
    beside(move || {
        let _turn = turn;
        desk.calibrate(&wanted, work)
    })
    .await
    .map(Json)
}

/// Deletes a calibration.
pub(crate) async fn discard(
    desk: Shared,
    Path((kind, name)): Path<(Kind, String)>,
) -> Result<Json<Value>, Refused> {
    match kind {
        Kind::Cameras | Kind::Heads => to_trash(desk, kind, name).await,
        Kind::Pictures | Kind::Runs | Kind::Rigs => Err(Refused::missing("calibration")),
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Printed {
    #[serde(default)]
    paper: String,
    #[serde(default)]
    board: String,
}

/// Pages of markers, to be printed.
pub(crate) async fn printed(
    State(desk): Shared,
    Query(Printed { paper, board }): Query<Printed>,
) -> Result<Response, Refused> {
    let flags: Map<String, Value> = [("paper", paper), ("board", board)]
        .into_iter()
        .map(|(flag, value)| (flag.to_owned(), json!(value)))
        .collect();
    let pdf = beside(move || desk.printed(&flags)).await?;
    let head = [
        (CONTENT_TYPE, "application/pdf"),
        (CONTENT_DISPOSITION, "attachment; filename=\"pages.pdf\""),
        (CACHE_CONTROL, "no-store"),
    ];
    Ok((head, pdf).into_response())
}
