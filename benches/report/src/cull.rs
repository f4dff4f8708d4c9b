//! How much a cull in single precision keeps for nothing: sixteen balls against one ray, as in a node of the tree.
//!
//! A cull may keep a ball that the ray misses (a false pass, which costs a test) and must never drop one that it meets.
//! The tree's own cull is private to it and written in SIMD; what is measured here is its formula, restated for any
//! precision and margin, in the coordinates in which the scene is the unit ball.

use std::hint::black_box;

use rayon::prelude::*;
use rt_geom::{Ray, Sphere};

use super::measure::{Cell, Effort, Errors, Kernel, Measured, hexadecimal, take_turns};
use super::methods::real::{Components, Float, dot, dvec3};
use super::progress::progress;
use super::random::{Random, cross, length, plus, size};
use super::reference;

/// Balls that are culled together.
const WIDTH: usize = 16;

/// A ray and sixteen balls in the unit ball.
struct CullCase {
    /// Origin and direction.
    ray: [f64; 6],
    /// Centers and radii.
    balls: [[f64; 4]; WIDTH],
}

impl CullCase {
    /// The ray and one ball, as the kernel of rays and spheres has it.
    fn with_ball(&self, ball: &[f64; 4]) -> [f64; 10] {
        let numbers = [&self.ray[..], ball].concat();
        numbers.try_into().expect("six numbers and four")
    }
}

/// Writes for each case which balls are kept, as bits.
type CullRun<'a> = Box<dyn Fn(&mut [u16]) + 'a>;

/// A cull and what it makes of a list of cases before time is taken.
struct CullMethod {
    name: &'static str,
    source: &'static str,
    ours: bool,
    prepare: fn(&[CullCase]) -> CullRun<'_>,
}

const fn method(
    name: &'static str,
    source: &'static str,
    ours: bool,
    prepare: fn(&[CullCase]) -> CullRun<'_>,
) -> CullMethod {
    CullMethod { name, source, ours, prepare }
}

const METHODS: [CullMethod; 6] = [
    method("f32, no margin", "distance to the segment, rounding ignored", false, |cases| balls::<f32>(cases, 0.0)),
    method("f32, the tree's margin", "the tree's leaf blocks: 64 half-ulps", true, |cases| balls::<f32>(cases, 64.0)),
    method("f32, margin × 16", "the same, 1024 half-ulps", false, |cases| balls::<f32>(cases, 1024.0)),
    method("f32, boxes", "the tree's nodes: Kay and Kajiya's slabs, margin of 8 half-ulps", true, boxes),
    method("f64, margin", "distance to the segment, 64 half-ulps", false, |cases| balls::<f64>(cases, 64.0)),
    method("exact test", "the kernel for spheres, no cull", true, exact_test),
];

/// Measures the culls.
pub(super) fn cull(effort: Effort) -> Kernel {
    progress("cull of a bounding volume");
    let mut measured = METHODS.each_ref().map(|method| Measured::new(method.name, method.source, method.ours, false));
    for (name, cases) in classes(effort.cases.div_ceil(4)) {
        let truths: Vec<u16> = cases.par_iter().map(truth).collect();
        let runs: Vec<CullRun> = METHODS.iter().map(|method| (method.prepare)(&cases)).collect();
        let mut kept = vec![0; cases.len()];
        let time = |i: usize| {
            runs[i](&mut kept);
            black_box(&mut kept);
        };
        let times = take_turns(runs.len(), cases.len() * WIDTH, effort, time);
        for ((run, measured), time) in runs.iter().zip(&mut measured).zip(times) {
            let mut kept = vec![0; cases.len()];
            run(&mut kept);
            measured.classes.push(Cell { class: name.to_owned(), errors: errors(&cases, &truths, &kept), time });
        }
    }
    Kernel {
        name: "cull".to_owned(),
        verdict: Some("kept or dropped".to_owned()),
        values: None,
        one_sided: true,
        methods: measured.into(),
    }
}

/// The balls that the ray meets.
fn truth(case: &CullCase) -> u16 {
    bits(|lane| reference::sphere(&case.with_ball(&case.balls[lane])).verdict == 1)
}

fn bits(is_set: impl Fn(usize) -> bool) -> u16 {
    (0..WIDTH).fold(0, |bits, lane| bits | u16::from(is_set(lane)) << lane)
}

fn errors(cases: &[CullCase], truths: &[u16], kept: &[u16]) -> Errors {
    let mut errors = Errors { cases: cases.len() * WIDTH, ..Errors::default() };
    for ((case, &truth), &kept) in cases.iter().zip(truths).zip(kept) {
        errors.wrong_verdicts += (truth ^ kept).count_ones() as usize;
        errors.lost += (truth & !kept).count_ones() as usize;
        // A drop is what a reader wants to see.
        for wrong in [truth & !kept, kept & !truth] {
            if wrong != 0 && errors.first_wrong.is_none() {
                let lane = wrong.trailing_zeros() as usize;
                errors.first_wrong = Some(hexadecimal(&case.with_ball(&case.balls[lane])));
            }
        }
    }
    errors
}

/// A ray as every cull sees it: its line from the point nearest to the middle of the scene, in double precision.
struct CullLine {
    direction: Components<f64>,
    nearest: Components<f64>,
    /// Where the ray begins and where the scene ends.
    start: f64,
    end: f64,
    error: f64,
}

impl CullLine {
    fn new(ray: &[f64; 6]) -> Self {
        let [ox, oy, oz, dx, dy, dz] = *ray;
        let along = length([dx, dy, dz]);
        let direction = [dx, dy, dz].map(|x| x / along);
        let base = -dot([ox, oy, oz], direction);
        let nearest = plus([ox, oy, oz], direction, base);
        // The tree's bound of the rounding errors above.
        let error = (1.0 + base.abs() + nearest.map(f64::abs).iter().sum::<f64>()) / (1u64 << 46) as f64;
        Self { direction, nearest, start: (-base - error).max(-1.125), end: 1.125, error }
    }
}

/// The distance from each center to the part of the ray in the scene, with a margin in half-ulps of 1.
fn balls<'a, T: Float + 'a>(cases: &'a [CullCase], margin: f64) -> CullRun<'a> {
    struct PackedBalls<T> {
        center: [[T; WIDTH]; 3],
        radius: [T; WIDTH],
    }
    let packed: Vec<(&CullCase, PackedBalls<T>)> = cases
        .iter()
        .map(|case| {
            let mut balls = PackedBalls { center: [[T::of(0.0); WIDTH]; 3], radius: [T::of(0.0); WIDTH] };
            for (lane, &[x, y, z, r]) in case.balls.iter().enumerate() {
                let center = [x, y, z].map(T::of);
                let moved = length([0, 1, 2].map(|i| center[i].wide() - [x, y, z][i]));
                for (row, c) in balls.center.iter_mut().zip(center) {
                    row[lane] = c;
                }
                balls.radius[lane] = T::at_least(r + 2.0 * moved);
            }
            (case, balls)
        })
        .collect();
    Box::new(move |kept| {
        for ((case, balls), kept) in packed.iter().zip(kept) {
            let line = CullLine::new(&case.ray);
            let (w, q) = (line.direction.map(T::of), line.nearest.map(T::of));
            // Two unit vectors across the ray (Duff et al. 2017).
            let one = T::of(1.0);
            let sign = one.copysign(w[2]);
            let a = -(one / (sign + w[2]));
            let b = w[0] * w[1] * a;
            let frame =
                [[one + sign * w[0] * w[0] * a, sign * b, -(sign * w[0])], [b, sign + w[1] * w[1] * a, -w[1]], w];
            let offset = frame.map(|axis| dot(axis, q));
            let (start, end) = (T::of(line.start), T::of(line.end));
            let slack = T::at_least(if margin > 0.0 { margin * T::HALF_ULP + line.error } else { 0.0 });
            let squared = |lane: usize| {
                let [x, y, t] = [0, 1, 2].map(|k| {
                    let along = balls.center[0][lane] * frame[k][0]
                        + balls.center[1][lane] * frame[k][1]
                        + balls.center[2][lane] * frame[k][2];
                    along - offset[k]
                });
                let beyond = if t < start {
                    t - start
                } else if t > end {
                    t - end
                } else {
                    T::of(0.0)
                };
                let reach = balls.radius[lane] + slack;
                x * x + y * y + beyond * beyond <= reach * reach
            };
            *kept = bits(squared);
        }
    })
}

/// The boxes around the balls, by slabs.
fn boxes(cases: &[CullCase]) -> CullRun<'_> {
    let packed: Vec<(&CullCase, [[f32; WIDTH]; 6])> = cases
        .iter()
        .map(|case| {
            let plane = |row: usize, [x, y, z, r]: [f64; 4]| match row {
                0..3 => -f32::at_least(r - [x, y, z][row]),
                _ => f32::at_least([x, y, z][row - 3] + r),
            };
            (case, std::array::from_fn(|row| case.balls.map(|ball| plane(row, ball))))
        })
        .collect();
    Box::new(move |kept| {
        for ((case, planes), kept) in packed.iter().zip(kept) {
            let line = CullLine::new(&case.ray);
            let slack = f32::at_least(8.0 * f32::HALF_ULP + line.error);
            let slabs = [0, 1, 2].map(|axis| {
                let (w, q) = (f32::of(line.direction[axis]), f32::of(line.nearest[axis]));
                let tiny = 1.0 / (1u64 << 40) as f32;
                let inverse = 1.0 / if w.abs() < tiny { tiny.copysign(w) } else { w };
                let (center, slack) = (-(q * inverse), inverse.abs() * slack);
                let (near, far) = if w.is_sign_negative() { (axis + 3, axis) } else { (axis, axis + 3) };
                (near, far, inverse, center - slack, center + slack)
            });
            let (start, end) = (f32::of(line.start), f32::of(line.end));
            *kept = bits(|lane| {
                let (mut enter, mut leave) = (start, end);
                for (near, far, inverse, before, after) in slabs {
                    enter = enter.max(planes[near][lane] * inverse + before);
                    leave = leave.min(planes[far][lane] * inverse + after);
                }
                enter <= leave
            });
        }
    })
}

fn exact_test(cases: &[CullCase]) -> CullRun<'_> {
    let shapes: Vec<(Ray, [Sphere; WIDTH])> = cases
        .iter()
        .map(|case| {
            let ray = Ray::new(dvec3(&case.ray, 0), dvec3(&case.ray, 3)).expect("cases are valid rays");
            let sphere = |ball: [f64; 4]| Sphere::new(dvec3(&ball, 0), ball[3]).expect("radii are positive");
            (ray, case.balls.map(sphere))
        })
        .collect();
    Box::new(move |kept| {
        for ((ray, spheres), kept) in shapes.iter().zip(kept) {
            *kept = bits(|lane| spheres[lane].any(ray, 0.0..f64::INFINITY));
        }
    })
}

/// A ray from a distance through a point of the scene.
fn ray(r: &mut Random, distance: f64) -> ([f64; 3], [f64; 3]) {
    let origin = r.unit().map(|x| x * distance);
    let target = r.unit().map(|x| x * 0.5);
    (origin, plus(target, origin, -1.0))
}

/// A ball that the ray passes at its radius, changed by a small share.
fn beside(r: &mut Random, (o, d): ([f64; 3], [f64; 3]), radius: f64) -> [f64; 4] {
    let w = d.map(|x| x / length(d));
    let outward = cross(w, r.unit());
    let middle = -(o[0] * w[0] + o[1] * w[1] + o[2] * w[2]);
    let foot = plus(o, w, middle + r.within(-0.5, 0.5));
    let distance = radius * (1.0 + r.exponent(-10.0, -5.0));
    let [x, y, z] = plus(foot, outward, distance / length(outward));
    [x, y, z, radius]
}

/// A case whose balls are made one after the other.
fn with_balls(r: &mut Random, (o, d): ([f64; 3], [f64; 3]), mut ball: impl FnMut(&mut Random) -> [f64; 4]) -> CullCase {
    let balls = [0; WIDTH].map(|_| ball(r));
    CullCase { ray: [o[0], o[1], o[2], d[0], d[1], d[2]], balls }
}

/// The ordinary class first, then the hard ones, of `count` rays each.
fn classes(count: usize) -> Vec<(&'static str, Vec<CullCase>)> {
    type Make = fn(&mut Random) -> CullCase;
    let makers: [(&str, Make); 6] = [
        ("ordinary", |r| {
            let ray = ray(r, 4.0);
            with_balls(r, ray, |r| {
                let [x, y, z] = r.vector(0.5);
                [x, y, z, 0.1]
            })
        }),
        ("silhouettes", |r| {
            let ray = ray(r, 4.0);
            with_balls(r, ray, |r| beside(r, ray, 0.05))
        }),
        ("silhouettes of tiny balls", |r| {
            let ray = ray(r, 4.0);
            with_balls(r, ray, |r| {
                let radius = size(r.within(-7.0, -4.0));
                beside(r, ray, radius)
            })
        }),
        ("silhouettes from far", |r| {
            let distance = size(r.within(2.0, 6.0));
            let ray = ray(r, distance);
            with_balls(r, ray, |r| beside(r, ray, 0.05))
        }),
        ("balls that end where the ray begins", |r| {
            let (o, d) = (r.vector(0.3), r.unit());
            with_balls(r, (o, d), |r| {
                let radius = r.within(0.01, 0.3);
                let [x, y, z] = plus(o, d, -radius * (1.0 + r.exponent(-10.0, -5.0)));
                [x, y, z, radius]
            })
        }),
        ("rays along an axis", |r| {
            let ray = ([r.whole(-2, 2) / 4.0, r.whole(-2, 2) / 4.0, 4.0], [0.0, 0.0, -r.within(0.5, 2.0)]);
            with_balls(r, ray, |r| {
                let [x, y, z] = [0; 3].map(|_| r.whole(-2, 2) / 4.0);
                [r.near(x), y, z, 0.25]
            })
        }),
    ];
    let mut random = Random::new(0xC011);
    makers.map(|(name, make)| (name, (0..count).map(|_| make(&mut random)).collect())).into()
}

#[cfg(test)]
mod tests {
    use rt_geom::Bvh;

    use super::*;

    #[test]
    fn only_the_cull_without_a_margin_drops_what_a_ray_meets() {
        let kernel = cull(Effort { cases: 400, rounds: 1, timing: 1, spheres: 0, rows: 0 });
        for method in &kernel.methods {
            let lost = method.total().lost;
            assert_eq!(lost > 0, method.name == "f32, no margin", "{} drops {lost}", method.name);
        }
        let wrong = |name: &str| {
            let found = kernel.methods.iter().find(|method| method.name == name).expect("a method's name");
            found.total().wrong_verdicts
        };
        assert!(wrong("f32, the tree's margin") < wrong("f32, margin × 16"));
        assert!(wrong("f32, the tree's margin") < wrong("f32, boxes"));
        assert_eq!(wrong("exact test"), 0);
    }

    #[test]
    fn the_restated_cull_keeps_what_the_tree_keeps() {
        // Balls that a ray misses by up to ten margins, and two that make the scene the unit ball.
        let anchor = |x: f64| [x, 0.0, 0.0, 0.01];
        let mut random = Random::new(7);
        let r = &mut random;
        let cases: Vec<CullCase> = std::iter::repeat_with(|| {
            let origin = r.unit().map(|x| x * 4.0);
            let direction = plus(r.unit().map(|x| x * 0.5), origin, -1.0);
            let w = direction.map(|x| x / length(direction));
            let mut balls = [anchor(0.98); WIDTH];
            balls[1] = anchor(-0.98);
            for ball in &mut balls[2..] {
                let outward = cross(w, r.unit());
                let distance = 0.05 + r.within(1e-9, 640.0 * f32::HALF_ULP);
                let foot = plus(origin, w, -dot(origin, w) + r.within(-0.4, 0.4));
                let [x, y, z] = plus(foot, outward, distance / length(outward));
                *ball = [x, y, z, 0.05];
            }
            let [[ox, oy, oz], [dx, dy, dz]] = [origin, direction];
            CullCase { ray: [ox, oy, oz, dx, dy, dz], balls }
        })
        .filter(|case| truth(case) == 0)
        .take(500)
        .collect();
        let ours = METHODS.iter().find(|method| method.name == "f32, the tree's margin").expect("it is there");
        let mut kept = vec![0; cases.len()];
        (ours.prepare)(&cases)(&mut kept);
        let restated: u32 = kept.iter().map(|kept| kept.count_ones()).sum();
        let tests = |case: &CullCase| {
            let sphere = |ball: [f64; 4]| Sphere::new(dvec3(&ball, 0), ball[3]).expect("radii are positive");
            let tree = Bvh::new(case.balls.map(sphere).to_vec(), Vec::new());
            let ray = Ray::new(dvec3(&case.ray, 0), dvec3(&case.ray, 3)).expect("a valid ray");
            tree.closest_counted(&ray, 0.0..f64::INFINITY).1.tests
        };
        let tree: usize = cases.iter().map(tests).sum();
        let share = f64::from(restated) / tree as f64;
        assert!(tree > 300 && (share - 1.0).abs() < 0.02, "the tree keeps {tree}, the restated cull {restated}");
    }
}
