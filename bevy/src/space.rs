//! From Bevy's spaces to limpid's. To limpid, the world is the space of the fluid, so that particles stay as they are.

use bevy::math::{Affine3A, DAffine3, DMat4, DQuat, DVec3, Mat4, Rect, Vec3};
use limpid::glam;
use limpid::{Environment, View};

/// How a camera of Bevy's sees a fluid.
pub(crate) struct Eye {
    pub world_from_view: Affine3A,
    pub clip_from_view: Mat4,
    /// The part of the target that it fills: 0 to 1 across and down.
    pub viewport: Rect,
}

impl Eye {
    /// limpid's view of a fluid. None: the camera or the fluid is scaled to nothing.
    pub fn view_of(&self, world_from_fluid: Affine3A) -> Option<View> {
        let view_from_fluid = affine(self.world_from_view).inverse() * affine(world_from_fluid);
        let (scale, rotation, translation) = parts(view_from_fluid)?;
        // limpid's views are rigid: what scale there is goes into the projection.
        let rigid = DAffine3::from_rotation_translation(rotation, translation / scale);
        let projection = matrix(self.clip_from_view);
        let is_perspective = projection.w_axis.w == 0.0;
        let clip_from_rigid = projection * DMat4::from_scale(DVec3::splat(scale));
        let view = View {
            view_from_world: of_limpid(DMat4::from(rigid)),
            clip_from_view: of_limpid(self.target_from_viewport() * clip_from_rigid),
            near: 0.0,
            far: f64::INFINITY,
        };
        let row = |column: bevy::math::DVec4| column.z;
        Some(if is_perspective {
            // Clip space is homogeneous: limpid wants w to be the depth itself.
            let clip_from_view = view.clip_from_view * (1.0 / scale);
            let (z, w) = (row(clip_from_rigid.z_axis) / scale, row(clip_from_rigid.w_axis) / scale);
            View { clip_from_view, near: w / (1.0 + z), ..view }
        } else {
            let (z, w) = (row(clip_from_rigid.z_axis), row(clip_from_rigid.w_axis));
            behind_near(View { near: (w - 1.0) / z, far: w / z, ..view })
        })
    }

    fn target_from_viewport(&self) -> DMat4 {
        let (size, center) = (self.viewport.size().as_dvec2(), self.viewport.center().as_dvec2());
        DMat4::from_translation(DVec3::new(2.0 * center.x - 1.0, 1.0 - 2.0 * center.y, 0.0))
            * DMat4::from_scale(DVec3::new(size.x, size.y, 1.0))
    }
}

/// The same view from farther back where an orthographic one begins at its eye or behind it: limpid's depths are positive.
fn behind_near(view: View) -> View {
    let least = 0.01 * (view.far - view.near);
    if view.near >= least {
        return view;
    }
    let back = least - view.near;
    let along = |z: f64| glam::DMat4::from_translation(glam::DVec3::new(0.0, 0.0, z));
    View {
        view_from_world: along(-back) * view.view_from_world,
        clip_from_view: view.clip_from_view * along(back),
        near: view.near + back,
        far: view.far + back,
    }
}

/// Surroundings in the space of a fluid: nothing but sky, and a floor at that height in the world.
pub(crate) fn surroundings(world_from_fluid: Affine3A, floor: Option<f32>) -> Option<Environment> {
    let (scale, rotation, translation) = parts(affine(world_from_fluid))?;
    let up = of_limpid_vector(rotation.inverse() * DVec3::Y);
    let around = Environment::around(-glam::DVec3::ONE, glam::DVec3::ONE, 0.0, up, glam::DVec3::ZERO);
    let floor = floor.map(|floor| (f64::from(floor) - translation.y) / scale);
    Some(Environment { floor, sun_strength: 0.0, ..around })
}

/// A direction of the world in the space of a fluid.
pub(crate) fn direction_in(world_from_fluid: Affine3A, direction: Vec3) -> Option<glam::DVec3> {
    let (_, rotation, _) = parts(affine(world_from_fluid))?;
    Some(of_limpid_vector((rotation.inverse() * direction.as_dvec3()).normalize()))
}

/// Even scale, rotation and translation.
fn parts(transform: DAffine3) -> Option<(f64, DQuat, DVec3)> {
    let (scale, rotation, translation) = transform.to_scale_rotation_translation();
    let scale = scale.abs().element_product().cbrt();
    let is_usable = scale > 0.0 && scale.is_finite() && rotation.is_finite() && translation.is_finite();
    is_usable.then_some((scale, rotation, translation))
}

fn affine(affine: Affine3A) -> DAffine3 {
    DAffine3::from_cols_array(&affine.to_cols_array().map(f64::from))
}

fn matrix(matrix: Mat4) -> DMat4 {
    DMat4::from_cols_array(&matrix.to_cols_array().map(f64::from))
}

/// Bevy and limpid have different versions of glam.
fn of_limpid(matrix: DMat4) -> glam::DMat4 {
    glam::DMat4::from_cols_array(&matrix.to_cols_array())
}

fn of_limpid_vector(vector: DVec3) -> glam::DVec3 {
    glam::DVec3::from_array(vector.to_array())
}

#[cfg(test)]
mod tests;
