//! Devices on the same network: which are invited, which have joined, and what each may do.
//!
//! ```text
//! a page of this computer ─ invites ─► a secret for one device, ten minutes ─ as a QR code ─► a phone ─ joins ─► a secret of its own, in a cookie
//! ```
//!
//! Nothing of it outlives the program: after it is started anew, devices are invited anew.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use tokio::sync::watch;

/// How long an invitation holds.
pub(crate) const INVITED: Duration = Duration::from_secs(600);
/// How long a device that asks nothing stays joined.
const AWAY: Duration = Duration::from_secs(24 * 3600);
/// Invitations that hold at once; the oldest gives way.
const MOST_INVITED: usize = 8;
/// Devices that have joined at once; the one that has been away longest gives way.
const MOST_JOINED: usize = 64;
/// Letters of a device's name.
const MOST_LETTERS: usize = 40;

/// What a device may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Role {
    /// Whatever a page of this computer may.
    Operator,
    /// Look on, and stop.
    Viewer,
}

/// What nobody can guess: 128 bits.
#[derive(Clone, Copy)]
pub(crate) struct Secret([u8; 16]);

impl Secret {
    /// A new one; `None` where the system gives no random numbers.
    fn new() -> Option<Self> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes).ok().map(|()| Self(bytes))
    }

    pub(crate) fn hex(self) -> String {
        self.0.iter().map(|byte| format!("{byte:02x}")).collect()
    }

    fn read(text: &str) -> Option<Self> {
        let is_hex = text.len() == 32 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
        let number = is_hex.then(|| u128::from_str_radix(text, 16).ok()).flatten()?;
        Some(Self(number.to_be_bytes()))
    }

    /// Looks at every byte, whichever differs first: how long that takes tells nothing.
    fn is(self, other: Self) -> bool {
        self.0.iter().zip(other.0).fold(0, |differs, (one, other)| differs | (one ^ other)) == 0
    }
}

struct Invitation {
    secret: Secret,
    role: Role,
    until: Instant,
}

struct Device {
    id: u64,
    secret: Secret,
    name: String,
    role: Role,
    seen: Instant,
    /// Closes its lines when it is sent away.
    sent_away: watch::Sender<bool>,
}

/// Somebody who asks.
#[derive(Clone)]
pub(crate) struct Caller {
    /// What he may; nothing of a device that has not joined.
    pub(crate) role: Option<Role>,
    /// A page of this computer.
    pub(crate) is_local: bool,
    /// The device's number; 0 of this computer.
    pub(crate) device: u64,
    /// Tells when the device is sent away.
    pub(crate) sent_away: Option<watch::Receiver<bool>>,
}

impl Caller {
    /// A page of this computer.
    pub(crate) const LOCAL: Self =
        Self { role: Some(Role::Operator), is_local: true, device: 0, sent_away: None };

    /// Whether he may do more than look on.
    pub(crate) fn operates(&self) -> bool {
        self.role == Some(Role::Operator)
    }
}

/// All of them.
#[derive(Default)]
pub(crate) struct Devices(Mutex<State>);

#[derive(Default)]
struct State {
    invited: Vec<Invitation>,
    joined: Vec<Device>,
    next: u64,
}

impl Devices {
    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Invites one device; what it joins by, or nothing where the system gives no random numbers.
    pub(crate) fn invite(&self, role: Role) -> Option<Secret> {
        let secret = Secret::new()?;
        let mut state = self.state();
        let now = Instant::now();
        state.invited.retain(|one| one.until > now);
        if state.invited.len() >= MOST_INVITED {
            state.invited.remove(0);
        }
        state.invited.push(Invitation { secret, role, until: now + INVITED });
        Some(secret)
    }

    /// Takes a device in that was invited, once; its own secret from then on, and what it may do.
    pub(crate) fn join(&self, invitation: &str, name: &str) -> Option<(Secret, Role)> {
        let asked = Secret::read(invitation)?;
        let mut state = self.state();
        let now = Instant::now();
        let at = state.invited.iter().position(|one| one.secret.is(asked) && one.until > now)?;
        let secret = Secret::new()?;
        let role = state.invited.remove(at).role;
        let plain = |c: &char| !c.is_control();
        let name: String = name.trim().chars().filter(plain).take(MOST_LETTERS).collect();
        let name = if name.is_empty() { "a device".to_owned() } else { name };
        state.joined.retain(|device| device.seen.elapsed() < AWAY);
        if state.joined.len() >= MOST_JOINED {
            let longest = state.joined.iter().enumerate().min_by_key(|(_, device)| device.seen);
            let longest = longest.map_or(0, |(at, _)| at);
            let _ = state.joined.remove(longest).sent_away.send(true);
        }
        state.next += 1;
        let id = state.next;
        state.joined.push(Device { id, secret, name, role, seen: now, sent_away: watch::Sender::new(false) });
        Some((secret, role))
    }

    /// Who asks with that secret.
    pub(crate) fn caller(&self, secret: Option<&str>) -> Caller {
        let nobody = Caller { role: None, is_local: false, device: 0, sent_away: None };
        let Some(secret) = secret.and_then(Secret::read) else { return nobody };
        let mut state = self.state();
        let known = state.joined.iter_mut().find(|device| device.secret.is(secret));
        let Some(device) = known.filter(|device| device.seen.elapsed() < AWAY) else { return nobody };
        device.seen = Instant::now();
        let sent_away = Some(device.sent_away.subscribe());
        Caller { role: Some(device.role), is_local: false, device: device.id, sent_away }
    }

    /// Sends a device away; whether there was one of that number.
    pub(crate) fn send_away(&self, id: u64) -> bool {
        let mut state = self.state();
        let Some(at) = state.joined.iter().position(|device| device.id == id) else { return false };
        let _ = state.joined.remove(at).sent_away.send(true);
        true
    }

    /// For pages.
    pub(crate) fn json(&self) -> Value {
        let told = |device: &Device| {
            json!({
                "id": device.id, "name": device.name, "role": device.role,
                "lines": device.sent_away.receiver_count(), "seen_s": device.seen.elapsed().as_secs(),
            })
        };
        self.state().joined.iter().map(told).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_invitation_is_for_one_device_and_runs_out() {
        let devices = Devices::default();
        let secret = devices.invite(Role::Viewer).unwrap().hex();
        assert!(devices.join(&"0".repeat(32), "").is_none() && devices.join("", "").is_none());
        let (own, role) = devices.join(&secret, " a phone\n ").unwrap();
        assert_eq!((role, &devices.json()[0]["name"]), (Role::Viewer, &json!("a phone")));
        assert!(devices.join(&secret, "").is_none(), "it is used up");
        assert!(devices.caller(Some(&secret)).role.is_none(), "an invitation is no device");
        let caller = devices.caller(Some(&own.hex()));
        assert!(caller.role == Some(Role::Viewer) && !caller.operates() && !caller.is_local);
        assert!(devices.caller(None).role.is_none());
        let late = devices.invite(Role::Operator).unwrap().hex();
        devices.state().invited[0].until = Instant::now();
        assert!(devices.join(&late, "").is_none(), "it has run out");
    }

    #[test]
    fn a_device_that_is_sent_away_or_away_for_a_day_is_nobody() {
        let devices = Devices::default();
        let join = || {
            let secret = devices.invite(Role::Operator).unwrap();
            devices.join(&secret.hex(), "").unwrap().0.hex()
        };
        let (one, other) = (join(), join());
        let line = devices.caller(Some(&one)).sent_away.unwrap();
        assert!(devices.send_away(1) && !devices.send_away(1));
        assert!(*line.borrow() && devices.caller(Some(&one)).role.is_none());
        assert!(devices.caller(Some(&other)).operates());
        devices.state().joined[0].seen = Instant::now() - AWAY;
        assert!(devices.caller(Some(&other)).role.is_none());
    }

    #[test]
    fn no_number_of_devices_fills_the_memory() {
        let devices = Devices::default();
        for _ in 0..3 * MOST_JOINED {
            devices.invite(Role::Viewer).unwrap();
            let secret = devices.invite(Role::Viewer).unwrap();
            devices.join(&secret.hex(), "").unwrap();
        }
        assert_eq!(devices.state().invited.len(), MOST_INVITED - 1);
        assert_eq!(devices.state().joined.len(), MOST_JOINED);
    }
}
