//! What stands beside the fluid, as the options name it: meshes, bodies, light.

use crate::frames::Frames;
use eframe::egui_wgpu::RenderState;
use limpid_headless::Image;
use limpid_shot::{Options, Props, environment};
use std::path::Path;

/// It, and what it was read of.
#[derive(Default)]
pub struct Stand {
    key: Option<(Options, u64)>,
    environment: Option<String>,
    /// The files of all frames.
    pub files: Vec<limpid_io::Frame>,
    /// Meshes and bodies.
    pub props: Props,
    /// The same on the device.
    pub meshes: Vec<limpid::Mesh>,
}

impl Stand {
    /// Reads everything again the next time: files of these names are new.
    pub fn forget(&mut self) {
        self.key = None;
        self.forget_light();
    }

    /// Reads the light again the next time: there is one more picture that wants it.
    pub fn forget_light(&mut self) {
        self.environment = None;
    }

    /// Reads meshes and bodies, if other ones are named than before; then what is wrong with them.
    pub fn furnish(
        &mut self,
        gpu: &RenderState,
        options: &Options,
        frames: &Frames,
        generation: u64,
    ) -> Option<Vec<String>> {
        let part = Options { mesh: options.mesh.clone(), bodies: options.bodies.clone(), ..Options::default() };
        let key = Some((part, generation));
        if self.key == key {
            return None;
        }
        self.key = key;
        self.files = frames.list();
        Some(match Props::load(options, &self.files) {
            Ok(props) => {
                self.meshes = props.upload(&gpu.device, &gpu.queue);
                let warnings = props.warnings.clone();
                self.props = props;
                warnings
            }
            Err(error) => vec![error.to_string()],
        })
    }

    /// Reads the light from all around, if another one is named than before; None within: there is none.
    ///
    /// # Errors
    /// A picture that is none.
    pub fn light(&mut self, options: &Options) -> Option<Result<Option<Image>, String>> {
        let environment = options.environment.clone().filter(|path| !path.is_empty());
        if self.environment == environment {
            return None;
        }
        self.environment = environment;
        let map = self.environment.as_deref().map(|path| environment::read(Path::new(path))).transpose();
        Some(map.map_err(|error| error.to_string()))
    }
}
