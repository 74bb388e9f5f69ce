//! The committed JSON schema is the one that the code makes. `cargo xtask docs` writes it anew.

use std::path::Path;

#[test]
fn the_committed_schema_is_current() {
    let schema = schemars::schema_for!(shapeop::problem::Problem);
    let text = serde_json::to_string_pretty(&schema).unwrap() + "\n";
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/problem.schema.json");
    if std::env::var_os("SHAPEOP_WRITE_SCHEMA").is_some() {
        std::fs::write(&file, &text).unwrap();
    }
    assert_eq!(std::fs::read_to_string(&file).unwrap(), text, "run `cargo xtask docs` and look at the difference");
}
