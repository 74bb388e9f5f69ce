//! The documentation says what the code says.

use std::fmt::Write as _;
use std::path::Path;

use shapeop::constraints::{Projection, Rows, Scalars, types};

fn table() -> String {
    let mut text = String::from(
        "# Constraint types\n\n\
         Made from the registry by `cargo xtask docs`; `shapeop types` prints it too. Sets, formulas, behaviour on degenerate \
         input and\nsources stand at the top of each type's file in `src/constraints/`.\n\n\
         Scalars are in model units unless their name says otherwise; a value after `=` is the default, others are taken from the \
         points when the\nconstraint is added. *Projection*: nearest, feasible (in the set, not always nearest) or approximate (a \
         step towards the set). *Power*: scaling\nthe model by `s` scales the energy by `s` to this power.\n\n\
         | type | what it does | points | scalars | rows | projection | violation in | power |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for info in types() {
        let indices = info.index_names.join(", ");
        let points = match info.greatest_indices {
            Some(most) if most == info.least_indices => format!("{most}: {indices}"),
            Some(most) => format!("{} to {most}: {indices}", info.least_indices),
            None => format!("{} or more: {indices}, …", info.least_indices),
        };
        let scalars = match info.scalars {
            Scalars::None => "–".to_owned(),
            Scalars::Shapes => "3 k m: m shapes of the k points".to_owned(),
            Scalars::Named(scalars) => {
                let named = scalars.iter().map(|scalar| match scalar.default {
                    Some(default) => format!("{} = {default}", scalar.name),
                    None => scalar.name.to_owned(),
                });
                named.collect::<Vec<_>>().join(", ")
            }
        };
        let rows = match info.rows {
            Rows::Centred => "centred".to_owned(),
            Rows::Linear(count) => count.to_string(),
            Rows::Pairs => "one per pair".to_owned(),
        };
        let projection = match info.projection {
            Projection::Nearest => "nearest",
            Projection::Feasible => "feasible",
            Projection::Approximate => "approximate",
        };
        let (name, help, unit, power) = (info.name, info.help, info.violation_unit, info.energy_scale_power);
        writeln!(text, "| {name} | {help} | {points} | {scalars} | {rows} | {projection} | {unit} | {power} |")
            .unwrap();
    }
    text
}

#[test]
fn the_table_of_types_is_current() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/constraints.md");
    if std::env::var_os("SHAPEOP_WRITE_DOCS").is_some() {
        std::fs::write(&file, table()).unwrap();
    }
    assert_eq!(std::fs::read_to_string(&file).unwrap(), table(), "run `cargo xtask docs` and look at the difference");
}
