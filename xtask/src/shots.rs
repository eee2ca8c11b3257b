//! What the demo renders.

/// One call of `limpid render`.
pub struct Shot {
    /// The picture, under `out/demo`.
    pub picture: &'static str,
    /// Particle files, under `data`. Several make an image sequence.
    pub inputs: &'static [&'static str],
    /// Eye and target, as the options want them. None: limpid frames the fluid.
    pub camera: Option<(&'static str, &'static str)>,
    /// Whether the bodies and the tank of the simulation are drawn.
    pub bodies: bool,
}

/// All of them, in order.
pub const SHOTS: &[Shot] = &[
    Shot {
        picture: "drop.png",
        inputs: &["sphere_drop/frame.0014.pos"],
        camera: Some(("1.12,0.62,1.32", "0.5,0.19,0.5")),
        bodies: false,
    },
    Shot { picture: "splash.png", inputs: &["sphere_drop/frame.0020.pos"], camera: None, bodies: false },
    Shot {
        picture: "dam_break.png",
        inputs: &["dam_break_double/ParticleData_Fluid_20.bgeo"],
        camera: Some(("2.2,1.5,4.3", "0,1.2,0")),
        bodies: false,
    },
    Shot {
        picture: "rigid_coupling.png",
        inputs: &["rigid_coupling/ParticleData_Fluid_22.bgeo"],
        camera: Some(("1.9,1.5,3.6", "0.2,0.45,0")),
        bodies: true,
    },
    Shot {
        picture: "jet/frame_####.png",
        inputs: &["jet/ParticleData_Fluid_32.bgeo", "jet/ParticleData_Fluid_42.bgeo", "jet/ParticleData_Fluid_52.bgeo"],
        camera: Some(("1.45,1.25,2.1", "0,0.35,0")),
        bodies: false,
    },
];
