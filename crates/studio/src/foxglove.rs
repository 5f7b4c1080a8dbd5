//! What happens, for Foxglove and programs like it: a WebSocket that speaks its protocol, to be read only.
//!
//! ```text
//! job ─ events ─► Live ─► messages by channel ─► who has subscribed to it        plan ─► /plan, /asked
//! ```

use std::collections::HashMap;
use std::sync::Arc;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use axum::extract::ws::{Message, WebSocket};
use serde::Deserialize;
use serde_json::{Value, json};
use tokio::sync::broadcast::error::RecvError;

use crate::desk::Desk;
use crate::devices::Caller;
use crate::points::Drawn;
use crate::socket::{PATIENCE, gone};

/// Subprotocols: of what is said here both have the same form.
pub(crate) const PROTOCOLS: [&str; 2] = ["foxglove.sdk.v1", "foxglove.websocket.v1"];
/// Longest message of who reads, bytes.
pub(crate) const MOST_MESSAGE: usize = 1 << 14;
/// Subscriptions of one who reads.
const MOST_SUBSCRIPTIONS: usize = 64;
/// What a binary message holds that has data of a channel.
const DATA: u8 = 1;
/// The frame in which all places are: the target's.
const FRAME: &str = "target";
/// Points of a plan that are shown at most.
const MOST_POINTS: usize = 20_000;

/// What is told, each with a schema of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Channel {
    /// How far the job is.
    Progress,
    /// What happens, in words.
    Log,
    /// What a camera has seen of the light.
    Seen,
    /// The lit strokes of the job.
    Plan,
    /// Where the spot is asked to be.
    Asked,
}

impl Channel {
    const ALL: [Self; 5] = [Self::Progress, Self::Log, Self::Seen, Self::Plan, Self::Asked];

    const fn id(self) -> u32 {
        self as u32 + 1
    }

    fn of(id: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|channel| channel.id() == id)
    }

    const fn topic(self) -> &'static str {
        match self {
            Self::Progress => "/progress",
            Self::Log => "/log",
            Self::Seen => "/seen",
            Self::Plan => "/plan",
            Self::Asked => "/asked",
        }
    }

    const fn schema_name(self) -> &'static str {
        match self {
            Self::Progress => "tracelight.Progress",
            Self::Log => "foxglove.Log",
            Self::Seen => "tracelight.Seen",
            Self::Plan => "foxglove.SceneUpdate",
            Self::Asked => "foxglove.PoseInFrame",
        }
    }

    /// Fields that people plot or show; of Foxglove's own kinds it knows the rest.
    fn schema(self) -> Value {
        let numbers = |names: &[&str]| -> Value {
            let all = names.iter().map(|name| ((*name).to_owned(), json!({ "type": "number" })));
            json!({ "type": "object", "properties": all.collect::<serde_json::Map<_, _>>() })
        };
        let time = json!({ "type": "object", "title": "time", "properties": { "sec": { "type": "integer" }, "nsec": { "type": "integer" } } });
        match self {
            Self::Progress => {
                let mut schema = numbers(&[
                    "t_s",
                    "plan_s",
                    "of_s",
                    "stroke",
                    "strokes",
                    "laps",
                    "speed",
                    "armed_s",
                    "late_ticks",
                    "latest_ms",
                ]);
                schema["properties"]["state"] = json!({ "type": "string" });
                schema["properties"]["gate"] = json!({ "type": "boolean" });
                schema
            }
            Self::Seen => {
                numbers(&["x_mm", "y_mm", "asked_x_mm", "asked_y_mm", "off_mm", "rms_mm", "images"])
            }
            Self::Log => {
                let text = json!({ "type": "string" });
                json!({ "type": "object", "properties": { "timestamp": time, "level": { "type": "integer" }, "message": text, "name": text, "file": text, "line": { "type": "integer" } } })
            }
            Self::Plan => {
                json!({ "type": "object", "properties": { "deletions": { "type": "array", "items": { "type": "object" } }, "entities": { "type": "array", "items": { "type": "object" } } } })
            }
            Self::Asked => {
                json!({ "type": "object", "properties": { "timestamp": time, "frame_id": { "type": "string" }, "pose": { "type": "object", "properties": { "position": numbers(&["x", "y", "z"]), "orientation": numbers(&["x", "y", "z", "w"]) } } } })
            }
        }
    }

    fn advertised(self) -> Value {
        json!({
            "id": self.id(), "topic": self.topic(), "encoding": "json", "schemaName": self.schema_name(),
            "schema": self.schema().to_string(), "schemaEncoding": "jsonschema",
        })
    }
}

/// What who reads says.
#[derive(Debug, PartialEq, Eq, Deserialize)]
#[serde(tag = "op", rename_all = "camelCase")]
enum Said {
    Subscribe {
        subscriptions: Vec<Subscription>,
    },
    #[serde(rename_all = "camelCase")]
    Unsubscribe {
        subscription_ids: Vec<u32>,
    },
}

#[derive(Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Subscription {
    id: u32,
    channel_id: u32,
}

/// One who reads.
struct Reader {
    socket: WebSocket,
    subscriptions: Vec<(u32, Channel)>,
    /// What was told last of each channel: who subscribes later is told that first.
    last: HashMap<Channel, String>,
}

impl Reader {
    /// Sends something; nothing where he has left, or reads nothing any more.
    async fn send(&mut self, message: Message) -> Option<()> {
        tokio::time::timeout(PATIENCE, self.socket.send(message)).await.ok()?.ok()
    }

    async fn say(&mut self, said: Value) -> Option<()> {
        self.send(Message::Text(said.to_string().into())).await
    }

    /// Tells what happens on a channel.
    async fn tell(&mut self, channel: Channel, data: String) -> Option<()> {
        let ids: Vec<u32> =
            self.subscriptions.iter().filter(|(_, of)| *of == channel).map(|(id, _)| *id).collect();
        for id in ids {
            self.send(Message::Binary(framed(id, &data).into())).await?;
        }
        self.last.insert(channel, data);
        Some(())
    }

    async fn tell_event(&mut self, desk: &Desk, event: &str) -> Option<()> {
        for (channel, data) in messages(event, desk.drawn().as_ref()) {
            self.tell(channel, data.to_string()).await?;
        }
        Some(())
    }

    /// Takes what he says; what he is told where something is wrong with it.
    async fn hear(&mut self, text: &str) -> Option<()> {
        let warning = |message: String| json!({ "op": "status", "level": 1, "message": message });
        match serde_json::from_str(text) {
            Ok(Said::Subscribe { subscriptions }) => {
                for Subscription { id, channel_id } in subscriptions {
                    let Some(channel) = Channel::of(channel_id) else {
                        self.say(warning(format!("there is no channel {channel_id}"))).await?;
                        continue;
                    };
                    if self.subscriptions.len() >= MOST_SUBSCRIPTIONS {
                        return self
                            .say(warning(format!(
                                "more than {MOST_SUBSCRIPTIONS} subscriptions are too many"
                            )))
                            .await;
                    }
                    self.subscriptions.retain(|(of, _)| *of != id);
                    self.subscriptions.push((id, channel));
                    if let Some(last) = self.last.get(&channel) {
                        let last = framed(id, last);
                        self.send(Message::Binary(last.into())).await?;
                    }
                }
            }
            Ok(Said::Unsubscribe { subscription_ids }) => {
                self.subscriptions.retain(|(id, _)| !subscription_ids.contains(id));
            }
            Err(_) => {
                self.say(warning(
                    "this server is read: subscribe and unsubscribe are all that it takes".to_owned(),
                ))
                .await?;
            }
        }
        Some(())
    }
}

/// Tells who reads what happens, until he leaves.
pub(crate) async fn serve_foxglove(desk: Arc<Desk>, caller: Caller, socket: WebSocket) {
    let mut reader = Reader { socket, subscriptions: Vec::new(), last: HashMap::new() };
    // there is nothing to be told to who has left
    let _ = served(&desk, caller, &mut reader).await;
}

async fn served(desk: &Desk, caller: Caller, reader: &mut Reader) -> Option<()> {
    let info = json!({
        "op": "serverInfo", "name": "tracelight studio", "capabilities": [], "supportedEncodings": ["json"], "metadata": {},
        "sessionId": format!("{}", since_1970().as_millis()),
    });
    reader.say(info).await?;
    reader.say(json!({ "op": "advertise", "channels": Channel::ALL.map(Channel::advertised) })).await?;
    let (first, mut told) = desk.live.join();
    for event in first {
        reader.tell_event(desk, &event).await?;
    }
    let mut sent_away = caller.sent_away.clone();
    loop {
        tokio::select! {
            () = gone(&mut sent_away) => return None,
            event = told.recv() => match event {
                Ok(event) => reader.tell_event(desk, &event).await?,
                // he reads slower than things happen: what was lost is not told
                Err(RecvError::Lagged(_)) => {}
                Err(RecvError::Closed) => return None,
            },
            said = reader.socket.recv() => match said {
                Some(Ok(Message::Text(text))) => reader.hear(&text).await?,
                Some(Ok(Message::Close(_)) | Err(_)) | None => return None,
                Some(Ok(_)) => {}
            },
        }
    }
}

fn since_1970() -> Duration {
    SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default()
}

fn time() -> Value {
    let now = since_1970();
    json!({ "sec": now.as_secs(), "nsec": now.subsec_nanos() })
}

/// Data of a channel as a binary message: what it is, whose subscription, when, and the data.
fn framed(id: u32, data: &str) -> Vec<u8> {
    let now = u64::try_from(since_1970().as_nanos()).unwrap_or(u64::MAX);
    let mut bytes = vec![DATA];
    bytes.extend(id.to_le_bytes());
    bytes.extend(now.to_le_bytes());
    bytes.extend(data.as_bytes());
    bytes
}

/// What an event of the job is on each channel; the plan is that of what is drawn, where it is known.
fn messages(event: &str, drawn: Option<&Drawn>) -> Vec<(Channel, Value)> {
    let Ok(mut event) = serde_json::from_str::<Value>(event) else { return Vec::new() };
    let name = event["event"].take();
    if let Some(event) = event.as_object_mut() {
        event.remove("event");
    }
    match name.as_str().unwrap_or_default() {
        "progress" => {
            let at = event["plan_s"].as_f64().zip(drawn).and_then(|(plan_s, drawn)| drawn.at(plan_s));
            let asked = at.map(|[x, y]| (Channel::Asked, pose(x, y)));
            std::iter::once((Channel::Progress, event)).chain(asked).collect()
        }
        "seen" => vec![(Channel::Seen, event)],
        "begun" => {
            let plan = (Channel::Plan, scene(drawn));
            vec![plan, (Channel::Log, log(2, "a job begins, dark"))]
        }
        "live" if event["on"] == true => vec![(Channel::Plan, scene(drawn))],
        "over" => vec![(Channel::Log, log(2, "the job is over"))],
        "state" => {
            let message = format!(
                "{} → {}",
                event["from"].as_str().unwrap_or("?"),
                event["to"].as_str().unwrap_or("?")
            );
            vec![(Channel::Log, log(2, &message))]
        }
        "fault" => {
            let message = format!(
                "{}: {}",
                event["code"].as_str().unwrap_or("?"),
                event["message"].as_str().unwrap_or("?")
            );
            vec![(Channel::Log, log(4, &message))]
        }
        "refused" => vec![(Channel::Log, log(3, event["message"].as_str().unwrap_or("refused")))],
        "lost" => vec![(Channel::Log, log(3, "whoever operates it is not heard"))],
        "looks" => vec![(
            Channel::Log,
            log(3, &format!("the camera looks into what is off: {}", event["state"].as_str().unwrap_or("?"))),
        )],
        _ => Vec::new(),
    }
}

fn log(level: u8, message: &str) -> Value {
    json!({ "timestamp": time(), "level": level, "message": message, "name": "tracelight", "file": "", "line": 0 })
}

fn pose(x: f32, y: f32) -> Value {
    json!({ "timestamp": time(), "frame_id": FRAME, "pose": { "position": { "x": x, "y": y, "z": 0 }, "orientation": { "x": 0, "y": 0, "z": 0, "w": 1 } } })
}

/// The lit strokes as lines of a scene; an empty one takes away what was there.
fn scene(drawn: Option<&Drawn>) -> Value {
    let strokes = drawn.map_or_else(Vec::new, |drawn| drawn.strokes(MOST_POINTS));
    let line = |points: &Vec<[f32; 2]>| {
        let points: Vec<Value> = points.iter().map(|[x, y]| json!({ "x": x, "y": y, "z": 0 })).collect();
        json!({
            "type": 0, "thickness": 2, "scale_invariant": true, "points": points, "colors": [], "indices": [],
            "pose": { "position": { "x": 0, "y": 0, "z": 0 }, "orientation": { "x": 0, "y": 0, "z": 0, "w": 1 } },
            "color": { "r": 0.9, "g": 0.1, "b": 0.2, "a": 1 },
        })
    };
    let entity = json!({
        "timestamp": time(), "frame_id": FRAME, "id": "plan", "lifetime": { "sec": 0, "nsec": 0 }, "frame_locked": false, "metadata": [],
        "arrows": [], "cubes": [], "spheres": [], "cylinders": [], "lines": strokes.iter().map(line).collect::<Vec<_>>(), "triangles": [], "texts": [], "models": [],
    });
    json!({ "deletions": [], "entities": [entity] })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channels(event: &Value, drawn: Option<&Drawn>) -> Vec<Channel> {
        messages(&event.to_string(), drawn).into_iter().map(|(channel, _)| channel).collect()
    }

    #[test]
    fn channels_have_names_schemas_and_numbers_of_their_own() {
        for channel in Channel::ALL {
            assert_eq!(Channel::of(channel.id()), Some(channel));
            let told = channel.advertised();
            let schema: Value = serde_json::from_str(told["schema"].as_str().unwrap()).unwrap();
            assert_eq!(schema["type"], "object");
            assert!(told["topic"].as_str().unwrap().starts_with('/'));
        }
        assert_eq!(Channel::of(0), None);
        assert_eq!(Channel::of(6), None);
    }

    #[test]
    fn what_happens_is_told_on_its_channels() {
        let drawn = Drawn::of(crate::points::tests::two_strokes()).unwrap();
        let progress = json!({ "event": "progress", "plan_s": 0.002, "gate": true });
        assert_eq!(channels(&progress, None), [Channel::Progress]);
        let told = messages(&progress.to_string(), Some(&drawn));
        assert_eq!(told[0].1, json!({ "plan_s": 0.002, "gate": true }));
        assert_eq!((told[1].0, told[1].1["pose"]["position"]["x"].as_f64()), (Channel::Asked, Some(2.0)));
        let begun = messages(&json!({ "event": "begun" }).to_string(), Some(&drawn));
        assert_eq!(begun[0].1["entities"][0]["lines"].as_array().unwrap().len(), 2);
        assert_eq!(channels(&json!({ "event": "live", "on": false }), Some(&drawn)), []);
        let fault = messages(
            &json!({ "event": "fault", "code": "stalled", "message": "it stands" }).to_string(),
            None,
        );
        assert_eq!((fault[0].0, &fault[0].1["message"]), (Channel::Log, &json!("stalled: it stands")));
        assert!(messages("no object", None).is_empty());
    }

    #[test]
    fn a_message_says_whose_it_is_and_when() {
        let bytes = framed(7, "{}");
        assert_eq!((bytes[0], &bytes[1..5], &bytes[13..]), (1, &7_u32.to_le_bytes()[..], &b"{}"[..]));
        let at = u64::from_le_bytes(bytes[5..13].try_into().unwrap());
        assert!(at > 1_700_000_000_000_000_000, "{at}");
    }

    #[test]
    fn who_reads_subscribes_and_asks_nothing_else() {
        let said = |text: &str| serde_json::from_str::<Said>(text).ok();
        assert_eq!(
            said(r#"{"op":"subscribe","subscriptions":[{"id":0,"channelId":3}]}"#),
            Some(Said::Subscribe { subscriptions: vec![Subscription { id: 0, channel_id: 3 }] })
        );
        assert_eq!(
            said(r#"{"op":"unsubscribe","subscriptionIds":[0]}"#),
            Some(Said::Unsubscribe { subscription_ids: vec![0] })
        );
        for other in [
            r#"{"op":"setParameters"}"#,
            r#"{"wish":"arm"}"#,
            "{",
            "[]",
            r#"{"op":"subscribe","subscriptions":[{"id":-1,"channelId":3}]}"#,
        ] {
            assert_eq!(said(other), None, "{other}");
        }
    }
}
