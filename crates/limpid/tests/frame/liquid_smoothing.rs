//! Liquids that are smoothed each in its own way.

use crate::common::{Cloud, SIZE, looking, shot_of, with_gpu};
use limpid::{CurvatureFlow, Filter, Paint, Settings, Smoothing};
use limpid_headless::{Aov, Shot};

/// Two bodies of rough water, far apart.
fn clouds() -> (Cloud, Vec<u8>) {
    let body = Cloud::slab(10, 5, 0.05, 0.4);
    let at = |x: f32| body.positions.iter().map(move |p| [p[0] + x, p[1], p[2]]);
    let positions: Vec<_> = at(-0.8).chain(at(0.8)).collect();
    let liquids = positions.iter().map(|p| u8::from(p[0] > 0.0)).collect();
    (Cloud::uniform(positions, 0.05), liquids)
}

fn depth(cloud: &Cloud, liquids: Option<&[u8]>, settings: Settings) -> Vec<u32> {
    let view = looking([0.4, 1.6, 3.0], [0.0; 3], SIZE);
    let shot = Shot { paint: Paint { colors: None, liquids }, ..shot_of(cloud, view, SIZE, settings) };
    let picture = with_gpu(|offscreen| offscreen.render(&shot, &[Aov::Depth])).unwrap();
    picture.aovs[0].values.iter().map(|depth| depth.to_bits()).collect()
}

/// Settings with another smoothing length for the second liquid.
fn apart(settings: Settings, strength: f32) -> Settings {
    let mut settings = settings;
    settings.other_strengths[0] = Some(strength);
    settings
}

/// The left half of a picture, or the right.
fn half(image: &[u32], right: bool) -> Vec<u32> {
    let middle = SIZE[0] as usize / 2;
    let rows = image.chunks(SIZE[0] as usize);
    rows.flat_map(|row| if right { &row[middle..] } else { &row[..middle] }).copied().collect()
}

#[test]
fn each_is_smoothed_as_if_it_were_alone() {
    let (cloud, liquids) = clouds();
    let flow = Smoothing::flow(CurvatureFlow::Explicit);
    let filters = [Filter::NarrowRange, Filter::Gaussian, Filter::Bilateral, Filter::CurvatureFlow].map(Smoothing::of);
    let spheres = filters.into_iter().chain([Smoothing { iterations: 20, strength: 0.2, ..flow }]);
    let spheres = spheres.map(|smoothing| Settings { smoothing, ..Settings::spheres() });
    for settings in spheres.chain([Settings::default()]) {
        let strong = 2.0 * settings.smoothing.strength;
        let with = |strength| Settings { smoothing: Smoothing { strength, ..settings.smoothing }, ..settings };
        let mixed = depth(&cloud, Some(&liquids), apart(settings, strong));
        let [weak, all_strong] = [settings, with(strong)].map(|settings| depth(&cloud, Some(&liquids), settings));
        let what = settings.smoothing.filter;
        assert!(half(&mixed, false) == half(&weak, false), "{what:?}, the first");
        assert!(half(&mixed, true) != half(&weak, true), "{what:?}, no difference");
        let (mixed, strong) = (half(&mixed, true), half(&all_strong, true));
        let most = mixed.iter().zip(&strong).filter(|(a, b)| a != b);
        let most = most.map(|(a, b)| (f32::from_bits(*a) - f32::from_bits(*b)).abs()).fold(0.0, f32::max);
        assert!(most < 1e-4 * 0.05, "{what:?}, the second: {most}");
    }
}

#[test]
fn no_smoothing_at_all_leaves_one_liquid_as_splatted() {
    let (cloud, liquids) = clouds();
    let mixed = depth(&cloud, Some(&liquids), apart(Settings::spheres(), 0.0));
    let raw = Settings { smoothing: Smoothing::of(Filter::None), ..Settings::spheres() };
    assert!(half(&mixed, true) == half(&depth(&cloud, None, raw), true));
}

#[test]
fn equal_lengths_change_no_bit() {
    let (cloud, liquids) = clouds();
    let settings = Settings::default();
    let same = apart(settings, settings.smoothing.strength);
    assert!(depth(&cloud, Some(&liquids), same) == depth(&cloud, None, settings));
}
