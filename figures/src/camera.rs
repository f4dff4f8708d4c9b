//! The camera: from a place in the picture to a ray.
//!
//! The report's camera sits at the origin, looks down -z and sees the part of the plane `z = -1` where `y` is in
//! `[-1, 1]` and `x` in `[-W/H, W/H]`. Any other camera is this one, moved and turned, with the plane's half height
//! set by the field of view. Pixel `(i, j)`, row 0 at the top, is sampled at its centre, or at the centres of the
//! `N` x `N` equal parts of it.

use glam::DVec3;
use rt_geom::{Ray, Sphere};

/// Where a picture is taken from. [`Camera::default`] is the report's camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    eye: DVec3,
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    half_height: f64,
    fit: bool,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            eye: DVec3::ZERO,
            forward: DVec3::NEG_Z,
            right: DVec3::X,
            up: DVec3::Y,
            half_height: 1.0,
            fit: false,
        }
    }
}

/// Why there is no such camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CameraError {
    /// The eye and the point that it looks at are the same, or too far apart for the f64 range.
    #[error("eye and look_at must be different points at a finite distance")]
    NoDirection,
    /// `up` is zero or along the line of sight.
    #[error("up must not be zero or parallel to the line of sight")]
    NoUp,
    /// The field of view is not an angle that a plane can show.
    #[error("fov must be an angle in degrees, more than 0 and less than 180")]
    FieldOfView,
}

impl Camera {
    /// Returns the camera at `eye` that sees `look_at` in the middle of the picture and `up` upwards, with the
    /// vertical field of view `fov` in degrees.
    ///
    /// ```
    /// # use figures::camera::Camera;
    /// use glam::DVec3;
    /// assert_eq!(Camera::new(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, 90.0), Ok(Camera::default()));
    /// ```
    ///
    /// # Errors
    /// The three cases of [`CameraError`]; numbers that are not finite are among them.
    pub fn new(eye: DVec3, look_at: DVec3, up: DVec3, fov: f64) -> Result<Self, CameraError> {
        let forward = (look_at - eye).try_normalize().ok_or(CameraError::NoDirection)?;
        if !eye.is_finite() {
            return Err(CameraError::NoDirection);
        }
        let up = up.try_normalize().ok_or(CameraError::NoUp)?;
        let right = forward.cross(up).try_normalize().ok_or(CameraError::NoUp)?;
        // Written so that NaN fails it.
        if !(fov > 0.0 && fov < 180.0) {
            return Err(CameraError::FieldOfView);
        }
        let half_height = tangent_of_half(fov);
        Ok(Self { eye, forward, right, up: right.cross(forward), half_height, fit: false })
    }

    /// The same camera, moved along its line of sight by [`Camera::framed`] before a picture is taken.
    #[must_use]
    pub fn fitted(self) -> Self {
        Self { fit: true, ..self }
    }

    /// Tells whether the camera moves so that everything is seen.
    pub fn fits(&self) -> bool {
        self.fit
    }

    /// Returns the camera with the same directions that stands where `content` just fills a picture of
    /// `width` x `height` pixels, with a margin of a twentieth of its radius; `None` if that place leaves the f64 range.
    pub fn framed(&self, content: &Sphere, width: u32, height: u32) -> Option<Self> {
        // The narrower half field of view has the tangent `tangent`; a sphere touches that cone when its centre is at
        // radius / sin(angle) = radius sqrt(1 + 1 / tangent^2).
        let tangent = self.half_height * (f64::from(width) / f64::from(height)).min(1.0);
        // A single point has no size to fill the picture with; any distance shows it alike.
        let radius = if content.radius() > 0.0 { 1.05 * content.radius() } else { 1.0 };
        let distance = radius * (1.0 + 1.0 / (tangent * tangent)).sqrt();
        let eye = content.center() - distance * self.forward;
        eye.is_finite().then_some(Self { eye, ..*self })
    }

    /// Where the picture is taken from.
    pub fn eye(&self) -> DVec3 {
        self.eye
    }

    /// The unit directions to the right of the picture, to its top, and into it.
    pub fn axes(&self) -> [DVec3; 3] {
        [self.right, self.up, self.forward]
    }
}

/// Returns the tangent of half of an angle in degrees, more than 0 and less than 180; exactly 1 for 90.
///
/// J. H. Lambert's continued fraction, `tan x = x / (1 - x² / (3 - x² / (5 - ...)))`: unlike the system's library it has
/// the same bits on every platform. Eleven of its terms leave an error below 1e-16 up to 45 degrees; with rounding it is
/// at most 4 ulp (tested).
fn tangent_of_half(degrees: f64) -> f64 {
    if degrees == 90.0 {
        return 1.0;
    }
    if degrees > 90.0 {
        return 1.0 / tangent_of_half(180.0 - degrees);
    }
    let x = degrees * (std::f64::consts::PI / 360.0);
    let below = [21.0, 19.0, 17.0, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0, 3.0, 1.0];
    x / below.into_iter().fold(f64::INFINITY, |rest, odd| odd - x * x / rest)
}

/// The size of a picture, and how finely it is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Columns; at least 1.
    pub width: u32,
    /// Rows; at least 1.
    pub height: u32,
    /// Samples along each side of a pixel; at least 1.
    pub samples: u32,
}

/// A camera and the grid of its samples.
#[derive(Clone, Copy, Debug)]
pub struct View {
    camera: Camera,
    size: Size,
}

impl View {
    /// Returns the view of a picture of this size.
    pub fn new(camera: Camera, size: Size) -> Self {
        Self { camera, size }
    }

    /// The size of the picture.
    pub fn size(&self) -> Size {
        self.size
    }

    /// Returns the ray through the centre of the cell at `column` and `row` of the grid of samples, row 0 at the top.
    ///
    /// For one sample per pixel and the report's camera its direction is `((2 (i + 1/2) / W - 1) W / H,
    /// 1 - 2 (j + 1/2) / H, -1)`, each component rounded once, since the numerators are whole numbers.
    #[expect(clippy::missing_panics_doc, reason = "the direction is proved to be finite and not zero")]
    pub fn ray(&self, column: u32, row: u32) -> Ray {
        let Size { width, height, samples } = self.size;
        let (columns, rows) = (i64::from(width) * i64::from(samples), i64::from(height) * i64::from(samples));
        let x = (2 * i64::from(column) + 1 - columns) as f64 / rows as f64;
        let y = (rows - 2 * i64::from(row) - 1) as f64 / rows as f64;
        let Camera { eye, forward, right, up, half_height, .. } = self.camera;
        let direction = forward + x * half_height * right + y * half_height * up;
        // The three axes are perpendicular unit vectors, so a sum of them with `forward` is about 1 long at least.
        Ray::new(eye, direction).expect("the eye is finite and the direction not zero")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_camera_is_the_reports() {
        let (width, height) = (7, 4);
        let view = View::new(Camera::default(), Size { width, height, samples: 1 });
        for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
            let direction = view.ray(i, j).direction();
            let (w, h) = (f64::from(width), f64::from(height));
            let x = (2.0 * (f64::from(i) + 0.5) / w - 1.0) * w / h;
            let y = 1.0 - 2.0 * (f64::from(j) + 0.5) / h;
            // The textbook form rounds up to five times, values up to W / H = 1.75.
            assert!((direction - DVec3::new(x, y, -1.0)).length() <= 5.0 * f64::EPSILON, "pixel {i}, {j}");
            assert_eq!(direction.z, -1.0);
        }
    }

    #[test]
    fn samples_are_the_pixels_of_a_finer_picture() {
        let coarse = View::new(Camera::default(), Size { width: 5, height: 3, samples: 4 });
        let fine = View::new(Camera::default(), Size { width: 20, height: 12, samples: 1 });
        for (i, j) in (0..12).flat_map(|j| (0..20).map(move |i| (i, j))) {
            assert_eq!(coarse.ray(i, j), fine.ray(i, j));
        }
    }

    #[test]
    fn a_picture_of_odd_size_has_its_middle_straight_ahead() {
        let camera =
            Camera::new(DVec3::new(1.0, 2.0, 3.0), DVec3::new(-4.0, 0.5, 9.0), DVec3::Y, 30.0).unwrap();
        let ray = View::new(camera, Size { width: 9, height: 5, samples: 1 }).ray(4, 2);
        assert_eq!(ray.direction(), camera.axes()[2]);
    }

    #[test]
    fn the_tangent_is_within_four_ulp() {
        for step in 1..18_000 {
            let degrees = f64::from(step) / 100.0;
            // The argument of the reference is rounded too; near 180 degrees that shows, so it is not compared there.
            let expected = (degrees.min(180.0 - degrees).to_radians() / 2.0).tan();
            let expected = if degrees > 90.0 { 1.0 / expected } else { expected };
            let found = tangent_of_half(degrees);
            assert!((found / expected - 1.0).abs() <= 4.0 * f64::EPSILON, "{degrees}: {found} {expected}");
        }
        assert_eq!(tangent_of_half(90.0), 1.0);
    }

    #[test]
    fn up_is_up_and_right_is_right() {
        let camera = Camera::new(DVec3::X * 5.0, DVec3::ZERO, DVec3::Y, 60.0).unwrap();
        let [right, up, forward] = camera.axes();
        assert!((right - DVec3::NEG_Z).length() < 1e-15, "from +x, -z is to the right: {right}");
        assert!((up - DVec3::Y).length() < 1e-15 && (forward - DVec3::NEG_X).length() < 1e-15);
    }

    #[test]
    fn a_fitted_sphere_touches_the_narrower_edge_up_to_the_margin() {
        let content = Sphere::new(DVec3::new(3.0, -2.0, 40.0), 2.5).unwrap();
        for (width, height) in [(64, 48), (48, 64), (10, 10)] {
            let camera = Camera::default().framed(&content, width, height).unwrap();
            let distance = camera.eye().distance(content.center());
            let half = (f64::from(width) / f64::from(height)).min(1.0).atan();
            let seen = (content.radius() * 1.05 / distance).asin();
            assert!((seen - half).abs() < 1e-12, "{width} x {height}: {seen} against {half}");
        }
    }

    #[test]
    fn impossible_cameras_are_refused() {
        let new = Camera::new;
        assert_eq!(new(DVec3::X, DVec3::X, DVec3::Y, 90.0), Err(CameraError::NoDirection));
        assert_eq!(new(DVec3::NAN, DVec3::X, DVec3::Y, 90.0), Err(CameraError::NoDirection));
        assert_eq!(new(DVec3::MAX, DVec3::MIN, DVec3::Y, 90.0), Err(CameraError::NoDirection));
        assert_eq!(new(DVec3::X, DVec3::ZERO, DVec3::ZERO, 90.0), Err(CameraError::NoUp));
        assert_eq!(new(DVec3::X, DVec3::ZERO, DVec3::NEG_X, 90.0), Err(CameraError::NoUp));
        for fov in [0.0, -1.0, 180.0, 200.0, f64::NAN, f64::INFINITY] {
            assert_eq!(new(DVec3::X, DVec3::ZERO, DVec3::Y, fov), Err(CameraError::FieldOfView), "{fov}");
        }
    }
}
