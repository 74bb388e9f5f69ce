//! Which machine iterates: the processor, or the graphics card.

use std::time::Instant;

use glam::DVec3;

#[cfg(not(feature = "gpu"))]
use super::{Outcome, Report};
use super::{ProgressFn, SolveOptions, Solver};
use crate::error::{Error, Result, Status};

/// Why there is no card.
#[cfg(not(feature = "gpu"))]
const WITHOUT_CARD: &str = "this library was built without the feature \"gpu\"";

/// What carries out the iterations of a solve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(i32)]
pub enum Backend {
    /// The processor, in double precision.
    #[default]
    Cpu = 0,
    /// The graphics card, in single precision; what a tolerance asks for beyond that the processor finishes. For libraries
    /// that were built with the feature `gpu`.
    Gpu = 1,
    /// The card where there is one that is faster on the model at hand, which the first iterations measure; else, and
    /// where anything is missing, the processor. [`super::Report::backend`] says what ran, and why.
    Automatic = 2,
}

/// What kind of adapter it is, the fastest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(i32)]
pub enum AdapterKind {
    /// A card with memory of its own.
    Discrete = 0,
    /// A part of the processor that shares its memory.
    Integrated = 1,
    /// A card that a virtual machine lends.
    Virtual = 2,
    /// Not known.
    Other = 3,
    /// A program that behaves like a card: for tests.
    Software = 4,
}

/// The adapter that iterates, and its limits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BackendInfo {
    /// Its name.
    pub adapter: String,
    /// Its kind.
    pub kind: AdapterKind,
    /// The interface it is driven by, such as "vulkan".
    pub api: String,
    /// The driver, and its version.
    pub driver: String,
    /// Bytes of one buffer at most.
    pub buffer_bytes: u64,
    /// Bytes of what one binding reaches at most; what is larger is split.
    pub binding_bytes: u64,
    /// Workgroups at most, in one dimension of a run.
    pub group_count: u32,
}

/// Which adapter, and how much of it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BackendOptions {
    /// A part of the adapter's name; empty: any, the fastest kind first.
    pub adapter: String,
    /// Bytes of one binding at most; 0: what the adapter allows. Less makes more and smaller runs of a large model.
    pub binding_bytes: u64,
    /// Bytes of the card that one solver may take; 0: no limit.
    pub memory_bytes: u64,
}

impl Backend {
    /// The backend of this number.
    ///
    /// # Errors
    /// There is none.
    pub fn from_number(number: i32) -> Result<Self> {
        let all = [Self::Cpu, Self::Gpu, Self::Automatic];
        all.into_iter().find(|backend| *backend as i32 == number).ok_or_else(|| {
            let reason = format!("expected 0 (CPU), 1 (GPU) or 2 (automatic), found {number}");
            Error::new(Status::InvalidValue, reason)
        })
    }
}

impl AdapterKind {
    /// The kind in a word.
    pub fn text(self) -> &'static str {
        match self {
            Self::Discrete => "discrete",
            Self::Integrated => "integrated",
            Self::Virtual => "virtual",
            Self::Other => "other",
            Self::Software => "software",
        }
    }
}

/// The adapter that `options` ask for. The first call takes a while: it opens it.
///
/// # Errors
/// Status `BackendUnavailable`, with the reason: there is none, or the library was built without the feature `gpu`.
pub fn backend_info(options: &BackendOptions) -> Result<BackendInfo> {
    #[cfg(feature = "gpu")]
    return super::gpu::Card::shared(options).map(|card| card.info().clone());
    #[cfg(not(feature = "gpu"))]
    {
        let _ = options;
        Err(Error::new(Status::BackendUnavailable, WITHOUT_CARD))
    }
}

/// Gives all graphics cards back, with all memory that solvers have on it: for a host that needs it for something else. Solves
/// that run on it end with status `BackendFailed`, at the points of their last read-back; later ones open it again.
pub fn release_backend() {
    #[cfg(feature = "gpu")]
    super::gpu::Card::release(None);
}

/// What goes on in a solve.
#[cfg_attr(not(feature = "gpu"), allow(dead_code, reason = "asked by cards alone"))]
pub(super) struct Course<'a, 'b> {
    pub(super) options: &'a SolveOptions,
    pub(super) started: Instant,
    /// The diagonal of the bounding box.
    pub(super) diagonal: f64,
    pub(super) progress: &'a mut ProgressFn<'b>,
}

impl Solver {
    /// Sets what carries out the iterations of the following solves. A new solver has `Cpu`.
    ///
    /// # Errors
    /// Status `BackendUnavailable`, for `Gpu` alone: there is no adapter, or the library was built without the feature
    /// `gpu`. Nothing changes then.
    pub fn set_backend(&mut self, backend: Backend) -> Result<()> {
        if backend == Backend::Gpu {
            backend_info(&self.backend_options)?;
        }
        self.backend = backend;
        self.forget_card();
        Ok(())
    }

    /// What was set to carry out iterations.
    pub fn backend(&self) -> Backend {
        self.backend
    }

    /// Chooses the adapter, and how much of it the following solves may use.
    pub fn set_backend_options(&mut self, options: &BackendOptions) {
        self.backend_options = options.clone();
        self.forget_card();
    }

    /// Why an exploration runs where it runs.
    pub(super) fn reason_of_exploration(&self, refusal: Option<&str>) -> String {
        match (self.backend, refusal) {
            (Backend::Gpu, Some(refusal)) => refusal.to_owned(),
            (Backend::Automatic, _) => "the processor accelerates sweeps, and a card does not".to_owned(),
            _ => "as asked for".to_owned(),
        }
    }

    fn forget_card(&mut self) {
        #[cfg(feature = "gpu")]
        {
            self.on_card = super::on_card::OnCard::default();
        }
    }

    /// The adapter of this solver. The first call takes a while: it opens it.
    ///
    /// # Errors
    /// As [`backend_info`].
    pub fn backend_info(&self) -> Result<BackendInfo> {
        backend_info(&self.backend_options)
    }

    /// Gives the card of this solver back, as [`release_backend`] does all.
    pub fn release_backend(&self) {
        #[cfg(feature = "gpu")]
        super::gpu::Card::release(Some(&self.backend_options));
    }

    /// The projection of every constraint at the current points, by id, as one target per row of its type: relative to the mean
    /// of its points, and without a mean, where the rows are centred. `Cpu` and `Gpu` agree to some 1e-6 of a constraint's
    /// size. Nothing for removed constraints.
    ///
    /// # Errors
    /// Status `BackendUnavailable` or `BackendFailed`, unless `backend` is `Cpu`.
    pub fn projections(&self, backend: Backend) -> Result<Vec<Vec<DVec3>>> {
        let mut set = self.constraints.clone();
        set.compact();
        #[cfg(feature = "gpu")]
        let mut of_card = match backend {
            Backend::Cpu => Vec::new(),
            _ => super::gpu::projections(&*super::gpu::Card::shared(&self.backend_options)?, &set, &self.points)?,
        };
        #[cfg(not(feature = "gpu"))]
        let mut of_card: Vec<Option<Vec<DVec3>>> = match backend {
            Backend::Cpu => Vec::new(),
            _ => backend_info(&self.backend_options).map(|_| Vec::new())?,
        };
        let mut found = vec![Vec::new(); self.constraint_count()];
        let mut ids = set.ids_by_slot();
        for (index, (batch, _)) in set.batches().enumerate() {
            let targets = of_card.get_mut(index).and_then(Option::take).unwrap_or_else(|| {
                let mut targets = vec![DVec3::ZERO; batch.target_offset(batch.len())];
                batch.project(0..batch.len(), &self.points, &mut targets);
                batch.centre_targets(0..batch.len(), &mut targets);
                targets
            });
            for (slot, id) in (0..batch.len()).zip(&mut ids) {
                found[id] = targets[batch.target_offset(slot)..batch.target_offset(slot + 1)].to_vec();
            }
        }
        Ok(found)
    }
}

/// What a library without the feature does where the other turns to the card: nothing.
#[cfg(not(feature = "gpu"))]
impl Solver {
    pub(super) fn prepare_card(&mut self) -> Result<()> {
        Ok(())
    }

    pub(super) fn has_read_back(&self) -> bool {
        false
    }

    pub(super) fn turns_to_card(&self, _report: &Report) -> bool {
        false
    }

    pub(super) fn iterate_on_card(&mut self, _report: &mut Report, _course: &mut Course<'_, '_>) -> Option<Outcome> {
        None
    }

    pub(super) fn iterate_on_backends(&mut self, _iterations: u32) -> Result<u32> {
        Ok(0)
    }

    pub(super) fn cpu_iterated(&mut self, _iterations: u32, _started: Instant) {}

    pub(super) fn tell_backend(&self, report: &mut Report) {
        report.backend_reason = match self.backend {
            Backend::Automatic => WITHOUT_CARD.to_owned(),
            _ => "as asked for".to_owned(),
        };
    }
}
