use tracelight_rig::{
    Actuation, Command, Fault, Joint, Measurement, PanTilt, Phase, Segment, Setpoint, Telemetry,
};

use crate::Config;
use crate::law::{LawInput, LawState, command};
use crate::observer::Observer;
use crate::player::{Played, Player};
use crate::return_path::ReturnPath;
use crate::supervisor::{Clock, Situation, Supervisor};
use crate::watch::EncoderWatch;

/// The controller: its configuration, fixed at start.
#[derive(Clone, Copy, Debug)]
pub struct Controller {
    config: Config,
}

/// What the controller remembers from tick to tick.
#[derive(Clone, Copy, Debug)]
pub struct State {
    tick: u32,
    observer: Observer,
    watch: EncoderWatch,
    player: Player,
    supervisor: Supervisor,
    law: LawState,
    way_back: Option<ReturnPath>,
    /// Torque applied during the last tick, N m.
    torque_nm: PanTilt<f32>,
}

impl Controller {
    /// Takes a configuration as it is; whoever made it has checked it.
    pub const fn new(config: Config) -> Self {
        Self { config }
    }

    /// State of a head at rest whose encoders read `measured`: dark, disarmed, held where it is.
    pub fn start(&self, measured: &PanTilt<Measurement>) -> State {
        let observer = Observer::at_rest(&self.config, measured);
        State {
            tick: 0,
            observer,
            watch: EncoderWatch::new(measured),
            player: Player::resting_at(observer.position_rad(&self.config)),
            supervisor: Supervisor::default(),
            law: LawState::default(),
            way_back: None,
            torque_nm: PanTilt::default(),
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
        let Situation { position_rad, rate_rad_s: velocity_rad_s, .. } = situation;
        let command_v = self.drive(state, &played);
        let telemetry = Telemetry {
            tick: state.tick,
            plan_tick: state.player.plan_tick(),
            measured: *measured,
            setpoint: played.setpoint,
            position_rad,
            velocity_rad_s,
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
        state.observer.tick(&self.config, state.torque_nm, measured);
        let tilt = state.observer.position_rad(&self.config).tilt;
        let rate = state.observer.rate_rad_s();
        let terms = self.config.model.terms(tilt, rate);
        let effort = (state.torque_nm, rate);
        if let Some(fault) = state.watch.tick(&self.config, &terms, effort, measured) {
            state.supervisor.trip(fault);
        }
    }

    fn situation<'a>(&self, state: &State, played: &'a Played) -> Situation<'a> {
        let position_rad = state.observer.position_rad(&self.config);
        Situation {
            setpoint: &played.setpoint,
            segment: played.segment.as_ref(),
            position_rad,
            rate_rad_s: state.observer.rate_rad_s(),
            error_rad: PanTilt::from_fn(|j| played.setpoint[j].position_rad - position_rad[j]),
            begun: state.player.has_begun(),
            starved: state.player.is_empty() && !state.player.is_done(),
            done: state.player.is_done(),
        }
    }

    /// Volts for this tick. With an encoder that lies there is nothing to control by: no volts.
    fn drive(&self, state: &mut State, played: &Played) -> PanTilt<f32> {
        let position = state.observer.position_rad(&self.config);
        let rate = state.observer.rate_rad_s();
        let (setpoint, ahead) = self.reference(state, played, position, rate);
        let input = LawInput {
            ahead: &ahead,
            error_rad: PanTilt::from_fn(|j| setpoint[j].position_rad - position[j]),
            rate_error_rad_s: PanTilt::from_fn(|j| setpoint[j].velocity_rad_s - rate[j]),
        };
        let volts = command(&self.config, &mut state.law, &input);
        let blind = matches!(state.supervisor.fault, Some(Fault::EncoderDead | Fault::EncoderJumped));
        let volts = if blind { PanTilt::default() } else { volts };
        state.torque_nm = PanTilt::from_fn(|j: Joint| volts[j] * self.config.axes[j].torque_nm_per_v);
        volts
    }

    /// Where the loop is to go now and half a tick later: along the plan, or, when its clock stands, gently back to
    /// where it stands.
    fn reference(
        &self,
        state: &mut State,
        played: &Played,
        position_rad: PanTilt<f32>,
        rate_rad_s: PanTilt<f32>,
    ) -> (PanTilt<Setpoint>, PanTilt<Setpoint>) {
        let stands = match state.supervisor.phase {
            Phase::Holding | Phase::Faulted => true,
            Phase::Dark | Phase::Armed => state.player.has_begun() && played.segment.is_some(),
            Phase::Tracing | Phase::Done => false,
        };
        if !stands {
            state.way_back = None;
            return (played.setpoint, played.ahead);
        }
        let kept = state.way_back.filter(|w| !w.is_lost(&self.config, position_rad));
        let mut way = kept.unwrap_or_else(|| {
            state.law.reset();
            ReturnPath::from(position_rad, rate_rad_s)
        });
        let now = way.tick(&self.config, &played.setpoint);
        state.way_back = Some(way);
        (now, now)
    }
}

fn run_clock(player: &mut Player, clock: Clock) {
    match clock {
        Clock::Run => player.advance(),
        Clock::Stop => player.hold(),
        Clock::Wait => {}
    }
}
