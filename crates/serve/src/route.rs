//! Which question is asked where.

use crate::engine::{Ask, Engine, Prepared};
use crate::guard::Refusal;
use crate::meaning;
use hadar::error::Error;
use hyper::StatusCode;
use hyper::body::Bytes;

const HTML: &str = "text/html; charset=utf-8";
const JSON: &str = "application/json";
const TEXT: &str = "text/plain; charset=utf-8";

/// What is sent back.
#[derive(Debug)]
pub(crate) struct Reply {
    pub(crate) status: StatusCode,
    pub(crate) kind: &'static str,
    pub(crate) body: Bytes,
}

impl Reply {
    fn of(kind: &'static str, body: impl Into<Bytes>) -> Self {
        Self { status: StatusCode::OK, kind, body: body.into() }
    }

    pub(crate) fn refused(Refusal(status, reason): Refusal) -> Self {
        Self { status, kind: TEXT, body: Bytes::from_static(reason.as_bytes()) }
    }

    /// An answer, or what is wrong with the scenario, on one line.
    fn answered(kind: &'static str, answer: Result<String, Error>) -> Self {
        match answer {
            Ok(text) => Self::of(kind, text),
            Err(error) => Self::text(StatusCode::UNPROCESSABLE_ENTITY, error.to_string()),
        }
    }

    pub(crate) fn text(status: StatusCode, text: String) -> Self {
        Self { status, kind: TEXT, body: text.into() }
    }
}

const NOT_HERE: Refusal = Refusal(StatusCode::NOT_FOUND, "there is nothing here");

/// What is there to be looked at.
pub(crate) fn get(path: &str, engine: &Engine) -> Reply {
    match path {
        "/" => Reply::of(HTML, include_str!("page/index.html")),
        "/page.css" => Reply::of("text/css; charset=utf-8", include_str!("page/page.css")),
        "/page.js" => Reply::of("text/javascript; charset=utf-8", include_str!("page/page.js")),
        "/start" => Reply::answered(JSON, engine.start()),
        _ => match path.strip_prefix("/explain/").and_then(meaning::page) {
            Some(page) => Reply::of(HTML, page),
            None => Reply::refused(NOT_HERE),
        },
    }
}

/// What is asked to be computed.
#[derive(Debug, Clone, Copy)]
enum Wanted {
    Ask,
    Json,
    Report,
}

/// A question with its scenario looked up.
#[derive(Debug)]
pub(crate) struct Question {
    wanted: Wanted,
    prepared: Prepared,
}

/// What comes of the beginning of a question.
#[derive(Debug)]
pub(crate) enum Begun {
    /// There is nothing to compute.
    Replied(Reply),
    /// There is.
    Prepared(Box<Question>),
}

/// Reads a question and looks up what its scenario names.
pub(crate) fn begun(path: &str, body: &[u8], engine: &Engine) -> Begun {
    let wanted = match path {
        "/ask" => Wanted::Ask,
        "/json" => Wanted::Json,
        "/report" => Wanted::Report,
        _ => return Begun::Replied(Reply::refused(NOT_HERE)),
    };
    match serde_json::from_slice::<Ask>(body) {
        Ok(ask) => Begun::Prepared(Box::new(Question { wanted, prepared: engine.prepare(ask) })),
        Err(_) => {
            let refusal = Refusal(StatusCode::BAD_REQUEST, "this is no question of the page");
            Begun::Replied(Reply::refused(refusal))
        }
    }
}

impl Question {
    /// Whether it takes a part of a second. A report takes longer than its answer.
    pub(crate) fn is_quick(&self) -> bool {
        !matches!(self.wanted, Wanted::Report) && self.prepared.is_quick()
    }

    /// Computes the answer.
    pub(crate) fn reply(self, engine: &Engine) -> Reply {
        match self.wanted {
            Wanted::Ask => Reply::answered(JSON, engine.answer(self.prepared)),
            Wanted::Json => Reply::answered(JSON, engine.json(self.prepared)),
            Wanted::Report => Reply::answered(HTML, engine.report(self.prepared)),
        }
    }
}
