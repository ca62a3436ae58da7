//! `hadar` as two pages in the browser: a form and the text of a scenario, two views of one thing, and a rule with its cameras, each with
//! what the engine says of it.
//!
//! Nothing leaves this machine and nothing of it is read: the page listens on a loopback address, takes requests of its own page
//! alone (`guard`), bounds their size and number (`http`), and reads scenarios that name no files
//! ([`Written::refusing_files`](hadar_scenario::Written::refusing_files)). The answers are those of `hadar size`,
//! `hadar find` and `hadar rule`.
//!
//! | file | what is there |
//! |---|---|
//! | `http` | connections: how many, how long, how large |
//! | `room` | places of connections |
//! | `turns` | whose turn it is to compute |
//! | `guard` | who may ask |
//! | `route` | which question is asked where |
//! | `engine` | the answer to a scenario |
//! | `finding` | the cameras that meet a scenario |
//! | `rules` | the answer to a rule |
//! | `examples` | scenarios that the page offers to begin from |
//! | `packs` | rules that the page offers |
//! | `said` | warnings, conditions and mistakes as they are shown |
//! | `size_limit` | what is larger than a page computes |
//! | `form` | a scenario as fields |
//! | `place` | paths of a scenario, and what may stand there |
//! | `slider` | the range about a number |
//! | `edit` | fields changed in the text of a scenario |
//! | `meaning` | what a word means, as a page |
//! | `page/` | what the browser shows |

mod edit;
mod engine;
mod examples;
mod finding;
mod form;
mod guard;
mod http;
mod longest;
mod meaning;
mod packs;
mod place;
mod room;
mod route;
mod rules;
mod said;
mod size_limit;
mod slider;
mod turns;

pub use engine::Engine;
pub use http::serve;
