//! A head on a Grbl board on the net, by the clock.

use std::io::{ErrorKind, Read as _, Write as _};
use std::net::TcpListener;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use tracelight_aim::HeadPose;
use tracelight_port::{At, Speaks, ask, asked_text, head};
use tracelight_rig::{Command, PanTilt, Rig as _};
use tracelight_session::{Session, State};
use tracelight_sim::{RigConfig, observed_tick};
use tracelight_task::Stop;

#[allow(
    dead_code,
    reason = "it is the board that the driver's own tests have, and more is asked of it there"
)]
#[path = "../../../grbl/tests/all/board.rs"]
mod board;

use board::Board;

/// A board that answers on the net until it is dropped, one program after the other.
struct Served {
    port: u16,
    ends: Arc<AtomicBool>,
    thread: Option<JoinHandle<Board>>,
}

impl Served {
    fn new(mut board: Board) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        listener.set_nonblocking(true).unwrap();
        let port = listener.local_addr().unwrap().port();
        let ends = Arc::new(AtomicBool::new(false));
        let ended = Arc::clone(&ends);
        let thread = std::thread::spawn(move || {
            let (mut stream, began, mut passed_ms) = (None, Instant::now(), 0);
            while !ended.load(Ordering::Relaxed) {
                if let Ok((new, _)) = listener.accept() {
                    new.set_nonblocking(true).unwrap();
                    stream = Some(new);
                }
                let mut bytes = [0; 256];
                match stream.as_mut().map(|stream| stream.read(&mut bytes)) {
                    Some(Ok(0)) => stream = None,
                    Some(Ok(count)) => board.hear(&bytes[..count]),
                    Some(Err(e)) if e.kind() != ErrorKind::WouldBlock => stream = None,
                    _ => {}
                }
                while passed_ms < began.elapsed().as_millis() {
                    board.pass();
                    passed_ms += 1;
                }
                let said = board.say();
                if let Some(stream) = &mut stream {
                    let _ = stream.write_all(&said);
                }
                std::thread::sleep(Duration::from_micros(300));
            }
            board
        });
        Self { port, ends, thread: Some(thread) }
    }

    fn at(&self) -> At {
        At { port: format!("tcp:127.0.0.1:{}", self.port), speaks: Speaks::Grbl, is_said: true }
    }

    fn end(&mut self) -> Board {
        self.ends.store(true, Ordering::Relaxed);
        self.thread.take().unwrap().join().unwrap()
    }
}

fn stepper_board() -> Board {
    Board::new(1.0 / RigConfig::stepper().drive.stepper.microstep_rad().to_degrees())
}

#[test]
fn a_head_on_the_net_is_fitted_homed_turned_and_left_dark() {
    let (mut served, stop) = (Served::new(stepper_board()), Stop::default());
    let at = served.at();
    let told = asked_text(&at.port, &ask(&at.port, &stop).unwrap());
    assert!(told.contains("not homed") && told.contains("$32=1"), "{told}");
    let (config, notes) = at.fitted(RigConfig::stepper(), &stop).unwrap();
    assert!(notes.iter().any(|note| note.contains("4000 deg/s2")), "{notes:?}");
    let pose = HeadPose::square_on(0.9144);
    {
        let mut device = head(&at, &config, pose, &stop).unwrap();
        assert!(!device.rig().is_homed() && device.rig().wants_a_person());
        device.next().unwrap();
        while device.send(Command::Home(PanTilt::new(0, 0))).is_err() {
            device.next().unwrap();
        }
        device.next().unwrap();
    }
    // whoever comes later finds it homed
    let device = head(&at, &config, pose, &stop).unwrap();
    assert!(device.rig().is_homed() && device.rig().failure().is_none());
    let mut session = Session::new(device);
    while session.state() != State::Ready {
        observed_tick(&mut session).unwrap();
    }
    drop(session);
    assert!(served.end().knows_zero());
}

#[test]
fn a_rig_that_a_grbl_board_cannot_turn_is_refused() {
    let (mut served, stop) = (Served::new(stepper_board()), Stop::default());
    let at = served.at();
    let motors = at.fitted(RigConfig::report(), &stop).unwrap_err();
    assert!(motors.message.contains("base = \"stepper\""), "{}", motors.message);
    let mut other = RigConfig::stepper();
    other.drive.stepper.microsteps = 32;
    let steps = at.fitted(other, &stop).unwrap_err();
    assert!(steps.message.contains("26.667") && steps.message.contains("53.333"), "{}", steps.message);
    let mut same = RigConfig::stepper();
    same.drive.axes.tilt = same.drive.axes.pan;
    assert!(at.fitted(same, &stop).unwrap_err().message.contains("both on axis X"));
    served.end();
    let gone = ask(&at.port, &stop).unwrap_err();
    assert_eq!(gone.code, "port");
}
