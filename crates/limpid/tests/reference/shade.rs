//! Light in and on the liquid (van der Laan 2009, Eq. 13-15, with the exact dielectric Fresnel term).

use super::environment::{SUN_LIGHT, Scene, Surroundings, light_on};
use super::{Camera, Ray};
use glam::{DVec2, DVec3, DVec4, FloatExt};
use limpid::{Absorption, Fresnel, Optics, Settings};

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
        let submerged = self.depth <= 1.0005 * self.camera.view.near;
        let cosine = (-self.normal.dot(toward)).clamp(1e-4, 1.0);
        let reflectance = if submerged { DVec3::ZERO } else { reflectance(optics, cosine) };
        let through = self.transmittance();
        let sun = self.sunlight();
        let lit = light_on(&self.surroundings.environment, self.to_world(self.normal), sun);
        let [base, glow] = [optics.albedo, optics.color].map(|rgb| DVec3::from_array(rgb.map(f64::from)));
        let body = (1.0 - through) * (scattered_share(optics, self.radius) * base * lit + glow);
        let glint = if submerged { DVec3::ZERO } else { self.glint(toward) * sun };
        let own = reflectance * self.reflected(toward) + glint + (1.0 - reflectance) * body;
        let transmitted = (1.0 - reflectance) * through;
        match scene {
            None => own.extend(1.0 - transmitted.element_sum() / 3.0),
            Some(scene) => (own + transmitted * self.behind(scene, toward)).extend(1.0),
        }
    }

    /// Beer-Lambert.
    fn transmittance(&self) -> DVec3 {
        transmittance(&self.settings.optics, self.radius, self.thickness)
    }

    fn to_world(&self, direction: DVec3) -> DVec3 {
        self.camera.view.view_from_world.inverse().transform_vector3(direction)
    }

    fn reflected(&self, toward: DVec3) -> DVec3 {
        let world_from_view = self.camera.view.view_from_world.inverse();
        let position = world_from_view.transform_point3(self.ray.at(self.depth));
        let direction = self.to_world(toward.reflect(self.normal));
        let roughness = f64::from(self.settings.optics.roughness);
        self.surroundings.light(position, direction, 2.0 * roughness * roughness)
    }

    /// Share of the sun's light that arrives 2 r above the surface.
    fn sunlight(&self) -> DVec3 {
        let position = self.camera.view.view_from_world.inverse().transform_point3(self.ray.at(self.depth));
        let above = position + 2.0 * self.radius * self.surroundings.environment.sun;
        self.surroundings.shadow.light(above)
    }

    /// Blinn's highlight of the sun, four times as bright as its light on a wall.
    fn glint(&self, toward: DVec3) -> DVec3 {
        let optics = &self.settings.optics;
        let sun = self.camera.view.view_from_world.transform_vector3(self.surroundings.environment.sun);
        let highlight = self.normal.dot((sun - toward).normalize()).max(0.0).powf(optics.shininess.into());
        4.0 * self.surroundings.environment.sun_strength * f64::from(optics.specular) * highlight * SUN_LIGHT
    }

    /// The scene along the bent ray, as far behind the surface as the liquid is thick.
    fn behind(&self, scene: &Scene, toward: DVec3) -> DVec3 {
        let optics = &self.settings.optics;
        let inside = toward.refract(self.normal, 1.0 / f64::from(optics.refractive_index));
        let bent = toward.lerp(inside, optics.refraction.into());
        let exit = self.ray.at(self.depth) + self.thickness * bent;
        let px = self.camera.px_of(exit);
        let usable = exit.z < 0.0 && scene.depth[self.camera.index_at(px)] > self.depth;
        self.bilinear(scene, if usable { px } else { self.px })
    }

    /// The scene's colour, texels in front of the surface left out.
    fn bilinear(&self, scene: &Scene, px: DVec2) -> DVec3 {
        let last = DVec2::new(self.camera.size[0].into(), self.camera.size[1].into()) - 1.0;
        let at = (px - 0.5).clamp(DVec2::ZERO, last);
        let corner = |offset: DVec2| {
            let along = offset * at.fract() + (1.0 - offset) * (1.0 - at.fract());
            (self.camera.index_at(at + offset), along.x * along.y)
        };
        let corners = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE].map(corner);
        let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
        for (texel, weight) in corners.into_iter().filter(|(texel, _)| scene.depth[*texel] > self.depth) {
            sum += weight * scene.color[texel];
            weights += weight;
        }
        if weights > 0.0 { sum / weights } else { scene.color[corners[0].0] }
    }
}

/// Absorption per world unit.
fn per_world(optics: &Optics, radius: f64) -> DVec3 {
    DVec3::from_array(match optics.absorption {
        Absorption::PerRadius(rgb) => rgb.map(|k| f64::from(k) / radius),
        Absorption::PerWorld(rgb) => rgb.map(f64::from),
    })
}

/// Scattering per world unit.
fn scattering(optics: &Optics, radius: f64) -> DVec3 {
    per_world(
        &Optics {
            absorption: match optics.absorption {
                Absorption::PerRadius(_) => Absorption::PerRadius(optics.scattering),
                Absorption::PerWorld(_) => Absorption::PerWorld(optics.scattering),
            },
            ..*optics
        },
        radius,
    )
}

/// What a shadow loses per world unit.
pub fn extinction(optics: &Optics, radius: f64) -> DVec3 {
    if optics.opaque { DVec3::splat(4.0 / radius) } else { per_world(optics, radius) + scattering(optics, radius) }
}

/// What goes straight through so much liquid.
pub fn transmittance(optics: &Optics, radius: f64, thickness: f64) -> DVec3 {
    if optics.opaque {
        return DVec3::ZERO;
    }
    (-extinction(optics, radius) * thickness).exp()
}

/// Of what does not go straight through, the share that is scattered and not absorbed.
fn scattered_share(optics: &Optics, radius: f64) -> DVec3 {
    if optics.opaque {
        return DVec3::ONE;
    }
    scattering(optics, radius) / extinction(optics, radius).max(DVec3::splat(1e-30))
}

/// What the surface of a metal or a dielectric reflects.
fn reflectance(optics: &Optics, cosine: f64) -> DVec3 {
    let metal = DVec3::from_array(optics.metal.map(f64::from));
    let index = f64::from(optics.refractive_index);
    let schlick = |r0: DVec3| r0 + (1.0 - r0) * (1.0 - cosine).powi(5);
    match optics.fresnel {
        _ if metal.max_element() > 0.0 => schlick(metal),
        Fresnel::Schlick => schlick(DVec3::splat(((index - 1.0) / (index + 1.0)).powi(2))),
        Fresnel::Exact => DVec3::splat(fresnel(cosine, index)),
    }
}

/// Unpolarised reflectance by Snell's law and the amplitudes of both polarisations.
pub fn fresnel(cosine: f64, index: f64) -> f64 {
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

#[test]
fn schlick_of_water() {
    let water = Optics { refractive_index: 1.33, fresnel: Fresnel::Schlick, ..Optics::default() };
    for (degrees, expected) in [(0.0, 0.02006), (45.0, 0.02217), (89.0, 0.9174)] {
        assert!((reflectance(&water, f64::to_radians(degrees).cos()).x - expected).abs() < 5e-5, "{degrees} degrees");
    }
}
