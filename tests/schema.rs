//! The committed JSON schemas are those that the code makes. `cargo xtask docs` writes them anew.

use std::path::Path;

fn check(schema: schemars::Schema, file: &str) {
    let text = serde_json::to_string_pretty(&schema).unwrap() + "\n";
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs").join(file);
    if std::env::var_os("SHAPEOP_WRITE_SCHEMA").is_some() {
        std::fs::write(&file, &text).unwrap();
    }
    assert_eq!(std::fs::read_to_string(&file).unwrap(), text, "run `cargo xtask docs` and look at the difference");
}

#[test]
fn the_committed_schemas_are_current() {
    check(schemars::schema_for!(shapeop::problem::Problem), "problem.schema.json");
    check(schemars::schema_for!(shapeop::geometry::canal::file::SurfaceForm), "canal.schema.json");
    check(schemars::schema_for!(shapeop::geometry::canal::file::PartsForm), "canal-parts.schema.json");
    check(schemars::schema_for!(shapeop::geometry::ruled::file::StripsForm), "ruled.schema.json");
    check(schemars::schema_for!(shapeop::geometry::ruled::planks::Planks), "ruled-planks.schema.json");
    check(schemars::schema_for!(shapeop::geometry::ruled::report::Report), "ruled-report.schema.json");
    check(schemars::schema_for!(shapeop::geometry::snakes::file::SnakeForm), "snake.schema.json");
    check(schemars::schema_for!(shapeop::geometry::snakes::arc_list::ArcListForm), "snake-arcs.schema.json");
    check(schemars::schema_for!(shapeop::geometry::snakes::report::Report), "snake-report.schema.json");
}
