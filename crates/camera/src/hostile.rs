//! Cameras on the net that drip, stall, send too much, or send on to elsewhere: each ends within its bound, by a sentence that says what it did.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use tracelight_eye::{Looks, MOST_IMAGE_BYTES};

use crate::net::Limits;
use crate::stream::Stream;

/// As of the program, but sooner.
const LIMITS: Limits = Limits {
    patience: Duration::from_millis(400),
    whole: Duration::from_millis(800),
    silence: Duration::from_millis(600),
};
/// Limits for images of which much is sent before they are refused: a busy machine takes its time.
const UNHURRIED: Limits = Limits {
    patience: Duration::from_secs(30),
    whole: Duration::from_secs(60),
    silence: Duration::from_secs(60),
};
/// For a machine that does much else.
const SLACK: Duration = Duration::from_secs(3);
const IMAGE: &str = "HTTP/1.1 200 OK\r\nContent-Type: image/jpeg\r\n";
const STREAM: &str = "HTTP/1.1 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=cut\r\n\r\n";
const PART: &str = "--cut\r\nContent-Type: image/jpeg\r\n";

/// What was asked for, and where an answer goes.
type Answers = fn(path: &str, to: &mut TcpStream) -> std::io::Result<()>;

/// A camera; its port, and the paths that it is asked for.
fn camera(answers: Answers) -> (u16, Receiver<String>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    let (asked, all) = channel();
    let asked = Arc::new(asked);
    std::thread::spawn(move || {
        for connection in listener.incoming() {
            let asked = Arc::clone(&asked);
            std::thread::spawn(move || {
                let mut to = connection.unwrap();
                let mut request = [0; 4096];
                let length = to.read(&mut request).unwrap();
                let request = String::from_utf8_lossy(&request[..length]).into_owned();
                let path = request.split(' ').nth(1).unwrap_or_default().to_owned();
                let _ = asked.send(path.clone());
                // whoever asked may go before the end
                let _ = answers(&path, &mut to);
            });
        }
    });
    (port, all)
}

/// What a first image comes to; in time.
fn first(answers: Answers, limits: Limits) -> Result<(), String> {
    let (port, _) = camera(answers);
    look(&format!("http://127.0.0.1:{port}/video"), limits)
}

fn look(url: &str, limits: Limits) -> Result<(), String> {
    let begun = Instant::now();
    let image = Stream::with(url, limits).and_then(|mut camera| camera.take(0.0));
    let bound = limits.patience + limits.whole + SLACK;
    assert!(begun.elapsed() < bound, "{:?}", begun.elapsed());
    match image {
        Ok(_) => Ok(()),
        Err(failure) => {
            assert!(failure.message.starts_with(&format!("the camera at {url}: ")), "{}", failure.message);
            Err(failure.message)
        }
    }
}

fn check_refused(answers: Answers, what: &str) {
    check_refused_within(answers, LIMITS, what);
}

fn check_refused_within(answers: Answers, limits: Limits, what: &str) {
    let why = first(answers, limits).unwrap_err();
    assert!(why.contains(what), "{why}, and not {what}");
}

/// Byte after byte, for ever.
fn drip(to: &mut TcpStream) -> std::io::Result<()> {
    loop {
        to.write_all(b"x")?;
        std::thread::sleep(Duration::from_millis(50));
    }
}

/// Until whoever asked goes.
fn stall(to: &mut TcpStream) -> std::io::Result<()> {
    to.read(&mut [0; 16]).map(|_| ())
}

/// Zeros, one more than are taken.
fn too_many(to: &mut TcpStream) -> std::io::Result<()> {
    let some = vec![0; 1 << 20];
    let mut left = MOST_IMAGE_BYTES + 1;
    while left > 0 {
        let now = left.min(some.len());
        to.write_all(&some[..now])?;
        left -= now;
    }
    Ok(())
}

#[test]
fn an_image_that_drips_or_stalls_ends_within_its_bound() {
    let late = "it sent no whole image within 0.8 s";
    check_refused(|_, to| write!(to, "{IMAGE}\r\n").and_then(|()| drip(to)), late);
    check_refused(|_, to| write!(to, "{IMAGE}Content-Length: 9000\r\n\r\n").and_then(|()| drip(to)), late);
    check_refused(
        |_, to| write!(to, "{IMAGE}Content-Length: 9\r\n\r\n").and_then(|()| stall(to)),
        "within 0.",
    );
    check_refused(
        |_, to| write!(to, "{IMAGE}Transfer-Encoding: chunked\r\n\r\n1\r\nx\r\n").and_then(|()| stall(to)),
        "within 0.",
    );
}

#[test]
fn an_answer_that_never_begins_or_drips_its_head_ends_within_its_bound() {
    check_refused(|_, to| stall(to), "it did not answer within 0.4 s");
    check_refused(|_, to| write!(to, "{IMAGE}X: ").and_then(|()| drip(to)), "it did not answer within 0.4 s");
    check_refused(|_, to| write!(to, "{IMAGE}Content-Length: 9\r\n\r\nab"), "ended before it was whole");
}

#[test]
fn a_stream_that_stalls_is_told_and_then_given_up() {
    let (port, _) = camera(|_, to| {
        write!(to, "{STREAM}")?;
        std::thread::sleep(LIMITS.patience / 2);
        write!(to, "{PART}Content-Length: 4\r\n\r\nabcd\r\n{PART}Content-Length: 4\r\n\r\nab")?;
        stall(to)
    });
    let mut camera = Stream::with(&format!("http://127.0.0.1:{port}/x"), LIMITS).unwrap();
    assert!(camera.take(0.0).is_ok());
    let begun = Instant::now();
    let why = camera.take(0.0).unwrap_err().message;
    assert!(why.contains("no image for 0 s") && begun.elapsed() < LIMITS.patience + SLACK, "{why}");
    std::thread::sleep(LIMITS.silence);
    let why = camera.take(0.0).unwrap_err().message;
    assert!(why.contains("its stream stopped: nothing came within 0.6 s"), "{why}");
}

#[test]
fn a_stream_that_drips_has_no_image() {
    check_refused(|_, to| write!(to, "{STREAM}").and_then(|()| drip(to)), "no image for 0 s");
    check_refused(|_, to| write!(to, "{STREAM}{PART}\r\n").and_then(|()| drip(to)), "no image for 0 s");
}

#[test]
fn an_image_that_is_too_large_is_told_so_with_its_length_or_without() {
    check_refused_within(
        |_, to| write!(to, "{IMAGE}\r\n").and_then(|()| too_many(to)),
        UNHURRIED,
        "its image has more than 64000000 bytes",
    );
    check_refused_within(
        |_, to| write!(to, "{IMAGE}Content-Length: 64000001\r\n\r\n").and_then(|()| too_many(to)),
        UNHURRIED,
        "its image has 64000001 bytes, at most 64000000",
    );
    check_refused_within(
        |_, to| write!(to, "{STREAM}{PART}\r\n").and_then(|()| too_many(to)).and_then(|()| stall(to)),
        UNHURRIED,
        "its stream sends an image of more than 64000000 bytes",
    );
}

/// Sends on to wherever the path says behind its first letter; `/image` is an image.
fn sends_on(path: &str, to: &mut TcpStream) -> std::io::Result<()> {
    match path.split_once("?to=") {
        Some((_, place)) => {
            write!(to, "HTTP/1.1 302 Found\r\nLocation: {place}\r\nContent-Length: 0\r\n\r\n")
        }
        None => write!(to, "{IMAGE}Content-Length: 4\r\n\r\nabcd"),
    }
}

#[test]
fn a_redirect_is_followed_on_the_host_and_nowhere_else() {
    let (other, asked_there) = camera(sends_on);
    let (port, asked) = camera(sends_on);
    let own = format!("http://127.0.0.1:{port}");
    assert_eq!(look(&format!("{own}/a?to=/image"), LIMITS), Ok(()));
    // once to see what it sends, once for the image
    assert_eq!(asked.try_iter().collect::<Vec<_>>(), ["/a?to=/image", "/image"].repeat(2));
    assert_eq!(look(&format!("{own}/a?to={own}/b?to=http://127.0.0.1:{other}/image"), LIMITS), Ok(()));
    assert_eq!(asked_there.try_iter().collect::<Vec<_>>(), ["/image"; 2]);
    for (place, what) in [
        (format!("http://localhost:{other}/image"), "not on 127.0.0.1"),
        (format!("//localhost:{other}/image"), "not on 127.0.0.1"),
        (format!("https://127.0.0.1:{other}/image"), "nothing but http:// on the same host"),
        ("file:///etc/passwd".to_owned(), "nothing but http:// on the same host"),
    ] {
        let why = look(&format!("{own}/a?to={place}"), LIMITS).unwrap_err();
        assert!(why.contains(&format!("it redirects to {place}, ")) && why.contains(what), "{why}");
    }
    assert_eq!(asked_there.try_iter().count(), 0, "the other host was asked");
}

#[test]
fn a_camera_that_answers_one_question_a_connection_is_asked_on_a_new_one() {
    let (port, asked) =
        camera(|path, to| sends_on(path, to).and_then(|()| stall(to)).and_then(|()| stall(to)));
    assert_eq!(look(&format!("http://127.0.0.1:{port}/a?to=/image"), LIMITS), Ok(()));
    assert_eq!(asked.try_iter().count(), 4);
}

#[test]
fn redirects_end_however_many_and_slow_they_are() {
    check_refused(
        |_, to| write!(to, "HTTP/1.1 301 Moved\r\nLocation: /again\r\nContent-Length: 0\r\n\r\n"),
        "it redirects more than 3 times, and would next to http://127.0.0.1:",
    );
    check_refused(
        |_, to| {
            std::thread::sleep(Duration::from_millis(300));
            write!(to, "HTTP/1.1 307 Moved\r\nLocation: /again\r\nContent-Length: 0\r\n\r\n")
        },
        "within 0.8 s, its redirects counted",
    );
    check_refused(
        |_, to| write!(to, "HTTP/1.1 304 Not Modified\r\nContent-Length: 0\r\n\r\n"),
        "does not say where to",
    );
    // the body of a redirect is nobody's
    check_refused(
        |_, to| write!(to, "HTTP/1.1 302 Found\r\nLocation: file:/x\r\n\r\n").and_then(|()| drip(to)),
        "it redirects to file:/x, ",
    );
}
