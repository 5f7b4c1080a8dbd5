use std::sync::Mutex;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};

use axum::body::Body;
use axum::http::Request;
use http_body_util::BodyExt as _;
use tower::ServiceExt as _;
use tracelight_task::{Failure, Progress, Stop};

use super::*;
use crate::desk::Desk;
use crate::devices::Devices;
use crate::folder::Folder;
use crate::lan::Lan;
use crate::program::{Performed, Program, Seat};

mod history;
mod network;
mod openapi;
mod watching;

/// A program that notes what it is to do, plans two ticks, and traces until it is stopped or let go on.
struct Noting {
    asked: Sender<Vec<String>>,
    traced: Mutex<Receiver<()>>,
    runs: Arc<Mutex<String>>,
    head: Option<crate::program::Head>,
}

impl Program for Noting {
    fn head(&self) -> Option<&crate::program::Head> {
        self.head.as_ref()
    }

    fn rigs(&self) -> Vec<String> {
        vec!["report".to_owned()]
    }

    fn look(
        &self,
        _: &[String],
        stop: &Stop,
        each: &mut dyn FnMut(Vec<u8>, Value) -> bool,
    ) -> Result<(), Failure> {
        while each(b"image".to_vec(), json!({ "markers": [] })) {
            stop.check()?;
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        Ok(())
    }

    fn knows(&self, wish: &str) -> bool {
        ["arm", "go-on", "pause", "pause-now", "stop", "disarm"].contains(&wish)
    }

    fn perform(
        &self,
        arguments: &[String],
        seat: Option<&dyn Seat>,
        (progress, stop): (&dyn Progress, &Stop),
    ) -> Result<Performed, Failure> {
        self.asked.send(arguments.to_vec()).unwrap();
        match arguments[0].as_str() {
            "plan" if arguments.iter().any(|argument| argument == "--width=3x") => {
                Err(Failure::usage("usage", "3x is no length"))
            }
            "plan" => {
                let table = arguments.iter().position(|argument| argument == "-o").unwrap() + 1;
                std::fs::write(&arguments[table], "t_s,lit,x_m,y_m\n0.000,0,0,0\n0.001,1,1,2\n").unwrap();
                progress.say("note: two ticks");
                Ok(done(r#"{"sequence":[{"lit_from_s":0.001,"lit_to_s":0.001}]}"#))
            }
            "trace" | "resume" => loop {
                let out = arguments.iter().position(|argument| argument == "--out").unwrap() + 1;
                std::fs::write(std::path::Path::new(&arguments[out]).join("job.toml"), "").unwrap();
                progress.stage("run", 10);
                stop.check()?;
                if let Some(seat) = seat {
                    seat.tell(&json!({ "event": "progress" }));
                    while let Some(wish) = seat.wish() {
                        seat.tell(&json!({ "event": "heard", "wish": wish }));
                    }
                }
                // a test that fails lets nothing go on for ever
                if !matches!(self.traced.lock().unwrap().try_recv(), Err(TryRecvError::Empty)) {
                    return Ok(done(r#"{"tracking":{}}"#));
                }
                std::thread::sleep(std::time::Duration::from_millis(2));
            },
            "calibrate" if arguments[1] == "show" => {
                Ok(done(r#"{"calibrations":[{"file":"x","of":"head","date":"2026-12-01"}]}"#))
            }
            "calibrate" => {
                let file = arguments.iter().find_map(|argument| argument.strip_prefix("--output=")).unwrap();
                std::fs::write(file, format!("# {}", arguments[1])).unwrap();
                Ok(Performed { text: format!("file: {file}"), ..done("{}") })
            }
            "explain" => panic!("a program that must not"),
            _ => Ok(done(&self.runs.lock().unwrap())),
        }
    }
}

fn done(json: &str) -> Performed {
    Performed { json: json.to_owned(), text: String::new(), failure: None }
}

struct Studio {
    router: Router,
    /// For devices of the network.
    network: Router,
    devices: Arc<Devices>,
    /// What the program tells of runs.
    runs: Arc<Mutex<String>>,
    asked: Receiver<Vec<String>>,
    go_on: Sender<()>,
    dir: std::path::PathBuf,
}

impl Drop for Studio {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.dir);
    }
}

fn studio(name: &str) -> Studio {
    studio_of(name, None)
}

/// One that was opened for a head.
fn studio_of(name: &str, head: Option<crate::program::Head>) -> Studio {
    let dir = std::env::temp_dir().join(format!("tracelight-studio-{name}-{}", std::process::id()));
    let (asked_by, asked) = channel();
    let (go_on, traced) = channel();
    let runs = Arc::new(Mutex::new(r#"{"runs":[]}"#.to_owned()));
    let program = Noting { asked: asked_by, traced: Mutex::new(traced), runs: Arc::clone(&runs), head };
    let desk = Arc::new(Desk::new(Box::new(program), Folder::open(&dir).unwrap()));
    let devices = Arc::new(Devices::default());
    let lan = Some(Arc::new(Lan { port: 4461, fingerprint: "AB:CD".to_owned() }));
    let house = House { desk, devices: Arc::clone(&devices), lan };
    let network = router(house.clone(), Door::Lan(Arc::clone(&devices)));
    Studio { router: router(house, Door::Local(4460)), network, devices, runs, asked, go_on, dir }
}

impl Studio {
    async fn send(&self, request: Request<Body>) -> (StatusCode, HeaderMap, Vec<u8>) {
        let response = self.router.clone().oneshot(request).await.unwrap();
        let (status, headers) = (response.status(), response.headers().clone());
        (status, headers, response.into_body().collect().await.unwrap().to_bytes().to_vec())
    }

    async fn get(&self, path: &str) -> (StatusCode, Vec<u8>) {
        let request = Request::get(path).header("host", "127.0.0.1:4460").body(Body::empty()).unwrap();
        let (status, _, body) = self.send(request).await;
        (status, body)
    }

    async fn post(&self, path: &str, body: impl Into<Body>) -> (StatusCode, Value) {
        let request =
            Request::post(path).header("host", "localhost:4460").header("origin", "http://localhost:4460");
        let (status, _, body) = self.send(request.body(body.into()).unwrap()).await;
        (status, serde_json::from_slice(&body).unwrap_or(Value::Null))
    }

    async fn put(&self, path: &str, body: impl Into<Body>) -> (StatusCode, Value) {
        let request = Request::put(path).header("host", "localhost:4460").body(body.into()).unwrap();
        let (status, _, body) = self.send(request).await;
        (status, serde_json::from_slice(&body).unwrap_or(Value::Null))
    }

    async fn delete(&self, path: &str) -> (StatusCode, Value) {
        let request = Request::delete(path).header("host", "localhost:4460").body(Body::empty()).unwrap();
        let (status, _, body) = self.send(request).await;
        (status, serde_json::from_slice(&body).unwrap_or(Value::Null))
    }

    async fn job(&self) -> Value {
        let (_, body) = self.get("/api/v1/jobs/current").await;
        serde_json::from_slice::<Value>(&body).unwrap()["job"].clone()
    }

    async fn until_over(&self) -> Value {
        for _ in 0..2000 {
            let job = self.job().await;
            if job["over"] == true {
                return job;
            }
            tokio::time::sleep(std::time::Duration::from_millis(2)).await;
        }
        panic!("the job does not end");
    }
}

/// Runs what a test does, as the server runs.
fn run(test: impl Future<Output = ()>) {
    tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .enable_all()
        .build()
        .unwrap()
        .block_on(test);
}

#[test]
fn a_plan_is_a_command_line_and_comes_with_its_points() {
    run(async {
        let studio = studio("plan");
        let asked = r#"{"picture":"house.png","page":"a","flags":{"width":"3m","flip":true}}"#;
        let (status, plan) = studio.post("/api/v1/plans", asked).await;
        assert_eq!(status, StatusCode::OK, "{plan}");
        let command = studio.asked.recv().unwrap();
        assert!(command[0] == "plan" && command[1].ends_with("pictures/house.png"), "{command:?}");
        assert_eq!(command[2..4], ["--flip", "--width=3m"]);
        assert!(plan["command"].as_str().unwrap().starts_with("tracelight trace "), "{plan}");
        assert_eq!(plan["remarks"], json!(["two ticks"]));
        let (status, points) = studio.get(plan["points"].as_str().unwrap()).await;
        assert_eq!((status, points.len()), (StatusCode::OK, 16 + 4 * 5 * 2));
        // nothing of it stays in the folder
        let left = std::fs::read_dir(&studio.dir).unwrap().flatten().filter(|entry| entry.path().is_file());
        assert_eq!(left.count(), 0);
    });
}

#[test]
fn what_is_wrong_with_a_wish_is_told_as_the_command_line_tells_it() {
    run(async {
        let studio = studio("wrong");
        for (path, asked, status, why) in [
            ("plans", r#"{"picture":"house.png","flags":{"width":"3x"}}"#, 400, "3x is no length"),
            ("plans", r#"{"picture":"house.png","flags":{"out":"/etc/x"}}"#, 400, "out is no flag"),
            ("plans", r#"{"picture":"../../x.png","flags":{}}"#, 400, "there is no picture"),
            ("jobs", r#"{"picture":"none.png","flags":{}}"#, 400, "there is no picture"),
            ("plans", r#"{"picture":"#, 400, "a plan or a job is asked for by"),
            ("plans", r#"{"picture":"house.png","flags":{},"more":1}"#, 400, "unknown field"),
            ("plans", "\u{0}", 400, "a plan or a job"),
        ] {
            let (found, told) = studio.post(&format!("/api/v1/{path}"), asked).await;
            let message = told["error"]["message"].as_str().unwrap_or_default();
            assert!(found.as_u16() == status && message.contains(why), "{asked}: {found} {told}");
        }
        let large = vec![b' '; (1 << 16) + 1];
        let (found, _) = studio.post("/api/v1/plans", large).await;
        assert_eq!(found, StatusCode::PAYLOAD_TOO_LARGE);
    });
}

#[test]
fn one_job_at_a_time_is_traced_and_stopped_by_anybody() {
    run(async {
        let studio = studio("job");
        let asked = r#"{"picture":"star.png","flags":{"width":"1m"}}"#;
        assert_eq!(studio.job().await, Value::Null);
        // nothing to stop is no error, whatever is sent
        assert_eq!(studio.post("/api/v1/stop", "{").await, (StatusCode::OK, json!({ "stopped": false })));
        let (status, begun) = studio.post("/api/v1/jobs", asked).await;
        assert_eq!((status, &begun["run"]), (StatusCode::ACCEPTED, &json!("star")), "{begun}");
        let command = studio.asked.recv().unwrap();
        assert!(command[0] == "trace" && command.contains(&"--width=1m".to_owned()), "{command:?}");
        let (status, told) = studio.post("/api/v1/jobs", asked).await;
        assert_eq!((status, &told["error"]["code"]), (StatusCode::CONFLICT, &json!("busy")));
        assert_eq!(studio.post("/api/v1/stop", "").await.1, json!({ "stopped": true }));
        let ended = studio.until_over().await;
        assert_eq!(ended["failure"]["code"], "interrupted", "{ended}");
        let (_, next) = studio.post("/api/v1/jobs", asked).await;
        assert_eq!(next["run"], "star-2", "an earlier run is never written over");
        studio.go_on.send(()).unwrap();
        let ended = studio.until_over().await;
        assert!(ended["failure"].is_null() && ended["answer"]["tracking"].is_object(), "{ended}");
    });
}

#[test]
fn an_older_wish_of_a_page_counts_for_nothing_and_a_program_that_fails_is_told() {
    run(async {
        let studio = studio("wishes");
        let wish = |number: u32| format!(r#"{{"picture":"star.png","page":"a","number":{number}}}"#);
        assert_eq!(studio.post("/api/v1/plans", wish(7)).await.0, StatusCode::OK);
        let (status, told) = studio.post("/api/v1/plans", wish(6)).await;
        assert_eq!((status, &told["error"]["code"]), (StatusCode::CONFLICT, &json!("interrupted")));
        assert_eq!(studio.post("/api/v1/plans", wish(8)).await.0, StatusCode::OK);
        let (status, told) = studio.get("/api/v1/explain/board").await;
        assert_eq!(status, StatusCode::UNPROCESSABLE_ENTITY, "{}", String::from_utf8_lossy(&told));
    });
}

#[test]
fn only_pages_of_this_server_may_ask() {
    run(async {
        let studio = studio("guard");
        let get = |host: &'static str| {
            Request::get("/api/v1/about").header("host", host).body(Body::empty()).unwrap()
        };
        for (host, status) in [
            ("127.0.0.1:4460", 200),
            ("localhost:4460", 200),
            ("[::1]:4460", 200),
            ("evil.example", 403),
            ("127.0.0.1:80", 403),
            ("127.0.0.1.evil.example:4460", 403),
            ("localhost:4460.evil.example", 403),
        ] {
            assert_eq!(studio.send(get(host)).await.0.as_u16(), status, "{host}");
        }
        let none = Request::get("/api/v1/about").body(Body::empty()).unwrap();
        assert_eq!(studio.send(none).await.0, StatusCode::FORBIDDEN);
        for (name, value) in
            [("origin", "http://evil.example"), ("origin", "null"), ("sec-fetch-site", "cross-site")]
        {
            let stop = Request::post("/api/v1/stop").header("host", "127.0.0.1:4460").header(name, value);
            assert_eq!(
                studio.send(stop.body(Body::empty()).unwrap()).await.0,
                StatusCode::FORBIDDEN,
                "{name}: {value}"
            );
        }
    });
}

#[test]
fn pictures_come_in_by_name_and_nothing_else_comes_out() {
    run(async {
        let studio = studio("pictures");
        let add = |name: &str| format!("/api/v1/pictures?name={name}");
        let (_, first) = studio.post(&add("My%20house.PNG"), "one").await;
        let (_, same) = studio.post(&add("My%20house.PNG"), "one").await;
        let (_, other) = studio.post(&add("..%2F..%2FMy%20house.png"), "two").await;
        assert_eq!(
            (&first["id"], &same["id"], &other["id"]),
            (&json!("My-house.png"), &json!("My-house.png"), &json!("My-house-2.png"))
        );
        let (status, told) = studio.post(&add("evil.sh"), "x").await;
        assert!(status == StatusCode::BAD_REQUEST && told["error"]["code"] == "not-a-picture", "{told}");
        assert_eq!(studio.post(&add("empty.png"), "").await.0, StatusCode::BAD_REQUEST);
        assert_eq!(studio.get("/api/v1/pictures/My-house-2.png").await, (StatusCode::OK, b"two".to_vec()));
        let (_, listed) = studio.get("/api/v1/pictures").await;
        let listed: Value = serde_json::from_slice(&listed).unwrap();
        assert_eq!(listed["pictures"].as_array().unwrap().len(), 2 + EXAMPLES.len());
        assert_eq!(
            listed["pictures"][2]["id"], "house.png",
            "the examples come last, in their order: {listed}"
        );
        for path in [
            "/api/v1/pictures/..%2F..%2Fetc%2Fpasswd",
            "/api/v1/pictures/house.txt",
            "/api/v1/runs/..%2Fpictures/files/house.png",
            "/api/v1/runs/house/files/..%2F..%2Fx.png",
            "/api/v1/runs/.hidden/files/x.png",
            "/api/v1/runs/house/files/run.mcap",
            "/page/..%2Flib.rs",
            "/nothing",
        ] {
            assert_eq!(studio.get(path).await.0, StatusCode::NOT_FOUND, "{path}");
        }
    });
}

#[test]
fn the_page_comes_zipped_once_and_may_load_nothing_of_others() {
    run(async {
        let studio = studio("page");
        let ask = |name: &str, extra: (&'static str, String)| {
            Request::get(name)
                .header("host", "127.0.0.1:4460")
                .header(extra.0, extra.1)
                .body(Body::empty())
                .unwrap()
        };
        let (status, headers, zipped) =
            studio.send(ask("/", ("accept-encoding", "gzip, br".to_owned()))).await;
        assert_eq!((status, headers["content-encoding"].to_str().unwrap()), (StatusCode::OK, "gzip"));
        assert!(zipped.starts_with(&[0x1f, 0x8b]));
        let policy = headers["content-security-policy"].to_str().unwrap();
        assert!(policy.contains("default-src 'none'") && !policy.contains("unsafe"), "{policy}");
        assert_eq!(headers["x-content-type-options"], "nosniff");
        let tag = headers["etag"].to_str().unwrap().to_owned();
        let (status, _, body) = studio.send(ask("/", ("if-none-match", tag))).await;
        assert_eq!((status, body.len()), (StatusCode::NOT_MODIFIED, 0));
        let (_, headers, body) = studio.send(ask("/page/main.js", ("accept", "*/*".to_owned()))).await;
        assert!(
            headers["content-type"].to_str().unwrap().starts_with("text/javascript")
                && body.starts_with(b"// @ts-check")
        );
        // what somebody gave may be shown, and do nothing else
        let (_, headers, _) =
            studio.send(ask("/api/v1/pictures/sign.svg", ("accept", "*/*".to_owned()))).await;
        assert!(headers["content-security-policy"].to_str().unwrap().contains("sandbox"));
    });
}

#[test]
fn the_page_that_began_a_job_asks_it_and_the_others_only_stop_it() {
    run(async {
        let studio = studio("attended");
        let begin =
            r#"{"picture":"star.png","page":"a","attended":true,"flags":{"frame":"box","dry_run":true}}"#;
        let (status, _) = studio.post("/api/v1/jobs", r#"{"picture":"star.png","attended":true}"#).await;
        assert_eq!(status, StatusCode::BAD_REQUEST, "nobody operates it");
        let (status, _) =
            studio.post("/api/v1/jobs", r#"{"picture":"star.png","flags":{"step":true}}"#).await;
        assert_eq!(status, StatusCode::BAD_REQUEST, "nobody could ask for the next");
        let (status, begun) = studio.post("/api/v1/jobs", begin).await;
        assert!(status == StatusCode::ACCEPTED && begun["live"] == true, "{begun}");
        let command = studio.asked.recv().unwrap();
        for flag in ["--frame=box", "--dry-run", "--real-time=1"] {
            assert!(command.iter().any(|argument| argument == flag), "{flag}: {command:?}");
        }
        let wish = |page: &str, wish: &str| format!(r#"{{"page":"{page}","wish":"{wish}"}}"#);
        for (page, word, status, why) in [
            ("a", "arm", 200, ""),
            ("b", "arm", 400, "another page operates it"),
            ("a", "light", 400, "nothing that a job can be asked"),
            ("b", "stop", 200, ""),
            ("b", "take", 200, ""),
            ("a", "refuse", 200, ""),
        ] {
            let (found, told) = studio.post("/api/v1/jobs/current/wishes", wish(page, word)).await;
            let message = told["error"]["message"].as_str().unwrap_or_default();
            assert!(found.as_u16() == status && message.contains(why), "{page} {word}: {found} {told}");
        }
        assert_eq!(studio.post("/api/v1/jobs/current/wishes", "{").await.0, StatusCode::BAD_REQUEST);
        // once it goes on, to stop it does not end it
        tokio::time::sleep(std::time::Duration::from_millis(20)).await;
        assert_eq!(studio.post("/api/v1/stop", "").await.1, json!({ "stopped": true }));
        tokio::time::sleep(std::time::Duration::from_millis(20)).await;
        assert_eq!(studio.job().await["over"], false);
        studio.go_on.send(()).unwrap();
        studio.until_over().await;
        let (found, told) = studio.post("/api/v1/jobs/current/wishes", wish("a", "arm")).await;
        assert!(found == StatusCode::BAD_REQUEST, "{told}");
    });
}

#[test]
fn a_socket_is_opened_by_pages_of_this_server_alone() {
    run(async {
        let studio = studio("socket");
        for (origin, status) in [("http://evil.example", 403), ("http://127.0.0.1:9999", 403), ("null", 403)]
        {
            let upgrade = Request::get("/api/v1/live?page=a")
                .header("host", "127.0.0.1:4460")
                .header("connection", "upgrade")
                .header("upgrade", "websocket")
                .header("sec-websocket-version", "13")
                .header("sec-websocket-key", "dGhlIHNhbXBsZSBub25jZQ==")
                .header("origin", origin);
            assert_eq!(
                studio.send(upgrade.body(Body::empty()).unwrap()).await.0.as_u16(),
                status,
                "{origin}"
            );
        }
    });
}
