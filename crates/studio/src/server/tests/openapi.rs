//! The description of what may be asked, held against what is answered.

use super::*;
use crate::flags::Which;

fn described() -> Value {
    serde_json::from_str(include_str!("../../openapi.json")).unwrap()
}

#[test]
fn what_is_described_is_there_and_what_is_there_is_described() {
    let described = described();
    let paths = described["paths"].as_object().unwrap();
    let source = include_str!("../../server.rs");
    let routes: Vec<(&str, &str)> = source
        .split(".route(\"/")
        .skip(1)
        .filter_map(|rest| rest.split_once("\","))
        .filter(|(path, _)| !path.is_empty() && !path.starts_with("page/"))
        .map(|(path, how)| (path, how.split(".route(").next().unwrap().split(".nest(").next().unwrap()))
        .collect();
    assert!(routes.len() > 20, "{routes:?}");
    for (path, how) in &routes {
        let methods = paths.get(&format!("/{path}")).unwrap_or_else(|| panic!("/{path} is not described"));
        for method in ["get", "post", "put", "delete"] {
            let is = how.contains(&format!("{method}("));
            assert_eq!(methods.get(method).is_some(), is, "{method} /{path}");
        }
    }
    assert_eq!(paths.len(), routes.len(), "something is described that is not there");
    run(async {
        let studio = studio("openapi");
        let (status, body) = studio.get("/api/v1/openapi.json").await;
        assert_eq!((status, serde_json::from_slice::<Value>(&body).unwrap()), (StatusCode::OK, described));
        // what is refused before anybody reads it is refused in the same form
        let (status, told) = studio.post("/api/v1/about", "").await;
        assert_eq!((status, &told["error"]["code"]), (StatusCode::METHOD_NOT_ALLOWED, &json!("usage")));
        let (status, body) = studio.get("/api/v1/plans/x/points").await;
        assert!(status == StatusCode::BAD_REQUEST && body.starts_with(b"{\"error\""), "{status}");
    });
}

#[test]
fn the_flags_that_are_described_are_those_that_are_taken() {
    let described = described();
    let flags = described["components"]["schemas"]["Flags"]["properties"].as_object().unwrap();
    for (name, of) in flags {
        assert!(Which::Attended.has(name), "{name}");
        let is_attended = of["description"] == "of a job that is attended";
        assert_eq!(Which::Drawing.has(name), !is_attended, "{name}");
    }
    assert_eq!(flags.len(), Which::count());
}
