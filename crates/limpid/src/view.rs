//! The camera: a right-handed world, a view space that looks down -z, depths that are positive view distances.

use crate::{Error, Scale};
use bytemuck::{Pod, Zeroable};
use glam::dcamera::rh::{proj::directx, view};
use glam::{DMat4, DVec3, Mat4};

/// Where the picture is taken from and how it is projected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Rigid transform from world to view space. In f64, so that a scene far from the origin keeps its digits.
    pub view_from_world: DMat4,
    /// Projection to wgpu's clip space (depth 0 to 1, standard or reversed, finite or infinite), perspective or
    /// orthographic. Decides what depth the host's depth target gets.
    pub clip_from_view: DMat4,
    /// Nearest view depth that is drawn, world units, above 0: a ball of fluid that reaches past it is cut open there.
    pub near: f64,
    /// Orthographic views only: a view depth beyond everything, world units. Perspective views have no far limit.
    pub far: f64,
}

impl View {
    /// A perspective camera with reversed, infinite depth: `fov_y` is the full vertical field of view in radians, `aspect` is
    /// width over height.
    ///
    /// ```
    /// use limpid::View;
    /// use limpid::glam::{DVec3, dvec3};
    ///
    /// let view = View::perspective(dvec3(0.0, 0.0, 5.0), DVec3::ZERO, DVec3::Y, 0.8, 1.5, 0.1);
    /// assert_eq!(view.eye(), dvec3(0.0, 0.0, 5.0));
    /// // Near things have the larger depth.
    /// assert!((view.clip_from_view.project_point3(dvec3(0.0, 0.0, -0.1)).z - 1.0).abs() < 1e-12);
    /// // A projection of the host's own is as good.
    /// let clip_from_view = limpid::glam::dcamera::rh::proj::directx::perspective(0.8, 1.5, 0.1, 100.0);
    /// let standard = View { clip_from_view, ..view };
    /// assert!(standard.is_perspective());
    /// ```
    pub fn perspective(eye: DVec3, target: DVec3, up: DVec3, fov_y: f64, aspect: f64, near: f64) -> Self {
        Self {
            view_from_world: view::look_at_mat4(eye, target, up),
            clip_from_view: directx::perspective_infinite_reverse(fov_y, aspect, near),
            near,
            far: f64::INFINITY,
        }
    }

    /// An orthographic camera that shows `height` world units from bottom to top.
    pub fn orthographic(eye: DVec3, target: DVec3, up: DVec3, height: f64, aspect: f64, near: f64, far: f64) -> Self {
        let half = 0.5 * height;
        Self {
            view_from_world: view::look_at_mat4(eye, target, up),
            // Reversed depth: near and far change places.
            clip_from_view: directx::orthographic(-half * aspect, half * aspect, -half, half, far, near),
            near,
            far,
        }
    }

    /// The same picture moved by a part of a pixel, `offset_px` to the right and downwards: what is seen through pixel
    /// position p + offset is then seen through p. Averages of several are anti-aliased.
    pub fn shifted_px(&self, offset_px: [f64; 2], size: [u32; 2]) -> Self {
        let [x, y] = [0, 1].map(|axis| 2.0 * offset_px[axis] / f64::from(size[axis]));
        let clip_from_view = DMat4::from_translation(DVec3::new(-x, y, 0.0)) * self.clip_from_view;
        Self { clip_from_view, ..*self }
    }

    /// Whether rays leave one point (perspective) or run side by side (orthographic).
    pub fn is_perspective(&self) -> bool {
        self.clip_from_view.w_axis.w == 0.0
    }

    /// The camera's position (perspective) or the origin of its view space (orthographic), in world space.
    pub fn eye(&self) -> DVec3 {
        self.view_from_world.inverse().transform_point3(DVec3::ZERO)
    }

    /// View depth of a nearness (see [`crate::FrameBuffers`]); +infinity for 0, where there is no fluid.
    pub fn depth_of(&self, nearness: f32) -> f32 {
        if nearness <= 0.0 {
            f32::INFINITY
        } else if self.is_perspective() {
            1.0 / nearness
        } else {
            (1.0 - nearness) * self.far as f32
        }
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        let finite = self.view_from_world.is_finite() && self.clip_from_view.is_finite() && self.near.is_finite();
        if !finite {
            return Err(Error::View(
                "its matrices hold numbers that are not finite (are eye and target the same point, or is up parallel to the view?)",
            ));
        }
        if self.near <= 0.0 {
            return Err(Error::View("near must be above 0"));
        }
        let finite_far = self.far.is_finite() && self.far > self.near;
        if !self.is_perspective() && !finite_far {
            return Err(Error::View("an orthographic view needs a finite far beyond near"));
        }
        if self.clip_from_view.x_axis.x == 0.0 || self.clip_from_view.y_axis.y == 0.0 {
            return Err(Error::View("its projection is flat (field of view or height of 0?)"));
        }
        Ok(())
    }

    /// What the shaders know of the view: `frame.wgsl`'s `View`. `origin` is where the particles' local space starts.
    /// A picture of `picture_size` is seen in pixels of `scale` x `scale` of its own, rounded up.
    pub(crate) fn uniform(&self, picture_size: [u32; 2], scale: Scale, origin: DVec3) -> ViewUniform {
        let clip = self.clip_from_view;
        let perspective = self.is_perspective();
        // A point at depth z is seen through pixel (x, y) at ray_origin + ray_slope z; each is affine in the pixel.
        let side = f64::from(scale.divisor());
        let ndc_per_px = [2.0 * side / f64::from(picture_size[0]), -2.0 * side / f64::from(picture_size[1])];
        let shift = if perspective { clip.z_axis } else { -clip.w_axis };
        let px_step = [ndc_per_px[0] / clip.x_axis.x, ndc_per_px[1] / clip.y_axis.y];
        let px_zero = [(-1.0 + shift.x) / clip.x_axis.x, (1.0 + shift.y) / clip.y_axis.y];
        ViewUniform {
            view_from_local: (self.view_from_world * DMat4::from_translation(origin)).as_mat4(),
            world_from_view: self.view_from_world.inverse().as_mat4(),
            px_zero: px_zero.map(|v| v as f32),
            px_step: px_step.map(|v| v as f32),
            depth_row: [clip.z_axis.z as f32, clip.w_axis.z as f32, clip.z_axis.w as f32, clip.w_axis.w as f32],
            size: scale.of(picture_size),
            near: self.near as f32,
            far: if perspective { 0.0 } else { self.far as f32 },
        }
    }
}

/// `frame.wgsl`'s `View`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct ViewUniform {
    pub view_from_local: Mat4,
    pub world_from_view: Mat4,
    pub px_zero: [f32; 2],
    pub px_step: [f32; 2],
    pub depth_row: [f32; 4],
    pub size: [u32; 2],
    pub near: f32,
    /// 0 in perspective.
    pub far: f32,
}

impl ViewUniform {
    /// Pixels that a world length covers where the local origin is: about where the particles are.
    pub fn px_per_world(&self) -> f32 {
        let depth = if self.far == 0.0 { (-self.view_from_local.w_axis.z).max(self.near) } else { 1.0 };
        -1.0 / (self.px_step[1] * depth)
    }
}
