//! One rig and at most one job, as somebody at the wall has them in hand.
//!
//! Whoever drives a rig, be it a terminal, a web page or a script, sends it [`Request`]s and lets it [`tick`](Session::tick). The session feeds the job's
//! segments, says in which [`State`] it is, and tells [`Event`]s.

mod event;
mod feed;
mod follow;
mod job;
mod outbox;
mod request;
mod running;
mod session;
mod state;
mod told;

pub use event::{Event, Snapshot, seconds};
pub use feed::{Feeder, Trim, Untrimmed};
pub use job::{Again, Job, Repeated, StrokeTicks};
pub use request::{Refused, Request, When, faster, slower};
pub use session::Session;
pub use state::{ARMED_TICKS, ATTENDED_TICKS, PAUSED_TICKS, State};
pub use told::{event_json, snapshot_json};
