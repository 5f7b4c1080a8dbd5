//! What is asked by HTTP, and answered.

use std::fs::File;
use std::sync::Arc;

use axum::body::Bytes;
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::{DefaultBodyLimit, Extension, Path, Query, State};
use axum::http::header::{
    ACCEPT_ENCODING, CACHE_CONTROL, CONTENT_ENCODING, CONTENT_SECURITY_POLICY, CONTENT_TYPE, ETAG,
    IF_NONE_MATCH, VARY,
};
use axum::http::{HeaderMap, StatusCode};
use axum::middleware::from_fn_with_state;
use axum::response::{IntoResponse, Response};
use axum::routing::{delete, get, post};
use axum::{Json, Router};
use serde::Deserialize;
use serde_json::{Map, Value, json};

use crate::assets::packed;
use crate::beside::{Shared, beside, discard, only_operators};
use crate::desk::{Subject, Wanted};
use crate::devices::Caller;
use crate::door::Place;
use crate::folder::{EXAMPLES, Kind};
use crate::foxglove::{MOST_MESSAGE as MOST_READ, PROTOCOLS, serve_foxglove};
use crate::guard::{Door, SHOWN, guard};
use crate::head::Move;
use crate::house::House;
use crate::lab::Experiment;
use crate::refused::Refused;
use crate::rigs::Written;
use crate::sent::sent;
use crate::session;
use crate::socket::{MOST_MESSAGE, ask, serve_socket, watch_operator};
use crate::tasks::Wanting;
use crate::watch::{as_camera, is_simulated};
use crate::watching;

/// Everything there is, for who comes in by that door.
pub(crate) fn router(house: House, door: Door) -> Router {
    let api = Router::new()
        .route("/about", get(about))
        .route("/openapi.json", get(openapi))
        .route("/explain/{code}", get(explain))
        .route("/pictures", get(pictures).post(add))
        .route("/pictures/{id}", get(picture).delete(discard_picture))
        .route("/plans", post(plan))
        .route("/plans/{id}/points", get(points))
        .route("/jobs", post(trace))
        .route("/jobs/current", get(job))
        .route("/jobs/current/wishes", post(wish))
        .route("/live", get(live))
        .route("/foxglove", get(foxglove))
        .route("/head", post(move_head))
        .route("/lab", post(lab))
        .route("/lab/lessons", get(lessons))
        .route("/stop", post(stop))
        .route("/session", get(session::told))
        .route("/session/join", post(session::join))
        .route("/session/invitations", post(session::invite))
        .route("/session/devices/{id}", delete(session::send_away))
        .route("/runs", get(runs))
        .route("/runs/{run}", get(one_run).delete(discard_run))
        .route("/runs/{run}/files/{name}", get(run_file))
        .route("/rigs", get(rigs))
        .route("/rigs/{name}", get(rig).put(write_rig).delete(discard_rig))
        .route("/cameras", get(watching::cameras))
        .route("/cameras/{id}/look", get(watching::look))
        .route("/cameras/{id}/images/{number}", get(watching::image))
        .route("/calibrations", get(watching::calibrations).post(watching::calibrate))
        .route("/calibrations/pages.pdf", get(watching::printed))
        .route("/calibrations/{kind}/{name}", delete(watching::discard))
        .route("/trash/{kind}/{name}", post(restore))
        .route("/compare", get(compare));
    Router::new()
        .route("/", get(|headers: HeaderMap| async move { asset("index.html", &headers) }))
        .route(
            "/page/{name}",
            get(|Path(name): Path<String>, headers: HeaderMap| async move { asset(&name, &headers) }),
        )
        .nest("/api/v1", api)
        .fallback(|| async { Refused::missing("page").into_response() })
        // the guard reads what is sent, within its bounds
        .layer(DefaultBodyLimit::disable())
        .layer(from_fn_with_state(door, guard))
        .with_state(house)
}

async fn about(State(desk): Shared) -> Json<Value> {
    let head = desk.program.head().map(|head| {
        json!({ "name": head.draws_as, "planned_as": head.planned_as, "at_port": head.is_at_port, "real": head.is_real })
    });
    Json(json!({
        "name": "tracelight", "version": env!("CARGO_PKG_VERSION"), "folder": desk.folder.dir().to_string_lossy(),
        "head": head, "examples": EXAMPLES.map(|(name, _)| name),
    }))
}

/// What of all this there is, for programs that read such descriptions.
async fn openapi() -> Response {
    ([(CONTENT_TYPE, "application/json")], include_str!("openapi.json")).into_response()
}

async fn explain(State(desk): Shared, Path(code): Path<String>) -> Result<Json<Value>, Refused> {
    // a word, and no flag
    let code = code.trim_start_matches('-').to_owned();
    beside(move || desk.ask(&["explain", "--json", "--", &code])).await.map(Json)
}

async fn pictures(State(desk): Shared) -> Result<Json<Value>, Refused> {
    beside(move || Ok(desk.folder.listed())).await.map(|all| Json(json!({ "pictures": all })))
}

#[derive(Deserialize)]
struct Named {
    name: String,
}

async fn add(
    State(desk): Shared,
    Query(Named { name }): Query<Named>,
    bytes: Bytes,
) -> Result<Json<Value>, Refused> {
    beside(move || desk.folder.add(&name, &bytes)).await.map(|id| Json(json!({ "id": id })))
}

async fn picture(State(desk): Shared, Path(id): Path<String>) -> Result<Response, Refused> {
    let found = beside(move || Ok(desk.folder.picture_file(&id))).await?;
    found.map(shown).ok_or_else(|| Refused::missing("picture"))
}

/// Something of the folder.
fn shown((file, kind): (File, &'static str)) -> Response {
    let head = [(CONTENT_TYPE, kind), (CONTENT_SECURITY_POLICY, SHOWN), (CACHE_CONTROL, "no-cache")];
    (head, sent(file)).into_response()
}

/// What a page asks to be planned or traced.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Asked {
    #[serde(default)]
    picture: String,
    /// The run whose rest is drawn instead of a picture.
    #[serde(default)]
    rest_of: Option<String>,
    #[serde(default)]
    flags: Map<String, Value>,
    /// Which page asks.
    #[serde(default)]
    page: String,
    /// Its number of this wish: of two the higher one counts.
    #[serde(default)]
    number: u64,
    /// Whether the page operates it: by the clock, and armed from there.
    #[serde(default)]
    attended: bool,
}

/// Reads a request, or says what is wrong with it.
fn asked(bytes: &[u8]) -> Result<Asked, Refused> {
    serde_json::from_slice(bytes).map_err(|e| {
        let message = format!("a plan or a job is asked for by {{\"picture\": ID, \"flags\": {{…}}}}: {e}");
        Refused::usage(message)
    })
}

async fn plan(
    State(desk): Shared,
    Extension(caller): Extension<Caller>,
    bytes: Bytes,
) -> Result<Json<Value>, Refused> {
    let Asked { picture, flags, page, number, .. } = asked(&bytes)?;
    if let Some(camera) = as_camera(&picture) {
        // nobody is seen in a simulated room
        if !is_simulated(camera) {
            only_operators(&caller)?;
        }
    }
    let _waits = desk.waits(&caller)?;
    // a page of another device is another page, whatever it calls itself
    let page = if page.is_empty() { page } else { format!("{}:{page}", caller.device) };
    let planned = desk.begin_plan((&page, number), &picture, &flags)?;
    let turn = Arc::clone(&desk.planning).lock_owned().await;
    // what draws over it has it for itself; a simulated one is there for everybody
    if let Some(camera) = as_camera(&picture).filter(|camera| !is_simulated(camera)) {
        desk.watching.free(camera).await;
    }
    beside(move || {
        let _turn = turn;
        let made = desk.plan(planned)?;
        if caller.operates() {
            desk.note(&picture, &flags, &made);
        }
        Ok(made)
    })
    .await
    .map(Json)
}

async fn points(State(desk): Shared, Path(id): Path<u64>) -> Response {
    match desk.points(id) {
        Some(bytes) => {
            ([(CONTENT_TYPE, "application/octet-stream"), (CACHE_CONTROL, "no-store")], bytes).into_response()
        }
        None => Refused::missing("plan").into_response(),
    }
}

async fn trace(State(desk): Shared, bytes: Bytes) -> Result<(StatusCode, Json<Value>), Refused> {
    let Asked { picture, rest_of, flags, page, attended, .. } = asked(&bytes)?;
    if attended && page.is_empty() {
        return Err(Refused::usage("a job that is attended names the page that operates it"));
    }
    if let Some(camera) = as_camera(&picture).filter(|camera| !is_simulated(camera)) {
        desk.watching.free(camera).await;
    }
    let threads = tokio::runtime::Handle::current();
    // begun where nobody who leaves can interrupt it; it goes on when nobody looks any more
    let begun = beside(move || {
        let subject = rest_of.as_deref().map_or(Subject::Picture(&picture), Subject::RestOf);
        let operator = attended.then_some(page.as_str());
        let (begun, run) = desk.trace(&Wanted { subject, flags: &flags, operator })?;
        drop(threads.spawn_blocking(run));
        if attended {
            drop(threads.spawn(watch_operator(desk)));
        }
        Ok(begun)
    });
    Ok((StatusCode::ACCEPTED, Json(begun.await?)))
}

async fn job(State(desk): Shared) -> Json<Value> {
    Json(json!({ "job": desk.job() }))
}

/// What a page asks of the job that it operates.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Wished {
    page: String,
    wish: String,
}

async fn wish(State(desk): Shared, bytes: Bytes) -> Result<Json<Value>, Refused> {
    let Wished { page, wish } = serde_json::from_slice(&bytes)
        .map_err(|e| Refused::usage(format!("a wish is {{\"page\": ID, \"wish\": WORD}}: {e}")))?;
    ask(&desk, &page, &wish).map_err(Refused::usage)?;
    Ok(Json(json!({ "asked": wish })))
}

/// The job's events as they happen, for a page that names itself; what it sends are wishes, and that it is there.
async fn live(
    State(desk): Shared,
    Extension(caller): Extension<Caller>,
    place: Option<Extension<Place>>,
    Query(Page { page }): Query<Page>,
    upgrade: WebSocketUpgrade,
) -> Response {
    upgrade.max_message_size(MOST_MESSAGE).on_upgrade(async move |socket| {
        // as long as it is open it counts as a connection
        let _place = place;
        serve_socket(desk, (page, caller), socket).await;
    })
}

/// What happens, for Foxglove and programs like it.
async fn foxglove(
    State(desk): Shared,
    Extension(caller): Extension<Caller>,
    place: Option<Extension<Place>>,
    upgrade: WebSocketUpgrade,
) -> Response {
    upgrade.protocols(PROTOCOLS).max_message_size(MOST_READ).on_upgrade(async move |socket| {
        let _place = place;
        serve_foxglove(desk, caller, socket).await;
    })
}

#[derive(Deserialize)]
struct Page {
    page: String,
}

/// Moves the head at the port by hand.
async fn move_head(State(desk): Shared, bytes: Bytes) -> Result<Json<Value>, Refused> {
    let by: Move = serde_json::from_slice(&bytes).map_err(|e| {
        Refused::usage(format!(
            "a head is moved by {{\"move\": \"home\", \"park\", \"look\" or \"jog\", \"by\": \"5deg,0deg\"}}: {e}"
        ))
    })?;
    beside(move || desk.move_head(&by)).await.map(Json)
}

async fn lab(
    State(desk): Shared,
    Extension(caller): Extension<Caller>,
    bytes: Bytes,
) -> Result<Json<Value>, Refused> {
    let asked: Experiment = serde_json::from_slice(&bytes).map_err(|e| {
        Refused::usage(format!(
            "an experiment is asked for by {{\"command\": \"bode\", \"of\": [FORMULA], \"flags\": {{…}}}}: {e}"
        ))
    })?;
    if asked.is_long() {
        only_operators(&caller)?;
    }
    let _waits = desk.waits(&caller)?;
    let work = desk.work();
    // who leaves wants nothing of it any more
    let _wanted = Wanting(Arc::clone(&work));
    let turn = Arc::clone(&desk.experimenting).lock_owned().await;
    let operates = caller.operates();
    beside(move || {
        let _turn = turn;
        desk.experiment(&asked, (work, operates))
    })
    .await
    .map(Json)
}

async fn lessons(State(desk): Shared) -> Result<Json<Value>, Refused> {
    beside(move || Ok(desk.lessons())).await.map(Json)
}

/// Never refused, whatever is sent with it.
async fn stop(State(desk): Shared) -> Json<Value> {
    Json(json!({ "stopped": desk.stop() }))
}

async fn runs(State(desk): Shared) -> Result<Json<Value>, Refused> {
    beside(move || desk.runs()).await.map(Json)
}

async fn one_run(State(desk): Shared, Path(run): Path<String>) -> Result<Json<Value>, Refused> {
    let found = beside(move || desk.run(&run)).await?;
    found.map(Json).ok_or_else(|| Refused::missing("run"))
}

#[derive(Deserialize)]
struct Both {
    first: String,
    second: String,
}

async fn compare(
    State(desk): Shared,
    Query(Both { first, second }): Query<Both>,
) -> Result<Json<Value>, Refused> {
    beside(move || desk.compare(&first, &second)).await.map(Json)
}

async fn discard_run(desk: Shared, Path(run): Path<String>) -> Result<Json<Value>, Refused> {
    discard(desk, Kind::Runs, run).await
}

async fn discard_picture(desk: Shared, Path(id): Path<String>) -> Result<Json<Value>, Refused> {
    discard(desk, Kind::Pictures, id).await
}

async fn discard_rig(desk: Shared, Path(name): Path<String>) -> Result<Json<Value>, Refused> {
    discard(desk, Kind::Rigs, name).await
}

async fn rigs(State(desk): Shared) -> Result<Json<Value>, Refused> {
    beside(move || desk.rigs()).await.map(Json)
}

async fn rig(State(desk): Shared, Path(name): Path<String>) -> Result<Json<Value>, Refused> {
    beside(move || desk.rig_text(&name)).await.map(Json).map_err(Refused::of_path)
}

async fn write_rig(
    State(desk): Shared,
    Path(name): Path<String>,
    bytes: Bytes,
) -> Result<Json<Value>, Refused> {
    let written: Written = serde_json::from_slice(&bytes)
        .map_err(|e| Refused::usage(format!("a rig file is written by {{\"toml\": TEXT}}: {e}")))?;
    beside(move || desk.write_rig(&name, &written)).await.map(Json)
}

async fn restore(
    State(desk): Shared,
    Path((kind, name)): Path<(Kind, String)>,
) -> Result<Json<Value>, Refused> {
    let done = beside(move || desk.folder.restore(kind, &name)).await;
    done.map(|id| Json(json!({ "id": id }))).map_err(Refused::of_path)
}

async fn run_file(
    State(desk): Shared,
    Path((run, name)): Path<(String, String)>,
) -> Result<Response, Refused> {
    let found = beside(move || Ok(desk.folder.run_file(&run, &name))).await?;
    found.map(shown).ok_or_else(|| Refused::missing("file"))
}

/// A file of the page, zipped for who takes it so, or nothing anew for who has it.
fn asset(name: &str, headers: &HeaderMap) -> Response {
    let Some(packed) = packed(name) else { return Refused::missing("page").into_response() };
    let common = [(ETAG, packed.tag.as_str()), (CACHE_CONTROL, "no-cache"), (VARY, "accept-encoding")];
    let has = |name, text: &str| {
        headers.get(name).and_then(|value| value.to_str().ok()).is_some_and(|value| value.contains(text))
    };
    if has(IF_NONE_MATCH, &packed.tag) {
        return (StatusCode::NOT_MODIFIED, common).into_response();
    }
    let kind = (CONTENT_TYPE, packed.asset.kind);
    if has(ACCEPT_ENCODING, "gzip") && !packed.zipped.is_empty() {
        let zipped = [kind, (CONTENT_ENCODING, "gzip")];
        return (common, zipped, packed.zipped.clone()).into_response();
    }
    (common, [kind], packed.asset.text).into_response()
}

#[cfg(test)]
mod tests;
