//! The directional lights, as limpid's sun and lamps.

use crate::extract::Scene;
use bevy::camera::visibility::InheritedVisibility;
use bevy::color::{ColorToComponents, LinearRgba};
use bevy::ecs::system::{Query, ResMut};
use bevy::light::DirectionalLight;
use bevy::math::Vec3;
use bevy::render::Extract;
use bevy::transform::components::GlobalTransform;
use limpid::MOST_LAMPS;
use std::f32::consts::PI;

/// The brightest first, as many as limpid takes.
#[derive(Default)]
pub(crate) struct Lights(Vec<Light>);

/// One of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Light {
    /// Unit vector towards it, in the world.
    pub toward: Vec3,
    /// Linear, times lux.
    illuminance: [f32; 3],
}

type LightQuery<'w, 's> =
    Query<'w, 's, (&'static DirectionalLight, &'static GlobalTransform, &'static InheritedVisibility)>;

pub(crate) fn extract_lights(mut scene: ResMut<Scene>, lights: Extract<LightQuery>) {
    let visible = lights.iter().filter(|(_, _, visibility)| visibility.get());
    let light = |(light, transform, _): (&DirectionalLight, &GlobalTransform, _)| Light {
        toward: transform.back().into(),
        illuminance: LinearRgba::from(light.color).to_f32_array_no_alpha().map(|v| v * light.illuminance),
    };
    scene.lights = Lights::of(visible.map(light).collect());
}

impl Lights {
    fn of(mut lights: Vec<Light>) -> Self {
        lights.sort_by(|a, b| b.luminance().total_cmp(&a.luminance()));
        lights.truncate(1 + MOST_LAMPS);
        Self(lights)
    }

    pub fn sun(&self) -> Option<&Light> {
        self.0.first()
    }

    pub fn lamps(&self) -> &[Light] {
        self.0.get(1..).unwrap_or_default()
    }
}

impl Light {
    fn luminance(&self) -> f32 {
        let [r, g, b] = self.illuminance;
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }

    /// How bright a white wall is that faces it, in a picture of this exposure: limpid's unit of light.
    pub fn strength(&self, exposure: f32) -> f32 {
        self.luminance() * exposure / PI
    }

    /// The same for each channel.
    pub fn color(&self, exposure: f32) -> [f32; 3] {
        self.illuminance.map(|v| v * exposure / PI)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_brightest_is_the_sun_and_three_others_are_lamps() {
        let light = |lux: f32| Light { toward: Vec3::Y, illuminance: [lux; 3] };
        let lights = Lights::of([3.0, 100.0, 1.0, 20.0, 2.0].map(light).into());
        assert_eq!(lights.sun(), Some(&light(100.0)));
        assert_eq!(lights.lamps(), [20.0, 3.0, 2.0].map(light));
        assert_eq!(Lights::default().sun(), None);
        assert_eq!(Lights::default().lamps(), []);
    }

    #[test]
    fn green_light_is_brighter_than_blue() {
        let [green, blue] =
            [[0.0, 10.0, 0.0], [0.0, 0.0, 10.0]].map(|illuminance| Light { toward: Vec3::Y, illuminance });
        assert_eq!(Lights::of(vec![blue, green]).sun(), Some(&green));
    }

    #[test]
    fn a_wall_scatters_its_light_over_a_half_space() {
        let light = Light { toward: Vec3::Y, illuminance: [PI * 500.0; 3] };
        assert!((light.strength(0.002) - 1.0).abs() < 1e-6);
    }
}
