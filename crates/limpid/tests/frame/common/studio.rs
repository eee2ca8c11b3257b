//! One device for all tests.

use super::Cloud;
use glam::{DVec3, Vec3, Vec4, dvec3};
use limpid::{Environment, Settings, View};
use limpid_headless::{Aov, Background, Error, Gpu, Offscreen, Shot};
use std::sync::{LazyLock, Mutex, PoisonError};

static STUDIO: LazyLock<Mutex<Offscreen>> = LazyLock::new(|| {
    // The error says what to install.
    let offscreen = Gpu::open(None).and_then(Offscreen::new).unwrap_or_else(|error| panic!("{error}"));
    println!("adapter: {:?}", offscreen.gpu().info);
    Mutex::new(offscreen)
});

/// All buffers of a frame.
#[derive(Clone, PartialEq)]
pub struct Rendered {
    pub raw_depth: Vec<f32>,
    pub depth: Vec<f32>,
    pub thickness: Vec<f32>,
    pub normal: Vec<Vec3>,
    pub curvature: Vec<f32>,
    pub color: Vec<Vec4>,
    pub rgba: Vec<u8>,
}

impl Rendered {
    pub fn covered(&self) -> usize {
        self.depth.iter().filter(|depth| depth.is_finite()).count()
    }
}

pub fn shot_of<'a>(cloud: &'a Cloud, view: View, size: [u32; 2], settings: Settings) -> Shot<'a> {
    let environment = Environment::around(DVec3::splat(-1.0), DVec3::splat(1.0), -1.0, DVec3::Y, dvec3(2.0, 1.0, 3.0));
    Shot { settings, background: Background::Transparent, ..Shot::new(cloud.slices(), view, size, environment) }
}

/// Several tests at once share the device; one that failed does no harm to it.
pub fn with_gpu<T>(work: impl FnOnce(&mut Offscreen) -> T) -> T {
    work(&mut STUDIO.lock().unwrap_or_else(PoisonError::into_inner))
}

pub fn try_render(shot: &Shot<'_>) -> Result<Rendered, Error> {
    const AOVS: [Aov; 6] = [Aov::RawDepth, Aov::Depth, Aov::Thickness, Aov::Normal, Aov::Curvature, Aov::Color];
    let picture = with_gpu(|offscreen| offscreen.render(shot, &AOVS))?;
    let values = |aov| {
        let index = AOVS.iter().position(|other| *other == aov).unwrap();
        &picture.aovs[index].values
    };
    Ok(Rendered {
        raw_depth: values(Aov::RawDepth).clone(),
        depth: values(Aov::Depth).clone(),
        thickness: values(Aov::Thickness).clone(),
        normal: values(Aov::Normal).as_chunks().0.iter().map(|v| Vec3::from_array(*v)).collect(),
        curvature: values(Aov::Curvature).clone(),
        color: values(Aov::Color).as_chunks().0.iter().map(|v| Vec4::from_array(*v)).collect(),
        rgba: picture.rgba,
    })
}

pub fn render(shot: &Shot<'_>) -> Rendered {
    try_render(shot).unwrap()
}
