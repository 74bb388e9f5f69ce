//! `types`: the registry, for people and programs.

use anyhow::Result;
use serde_json::json;
use shapeop::constraints::{Projection, Rows, Scalars, TypeIndex, TypeInfo, types};

use crate::Ending;
use crate::args::TypesArgs;
use crate::output::say;

pub fn run(args: &TypesArgs, is_quiet: bool) -> Result<Ending> {
    let infos: Vec<&TypeInfo> = match &args.name {
        Some(name) => vec![TypeIndex::named(name)?.info()],
        None => types().collect(),
    };
    if is_quiet {
        return Ok(Ending::Done);
    }
    if args.json {
        let list: Vec<_> = infos.iter().map(|info| as_json(info)).collect();
        say(&serde_json::to_string_pretty(&list)?)?;
    } else if let (Some(_), [info]) = (&args.name, &infos[..]) {
        say(&explained(info))?;
    } else {
        let line = |cells: [&str; 4]| format!("  {:<21}  {:<9}  {:<27}  {}", cells[0], cells[1], cells[2], cells[3]);
        let mut lines = vec![line(["type", "points", "scalars", "what it does"])];
        lines.extend(infos.iter().map(|info| line([info.name, &point_counts(info), &scalar_names(info), info.help])));
        lines.push("\n  shapeop types NAME explains one.".to_owned());
        say(&lines.join("\n"))?;
    }
    Ok(Ending::Done)
}

fn point_counts(info: &TypeInfo) -> String {
    match info.greatest_indices {
        Some(most) if most == info.least_indices => most.to_string(),
        Some(most) => format!("{} - {most}", info.least_indices),
        None => format!("{} or more", info.least_indices),
    }
}

fn scalar_names(info: &TypeInfo) -> String {
    match info.scalars {
        Scalars::None => "-".to_owned(),
        Scalars::Shapes => "shapes".to_owned(),
        Scalars::Named(names) => names.iter().map(|scalar| scalar.name).collect::<Vec<_>>().join(", "),
    }
}

fn scalars(info: &TypeInfo) -> String {
    match info.scalars {
        Scalars::None => "-".to_owned(),
        Scalars::Shapes => "x y z of shapes (as created)".to_owned(),
        Scalars::Named(names) => {
            let list = names.iter().map(|scalar| match scalar.default {
                Some(default) => format!("{} ({})", scalar.name, rounded(default)),
                None => format!("{} (as created)", scalar.name),
            });
            list.collect::<Vec<_>>().join(", ")
        }
    }
}

fn rounded(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn projection(info: &TypeInfo) -> &'static str {
    match info.projection {
        Projection::Nearest => "nearest",
        Projection::Feasible => "feasible",
        Projection::Approximate => "approximate",
    }
}

fn explained(info: &TypeInfo) -> String {
    let rows = match info.rows {
        Rows::Centred => "points relative to their mean".to_owned(),
        Rows::Pairs => "1 row for each pair of points".to_owned(),
        Rows::Linear(1) => "1 row".to_owned(),
        Rows::Linear(count) => format!("{count} rows"),
    };
    let lines = [
        ("points", format!("{}: {}", point_counts(info), info.index_names.join(", "))),
        ("scalars", scalars(info)),
        ("compares", rows),
        ("projection", projection(info).to_owned()),
        ("violation in", info.violation_unit.to_owned()),
        ("energy grows", format!("with the power {} of the model's size", info.energy_scale_power)),
    ];
    let lines: Vec<String> = lines.iter().map(|(name, text)| format!("  {name:<13} {text}")).collect();
    format!("{}: {}\n{}", info.name, info.help, lines.join("\n"))
}

fn as_json(info: &TypeInfo) -> serde_json::Value {
    let scalars = match info.scalars {
        Scalars::None => json!([]),
        Scalars::Shapes => json!("shapes"),
        Scalars::Named(names) => {
            names.iter().map(|scalar| json!({"name": scalar.name, "default": scalar.default})).collect()
        }
    };
    json!({
        "name": info.name,
        "help": info.help,
        "least_indices": info.least_indices,
        "greatest_indices": info.greatest_indices,
        "index_names": info.index_names,
        "scalars": scalars,
        "projection": projection(info),
        "violation_unit": info.violation_unit,
        "energy_scale_power": info.energy_scale_power,
    })
}
