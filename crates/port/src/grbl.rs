//! A head whose motors hang on a Grbl board, as a rig.

use std::path::Path;
use std::time::{Duration, Instant};

use tracelight_aim::HeadPose;
use tracelight_grbl::{Asking, AxisLimits, Board, Driver, Trouble};
use tracelight_rig::{Command, Joint, PanTilt, Rig, TICK_F64_S, Telemetry};
use tracelight_sim::{DriveKind, RigConfig};
use tracelight_task::{Failure, Stop, Task};

use crate::seen::Seen;
use crate::session::micros;
use crate::shared::{Shared, stopped};
use crate::wire::Wire;

/// For how long it waits for bytes before it looks what else is to be done.
const WAIT: Duration = Duration::from_millis(1);
/// How long a board may take to come to rest when nobody drives it any more.
const SETTLES: Duration = Duration::from_secs(3);
/// Furthest that the lit spot may be from where it is told to be, m, by joining ticks to moves.
const NEAR_M: f64 = 5e-5;
/// Share of a board's acceleration that a plan uses: with the rest the board changes its speed from move to move.
const ACCELERATION_SHARE: f64 = 0.5;
/// How far a board's steps may be from those of the rig file, as a share; the board's hold.
const STEPS_APART: f64 = 0.01;
/// A board that plans no more moves ahead is of the small kind (an Uno), which makes so many steps a second at most.
const SMALL_MOVES: usize = 16;
const MOST_STEPS_A_S: f64 = 30_000.0;
/// How far the steps of both axes may be apart: a rig file has one gear for both.
const AXES_APART: f64 = 1e-3;

/// A head on a Grbl board. Nothing measures where it is: its ticks are told once the board has done them.
#[derive(Debug)]
pub struct Grbl {
    driver: Driver,
    wire: Wire,
    at: String,
    began: Instant,
    /// Those who watch it, and may disarm it; none where no socket could be made.
    shared: Option<Shared>,
    broke: Option<String>,
    /// Why it is to stay dark: somebody else stopped it.
    stopped: Option<Failure>,
    is_dark: bool,
    remarks: Vec<String>,
}

/// What a board says that it is, at a serial port or `tcp:HOST`.
///
/// # Errors
/// `port`: it cannot be opened. `board`: what is wrong with it. `interrupted`.
pub fn ask(at: &str, stop: &Stop) -> Result<Board, Failure> {
    let mut wire = Wire::open(at)?;
    asked(&mut wire, at, Instant::now(), stop)
}

fn asked(wire: &mut Wire, at: &str, began: Instant, stop: &Stop) -> Result<Board, Failure> {
    let mut asking = Asking::new(micros(began));
    let mut bytes = Vec::new();
    loop {
        stop.check()?;
        bytes.clear();
        asking.give(micros(began), &mut bytes);
        wire.write(&bytes).map_err(|e| gone(at, &e))?;
        bytes.clear();
        wire.read(&mut bytes, WAIT).map_err(|e| gone(at, &e))?;
        asking.take(&bytes, micros(began));
        if let Some(board) = asking.board(micros(began)) {
            return board.map_err(|trouble| wrong(at, &trouble));
        }
    }
}

fn gone(at: &str, e: &std::io::Error) -> Failure {
    Failure::failed("board", format!("{at}: the line to the board is gone: {e}"))
}

fn wrong(at: &str, trouble: &Trouble) -> Failure {
    Failure::failed("board", format!("{at}: {trouble}"))
}

/// Makes a rig that of the head on a board: its steps, and no more speed and acceleration than the board allows. What people are to know of that.
///
/// # Errors
/// `rig-file`: the rig is none on stepper motors, or its steps are others than the board's. `board`: settings of the board that do not fit.
pub(crate) fn fit(at: &str, board: &Board, config: RigConfig) -> Result<(RigConfig, Vec<String>), Failure> {
    let refused = |why: String| Failure::usage("rig-file", format!("{}: {why}", config.name));
    if config.drive.kind != DriveKind::Stepper {
        return Err(refused(
            "a Grbl board turns stepper motors, and this rig has others: give a rig file that begins with base = \"stepper\", as docs/open-loop.md tells"
                .to_owned(),
        ));
    }
    let axes = config.drive.axes;
    if axes.pan.letter == axes.tilt.letter {
        return Err(refused(format!(
            "pan and tilt are both on axis {}: each needs its own",
            axes.pan.letter
        )));
    }
    board.check().map_err(|trouble| wrong(at, &trouble))?;
    let limits = board.limits(axes).map_err(|trouble| wrong(at, &trouble))?;
    let said_rad = config.drive.stepper.microstep_rad();
    for j in Joint::BOTH {
        let is_rad = limits[j].step_rad;
        if (is_rad / said_rad - 1.0).abs() > STEPS_APART {
            let [is, said] = [is_rad, said_rad].map(|step_rad| 1.0 / step_rad.to_degrees());
            return Err(refused(format!(
                "the board makes {is:.3} steps a degree of {j} (axis {}), and by microsteps and gear of the rig file there are {said:.3}: set both alike",
                axes[j].letter
            )));
        }
    }
    if (limits.pan.step_rad / limits.tilt.step_rad - 1.0).abs() > AXES_APART {
        return Err(refused("the board's axes have different steps: set $100 and its like alike".to_owned()));
    }
    Ok(fitted(config, said_rad, limits, board.moves <= SMALL_MOVES))
}

fn fitted(
    mut config: RigConfig,
    said_rad: f64,
    limits: PanTilt<AxisLimits>,
    is_small: bool,
) -> (RigConfig, Vec<String>) {
    let fastest_rad_s =
        limits.map(|limits| if is_small { MOST_STEPS_A_S * limits.step_rad } else { f64::INFINITY });
    config.drive.stepper.gear_ratio *= said_rad / limits.pan.step_rad;
    // a board switches the laser within a move, without a relay
    for model in [&mut config.model, &mut config.truth.model] {
        (model.relay.on_s, model.relay.off_s) = (0.0, 0.0);
        (model.enable.on_s, model.enable.off_s) = (0.0, 0.0);
    }
    let mut slower = Vec::new();
    for j in Joint::BOTH {
        let motion = &mut config.motion;
        let speed_rad_s = limits[j].speed_rad_s.min(fastest_rad_s[j]);
        let most = [speed_rad_s, ACCELERATION_SHARE * limits[j].acceleration_rad_s2];
        let wishes = [&mut motion.speed_limit_rad_s[j], &mut motion.acceleration_limit_rad_s2[j]];
        let is_more = wishes.iter().zip(most).any(|(wish, most)| **wish > most);
        wishes.into_iter().zip(most).for_each(|(wish, most)| *wish = wish.min(most));
        if is_more {
            slower.push(format!(
                "{j} {:.0} deg/s and {:.0} deg/s2",
                motion.speed_limit_rad_s[j].to_degrees(),
                motion.acceleration_limit_rad_s2[j].to_degrees()
            ));
        }
    }
    let note = format!(
        "the plan keeps within the board's own limits: at most {} (half of what $120 and its like allow; 30000 steps a second of a small board)",
        slower.join(", ")
    );
    let notes = if slower.is_empty() { Vec::new() } else { vec![note] };
    (config.driven(), notes)
}

impl Grbl {
    /// Asks the board at a serial port or `tcp:HOST`, and makes it ready to draw by a head that is built and stands so. It is disarmed.
    ///
    /// # Errors
    /// As of [`ask`] and [`fit`].
    pub fn connect(at: &str, config: &RigConfig, pose: HeadPose, stop: &Stop) -> Result<Self, Failure> {
        let began = Instant::now();
        let mut wire = Wire::open(at)?;
        let board = asked(&mut wire, at, began, stop)?;
        let (config, _) = fit(at, &board, config.clone())?;
        // it was dark since it was asked first, and who drove it before may have lit it until then
        let shut_ticks = (began.elapsed().as_secs_f64() / TICK_F64_S) as u32;
        let near = (NEAR_M / pose.distance_m, shut_ticks);
        let driver = Driver::new(config.control_config(), board, config.drive.axes, near, micros(began))
            .map_err(|trouble| wrong(at, &trouble))?;
        let (mut remarks, path) = (Vec::new(), Path::new(at));
        let shared = Shared::new(path, false)
            .map_err(|e| remarks.push(format!("no other program can watch or stop this head: {e}")))
            .ok();
        let at = at.to_owned();
        let (broke, stopped, is_dark) = (None, None, false);
        Ok(Self { driver, wire, at, began, shared, broke, stopped, is_dark, remarks })
    }

    /// The board.
    #[must_use]
    pub const fn board(&self) -> &Board {
        self.driver.board()
    }

    /// As of a board behind a wire.
    pub(crate) fn is_homed(&self) -> bool {
        self.driver.is_homed()
    }

    pub(crate) fn remarks(&mut self) -> Vec<String> {
        std::mem::take(&mut self.remarks)
    }

    pub(crate) fn failure(&self) -> Option<Failure> {
        let broke = self.broke.as_ref().map(|why| {
            Failure::failed("board", format!("{}: the line to the board is gone: {why}", self.at))
        });
        let trouble = || self.driver.trouble().map(|trouble| wrong(&self.at, trouble));
        self.stopped.clone().or(broke).or_else(trouble)
    }

    pub(crate) fn wait_for_light(&mut self, task: Task<'_>) -> Result<(), Failure> {
        let mut is_told = false;
        while self.next().is_some() {
            task.check()?;
            let left_s = f64::from(self.driver.opens_in_ticks()) * TICK_F64_S;
            if left_s <= 0.0 {
                return Ok(());
            }
            if !std::mem::replace(&mut is_told, true) {
                task.say(&format!(
                    "note: a Grbl board does not say where its light was before: it stays dark for {left_s:.1} s more"
                ));
            }
        }
        Err(self.failure().unwrap_or_else(Failure::interrupted))
    }

    /// Says what is to be said, and hears what comes.
    fn pump(&mut self) {
        if self.shared.as_mut().is_some_and(|shared| shared.hear().disarm) {
            // what cannot be taken now is taken while it is halted
            let _ = self.driver.send(Command::Disarm, micros(self.began));
            self.stopped = Some(stopped(&self.at));
        }
        let mut bytes = Vec::new();
        self.driver.give(micros(self.began), &mut bytes);
        let said = self.wire.write(&bytes);
        bytes.clear();
        let heard = self.wire.read(&mut bytes, WAIT);
        self.driver.take(&bytes, micros(self.began));
        self.broke = self.broke.take().or_else(|| said.and(heard).err().map(|e| e.to_string()));
    }
}

/// Whoever lets go of it leaves it dark, at rest, and knowing where it points.
impl Drop for Grbl {
    fn drop(&mut self) {
        let _ = self.driver.send(Command::Disarm, micros(self.began));
        let until = Instant::now() + SETTLES;
        while !self.driver.is_settled() && self.failure().is_none() && Instant::now() < until {
            self.pump();
        }
    }
}

impl Rig for Grbl {
    fn send(&mut self, command: Command) -> Result<(), Command> {
        // whoever stopped it from elsewhere does not want it lit again from here
        let lights = matches!(command, Command::Arm { .. } | Command::Point(_));
        if self.stopped.is_some() && lights {
            return Err(command);
        }
        self.driver.send(command, micros(self.began))
    }

    fn next(&mut self) -> Option<Telemetry> {
        loop {
            if let Some(told) = self.driver.telemetry() {
                self.is_dark = !told.actuation.lights();
                self.shared.iter_mut().for_each(|shared| shared.tell(&Seen::of(&told)));
                return Some(told);
            }
            let is_waited_for = self.stopped.is_some() && !self.is_dark && self.broke.is_none();
            if self.failure().is_some() && (!is_waited_for || self.driver.trouble().is_some()) {
                // what is still to be said to it
                self.pump();
                return None;
            }
            self.pump();
        }
    }
}
