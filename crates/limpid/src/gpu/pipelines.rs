//! Pipelines built together, on all cores.

use super::{Kernel, Raster};
use std::future::Future;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

/// Pipelines that frames to come need: drivers take milliseconds for each, some of them hundreds, but work on several at once. Whoever does not ask
/// for them together has each built when it is first used.
#[derive(Default)]
pub struct Pipelines {
    kernels: Vec<Kernel>,
    rasters: Vec<Raster>,
}

/// One of them.
enum Pending<'a> {
    Kernel(&'a Kernel),
    Raster(&'a Raster),
}

impl Pending<'_> {
    fn source_bytes(&self) -> usize {
        match self {
            Self::Kernel(kernel) => kernel.source_bytes(),
            Self::Raster(raster) => raster.source_bytes(),
        }
    }

    fn build(&self, cache: Option<&wgpu::PipelineCache>) {
        match self {
            Self::Kernel(kernel) => kernel.build_ahead(cache),
            Self::Raster(raster) => raster.build_ahead(cache),
        }
    }
}

impl Pipelines {
    /// Adds others.
    pub fn extend(&mut self, others: Self) {
        self.kernels.extend(others.kernels);
        self.rasters.extend(others.rasters);
    }

    pub(crate) fn push_kernel(&mut self, kernel: &Kernel) {
        self.kernels.push(kernel.clone());
    }

    pub(crate) fn push_raster(&mut self, raster: &Raster) {
        self.rasters.push(raster.clone());
    }

    /// Builds those that are not there yet, and returns when all are: on as many threads as the machine has cores, in a browser on
    /// the one there is. One that the driver refuses is tried again when it is used: the error is told there.
    ///
    /// `cache`: what the driver is given back of an earlier run, and adds to ([`wgpu::PipelineCache::get_data`] is to be kept for the
    /// next); None: it starts anew.
    pub fn build(&self, cache: Option<&wgpu::PipelineCache>) {
        let kernels = self.kernels.iter().filter(|kernel| !kernel.is_built()).map(Pending::Kernel);
        let rasters = self.rasters.iter().filter(|raster| !raster.is_built()).map(Pending::Raster);
        let mut pending: Vec<Pending<'_>> = kernels.chain(rasters).collect();
        // Those with the most source first: they take longest, and would keep one thread busy at the end.
        pending.sort_by_key(|pending| std::cmp::Reverse(pending.source_bytes()));
        build_all(&pending, cache);
    }
}

/// What `make` makes, or None where the device tells of an error. Error scopes are a thread's own: the host's would miss it.
pub(super) fn without_errors<T>(device: &wgpu::Device, make: impl FnOnce() -> T) -> Option<T> {
    let filters = [wgpu::ErrorFilter::OutOfMemory, wgpu::ErrorFilter::Internal, wgpu::ErrorFilter::Validation];
    let scopes = filters.map(|filter| device.push_error_scope(filter));
    let made = make();
    // The innermost first. A browser tells later: None then.
    let is_fine = |scope: wgpu::ErrorScopeGuard| {
        let popped = pin!(scope.pop()).poll(&mut Context::from_waker(Waker::noop()));
        matches!(popped, Poll::Ready(None))
    };
    let [memory, internal, validation] = scopes;
    let all_fine = [validation, internal, memory].map(is_fine) == [true; 3];
    all_fine.then_some(made)
}

#[cfg(target_arch = "wasm32")]
fn build_all(pending: &[Pending<'_>], cache: Option<&wgpu::PipelineCache>) {
    pending.iter().for_each(|pending| pending.build(cache));
}

#[cfg(not(target_arch = "wasm32"))]
fn build_all(pending: &[Pending<'_>], cache: Option<&wgpu::PipelineCache>) {
    use std::sync::atomic::{AtomicUsize, Ordering};

    let next = AtomicUsize::new(0);
    let work = || {
        while let Some(pending) = pending.get(next.fetch_add(1, Ordering::Relaxed)) {
            pending.build(cache);
        }
    };
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 1..cores.min(pending.len()) {
            // One that the system refuses leaves its share to the others.
            drop(std::thread::Builder::new().spawn_scoped(scope, work));
        }
        work();
    });
}
