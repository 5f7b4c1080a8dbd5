//! Questions by HTTP: how long is waited for an answer, how much of it is taken, and who may give it.
//!
//! Images of a room go from the camera that was named to this machine: through no proxy that the environment names, and from no other host.

use std::io::{self, Read};
use std::time::{Duration, Instant};

use tracelight_eye::MOST_IMAGE_BYTES;
use ureq::http::{Response, header::LOCATION};
use ureq::{Agent, Body, Error, Timeout};

use crate::latest::PATIENCE;
use crate::redirect;
use crate::shown::shown;

/// Largest image that is taken, bytes.
pub(crate) const MOST_BYTES: u64 = MOST_IMAGE_BYTES as u64;
/// Most redirects one after the other.
const MOST_REDIRECTS: usize = 3;

/// How long a camera is waited for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// For its name, for a connection, and for the head of an answer, each.
    pub(crate) patience: Duration,
    /// For an image, from the question to its last byte; for the head of a stream, redirects counted.
    pub(crate) whole: Duration,
    /// For the next byte of a stream.
    pub(crate) silence: Duration,
}

impl Limits {
    /// Slow wireless cameras take seconds for a large image, and their streams falter for seconds while nobody looks.
    pub(crate) const USUAL: Self =
        Self { patience: PATIENCE, whole: Duration::from_secs(10), silence: Duration::from_secs(10) };

    /// Why there is no answer, or none to its end.
    fn words(self, error: &Error) -> String {
        let within = |what: &str, time: Duration| format!("{what} within {} s", time.as_secs_f64());
        match error {
            Error::Timeout(Timeout::Resolve) => within("its name was not found", self.patience),
            Error::Timeout(Timeout::Connect) => {
                within("no connection", self.patience) + ": is it switched on, and is that its address?"
            }
            Error::Timeout(Timeout::SendRequest | Timeout::RecvResponse) => {
                within("it did not answer", self.patience)
            }
            Error::Timeout(Timeout::PerRead) => within("its stream stopped: nothing came", self.silence),
            Error::Timeout(_) => within("it sent no whole image", self.whole),
            Error::Io(e) if e.kind() == io::ErrorKind::UnexpectedEof => {
                "its answer ended before it was whole".to_owned()
            }
            other => other.to_string(),
        }
    }
}

/// What of an answer has to come in time.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Bounded {
    /// Its head: what follows may be a stream.
    Head,
    /// All of it.
    Image,
}

/// A camera's address, and how it is asked.
pub(crate) struct Net {
    url: String,
    agent: Agent,
    limits: Limits,
}

/// What a camera answered: the kind of it, and the rest.
pub(crate) struct Answer {
    pub(crate) kind: String,
    pub(crate) body: Told,
}

impl Net {
    pub(crate) fn new(url: &str, limits: Limits) -> Self {
        let config = Agent::config_builder()
            .proxy(None)
            // followed here, within the host
            .max_redirects(0)
            .max_redirects_will_error(false)
            // small cameras say that they keep a connection, and close it: the next question would meet a reset
            .max_idle_connections(0)
            .timeout_per_read(Some(limits.silence));
        Self { url: url.to_owned(), agent: config.build().into(), limits }
    }

    /// The address as it may be shown: without a password.
    pub(crate) fn shown(&self) -> String {
        shown(&self.url)
    }

    /// An answer whose body may go on for ever.
    ///
    /// # Errors
    /// Why there is none, in words.
    pub(crate) fn open(&self) -> Result<Answer, String> {
        let answer = self.ask(Bounded::Head)?;
        let kind = kind_of(&answer);
        Ok(Answer { kind, body: Told { from: answer.into_body().into_reader(), limits: self.limits } })
    }

    /// One image, whole.
    ///
    /// # Errors
    /// Why there is none, in words.
    pub(crate) fn image(&self) -> Result<Vec<u8>, String> {
        let answer = self.ask(Bounded::Image)?;
        let kind = kind_of(&answer);
        if !kind.starts_with("image/") {
            return Err(format!("it sent {kind} this time, and no image"));
        }
        if let Some(length) = answer.body().content_length().filter(|length| *length > MOST_BYTES) {
            return Err(format!("its image has {length} bytes, at most {MOST_BYTES} are taken"));
        }
        let mut bytes = Vec::new();
        // a byte more tells one that is too large from one that just is not
        let mut body = answer.into_body().into_reader().take(MOST_BYTES + 1);
        body.read_to_end(&mut bytes).map_err(|e| self.limits.words(&e.into()))?;
        if bytes.len() as u64 > MOST_BYTES {
            return Err(format!("its image has more than {MOST_BYTES} bytes, the most that are taken"));
        }
        Ok(bytes)
    }

    fn ask(&self, bounded: Bounded) -> Result<Response<Body>, String> {
        let until = Instant::now() + self.limits.whole;
        let mut url = self.url.clone();
        for _ in 0..=MOST_REDIRECTS {
            let answer = self.ask_once(&url, bounded, until)?;
            if !answer.status().is_redirection() {
                return Ok(answer);
            }
            let place = answer.headers().get(LOCATION).and_then(|place| place.to_str().ok());
            let status = answer.status().as_u16();
            url = redirect::target(
                &url,
                place.ok_or_else(|| format!("it redirects (status {status}) and does not say where to"))?,
            )?;
        }
        Err(format!("it redirects more than {MOST_REDIRECTS} times, and would next to {}", shown(&url)))
    }

    fn ask_once(&self, url: &str, bounded: Bounded, until: Instant) -> Result<Response<Body>, String> {
        let left = until.saturating_duration_since(Instant::now());
        let patience = Some(self.limits.patience.min(left));
        let request = self.agent.get(url).config();
        let request = request.timeout_resolve(patience).timeout_connect(patience);
        let request = request.timeout_send_request(patience).timeout_recv_response(patience);
        let whole = (bounded == Bounded::Image).then_some(left);
        let answer = request.timeout_global(whole).build().call();
        answer.map_err(|error| match error {
            Error::Timeout(_) if Instant::now() >= until && bounded == Bounded::Head => {
                format!(
                    "it did not answer within {} s, its redirects counted",
                    self.limits.whole.as_secs_f64()
                )
            }
            error => self.limits.words(&error),
        })
    }
}

/// What an answer says it is.
fn kind_of(answer: &Response<Body>) -> String {
    let kind = answer.headers().get("content-type").and_then(|kind| kind.to_str().ok());
    kind.unwrap_or("something of no kind that it tells").to_owned()
}

/// The body of an answer, its errors told in words.
pub(crate) struct Told {
    from: ureq::BodyReader<'static>,
    limits: Limits,
}

impl Read for Told {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let limits = self.limits;
        self.from.read(to).map_err(|e| io::Error::new(e.kind(), limits.words(&e.into())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_took_too_long_is_told_with_its_bound() {
        let check = |timeout, what: &str| assert_eq!(Limits::USUAL.words(&Error::Timeout(timeout)), what);
        check(Timeout::Resolve, "its name was not found within 5 s");
        check(Timeout::Connect, "no connection within 5 s: is it switched on, and is that its address?");
        check(Timeout::RecvResponse, "it did not answer within 5 s");
        check(Timeout::PerRead, "its stream stopped: nothing came within 10 s");
        check(Timeout::Global, "it sent no whole image within 10 s");
    }
}
