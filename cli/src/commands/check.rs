//! `check`: how good a mesh is, and where it is worst.

use anyhow::Result;
use serde_json::json;
use shapeop::mesh::file::{Source, read_source};
use shapeop::mesh::measure::{self, Spread};

use crate::Ending;
use crate::args::CheckArgs;
use crate::output::say;
use crate::quality::{Connections, Quality};
use crate::table::{aligned, histogram, number, percent};

pub fn run(args: &CheckArgs, is_quiet: bool) -> Result<Ending> {
    let source = read_source(&args.mesh)?;
    let limit = args.limit / 100.0;
    let connections = Connections::of(&source.mesh)?;
    let quality = Quality::of(&source.mesh, limit)?;
    if is_quiet {
        return Ok(Ending::Done);
    }
    if args.json {
        say(&as_json(args, &source, &connections, &quality)?)?;
    } else {
        say(&in_words(args, &source, &connections, &quality))?;
    }
    Ok(Ending::Done)
}

fn as_json(args: &CheckArgs, source: &Source, connections: &Connections, quality: &Quality) -> Result<String> {
    let worst = quality.worst_faces(args.worst).into_iter().map(|face| {
        let corners = source.mesh.corners(&source.mesh.faces[face]);
        json!({
            "face": face,
            "line": source.face_lines.get(face),
            "planarity": quality.planarity_of_faces[face],
            "plane_distance": measure::plane_distance(&corners),
        })
    });
    let report = json!({
        "version": 1,
        "program": concat!("shapeop ", env!("CARGO_PKG_VERSION")),
        "command": "check",
        "input": args.mesh.display().to_string(),
        "limit": args.limit / 100.0,
        "connections": connections,
        "quality": quality,
        "worst_faces": worst.collect::<Vec<_>>(),
    });
    Ok(serde_json::to_string_pretty(&report)?)
}

fn in_words(args: &CheckArgs, source: &Source, connections: &Connections, quality: &Quality) -> String {
    let mesh = &source.mesh;
    let mut parts = vec![format!(
        "{}: {} points, {}, {} edges, {} boundar{}, diagonal {}",
        args.mesh.display(),
        connections.points,
        connections.faces_in_words(),
        connections.edges,
        connections.boundaries,
        if connections.boundaries == 1 { "y" } else { "ies" },
        number(mesh.diagonal()),
    )];
    parts.extend(remarks(connections));
    if mesh.faces.is_empty() {
        return parts.join("\n");
    }
    let percents = |name: &str, spread: &Spread| {
        vec![
            name.to_owned(),
            percent(spread.min),
            percent(spread.mean),
            percent(spread.max),
            format!("face {}", spread.max_at),
        ]
    };
    let numbers = |name: &str, spread: &Spread, place: String| {
        vec![name.to_owned(), number(spread.min), number(spread.mean), number(spread.max), place]
    };
    let header = ["", "min", "mean", "max", "worst at"].map(str::to_owned).to_vec();
    let longest = |spread: &Spread| {
        let edges = shapeop::mesh::Topology::new(mesh).map(|topology| topology.edges().get(spread.max_at).copied());
        edges.ok().flatten().map_or(String::new(), |[a, b]| format!("edge {a}-{b}"))
    };
    let rows = [
        header,
        percents("planarity", &quality.planarity),
        numbers("distance from face plane", &quality.plane_distance, format!("face {}", quality.plane_distance.max_at)),
        percents("circularity", &quality.circularity),
        percents("regularity", &quality.regularity),
        numbers("edge length", &quality.edge_length, longest(&quality.edge_length)),
        numbers("corner angle (degrees)", &quality.corner_angle_deg, String::new()),
    ];
    parts.push(format!("\n{}", aligned(&rows)));
    let limit = args.limit / 100.0;
    parts.push(format!(
        "\nplanarity: {} of {} faces are over {}",
        quality.faces_over_limit,
        mesh.faces.len(),
        percent(limit)
    ));
    let short_percent = |value: f64| format!("{:.2} %", 100.0 * value);
    parts.push(histogram(&quality.planarity_of_faces, 0.0, 0.01, 10, &short_percent));
    let lengths = measure::edge_lengths(mesh).unwrap_or_default();
    parts.push("\nedge lengths".to_owned());
    parts.push(histogram(&lengths, quality.edge_length.min, quality.edge_length.max, 8, &number));
    if quality.planarity.max > 0.0 && args.worst > 0 {
        parts.push("\nleast planar faces, counted from 0".to_owned());
        parts.push(worst_faces(args, source, quality));
    }
    parts.join("\n")
}

fn remarks(connections: &Connections) -> Vec<String> {
    let named = |edges: &[[u32; 2]]| {
        let names: Vec<String> = edges.iter().take(3).map(|[a, b]| format!("{a}-{b}")).collect();
        format!("{}{}", names.join(", "), if edges.len() > 3 { ", ..." } else { "" })
    };
    let mut remarks = Vec::new();
    let Connections { non_manifold_edges, misoriented_edges, unused_points, .. } = connections;
    if !non_manifold_edges.is_empty() {
        remarks.push(format!(
            "  {} edges have more than two faces: {}",
            non_manifold_edges.len(),
            named(non_manifold_edges)
        ));
    }
    if !misoriented_edges.is_empty() {
        let list = named(misoriented_edges);
        remarks
            .push(format!("  {} edges have faces that are turned against each other: {list}", misoriented_edges.len()));
    }
    if *unused_points > 0 {
        remarks.push(format!("  {unused_points} points belong to no face"));
    }
    remarks
}

fn worst_faces(args: &CheckArgs, source: &Source, quality: &Quality) -> String {
    let rows = quality.worst_faces(args.worst).into_iter().map(|face| {
        let corners = source.mesh.corners(&source.mesh.faces[face]);
        let line = source.face_lines.get(face).map_or(String::new(), |line| format!("line {line}"));
        vec![
            format!("face {face}"),
            line,
            percent(quality.planarity_of_faces[face]),
            format!("{} from its plane", number(measure::plane_distance(&corners))),
        ]
    });
    aligned(&rows.collect::<Vec<_>>())
}
