//! What the studio has in hand: plans that were asked for, and one job at a time.

use std::collections::{HashMap, VecDeque};
use std::fs;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use axum::body::Bytes;
use serde_json::{Map, Value, json};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tracelight_task::Failure;

use crate::answers::json_of;
use crate::devices::Caller;
use crate::flags::{Which, arguments, draws_all, mode_of, typed};
use crate::folder::{Folder, Kind, no_run};
use crate::live::Live;
use crate::names::Names;
use crate::points::{self, Drawn};
use crate::program::{Head, Program, Seat};
use crate::tasks::{AtLast, Ended, Work};
use crate::watch::{Watching, as_camera, file_stem, is_simulated};

/// Plans whose points are kept for pages to fetch.
const KEPT_PLANS: usize = 16;
/// Pages of which is known what they asked for last.
const MOST_PAGES: usize = 64;

/// Everything in hand.
pub(crate) struct Desk {
    pub(crate) program: Arc<dyn Program>,
    pub(crate) folder: Folder,
    next: AtomicU64,
    plans: Mutex<VecDeque<(u64, Bytes)>>,
    /// The picture and flags that were planned last by who operates: where a page begins that comes new, such as a phone at the wall.
    last: Mutex<Value>,
    /// The number of that plan.
    last_plan: AtomicU64,
    /// The points of what the job draws, where they are those that were planned last.
    drawn: Mutex<Option<Drawn>>,
    /// What each page asked for last, and the number it gave that.
    asked: Mutex<HashMap<String, (u64, Arc<Work>)>>,
    /// Held while a plan is made: each takes all of the processor. Who waits for it holds no thread.
    pub(crate) planning: Arc<tokio::sync::Mutex<()>>,
    /// How many may wait for a plan or an experiment: pages of this computer, devices that operate, devices that look on.
    waiting: [Arc<Semaphore>; 3],
    /// Held while an experiment of the lab is made.
    pub(crate) experimenting: Arc<tokio::sync::Mutex<()>>,
    job: Mutex<Option<Job>>,
    /// A move of the head by hand.
    moved: Mutex<Option<Arc<Work>>>,
    /// The experiment that is made, or the last one that was.
    experiment: Mutex<Option<Arc<Work>>>,
    /// Held while a file of the folder is replaced.
    writing: Mutex<()>,
    /// Cameras that pages look through.
    pub(crate) watching: Watching,
    /// What pages and a job that they attend say to each other.
    pub(crate) live: Live,
}

/// A picture that is traced, or the last one that was.
#[derive(Clone)]
struct Job {
    work: Arc<Work>,
    run: String,
    picture: String,
    /// The flags of what is drawn.
    flags: Value,
    /// Whether pages attend it.
    live: bool,
}

/// A plan that was taken on.
pub(crate) struct Planned {
    command: Vec<String>,
    work: AtLast,
}

/// A job that somebody asks for.
pub(crate) struct Wanted<'a> {
    pub(crate) subject: Subject<'a>,
    pub(crate) flags: &'a Map<String, Value>,
    /// The page that operates it, if one does.
    pub(crate) operator: Option<&'a str>,
}

impl Wanted<'_> {
    /// Whether it draws what was planned: all of it, in that order, and nothing that a camera sees anew.
    fn is_as_planned(&self) -> bool {
        draws_all(self.flags)
            && matches!(self.subject, Subject::Picture(of) if as_camera(of).is_none_or(is_simulated))
    }
}

/// What is to be drawn.
#[derive(Clone, Copy)]
pub(crate) enum Subject<'a> {
    /// A picture, by its id.
    Picture(&'a str),
    /// What a run has left, by its id.
    RestOf(&'a str),
}

fn locked<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Desk {
    pub(crate) fn new(program: Box<dyn Program>, folder: Folder) -> Self {
        Self {
            program: Arc::from(program),
            folder,
            next: AtomicU64::new(1),
            plans: Mutex::default(),
            last: Mutex::default(),
            last_plan: AtomicU64::new(0),
            drawn: Mutex::default(),
            asked: Mutex::default(),
            planning: Arc::default(),
            waiting: [24, 12, 6].map(|most| Arc::new(Semaphore::new(most))),
            experimenting: Arc::default(),
            job: Mutex::default(),
            moved: Mutex::default(),
            experiment: Mutex::default(),
            writing: Mutex::default(),
            watching: Watching::default(),
            live: Live::new(),
        }
    }

    /// A place among those who wait for what is computed, so that nobody fills it for the others.
    ///
    /// # Errors
    /// `busy` where there is none.
    pub(crate) fn waits(&self, caller: &Caller) -> Result<OwnedSemaphorePermit, Failure> {
        let of = match (caller.is_local, caller.operates()) {
            (true, _) => 0,
            (false, true) => 1,
            (false, false) => 2,
        };
        let full =
            |_| Failure::failed("busy", "too much is asked at once: wait until some of it is answered");
        Arc::clone(&self.waiting[of]).try_acquire_owned().map_err(full)
    }

    pub(crate) fn work(&self) -> Arc<Work> {
        Work::new(self.next.fetch_add(1, Ordering::Relaxed))
    }

    /// The head that the studio was opened for, where a page chooses no other.
    pub(crate) fn head_of(&self, flags: &Map<String, Value>) -> Option<&Head> {
        let chooses = flags.get("rig").and_then(Value::as_str).is_some_and(|rig| !rig.trim().is_empty());
        self.program.head().filter(|_| !chooses)
    }

    /// The command line of what a page asks for.
    fn command(
        &self,
        name: &str,
        picture: &str,
        flags: &Map<String, Value>,
        which: Which,
    ) -> Result<Vec<String>, Failure> {
        let mut command = vec![name.to_owned(), self.subject(picture)?];
        command.extend(arguments(flags, which, &self.names())?);
        if let Some(head) = self.head_of(flags) {
            let rig = if which == Which::Attended { &head.draws_as } else { &head.planned_as };
            command.push(format!("--rig={rig}"));
        }
        Ok(command)
    }

    /// What is drawn, as a command line names it: a picture's path, or a camera.
    fn subject(&self, picture: &str) -> Result<String, Failure> {
        if let Some(camera) = as_camera(picture) {
            return Ok(format!("--camera={}", self.source(camera)?));
        }
        self.folder.picture_path(picture)
    }

    /// Takes note of what a page asks for, by the number that it gives its wishes, and ends what it asked for before; a page without a name asks for everything at once.
    fn wish(&self, (page, number): (&str, u64), work: &Arc<Work>) -> Result<(), Failure> {
        if page.is_empty() {
            return Ok(());
        }
        let mut asked = locked(&self.asked);
        if asked.len() >= MOST_PAGES {
            asked.retain(|_, (_, work)| !work.is_over());
        }
        if let Some((last, before)) = asked.get(page) {
            if *last > number {
                return Err(Failure::interrupted());
            }
            before.stop.want();
        }
        asked.insert(page.to_owned(), (number, Arc::clone(work)));
        Ok(())
    }

    /// Takes a plan on that is to be made. What the same page asked for before and is not done is ended.
    ///
    /// # Errors
    /// What is wrong with it; `interrupted` where the page has asked for another since.
    pub(crate) fn begin_plan(
        &self,
        page: (&str, u64),
        picture: &str,
        flags: &Map<String, Value>,
    ) -> Result<Planned, Failure> {
        let command = self.command("plan", picture, flags, Which::Drawing)?;
        let work = self.work();
        let planned = Planned { command, work: AtLast(Arc::clone(&work)) };
        self.wish(page, &work)?;
        Ok(planned)
    }

    /// Makes a plan: while one is made no other one is.
    ///
    /// # Errors
    /// What the program says; `interrupted` where the page has asked for another since.
    pub(crate) fn plan(&self, planned: Planned) -> Result<Value, Failure> {
        let Planned { command, work: last } = planned;
        let work = Arc::clone(&last.0);
        // somebody may have wished for another while this one waited
        work.stop.check()?;
        let table = self.folder.moment("plan", work.id, ".csv");
        let out = ["-o".to_owned(), table.to_string_lossy().into_owned(), "--json".to_owned()];
        let all: Vec<String> = command.iter().cloned().chain(out).collect();
        let planned = self.program.perform(&all, None, (&*work, &work.stop));
        let text = fs::read_to_string(&table).unwrap_or_default();
        // what cannot be removed is written over another time
        let _ = fs::remove_file(&table);
        work.end(Ended { answer: Value::Null, failure: None });
        let answer = json_of(planned?)?;
        let bytes = points::binary(&text, &answer)
            .ok_or_else(|| Failure::failed("internal", "the plan's table cannot be read"))?;
        let mut plans = locked(&self.plans);
        plans.push_back((work.id, Bytes::from(bytes)));
        if plans.len() > KEPT_PLANS {
            plans.pop_front();
        }
        Ok(json!({
            "id": work.id, "command": typed(&traced(&command)), "plan": answer, "remarks": work.remarks(),
            "points": format!("/api/v1/plans/{}/points", work.id),
        }))
    }

    /// Takes note of what somebody who operates has planned.
    pub(crate) fn note(&self, picture: &str, flags: &Map<String, Value>, plan: &Value) {
        *locked(&self.last) = json!({ "picture": picture, "flags": flags });
        self.last_plan.store(plan["id"].as_u64().unwrap_or(0), Ordering::Relaxed);
    }

    /// The points of what the job in hand draws, if they are known.
    pub(crate) fn drawn(&self) -> Option<Drawn> {
        locked(&self.drawn).clone()
    }

    /// The points of what was planned last, where that is what is to be drawn.
    fn planned_of(&self, picture: &str, flags: &Value) -> Option<Drawn> {
        let last = self.last();
        let asked = |flags: &Value| arguments(flags.as_object()?, Which::Drawing, &self.names()).ok();
        let is_same = last["picture"] == picture && asked(&last["flags"]) == asked(flags);
        Drawn::of(self.points(self.last_plan.load(Ordering::Relaxed))?).filter(|_| is_same)
    }

    /// What was planned last; null where nothing was.
    pub(crate) fn last(&self) -> Value {
        locked(&self.last).clone()
    }

    /// A plan's points.
    pub(crate) fn points(&self, id: u64) -> Option<Bytes> {
        locked(&self.plans).iter().find(|(known, _)| *known == id).map(|(_, bytes)| bytes.clone())
    }

    /// The command of a job, and what is drawn by it.
    fn job_command(&self, wanted: &Wanted<'_>) -> Result<(Vec<String>, String, Value), Failure> {
        let Wanted { subject, flags, operator } = wanted;
        let (mut command, picture, drawn, keeps_time) = match subject {
            Subject::Picture(picture) => {
                let which = if operator.is_some() { Which::Attended } else { Which::Drawing };
                let drawn = flags.iter().filter(|(name, _)| Which::Drawing.has(name));
                let drawn: Map<String, Value> =
                    drawn.map(|(name, value)| (name.clone(), value.clone())).collect();
                // unattended it is simulated
                let keeps_time =
                    operator.is_some() && self.head_of(flags).is_some_and(|head| head.is_at_port);
                let command = self.command("trace", picture, flags, which)?;
                (command, (*picture).to_owned(), json!(drawn), keeps_time)
            }
            Subject::RestOf(run) => self.rest_command(run, flags)?,
        };
        if keeps_time && operator.is_none() {
            let message =
                "the head at the port is operated by a page: ask for it with \"attended\" and the page's id";
            return Err(Failure::usage("usage", message));
        }
        let is_paced = command.iter().any(|argument| argument.starts_with("--real-time"));
        if operator.is_some() && !is_paced && !keeps_time {
            command.push("--real-time=1".to_owned());
        }
        Ok((command, picture, drawn))
    }

    /// The command that draws what a run has left, its picture and flags, and whether its head keeps time by itself.
    fn rest_command(
        &self,
        run: &str,
        flags: &Map<String, Value>,
    ) -> Result<(Vec<String>, String, Value, bool), Failure> {
        let dir = self.run_dir(run)?;
        let told = self.run(run)?.ok_or_else(|| no_run(run))?;
        let rig = told["rig"].as_str();
        let (head, names) = (self.program.head(), self.names());
        let is_heads = |rig: &str| {
            head.is_some_and(|head| [&head.draws_as, &head.planned_as].iter().any(|is| *is == rig))
        };
        if let Some(rig) = rig.filter(|rig| !is_heads(rig) && names.value(Kind::Rigs, rig).is_none()) {
            let message = format!(
                "{run} was drawn by the head {rig}: open the studio with --rig {rig}, and go on with it there"
            );
            return Err(Failure::usage("usage", message));
        }
        let mut command = vec!["resume".to_owned(), dir];
        command.extend(arguments(flags, Which::Rest, &Names::default())?);
        let picture = told["picture"].as_str().unwrap_or("picture.png").to_owned();
        let keeps_time = head.is_some_and(|head| head.is_at_port && rig == Some(head.draws_as.as_str()));
        Ok((command, picture, told["flags"].clone(), keeps_time))
    }

    /// Begins to trace a picture, or the rest of a run, on the simulated rig, as fast as that can or, where a page operates it, by the clock; what is to be run then.
    ///
    /// # Errors
    /// `busy` while another one is; what is wrong with the flags.
    pub(crate) fn trace(
        self: &Arc<Self>,
        wanted: &Wanted<'_>,
    ) -> Result<(Value, impl FnOnce() + Send + use<>), Failure> {
        let (mut command, picture, flags) = self.job_command(wanted)?;
        let operator = wanted.operator;
        let work = self.work();
        {
            let mut job = locked(&self.job);
            if job.as_ref().is_some_and(|job| !job.work.is_over()) {
                let message = "a picture is being traced: stop it, or wait until it is done";
                return Err(Failure::failed("busy", message));
            }
            if self.is_moved() {
                return Err(Failure::failed("busy", "the head is moved by hand: wait until it rests"));
            }
            *job = Some(Job {
                work: Arc::clone(&work),
                run: String::new(),
                picture: picture.clone(),
                flags: flags.clone(),
                live: operator.is_some(),
            });
        }
        *locked(&self.drawn) = self.planned_of(&picture, &flags).filter(|_| wanted.is_as_planned());
        // from here on it ends, whatever becomes of it
        let last = AtLast(Arc::clone(&work));
        let named = as_camera(&picture).map_or_else(|| picture.clone(), file_stem);
        let (run, dir) = self.folder.begin_run(&named)?;
        if let Some(job) = locked(&self.job).as_mut() {
            job.run = run;
        }
        command.extend(["--out".to_owned(), dir.to_string_lossy().into_owned(), "--json".to_owned()]);
        let desk = Arc::clone(self);
        let (begun, is_live, mode) = (self.job(), operator.is_some(), mode_of(&command));
        operator.iter().for_each(|page| self.live.begin(page, mode));
        Ok((begun, move || {
            let _last = last;
            // whatever becomes of it, pages are told that it is over
            let live = is_live.then(|| Attended(&desk.live));
            let seat = live.as_ref().map(|live| live.0 as &dyn Seat);
            let done = desk.program.perform(&command, seat, (&*work, &work.stop)).and_then(|performed| {
                let failure = performed.failure.clone();
                Ok(Ended { answer: json_of(performed)?, failure })
            });
            // what failed before there was anything to keep leaves no folder
            desk.folder.drop_empty(&dir);
            // before another one may begin
            drop(live);
            work.end(done.unwrap_or_else(|failure| Ended { answer: Value::Null, failure: Some(failure) }));
        }))
    }

    /// The job in hand, or the last one; null where there was none.
    pub(crate) fn job(&self) -> Value {
        let job = locked(&self.job).clone();
        job.map_or(Value::Null, |job| {
            let mut told = job.work.json();
            told["run"] = json!(job.run);
            told["picture"] = json!(job.picture);
            told["flags"] = job.flags;
            told["live"] = json!(job.live);
            told
        })
    }

    /// Stops the job in hand, dark; whether there was one. One that pages attend is held, to go on or to be ended; any other one is over.
    pub(crate) fn stop(&self) -> bool {
        // before its first tick nobody hears what it is asked, and nothing is drawn that could go on
        if self.live.is_on() && self.live.has_begun() {
            return self.live.stop();
        }
        self.end()
    }

    /// Whether the head is moved by hand.
    fn is_moved(&self) -> bool {
        locked(&self.moved).as_ref().is_some_and(|work| !work.is_over())
    }

    /// Begins to move the head by hand.
    ///
    /// # Errors
    /// `busy` while a job or another move is on.
    pub(crate) fn begin_move(&self) -> Result<Arc<Work>, Failure> {
        // as where a job begins: both look at both
        let job = locked(&self.job);
        if job.as_ref().is_some_and(|job| !job.work.is_over()) || self.is_moved() {
            return Err(Failure::failed(
                "busy",
                "the head is in use: stop what is drawn, or wait until it rests",
            ));
        }
        let work = self.work();
        *locked(&self.moved) = Some(Arc::clone(&work));
        Ok(work)
    }

    /// Ends the job in hand, dark, and any move of the head; whether there was one.
    pub(crate) fn end(&self) -> bool {
        let moved = locked(&self.moved).as_ref().filter(|work| !work.is_over()).cloned();
        if let Some(work) = moved {
            work.stop.want();
            return true;
        }
        let job = locked(&self.job);
        let is_on = job.as_ref().filter(|job| !job.work.is_over());
        is_on.is_some_and(|job| {
            job.work.stop.want();
            true
        })
    }

    /// The turn to replace a file of the folder.
    pub(crate) fn writes(&self) -> MutexGuard<'_, ()> {
        locked(&self.writing)
    }

    /// Takes note of an experiment, which ends when the studio does.
    pub(crate) fn begin_experiment(&self, work: &Arc<Work>) {
        *locked(&self.experiment) = Some(Arc::clone(work));
    }

    /// Ends everything in hand.
    pub(crate) fn close(&self) {
        self.end();
        self.watching.close();
        locked(&self.experiment).iter().for_each(|work| {
            work.stop.want();
        });
        locked(&self.asked).values().for_each(|(_, work)| {
            work.stop.want();
        });
    }

    /// What a command without a picture answers.
    ///
    /// # Errors
    /// What the program says.
    pub(crate) fn ask(&self, command: &[&str]) -> Result<Value, Failure> {
        let command: Vec<String> = command.iter().map(|&word| word.to_owned()).collect();
        let work = self.work();
        json_of(self.program.perform(&command, None, (&*work, &work.stop))?)
    }
}

/// A job that pages may attend, for as long as it goes on.
struct Attended<'a>(&'a Live);

impl Drop for Attended<'_> {
    fn drop(&mut self) {
        self.0.end();
    }
}

/// The command that draws what another one plans.
fn traced(command: &[String]) -> Vec<String> {
    std::iter::once("trace".to_owned()).chain(command.iter().skip(1).cloned()).collect()
}
