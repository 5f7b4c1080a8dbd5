//! The studio as a process: a page is asked for as a browser does, a picture planned and traced as the command line does it.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::support::{folder, program};

/// A studio that is served until this is dropped.
struct Served {
    process: Child,
    /// Host and port.
    at: String,
    dir: std::path::PathBuf,
}

impl Served {
    fn new(name: &str, more: &[&str]) -> Self {
        let dir = folder(name);
        let mut command: Command = program();
        command.args(["studio", "--port", "0", "--no-open", "--folder"]).arg(dir.join("studio")).args(more);
        let mut process = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        let mut said = String::new();
        BufReader::new(process.stderr.take().unwrap()).read_line(&mut said).unwrap();
        let address = said.split("http://").nth(1).unwrap_or_else(|| panic!("no address in {said:?}"));
        let at = address.split('/').next().unwrap().to_owned();
        Self { process, at, dir }
    }

    /// Status and body of what is answered.
    fn ask(&self, method: &str, path: &str, body: &[u8]) -> (u16, Vec<u8>) {
        let mut stream = TcpStream::connect(&self.at).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        let head = format!(
            "{method} {path} HTTP/1.1\r\nhost: {}\r\ncontent-length: {}\r\nconnection: close\r\n\r\n",
            self.at,
            body.len()
        );
        stream.write_all(head.as_bytes()).unwrap();
        stream.write_all(body).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        let end = answer.windows(4).position(|four| four == b"\r\n\r\n").unwrap();
        let status = String::from_utf8_lossy(&answer[9..12]).parse().unwrap();
        (status, answer[end + 4..].to_vec())
    }

    fn json(&self, method: &str, path: &str, body: &Value) -> Value {
        let (status, answer) = self.ask(method, &format!("/api/v1{path}"), body.to_string().as_bytes());
        let text = String::from_utf8_lossy(&answer);
        assert!(status < 300, "{path}: {status} {text}");
        serde_json::from_slice(&answer).unwrap_or_else(|e| panic!("{path}: {e} in {text}"))
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

#[test]
fn a_picture_is_planned_and_traced_as_the_command_line_does_it() {
    let served = Served::new("studio-traces", &[]);
    let (status, page) = served.ask("GET", "/", b"");
    assert!(status == 200 && String::from_utf8_lossy(&page).contains("Tracelight"), "{status}");
    let asked =
        json!({ "picture": "star.png", "page": "test", "flags": { "width": "20cm", "rotate": "10deg" } });
    let planned = served.json("POST", "/plans", &asked);
    let picture = served.dir.join("studio/pictures/star.png");
    let alone = program()
        .args(["plan"])
        .arg(&picture)
        .args(["--width=20cm", "--rotate=10deg", "--json"])
        .output()
        .unwrap();
    let alone: Value = serde_json::from_slice(&alone.stdout).unwrap();
    for part in ["strokes", "plan", "target", "sequence"] {
        assert_eq!(planned["plan"][part], alone[part], "{part}");
    }
    let (status, points) = served.ask("GET", planned["points"].as_str().unwrap(), b"");
    let rows = u32::from_le_bytes(points[8..12].try_into().unwrap());
    let ticks = alone["plan"]["duration_s"].as_f64().unwrap() * 1e3;
    assert!(status == 200 && (f64::from(rows) - ticks).abs() < 3.0, "{rows} rows, {ticks} ticks");
    let begun = served.json("POST", "/jobs", &json!({ "picture": "star.png", "flags": { "width": "20cm" } }));
    assert_eq!(begun["run"], "star");
    let until = Instant::now() + Duration::from_secs(60);
    let job = loop {
        let job = served.json("GET", "/jobs/current", &Value::Null)["job"].clone();
        if job["over"] == true {
            break job;
        }
        assert!(Instant::now() < until, "{job}");
        std::thread::sleep(Duration::from_millis(20));
    };
    assert!(job["failure"].is_null() && job["answer"]["simulated"] == true, "{job}");
    assert!(job["answer"]["tracking"]["max_mm"].as_f64().unwrap() < 0.3, "{job}");
    let runs = served.json("GET", "/runs", &Value::Null);
    assert_eq!(runs["runs"][0]["finished"], true, "{runs}");
    let (status, report) = served.ask("GET", "/api/v1/runs/star/files/report.html", b"");
    assert!(status == 200 && report.len() > 10_000);
    let explained = served.json("GET", "/explain/host-silent", &Value::Null);
    assert!(explained.to_string().contains("host"), "{explained}");
}

#[test]
fn a_wrong_value_is_told_by_the_parser_and_a_picture_that_is_none_by_its_reader() {
    let served = Served::new("studio-wrong", &[]);
    let refused = |picture: &str, flags: Value| -> Value {
        let asked = json!({ "picture": picture, "flags": flags }).to_string();
        let (status, answer) = served.ask("POST", "/api/v1/plans", asked.as_bytes());
        assert!((400..500).contains(&status), "{status}");
        serde_json::from_slice::<Value>(&answer).unwrap()["error"].clone()
    };
    let wrong = refused("house.png", json!({ "width": "3x" }));
    assert!(wrong["message"].as_str().unwrap().contains("--width"), "{wrong}");
    let both = refused("house.png", json!({ "width": "1m", "height": "1m" }));
    assert!(both["message"].as_str().unwrap().contains("cannot be used with"), "{both}");
    let (_, added) = served.ask("POST", "/api/v1/pictures?name=none.png", b"no picture at all");
    let id: Value = serde_json::from_slice(&added).unwrap();
    let none = refused(id["id"].as_str().unwrap(), json!({}));
    assert!(!none["message"].as_str().unwrap().is_empty() && none["code"] != "internal", "{none}");
}

#[test]
fn who_is_slow_is_not_waited_for_and_keeps_nobody_from_being_answered() {
    let served = Served::new("studio-slow", &[]);
    let slow = |said: &str| {
        let mut stream = TcpStream::connect(&served.at).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(40))).unwrap();
        stream.write_all(said.replace("HOST", &served.at).as_bytes()).unwrap();
        stream
    };
    let began = Instant::now();
    let mut all: Vec<TcpStream> = (0..100).map(|_| slow("GET / HTTP/1.1\r\nhost: HOST\r\nx-")).collect();
    all.push(slow("POST /api/v1/plans HTTP/1.1\r\nhost: HOST\r\ncontent-length: 100\r\n\r\n{"));
    all.push(slow(
        "POST /api/v1/pictures?name=x.png HTTP/1.1\r\nhost: HOST\r\ncontent-length: 50000000\r\n\r\nx",
    ));
    // what is sent with stop is not waited for
    let mut stop = slow("POST /api/v1/stop HTTP/1.1\r\nhost: HOST\r\ncontent-length: 100\r\n\r\n{");
    let mut answer = [0; 12];
    stop.read_exact(&mut answer).unwrap();
    assert!(answer == *b"HTTP/1.1 200" && began.elapsed() < Duration::from_secs(5), "{:?}", began.elapsed());
    let (status, _) = served.ask("GET", "/", b"");
    assert!(
        status == 200 && began.elapsed() < Duration::from_secs(5),
        "{status} after {:?}",
        began.elapsed()
    );
    for mut stream in all {
        let mut told = Vec::new();
        // closed, or broken off: the end of it either way
        let _ = stream.read_to_end(&mut told);
        let told = String::from_utf8_lossy(&told);
        assert!(told.is_empty() || told.starts_with("HTTP/1.1 408"), "{told}");
    }
    assert!(began.elapsed() < Duration::from_secs(30), "the last one is let go after {:?}", began.elapsed());
}

#[test]
#[cfg(unix)]
fn ctrl_c_ends_it_soon_and_another_one_may_have_its_port() {
    use nix::sys::signal::{Signal, kill};
    use nix::unistd::Pid;

    let mut served = Served::new("studio-ends", &["examples/star.png"]);
    let taken = program()
        .args(["studio", "--no-open", "--port", served.at.rsplit(':').next().unwrap()])
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&taken.stderr).into_owned();
    assert!(!taken.status.success() && told.contains("--port 0"), "{told}");
    kill(Pid::from_raw(served.process.id().try_into().unwrap()), Signal::SIGINT).unwrap();
    let began = Instant::now();
    let status = served.process.wait().unwrap();
    assert!(
        status.success() && began.elapsed() < Duration::from_secs(5),
        "{status} after {:?}",
        began.elapsed()
    );
}
