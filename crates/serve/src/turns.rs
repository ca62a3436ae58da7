//! Whose turn it is to compute: quick questions in several places of their own, all others one at a time on fewer threads than there
//! are cores, so that a quick one never waits for them.
//!
//! What a question takes is guessed from its scenario; where the guess was wrong it is stopped after a while, and asked again in its turn
//! among the others. Each question has threads of its own, which go with it. It is stopped where nobody waits for it any more.

use crate::engine::Engine;
use crate::guard::Refusal;
use crate::route::{self, Begun, Reply};
use hadar::stop::{self, Reason, Stop, Stopped};
use hadar_study::budget::Limits;
use hyper::StatusCode;
use hyper::body::Bytes;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::Semaphore;
use tokio::time::timeout;

/// Quick questions that are computed at once.
const QUICK: usize = 8;
/// Time for one of them.
const QUICK_TIME: Duration = Duration::from_secs(10);
/// Questions that are computed at once, and those of them that are just being stopped.
pub(crate) const AT_ONCE: usize = 4 * QUICK;

/// The places of questions that are computed.
pub(crate) struct Turns {
    quick: Lane,
    other: Lane,
}

struct Lane {
    places: Arc<Semaphore>,
    /// Of each of its questions.
    threads: usize,
}

/// A question that is computed: stopped when nobody waits for it any more.
struct Awaited(Stop);

impl Drop for Awaited {
    fn drop(&mut self) {
        self.0.now(Reason::NobodyListens);
    }
}

impl Turns {
    pub(crate) fn new(cores: usize) -> Self {
        let lane = |places, threads| Lane { places: Arc::new(Semaphore::new(places)), threads };
        Self { quick: lane(QUICK, cores), other: lane(1, cores.saturating_sub(1).max(1)) }
    }
}

/// Computes a reply in its turn.
pub(crate) async fn taken(turns: Arc<Turns>, engine: Arc<Engine>, path: String, body: Bytes) -> Reply {
    let (own, asked) = (Arc::clone(&engine), (path.clone(), body.clone()));
    let quick = move || match route::begun(&asked.0, &asked.1, &own) {
        Begun::Prepared(question) if question.is_quick() => Begun::Replied(question.reply(&own)),
        begun => begun,
    };
    let begun = match turns.quick.run(engine.limits, Some(QUICK_TIME), quick).await {
        Ok(Some(begun)) => begun,
        // It is no quick one.
        Ok(None) => {
            let own = Arc::clone(&engine);
            let again = move || route::begun(&path, &body, &own);
            match turns.other.run(engine.limits, None, again).await {
                Ok(Some(begun)) => begun,
                Ok(None) => return failed(),
                Err(reply) => return reply,
            }
        }
        Err(reply) => return reply,
    };
    let question = match begun {
        Begun::Replied(reply) => return reply,
        Begun::Prepared(question) => question,
    };
    let own = Arc::clone(&engine);
    match turns.other.run(engine.limits, None, move || question.reply(&own)).await {
        Ok(reply) => reply.unwrap_or_else(failed),
        Err(reply) => reply,
    }
}

impl Lane {
    /// Does a job when it is its turn, on threads of its own; none if it takes longer than `most`.
    async fn run<T: Send + 'static>(
        &self,
        limits: Limits,
        most: Option<Duration>,
        job: impl FnOnce() -> T + Send + 'static,
    ) -> Result<Option<T>, Reply> {
        let Ok(place) = Arc::clone(&self.places).acquire_owned().await else { return Err(failed()) };
        let awaited = Awaited(Stop::new());
        let (stop, threads) = (awaited.0.clone(), self.threads);
        let work = tokio::task::spawn_blocking(move || {
            // Kept until the work has ended, whether or not anybody still waits for it.
            let _place = place;
            let memory = Limits { time: None, ..limits };
            let _watch = memory.watch(&stop, |_| ()).ok();
            stop::within(&stop, || match stop.own_threads(threads) {
                Ok(own) => own.install(job),
                Err(_) => job(),
            })
        });
        let done = match most {
            Some(most) => match timeout(most, work).await {
                Ok(done) => done,
                Err(_) => return Ok(None),
            },
            None => work.await,
        };
        match done {
            Ok(Ok(made)) => Ok(Some(made)),
            Ok(Err(Stopped { reason, .. })) => {
                Err(Reply::text(StatusCode::SERVICE_UNAVAILABLE, limits.stopped(reason).to_string()))
            }
            Err(_) => Err(failed()),
        }
    }
}

fn failed() -> Reply {
    Reply::refused(Refusal(StatusCode::INTERNAL_SERVER_ERROR, "this is a bug; report it with the scenario"))
}
