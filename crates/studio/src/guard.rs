//! Who may ask: pages of this server on this computer, and nobody else's.

use axum::extract::{Request, State};
use axum::http::header::{HOST, ORIGIN, UPGRADE};
use axum::http::{HeaderMap, HeaderValue, Method, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

/// The port that is listened at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Port(pub(crate) u16);

/// What a page of the studio may load: its own files.
const OWN: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; font-src 'self'; \
                   base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
/// What a picture or a report may do that lies in the folder: show itself. It is nobody's page, and asks nobody.
pub(crate) const SHOWN: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src 'self' data:; sandbox allow-scripts allow-popups";

/// Refuses who comes by another name than this computer's own, as pages do that have their name point here, and who sends from another page; the rest is told what it may
/// load.
pub(crate) async fn guard(State(port): State<Port>, request: Request, next: Next) -> Response {
    let headers = request.headers();
    if !is_own(headers, HOST.as_str(), port, true) {
        return refused("this server is for this computer: open it as http://127.0.0.1 with its port");
    }
    // a socket that is opened is read by GET, and browsers let any page open one
    let is_socket = headers.contains_key(UPGRADE);
    let changes = is_socket || !matches!(*request.method(), Method::GET | Method::HEAD);
    let is_foreign =
        headers.get("sec-fetch-site").is_some_and(|site| site != "same-origin" && site != "none");
    if changes && (is_foreign || !is_own(headers, ORIGIN.as_str(), port, false)) {
        return refused("another page asked for this, and only the studio's own may");
    }
    let mut response = next.run(request).await;
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

/// Whether a header names this server; one that is missing does where it need not be there.
fn is_own(headers: &HeaderMap, name: &str, Port(port): Port, needed: bool) -> bool {
    let Some(value) = headers.get(name) else { return !needed };
    let Ok(text) = value.to_str() else { return false };
    let host = text.strip_prefix("http://").unwrap_or(text);
    ["127.0.0.1", "localhost", "[::1]"].iter().any(|own| {
        host.strip_prefix(own)
            .is_some_and(|rest| rest == format!(":{port}") || (rest.is_empty() && port == 80))
    })
}

fn refused(why: &'static str) -> Response {
    (StatusCode::FORBIDDEN, why).into_response()
}
