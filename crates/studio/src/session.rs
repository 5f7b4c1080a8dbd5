//! Devices of the network, asked by HTTP: who somebody is, invited, joined, sent away.

use std::sync::Arc;

use axum::body::Bytes;
use axum::extract::{Extension, Path, State};
use axum::http::header::SET_COOKIE;
use axum::response::{IntoResponse, Response};
use axum::{Json, http::StatusCode};
use serde::Deserialize;
use serde_json::{Value, json};
use tracelight_task::Failure;

use crate::desk::Desk;
use crate::devices::{Caller, Devices, INVITED, Role};
use crate::guard::COOKIE_NAME;
use crate::lan::{Lan, code_svg};
use crate::refused::Refused;

type Network = State<Option<Arc<Lan>>>;
type Known = State<Arc<Devices>>;

/// Who asks, and what devices there are, for who may send them away.
pub(crate) async fn told(
    Extension(caller): Extension<Caller>,
    State(lan): Network,
    State(devices): Known,
    State(desk): State<Arc<Desk>>,
) -> Json<Value> {
    let operates = caller.operates();
    let lan = lan.filter(|_| operates);
    let lan = lan.map(|lan| json!({ "addresses": lan.addresses(), "fingerprint": lan.fingerprint }));
    let devices = operates.then(|| devices.json());
    let last = caller.role.map(|_| desk.last());
    Json(
        json!({ "role": caller.role, "local": caller.is_local, "device": caller.device, "lan": lan, "devices": devices, "last": last }),
    )
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Joins {
    invitation: String,
    #[serde(default)]
    name: String,
}

/// A device joins by its invitation, once.
pub(crate) async fn join(State(devices): Known, bytes: Bytes) -> Result<Response, Refused> {
    let Joins { invitation, name } = serde_json::from_slice(&bytes).map_err(|e| {
        Refused::usage(format!("a device joins by {{\"invitation\": SECRET, \"name\": NAME}}: {e}"))
    })?;
    let (secret, role) = devices.join(&invitation, &name).ok_or_else(|| {
        let message = "this invitation was used already, or has run out: ask for another one on the studio's own computer";
        Refused::with(StatusCode::UNAUTHORIZED, Failure::usage("not-invited", message))
    })?;
    let cookie =
        format!("{COOKIE_NAME}={}; Path=/; Secure; HttpOnly; SameSite=Strict; Max-Age=2592000", secret.hex());
    Ok(([(SET_COOKIE, cookie)], Json(json!({ "role": role }))).into_response())
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Invites {
    role: Role,
}

/// Invites a device: what its camera is to read.
pub(crate) async fn invite(
    State(lan): Network,
    State(devices): Known,
    bytes: Bytes,
) -> Result<Json<Value>, Refused> {
    let Invites { role } = serde_json::from_slice(&bytes).map_err(|e| {
        Refused::usage(format!("a device is invited by {{\"role\": \"operator\" or \"viewer\"}}: {e}"))
    })?;
    let Some(lan) = lan else {
        return Err(Refused::usage("no device reaches this studio: start it with tracelight studio --lan"));
    };
    let links = links(&lan, &devices, role)?;
    let code = links.first().and_then(|link| code_svg(link));
    Ok(Json(json!({
        "role": role, "links": links, "code_svg": code, "fingerprint": lan.fingerprint, "holds_s": INVITED.as_secs(),
    })))
}

/// Where a device that is invited joins, by each of this computer's addresses.
///
/// # Errors
/// `internal` where the system gives no random numbers.
pub(crate) fn links(lan: &Lan, devices: &Devices, role: Role) -> Result<Vec<String>, Failure> {
    let secret = devices.invite(role);
    let secret =
        secret.ok_or_else(|| Failure::failed("internal", "this computer gives no random numbers"))?.hex();
    // behind #: no server's log and no other page is told it
    Ok(lan.addresses().iter().map(|address| format!("{address}#join={secret}")).collect())
}

/// Sends a device away.
pub(crate) async fn send_away(State(devices): Known, Path(id): Path<u64>) -> Result<Json<Value>, Refused> {
    devices.send_away(id).then(|| Json(json!({ "sent_away": id }))).ok_or_else(|| Refused::missing("device"))
}
