//! Benchmarks of speed against error: which method with which settings suits which budget.
//!
//! ```text
//! suites → plans ─ runner: subject, engine → stopwatch · truth, metrics, error terms · reference → record ─ JSON, CSV, table, page
//! ```
//!
//! | module | contents |
//! |---|---|
//! | [`suites`] | sets of runs |
//! | [`plan`] | one run: scene, engine, settings, measurements |
//! | [`place`] | viewpoints relative to a subject's own |
//! | [`subject`] | scenes of any number of points, with their exact surface |
//! | [`engine`] | ways to render, behind one interface |
//! | [`stopwatch`], [`frame_times`] | times of any work in turns, and of frames |
//! | [`disturbance`] | why times may not be those of the work |
//! | [`error_terms`], [`hidden`] | parts of the error |
//! | [`ceilings`], [`work`] | rates of the device, and what passes do of them at least |
//! | [`runner`], [`session`], [`time_limit`] | execution of plans |
//! | [`papers`] | effects, costs and tables of the papers |
//! | [`hard`] | numerically hard cases: float32 against float64 |
//! | [`command`] | the command of a picture |
//! | [`record`] | results, as stored in JSON |
//! | [`table`], [`csv`], [`report`] | results as text, CSV and HTML |
//! | [`format`](mod@format) | numbers and names as text |
//! | [`recommendations`], [`standings`], [`convergence`], [`machines`] | evaluation of the results |

pub mod ceilings;
pub mod code;
pub mod command;
pub mod convergence;
pub mod csv;
pub mod disturbance;
pub mod engine;
pub mod error_terms;
pub mod format;
pub mod frame_times;
mod group;
pub mod hard;
pub mod hidden;
pub mod images;
mod load;
pub mod machines;
pub mod papers;
pub mod place;
pub mod plan;
pub mod recommendations;
pub mod record;
pub mod report;
pub mod runner;
pub mod session;
pub mod standings;
pub mod stopwatch;
pub mod subject;
pub mod suites;
mod table;
pub mod time_limit;
pub mod work;

pub use record::Results;
pub use session::{SessionOptions, measure};
pub use suites::Suite;
pub use table::table;
