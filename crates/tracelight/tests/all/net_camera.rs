//! Cameras on the net that never end an image, and an environment that would have their images go elsewhere.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use crate::support::{folder, program, root};

/// Something that listens: where, and who came.
fn server(serve: fn(TcpStream) -> std::io::Result<()>) -> (String, Receiver<()>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().to_string();
    let (came, all) = channel();
    std::thread::spawn(move || {
        for connection in listener.incoming() {
            let _ = came.send(());
            std::thread::spawn(move || serve(connection.unwrap()));
        }
    });
    (address, all)
}

/// Tells of an image, and sends a byte of it a second.
fn drip(mut to: TcpStream) -> std::io::Result<()> {
    let _ = to.read(&mut [0; 4096])?;
    to.write_all(b"HTTP/1.1 200 OK\r\nContent-Type: image/jpeg\r\nContent-Length: 90000\r\n\r\n")?;
    loop {
        to.write_all(b"x")?;
        std::thread::sleep(Duration::from_secs(1));
    }
}

/// Sends the image of the page on cameras.
fn image(mut to: TcpStream) -> std::io::Result<()> {
    let _ = to.read(&mut [0; 4096])?;
    let image = std::fs::read(root().join("docs/camera/house.jpg"))?;
    write!(to, "HTTP/1.1 200 OK\r\nContent-Type: image/jpeg\r\nContent-Length: {}\r\n\r\n", image.len())?;
    to.write_all(&image)
}

fn calibrating(address: &str, out: &str, environment: &[(&str, String)]) -> Child {
    let mut command = program();
    command.args(["calibrate", "markers", "--camera", &format!("http://{address}/image"), "-o", out]);
    command.env_remove("no_proxy").env_remove("NO_PROXY");
    command.envs(environment.iter().map(|(name, value)| (name, value)));
    command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

#[test]
fn a_camera_that_drips_ends_within_its_bound_and_by_one_ctrl_c_at_once() {
    let dir = folder("net-drip");
    let [one, two] = ["1.toml", "2.toml"].map(|name| dir.join(name).to_str().unwrap().to_owned());
    let (address, came) = server(drip);
    let begun = Instant::now();
    let [waits, mut stopped] = [&one, &two].map(|out| calibrating(&address, out, &[]));
    // each asks what is sent, and then for an image
    (0..4).for_each(|_| came.recv_timeout(Duration::from_secs(9)).unwrap());
    std::thread::sleep(Duration::from_millis(500));
    let id = stopped.id().to_string();
    assert!(std::process::Command::new("kill").args(["-INT", &id]).status().unwrap().success());
    let asked = Instant::now();
    assert_eq!(stopped.wait().unwrap().code(), Some(130));
    assert!(asked.elapsed() < Duration::from_secs(2), "ended {:?} after it was asked to", asked.elapsed());
    println!("Ctrl-C: {:?}", asked.elapsed());
    let waited = waits.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&waited.stderr);
    assert_eq!(waited.status.code(), Some(1), "{said}");
    assert!(said.contains(&address) && said.contains("it sent no whole image within 10 s"), "{said}");
    assert!(begun.elapsed() < Duration::from_secs(15), "{:?}", begun.elapsed());
    println!("by itself: {:?}", begun.elapsed());
}

#[test]
fn images_go_through_no_proxy_that_the_environment_names() {
    let dir = folder("net-proxy");
    let (proxy, came) = server(image);
    let (address, asked) = server(image);
    let names = ["http_proxy", "HTTP_PROXY", "https_proxy", "HTTPS_PROXY", "all_proxy", "ALL_PROXY"];
    let environment = names.map(|name| (name, format!("http://{proxy}")));
    let out = dir.join("camera.toml");
    let done = calibrating(&address, out.to_str().unwrap(), &environment).wait_with_output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    assert_eq!(asked.try_iter().count(), 2, "the camera is asked itself");
    assert_eq!(came.try_iter().count(), 0, "the proxy is not");
}
