//! `limpid render`: from particle files to pictures.

mod ahead;
mod outputs;
mod partial;
mod progress;
mod timings;

use crate::console;
use crate::failure::Failure;
use crate::lost;
use crate::write::{write_aov, write_layers, write_picture};
use clap::Args;
use limpid_headless::{Aov, Background, Offscreen, Shot, pipeline_folder};
use limpid_shot::environment;
use limpid_shot::{Diffuse, FrameParticles, Inputs, Legend, Living, Options, Paints, Props, Stage, Survey, config};
use outputs::{FrameOutputs, Outputs};
use progress::Progress;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// The command line of `limpid render`.
#[derive(Args, Debug)]
pub struct RenderArguments {
    #[command(flatten)]
    options: Options,
    /// Read options from this file, keys named like the options; options on the command line win
    #[arg(long, value_name = "FILE.toml")]
    config: Option<PathBuf>,
    /// Print all options as they would be used, in the form that --config reads, and stop
    #[arg(long)]
    print_config: bool,
    /// Save what the K-th of N parts of a single frame's particles leaves in the picture's images to -o OUT.partial, for
    /// --partials; needs --anisotropy off --layers off
    #[arg(long, value_name = "K/N", help_heading = "More output", conflicts_with = "partials")]
    part: Option<partial::Part>,
    /// Make the picture of these saved parts; INPUT, the same options as theirs and a fixed camera say what is around them
    #[arg(long, value_name = "FILE,FILE,...", value_delimiter = ',', help_heading = "More output")]
    partials: Vec<PathBuf>,
}

/// Renders every frame and writes its files. `started`: when the program was.
pub fn run(arguments: Box<RenderArguments>, started: Instant) -> Result<(), Failure> {
    let options = config::effective(&arguments.options, arguments.config.as_deref())?;
    if arguments.print_config {
        return console::print(&config::print(&options)?);
    }
    let quiet = options.quiet();
    let inputs = Arc::new(Inputs::of(&options)?);
    let sequence = &inputs.sequence;
    if (arguments.part.is_some() || !arguments.partials.is_empty()) && sequence.frames.len() != 1 {
        let frames = sequence.frames.len();
        return Err(Failure::usage(format!(
            "--part and --partials take one frame, not {frames}; choose it by --start and --end"
        )));
    }
    let outputs = Outputs::plan(&options, &sequence.frames, arguments.part.is_some())?;
    outputs.check()?;
    let merged = partial::merged(&arguments.partials)?;
    let props = Props::load(&options, &sequence.frames)?;
    let map = options.environment.as_deref().map(|path| environment::read(Path::new(path))).transpose()?;
    let mut offscreen = Offscreen::new(lost::open(options.adapter.as_deref())?)?;
    if let Some(folder) = pipeline_folder() {
        offscreen.keep_pipelines_in(&folder);
    }
    offscreen.set_partial(merged);
    if let (Some(map), Some(path)) = (map, &options.environment) {
        let bad = |source| Failure::Frame { path: path.into(), source };
        offscreen.set_environment(Some(&map)).map_err(bad)?;
    }

    let mut survey = survey(&inputs, &options)?;
    // A single frame is not read twice.
    let sets: Box<dyn Iterator<Item = _>> = match survey.take_largest().filter(|_| sequence.frames.len() == 1) {
        Some(single) => Box::new(std::iter::once(Ok(single))),
        None => Box::new(ahead::frames(&inputs)),
    };
    let stage = Stage::of(&options, &survey, &props)?;
    let paints = Paints::of(&options, &survey)?;
    let legend = Legend::of(&options, &paints.tint);
    let meshes = props.upload(&offscreen.gpu().device, &offscreen.gpu().queue);
    let mut living = Living::new(&options);
    let mut diffuse = Diffuse::find(&options, &sequence.frames, survey.radius_world())?;
    let progress = Progress::new("rendering", sequence.frames.len(), quiet);
    for (index, ((frame, files), set)) in sequence.frames.iter().zip(&outputs.frames).zip(sets).enumerate() {
        let mut particles = FrameParticles::of(set?, &survey, &paints)?;
        let remarks = living.advance(frame, &mut particles);
        let droplets = diffuse.advance(frame, index, &mut particles)?;
        let bodies = props.at(frame, &meshes);
        let shot = Shot { droplets: &droplets.slices(), ..stage.shot(&options, &particles, &bodies) };
        let wanted = Wanted {
            show: options.show.map(|aov| aov.0),
            legend: legend.as_ref(),
            aovs: &outputs.aovs,
            layers: match (outputs.are_layered, particles.velocities()) {
                (false, _) => &[],
                (true, None) => &LAYERS,
                (true, Some(_)) => &MOVING_LAYERS,
            },
            seconds_per_frame: 1.0 / options.fps(),
        };
        match arguments.part {
            Some(part) => partial::save(&mut offscreen, &shot, part, &files.picture, &frame.path)?,
            None => render(&mut offscreen, &shot, &wanted, files, &frame.path)?,
        }
        if index == 0 {
            // Only now: a failure so far is one line.
            let warnings = sequence.warnings.iter().chain(&survey.warnings).chain(&props.warnings);
            for warning in warnings.chain(&remarks.warnings) {
                console::warn(warning);
            }
            let notes = survey.radius_note().into_iter().chain(paints.tint.note(&options));
            notes.filter(|_| !quiet).for_each(|note| console::note(&note));
        }
        droplets.warnings.iter().for_each(|warning| console::warn(warning));
        if !quiet {
            remarks.notes.iter().chain(&droplets.notes).for_each(|note| console::note(note));
        }
        if index + 1 == sequence.frames.len()
            && let Some(target) = &outputs.timings
        {
            timings::measure(&mut offscreen, &shot, target, &frame.path, started)?;
        }
        progress.advance();
    }
    progress.finish();
    if !quiet { outputs.report() } else { Ok(()) }
}

/// Looks through all frames.
fn survey(inputs: &Arc<Inputs>, options: &Options) -> Result<Survey, Failure> {
    let mut survey = Survey::default();
    let progress = Progress::new("looking through", inputs.sequence.frames.len(), options.quiet());
    for set in ahead::frames(inputs) {
        survey.include(&set?, options);
        progress.advance();
    }
    progress.finish();
    survey.settle(options)?;
    Ok(survey)
}

/// What a frame's files show.
struct Wanted<'a> {
    /// The buffer that the picture is of; None: the shaded fluid.
    show: Option<Aov>,
    /// What is drawn over the picture.
    legend: Option<&'a Legend>,
    aovs: &'a [outputs::AovKind],
    /// The layers of the picture's file; none: it is a PNG.
    layers: &'a [Aov],
    /// The time that the motion in a layer takes.
    seconds_per_frame: f64,
}

/// What an OpenEXR file of a picture holds.
const LAYERS: [Aov; 6] = [Aov::Picture, Aov::Depth, Aov::Normal, Aov::Thickness, Aov::Passage, Aov::Albedo];
/// The same of particles with velocities.
const MOVING_LAYERS: [Aov; 7] =
    [Aov::Picture, Aov::Depth, Aov::Normal, Aov::Thickness, Aov::Passage, Aov::Albedo, Aov::Motion];

/// Renders one frame and writes its picture and buffers.
fn render(
    offscreen: &mut Offscreen,
    shot: &Shot<'_>,
    wanted: &Wanted<'_>,
    files: &FrameOutputs,
    input: &Path,
) -> Result<(), Failure> {
    let kinds = wanted.aovs.iter().map(|kind| kind.aov).chain(wanted.layers.iter().copied()).chain(wanted.show);
    let kinds: Vec<Aov> = kinds.collect();
    let mut picture =
        offscreen.render(shot, &kinds).map_err(|source| Failure::Frame { path: input.to_owned(), source })?;
    if let (Some(show), Some(image)) = (wanted.show, picture.aovs.last()) {
        picture.rgba = show.picture(image, shot.particles.reference_radius());
    }
    if let Some(legend) = wanted.legend {
        legend.draw(&mut picture.rgba, picture.size);
    }
    if !wanted.layers.is_empty() {
        // Compositing programs want pixels to the next frame.
        for (_, image) in
            kinds.iter().zip(&mut picture.aovs).skip(wanted.aovs.len()).filter(|(k, _)| **k == Aov::Motion)
        {
            image.values.iter_mut().for_each(|value| *value *= wanted.seconds_per_frame as f32);
        }
    }
    let layers: Vec<_> = kinds.iter().copied().zip(&picture.aovs).skip(wanted.aovs.len()).collect();
    if !wanted.layers.is_empty() {
        write_layers(&files.picture, &layers)?;
    }
    let opaque = wanted.show.is_some() || shot.background != Background::Transparent;
    if wanted.layers.is_empty() {
        write_picture(&files.picture, &picture, opaque)?;
    }
    for ((kind, path), image) in wanted.aovs.iter().zip(&files.aovs).zip(&picture.aovs) {
        write_aov(path, kind.format, kind.aov, image)?;
    }
    Ok(())
}
