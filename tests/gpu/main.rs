//! The graphics card against the processor. Runs on any adapter, the software one included.

mod faults;
mod fits;
mod kernels;
#[path = "../../benches/models.rs"]
#[allow(dead_code, reason = "each program takes what it needs")]
mod models;
mod problems;
#[path = "../programs/mod.rs"]
mod programs;
mod strains;

use shapeop::solver::{BackendOptions, backend_info};

/// True if there is an adapter; else says that the tests were left out.
fn has_adapter() -> bool {
    match backend_info(&BackendOptions::default()) {
        Ok(_) => true,
        Err(error) => {
            programs::leave_out(&format!("iterations on a graphics card: {error}"));
            false
        }
    }
}
