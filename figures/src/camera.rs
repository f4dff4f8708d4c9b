//! The camera: from a place in the picture to a ray.
//!
//! The report's camera sits at the origin, looks down -z and sees the part of the plane `z = -1` where `y` is in
//! `[-1, 1]` and `x` in `[-W/H, W/H]`. Any other camera is this one, moved and turned, with the plane's half height
//! set by the field of view. Pixel `(i, j)`, row 0 at the top, is sampled at its centre, or at the centres of the
//! `N` x `N` equal parts of it.

use glam::DVec3;
use rt_geom::Ray;

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
        Self { eye: DVec3::ZERO, forward: DVec3::NEG_Z, right: DVec3::X, up: DVec3::Y, half_height: 1.0, fit: false }
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
    /// Returns the camera for objects that come without one: it looks from the direction `from`, moves so that
    /// everything is seen, and has a field of view of 28 degrees, so that things far from the middle are little
    /// stretched.
    ///
    /// # Panics
    /// If `from` or `up` is zero or not finite, or if they are parallel.
    pub fn stage(from: DVec3, up: DVec3) -> Self {
        Self::new(from, DVec3::ZERO, up, 28.0).expect("two directions").fitted()
    }

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

    /// The same camera, moved by [`Camera::framed`] before a picture is taken.
    #[must_use]
    pub fn fitted(self) -> Self {
        Self { fit: true, ..self }
    }

    /// Returns whether the camera moves so that everything is seen.
    pub fn fits(&self) -> bool {
        self.fit
    }

    /// Returns the camera with the same directions that stands where `balls`, each a center and a radius, just fill a
    /// picture of `width` x `height` pixels, with a margin of a twentieth on each side.
    ///
    /// `None` if there are none, or if that place leaves the f64 range.
    ///
    /// The picture's edges are four planes through the eye. Two of them, left and right, make a wedge; pushed against
    /// the balls from both sides it stands at one place and depth, and so does the wedge of the other two. The eye
    /// takes its place across from each, and its depth from the one that is farther back.
    pub fn framed(&self, balls: impl Iterator<Item = (DVec3, f64)>, width: u32, height: u32) -> Option<Self> {
        let vertical = self.half_height / 1.1;
        let tangents = [vertical * f64::from(width) / f64::from(height), vertical];
        let across = [self.right, self.up];
        // A ball at (x, z) is on the inner side of the wedge's planes through (X, Z) iff
        //   tangent (z - Z) -+ (x - X) >= radius sqrt(1 + tangent^2).
        let mut limits = [[f64::NEG_INFINITY; 2]; 2];
        for (center, radius) in balls {
            let z = center.dot(self.forward);
            for axis in 0..2 {
                let x = center.dot(across[axis]);
                let reach = radius * (1.0 + tangents[axis] * tangents[axis]).sqrt() - tangents[axis] * z;
                limits[axis] = [limits[axis][0].max(reach + x), limits[axis][1].max(reach - x)];
            }
        }
        let depth = |axis: usize| -(limits[axis][0] + limits[axis][1]) / (2.0 * tangents[axis]);
        let place = |axis: usize| (limits[axis][0] - limits[axis][1]) / 2.0;
        let eye = place(0) * self.right + place(1) * self.up + depth(0).min(depth(1)) * self.forward;
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
/// J. H. Lambert's continued fraction, `tan x = x / (1 - x² / (3 - x² / (5 - ...)))`: unlike the system's library it
/// has the same bits on every platform. Eleven of its terms leave an error below 1e-16 up to 45 degrees; with rounding
/// it is at most 4 ulp (tested).
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

/// Returns the cosine and the sine of an angle in degrees, which is finite: the same bits on every platform, and exact
/// for multiples of 90.
pub(crate) fn cos_sin(degrees: f64) -> (f64, f64) {
    let degrees = degrees % 360.0;
    let quarter = (degrees / 90.0).round();
    // Within -45..=45.
    let rest = degrees - 90.0 * quarter;
    let t = tangent_of_half(rest.abs());
    let (cos, sin) = ((1.0 - t * t) / (1.0 + t * t), (2.0 * t / (1.0 + t * t)).copysign(rest));
    match quarter.rem_euclid(4.0) {
        0.0 => (cos, sin),
        1.0 => (-sin, cos),
        2.0 => (-cos, -sin),
        _ => (sin, -cos),
    }
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
    pub fn ray(&self, column: u32, row: u32) -> Ray {
        self.ray_through(self.across(column), self.down(row))
    }

    /// Returns the ray through the cell where a column and a row meet, given as [`View::across`] and [`View::down`] do.
    #[inline]
    pub(crate) fn ray_through(&self, across: DVec3, down: DVec3) -> Ray {
        // The three axes are perpendicular unit vectors, so a sum of them with `forward` is about 1 long at least.
        Ray::new(self.camera.eye, across + down).expect("the eye is finite and the direction not zero")
    }

    /// Returns the direction to the centre of a column of cells, in the middle of the picture's height.
    pub(crate) fn across(&self, column: u32) -> DVec3 {
        let Size { width, height, samples } = self.size;
        let (columns, rows) = (i64::from(width) * i64::from(samples), i64::from(height) * i64::from(samples));
        let x = (2 * i64::from(column) + 1 - columns) as f64 / rows as f64;
        self.camera.forward + x * self.camera.half_height * self.camera.right
    }

    /// Returns what to add to it for the centre of a row of cells.
    pub(crate) fn down(&self, row: u32) -> DVec3 {
        let rows = i64::from(self.size.height) * i64::from(self.size.samples);
        let y = (rows - 2 * i64::from(row) - 1) as f64 / rows as f64;
        y * self.camera.half_height * self.camera.up
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
        let camera = Camera::new(DVec3::new(1.0, 2.0, 3.0), DVec3::new(-4.0, 0.5, 9.0), DVec3::Y, 30.0).unwrap();
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
    fn cosine_and_sine_are_those_of_the_angle() {
        for step in -800_i32..800 {
            let degrees = f64::from(step) * 0.9;
            let (cos, sin) = cos_sin(degrees);
            let expected = degrees.to_radians();
            let distance = (cos - expected.cos()).abs().max((sin - expected.sin()).abs());
            // The argument of the reference is rounded: up to 13 radians.
            assert!(distance < 16.0 * f64::EPSILON, "{degrees}: {distance:e}");
        }
        let exact = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)];
        for (at, expected) in
            (-8..9_i32).map(|quarter| (f64::from(quarter) * 90.0, exact[quarter.rem_euclid(4) as usize]))
        {
            assert_eq!(cos_sin(at), expected, "{at}");
        }
    }

    #[test]
    fn up_is_up_and_right_is_right() {
        let camera = Camera::new(DVec3::X * 5.0, DVec3::ZERO, DVec3::Y, 60.0).unwrap();
        let [right, up, forward] = camera.axes();
        assert!((right - DVec3::NEG_Z).length() < 1e-15, "from +x, -z is to the right: {right}");
        assert!((up - DVec3::Y).length() < 1e-15 && (forward - DVec3::NEG_X).length() < 1e-15);
    }

    #[test]
    fn fitted_balls_touch_the_narrower_edges_up_to_the_margin() {
        let balls =
            [(DVec3::new(3.0, -2.0, 40.0), 2.5), (DVec3::new(-7.0, 1.0, 38.0), 0.5), (DVec3::new(2.0, 9.0, 51.0), 0.0)];
        let turned = Camera::new(DVec3::X, DVec3::new(-3.0, 2.0, 9.0), DVec3::Y, 50.0).unwrap();
        for (camera, width, height) in [
            (Camera::default(), 64, 48),
            (Camera::stage(DVec3::new(12.0, 9.0, 20.0), DVec3::Y), 48, 64),
            (turned, 10, 10),
            (turned, 500, 10),
        ] {
            let framed = camera.framed(balls.into_iter(), width, height).unwrap();
            let [right, up, forward] = framed.axes();
            // How far the balls keep from each of the four planes of the picture with its margin.
            let gaps = [right, -right, up, -up].map(|side| {
                let aspect = f64::from(width) / f64::from(height);
                let tangent = framed.half_height / 1.1 * if side.dot(up) == 0.0 { aspect } else { 1.0 };
                let inward = (tangent * forward - side).normalize();
                let gap = |(center, radius): (DVec3, f64)| inward.dot(center - framed.eye()) - radius;
                balls.into_iter().map(gap).fold(f64::INFINITY, f64::min)
            });
            assert!(gaps.iter().all(|gap| *gap > -1e-12), "{width} x {height}: {gaps:?}");
            let touches = |gaps: &[f64]| gaps.iter().all(|gap| gap.abs() < 1e-12);
            assert!(touches(&gaps[..2]) || touches(&gaps[2..]), "{width} x {height}: {gaps:?}");
            let centred = (gaps[0] - gaps[1]).abs() < 1e-12 && (gaps[2] - gaps[3]).abs() < 1e-12;
            assert!(centred, "{width} x {height}: {gaps:?}");
        }
        assert_eq!(Camera::default().framed(std::iter::empty(), 64, 48), None);
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
