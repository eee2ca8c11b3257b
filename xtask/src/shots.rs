//! What the demo renders.

/// One call of `limpid render`.
pub struct Shot {
    /// The picture, under `out/demo`.
    pub picture: &'static str,
    /// Particle files, under `data`. Several make an image sequence.
    pub inputs: &'static [&'static str],
    /// Eye and target, as the options want them. None: limpid frames the fluid.
    pub camera: Option<(&'static str, &'static str)>,
}

/// All of them, in order.
pub const SHOTS: &[Shot] = &[
    Shot {
        picture: "sphere_drop.png",
        inputs: &["sphere_drop/frame.0014.pos"],
        camera: Some(("1.8,1.2,2.3", "0.5,0.36,0.5")),
    },
    Shot {
        picture: "dam_break.png",
        inputs: &["dam_break_double/ParticleData_Fluid_20.bgeo"],
        camera: Some(("2.9,2.5,5.4", "0,1.1,0")),
    },
    Shot {
        picture: "rigid_coupling.png",
        inputs: &["rigid_coupling/ParticleData_Fluid_22.bgeo"],
        camera: Some(("2.7,2.3,4.8", "0,0.8,0")),
    },
    Shot { picture: "framed_for_you.png", inputs: &["splashsurf/cube_2366_particles.vtk"], camera: None },
    Shot {
        picture: "jet/frame_{}.png",
        inputs: &["jet/ParticleData_Fluid_32.bgeo", "jet/ParticleData_Fluid_42.bgeo", "jet/ParticleData_Fluid_52.bgeo"],
        camera: Some(("2.0,1.5,2.9", "0,0.4,0")),
    },
];
