//! JSON schema of results.

use super::{FORMAT, Results};
use schemars::Schema;

/// The JSON schema of [`Results`], draft 2020-12. Its `$id` has the [version](FORMAT); a reader that knows it can read any results with that
/// `format`, and ignores properties that it does not know.
pub fn schema() -> Schema {
    let mut schema = schemars::schema_for!(Results);
    schema.insert("$id".into(), format!("surfel-bench-results-{FORMAT}").into());
    schema.insert("title".into(), format!("Results of surfel bench, format {FORMAT}").into());
    schema
}
