//! Which question is asked where.

use crate::engine::{Ask, Engine, Prepared};
use crate::finding::{FindAsk, PreparedFind};
use crate::guard::Refusal;
use crate::meaning;
use crate::rules::{PreparedReforms, PreparedRule};
use hadar::error::Error;
use hyper::StatusCode;
use hyper::body::Bytes;
use serde::de::DeserializeOwned;

const HTML: &str = "text/html; charset=utf-8";
const SCRIPT: &str = "text/javascript; charset=utf-8";
const STYLE: &str = "text/css; charset=utf-8";
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
        "/page.css" => Reply::of(STYLE, include_str!("page/page.css")),
        "/readings.js" => Reply::of(SCRIPT, hadar_report::READINGS),
        "/shared.js" => Reply::of(SCRIPT, include_str!("page/shared.js")),
        "/form.js" => Reply::of(SCRIPT, include_str!("page/form.js")),
        "/past.js" => Reply::of(SCRIPT, include_str!("page/past.js")),
        "/find.js" => Reply::of(SCRIPT, include_str!("page/find.js")),
        "/page.js" => Reply::of(SCRIPT, include_str!("page/page.js")),
        "/start" => Reply::answered(JSON, engine.start()),
        "/rules" => Reply::of(HTML, include_str!("page/rules.html")),
        "/rules.css" => Reply::of(STYLE, include_str!("page/rules.css")),
        "/rules.js" => Reply::of(SCRIPT, include_str!("page/rules.js")),
        "/rules/start" => Reply::answered(JSON, engine.rules()),
        _ => match path.strip_prefix("/explain/").and_then(meaning::page) {
            Some(page) => Reply::of(HTML, page),
            None => Reply::refused(NOT_HERE),
        },
    }
}

/// What is asked to be computed of a scenario.
#[derive(Debug, Clone, Copy)]
enum Wanted {
    Ask,
    Json,
    Report,
}

/// A question with its scenario or its rule looked up.
#[derive(Debug)]
pub(crate) struct Question(Asked);

#[derive(Debug)]
enum Asked {
    Scenario(Wanted, Box<Prepared>),
    Rule(Box<PreparedRule>),
    Reforms(PreparedReforms),
    Find(Box<PreparedFind>),
}

/// What comes of the beginning of a question.
#[derive(Debug)]
pub(crate) enum Begun {
    /// There is nothing to compute.
    Replied(Reply),
    /// There is.
    Prepared(Question),
}

/// Reads a question and looks up what its scenario or its rule names.
pub(crate) fn begun(path: &str, body: &[u8], engine: &Engine) -> Begun {
    let of_scenario =
        |wanted| read(body).map(|ask: Ask| Asked::Scenario(wanted, Box::new(engine.prepare(ask))));
    let asked = match path {
        "/ask" => of_scenario(Wanted::Ask),
        "/json" => of_scenario(Wanted::Json),
        "/report" => of_scenario(Wanted::Report),
        "/find" => read(body).map(|ask: FindAsk| Asked::Find(Box::new(engine.prepare_find(&ask)))),
        "/rule" => read(body).map(|ask| Asked::Rule(Box::new(engine.prepare_rule(ask)))),
        "/rule/reforms" => read(body).map(|ask| Asked::Reforms(engine.prepare_reforms(&ask))),
        _ => Err(NOT_HERE),
    };
    match asked {
        Ok(asked) => Begun::Prepared(Question(asked)),
        Err(refusal) => Begun::Replied(Reply::refused(refusal)),
    }
}

fn read<T: DeserializeOwned>(body: &[u8]) -> Result<T, Refusal> {
    let refusal = Refusal(StatusCode::BAD_REQUEST, "this is no question of the page");
    serde_json::from_slice(body).map_err(|_| refusal)
}

impl Question {
    /// Whether it takes a part of a second. A report takes longer than its answer.
    pub(crate) fn is_quick(&self) -> bool {
        match &self.0 {
            Asked::Scenario(Wanted::Report, _) => false,
            Asked::Scenario(_, prepared) => prepared.is_quick(),
            Asked::Rule(prepared) => prepared.is_quick(),
            Asked::Reforms(prepared) => prepared.is_quick(),
            Asked::Find(prepared) => prepared.is_quick(),
        }
    }

    /// Computes the answer.
    pub(crate) fn reply(self, engine: &Engine) -> Reply {
        match self.0 {
            Asked::Scenario(Wanted::Ask, prepared) => Reply::answered(JSON, engine.answer(*prepared)),
            Asked::Scenario(Wanted::Json, prepared) => Reply::answered(JSON, engine.json(*prepared)),
            Asked::Scenario(Wanted::Report, prepared) => Reply::answered(HTML, engine.report(*prepared)),
            Asked::Rule(prepared) => Reply::answered(JSON, engine.rule_answer(*prepared)),
            Asked::Reforms(prepared) => Reply::answered(JSON, engine.reforms_answer(prepared)),
            Asked::Find(prepared) => Reply::answered(JSON, engine.find_answer(*prepared)),
        }
    }
}
