//! A simulated pan/tilt laser head.
//!
//! [`Plant`] is a [`tracelight_rig::Head`]: volts and gate in, counts out, once a tick. Behind that seam it steps the
//! nonlinear equations of motion with friction that truly sticks, quantizes what the encoders see, switches the
//! laser through a relay and knows where the beam really is. It never sees the controller.

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")
)]

mod belt;
mod camera;
mod config;
mod dice;
mod encoder;
mod foot;
mod friction;
mod gain;
mod light;
mod mechanism;
mod plant;
mod servo_joint;
mod step;
mod stepper_joint;
mod stops;
mod teeth;
mod wear;

pub use camera::{
    CameraConfig, Exposed, Image, Lamp, Laser, Part, Poster, Sensor, SimulatedCamera, SpotSample, Wall,
};
pub use config::{EncoderConfig, PlantConfig, RelayConfig};
pub use foot::{FootConfig, GyroscopeConfig};
pub use gain::Weakening;
pub use plant::Plant;
pub use servo_joint::{ServoDrive, ServoJoint};
pub use step::{JointState, Stepper};
pub use stepper_joint::{StepperDemand, StepperDrive, StepperJoint};
pub use teeth::LooseBelt;
pub use wear::Wear;
