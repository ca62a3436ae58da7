//! What comes of a report that was made again.

use serde::Serialize;

/// What is not as it should be.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(tag = "code", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Difference {
    /// A file of the report is not there.
    Missing {
        /// Name of the file that is missing.
        file: String,
    },
    /// A file is not as it was when the report was written.
    Changed {
        /// Name of the file that has changed.
        file: String,
    },
    /// A file is made again with other content.
    Differs {
        /// Name of the file whose new content differs.
        file: String,
    },
    /// The command makes no such file.
    NotMade {
        /// Name of the file that is not made again.
        file: String,
    },
    /// The command makes a file that the report does not list.
    Unlisted {
        /// Name of the file that is not listed.
        file: String,
    },
    /// Something that the answer rests on is another.
    Input {
        /// As the report names it.
        path: String,
        /// SHA-256 that the report has.
        was: Option<String>,
        /// SHA-256 of what was read now.
        is: Option<String>,
    },
    /// The statement does not say what is demanded.
    Demand {
        /// The text that the statement must have there.
        demanded: String,
        /// The text that the statement has there.
        found: String,
    },
    /// An envelope is not about this statement.
    Envelope {
        /// What is wrong with it.
        #[serde(flatten)]
        fault: EnvelopeFault,
    },
    /// Another program made it: no difference by itself.
    Program {
        /// Version and commit of the program that made the report.
        was: String,
        /// Version and commit of the program that checks it.
        is: String,
    },
}

/// What came of it.
#[derive(Debug, Serialize)]
pub struct Verified {
    /// Whether all files and inputs are the same.
    pub verified: bool,
    /// Number of files that were compared.
    pub files: usize,
    /// Whether the file of the question was compared: without it its name and hash are what the report says.
    pub question_compared: bool,
    /// Inputs that were compared, the file of the question among them if it was found.
    pub inputs: usize,
    /// The command that was given again.
    pub command: String,
    /// What is not as it should be.
    pub differences: Vec<Difference>,
    /// Keys by which a DSSE `envelope` says that it is signed; whether it is, is not checked here.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub signed_by: Vec<String>,
    /// Files in the folder that are not the report's, of which nothing is said.
    pub strangers: Vec<String>,
}

/// What is wrong with a DSSE envelope.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(tag = "fault", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum EnvelopeFault {
    /// It is none.
    NoEnvelope {
        /// Why the file is no DSSE envelope.
        why: String,
    },
    /// Its payload is of another type.
    OtherType {
        /// The type of payload that was found.
        found: String,
    },
    /// Its payload is no base64.
    NoBase64 {
        /// Why the payload cannot be decoded as base64.
        why: String,
    },
    /// It holds another statement.
    OtherStatement,
    /// Nobody signed it.
    Unsigned,
}
