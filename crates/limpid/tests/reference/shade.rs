//! Light in and on the liquid (van der Laan 2009, Eq. 13-15, with the exact dielectric Fresnel term).

use super::environment::{SUN_LIGHT, Scene, Surroundings};
use super::{Camera, Ray};
use glam::{DVec2, DVec3, DVec4, FloatExt};
use limpid::{Absorption, Optics, Settings};

/// Linear premultiplied colour of each pixel's surface; 0 where there is none to see. `radius` is r.
pub fn shade(
    camera: &Camera,
    settings: &Settings,
    radius: f64,
    surroundings: &Surroundings,
    scene: Option<&Scene>,
    (depth, normal, thickness): (&[f64], &[DVec3], &[f64]),
) -> Vec<DVec4> {
    let pixel = |(i, px): (usize, DVec2)| {
        let hidden = scene.is_some_and(|scene| depth[i] >= scene.depth[i]);
        let thin = thickness[i] < f64::from(settings.min_thickness) * radius;
        if depth[i].is_infinite() || hidden || thin {
            return DVec4::ZERO;
        }
        let surface = Surface {
            camera,
            settings,
            radius,
            surroundings,
            px,
            ray: camera.ray(px),
            depth: depth[i],
            normal: normal[i],
            thickness: thickness[i],
        };
        surface.color(scene)
    };
    camera.pixels().map(pixel).collect()
}

struct Surface<'a> {
    camera: &'a Camera,
    settings: &'a Settings,
    radius: f64,
    surroundings: &'a Surroundings,
    px: DVec2,
    ray: Ray,
    depth: f64,
    /// View space.
    normal: DVec3,
    thickness: f64,
}

impl Surface<'_> {
    fn color(&self, scene: Option<&Scene>) -> DVec4 {
        let optics = &self.settings.optics;
        let toward = self.ray.direction.normalize();
        let reflectance = fresnel((-self.normal.dot(toward)).clamp(0.0, 1.0), optics.refractive_index.into());
        let transmitted = (1.0 - reflectance) * self.transmittance();
        let body = DVec3::from_array(optics.color.map(f64::from)) * (1.0 - reflectance - transmitted);
        let own = body + reflectance * self.reflected(toward) + self.glint(toward);
        match scene {
            None => own.extend(1.0 - transmitted.element_sum() / 3.0),
            Some(scene) => (own + transmitted * self.behind(scene, toward)).extend(1.0),
        }
    }

    /// Beer-Lambert.
    fn transmittance(&self) -> DVec3 {
        (-per_world(&self.settings.optics, self.radius) * self.thickness).exp()
    }

    fn reflected(&self, toward: DVec3) -> DVec3 {
        let world_from_view = self.camera.view.view_from_world.inverse();
        let position = world_from_view.transform_point3(self.ray.at(self.depth));
        let direction = world_from_view.transform_vector3(toward.reflect(self.normal));
        self.surroundings.light(position, direction, 0.02)
    }

    /// Blinn's highlight of the sun, four times as bright as its light on a wall.
    fn glint(&self, toward: DVec3) -> DVec3 {
        let optics = &self.settings.optics;
        let sun = self.camera.view.view_from_world.transform_vector3(self.surroundings.environment.sun);
        let highlight = self.normal.dot((sun - toward).normalize()).max(0.0).powf(optics.shininess.into());
        4.0 * f64::from(optics.specular) * highlight * SUN_LIGHT
    }

    /// The scene along the bent ray, as far behind the surface as the liquid is thick.
    fn behind(&self, scene: &Scene, toward: DVec3) -> DVec3 {
        let optics = &self.settings.optics;
        let inside = toward.refract(self.normal, 1.0 / f64::from(optics.refractive_index));
        let bent = toward.lerp(inside, optics.refraction.into());
        let exit = self.ray.at(self.depth) + self.thickness * bent;
        let px = self.camera.px_of(exit);
        let usable = exit.z < 0.0 && scene.depth[self.camera.index_at(px)] > self.depth;
        self.bilinear(&scene.color, if usable { px } else { self.px })
    }

    fn bilinear(&self, image: &[DVec3], px: DVec2) -> DVec3 {
        let last = DVec2::new(self.camera.size[0].into(), self.camera.size[1].into()) - 1.0;
        let at = (px - 0.5).clamp(DVec2::ZERO, last);
        let texel = |x: f64, y: f64| image[self.camera.index_at(DVec2::new(x, y))];
        let row = |y: f64| texel(at.x, y).lerp(texel(at.x + 1.0, y), at.x.fract());
        row(at.y).lerp(row(at.y + 1.0), at.y.fract())
    }
}

/// Absorption per world unit.
pub fn per_world(optics: &Optics, radius: f64) -> DVec3 {
    DVec3::from_array(match optics.absorption {
        Absorption::PerRadius(rgb) => rgb.map(|k| f64::from(k) / radius),
        Absorption::PerWorld(rgb) => rgb.map(f64::from),
    })
}

/// Unpolarised reflectance by Snell's law and the amplitudes of both polarisations.
fn fresnel(cosine: f64, index: f64) -> f64 {
    let inner = (1.0 - (1.0 - cosine * cosine) / (index * index)).sqrt();
    let across = (cosine - index * inner) / (cosine + index * inner);
    let along = (index * cosine - inner) / (index * cosine + inner);
    (across * across).lerp(along * along, 0.5)
}

#[test]
fn fresnel_of_water() {
    for (degrees, expected) in [(0.0, 0.02006), (45.0, 0.02752), (89.0, 0.8960)] {
        assert!((fresnel(f64::to_radians(degrees).cos(), 1.33) - expected).abs() < 5e-5, "{degrees} degrees");
    }
}
