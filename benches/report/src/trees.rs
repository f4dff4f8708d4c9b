//! What the trees cost to build and what they save: a plain loop, the report's tree over the list as it is and sorted
//! in space, and the fast tree, one ray at a time and many at once.
//!
//! The scene is a cloud of equal spheres in a cube, which fill about a tenth of it however many they are; the rays come
//! from all sides and aim at points in the cube. The spheres are listed in random order, so that halves of the list are
//! no halves of the cloud: the worst order for the report's tree, unless it sorts them.

use std::fmt::Write;
use std::hint::black_box;
use std::time::Instant;

use glam::DVec3;
use pxfm::f_cbrt;
use rt_geom::{AHEAD, Bvh, Hit, Ray, Sphere, SphereTree};
use serde::{Deserialize, Serialize};

use super::labels::Labels;
use super::measure::{Effort, Time};
use super::progress::progress;
use super::random::Random;
use super::svg::{
    LEFT, RIGHT, axes, below, caption, key, key_height, level, power_of_ten, shape, style, upright, upward,
};

/// What was measured of one method on one number of spheres.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Growth {
    pub(super) method: String,
    pub(super) ours: bool,
    pub(super) spheres: usize,
    pub(super) rays: usize,
    /// Seconds to build, once.
    pub(super) build: f64,
    /// Nanoseconds for one ray.
    pub(super) time: Time,
    /// Rays whose hit is not the plain loop's, of those compared.
    pub(super) different: usize,
    pub(super) compared: usize,
    /// Sphere tests for one ray, where they are counted.
    pub(super) tests: Option<f64>,
}

/// Writes the closest hit of each ray.
type Trace<'a> = Box<dyn Fn(&[Ray], &mut [Option<Hit>]) + 'a>;

/// A way to find closest hits, as [`Growth`] describes it.
struct Contestant<'a> {
    name: &'static str,
    ours: bool,
    rays: &'a [Ray],
    build: f64,
    tests: Option<f64>,
    trace: Trace<'a>,
}

/// Sphere tests that the plain loop may make in one round.
const LOOP: usize = 16_000_000;

/// Measures growing clouds.
pub(super) fn growth(effort: Effort) -> Vec<Growth> {
    let counts = std::iter::successors(Some(100), |count| Some(count * 10));
    counts.take_while(|&count| count <= effort.spheres).flat_map(|count| cloud(count, effort)).collect()
}

/// Measures all methods on one cloud.
fn cloud(count: usize, effort: Effort) -> Vec<Growth> {
    progress(&format!("trees of {count} spheres"));
    let cloud = Cloud::new(count, effort);
    let trees = Trees::new(&cloud.spheres);
    let truth: Vec<Option<Hit>> = cloud.few().iter().map(|ray| cloud.plain(ray)).collect();
    race(count, &contestants(&cloud, &trees), &truth, effort)
}

/// Spheres, and rays that aim at them.
struct Cloud {
    spheres: Vec<Sphere>,
    rays: Vec<Ray>,
}

impl Cloud {
    fn new(count: usize, effort: Effort) -> Self {
        let mut random = Random::new(count as u64);
        let radius = f_cbrt(0.1 * 8.0 / (count as f64 * 4.19));
        let mut point = |size: f64| DVec3::from_array(random.vector(size));
        let sphere = |center| Sphere::new(center, radius).expect("a cloud is made of valid spheres");
        let spheres = (0..count).map(|_| sphere(point(1.0))).collect();
        let ray = || {
            let origin = point(1.0).normalize_or(DVec3::X) * 4.0;
            Some(Ray::new(origin, point(1.0) - origin))
        };
        Self { spheres, rays: std::iter::from_fn(ray).flatten().take(2 * effort.cases).collect() }
    }

    /// As many rays as the plain loop may ask in one round.
    fn few(&self) -> &[Ray] {
        &self.rays[..(LOOP / self.spheres.len()).clamp(1, self.rays.len())]
    }

    /// The closest hit, by asking every sphere.
    fn plain(&self, ray: &Ray) -> Option<Hit> {
        let hits = self.spheres.iter().enumerate();
        let hits = hits.filter_map(|(index, sphere)| Some(Hit { index, t: sphere.closest(ray, AHEAD)? }));
        // The first of equal hits is kept: the lower index.
        hits.reduce(|best, hit| if hit.t < best.t { hit } else { best })
    }
}

/// What is built over the spheres of a cloud, and the seconds that it took.
struct Trees {
    listed: (SphereTree, f64),
    sorted: (SphereTree, f64),
    fast: (Bvh, f64),
}

impl Trees {
    fn new(spheres: &[Sphere]) -> Self {
        /// Builds once to keep, and once more, warm, for the time.
        fn timed<T>(build: impl Fn() -> T) -> (T, f64) {
            let built = build();
            let start = Instant::now();
            drop(black_box(build()));
            (built, start.elapsed().as_secs_f64())
        }
        Self {
            listed: timed(|| SphereTree::new(spheres.to_vec(), Vec::new())),
            sorted: timed(|| SphereTree::sorted(spheres.to_vec(), Vec::new())),
            fast: timed(|| Bvh::new(spheres.to_vec(), Vec::new())),
        }
    }
}

fn contestants<'a>(cloud: &'a Cloud, Trees { listed, sorted, fast }: &'a Trees) -> [Contestant<'a>; 5] {
    let (few, all) = (cloud.few(), &cloud.rays[..]);
    let fewer = &few[..few.len().div_ceil(4)];
    let tests = |tree: &SphereTree, rays: &[Ray]| {
        let visits = rays.iter().map(|ray| tree.closest_counted(ray, AHEAD).1);
        Some(visits.map(|visits| visits.nodes + visits.tests).sum::<usize>() as f64 / rays.len() as f64)
    };
    let contestant = |name, ours, rays, build, tests, trace| Contestant { name, ours, rays, build, tests, trace };
    let looped = Some(cloud.spheres.len() as f64);
    let batch: Trace = Box::new(|rays, hits| fast.0.closest_batch(rays, AHEAD, hits));
    [
        contestant("plain loop", false, few, 0.0, looped, each(|ray| cloud.plain(ray))),
        contestant(
            "SphereTree, as listed",
            false,
            fewer,
            listed.1,
            tests(&listed.0, fewer),
            each(|ray| listed.0.closest(ray, AHEAD)),
        ),
        contestant(
            "SphereTree, sorted",
            true,
            all,
            sorted.1,
            tests(&sorted.0, all),
            each(|ray| sorted.0.closest(ray, AHEAD)),
        ),
        contestant("Bvh", true, all, fast.1, None, each(|ray| fast.0.closest(ray, AHEAD))),
        contestant("Bvh, batch", true, all, fast.1, None, batch),
    ]
}

/// Asks ray by ray.
fn each<'a>(closest: impl Fn(&Ray) -> Option<Hit> + 'a) -> Trace<'a> {
    Box::new(move |rays, hits| {
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = closest(ray);
        }
    })
}

/// Times the contestants in turn and compares their hits with the true ones, which begin with the first ray.
fn race(count: usize, contestants: &[Contestant], truth: &[Option<Hit>], effort: Effort) -> Vec<Growth> {
    let mut times = vec![Vec::new(); contestants.len()];
    let mut different = vec![0; contestants.len()];
    let mut hits = vec![None; 2 * effort.cases];
    for _ in 0..effort.rounds {
        for (i, Contestant { rays, trace, .. }) in contestants.iter().enumerate() {
            let start = Instant::now();
            trace(black_box(rays), &mut hits[..rays.len()]);
            times[i].push(start.elapsed().as_nanos() as f64 / rays.len() as f64);
            let key = |hit: &Option<Hit>| hit.as_ref().map(|hit| (hit.index, hit.t.to_bits()));
            different[i] = hits[..rays.len()].iter().zip(truth).filter(|(hit, truth)| key(hit) != key(truth)).count();
        }
    }
    let measured = contestants.iter().zip(times).zip(different);
    let rows = measured.map(|((&Contestant { name, ours, rays, build, tests, .. }, times), different)| Growth {
        method: name.to_owned(),
        ours,
        spheres: count,
        rays: rays.len(),
        build,
        time: Time::of(times),
        different,
        compared: truth.len().min(rays.len()),
        tests,
    });
    rows.collect()
}

const TOP: f64 = 36.0;
const BOTTOM: f64 = 316.0;
const KEY: f64 = BOTTOM + 58.0;

/// Returns the diagram of the time for one ray against the number of spheres, both logarithmic.
pub(super) fn plot(growth: &[Growth]) -> String {
    let range = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x.log10()), high.max(x.log10())))
    };
    let (x_low, x_high) = range(&mut growth.iter().map(|row| row.spheres as f64));
    let (y_low, y_high) = range(&mut growth.iter().map(|row| row.time.median));
    let (y_low, y_high) = (y_low.floor(), y_high.ceil());
    let x_high = x_high.max(x_low + 1.0);
    let x =
        |spheres: usize| LEFT + 14.0 + (RIGHT - LEFT - 50.0) * ((spheres as f64).log10() - x_low) / (x_high - x_low);
    let y = |time: f64| TOP + (BOTTOM - TOP) * (y_high - time.log10()) / (y_high - y_low);
    let mut methods: Vec<(&str, bool)> = Vec::new();
    for row in growth {
        if !methods.iter().any(|(name, _)| *name == row.method) {
            methods.push((&row.method, row.ours));
        }
    }
    let mut svg = style("closest hit in a cloud of spheres", KEY + key_height(methods.len()));
    #[expect(clippy::cast_possible_truncation, reason = "whole numbers of decades")]
    for decade in y_low as i32..=y_high as i32 {
        level(&mut svg, y(10f64.powf(decade.into())), power_of_ten(decade));
    }
    for row in growth.iter().filter(|row| row.method == methods[0].0) {
        upright(&mut svg, x(row.spheres), TOP, BOTTOM);
        below(&mut svg, x(row.spheres), BOTTOM + 17.0, row.spheres);
    }
    let lines = methods.iter().map(|&(name, ours)| {
        let rows = growth.iter().filter(|row| row.method == name);
        (class(ours), rows.map(|row| (x(row.spheres), y(row.time.median))).collect())
    });
    join(&mut svg, &lines.collect::<Vec<_>>());
    axes(&mut svg, TOP, BOTTOM);
    caption(&mut svg, BOTTOM + 36.0, "spheres");
    upward(&mut svg, (TOP + BOTTOM) / 2.0, "nanoseconds a ray, one thread");
    let names: Vec<_> = methods.iter().map(|&(name, ours)| (name.to_owned(), class(ours).to_owned(), false)).collect();
    key(&mut svg, KEY, &names);
    svg + "</svg>\n"
}

fn class(ours: bool) -> &'static str {
    if ours { "ours" } else { "other" }
}

/// Draws the points of each method, joined, with its number at the last one.
fn join(svg: &mut String, lines: &[(&str, Vec<(f64, f64)>)]) {
    let mut labels = Labels::new([LEFT, RIGHT, TOP, BOTTOM], lines.iter().flat_map(|(_, points)| points.clone()));
    for (class, points) in lines {
        for pair in points.windows(2) {
            labels.avoid(pair[0], pair[1]);
        }
        let path: Vec<String> = points.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
        // Writing to a string cannot fail.
        let _ = writeln!(svg, r#"<polyline class="{class} line" points="{}"/>"#, path.join(" "));
        for &point in points {
            let _ = writeln!(svg, r#"<path class="{class}" d="{}"/>"#, shape(point, false));
        }
    }
    for (i, (_, points)) in lines.iter().enumerate() {
        *svg += &labels.place(points[points.len() - 1], i + 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_tree_gives_the_plain_loops_hit() {
        let rows = growth(Effort { cases: 64, rounds: 1, timing: 1, spheres: 1000, rows: 0 });
        assert_eq!(rows.len(), 10);
        for row in &rows {
            let compared = if row.method == "SphereTree, as listed" { 32 } else { 128 };
            assert_eq!((row.different, row.compared), (0, compared), "{} of {}", row.method, row.spheres);
        }
        let saved = rows.iter().find(|row| row.method == "SphereTree, as listed" && row.spheres == 1000);
        assert!(saved.and_then(|row| row.tests).is_some_and(|tests| tests > 1.0));
    }
}
