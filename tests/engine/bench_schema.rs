//! The JSON schema of results.

use crate::support::results::plausible;
use serde_json::{Value, json};
use surfel::bench::record::{FORMAT, schema};

/// The schema of each format that was ever released, as `surfel bench --schema` prints it.
const PUBLISHED: &str = include_str!("../../src/bench/record/schema.json");

/// Why a value is not as the schema says.
fn faults(value: &Value) -> Option<String> {
    let (mut schemas, mut compiler) = (boon::Schemas::new(), boon::Compiler::new());
    compiler.add_resource("results.json", schema().to_value()).unwrap();
    let index = compiler.compile("results.json", &mut schemas).unwrap();
    schemas.validate(value, index).err().map(|error| error.to_string())
}

#[test]
fn the_schema_is_the_published_one() {
    let published: Value = serde_json::from_str(PUBLISHED).unwrap();
    let hint = "the results have changed: if older readers cannot read them, increase FORMAT; then write schema.json by `surfel bench --schema`";
    assert_eq!(schema().to_value(), published, "{hint}");
    assert!(published["$id"].as_str().unwrap().ends_with(&format!("-{FORMAT}")));
}

#[test]
fn results_meet_the_schema_and_others_do_not() {
    let mut results = plausible();
    results.sessions[0].runs[0].float64_error.as_mut().unwrap().colour = f64::NAN;
    let results = serde_json::to_value(&results).unwrap();
    assert_eq!(faults(&results), None);
    let broken = |path: &str, value: Value| {
        let mut results = results.clone();
        *results.pointer_mut(path).unwrap() = value;
        faults(&results).unwrap_or_else(|| panic!("{path} is accepted"))
    };
    broken("/format", json!("4"));
    broken("/sessions/0/runs/0/experiment", json!("unknown"));
    broken("/sessions/0/runs/0/time/wall/median", json!(null));
    broken("/sessions/0/runs/0/size", json!([1]));
    broken("/sessions/0/provenance/date", json!(3));
}
