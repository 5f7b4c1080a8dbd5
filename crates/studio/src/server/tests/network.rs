//! Devices of the network: what each may ask, and who is nobody.

use super::*;
use crate::devices::Role;

/// Somebody of the network who asks, with the cookie of a device that has joined or none.
async fn asks(
    studio: &Studio,
    (method, path): (&str, &str),
    (cookie, more): (Option<&str>, &[(&str, &str)]),
    body: &str,
) -> (StatusCode, HeaderMap, Value) {
    let mut request = Request::builder().method(method).uri(path).header("host", "192.168.1.5:4461");
    if let Some(cookie) = cookie {
        request = request.header("cookie", format!("other=1; {cookie}"));
    }
    for (name, value) in more {
        request = request.header(*name, *value);
    }
    let request = request.body(Body::from(body.to_owned())).unwrap();
    let response = studio.network.clone().oneshot(request).await.unwrap();
    let (status, headers) = (response.status(), response.headers().clone());
    let body = response.into_body().collect().await.unwrap().to_bytes();
    (status, headers, serde_json::from_slice(&body).unwrap_or(Value::Null))
}

/// Joins as a browser does; its cookie.
async fn joins(studio: &Studio, role: Role) -> String {
    let secret = studio.devices.invite(role).unwrap().hex();
    let asked = json!({ "invitation": secret, "name": "a phone" }).to_string();
    let (status, headers, told) = asks(studio, ("POST", "/api/v1/session/join"), (None, &[]), &asked).await;
    assert_eq!(status, StatusCode::OK, "{told}");
    let cookie = headers["set-cookie"].to_str().unwrap();
    for part in ["__Host-tracelight=", "Secure", "HttpOnly", "SameSite=Strict", "Path=/"] {
        assert!(cookie.contains(part), "{cookie}");
    }
    // an invitation is for one device
    let (status, _, told) = asks(studio, ("POST", "/api/v1/session/join"), (None, &[]), &asked).await;
    assert_eq!((status, &told["error"]["code"]), (StatusCode::UNAUTHORIZED, &json!("not-invited")));
    cookie.split(';').next().unwrap().to_owned()
}

#[test]
fn a_device_may_what_its_invitation_says_and_anybody_may_stop() {
    run(async {
        let studio = studio("roles");
        let (operator, viewer) = (joins(&studio, Role::Operator).await, joins(&studio, Role::Viewer).await);
        let job = r#"{"picture":"star.png","page":"a","attended":true}"#;
        let wish = r#"{"page":"a","wish":"arm"}"#;
        let wished = "/api/v1/jobs/current/wishes";
        let (nobody, viewer) = (None, Some(viewer.as_str()));
        let operator = Some(operator.as_str());
        for (who, method, path, body, status) in [
            (nobody, "GET", "/", "", 200),
            (nobody, "GET", "/page/main.js", "", 200),
            (nobody, "GET", "/api/v1/session", "", 200),
            (nobody, "GET", "/api/v1/about", "", 401),
            (nobody, "GET", "/api/v1/pictures/house.png", "", 401),
            (nobody, "GET", "/api/v1/runs", "", 401),
            (nobody, "POST", "/api/v1/plans", job, 401),
            (nobody, "POST", "/api/v1/jobs", job, 401),
            (nobody, "POST", "/api/v1/session/invitations", r#"{"role":"operator"}"#, 401),
            (nobody, "POST", "/api/v1/stop", "", 200),
            (Some("__Host-tracelight=00000000000000000000000000000000"), "GET", "/api/v1/runs", "", 401),
            (Some("__Host-tracelight="), "GET", "/api/v1/runs", "", 401),
            (viewer, "GET", "/api/v1/about", "", 200),
            (viewer, "GET", "/api/v1/jobs/current", "", 200),
            (viewer, "POST", "/api/v1/plans", r#"{"picture":"house.png"}"#, 200),
            (viewer, "POST", "/api/v1/jobs", job, 403),
            (viewer, "POST", wished, wish, 403),
            (viewer, "POST", "/api/v1/pictures?name=x.png", "x", 403),
            (viewer, "DELETE", "/api/v1/runs/house", "", 403),
            (viewer, "DELETE", "/api/v1/session/devices/1", "", 403),
            (viewer, "POST", "/api/v1/session/invitations", r#"{"role":"operator"}"#, 403),
            (viewer, "POST", "/api/v1/stop", "", 200),
            (operator, "POST", "/api/v1/jobs", job, 202),
            (operator, "POST", wished, wish, 200),
        ] {
            let (found, _, told) = asks(&studio, (method, path), (who, &[]), body).await;
            assert_eq!(found.as_u16(), status, "{method} {path}: {told}");
        }
        let (_, _, told) = asks(&studio, ("GET", "/api/v1/session"), (viewer, &[]), "").await;
        assert!(told["role"] == "viewer" && told["local"] == false && told["devices"].is_null(), "{told}");
        let (_, _, told) = asks(&studio, ("GET", "/api/v1/session"), (operator, &[]), "").await;
        let devices = told["devices"].as_array().unwrap();
        assert!(devices.len() == 2 && told["lan"]["fingerprint"] == "AB:CD", "{told}");
        // sent away, it is nobody
        let id = devices[1]["id"].as_u64().unwrap();
        let away = format!("/api/v1/session/devices/{id}");
        assert_eq!(asks(&studio, ("DELETE", &away), (operator, &[]), "").await.0, StatusCode::OK);
        assert_eq!(asks(&studio, ("DELETE", &away), (operator, &[]), "").await.0, StatusCode::NOT_FOUND);
        let (status, ..) = asks(&studio, ("GET", "/api/v1/runs"), (viewer, &[]), "").await;
        assert_eq!(status, StatusCode::UNAUTHORIZED);
        studio.post("/api/v1/stop", "").await;
        studio.go_on.send(()).unwrap();
    });
}

#[test]
fn pages_of_others_reach_nothing_by_a_device_that_has_joined() {
    run(async {
        let studio = studio("foreign");
        let cookie = joins(&studio, Role::Operator).await;
        let job = r#"{"picture":"star.png"}"#;
        for (name, value, status) in [
            ("origin", "https://192.168.1.5:4461", 202),
            ("origin", "http://192.168.1.5:4461", 403),
            ("origin", "https://192.168.1.6:4461", 403),
            ("origin", "https://192.168.1.5", 403),
            ("origin", "https://evil.example", 403),
            ("origin", "null", 403),
            ("sec-fetch-site", "cross-site", 403),
            ("sec-fetch-site", "same-site", 403),
        ] {
            let asked = ("POST", "/api/v1/jobs");
            let (found, ..) = asks(&studio, asked, (Some(&cookie), &[(name, value)]), job).await;
            assert_eq!(found.as_u16(), status, "{name}: {value}");
        }
        studio.go_on.send(()).unwrap();
        // a name that a page had point here has no cookie of this server's, and what it sends comes from there
        for (host, origin, status) in [
            ("pc.fritz.box:4461", "https://pc.fritz.box:4461", 401),
            ("evil.example:4461", "https://evil.example:4461", 401),
            ("evil.example:4461", "https://evil.example", 403),
        ] {
            let request = Request::post("/api/v1/jobs").header("host", host).header("origin", origin);
            let found = studio.network.clone().oneshot(request.body(Body::empty()).unwrap()).await.unwrap();
            assert_eq!(found.status().as_u16(), status, "{host} {origin}");
        }
    });
}

#[test]
fn invitations_are_given_by_pages_of_this_computer_and_by_whom_they_let_operate() {
    run(async {
        let studio = studio("invites");
        let (status, told) = studio.post("/api/v1/session/invitations", r#"{"role":"viewer"}"#).await;
        let link = told["links"][0].as_str().unwrap();
        assert!(
            status == StatusCode::OK && link.starts_with("https://") && link.contains(":4461/#join="),
            "{told}"
        );
        assert!(told["code_svg"].as_str().unwrap().contains("<svg") && told["holds_s"] == 600, "{told}");
        let secret = link.split("join=").nth(1).unwrap();
        assert_eq!(studio.devices.join(secret, "").unwrap().1, Role::Viewer);
        for wrong in ["", "{}", r#"{"role":"king"}"#, r#"{"role":"viewer","more":1}"#] {
            let (status, told) = studio.post("/api/v1/session/invitations", wrong).await;
            assert_eq!(status, StatusCode::BAD_REQUEST, "{told}");
        }
        assert_eq!(studio.post("/api/v1/session/join", "[]").await.0, StatusCode::BAD_REQUEST);
    });
}

#[test]
fn who_looks_on_takes_nobody_elses_turn() {
    run(async {
        let studio = studio("turns");
        let viewer = joins(&studio, Role::Viewer).await;
        let plan = |number: u64| format!(r#"{{"picture":"house.png","page":"a","number":{number}}}"#);
        // by the name of the operator's page, with a number that nothing comes after
        let (status, ..) =
            asks(&studio, ("POST", "/api/v1/plans"), (Some(&viewer), &[]), &plan(1 << 60)).await;
        assert_eq!(status, StatusCode::OK);
        assert_eq!(studio.post("/api/v1/plans", plan(1)).await.0, StatusCode::OK);
    });
}
