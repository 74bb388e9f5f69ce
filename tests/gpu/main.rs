//! The graphics card against the processor. Runs on any adapter, the software one included.

mod kernels;
mod strains;

use shapeop::solver::{BackendOptions, backend_info};

/// True if there is an adapter; else says that the tests were left out.
fn has_adapter() -> bool {
    match backend_info(&BackendOptions::default()) {
        Ok(_) => true,
        Err(error) => {
            eprintln!("LEFT OUT: {error}");
            false
        }
    }
}
