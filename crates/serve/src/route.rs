//! Which question is asked where.

use crate::engine::{Ask, Engine};
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
            Err(error) => {
                Self { status: StatusCode::UNPROCESSABLE_ENTITY, kind: TEXT, body: error.to_string().into() }
            }
        }
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

/// What is computed.
pub(crate) fn post(path: &str, body: &[u8], engine: &Engine) -> Reply {
    let ask: Ask = match serde_json::from_slice(body) {
        Ok(ask) => ask,
        Err(_) => return Reply::refused(Refusal(StatusCode::BAD_REQUEST, "this is no question of the page")),
    };
    match path {
        "/ask" => Reply::answered(JSON, engine.answer(&ask)),
        "/json" => Reply::answered(JSON, engine.json(&ask)),
        "/report" => Reply::answered(HTML, engine.report(&ask)),
        _ => Reply::refused(NOT_HERE),
    }
}
