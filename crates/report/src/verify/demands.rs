//! What is demanded of a statement beside that it is the one its command makes: that the rule is passed, which rule, on which day, and that an
//! envelope which somebody signed holds it.
//!
//! An envelope (DSSE) has a payload in base64 and signatures over it; whose they are is for the tool to say that made them.
//!
//! Source: DSSE v1.0.2 (github.com/secure-systems-lab/dsse); in-toto attestation framework, Statement v1.

use super::verified::{Difference, EnvelopeFault};
use crate::folder::inside::Inside;
use crate::manifest::sha256_of_file;
use crate::rule::STATEMENT;
use base64::Engine as _;
use base64::engine::general_purpose::{STANDARD, URL_SAFE};
use hadar::error::{Error, Result};
use serde::Deserialize;
use serde_json::Value;
use std::io::Read as _;
use std::path::{Path, PathBuf};

/// The type of the payload of an envelope that holds a statement.
const PAYLOAD: &str = "application/vnd.in-toto+json";
/// The longest statement, bytes.
const LONGEST: u64 = 1 << 26;

/// What is demanded.
#[derive(Debug, Clone, Default)]
pub struct Demands {
    /// That the rule is passed.
    pub passed: bool,
    /// SHA-256 of the rule, over which nothing is set and of which no condition is accepted, and its folder, in which all files are that it names.
    pub rule: Option<(String, PathBuf)>,
    /// The day that must have been asked about, as it is written.
    pub on: Option<String>,
    /// An envelope that must hold the statement.
    pub envelope: Option<Vec<u8>>,
}

#[derive(Deserialize)]
struct Envelope {
    payload: String,
    #[serde(rename = "payloadType")]
    payload_type: String,
    signatures: Vec<Signature>,
}

#[derive(Deserialize)]
struct Signature {
    #[serde(default)]
    keyid: Option<String>,
    sig: String,
}

impl Demands {
    /// Whether anything is demanded.
    #[must_use]
    pub const fn is_none(&self) -> bool {
        !self.passed && self.rule.is_none() && self.on.is_none() && self.envelope.is_none()
    }

    /// Holds them against the statement in a folder: what is not met, and the keys by which an envelope says that it is signed.
    pub(super) fn unmet(&self, folder: &Path, is_listed: bool) -> Result<(Vec<Difference>, Vec<String>)> {
        let mut text = Vec::new();
        let read = Inside::open(folder).and_then(|inside| inside.file(STATEMENT));
        let read = read.and_then(|file| file.take(LONGEST).read_to_end(&mut text));
        // One that the report does not list was not made again.
        if read.is_err() || !is_listed {
            let instead = "name the report of a rule: hadar rule RULE --out FOLDER";
            return Err(Error::malformed("there is no statement in this folder", instead).in_file(folder));
        }
        let statement: Value = serde_json::from_slice(&text).unwrap_or_default();
        let predicate = &statement["predicate"];
        let mut unmet = Vec::new();
        let mut demand = |demanded: &str, found: &Value| {
            if found.as_str() != Some(demanded) {
                let found = found.as_str().unwrap_or("nothing").to_owned();
                unmet.push(Difference::Demand { demanded: demanded.to_owned(), found });
            }
        };
        if self.passed {
            demand("PASSED", &predicate["result"]);
        }
        if let Some((rule, home)) = &self.rule {
            demand(rule, &predicate["policy"]["digest"]["sha256"]);
            // What is built in is of the program; every other file must be the one beside the rule.
            for input in predicate["configuration"].as_array().into_iter().flatten().skip(1) {
                let name = input["name"].as_str().unwrap_or_default();
                if !name.starts_with("built-in: ") {
                    let there = sha256_of_file(&home.join(name)).ok().flatten();
                    demand(
                        &there.unwrap_or_else(|| format!("{name} beside the rule")),
                        &input["digest"]["sha256"],
                    );
                }
            }
        }
        if let Some(day) = &self.on {
            demand(day, &predicate["on"]);
        }
        let mut keys = Vec::new();
        if let Some(envelope) = &self.envelope {
            match signed(envelope, &text) {
                Ok(found) => keys = found,
                Err(fault) => unmet.push(Difference::Envelope { fault }),
            }
        }
        Ok((unmet, keys))
    }
}

/// The keys by which an envelope says that a statement is signed, or what is wrong with it.
fn signed(envelope: &[u8], statement: &[u8]) -> std::result::Result<Vec<String>, EnvelopeFault> {
    let envelope: Envelope = serde_json::from_slice(envelope)
        .map_err(|error| EnvelopeFault::NoEnvelope { why: error.to_string() })?;
    if envelope.payload_type != PAYLOAD {
        return Err(EnvelopeFault::OtherType { found: envelope.payload_type });
    }
    let payload = STANDARD.decode(&envelope.payload).or_else(|_| URL_SAFE.decode(&envelope.payload));
    let payload = payload.map_err(|error| EnvelopeFault::NoBase64 { why: error.to_string() })?;
    if payload != statement {
        return Err(EnvelopeFault::OtherStatement);
    }
    let signs = |one: &Signature| !one.sig.trim().is_empty();
    if envelope.signatures.is_empty() || !envelope.signatures.iter().all(signs) {
        return Err(EnvelopeFault::Unsigned);
    }
    // A key without a name has none.
    Ok(envelope.signatures.into_iter().map(|one| one.keyid.unwrap_or_default()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn an_envelope_holds_the_very_bytes() {
        let statement = b"{\n  \"_type\": \"x\"\n}\n";
        let of = |payload: &[u8], kind: &str, sig: &str| {
            let signature = json!({ "keyid": "k1", "sig": sig });
            json!({ "payload": STANDARD.encode(payload), "payloadType": kind, "signatures": [signature] })
                .to_string()
        };
        assert_eq!(signed(of(statement, PAYLOAD, "c2ln").as_bytes(), statement), Ok(vec!["k1".to_owned()]));
        let wrong = |text: &str, fault: EnvelopeFault| {
            let found = signed(text.as_bytes(), statement).unwrap_err();
            assert_eq!(std::mem::discriminant(&found), std::mem::discriminant(&fault), "{found:?}");
        };
        let (mut changed, none) = (statement.to_vec(), String::new());
        changed[5] ^= 1;
        wrong(&of(&changed, PAYLOAD, "c2ln"), EnvelopeFault::OtherStatement);
        wrong(&of(statement, "text/plain", "c2ln"), EnvelopeFault::OtherType { found: none.clone() });
        wrong(&of(statement, PAYLOAD, ""), EnvelopeFault::Unsigned);
        let of = |payload: &str| {
            json!({ "payload": payload, "payloadType": PAYLOAD, "signatures": [] }).to_string()
        };
        wrong(&of(&STANDARD.encode(statement)), EnvelopeFault::Unsigned);
        wrong(&of(""), EnvelopeFault::OtherStatement);
        wrong(&of("!"), EnvelopeFault::NoBase64 { why: none.clone() });
        wrong("{}", EnvelopeFault::NoEnvelope { why: none });
    }
}
