//! A scene drawn by the textbook, in either precision: every object is asked, by the plainest formulas.

use glam::DVec3;
use rt_geom::{Ray, Sphere, Triangle};

use crate::methods::real::{Components, Float, add, cross, normalized, scaled, sub};
use crate::methods::{crossing, terms, textbook_coordinates, textbook_roots};
use figures::scene::{Filter, Look, Paint, Scene};

/// A scene's objects in one precision.
pub(super) struct Painter<'a, T> {
    scene: &'a Scene,
    spheres: Vec<(Components<T>, T)>,
    triangles: Vec<[Components<T>; 3]>,
}

/// What is seen, at which `t`.
struct Seen<T> {
    t: T,
    index: usize,
    /// The weights of the second and the third vertex of a triangle.
    weights: [T; 2],
}

fn narrow<T: Float>(v: DVec3) -> Components<T> {
    v.to_array().map(T::of)
}

impl<'a, T: Float> Painter<'a, T> {
    pub(super) fn new(scene: &'a Scene) -> Self {
        let ball = |sphere: &Sphere| (narrow(sphere.center()), T::of(sphere.radius()));
        let corners = |triangle: &Triangle| triangle.vertices().map(narrow);
        Self {
            scene,
            spheres: scene.spheres.iter().map(ball).collect(),
            triangles: scene.triangles.iter().map(corners).collect(),
        }
    }

    /// The colour that a ray brings back.
    pub(super) fn color(&self, ray: &Ray) -> DVec3 {
        let (origin, direction) = (narrow(ray.origin()), narrow(ray.direction()));
        let Some(seen) = self.closest(origin, direction) else {
            return self.scene.background;
        };
        let point = add(origin, scaled(direction, seen.t));
        match self.spheres.get(seen.index) {
            Some(&(center, _)) => {
                let look =
                    self.scene.look(self.scene.sphere_looks[seen.index]).expect("a sphere of these scenes has a look");
                let normal = normalized(sub(point, center));
                let surface = match &look.paint {
                    Paint::Color(color) => narrow(*color),
                    Paint::Image { texture, mirrored, filter } => {
                        let [u, v] = textbook_coordinates(normal);
                        let u = if *mirrored { u } else { T::of(1.0) - u };
                        narrow(match filter {
                            Filter::Nearest => texture.nearest(u.wide(), v.wide()),
                            Filter::Bilinear => texture.bilinear(u.wide(), v.wide()),
                        })
                    }
                };
                self.lit(point, direction, normal, surface, look)
            }
            None => {
                let index = seen.index - self.spheres.len();
                let [a, b, c] = self.triangles[index];
                let look = self.scene.look(self.scene.triangle_looks[index]).expect("a triangle has a look");
                let surface = match (self.scene.vertex_colors.get(index), &look.paint) {
                    (Some(Some(colors)), _) => {
                        let [u, v] = seen.weights;
                        let [x, y, z] = colors.map(narrow::<T>);
                        add(add(scaled(x, T::of(1.0) - u - v), scaled(y, u)), scaled(z, v))
                    }
                    (_, Paint::Color(color)) => narrow(*color),
                    (_, Paint::Image { .. }) => unreachable!("a triangle's look has a color"),
                };
                self.lit(point, direction, cross(sub(b, a), sub(c, a)), surface, look)
            }
        }
    }

    fn closest(&self, origin: Components<T>, direction: Components<T>) -> Option<Seen<T>> {
        let zero = T::of(0.0);
        let mut best: Option<Seen<T>> = None;
        let mut offer = |t: T, index: usize, weights: [T; 2]| {
            if t >= zero && best.as_ref().is_none_or(|best| t < best.t) {
                best = Some(Seen { t, index, weights });
            }
        };
        for (index, &(center, radius)) in self.spheres.iter().enumerate() {
            if let Some([near, far]) = textbook_roots(direction, sub(origin, center), radius) {
                offer(if near >= zero { near } else { far }, index, [zero; 2]);
            }
        }
        for (index, &vertices) in self.triangles.iter().enumerate() {
            if let Some((t, u, v)) = crossing(origin, direction, vertices, 0.0) {
                offer(t, self.spheres.len() + index, [u, v]);
            }
        }
        best
    }

    fn lit(
        &self,
        point: Components<T>,
        direction: Components<T>,
        normal: Components<T>,
        surface: Components<T>,
        look: &Look,
    ) -> DVec3 {
        let material = &look.material;
        let mut color = scaled(surface, T::of(material.ambient));
        for lamp in &self.scene.lights {
            let (diffuse, specular) = terms(point, direction, normal, narrow(lamp.position), material.shininess);
            let (diffuse, specular) = (T::of(material.diffuse) * diffuse, T::of(material.specular) * specular);
            let light: Components<T> = narrow(lamp.color);
            color = [0, 1, 2].map(|i| color[i] + (diffuse * surface[i] + specular) * light[i]);
        }
        DVec3::from_array((if self.scene.lights.is_empty() { surface } else { color }).map(T::wide))
    }
}
