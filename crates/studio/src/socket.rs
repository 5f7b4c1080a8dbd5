//! A page's line to the job that goes on: events one way, wishes and signs of life the other.

use std::sync::Arc;
use std::time::Duration;

use axum::extract::ws::{Message, WebSocket};
use serde::Deserialize;
use serde_json::json;
use tokio::sync::broadcast::Receiver;
use tokio::sync::broadcast::error::RecvError;
use tokio::sync::watch;

use crate::desk::Desk;
use crate::devices::Caller;

/// Longest message of a page, bytes.
pub(crate) const MOST_MESSAGE: usize = 1024;
/// How long a page may take to read what it is told.
pub(crate) const PATIENCE: Duration = Duration::from_secs(5);
/// How often is looked whether the operator is there.
const LOOK: Duration = Duration::from_millis(50);

/// What a page says.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Said {
    /// What it asks of the job.
    wish: Option<String>,
    /// Whether it says that it is there.
    #[serde(default)]
    here: bool,
}

/// Asks something of the job, for a page.
///
/// # Errors
/// Why that is refused.
pub(crate) fn ask(desk: &Desk, page: &str, wish: &str) -> Result<(), String> {
    let is_own = ["take", "refuse"].contains(&wish);
    if !is_own && !desk.program.knows(wish) {
        return Err(format!("{wish:?} is nothing that a job can be asked"));
    }
    if wish == "end" && desk.live.may_end(page) && !desk.live.has_begun() {
        // nobody hears wishes before the first tick
        desk.end();
        return Ok(());
    }
    desk.live.ask(page, wish)
}

/// Tells a page what happens, and hears it, until it leaves.
pub(crate) async fn serve_socket(desk: Arc<Desk>, (page, caller): (String, Caller), mut socket: WebSocket) {
    let Some(mut told) = joined(&desk, &mut socket).await else { return };
    let mut sent_away = caller.sent_away.clone();
    loop {
        tokio::select! {
            () = gone(&mut sent_away) => return,
            event = told.recv() => match event {
                Ok(event) => {
                    if say(&mut socket, event).await.is_none() {
                        return;
                    }
                }
                // it is told how things stand, as if it came just now
                Err(RecvError::Lagged(_)) => {
                    let Some(anew) = joined(&desk, &mut socket).await else { return };
                    told = anew;
                }
                Err(RecvError::Closed) => return,
            },
            said = socket.recv() => match said {
                Some(Ok(Message::Text(text))) => {
                    if let Some(answer) = hear(&desk, (&page, caller.operates()), &text)
                        && say(&mut socket, answer).await.is_none()
                    {
                        return;
                    }
                }
                Some(Ok(Message::Close(_)) | Err(_)) | None => return,
                Some(Ok(_)) => {}
            },
        }
    }
}

/// Tells a page how things stand; what it is told from then on, or nothing if it has left.
async fn joined(desk: &Desk, socket: &mut WebSocket) -> Option<Receiver<String>> {
    let (first, told) = desk.live.join();
    for event in first {
        say(socket, event).await?;
    }
    Some(told)
}

/// Sends a page something; nothing where it has left, or reads nothing any more.
async fn say(socket: &mut WebSocket, text: String) -> Option<()> {
    tokio::time::timeout(PATIENCE, socket.send(Message::Text(text.into()))).await.ok()?.ok()
}

/// Waits until a device is sent away; a page of this computer never is.
pub(crate) async fn gone(sent_away: &mut Option<watch::Receiver<bool>>) {
    match sent_away {
        // a device that nobody knows any more has left
        Some(sent_away) => drop(sent_away.wait_for(|is| *is).await),
        None => std::future::pending().await,
    }
}

/// Takes what a page said; what it is answered, if something is wrong with it.
fn hear(desk: &Desk, (page, operates): (&str, bool), text: &str) -> Option<String> {
    let refused = |why: String| Some(json!({ "event": "refused", "message": why }).to_string());
    let Ok(Said { wish, here }) = serde_json::from_str(text) else {
        return refused("a page says {\"wish\": WORD} or {\"here\": true}".to_owned());
    };
    if !operates && wish.as_deref().is_some_and(|wish| wish != "stop") {
        return refused("this device may look on and stop, nothing else".to_owned());
    }
    // who looks on is nobody's sign of life
    if operates && (here || wish.is_some()) {
        desk.live.hear(page);
    }
    wish.and_then(|wish| ask(desk, page, &wish).err()).and_then(refused)
}

/// Looks whether the operator of a job is there, for as long as it goes on.
pub(crate) async fn watch_operator(desk: Arc<Desk>) {
    while desk.live.is_on() {
        desk.live.look();
        tokio::time::sleep(LOOK).await;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::folder::Folder;
    use crate::program::{Performed, Program, Seat};
    use serde_json::Value;
    use tracelight_task::{Failure, Progress, Stop};

    /// A program that does nothing, and knows some wishes.
    struct Idle;

    impl Program for Idle {
        fn rigs(&self) -> Vec<String> {
            Vec::new()
        }

        fn look(
            &self,
            _: &[String],
            _: &Stop,
            _: &mut dyn FnMut(Vec<u8>, Value) -> bool,
        ) -> Result<(), Failure> {
            Ok(())
        }

        fn knows(&self, wish: &str) -> bool {
            ["arm", "go-on", "stop", "end", "speed=0.5"].contains(&wish)
        }

        fn perform(
            &self,
            _: &[String],
            _: Option<&dyn Seat>,
            _: (&dyn Progress, &Stop),
        ) -> Result<Performed, Failure> {
            Err(Failure::interrupted())
        }
    }

    #[test]
    fn whatever_a_page_says_is_taken_or_refused_and_who_looks_on_asks_nothing_but_to_stop() {
        let dir = std::env::temp_dir().join(format!("tracelight-socket-{}", std::process::id()));
        let desk = Desk::new(Box::new(Idle), Folder::open(&dir).unwrap());
        desk.live.begin("a", "trace");
        let seeds: [&[u8]; 6] = [
            br#"{"wish":"arm"}"#,
            br#"{"wish":"go-on","here":true}"#,
            br#"{"here":true}"#,
            br#"{"wish":"stop"}"#,
            br#"{"wish":"speed=0.5"}"#,
            br#"{"wish":"take","here":false}"#,
        ];
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        let mut random = |below: usize| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            usize::try_from(state >> 33).unwrap() % below
        };
        // for longer where somebody asks for that
        let longer_s =
            std::env::var("TRACELIGHT_FUZZ_S").ok().and_then(|text| text.parse().ok()).unwrap_or(0);
        let began = std::time::Instant::now();
        for count in 0_u64.. {
            if count >= 100_000 && began.elapsed().as_secs() >= longer_s {
                break;
            }
            let mut bytes = seeds[random(seeds.len())].to_vec();
            for _ in 0..random(4) {
                let at = random(bytes.len());
                match random(3) {
                    0 => bytes[at] = u8::try_from(random(256)).unwrap(),
                    1 => drop(bytes.remove(at)),
                    _ => bytes.extend_from_slice(seeds[random(seeds.len())]),
                }
                if bytes.is_empty() {
                    break;
                }
            }
            let text = String::from_utf8_lossy(&bytes);
            let said = serde_json::from_str::<Value>(&text);
            let answer = hear(&desk, ("b", false), &text);
            while let Some(wish) = desk.live.wish() {
                assert_eq!(wish, "stop", "{text}");
                assert_eq!(said.as_ref().unwrap()["wish"], "stop", "{text}");
            }
            // what is no message is answered
            assert!(said.is_ok() || answer.is_some(), "{text}");
            let _ = hear(&desk, ("a", true), &text);
            while let Some(wish) = desk.live.wish() {
                assert!(desk.program.knows(&wish), "{text}");
            }
        }
        std::fs::remove_dir_all(dir).unwrap();
    }
}
