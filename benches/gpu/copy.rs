//! The rate at which the card copies memory: what bounds an iteration.

use std::time::Instant;

use crate::Outcome;

/// Bytes of each of the two buffers: far above any cache of a card.
const BYTES: u64 = 256 << 20;

/// Copies whose time is taken together; one before them warms up.
const COPIES: u32 = 20;

/// Rounds of copies; the fastest counts, as a bound.
const ROUNDS: usize = 5;

/// Threads of a workgroup.
const GROUP: u32 = 256;

const KERNEL: &str = "
@group(0) @binding(0) var<storage, read> source: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> destination: array<vec4<f32>>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = id.y * groups.x * 256u + id.x;
    if i < arrayLength(&source) {
        destination[i] = source[i];
    }
}
";

/// Bytes per second that a kernel reads and writes together on the adapter of this name.
pub fn bandwidth(adapter: &str) -> Outcome<f64> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    let found = adapters.into_iter().find(|each| each.get_info().name == adapter);
    let found = found.ok_or_else(|| format!("the adapter {adapter} is gone"))?;
    let limits = found.limits();
    let (device, queue) = pollster::block_on(
        found.request_device(&wgpu::DeviceDescriptor { required_limits: limits.clone(), ..Default::default() }),
    )?;
    let size = BYTES.min(limits.max_buffer_size).min(limits.max_storage_buffer_binding_size) / 16 * 16;
    let usage = wgpu::BufferUsages::STORAGE;
    let buffers = ["source", "target"].map(|label| {
        device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
    });
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(KERNEL.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: Default::default(),
        cache: None,
    });
    let numbered = (0..).zip(&buffers);
    let entries: Vec<_> = numbered
        .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
        .collect();
    let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries,
    });
    let groups = u32::try_from(size / 16)?.div_ceil(GROUP);
    let across = groups.min(limits.max_compute_workgroups_per_dimension);
    let copies = |count: u32| -> Outcome<()> {
        let mut encoder = device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &bindings, &[]);
            (0..count).for_each(|_| pass.dispatch_workgroups(across, groups.div_ceil(across), 1));
        }
        queue.submit([encoder.finish()]);
        device.poll(wgpu::PollType::wait_indefinitely())?;
        Ok(())
    };
    copies(1)?;
    let mut fastest = f64::INFINITY;
    for _ in 0..ROUNDS {
        let started = Instant::now();
        copies(COPIES)?;
        fastest = fastest.min(started.elapsed().as_secs_f64());
    }
    Ok(2.0 * size as f64 * f64::from(COPIES) / fastest)
}
