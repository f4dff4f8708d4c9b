//! Each slip of the report that `docs/errata.md` lists stays corrected.

use glam::DVec3;
use rt_geom::{AHEAD, Bvh, PointInTriangle, Ray, Sphere, Triangle, inside_triangle, plane_by_pseudo_inverse};
use rt_math::{Roots, reflect};
use rt_shade::{Material, PointLight, SurfacePoint, Texture, phong, sphere_uv, texture_uv};

fn sphere(x: f64, y: f64, z: f64, radius: f64) -> Sphere {
    Sphere::new(DVec3::new(x, y, z), radius).expect("the numbers of the test are valid")
}

fn ray(origin: DVec3, direction: DVec3) -> Ray {
    Ray::new(origin, direction).expect("the numbers of the test are valid")
}

fn triangle(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> Triangle {
    Triangle::new(a, b, c).expect("the numbers of the test are valid")
}

#[test]
fn a_sphere_behind_the_eye_is_not_seen() {
    let behind = sphere(0.0, 0.0, 3.0, 1.0);
    let look = ray(DVec3::ZERO, DVec3::NEG_Z);
    assert_eq!(behind.roots(&look), Roots::Two(-4.0, -2.0), "the line meets it");
    assert!(!behind.any(&look, AHEAD), "the ray does not");
}

#[test]
fn the_roots_have_a_minus_sign() {
    assert_eq!(sphere(0.0, 0.0, -3.0, 1.0).roots(&ray(DVec3::ZERO, DVec3::NEG_Z)), Roots::Two(2.0, 4.0));
}

#[test]
fn the_nearest_sphere_wins() {
    let spheres = vec![sphere(0.0, 0.0, -9.0, 1.0), sphere(0.0, 0.0, -3.0, 1.0), sphere(0.0, 0.0, -6.0, 1.0)];
    let hit = Bvh::new(spheres, Vec::new()).closest(&ray(DVec3::ZERO, DVec3::NEG_Z), AHEAD);
    assert_eq!(hit.map(|hit| (hit.index, hit.t)), Some((1, 2.0)));
}

#[test]
fn equal_distances_go_to_the_lower_index() {
    let twice = vec![sphere(0.0, 0.0, -9.0, 1.0), sphere(0.0, 0.0, -3.0, 1.0), sphere(0.0, 0.0, -4.0, 2.0)];
    let hit = Bvh::new(twice, Vec::new()).closest(&ray(DVec3::ZERO, DVec3::NEG_Z), AHEAD);
    assert_eq!(hit.map(|hit| (hit.index, hit.t)), Some((1, 2.0)));
}

#[test]
fn from_inside_the_far_root_counts() {
    assert_eq!(sphere(0.0, 0.0, 0.5, 2.0).closest(&ray(DVec3::ZERO, DVec3::NEG_Z), AHEAD), Some(1.5));
}

#[test]
fn a_root_of_minus_one_is_not_a_miss() {
    let around = sphere(0.0, 0.0, 0.0, 1.0);
    assert_eq!(around.roots(&ray(DVec3::ZERO, DVec3::NEG_Z)), Roots::Two(-1.0, 1.0));
}

const MATTE: Material = Material { ambient: 0.0, diffuse: 1.0, specular: 0.0, shininess: 1.0 };
const MIRROR: Material = Material { ambient: 0.0, diffuse: 0.0, specular: 1.0, shininess: 2.0 };

fn lamp(position: DVec3) -> PointLight {
    PointLight { position, color: DVec3::ONE }
}

#[test]
fn the_lit_side_is_bright_and_the_dark_side_does_not_glow() {
    for material in [MATTE, MIRROR] {
        let shade = |light: PointLight| {
            phong(&SurfacePoint::new(DVec3::ZERO, DVec3::NEG_Z, DVec3::Z, DVec3::ONE, &material), &[light]).color
        };
        assert_eq!(shade(lamp(2.0 * DVec3::Z)), DVec3::ONE, "lit from the front, {material:?}");
        assert_eq!(shade(lamp(-2.0 * DVec3::Z)), DVec3::ZERO, "lit from behind, {material:?}");
    }
}

#[test]
fn the_highlight_faces_the_eye() {
    let mirrored = |direction: DVec3| {
        let light = lamp(DVec3::new(3.0, 0.0, 4.0));
        phong(&SurfacePoint::new(DVec3::ZERO, direction, DVec3::Z, DVec3::ONE, &MIRROR), &[light]).color.x
    };
    let towards_the_mirror_image = DVec3::new(3.0, 0.0, -4.0);
    let full = mirrored(towards_the_mirror_image);
    assert!((full - 1.0).abs() < 1e-14, "the eye in the mirrored ray sees the full highlight, found {full}");
    assert!((mirrored(1000.0 * towards_the_mirror_image) - full).abs() < 1e-14, "a longer ray is not brighter");
    assert_eq!(mirrored(DVec3::new(-4.0, 0.0, -3.0)), 0.0, "at a right angle there is none");
}

#[test]
fn a_red_lamp_lights_red() {
    let red = PointLight { position: DVec3::Z, color: DVec3::X };
    assert_eq!(
        phong(&SurfacePoint::new(DVec3::ZERO, DVec3::NEG_Z, DVec3::Z, DVec3::ONE, &MATTE), &[red]).color,
        DVec3::X
    );
}

#[test]
fn reflection_does_not_depend_on_the_length_of_the_normal() {
    let incident = DVec3::new(1.0, -2.0, 3.0);
    for length in [1e-300, 0.3, 1.0, 7.0, 1e300] {
        assert_eq!(reflect(incident, length * DVec3::Y), DVec3::new(1.0, 2.0, 3.0), "length {length}");
    }
}

#[test]
fn a_plane_through_the_origin_has_no_report_form() {
    let through = triangle([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let plane = plane_by_pseudo_inverse(&through);
    assert_ne!(plane.dot(DVec3::ZERO), 1.0, "no a, b, c satisfy the equation at the origin, found {plane}");
    let above = ray(DVec3::new(0.25, 0.25, 1.0), DVec3::NEG_Z);
    assert_eq!(through.closest(&above, AHEAD), Some(1.0), "the tracer's form has no such hole");
    let beside = triangle([0.0, 0.0, 2.0], [1.0, 0.0, 2.0], [0.0, 1.0, 2.0]);
    assert_eq!(plane_by_pseudo_inverse(&beside), DVec3::new(0.0, 0.0, 0.5), "elsewhere it is the plane");
}

#[test]
fn the_boundary_belongs_to_the_triangle() {
    let flat = triangle([0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]);
    for (point, inside) in
        [([1.0, 1.0, 0.0], true), ([2.0, 2.0, 0.0], true), ([4.0, 0.0, 0.0], true), ([3.0, 2.0, 0.0], false)]
    {
        let verdict = inside_triangle(point, &flat);
        assert_eq!(!matches!(verdict, PointInTriangle::Outside), inside, "{point:?} is {verdict:?}");
    }
}

#[test]
fn a_point_off_the_plane_is_judged_by_its_projection() {
    let flat = triangle([0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]);
    assert!(matches!(inside_triangle(DVec3::new(1.0, 1.0, 9.0), &flat), PointInTriangle::Interior));
    assert!(matches!(inside_triangle(DVec3::new(3.0, 3.0, 9.0), &flat), PointInTriangle::Outside));
}

#[test]
fn a_triangle_without_area_contains_nothing() {
    let line = triangle([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]);
    assert!(matches!(inside_triangle(DVec3::X, &line), PointInTriangle::Outside));
}

#[test]
fn a_map_reads_from_left_to_right() {
    // Seen from +z, the eye's right is +x.
    let u = |x: f64| sphere_uv(DVec3::new(x, 0.0, 1.0)).0;
    assert!(u(-0.1) > u(0.1), "the report's u falls from left to right");
    let column = |x: f64| texture_uv(DVec3::new(x, 0.0, 1.0), false).0;
    assert!(column(-0.1) < column(0.1), "a texture is read the other way round");
    assert_eq!(texture_uv(DVec3::new(0.1, 0.0, 1.0), true).0, u(0.1), "unless it is mirrored");
}

#[test]
fn the_seam_and_the_south_pole_stay_inside_the_image() {
    let texture = Texture::new(2, 2, (0..12).collect(), 255).expect("two by two texels");
    assert_eq!(sphere_uv(DVec3::new(-1.0, 0.0, 0.0)).0, 1.0, "the seam has u = W");
    assert_eq!(sphere_uv(DVec3::NEG_Y).1, 1.0, "the south pole has v = H");
    assert_eq!(texture.texel(1.0, 1.0), (0, 1), "u wraps to the first column, v is the last row");
}

#[test]
fn a_normal_longer_than_one_is_no_nan() {
    let longer = 1.0 + f64::EPSILON;
    assert_eq!(sphere_uv(DVec3::new(0.0, longer, 0.0)).1, 0.0);
    assert_eq!(sphere_uv(DVec3::new(0.0, -longer, 0.0)).1, 1.0);
}
