//! Every option of `limpid render`, as flags and as keys of a configuration file.

use crate::Error;
use crate::choice::{Axis, ColorAs, Named, Quality, choice};
use crate::colormap::Colormap;
use crate::liquid::Liquid;
use crate::size::Size;
use clap::{ArgAction, Args};
use glam::DVec3;
use limpid::{
    Absorption, AgitationLimits, Coloring, CurvatureFlow, Filter, Foam, Fresnel, Optics, Scale, Settings, Smoothing,
};
use limpid_headless::{Aov, Background};
use limpid_io::{Bare, Condition, Selection};
use serde::{Deserialize, Serialize};

/// Vertical field of view in degrees where nothing else is asked for.
const FOV_DEGREES: f64 = 45.0;

/// How soft the shadows of bodies are where nothing else is asked for: the true sun spans 0.53 degrees, seen through no haze.
const SUN_SIZE_DEGREES: f64 = 2.5;

/// Samples of a pixel at high quality: silhouettes without steps.
const HIGH_SAMPLES: u32 = 4;

/// The light is shown as it is.
const EXPOSURE: f64 = 1.0;

/// Depth in r at which particles' colours are what is left of white light where nothing else is asked for.
const COLOR_DEPTH: f64 = 6.0;

/// Frames per second where nothing else is asked for: what most simulations are written at.
const FPS: f64 = 25.0;

/// Radius of droplets in particle radii: what foam generators make is much finer than the fluid.
const DROPLET_RADIUS: f64 = 0.2;

/// Short, as splashes are photographed: a film camera's half of the time makes rain of spray.
const SHUTTER: f64 = 0.15;

/// Strength of the built-in sun.
const SUN: f64 = 1.0;

/// The options; what is not given is None. Ranges and defaults are added to the help from their own places.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Options {
    /// Particle files, a folder, or a pattern of numbered files (`frame_{}.vtk`, `frame_%04d.bgeo`, `frame_####.ply`, a glob)
    #[arg(value_name = "INPUT")]
    pub input: Option<Vec<String>>,
    /// Picture to write: .png, or .exr in linear light with depth, normal, thickness and more as layers; for several frames with `{}`, `%04d` or `####` in place of the number, else it is added
    #[arg(short, long, value_name = "OUT.png|exr")]
    pub output: Option<String>,
    /// First frame's number
    #[arg(long, value_name = "N", help_heading = "Particles")]
    pub start: Option<u64>,
    /// Last frame's number
    #[arg(long, value_name = "N", help_heading = "Particles")]
    pub end: Option<u64>,
    /// Take every Nth frame only
    #[arg(long, value_name = "N", help_heading = "Particles")]
    pub step: Option<u64>,
    /// Keep the particles alone for which this holds: an attribute, or x, y, z, compared with a number, as in 'Type == 3'; the
    /// length of vectors; several with && or by giving it again
    #[arg(long = "where", value_name = "CONDITION", action = ArgAction::Append, help_heading = "Particles")]
    pub r#where: Option<Vec<String>>,
    /// Keep the particles in this box alone: smallest x, y and z, then largest
    #[arg(long, value_name = "X,Y,Z,X,Y,Z", value_parser = numbers::<6>, allow_hyphen_values = true, help_heading = "Particles")]
    pub clip: Option<[f64; 6]>,
    /// Leave out particles with fewer neighbours than this within 4 radii; 0 keeps all
    #[arg(long, value_name = "N", help_heading = "Particles")]
    pub drop_isolated: Option<u32>,
    /// Take an attribute of the files for another: velocity=Vel
    #[arg(long, value_name = "NAME=IN_FILE", action = ArgAction::Append, help_heading = "Particles")]
    pub attribute: Option<Vec<String>>,
    /// World units in a unit of the files: multiplies positions, velocities and the files' radii
    #[arg(long, value_name = "S", allow_hyphen_values = true, help_heading = "Particles")]
    pub unit_scale: Option<f64>,
    /// Read files of bare numbers, x, y and z of each particle and nothing else, little-endian
    #[arg(long, value_name = "TYPE", value_parser = choice::<Bare>(), help_heading = "Particles")]
    pub raw: Option<Named<Bare>>,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH")]
    pub size: Option<Size>,

    /// Position of the camera, world units; without it the camera frames the fluid
    #[arg(long, value_name = "X,Y,Z", value_parser = triple, allow_hyphen_values = true, help_heading = "Camera")]
    pub camera_eye: Option<[f64; 3]>,
    /// What the camera looks at, world units; without it the centre of the fluid
    #[arg(long, value_name = "X,Y,Z", value_parser = triple, allow_hyphen_values = true, help_heading = "Camera")]
    pub camera_target: Option<[f64; 3]>,
    /// What is up in the picture; without it the data's up axis
    #[arg(long, value_name = "X,Y,Z", value_parser = triple, allow_hyphen_values = true, help_heading = "Camera")]
    pub camera_up: Option<[f64; 3]>,
    /// Vertical field of view in degrees
    #[arg(long, value_name = "DEGREES", allow_hyphen_values = true, help_heading = "Camera")]
    pub fov: Option<f64>,
    /// Orthographic view of this many world units from bottom to top, instead of a field of view
    #[arg(long, value_name = "HEIGHT", allow_hyphen_values = true, help_heading = "Camera")]
    pub ortho: Option<f64>,
    /// The data's up axis
    #[arg(long, value_name = "AXIS", value_parser = choice::<Axis>(), help_heading = "Camera")]
    pub up: Option<Named<Axis>>,

    /// Particle radius in world units; without it the file's, else half the estimated spacing
    #[arg(long, value_name = "R", allow_hyphen_values = true, help_heading = "Surface")]
    pub radius: Option<f64>,
    /// Drawn radius over particle radius; never changes the thickness
    #[arg(long, value_name = "S", allow_hyphen_values = true, help_heading = "Surface")]
    pub splat_scale: Option<f64>,
    /// Leave particles of lower density out of the picture, in the file's unit; 0 keeps all
    #[arg(long, value_name = "D", allow_hyphen_values = true, help_heading = "Surface")]
    pub density_threshold: Option<f64>,
    /// Stretch particles along the surface as their neighbours lie, and smooth them less; off draws spheres
    #[arg(long, value_name = "on|off", value_parser = choice::<bool>(), help_heading = "Surface")]
    pub anisotropy: Option<Named<bool>>,
    /// Anisotropy: largest ratio of a stretched particle's longest axis to its shortest
    #[arg(long, value_name = "K", allow_hyphen_values = true, help_heading = "Surface")]
    pub kappa: Option<f64>,
    /// Anisotropy: how far neighbours are looked for, in particle radii
    #[arg(long, value_name = "D", allow_hyphen_values = true, help_heading = "Surface")]
    pub support: Option<f64>,
    /// Anisotropy: particles with fewer neighbours turn round, wholly so at half as many
    #[arg(long, value_name = "N", allow_hyphen_values = true, help_heading = "Surface")]
    pub min_neighbours: Option<f64>,
    /// Anisotropy: how far particles are drawn towards the mean of their neighbours; 1 is all the way
    #[arg(long, value_name = "L", allow_hyphen_values = true, help_heading = "Surface")]
    pub center_smoothing: Option<f64>,
    /// Anisotropy: particles of a smaller radius in the picture, in pixels, are spheres and smoothed as such; 0 stretches all
    #[arg(long, value_name = "PX", allow_hyphen_values = true, help_heading = "Surface")]
    pub ellipsoid_min_px: Option<f64>,
    /// How the surface is smoothed
    #[arg(long, value_name = "NAME", value_parser = choice::<Filter>(), help_heading = "Surface")]
    pub filter: Option<Named<Filter>>,
    /// How curvature flow advances; asks for that filter where no other is named
    #[arg(long, value_name = "FORM", value_parser = choice::<CurvatureFlow>(), help_heading = "Surface")]
    pub curvature_flow: Option<Named<CurvatureFlow>>,
    /// Bilateral filter: exact, in two dimensions, instead of two passes along the axes; slow
    #[arg(long, num_args = 0..=1, require_equals = true, default_missing_value = "true", hide_possible_values = true,
          value_name = "BOOL", help_heading = "Surface")]
    pub exact_2d: Option<bool>,
    /// Smoothing length in particle radii
    #[arg(long, value_name = "S", allow_hyphen_values = true, help_heading = "Surface")]
    pub strength: Option<f64>,
    /// How often the filter is applied
    #[arg(long, value_name = "N", allow_hyphen_values = true, help_heading = "Surface")]
    pub iterations: Option<u32>,
    /// Largest half-width of the filter in pixels, which bounds the cost of a close-up
    #[arg(long, value_name = "PX", allow_hyphen_values = true, help_heading = "Surface")]
    pub filter_max_px: Option<u32>,
    /// What counts as one surface, in particle radii of depth; its exact meaning is each filter's
    #[arg(long, value_name = "D", allow_hyphen_values = true, help_heading = "Surface")]
    pub filter_range: Option<f64>,
    /// Narrow-range filter: what lies behind the range counts as this many particle radii behind
    #[arg(long, value_name = "D", allow_hyphen_values = true, help_heading = "Surface")]
    pub filter_clamp: Option<f64>,
    /// Neighbouring pixels farther apart than this many particle radii belong to different sheets
    #[arg(long, value_name = "D", allow_hyphen_values = true, help_heading = "Surface")]
    pub normal_step: Option<f64>,

    /// Preset of the resolutions and samples below, --layers and --caustics; each can be overridden
    #[arg(long, value_name = "NAME", value_parser = choice::<Quality>(), help_heading = "Quality")]
    pub quality: Option<Named<Quality>>,
    /// Pixels along one side of a pixel of the fluid, which is splatted, smoothed and shaded at that resolution
    #[arg(long, value_name = "N", value_parser = choice::<Scale>(), help_heading = "Quality")]
    pub filter_scale: Option<Named<Scale>>,
    /// Pixels along one side of a texel of the thickness image
    #[arg(long, value_name = "N", value_parser = choice::<Scale>(), help_heading = "Quality")]
    pub thickness_scale: Option<Named<Scale>>,

    /// Samples of each pixel: smooth silhouettes and highlights, for as many times the work
    #[arg(long, value_name = "N", allow_hyphen_values = true, help_heading = "Quality")]
    pub samples: Option<u32>,

    /// What is behind the fluid
    #[arg(long, value_name = "NAME", value_parser = choice::<Background>(), help_heading = "Look")]
    pub background: Option<Named<Background>>,
    /// Show the background where the fluid is thinner than this many particle radii
    #[arg(long, value_name = "T", allow_hyphen_values = true, help_heading = "Look")]
    pub min_thickness: Option<f64>,
    /// Multiplies the light before it is shown
    #[arg(long, value_name = "E", allow_hyphen_values = true, help_heading = "Look")]
    pub exposure: Option<f64>,
    /// What liquid it is: a name that `limpid looks` lists, or a file like those; options beside it win
    #[arg(long, value_name = "NAME|FILE.toml", help_heading = "Look")]
    pub look: Option<String>,
    /// Light from all around, an equirectangular picture, .hdr or .exr, fixed to the world, with up as the data's. It takes
    /// the place of the sky, and of sun and floor unless they are asked for
    #[arg(long, value_name = "FILE.hdr|FILE.exr", help_heading = "Look")]
    pub environment: Option<String>,
    /// Strength of the built-in sun; 0: none
    #[arg(long, value_name = "S", allow_hyphen_values = true, help_heading = "Look")]
    pub sun: Option<f64>,
    /// Where the sun is seen from the fluid, a direction in world space; without it beyond the fluid, to one side
    #[arg(long, value_name = "X,Y,Z", value_parser = triple, allow_hyphen_values = true, help_heading = "Look")]
    pub sun_direction: Option<[f64; 3]>,
    /// Whether there is a floor under the fluid, seen in it and through it, that takes its shadow
    #[arg(long, value_name = "on|off", value_parser = choice::<bool>(), help_heading = "Look")]
    pub floor: Option<Named<bool>>,
    /// Count every pixel of the fluid as this many particle radii thick and measure no thickness; 0 measures it
    #[arg(long, value_name = "T", allow_hyphen_values = true, help_heading = "Look")]
    pub fixed_thickness: Option<f64>,
    /// Follow light through the back of the liquid too, and see what liquid lies behind it beyond some air
    #[arg(long, value_name = "on|off", value_parser = choice::<bool>(), help_heading = "Look")]
    pub layers: Option<Named<bool>>,
    /// Reflectance of a surface by its index of refraction: exact, or Schlick's approximation
    #[arg(long, value_name = "NAME", value_parser = choice::<Fresnel>(), help_heading = "Look")]
    pub fresnel: Option<Named<Fresnel>>,
    /// Index of refraction
    #[arg(long, value_name = "N", allow_hyphen_values = true, help_heading = "Look")]
    pub refractive_index: Option<f64>,
    /// Absorption of red, green and blue for each particle radius of depth, so that every scene looks right
    #[arg(long, value_name = "R,G,B", value_parser = triple, allow_hyphen_values = true, help_heading = "Look")]
    pub absorption: Option<[f64; 3]>,
    /// Absorption of red, green and blue for each world unit of depth, as a physical liquid has
    #[arg(long, value_name = "R,G,B", value_parser = triple, allow_hyphen_values = true, help_heading = "Look")]
    pub absorption_per_world: Option<[f64; 3]>,
    /// Scattering of red, green and blue, in the unit of the absorption: milky liquids
    #[arg(long, value_name = "R,G,B", value_parser = triple, allow_hyphen_values = true, help_heading = "Look")]
    pub scattering: Option<[f64; 3]>,
    /// Linear base colour of what is scattered, and of an opaque liquid
    #[arg(long, value_name = "R,G,B", value_parser = triple, allow_hyphen_values = true, help_heading = "Look")]
    pub albedo: Option<[f64; 3]>,
    /// Whether nothing shines through, however thin the liquid
    #[arg(long, value_name = "on|off", value_parser = choice::<bool>(), help_heading = "Look")]
    pub opaque: Option<Named<bool>>,
    /// Reflectance of a metal seen straight on, red, green and blue; 0: no metal, the index of refraction decides
    #[arg(long, value_name = "R,G,B", value_parser = triple, allow_hyphen_values = true, help_heading = "Look")]
    pub metal: Option<[f64; 3]>,
    /// How blurred mirror images of the surroundings are
    #[arg(long, value_name = "R", allow_hyphen_values = true, help_heading = "Look")]
    pub roughness: Option<f64>,
    /// Linear light of its own that liquid sends out where it is so deep that nothing shines through
    #[arg(long, value_name = "R,G,B", value_parser = triple, allow_hyphen_values = true, help_heading = "Look")]
    pub color: Option<[f64; 3]>,
    /// How far the background is shifted, in units of the thickness
    #[arg(long, value_name = "S", allow_hyphen_values = true, help_heading = "Look")]
    pub refraction: Option<f64>,
    /// Strength of the sun's highlight
    #[arg(long, value_name = "S", allow_hyphen_values = true, help_heading = "Look")]
    pub specular: Option<f64>,
    /// Exponent of the sun's highlight; higher is smaller and sharper
    #[arg(long, value_name = "E", allow_hyphen_values = true, help_heading = "Look")]
    pub shininess: Option<f64>,

    /// Another liquid beside the first, mixed with it where they meet: what it is made of, a name or a file as --look has them;
    /// which particles it is, by input=FILES (those of one frame belong together by their numbers), by where=CONDITION as
    /// --where has them, or by phase=NUMBER; and what else is its own, radius=R, strength=S or parts of the look, as in
    /// 'oil input=oil_{}.vtk roughness=0.2'; may be given several times
    #[arg(long, value_name = "LOOK KEY=VALUE ...", value_parser = str::parse::<Liquid>, action = ArgAction::Append,
          help_heading = "Liquids")]
    pub liquid: Option<Vec<Liquid>>,
    /// Tell liquids in the same files apart by this attribute: particles are of the --liquid whose phase= is their number, by
    /// default its place, from 1, and of the first liquid if there is none
    #[arg(long, value_name = "ATTRIBUTE", help_heading = "Liquids")]
    pub phase_by: Option<String>,

    /// Colour the particles by a number of each: an attribute's, the length of a vector, or x, y, z; `velocity` is the speed. Or by
    /// `color`, their own colours in the files
    #[arg(long, value_name = "ATTRIBUTE", help_heading = "Colours")]
    pub color_by: Option<String>,
    /// What the colours are: the surface's, of liquid that nothing shines through; or what the body leaves of white light
    #[arg(long, value_name = "NAME", value_parser = choice::<ColorAs>(), help_heading = "Colours")]
    pub color_as: Option<Named<ColorAs>>,
    /// Absorption: depth in particle radii at which that much is left of white light
    #[arg(long, value_name = "D", allow_hyphen_values = true, help_heading = "Colours")]
    pub color_depth: Option<f64>,
    /// Colours for the numbers, from the least to the greatest; every map is perceptually even
    #[arg(long, value_name = "NAME", value_parser = choice::<Colormap>(), help_heading = "Colours")]
    pub colormap: Option<Named<Colormap>>,
    /// Numbers that have the map's first and last colour; without it the least and the greatest of all frames
    #[arg(long, value_name = "A,B", value_parser = numbers::<2>, allow_hyphen_values = true, help_heading = "Colours")]
    pub range: Option<[f64; 2]>,
    /// Whether the picture has a legend where colours stand for numbers
    #[arg(long, value_name = "on|off", value_parser = choice::<bool>(), help_heading = "Colours")]
    pub legend: Option<Named<bool>>,
    /// Unit of the numbers, for the legend
    #[arg(long, value_name = "TEXT", help_heading = "Colours")]
    pub legend_unit: Option<String>,

    /// Angle that the sun's disc spans, in degrees: how soft the shadows of bodies are
    #[arg(long, value_name = "DEGREES", allow_hyphen_values = true, help_heading = "Scene")]
    pub sun_size: Option<f64>,
    /// A light beside the sun, as far off: where it is seen from the fluid, a direction in world space, and its linear colour,
    /// of which 1 is as bright as the sun; may be given several times
    #[arg(long, value_name = "X,Y,Z,R,G,B", value_parser = numbers::<6>, action = ArgAction::Append,
          allow_hyphen_values = true, help_heading = "Scene")]
    pub light: Option<Vec<[f64; 6]>>,
    /// Whether the liquid's surface bends the sun's light, and gathers it on floor and bodies
    #[arg(long, value_name = "on|off", value_parser = choice::<bool>(), help_heading = "Scene")]
    pub caustics: Option<Named<bool>>,
    /// Mesh to draw beside the fluid, in world units: .obj, .gltf, .glb, .ply or .stl; may be given several times. One whose
    /// file name a body of --bodies has is that body's mesh
    #[arg(long, value_name = "FILE", action = ArgAction::Append, help_heading = "Scene")]
    pub mesh: Option<Vec<String>>,
    /// Bodies and tank walls to draw, with their places in every frame
    #[arg(long, value_name = "FILE.json", help_heading = "Scene")]
    pub bodies: Option<String>,
    /// Ripples that ride with the particles: their height in particle radii; 0 is none, 0.05 lively
    #[arg(long, value_name = "H", allow_hyphen_values = true, help_heading = "Living surface")]
    pub noise: Option<f64>,
    /// Wavelength of the longest ripples in particle radii
    #[arg(long, value_name = "L", allow_hyphen_values = true, help_heading = "Living surface")]
    pub noise_wavelength: Option<f64>,
    /// Octaves of the ripples; each is half as long and half as high as the one before
    #[arg(long, value_name = "N", allow_hyphen_values = true, help_heading = "Living surface")]
    pub noise_octaves: Option<u32>,
    /// Pixels along one side of a texel of the noise image; never finer than the fluid's own pixels
    #[arg(long, value_name = "N", value_parser = choice::<Scale>(), help_heading = "Living surface")]
    pub noise_scale: Option<Named<Scale>>,
    /// How much higher the ripples of agitated particles are: up to 1 + this times
    #[arg(long, value_name = "G", allow_hyphen_values = true, help_heading = "Living surface")]
    pub agitated_gain: Option<f64>,
    /// Change of velocity beyond which particles are agitated, world units per second, per second
    #[arg(long, value_name = "A", allow_hyphen_values = true, help_heading = "Living surface")]
    pub agitation_threshold: Option<f64>,
    /// Seconds in which agitation falls to 1/e
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, help_heading = "Living surface")]
    pub cooling: Option<f64>,
    /// Frames per second of the simulation: frame numbers over this are seconds
    #[arg(long, value_name = "FPS", allow_hyphen_values = true, help_heading = "Living surface")]
    pub fps: Option<f64>,
    /// Foam where particles are agitated, or simply where they are fast
    #[arg(long, value_name = "NAME", value_parser = choice::<Foam>(), help_heading = "Living surface")]
    pub foam: Option<Named<Foam>>,
    /// Opacity of full foam
    #[arg(long, value_name = "O", allow_hyphen_values = true, help_heading = "Living surface")]
    pub foam_opacity: Option<f64>,
    /// Linear colour of foam in full light
    #[arg(long, value_name = "R,G,B", value_parser = triple, allow_hyphen_values = true, help_heading = "Living surface")]
    pub foam_color: Option<[f64; 3]>,
    /// Speed at which speed foam begins (and agitation in a first frame), world units per second
    #[arg(long, value_name = "V", allow_hyphen_values = true, help_heading = "Living surface")]
    pub foam_speed_min: Option<f64>,
    /// Speed at which speed foam is full (and agitation in a first frame), world units per second
    #[arg(long, value_name = "V", allow_hyphen_values = true, help_heading = "Living surface")]
    pub foam_speed_max: Option<f64>,

    /// Foam particles, written by a foam generator: files as for INPUT, matched by number; none: not even those beside INPUT
    /// with `_foam` in the name
    #[arg(long, value_name = "INPUT", help_heading = "Droplets")]
    pub foam_particles: Option<String>,
    /// Spray particles, in the same way: `_spray`
    #[arg(long, value_name = "INPUT", help_heading = "Droplets")]
    pub spray_particles: Option<String>,
    /// Bubble particles, in the same way: `_bubbles`
    #[arg(long, value_name = "INPUT", help_heading = "Droplets")]
    pub bubble_particles: Option<String>,
    /// Break particles of the fluid of lower density up into spray, in the file's unit; 0: none
    #[arg(long, value_name = "D", allow_hyphen_values = true, help_heading = "Droplets")]
    pub spray_density: Option<f64>,
    /// Break particles of the fluid with fewer neighbours than this within 4 radii up into spray; 0: none
    #[arg(long, value_name = "N", help_heading = "Droplets")]
    pub spray_neighbours: Option<u32>,
    /// Radius of foam, spray and bubbles whose file has none, and mean radius of spray from the fluid, in particle radii
    #[arg(long, value_name = "R", allow_hyphen_values = true, help_heading = "Droplets")]
    pub droplet_radius: Option<f64>,
    /// Opacity of one droplet in its middle; their colour is --foam-color
    #[arg(long, value_name = "O", allow_hyphen_values = true, help_heading = "Droplets")]
    pub droplet_opacity: Option<f64>,
    /// Seconds before the end of its life in which a droplet fades, where the file has a life
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, help_heading = "Droplets")]
    pub droplet_fade: Option<f64>,
    /// Share of the time from frame to frame in which droplets are stretched along their way
    #[arg(long, value_name = "S", allow_hyphen_values = true, help_heading = "Droplets")]
    pub shutter: Option<f64>,

    /// Draw one buffer instead of the shaded fluid
    #[arg(long, value_name = "NAME", value_parser = choice::<Aov>(), help_heading = "More output")]
    pub show: Option<Named<Aov>>,
    /// Write a buffer beside the picture, .exr or .npy; may be given several times
    #[arg(long, value_name = "NAME=FILE", action = ArgAction::Append, help_heading = "More output")]
    pub aov: Option<Vec<String>>,
    /// Measure the GPU time of the last frame, as JSON on standard output or in a file
    #[arg(long, value_name = "FILE.json", num_args = 0..=1, require_equals = true, default_missing_value = "-",
          help_heading = "More output")]
    pub timings: Option<String>,

    /// What to render on: an index or a part of a name that `limpid adapters` lists
    #[arg(long, value_name = "NAME|INDEX")]
    pub adapter: Option<String>,
    /// Say nothing but errors and warnings
    #[arg(long, num_args = 0..=1, require_equals = true, default_missing_value = "true", hide_possible_values = true,
          value_name = "BOOL")]
    pub quiet: Option<bool>,
}

/// Options of which only one can hold: the first is the one that has a default.
pub const ALTERNATIVES: [[&str; 2]; 2] = [["fov", "ortho"], ["absorption", "absorption-per-world"]];

impl Options {
    /// What holds where nothing is said.
    pub fn defaults() -> Self {
        Self {
            size: Some(Size::default()),
            fov: Some(FOV_DEGREES),
            up: Some(Named(Axis::Y)),
            quality: Some(Named(Quality::Standard)),
            background: Some(Named(Background::default())),
            exposure: Some(EXPOSURE),
            samples: Some(1),
            sun_size: Some(SUN_SIZE_DEGREES),
            caustics: Some(Named(false)),
            agitation_threshold: Some(AgitationLimits::default().threshold),
            cooling: Some(AgitationLimits::default().cooling),
            fps: Some(FPS),
            color_as: Some(Named(ColorAs::Surface)),
            color_depth: Some(COLOR_DEPTH),
            colormap: Some(Named(Colormap::default())),
            legend: Some(Named(true)),
            sun: Some(SUN),
            floor: Some(Named(true)),
            spray_density: Some(0.0),
            spray_neighbours: Some(0),
            droplet_radius: Some(DROPLET_RADIUS),
            shutter: Some(SHUTTER),
            quiet: Some(false),
            ..Self::of_settings(&Settings::default())
        }
    }

    /// What the choices of a layer (quality, filter, anisotropy, environment) imply for other options, those of the layers below given.
    pub fn implied(&self, below: &Self) -> Self {
        let smoothing = self.implied_smoothing(below);
        let standard = Settings::default();
        let scales = self.quality.map(|quality| match quality.0 {
            Quality::Draft => (Scale::Half, Scale::Quarter),
            Quality::Standard => (standard.filter_scale, standard.thickness_scale),
            Quality::High => (Scale::Full, Scale::Full),
        });
        let has_map = self.environment.is_some();
        Self {
            sun: has_map.then_some(0.0),
            floor: has_map.then_some(Named(false)),
            filter_scale: scales.map(|(filter, _)| Named(filter)),
            thickness_scale: scales.map(|(_, thickness)| Named(thickness)),
            samples: self.quality.map(|quality| if quality.0 == Quality::High { HIGH_SAMPLES } else { 1 }),
            caustics: self.quality.map(|quality| Named(quality.0 == Quality::High)),
            layers: self.quality.map(|quality| Named(quality.0 != Quality::Draft)),
            ..smoothing
        }
    }

    /// A filter has its own defaults, and each of them one for spheres and one for ellipsoids.
    fn implied_smoothing(&self, below: &Self) -> Self {
        let smoothing_of = |options: &Self| {
            let form = options.curvature_flow.map(|form| form.0);
            match (options.filter.map(|filter| filter.0), form) {
                (None | Some(Filter::CurvatureFlow), Some(form)) => Some(Smoothing::flow(form)),
                (filter, _) => filter.map(Smoothing::of),
            }
        };
        let named = smoothing_of(self);
        let Some(smoothing) = named.or_else(|| self.anisotropy.and_then(|_| smoothing_of(below))) else {
            return Self::default();
        };
        let smoothing = match self.anisotropy.or(below.anisotropy) {
            Some(Named(false)) => smoothing,
            _ => smoothing.for_ellipsoids(),
        };
        let implied = Self::of_smoothing(&smoothing);
        if named.is_some() { implied } else { Self { strength: implied.strength, ..Self::default() } }
    }

    fn of_settings(settings: &Settings) -> Self {
        let Settings { anisotropy, detail, .. } = settings;
        let smoothing = Self::of_smoothing(&settings.smoothing);
        Self {
            splat_scale: Some(widen(settings.splat_scale)),
            density_threshold: Some(widen(settings.density_threshold)),
            anisotropy: Some(Named(anisotropy.enabled)),
            kappa: Some(widen(anisotropy.kappa)),
            support: Some(widen(anisotropy.support)),
            min_neighbours: Some(widen(anisotropy.min_neighbours)),
            center_smoothing: Some(widen(anisotropy.center_smoothing)),
            ellipsoid_min_px: Some(widen(anisotropy.min_radius_px)),
            filter_scale: Some(Named(settings.filter_scale)),
            thickness_scale: Some(Named(settings.thickness_scale)),
            min_thickness: Some(widen(settings.min_thickness)),
            normal_step: Some(widen(settings.normal_step)),
            noise: Some(widen(detail.noise)),
            noise_wavelength: Some(widen(detail.wavelength)),
            noise_octaves: Some(detail.octaves),
            noise_scale: Some(Named(detail.scale)),
            agitated_gain: Some(widen(detail.agitated_gain)),
            foam: Some(Named(detail.foam)),
            foam_opacity: Some(widen(detail.foam_opacity)),
            foam_color: Some(detail.foam_color.map(widen)),
            droplet_opacity: Some(widen(settings.droplet.opacity)),
            droplet_fade: Some(widen(settings.droplet.fade)),
            foam_speed_min: Some(widen(detail.foam_speed[0])),
            foam_speed_max: Some(widen(detail.foam_speed[1])),
            fixed_thickness: Some(settings.fixed_thickness.map_or(0.0, widen)),
            layers: Some(Named(settings.layers)),
            filter: smoothing.filter,
            curvature_flow: smoothing.curvature_flow,
            strength: smoothing.strength,
            iterations: smoothing.iterations,
            exact_2d: smoothing.exact_2d,
            filter_max_px: smoothing.filter_max_px,
            filter_range: smoothing.filter_range,
            filter_clamp: smoothing.filter_clamp,
            ..Self::of_optics(&settings.optics)
        }
    }

    /// What a look is made of.
    pub fn of_optics(optics: &Optics) -> Self {
        let (absorption, absorption_per_world) = match optics.absorption {
            Absorption::PerRadius(rgb) => (Some(rgb.map(widen)), None),
            Absorption::PerWorld(rgb) => (None, Some(rgb.map(widen))),
        };
        Self {
            fresnel: Some(Named(optics.fresnel)),
            refractive_index: Some(widen(optics.refractive_index)),
            metal: Some(optics.metal.map(widen)),
            roughness: Some(widen(optics.roughness)),
            absorption,
            absorption_per_world,
            scattering: Some(optics.scattering.map(widen)),
            albedo: Some(optics.albedo.map(widen)),
            opaque: Some(Named(optics.opaque)),
            color: Some(optics.color.map(widen)),
            refraction: Some(widen(optics.refraction)),
            specular: Some(widen(optics.specular)),
            shininess: Some(widen(optics.shininess)),
            ..Self::default()
        }
    }

    fn of_smoothing(smoothing: &Smoothing) -> Self {
        Self {
            filter: Some(Named(smoothing.filter)),
            curvature_flow: Some(Named(smoothing.curvature_flow)),
            strength: Some(widen(smoothing.strength)),
            iterations: Some(smoothing.iterations),
            exact_2d: Some(smoothing.exact_2d),
            filter_max_px: Some(smoothing.max_radius_px),
            filter_range: Some(widen(smoothing.range)),
            filter_clamp: Some(widen(smoothing.clamp)),
            ..Self::default()
        }
    }

    /// The look.
    pub fn settings(&self) -> Settings {
        let mut settings = Settings::default();
        set(&mut settings.splat_scale, self.splat_scale);
        set(&mut settings.density_threshold, self.density_threshold);
        settings.filter_scale = self.filter_scale.map_or(settings.filter_scale, |scale| scale.0);
        settings.thickness_scale = self.thickness_scale.map_or(settings.thickness_scale, |scale| scale.0);
        set(&mut settings.min_thickness, self.min_thickness);
        set(&mut settings.normal_step, self.normal_step);

        let anisotropy = &mut settings.anisotropy;
        anisotropy.enabled = self.anisotropy.map_or(anisotropy.enabled, |enabled| enabled.0);
        set(&mut anisotropy.kappa, self.kappa);
        set(&mut anisotropy.support, self.support);
        set(&mut anisotropy.min_neighbours, self.min_neighbours);
        set(&mut anisotropy.center_smoothing, self.center_smoothing);
        set(&mut anisotropy.min_radius_px, self.ellipsoid_min_px);

        let smoothing = &mut settings.smoothing;
        smoothing.filter = self.filter.map_or(smoothing.filter, |filter| filter.0);
        smoothing.curvature_flow = self.curvature_flow.map_or(smoothing.curvature_flow, |form| form.0);
        set(&mut smoothing.strength, self.strength);
        smoothing.iterations = self.iterations.unwrap_or(smoothing.iterations);
        smoothing.exact_2d = self.exact_2d.unwrap_or(smoothing.exact_2d);
        smoothing.max_radius_px = self.filter_max_px.unwrap_or(smoothing.max_radius_px);
        set(&mut smoothing.range, self.filter_range);
        set(&mut smoothing.clamp, self.filter_clamp);

        let detail = &mut settings.detail;
        set(&mut detail.noise, self.noise);
        set(&mut detail.wavelength, self.noise_wavelength);
        detail.octaves = self.noise_octaves.unwrap_or(detail.octaves);
        detail.scale = self.noise_scale.map_or(detail.scale, |scale| scale.0);
        set(&mut detail.agitated_gain, self.agitated_gain);
        detail.foam = self.foam.map_or(detail.foam, |foam| foam.0);
        set(&mut detail.foam_opacity, self.foam_opacity);
        detail.foam_color = self.foam_color.map_or(detail.foam_color, |rgb| rgb.map(|v| v as f32));
        set(&mut detail.foam_speed[0], self.foam_speed_min);
        set(&mut detail.foam_speed[1], self.foam_speed_max);

        let droplet = &mut settings.droplet;
        droplet.color = settings.detail.foam_color;
        set(&mut droplet.opacity, self.droplet_opacity);
        set(&mut droplet.fade, self.droplet_fade);
        droplet.shutter = (self.shutter.unwrap_or(SHUTTER) / self.fps()) as f32;

        settings.fixed_thickness = self.fixed_thickness.filter(|thickness| *thickness > 0.0).map(|v| v as f32);
        settings.layers = self.layers.map_or(settings.layers, |layers| layers.0);
        let optics = &mut settings.optics;
        optics.fresnel = self.fresnel.map_or(optics.fresnel, |fresnel| fresnel.0);
        set(&mut optics.refractive_index, self.refractive_index);
        if let Some(rgb) = self.absorption {
            optics.absorption = Absorption::PerRadius(rgb.map(|v| v as f32));
        }
        if let Some(rgb) = self.absorption_per_world {
            optics.absorption = Absorption::PerWorld(rgb.map(|v| v as f32));
        }
        set_rgb(&mut optics.metal, self.metal);
        set(&mut optics.roughness, self.roughness);
        set_rgb(&mut optics.scattering, self.scattering);
        set_rgb(&mut optics.albedo, self.albedo);
        optics.opaque = self.opaque.map_or(optics.opaque, |opaque| opaque.0);
        set_rgb(&mut optics.color, self.color);
        set(&mut optics.refraction, self.refraction);
        set(&mut optics.specular, self.specular);
        set(&mut optics.shininess, self.shininess);
        settings.coloring = self.coloring();
        for (place, liquid) in settings.other_liquids.iter_mut().zip(self.liquid.iter().flatten()) {
            *place = Some(liquid.optics());
        }
        settings
    }

    /// What the particles' colours do.
    fn coloring(&self) -> Coloring {
        match (&self.color_by, self.color_as) {
            (None, _) => Coloring::Off,
            (Some(_), Some(Named(ColorAs::Absorption))) => {
                Coloring::Absorption(self.color_depth.unwrap_or(COLOR_DEPTH) as f32)
            }
            (Some(_), _) => Coloring::Surface,
        }
    }

    /// Whether a picture whose colours stand for numbers has a legend.
    pub fn has_legend(&self) -> bool {
        self.legend.is_none_or(|legend| legend.0)
    }

    /// What agitates particles.
    pub fn agitation(&self) -> AgitationLimits {
        let limits = AgitationLimits::default();
        let [low, high] = limits.first_frame;
        let (low, high) = (self.foam_speed_min.unwrap_or(low), self.foam_speed_max.unwrap_or(high));
        AgitationLimits {
            threshold: self.agitation_threshold.unwrap_or(limits.threshold),
            cooling: self.cooling.unwrap_or(limits.cooling),
            first_frame: [low, high.max(1.001 * low).max(f64::MIN_POSITIVE)],
        }
    }

    /// Frames per second of the simulation.
    pub fn fps(&self) -> f64 {
        self.fps.unwrap_or(FPS)
    }

    /// Radius of droplets whose file has none, in particle radii.
    pub fn droplet_radius(&self) -> f64 {
        self.droplet_radius.unwrap_or(DROPLET_RADIUS)
    }

    /// What to render.
    pub fn inputs(&self) -> Result<&[String], Error> {
        match self.input.as_deref() {
            None | Some([]) => {
                Err(Error::usage("no input: give particle files, a folder or a pattern (see `limpid render --help`)"))
            }
            Some(inputs) => Ok(inputs),
        }
    }

    /// Pixels across and down.
    pub fn size(&self) -> [u32; 2] {
        self.size.unwrap_or_default().0
    }

    /// Vertical field of view in radians.
    pub fn fov_y(&self) -> f64 {
        self.fov.unwrap_or(FOV_DEGREES).to_radians()
    }

    /// The data's up axis.
    pub fn data_up(&self) -> DVec3 {
        match self.up {
            Some(Named(Axis::X)) => DVec3::X,
            Some(Named(Axis::Z)) => DVec3::Z,
            Some(Named(Axis::Y)) | None => DVec3::Y,
        }
    }

    /// What is behind the fluid.
    pub fn background(&self) -> Background {
        self.background.map_or(Background::default(), |background| background.0)
    }

    /// Whether the liquid bends the sun's light on the scene.
    pub fn caustics(&self) -> bool {
        self.caustics.is_some_and(|on| on.0)
    }

    /// Angle that the sun's disc spans, radians.
    pub fn sun_size(&self) -> f64 {
        self.sun_size.unwrap_or(SUN_SIZE_DEGREES).to_radians()
    }

    /// Samples of each pixel.
    pub fn samples(&self) -> u32 {
        self.samples.unwrap_or(1)
    }

    /// What to make of every frame after it is read.
    ///
    /// # Errors
    /// A condition or a new name that is none.
    pub fn selection(&self) -> Result<Selection, Error> {
        let conditions = self.r#where.iter().flatten().map(|text| Condition::parse_all(text));
        let conditions: Vec<Vec<Condition>> =
            conditions.collect::<Result<_, _>>().map_err(|problem| Error::usage(format!("--where {problem}")))?;
        let rename = |text: &String| match text.split_once('=') {
            Some((name, in_file)) if !name.is_empty() && !in_file.is_empty() => Ok((name.into(), in_file.into())),
            _ => Err(Error::usage(format!("--attribute {text}: must be NAME=IN_FILE, like velocity=Vel"))),
        };
        Ok(Selection {
            renames: self.attribute.iter().flatten().map(rename).collect::<Result<_, _>>()?,
            unit_scale: self.unit_scale,
            conditions: conditions.concat(),
            clip: self.clip,
            least_neighbours: self.drop_isolated.filter(|least| *least > 0),
        })
    }

    /// Factor of the light.
    pub fn exposure(&self) -> f32 {
        self.exposure.unwrap_or(EXPOSURE) as f32
    }

    /// Whether there is a floor.
    pub fn has_floor(&self) -> bool {
        self.floor.is_none_or(|floor| floor.0)
    }

    /// Strength of the sun.
    pub fn sun(&self) -> f64 {
        self.sun.unwrap_or(SUN)
    }

    /// Whether to say nothing but errors and warnings.
    pub fn quiet(&self) -> bool {
        self.quiet.unwrap_or(false)
    }
}

fn set(setting: &mut f32, option: Option<f64>) {
    if let Some(value) = option {
        *setting = value as f32;
    }
}

fn set_rgb(setting: &mut [f32; 3], option: Option<[f64; 3]>) {
    if let Some(rgb) = option {
        *setting = rgb.map(|v| v as f32);
    }
}

/// The f64 with the fewest digits that stands for the same f32: 1.333, not 1.3329999446868896.
fn widen(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(f64::from(value))
}

/// Three numbers between commas.
fn triple(text: &str) -> Result<[f64; 3], String> {
    numbers(text).map_err(|problem| format!("{problem}, like 1,2.5,-3"))
}

/// N numbers between commas.
fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|number| number.trim().parse()).collect();
    let numbers = numbers.ok().and_then(|numbers| numbers.try_into().ok());
    numbers.ok_or_else(|| format!("must be {N} numbers between commas"))
}
