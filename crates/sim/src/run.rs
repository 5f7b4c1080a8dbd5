mod behind_wire;

pub use behind_wire::ServedRig;

use std::collections::VecDeque;
use std::ops::ControlFlow;

use tracelight_aim::{HeadGeometry, HeadPose};
use tracelight_control::{Config, Controller, Estimate, State};
use tracelight_plant::Plant;
use tracelight_rig::{
    Actuation, Command, Fault, FaultRecord, Head, Joint, PanTilt, Phase, Rig, Segment, Sensed, Setpoint,
    TICK_F64_S, Telemetry,
};
use tracelight_session::{Feeder, Job, Session, StrokeTicks, Trim, Untrimmed};
use tracelight_stroke::Point;
use tracelight_trajectory::Plan;

use crate::RigConfig;
use crate::open_loop::OpenLoop;
use crate::trouble::{Line, Trouble};
use crate::wired::Wired;

/// Ticks a run goes on after a fault, so that the log shows what followed: 0.2 s.
pub const AFTERMATH_TICKS: u32 = 200;

/// Ticks a run may take beyond its plan and its longest hold before it is given up.
const PATIENCE_TICKS: usize = 60_000;

/// Ticks beyond a plan after which a run of a rig with such a controller is given up.
pub(crate) const fn patience_ticks(control: &Config) -> usize {
    PATIENCE_TICKS + control.hold_limit_ticks as usize
}

/// Where the spot should be of a head that is built so and stands there, by what its controller tells; `None` where that misses the target.
pub(crate) fn asked_spot(geometry: &HeadGeometry, pose: &HeadPose, told: &Telemetry) -> Option<Point> {
    geometry.spot(pose, told.setpoint.map(|s| f64::from(s.position_rad)))
}

/// How far beyond its range a joint comes up against its stop, rad.
const STOP_RAD: f64 = 0.0175;

/// What is known of one tick after it happened: what the controller saw, and where the light really was.
///
/// In simulation `angle_rad`, `rate_rad_s`, `spot` and `light` are the plant's truth; on a real head they are the encoders'
/// opinion and the gate ([`Origin`](crate::Origin) says which). All of them are instants: the start of the tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    /// The controller's side.
    pub telemetry: Telemetry,
    /// Joint angles, rad.
    pub angle_rad: PanTilt<f64>,
    /// Rates of the joints, rad/s.
    pub rate_rad_s: PanTilt<f64>,
    /// Where the beam meets the target plane, m; `None` when it misses it.
    pub spot: Option<Point>,
    /// Spot of the setpoint, m.
    pub asked: Option<Point>,
    /// Whether light leaves the head, after the relay.
    pub light: bool,
}

/// One seeded run, tick by tick.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    /// In time order; `telemetry.plan_tick` says which point of the plan each one follows.
    pub ticks: Vec<Tick>,
}

impl Run {
    /// Whether the plan was followed to its end.
    pub fn is_done(&self) -> bool {
        self.ticks.last().is_some_and(|tick| tick.telemetry.phase == Phase::Done)
    }

    /// The controller's side of it.
    pub fn telemetry(&self) -> Vec<Telemetry> {
        self.ticks.iter().map(|tick| tick.telemetry).collect()
    }

    /// The fault it ended with, if any.
    pub fn fault(&self) -> Option<Fault> {
        self.latched().map(|record| record.fault)
    }

    /// What is known of that fault.
    pub fn latched(&self) -> Option<FaultRecord> {
        self.ticks.last().and_then(|tick| tick.telemetry.latched)
    }
}

/// What a head without encoders is told besides its actuation: where its joints are to be, and where it was homed.
const fn open_loop<const SEGMENTS: usize>(state: &State<SEGMENTS>) -> (PanTilt<Setpoint>, PanTilt<i32>) {
    (*state.told(), *state.home())
}

/// What drives the head.
#[derive(Clone, Debug)]
enum Brain {
    /// The controller itself.
    Here(Box<(Controller, State)>),
    /// A board, by a wire; the truth of the ticks that its host does not know of yet.
    Wired(Box<Wired>, VecDeque<(u32, Tick)>),
}

/// A controller with a simulated head, in this process.
///
/// [`Rig`] on the host's side; the truth is on [`Simulated::step`].
#[derive(Clone, Debug)]
pub struct SimulatedRig {
    brain: Brain,
    plant: Plant,
    /// What turns the joints in place of the plant's motors, of a rig without encoders.
    open_loop: Option<OpenLoop>,
    sensed: Sensed,
    /// The last tick's.
    told: Telemetry,
    lines: PanTilt<Line>,
    model: HeadGeometry,
    truth: HeadGeometry,
    pose: HeadPose,
    true_pose: HeadPose,
    /// Share by which the beam turns further than the counts say, and how much more each tick.
    stretch: f64,
    stretch_per_tick: f64,
    has_gyroscope: bool,
    /// What is to go wrong of itself, and in which tick.
    coming: Vec<(u32, Trouble)>,
    /// Ticks beyond a plan after which a run is given up.
    patience_ticks: usize,
}

impl SimulatedRig {
    /// A rig at rest straight ahead, dark, in front of the target. `seed` draws what differs from head to head.
    pub fn new(config: &RigConfig, pose: HeadPose, seed: u64) -> Self {
        Self::homed_beside(config, pose, PanTilt::default(), seed)
    }

    /// A rig that was homed not quite: it rests where its encoders read zero, and so many counts are to be added to what they read for true angles.
    pub fn homed_beside(config: &RigConfig, pose: HeadPose, counts: PanTilt<i32>, seed: u64) -> Self {
        let count_rad = config.truth.model.encoder.count_rad();
        let angle_rad = counts.map(|count| f64::from(count) * count_rad);
        let plant = Plant::resting_at(&config.plant_config(), angle_rad, seed);
        let mut rig = Self::of(config, pose, plant, seed);
        for j in Joint::BOTH {
            rig.lines[j].off = counts[j].wrapping_neg();
        }
        rig.emulated(config, seed)
    }

    /// Makes a rig that was just powered up: at rest within a count of these angles, rad, with its encoders at zero there.
    pub fn unhomed(config: &RigConfig, pose: HeadPose, angle_rad: PanTilt<f64>, seed: u64) -> Self {
        let plant = Plant::resting_at(&config.plant_config(), angle_rad, seed);
        let mut rig = Self::of(config, pose, plant, seed);
        rig.power_up();
        rig.emulated(config, seed)
    }

    /// A rig with this plant, homed, its encoders read as they are. Its joints have end stops a degree beyond their ranges.
    fn of(config: &RigConfig, pose: HeadPose, plant: Plant, seed: u64) -> Self {
        let range_rad = config.truth.model.geometry.range_rad;
        let stops_rad = range_rad.map(|(lower, upper)| (lower - STOP_RAD, upper + STOP_RAD));
        let plant = plant.between_stops(&config.plant_config(), stops_rad);
        let controller = Controller::new(config.control_config());
        // homed: count 0 on both
        let sensed = Sensed {
            laser_on: Some(plant.laser_on()),
            light: Some(plant.light()),
            inputs: plant.inputs(),
            ..Sensed::default()
        };
        Self {
            brain: Brain::Here(Box::new((controller, controller.start_homed(&sensed)))),
            open_loop: OpenLoop::at_rest(config, plant.angle_rad()),
            plant,
            sensed,
            told: Telemetry::default(),
            lines: PanTilt::from_fn(|_| Line::new(seed)),
            model: config.model.geometry,
            truth: config.truth.model.geometry,
            pose,
            true_pose: pose,
            stretch: 0.0,
            stretch_per_tick: 0.0,
            has_gyroscope: config.truth.gyroscope.fitted,
            coming: Vec::new(),
            patience_ticks: patience_ticks(controller.config()),
        }
    }

    /// Encoders that count from where the joints are now, and a controller that knows nothing.
    fn power_up(&mut self) {
        if let Some(open_loop) = &mut self.open_loop {
            open_loop.power_up(self.plant.angle_rad());
        }
        let found = self.open_loop.as_ref().map_or_else(|| self.plant.measured(), OpenLoop::measured);
        for j in Joint::BOTH {
            self.lines[j].off = found[j].count.wrapping_neg();
            self.sensed.encoders[j].count = 0;
        }
        match &mut self.brain {
            Brain::Here(brain) => brain.1 = brain.0.start(&self.sensed),
            Brain::Wired(wired, unseen) => {
                unseen.clear();
                wired.lose_power();
            }
        }
    }

    /// What has to be added to what its encoders read for counts that mean true angles.
    pub fn true_counts(&self) -> PanTilt<i32> {
        PanTilt::from_fn(|j| self.lines[j].off.wrapping_neg())
    }

    /// Starts the tick count at another number than 0, as after a long uptime.
    #[must_use]
    pub fn counting_from(mut self, tick: u32) -> Self {
        if let Brain::Here(brain) = &mut self.brain {
            brain.1.count_from(tick);
        }
        self
    }

    /// Places the head at another true pose than the one assumed.
    #[must_use]
    pub const fn standing(mut self, true_pose: HeadPose) -> Self {
        self.true_pose = true_pose;
        self
    }

    /// Where it truly stands now.
    fn stands(&self) -> HeadPose {
        let turned = self.plant.foot_rad();
        let HeadPose { yaw_rad, pitch_rad, .. } = self.true_pose;
        HeadPose { yaw_rad: yaw_rad + turned.pan, pitch_rad: pitch_rad + turned.tilt, ..self.true_pose }
    }

    fn tick(&mut self) -> Tick {
        let Brain::Here(brain) = &mut self.brain else { return self.tick_wired() };
        self.stretch += self.stretch_per_tick;
        let (controller, state) = &mut **brain;
        let telemetry = controller.tick(state, &self.sensed);
        let open_loop = open_loop(state);
        self.told = telemetry;
        let tick = Tick { asked: self.asked(&telemetry), telemetry, ..self.truth() };
        self.exchange(&telemetry.actuation, &open_loop);
        tick
    }

    /// What is true of the head now; nothing is known of what it is told.
    fn truth(&self) -> Tick {
        Tick {
            telemetry: Telemetry::default(),
            angle_rad: self.plant.angle_rad(),
            rate_rad_s: self.plant.rate_rad_s(),
            spot: self.truth.spot(&self.stands(), self.plant.beam_rad().map(|q| q * (1.0 + self.stretch))),
            asked: None,
            light: self.plant.light(),
        }
    }

    /// Where the spot should be.
    fn asked(&self, telemetry: &Telemetry) -> Option<Point> {
        asked_spot(&self.model, &self.pose, telemetry)
    }

    /// Lets the head do a tick; a head without encoders is told where its joints are to be, and where it was homed.
    fn exchange(&mut self, actuation: &Actuation, (told, home): &(PanTilt<Setpoint>, PanTilt<i32>)) {
        let seen = match &mut self.open_loop {
            None => self.plant.exchange(actuation),
            Some(open_loop) => {
                let to_rad = open_loop.turn(told, home, self.plant.pushed_nm());
                Sensed { encoders: open_loop.measured(), ..self.plant.turned_to(actuation, to_rad) }
            }
        };
        let encoders = PanTilt::from_fn(|j| self.lines[j].carry(seen.encoders[j]));
        self.sensed = Sensed { encoders, ..seen };
    }

    /// Full steps by which each joint is behind its pulses for good, where a stepper fell out of step: the simulated truth, which no real head
    /// knows. None of a rig with encoders.
    pub fn lost_steps(&self) -> PanTilt<i64> {
        self.open_loop.as_ref().map_or(PanTilt::default(), OpenLoop::lost_steps)
    }

    /// What the controller believes of the joints.
    pub fn estimates(&self) -> PanTilt<Estimate> {
        match &self.brain {
            Brain::Here(brain) => *brain.1.estimates(),
            Brain::Wired(wired, _) => {
                wired.board().machine().state().map(|state| *state.estimates()).unwrap_or_default()
            }
        }
    }

    /// Something goes wrong from now on.
    pub fn suffer(&mut self, trouble: Trouble) {
        match trouble {
            Trouble::Push(torque_nm) => self.plant.push(torque_nm),
            Trouble::SupplySag(left) => self.plant.sag(left),
            Trouble::EncoderCut(j) => self.lines[j].cut_at = Some(self.sensed.encoders[j].count),
            Trouble::EncoderJump(j, counts) => match &mut self.open_loop {
                Some(open_loop) => open_loop.lose(j, counts),
                None => self.lines[j].off += counts,
            },
            Trouble::EncoderNoise(j, share) => self.lines[j].noise = share,
            Trouble::EncoderSlip(j, share) => self.plant.slip_disc(j, share),
            Trouble::EdgesMissed(j, share) => self.lines[j].miss(share),
            Trouble::BeltSkip(j, belt) => self.plant.loosen_belt(j, belt),
            Trouble::AmplifierWeakens(j, weakening) => self.plant.weaken(j, weakening),
            Trouble::StampGarbled(j) => self.lines[j].garbled = true,
            Trouble::LaserStuck => self.plant.stick_laser(),
            Trouble::Bump(by_rad) => self.plant.bump(by_rad),
            Trouble::LaserMended => self.plant.free_laser(),
            Trouble::EnableStuck => self.plant.stick_enable(),
            Trouble::PowerLoss => self.power_up(),
            Trouble::Input(input, state) => self.plant.set_input(input, state),
            Trouble::HostKilled(ms) => self.wired(|wired| wired.kill_host(ms)),
            Trouble::HostStall(ms) => self.wired(|wired| wired.stall(ms)),
            Trouble::BitFlip(word, bit) => self.wired(|wired| wired.spoil(word, bit)),
            Trouble::Unplug(ms) => self.wired(|wired| wired.unplug(ms)),
            Trouble::TickLate(ticks) => self.plant.hold_up(ticks * TICK_F64_S),
            Trouble::Drift(share_per_s) => self.stretch_per_tick = share_per_s * TICK_F64_S,
        }
    }
}

/// A rig with access to its true state.
pub trait Simulated: Rig {
    /// One tick of the closed loop, with the truth.
    fn step(&mut self) -> Tick;

    /// What the last tick told whoever runs it: who arms acknowledges its faults. All is nought before the first.
    fn told(&self) -> &Telemetry;

    /// Ticks beyond a plan after which a run is given up.
    fn patience_ticks(&self) -> usize;
}

impl<S: Simulated + ?Sized> Simulated for &mut S {
    fn step(&mut self) -> Tick {
        (**self).step()
    }

    fn told(&self) -> &Telemetry {
        (**self).told()
    }

    fn patience_ticks(&self) -> usize {
        (**self).patience_ticks()
    }
}

impl Simulated for SimulatedRig {
    fn step(&mut self) -> Tick {
        self.tick()
    }

    fn told(&self) -> &Telemetry {
        &self.told
    }

    fn patience_ticks(&self) -> usize {
        self.patience_ticks
    }
}

impl Rig for SimulatedRig {
    fn send(&mut self, command: Command) -> Result<(), Command> {
        match &mut self.brain {
            Brain::Here(brain) => brain.0.accept(&mut brain.1, command),
            Brain::Wired(wired, _) => wired.send(command),
        }
    }

    fn next(&mut self) -> Option<Telemetry> {
        Some(self.step().telemetry)
    }
}

/// Lets a session with a simulated rig run for a tick, with the truth.
pub fn tick<R: Simulated>(session: &mut Session<R>) -> Tick {
    tick_trimmed(session, &mut Untrimmed)
}

/// Does the same with a job whose segments are moved on their way to the rig.
pub fn tick_trimmed<R: Simulated>(session: &mut Session<R>, trim: &mut impl Trim) -> Tick {
    session.tick_by(R::step, |tick| Some(&tick.telemetry), trim)
}

/// Returns a plan as a session takes it; a dry one is traced in the dark.
pub fn job_of(plan: &Plan, dry: bool) -> Job {
    let mut end = 0;
    // a stroke without light takes no time
    let ticks = |lit: Option<[u32; 2]>| {
        let start = lit.map_or(end, |[first, _]| first);
        end = lit.map_or(end, |[_, last]| last + 1);
        StrokeTicks { start, end }
    };
    let strokes: Vec<StrokeTicks> = plan.lit_ticks().into_iter().map(ticks).collect();
    let of = strokes.len() as u32;
    Job { segments: plan.segments.clone(), strokes, first: 0, of, dry, slowest: 0.0, again: None }
}

/// Arms a rig: the host is there, and has read every fault that the rig told of. False where the rig does not take it.
pub fn arm(rig: &mut impl Simulated) -> bool {
    let acknowledges = rig.told().fault_number;
    rig.send(Command::KeepAlive).is_ok() && rig.send(Command::Arm { acknowledges }).is_ok()
}

/// Disarms a rig and lets ticks pass until its gate is shut, one at most, which are kept. Whoever stops a run does so before he goes.
fn darken<R: Simulated>(rig: &mut R, mut keep: impl FnMut(Tick)) {
    let _ = rig.send(Command::Disarm);
    if rig.told().actuation.lights() {
        keep(rig.step());
    }
}

/// Runs a plan on a simulated rig from power-up to rest. `watch` sees every tick as it happens and may stop the run: then the rig is disarmed, and
/// the run ends once the gate is shut.
pub fn run<R: Simulated>(
    rig: &mut R,
    plan: &Plan,
    dry: bool,
    watch: impl FnMut(&mut R, &Tick) -> ControlFlow<()>,
) -> Run {
    run_segments(rig, &plan.segments, dry, watch)
}

/// Runs segments that come from no plan.
pub fn run_segments<R: Simulated>(
    rig: &mut R,
    segments: &[Segment],
    dry: bool,
    mut watch: impl FnMut(&mut R, &Tick) -> ControlFlow<()>,
) -> Run {
    let mut feeder = Feeder::new(segments, dry);
    let planned = segments.last().map_or(0, |segment| segment.end_tick() as usize + 1);
    let mut ticks = Vec::with_capacity(planned);
    let mut aftermath = AFTERMATH_TICKS;
    let armed = arm(rig);
    while armed && ticks.len() < planned + rig.patience_ticks() {
        let alive = rig.send(Command::KeepAlive).is_ok();
        debug_assert!(alive, "only segments wait");
        feeder.feed(rig);
        let tick = rig.step();
        ticks.push(tick);
        aftermath -= u32::from(tick.telemetry.phase == Phase::Faulted);
        let over = tick.telemetry.phase == Phase::Done || aftermath == 0;
        if watch(rig, &tick).is_break() || over {
            break;
        }
    }
    if rig.told().phase != Phase::Done {
        darken(rig, |tick| ticks.push(tick));
    }
    Run { ticks }
}
