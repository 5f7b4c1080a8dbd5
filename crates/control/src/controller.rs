use tracelight_rig::{Actuation, Command, Fault, Joint, Measurement, PanTilt, Phase, Segment, Telemetry};

use crate::player::{Played, Player};
use crate::return_path::ReturnPath;
use crate::servo::{Reference, Servo};
use crate::supervisor::{Clock, Situation, Supervisor};
use crate::watch::EncoderWatch;
use crate::{Config, Estimate};

/// The controller: its configuration, fixed at start.
#[derive(Clone, Copy, Debug)]
pub struct Controller {
    config: Config,
}

/// What the controller remembers from tick to tick.
#[derive(Clone, Copy, Debug)]
pub struct State {
    tick: u32,
    servo: Servo,
    watch: EncoderWatch,
    player: Player,
    supervisor: Supervisor,
    way_back: Option<ReturnPath>,
}

impl State {
    /// What is believed of the joints.
    pub const fn estimates(&self) -> &PanTilt<Estimate> {
        self.servo.estimates()
    }
}

impl Controller {
    /// Takes a configuration as it is; whoever made it has checked it.
    pub const fn new(config: Config) -> Self {
        Self { config }
    }

    /// State of a head at rest whose encoders read `measured`: dark, disarmed, held where it is.
    pub fn start(&self, measured: &PanTilt<Measurement>) -> State {
        let servo = Servo::at_rest(&self.config, measured);
        State {
            tick: 0,
            servo,
            watch: EncoderWatch::new(measured),
            player: Player::resting_at(servo.estimates().map(|estimate| estimate.position_rad)),
            supervisor: Supervisor::default(),
            way_back: None,
        }
    }

    /// Takes a command, or gives it back when the queue is full. A segment that does not join the last one is taken
    /// and latches a fault.
    pub fn accept(&self, state: &mut State, command: Command) -> Result<(), Command> {
        match command {
            Command::Arm => {
                state.player.reopen();
                state.supervisor.arm();
            }
            Command::Disarm => {
                state.supervisor.disarm();
                state.player.hold_if_started();
            }
            Command::Finish => state.player.finish(),
            Command::Append(_) if !state.player.has_room() => return Err(command),
            Command::Append(segment) => {
                if !self.in_range(&segment) || !state.player.append(segment) {
                    state.supervisor.trip(Fault::SetpointInvalid);
                }
            }
        }
        Ok(())
    }

    /// Whether both ends of a segment lie within the joints' limits.
    fn in_range(&self, segment: &Segment) -> bool {
        [0.0, f32::from(segment.ticks)].into_iter().all(|n| {
            let at = segment.sample(n);
            Joint::BOTH.iter().all(|&j| self.config.axes[j].limits.contains(at[j].position_rad))
        })
    }

    /// One tick. `measured` is what the encoders read at its start; the returned telemetry carries what to do until
    /// its end. The first tick after [`start`](Self::start) takes the same measurement.
    pub fn tick(&self, state: &mut State, measured: &PanTilt<Measurement>) -> Telemetry {
        self.observe(state, measured);
        let played = state.player.play();
        let situation = self.situation(state, &played);
        let clock = state.supervisor.tick(&self.config, &situation);
        let darkness = state.supervisor.darkness(&self.config, &situation);
        let estimates = *state.servo.estimates();
        let command_v = self.drive(state, &played);
        let telemetry = Telemetry {
            tick: state.tick,
            plan_tick: state.player.plan_tick(),
            measured: *measured,
            setpoint: played.setpoint,
            position_rad: estimates.map(|estimate| estimate.position_rad),
            velocity_rad_s: estimates.map(|estimate| estimate.velocity_rad_s),
            acceleration_rad_s2: estimates.map(|estimate| estimate.acceleration_rad_s2),
            actuation: Actuation { command_v, gate: darkness.is_empty() },
            darkness,
            phase: state.supervisor.phase,
            fault: state.supervisor.fault,
        };
        run_clock(&mut state.player, clock);
        state.tick = state.tick.wrapping_add(1);
        telemetry
    }

    fn observe(&self, state: &mut State, measured: &PanTilt<Measurement>) {
        if state.tick == 0 {
            return;
        }
        state.servo.observe(&self.config, measured);
        let (efforts, estimates) = (state.servo.efforts(), state.servo.estimates());
        if let Some(fault) = state.watch.tick(&self.config, efforts, estimates, measured) {
            state.supervisor.trip(fault);
        }
    }

    fn situation<'a>(&self, state: &State, played: &'a Played) -> Situation<'a> {
        let position_rad = state.servo.estimates().map(|estimate| estimate.position_rad);
        Situation {
            setpoint: &played.setpoint,
            segment: played.segment.as_ref(),
            position_rad,
            rate_rad_s: state.servo.estimates().map(|estimate| estimate.velocity_rad_s),
            error_rad: PanTilt::from_fn(|j| played.setpoint[j].position_rad - position_rad[j]),
            begun: state.player.has_begun(),
            starved: state.player.is_empty() && !state.player.is_done(),
            done: state.player.is_done(),
        }
    }

    /// Volts for this tick. With an encoder that lies there is nothing to control by: no volts.
    fn drive(&self, state: &mut State, played: &Played) -> PanTilt<f32> {
        let reference = self.reference(state, played);
        let blind = matches!(state.supervisor.fault, Some(Fault::EncoderDead | Fault::EncoderJumped));
        if blind { state.servo.coast() } else { state.servo.drive(&self.config, &reference) }
    }

    /// Where the loop is to go now and half a tick later: along the plan, or, when its clock stands, gently back to
    /// where it stands.
    fn reference(&self, state: &mut State, played: &Played) -> Reference {
        let stands = match state.supervisor.phase {
            Phase::Holding | Phase::Faulted => true,
            Phase::Dark | Phase::Armed => state.player.has_begun() && played.segment.is_some(),
            Phase::Tracing | Phase::Done => false,
        };
        if !stands {
            state.way_back = None;
            return Reference { now: played.setpoint, ahead: played.ahead };
        }
        let position_rad = state.servo.estimates().map(|estimate| estimate.position_rad);
        let kept = state.way_back.filter(|w| !w.is_lost(&self.config, position_rad));
        let mut way = kept.unwrap_or_else(|| {
            state.servo.forget();
            ReturnPath::from(state.servo.estimates())
        });
        let now = way.tick(&self.config, &played.setpoint);
        state.way_back = Some(way);
        Reference { now, ahead: now }
    }
}

fn run_clock(player: &mut Player, clock: Clock) {
    match clock {
        Clock::Run => player.advance(),
        Clock::Stop => player.hold(),
        Clock::Wait => {}
    }
}
