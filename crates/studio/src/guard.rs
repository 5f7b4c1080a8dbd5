//! Who may ask, and what: pages of this server on this computer, devices that were invited, and nobody else.

use std::sync::Arc;
use std::time::Duration;

use axum::body::{Body, Bytes};
use axum::extract::{Request, State};
use axum::http::header::{CONTENT_TYPE, COOKIE, HOST, ORIGIN, UPGRADE};
use axum::http::{HeaderMap, HeaderValue, Method, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use http_body_util::BodyExt as _;
use tracelight_task::Failure;

use crate::devices::{Caller, Devices};
use crate::folder::MOST_BYTES;
use crate::refused::Refused;

/// What a page of the studio may load: its own files.
const OWN: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; font-src 'self'; \
                   base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
/// What a picture or a report may do that lies in the folder: show itself. It is nobody's page, and asks nobody.
pub(crate) const SHOWN: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src 'self' data:; sandbox allow-scripts allow-popups";
/// The cookie of a device that has joined; the beginning binds it to this server, in private.
pub(crate) const COOKIE_NAME: &str = "__Host-tracelight";
/// Longest request but a picture, bytes.
const MOST_ASKED: usize = 1 << 16;
/// How long a request may pause while it is sent, and how long it may take in all.
const PAUSE: Duration = Duration::from_secs(15);
const WHOLE: Duration = Duration::from_secs(600);
/// What anybody may ask who reaches a door.
const STOP: &str = "/api/v1/stop";
const JOIN: &str = "/api/v1/session/join";
/// What is read and has an effect: a camera is opened, pages are made.
const EFFECTS: [&str; 2] = ["/api/v1/cameras", "/api/v1/calibrations/pages.pdf"];
/// What is read by Foxglove, also by its page on the net, which runs in a browser of this computer.
const FOXGLOVE: &str = "/api/v1/foxglove";
const FOXGLOVE_PAGE: &str = "https://app.foxglove.dev";

/// The door that a request came in by.
#[derive(Clone)]
pub(crate) enum Door {
    /// Of this computer alone, at that port.
    Local(u16),
    /// Of the network, for the devices that have joined.
    Lan(Arc<Devices>),
}

impl Door {
    /// Whether a request calls this computer by a name of its own: pages have other names point here, and ask what anybody of this computer may.
    fn is_named(&self, host: &str) -> bool {
        match self {
            Self::Local(port) => {
                let own = ["127.0.0.1", "localhost", "[::1]"].iter().find_map(|own| host.strip_prefix(own));
                own.is_some_and(|rest| rest == format!(":{port}") || (rest.is_empty() && *port == 80))
            }
            // a network may call it anything; a page by a name that is somebody else's has no device's cookie
            Self::Lan(_) => true,
        }
    }

    const fn scheme(&self) -> &'static str {
        match self {
            Self::Local(_) => "http://",
            Self::Lan(_) => "https://",
        }
    }

    fn caller(&self, headers: &HeaderMap) -> Caller {
        match self {
            Self::Local(_) => Caller::LOCAL,
            Self::Lan(devices) => devices.caller(cookie(headers)),
        }
    }
}

fn cookie(headers: &HeaderMap) -> Option<&str> {
    let all = headers.get_all(COOKIE).iter().filter_map(|value| value.to_str().ok());
    all.flat_map(|text| text.split(';'))
        .find_map(|pair| pair.trim().strip_prefix(COOKIE_NAME)?.strip_prefix('='))
}

/// Refuses who comes by another name than this computer's own, who sends from another page, and who may not do what he asks; the rest is read within bounds, and what it
/// is answered may load nothing of others.
pub(crate) async fn guard(State(door): State<Door>, mut request: Request, next: Next) -> Response {
    let admitted = admitted(&door, &mut request);
    let response = match admitted {
        Ok(()) => match bounded(request).await {
            Ok(request) => explained(next.run(request).await).await,
            Err(refusal) => refusal.into_response(),
        },
        Err(refusal) => refusal.into_response(),
    };
    protected(response)
}

/// Looks whether a request may be answered, and notes who asks.
fn admitted(door: &Door, request: &mut Request) -> Result<(), Refused> {
    let headers = request.headers();
    let text = |name| headers.get(name).map(|value: &HeaderValue| value.to_str().unwrap_or("?"));
    let host = text(HOST.as_str()).filter(|host| door.is_named(host));
    let Some(host) = host else {
        return Err(forbidden("this server is for this computer: open it as http://127.0.0.1 with its port"));
    };
    let (is_read, is_socket) =
        (matches!(*request.method(), Method::GET | Method::HEAD), headers.contains_key(UPGRADE));
    let site = text("sec-fetch-site");
    let is_foreign = site.is_some_and(|site| site != "same-origin" && site != "none");
    let is_own = text(ORIGIN.as_str()).is_none_or(|origin| match door {
        Door::Local(_) => origin.strip_prefix("http://").is_some_and(|host| door.is_named(host)),
        Door::Lan(_) => origin.strip_prefix(door.scheme()) == Some(host),
    });
    // Foxglove's page may read what happens, and says so; it can ask nothing
    let is_foxglove =
        is_read && request.uri().path() == FOXGLOVE && text(ORIGIN.as_str()) == Some(FOXGLOVE_PAGE);
    // a socket that is opened is read by GET, and browsers let any page open one
    let has_effect =
        !is_read || is_socket || EFFECTS.iter().any(|path| request.uri().path().starts_with(path));
    if has_effect && (is_foreign || !is_own) && !is_foxglove {
        return Err(forbidden("another page asked for this, and only the studio's own may"));
    }
    let caller = door.caller(headers);
    may(&caller, request.uri().path(), is_read)?;
    request.extensions_mut().insert(caller);
    Ok(())
}

/// Whether somebody may ask for that.
fn may(caller: &Caller, path: &str, is_read: bool) -> Result<(), Refused> {
    let is_page = !path.starts_with("/api/");
    let is_anybodys = path == STOP || path == JOIN || path == "/api/v1/session";
    // to plan changes nothing, and shows what is drawn; neither does an experiment
    let looks = is_read || ["/api/v1/plans", "/api/v1/lab"].contains(&path);
    match caller.role {
        _ if is_page || is_anybodys || caller.operates() => Ok(()),
        Some(_) if looks => Ok(()),
        Some(_) => {
            Err(forbidden("this device may look on and stop, nothing else: ask for an invitation to operate"))
        }
        None => Err(Refused::with(
            StatusCode::UNAUTHORIZED,
            Failure::usage(
                "not-invited",
                "this device has not joined: read the code of Devices on the studio's own computer",
            ),
        )),
    }
}

pub(crate) fn forbidden(why: &str) -> Refused {
    Refused::with(StatusCode::FORBIDDEN, Failure::usage("not-allowed", why))
}

/// Reads what is sent, in time and within its size. What is sent with *stop* is not waited for.
async fn bounded(request: Request) -> Result<Request, Refused> {
    if matches!(*request.method(), Method::GET | Method::HEAD) || request.uri().path() == STOP {
        return Ok(request);
    }
    let most = if request.uri().path() == "/api/v1/pictures" { MOST_BYTES } else { MOST_ASKED };
    let (head, body) = request.into_parts();
    let bytes = tokio::time::timeout(WHOLE, collected(body, most)).await.unwrap_or_else(|_| Err(slow()))?;
    Ok(Request::from_parts(head, Body::from(bytes)))
}

async fn collected(mut body: Body, most: usize) -> Result<Bytes, Refused> {
    let mut bytes = Vec::new();
    while let Some(frame) = tokio::time::timeout(PAUSE, body.frame()).await.map_err(|_| slow())? {
        let frame = frame.map_err(|_| Refused::usage("what was sent broke off: send it again"))?;
        let Ok(data) = frame.into_data() else { continue };
        if bytes.len() + data.len() > most {
            let message = format!("what was sent is larger than {most} bytes, the most that is taken here");
            return Err(Refused::with(StatusCode::PAYLOAD_TOO_LARGE, Failure::usage("too-large", message)));
        }
        bytes.extend_from_slice(&data);
    }
    Ok(Bytes::from(bytes))
}

fn slow() -> Refused {
    let message = format!("nothing of what is sent came for {} s: send it again", PAUSE.as_secs());
    Refused::with(StatusCode::REQUEST_TIMEOUT, Failure::usage("too-slow", message))
}

/// A refusal by what reads requests, in words alone, becomes one as all others are.
async fn explained(response: Response) -> Response {
    const MOST: usize = 1 << 12;
    let is_json = response.headers().get(CONTENT_TYPE).is_some_and(|kind| kind == "application/json");
    if !response.status().is_client_error() || is_json {
        return response;
    }
    let status = response.status();
    let words = axum::body::to_bytes(response.into_body(), MOST).await.unwrap_or_default();
    let words = String::from_utf8_lossy(&words);
    let message = if words.is_empty() { status.to_string() } else { words.into_owned() };
    Refused::with(status, Failure::usage("usage", message)).into_response()
}

/// What is answered may load nothing of others, unless it says so itself.
fn protected(mut response: Response) -> Response {
    let headers = response.headers_mut();
    let own = [
        ("content-security-policy", OWN),
        ("x-content-type-options", "nosniff"),
        ("referrer-policy", "no-referrer"),
        ("cross-origin-resource-policy", "same-origin"),
    ];
    for (name, value) in own {
        if !headers.contains_key(name) {
            headers.insert(name, HeaderValue::from_static(value));
        }
    }
    response
}
