//! Runs that were: listed, gone on with, compared, deleted and had back.

use super::*;

/// A program that has made two runs of a page, and one of a terminal.
fn told_runs(dir: &std::path::Path) -> String {
    let run =
        |name: &str, command: Value| json!({ "folder": dir.join("runs").join(name), "command": command });
    let house = dir.join("pictures/house.png");
    json!({ "runs": [
        run("house", json!(["trace", house, "--width=2m", "--real-time=1", "--out", "x", "--json"])),
        run("other", json!(["trace", "/elsewhere/x.png", "--width", "2m"])),
    ]})
    .to_string()
}

#[test]
fn a_run_tells_by_what_a_page_asks_for_it_again_and_is_gone_on_with() {
    run(async {
        let studio = studio("history");
        *studio.runs.lock().unwrap() = told_runs(&studio.dir);
        for name in ["house", "other"] {
            std::fs::create_dir(studio.dir.join("runs").join(name)).unwrap();
        }
        std::fs::write(studio.dir.join("runs/house/run.mcap"), vec![7; 200_000]).unwrap();
        std::fs::write(studio.dir.join("runs/house/progress"), "").unwrap();
        let (_, body) = studio.get("/api/v1/runs/house").await;
        let house: Value = serde_json::from_slice(&body).unwrap();
        assert!(house["id"] == "house" && house["picture"] == "house.png", "{house}");
        assert_eq!(
            (&house["flags"], &house["files"]),
            (&json!({ "width": "2m" }), &json!([{ "name": "run.mcap", "bytes": 200_000 }]))
        );
        assert_eq!(studio.get("/api/v1/runs/house/files/run.mcap").await, (StatusCode::OK, vec![7; 200_000]));
        let (_, body) = studio.get("/api/v1/runs/other").await;
        let other: Value = serde_json::from_slice(&body).unwrap();
        assert!(other["picture"].is_null() && other["flags"].is_null(), "{other}");
        assert_eq!(studio.get("/api/v1/runs/none").await.0, StatusCode::NOT_FOUND);
        while studio.asked.try_recv().is_ok() {}
        for (asked, why) in [
            (r#"{"rest_of":"none"}"#, "there is no run"),
            (r#"{"rest_of":"../house"}"#, "there is no run"),
            (r#"{"rest_of":"house","flags":{"width":"3m"}}"#, "is as it was when the run was begun"),
        ] {
            let (status, told) = studio.post("/api/v1/jobs", asked).await;
            let message = told["error"]["message"].as_str().unwrap_or_default();
            assert!(status == StatusCode::BAD_REQUEST && message.contains(why), "{asked}: {told}");
        }
        while studio.asked.try_recv().is_ok() {}
        let rest = r#"{"rest_of":"house","attended":true,"page":"a","flags":{"frame":"box"}}"#;
        let (status, begun) = studio.post("/api/v1/jobs", rest).await;
        assert_eq!((status, &begun["run"]), (StatusCode::ACCEPTED, &json!("house-2")), "{begun}");
        assert_eq!((&begun["picture"], &begun["flags"]), (&json!("house.png"), &json!({ "width": "2m" })));
        let command =
            std::iter::from_fn(|| studio.asked.recv().ok()).find(|command| command[0] == "resume").unwrap();
        assert!(command[1].ends_with("runs/house"), "{command:?}");
        assert_eq!(command[2..4], ["--frame=box", "--real-time=1"]);
        studio.go_on.send(()).unwrap();
        studio.until_over().await;
    });
}

#[test]
fn what_is_deleted_is_had_back_and_what_is_written_is_not_deleted() {
    run(async {
        let studio = studio("trash");
        let at = |name: &str| studio.dir.join(name);
        for name in ["runs/house", "runs/busy"] {
            std::fs::create_dir(at(name)).unwrap();
            std::fs::write(at(name).join("summary.json"), name).unwrap();
        }
        let held = tracelight_files::ResultFolder::hold(&at("runs/busy")).unwrap();
        assert_eq!(studio.delete("/api/v1/runs/busy").await.0, StatusCode::CONFLICT);
        drop(held);
        assert_eq!(
            studio.delete("/api/v1/runs/house").await,
            (StatusCode::OK, json!({ "in_trash": "house" }))
        );
        assert!(!at("runs/house").exists() && at("trash/runs/house/summary.json").exists());
        // another one of the name does not take its place
        std::fs::create_dir(at("runs/house")).unwrap();
        assert_eq!(studio.post("/api/v1/trash/runs/house", "").await.0, StatusCode::CONFLICT);
        assert_eq!(studio.delete("/api/v1/runs/house").await.1, json!({ "in_trash": "house~2" }));
        assert_eq!(
            studio.post("/api/v1/trash/runs/house", "").await,
            (StatusCode::OK, json!({ "id": "house" }))
        );
        assert_eq!(std::fs::read(at("runs/house/summary.json")).unwrap(), b"runs/house");
        let (_, added) = studio.post("/api/v1/pictures?name=mine.png", "x").await;
        assert_eq!(added["id"], "mine.png");
        assert_eq!(studio.delete("/api/v1/pictures/mine.png").await.1, json!({ "in_trash": "mine.png" }));
        assert_eq!(studio.get("/api/v1/pictures/mine.png").await.0, StatusCode::NOT_FOUND);
        assert_eq!(studio.post("/api/v1/trash/pictures/mine.png", "").await.0, StatusCode::OK);
        // a name is given once
        for name in ["house-2", "house-3"] {
            let (_, begun) = studio.post("/api/v1/jobs", r#"{"picture":"house.png"}"#).await;
            assert_eq!(begun["run"], name);
            studio.go_on.send(()).unwrap();
            studio.until_over().await;
            assert_eq!(studio.delete(&format!("/api/v1/runs/{name}")).await.0, StatusCode::OK);
        }
        for (path, status) in [
            ("/api/v1/runs/none", 404),
            ("/api/v1/runs/..", 404),
            ("/api/v1/runs/..%2Fpictures", 404),
            ("/api/v1/pictures/house.png", 400),
            ("/api/v1/pictures/..%2F..%2Fx.png", 404),
        ] {
            let (found, told) = studio.delete(path).await;
            assert_eq!(found.as_u16(), status, "{path}: {told}");
        }
        for path in ["runs/none", "runs/..%2F..%2Fpictures", "runs/~2", "runs/..", "keys/x", "runs/.hidden"] {
            let (status, _) = studio.post(&format!("/api/v1/trash/{path}"), "").await;
            assert!(status.is_client_error(), "{path}: {status}");
        }
    });
}
