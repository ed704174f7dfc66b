//! Measuring speed against error: which method with which settings for which budget.
//!
//! ```text
//! suites → plans ─ runner: subject, engine → stopwatch · truth, metrics, terms · reference → record ─ JSON, CSV, table, page
//! ```
//!
//! | module | |
//! |---|---|
//! | [`suites`] | what is measured together |
//! | [`plan`] | one run: a scene, an engine, settings, what is wanted to be known |
//! | [`subject`] | a scene that can be sampled ever more densely, and what it truly looks like |
//! | [`engine`] | who renders: each method behind the same few calls |
//! | [`stopwatch`] | how long frames take |
//! | [`terms`], [`hidden`] | what an error is made of |
//! | [`runner`], [`session`] | carries plans out |
//! | [`papers`] | what the papers show, say and measured |
//! | [`hard`] | where numbers get difficult: float32 against float64 |
//! | [`record`] | what was measured, as it is kept |
//! | [`table`], [`csv`], [`report`] | the same for the eye and for other programs |
//! | [`advice`], [`falling`] | what follows from it |

pub mod advice;
pub mod code;
pub mod csv;
pub mod engine;
pub mod exhibit;
pub mod falling;
pub mod hard;
pub mod hidden;
pub mod papers;
pub mod plan;
pub mod record;
pub mod report;
pub mod runner;
pub mod session;
mod show;
pub mod stopwatch;
pub mod subject;
pub mod suites;
mod table;
pub mod terms;

pub use record::Results;
pub use session::{Wanted, measure};
pub use suites::Suite;
pub use table::table;
