//! The graphics card: opening it, buffers, kernels and their runs, and how it fails.
//!
//! Everything that can go wrong on a card ends as an [`Error`]: of status `BackendUnavailable` where nothing was begun (no
//! adapter, not enough memory, a limit exceeded), of status `BackendFailed` where the card was lost or refused work.

use std::cell::Cell;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use bytemuck::Pod;

use crate::error::{Error, Result, Status};
use crate::solver::backend::{AdapterKind, BackendInfo, BackendOptions};

/// Threads of a workgroup: a multiple of what cards run in step, and within every limit.
pub(in crate::solver) const GROUP: u32 = 64;

/// The end of texts that work on many things, one thread for each.
pub(in crate::solver) const THREADS: &str = include_str!("shaders/threads.wgsl");

/// Sums over workgroups.
pub(in crate::solver) const GROUP_SUM: &str = include_str!("shaders/group_sum.wgsl");

/// The largest moves of workgroups' points, as binding 4.
pub(in crate::solver) const MOVES: &str = include_str!("shaders/moves.wgsl");

/// An open card. Cheap to share: one serves all solvers of a process.
pub(in crate::solver) struct Card {
    device: wgpu::Device,
    queue: wgpu::Queue,
    info: BackendInfo,
    /// Bytes of one binding at most.
    binding_bytes: u64,
    group_count: u32,
    /// What went wrong first, since the card was opened.
    fault: Arc<Mutex<Option<String>>>,
    kernels: Mutex<HashMap<String, Kernel>>,
}

/// What a kernel does with one of its bindings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::solver) enum Access {
    Uniform,
    Read,
    Write,
}

/// A compiled kernel. Its bindings are numbered in the order of the accesses it was made with, in group 0.
#[derive(Clone)]
pub(in crate::solver) struct Kernel {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
}

/// A kernel with what it works on, ready to run again and again.
pub(in crate::solver) struct Run {
    pipeline: wgpu::ComputePipeline,
    bindings: wgpu::BindGroup,
    groups: [u32; 2],
}

thread_local! {
    /// Bytes that the model at hand has on the card, and may have at most; see [`Card::within`].
    static BUDGET: Cell<[u64; 2]> = const { Cell::new([0, u64::MAX]) };
}

/// The cards that are open, with what they were asked for by.
static SHARED: Mutex<Vec<(BackendOptions, Arc<Card>)>> = Mutex::new(Vec::new());

fn locked<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

pub(in crate::solver) fn unavailable(reason: impl Into<String>) -> Error {
    Error::new(Status::BackendUnavailable, reason)
}

impl Card {
    /// The card that `options` ask for, opened at the first call and whenever it was lost since.
    ///
    /// # Errors
    /// Status `BackendUnavailable` where there is none.
    pub(in crate::solver) fn shared(options: &BackendOptions) -> Result<Arc<Self>> {
        let mut shared = locked(&SHARED);
        shared.retain(|(_, card)| card.check().is_ok());
        if let Some((_, card)) = shared.iter().find(|(known, _)| is_same(known, options)) {
            return Ok(card.clone());
        }
        let card = Arc::new(Self::open(options)?);
        shared.push((options.clone(), card.clone()));
        Ok(card)
    }

    /// Gives back the card that `options` ask for, or all; what runs on it ends with `BackendFailed`.
    pub(in crate::solver) fn release(options: Option<&BackendOptions>) {
        let released = |known: &BackendOptions| options.is_none_or(|options| is_same(known, options));
        for (_, card) in locked(&SHARED).extract_if(.., |(known, _)| released(known)) {
            card.fail("the card was released");
            card.device.destroy();
        }
    }

    fn open(options: &BackendOptions) -> Result<Self> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
        let names = adapters.iter().map(|adapter| adapter.get_info().name).collect::<Vec<_>>().join(", ");
        let wanted = options.adapter.to_lowercase();
        let fits = |adapter: &wgpu::Adapter| adapter.get_info().name.to_lowercase().contains(&wanted);
        let adapter = adapters.into_iter().filter(fits).min_by_key(|adapter| kind_of(&adapter.get_info()) as i32);
        let Some(adapter) = adapter else {
            let reason = match (names.as_str(), wanted.as_str()) {
                ("", _) => {
                    "no graphics card was found: neither Vulkan, Metal nor Direct3D 12 has an adapter".to_owned()
                }
                (names, _) => format!("no adapter is called \"{}\"; there are: {names}", options.adapter),
            };
            return Err(unavailable(reason));
        };
        let (found, limits) = (adapter.get_info(), adapter.limits());
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("shapeop"),
            // Whatever the adapter can do: large models need large buffers.
            required_limits: limits.clone(),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|error| unavailable(format!("{} could not be opened: {error}", found.name)))?;
        let fault: Arc<Mutex<Option<String>>> = Arc::default();
        let first = |fault: &Mutex<Option<String>>, what: String| {
            locked(fault).get_or_insert(what);
        };
        let lost = fault.clone();
        device.set_device_lost_callback(move |_, message| first(&lost, format!("the card was lost: {message}")));
        let refused = fault.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| first(&refused, error.to_string())));
        let most = |limit: u64| if options.binding_bytes == 0 { limit } else { limit.min(options.binding_bytes) };
        let binding_bytes = most(limits.max_storage_buffer_binding_size.min(limits.max_buffer_size));
        let info = BackendInfo {
            adapter: found.name.clone(),
            kind: kind_of(&found),
            api: found.backend.to_string(),
            driver: format!("{} {}", found.driver, found.driver_info).trim().to_owned(),
            buffer_bytes: limits.max_buffer_size,
            binding_bytes,
            group_count: limits.max_compute_workgroups_per_dimension,
        };
        let group_count = limits.max_compute_workgroups_per_dimension;
        Ok(Self { device, queue, info, binding_bytes, group_count, fault, kernels: Mutex::default() })
    }

    /// What is known of it.
    pub(in crate::solver) fn info(&self) -> &BackendInfo {
        &self.info
    }

    /// Bytes of one binding at most: what is larger must be split.
    pub(in crate::solver) fn binding_bytes(&self) -> u64 {
        self.binding_bytes
    }

    /// Refuses to go on once anything went wrong.
    ///
    /// # Errors
    /// Status `BackendFailed`.
    pub(in crate::solver) fn check(&self) -> Result<()> {
        match &*locked(&self.fault) {
            None => Ok(()),
            Some(what) => Err(Error::new(Status::BackendFailed, format!("{}: {what}", self.info.adapter))),
        }
    }

    fn fail(&self, what: &str) {
        locked(&self.fault).get_or_insert(what.to_owned());
    }

    /// Runs `work`, whose buffers may take `bytes` together; 0: no limit.
    pub(in crate::solver) fn within<T>(bytes: u64, work: impl FnOnce() -> T) -> T {
        let before = BUDGET.replace([0, if bytes == 0 { u64::MAX } else { bytes }]);
        let result = work();
        BUDGET.set(before);
        result
    }

    /// A buffer of `values`, which kernels read and write.
    ///
    /// # Errors
    /// It exceeds a binding (`BackendUnavailable`) or the card's memory (`BackendUnavailable`), or the card was lost.
    pub(in crate::solver) fn buffer<T: Pod>(&self, name: &str, values: &[T]) -> Result<wgpu::Buffer> {
        let buffer = self.room(name, size_of_val(values).max(size_of::<T>()) as u64)?;
        self.write(&buffer, values);
        Ok(buffer)
    }

    /// A buffer of zeros.
    ///
    /// # Errors
    /// As [`Self::buffer`].
    pub(in crate::solver) fn room(&self, name: &str, bytes: u64) -> Result<wgpu::Buffer> {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        // Bindings are whole vectors.
        let size = bytes.max(16).next_multiple_of(16);
        if size > self.binding_bytes {
            let most = self.binding_bytes;
            return Err(unavailable(format!(
                "{name} takes {bytes} bytes, and {} binds {most} at most",
                self.info.adapter
            )));
        }
        let [used, most] = BUDGET.get();
        if used.saturating_add(size) > most {
            let reason = format!("{name} would make it more than the {most} bytes that a solver may take on the card");
            return Err(unavailable(reason));
        }
        BUDGET.set([used + size, most]);
        self.check()?;
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let descriptor = wgpu::BufferDescriptor { label: Some(name), size, usage, mapped_at_creation: false };
        let buffer = self.device.create_buffer(&descriptor);
        match pollster::block_on(scope.pop()) {
            None => self.check().map(|()| buffer),
            Some(_) => Err(unavailable(format!("{} has no room for {name}, {bytes} bytes", self.info.adapter))),
        }
    }

    /// A few numbers that a kernel reads.
    pub(in crate::solver) fn uniform<T: Pod>(&self, value: &T) -> wgpu::Buffer {
        let mut bytes = bytemuck::bytes_of(value).to_vec();
        bytes.resize(bytes.len().next_multiple_of(16), 0);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let size = bytes.len() as u64;
        // Not mapped at its creation, which a lost card answers with a panic.
        let buffer =
            self.device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false });
        self.write(&buffer, &bytes);
        buffer
    }

    /// Writes `values` to the start of `buffer`, before whatever is submitted next.
    pub(in crate::solver) fn write<T: Pod>(&self, buffer: &wgpu::Buffer, values: &[T]) {
        self.write_from(buffer, 0, values);
    }

    /// Writes `values` to `buffer` from the byte `first` on, before whatever is submitted next.
    pub(in crate::solver) fn write_from<T: Pod>(&self, buffer: &wgpu::Buffer, first: usize, values: &[T]) {
        // Copies are of whole words; types of other sizes are not used.
        self.queue.write_buffer(buffer, first as u64, bytemuck::cast_slice(values));
    }

    /// The kernel `main` of the WGSL text that `parts` make together, compiled once for each `name`.
    ///
    /// # Errors
    /// Status `BackendFailed` if the driver refuses it.
    pub(in crate::solver) fn kernel(&self, name: &str, parts: &[&str], accesses: &[Access]) -> Result<Kernel> {
        if let Some(kernel) = locked(&self.kernels).get(name) {
            return Ok(kernel.clone());
        }
        self.check()?;
        let entry = |(binding, access): (u32, &Access)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: match access {
                    Access::Uniform => wgpu::BufferBindingType::Uniform,
                    access => wgpu::BufferBindingType::Storage { read_only: *access == Access::Read },
                },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let entries: Vec<_> = (0..).zip(accesses).map(entry).collect();
        let descriptor = wgpu::BindGroupLayoutDescriptor { label: Some(name), entries: &entries };
        let layout = self.device.create_bind_group_layout(&descriptor);
        let source = wgpu::ShaderSource::Wgsl(parts.concat().into());
        let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(name), source });
        let pipeline_layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(name),
            bind_group_layouts: &[Some(&layout)],
            ..Default::default()
        });
        let pipeline = self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(name),
            layout: Some(&pipeline_layout),
            module: &module,
            entry_point: Some("main"),
            compilation_options: Default::default(),
            cache: None,
        });
        self.check()?;
        let kernel = Kernel { pipeline, layout };
        locked(&self.kernels).insert(name.to_owned(), kernel.clone());
        Ok(kernel)
    }

    /// `kernel` on `buffers`, with at least `thread_count` threads.
    pub(in crate::solver) fn run_of(&self, kernel: &Kernel, buffers: &[&wgpu::Buffer], thread_count: usize) -> Run {
        let numbered = (0..).zip(buffers);
        let entries: Vec<_> = numbered
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        let bindings = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &kernel.layout,
            entries: &entries,
        });
        let groups = (thread_count as u32).div_ceil(GROUP).max(1);
        let across = groups.min(self.group_count);
        Run { pipeline: kernel.pipeline.clone(), bindings, groups: [across, groups.div_ceil(across)] }
    }

    /// Submits the runs, one after the other.
    pub(in crate::solver) fn submit<'a>(&self, runs: impl IntoIterator<Item = &'a Run>) {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            for run in runs {
                pass.set_pipeline(&run.pipeline);
                pass.set_bind_group(0, &run.bindings, &[]);
                pass.dispatch_workgroups(run.groups[0], run.groups[1], 1);
            }
        }
        self.queue.submit([encoder.finish()]);
    }

    /// Waits for what was submitted.
    ///
    /// # Errors
    /// Status `BackendFailed` if the card was lost.
    pub(in crate::solver) fn wait(&self) -> Result<()> {
        if let Err(error) = self.device.poll(wgpu::PollType::wait_indefinitely()) {
            self.fail(&error.to_string());
        }
        self.check()
    }

    /// Waits for what was submitted and reads the first values of each buffer.
    ///
    /// # Errors
    /// Status `BackendFailed` if the card was lost.
    pub(in crate::solver) fn read<T: Pod>(&self, buffers: &[(&wgpu::Buffer, usize)]) -> Result<Vec<Vec<T>>> {
        self.check()?;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let copies: Vec<wgpu::Buffer> = buffers
            .iter()
            .map(|(buffer, count)| {
                let size = ((count * size_of::<T>()) as u64).next_multiple_of(4);
                let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
                let descriptor = wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false };
                let copy = self.device.create_buffer(&descriptor);
                encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, size);
                copy
            })
            .collect();
        self.queue.submit([encoder.finish()]);
        let failed = Arc::new(Mutex::new(None));
        for copy in copies.iter().filter(|copy| copy.size() > 0) {
            let failed = failed.clone();
            copy.slice(..).map_async(wgpu::MapMode::Read, move |result| {
                if let Err(error) = result {
                    *locked(&failed) = Some(error.to_string());
                }
            });
        }
        self.wait()?;
        if let Some(what) = locked(&failed).take() {
            self.fail(&what);
        }
        self.check()?;
        let values = copies.iter().zip(buffers).map(|(copy, (_, count))| {
            if *count == 0 {
                return Ok(Vec::new());
            }
            let view = copy.slice(..).get_mapped_range();
            let view = view.map_err(|error| Error::new(Status::BackendFailed, error.to_string()))?;
            Ok(bytemuck::pod_collect_to_vec(&view[..count * size_of::<T>()]))
        });
        values.collect()
    }
}

/// True if the same card serves both.
fn is_same(a: &BackendOptions, b: &BackendOptions) -> bool {
    (&a.adapter, a.binding_bytes) == (&b.adapter, b.binding_bytes)
}

fn kind_of(info: &wgpu::AdapterInfo) -> AdapterKind {
    match info.device_type {
        wgpu::DeviceType::DiscreteGpu => AdapterKind::Discrete,
        wgpu::DeviceType::IntegratedGpu => AdapterKind::Integrated,
        wgpu::DeviceType::VirtualGpu => AdapterKind::Virtual,
        wgpu::DeviceType::Cpu => AdapterKind::Software,
        wgpu::DeviceType::Other => AdapterKind::Other,
    }
}
