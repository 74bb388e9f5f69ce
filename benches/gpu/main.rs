//! Measurements of the graphics card for `cargo xtask show gpu`: groups of figures as lines of JSON.

mod accuracy;
mod copy;
#[path = "../../cli/benches/exploration/group.rs"]
mod group;
#[path = "../models.rs"]
mod models;
mod speed;
mod traffic;

use std::error::Error;

use serde_json::json;
use shapeop::solver::{AdapterKind, BackendInfo, BackendOptions, backend_info};

const USAGE: &str = "usage:
  gpu adapter                      the card, or why there is none
  gpu bandwidth                    bytes per second that a kernel copies, reading and writing counted
  gpu accuracy [NAMES [VERTICES]]  energies against those of the processor, and the tolerance asked for
  gpu speed [NAMES [SIZES]]        ms per iteration against the processor with all cores, and time to a tolerance
NAMES and SIZES are separated by commas";

/// What speed is measured on unless asked for others.
const SPEED_NAMES: &str = "planar_quads,squares,tets";
const SPEED_SIZES: &str = "10000,100000,1000000";

/// The six problems of docs/benchmarks.md.
const ACCURACY_NAMES: &str = "planar_quads,cloth,squares,shell,tets,circles";
const ACCURACY_SIZE: &str = "10000";

type Outcome<T> = Result<T, Box<dyn Error>>;

fn main() -> Outcome<()> {
    // Cargo adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["adapter"] => println!("{}", adapter()),
        ["bandwidth"] => {
            let info = backend_info(&BackendOptions::default())?;
            println!("{}", json!({"adapter": info.adapter, "bytes_per_second": copy::bandwidth(&info.adapter)?}));
        }
        ["accuracy", rest @ ..] => {
            let names = rest.first().unwrap_or(&ACCURACY_NAMES).split(',');
            let size = rest.get(1).unwrap_or(&ACCURACY_SIZE).parse()?;
            for name in names {
                println!("{}", accuracy::group(name, size)?);
            }
        }
        ["speed", rest @ ..] => {
            let names: Vec<&str> = rest.first().unwrap_or(&SPEED_NAMES).split(',').collect();
            let sizes =
                rest.get(1).unwrap_or(&SPEED_SIZES).split(',').map(str::parse).collect::<Result<Vec<u32>, _>>()?;
            speed::print(&names, &sizes)?;
        }
        _ => println!("{USAGE}\nNAMES: {}", models::NAMES.join(", ")),
    }
    Ok(())
}

/// What is known of the card, or why there is none.
fn adapter() -> serde_json::Value {
    match backend_info(&BackendOptions::default()) {
        Ok(info) => json!({
            "adapter": info.adapter,
            "kind": info.kind.text(),
            "api": info.api,
            "driver": info.driver,
            "buffer_bytes": info.buffer_bytes,
            "binding_bytes": info.binding_bytes,
            "is_card": is_card(&info),
        }),
        Err(error) => json!({"missing": error.to_string(), "is_card": false}),
    }
}

/// True unless a program does the work of a card, whose times say nothing.
fn is_card(info: &BackendInfo) -> bool {
    info.kind != AdapterKind::Software
}

fn model(name: &str, size: u32) -> Outcome<models::Model> {
    Ok(models::model(name, size).ok_or_else(|| format!("no problem is called {name}"))?)
}
