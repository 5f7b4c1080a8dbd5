//! The 2006 report's block diagram, run as it stands there: a controller in continuous time for each joint, a cap on its torque, the
//! nonlinear head, and in the way back a quantizer and a hold.

use tracelight_linear::{Discretization, LinearError, Matrix, StateSpace, Zpk};
use tracelight_plant::{GyroscopeConfig, JointState, Wear};
use tracelight_rig::{Joint, PanTilt, TICK_F64_S};

use crate::{Model, MotionArray};

/// Steps in a tick: head and controllers are stepped together, each 0.1 ms.
const STEPS: usize = 10;

/// Blocks and what is in them.
#[derive(Clone, Debug)]
pub struct Diagram {
    /// The head.
    pub head: Model,
    /// From error, rad, to torque at the joint, N m; in continuous time, with as many poles as zeros at least. Stepped by Tustin's
    /// rule.
    pub controllers: PanTilt<Zpk>,
    /// Largest torque, N m.
    pub cap_nm: PanTilt<f64>,
    /// Width of a quantum of the angle, rad; none passes it on as it is.
    pub quantum_rad: Option<f64>,
    /// Ticks for which the fed-back angle is held; `None` feeds it back at once.
    pub hold_ticks: Option<usize>,
}

/// A tick of a simulation, as its scopes show it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScopeTick {
    /// Where the joints should be, rad.
    pub set_rad: PanTilt<f64>,
    /// Where they are, rad.
    pub angle_rad: PanTilt<f64>,
    /// Motor command, as torque at the joint, N m.
    pub torque_nm: PanTilt<f64>,
}

impl Diagram {
    /// Follows an array from rest where it begins, and stays at its end for `rest_s`; a row a millisecond.
    pub fn follow(&self, array: &MotionArray, rest_s: f64) -> Result<Vec<ScopeTick>, LinearError> {
        let step_s = TICK_F64_S / STEPS as f64;
        let start = array.start_rad();
        let stepper = self.head.plant_config(GyroscopeConfig::NONE, Wear::NONE).stepper(PanTilt::default());
        let mut controllers = PanTilt::new(
            Block::new(&self.controllers.pan, step_s)?,
            Block::new(&self.controllers.tilt, step_s)?,
        );
        let mut state = JointState { angle_rad: start, rate_rad_s: PanTilt::default() };
        let mut held = state.angle_rad.map(|angle| self.quantized(angle));
        let hold_steps = self.hold_ticks.map_or(1, |ticks| ticks * STEPS);
        let ticks = ((array.length_s() + rest_s) / TICK_F64_S).round() as usize;
        let mut seen = Vec::with_capacity(ticks + 1);
        for step in 0..=ticks * STEPS {
            if step % hold_steps == 0 {
                held = state.angle_rad.map(|angle| self.quantized(angle));
            }
            let set_rad = array.at(step as f64 * step_s).map(|motion| motion.position_rad);
            let torque_nm = PanTilt::from_fn(|j: Joint| {
                let cap = self.cap_nm[j];
                controllers[j].next(set_rad[j] - held[j]).clamp(-cap, cap)
            });
            if step % STEPS == 0 {
                seen.push(ScopeTick { set_rad, angle_rad: state.angle_rad, torque_nm });
            }
            stepper.step(&mut state, torque_nm, step_s);
        }
        Ok(seen)
    }

    fn quantized(&self, angle_rad: f64) -> f64 {
        self.quantum_rad.map_or(angle_rad, |quantum| quantum * (angle_rad / quantum).round())
    }
}

/// A controller, stepped.
#[derive(Clone, Debug)]
struct Block {
    system: StateSpace,
    state: Matrix,
}

impl Block {
    fn new(controller: &Zpk, step_s: f64) -> Result<Self, LinearError> {
        let system = controller.state_space()?.sampled(step_s, Discretization::Tustin(None))?;
        let state = Matrix::zeros(system.order(), 1);
        Ok(Self { system, state })
    }

    /// What comes out now, given what goes in until the next step.
    fn next(&mut self, input: f64) -> f64 {
        let output = (self.system.c() * &self.state).sum() + self.system.d()[(0, 0)] * input;
        self.state = self.system.a() * &self.state + self.system.b() * input;
        output
    }
}

#[cfg(test)]
mod tests {
    use tracelight_dynamics::{Friction, HeadBodies};
    use tracelight_linear::{Time, TransferFunction};

    use super::*;
    use crate::{Between, RigConfig};

    fn controller(text: &str) -> Zpk {
        TransferFunction::parse(text, Time::Continuous).unwrap().zpk()
    }

    fn diagram(quantum_rad: Option<f64>, hold_ticks: Option<usize>) -> Diagram {
        let mut head = RigConfig::report().model;
        head.bodies = HeadBodies { gravity_m_s2: 0.0, ..HeadBodies::set_a() };
        let viscous = Friction::symmetric(0.01, 0.0);
        head.friction = PanTilt::new(viscous, viscous);
        let both = controller("20 + 2 s/(1 + s/400)");
        Diagram {
            head,
            controllers: PanTilt::new(both.clone(), both),
            cap_nm: PanTilt::new(1e9, 1e9),
            quantum_rad,
            hold_ticks,
        }
    }

    /// A jump of a hundredth of a radian, too small for anything but the linear model to matter.
    fn jump() -> MotionArray {
        let to = PanTilt::new(0.01, 0.0);
        MotionArray::new(&[(0.0, PanTilt::default()), (1e-6, to), (1.0, to)], Between::Lines).unwrap()
    }

    #[test]
    fn without_quantizer_and_hold_it_is_the_linear_loop() {
        let ticks = diagram(None, None).follow(&jump(), 0.0).unwrap();
        let inertia = HeadBodies::set_a().lumped().mass(0.0).own_inertia().pan;
        let plant =
            TransferFunction::parse(&format!("1/({inertia} s^2 + 0.01 s)"), Time::Continuous).unwrap();
        let loop_gain = diagram(None, None).controllers.pan.transfer().series(&plant).unwrap();
        let closed = loop_gain.closed().unwrap().step_response(1e-3, ticks.len()).unwrap();
        for (k, (tick, linear)) in ticks.iter().zip(&closed.values).enumerate().skip(1) {
            let off = tick.angle_rad.pan / 0.01 - linear;
            assert!(off.abs() < 3e-3, "{k}: {} {linear}", tick.angle_rad.pan / 0.01);
        }
    }

    #[test]
    fn a_hold_and_a_quantizer_are_seen() {
        let plain = diagram(None, None).follow(&jump(), 0.0).unwrap();
        let held = diagram(None, Some(20)).follow(&jump(), 0.0).unwrap();
        let most = |ticks: &[ScopeTick]| ticks.iter().map(|t| t.angle_rad.pan).fold(0.0, f64::max);
        assert!(most(&held) > 1.05 * most(&plain), "a hold costs phase: {} {}", most(&held), most(&plain));
        let quantum = 1.5e-3;
        let coarse = diagram(Some(quantum), Some(1)).follow(&jump(), 1.0).unwrap();
        let last = coarse.last().unwrap().angle_rad.pan;
        assert!((last - 0.01).abs() < quantum && (last - 0.01).abs() > 1e-5, "{last}");
    }

    #[test]
    fn torque_is_capped() {
        let mut diagram = diagram(None, None);
        diagram.cap_nm.pan = 0.05;
        let ticks = diagram.follow(&jump(), 0.0).unwrap();
        assert!(ticks.iter().all(|t| t.torque_nm.pan.abs() <= 0.05));
    }
}
