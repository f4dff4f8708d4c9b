//! `enclosing_sphere` encloses, in exact arithmetic, and is minimal, by a certificate in 400-bit arithmetic, on every
//! class of sets that is known to be awkward.

use glam::DVec3;
use oracle::enclosing::Ball;
use oracle::enclosing::certificate::Certificate;
use oracle::{Random, exact, quotient};
use rt_geom::{Bvh, Enclosing, Ray, Sphere, SphereTree, Triangle, enclosing_sphere};

fn sphere(center: DVec3, radius: f64) -> Sphere {
    Sphere::new(center, radius).expect("valid")
}

/// Makes a set of a class.
type Make = fn(&mut Random) -> Vec<Sphere>;

/// The classes of sets, by name.
const CLASSES: &[(&str, Make)] = &[
    ("one", |random| vec![sphere(random.point(), random.share())]),
    ("pair", |random| some(random, 2..3, |random| sphere(random.point(), random.share()))),
    ("cube", |random| {
        let largest = random.share();
        some(random, 2..40, |random| sphere(random.point(), largest * random.share()))
    }),
    ("points", |random| some(random, 2..40, |random| sphere(random.point(), 0.0))),
    ("many", |random| {
        let largest = 0.1 * random.share();
        some(random, 65..400, |random| sphere(random.point(), largest * random.share()))
    }),
    ("duplicates", |random| {
        let few = some(random, 1..5, |random| sphere(random.point(), random.share()));
        some(random, 2..30, |random| few[random.below(few.len())])
    }),
    ("concentric", |random| {
        let centers = [random.point(), random.point()];
        some(random, 2..20, |random| sphere(centers[random.below(2)], random.share()))
    }),
    ("one contains all", |random| {
        let big = sphere(random.point(), 4.0);
        let mut set = some(random, 2..20, |random| sphere(random.point(), 0.1 * random.share()));
        set.push(big);
        random.shuffle(&mut set);
        set
    }),
    ("tangent from inside", |random| {
        // A big sphere, and others that touch it from inside up to rounding, here and there one that sticks out.
        let big = sphere(random.point(), 1.0 + random.share());
        let mut set = some(random, 1..90, |random| {
            let radius = big.radius() * random.share();
            let out = if random.below(8) == 0 { random.share() * 1e-12 } else { 0.0 };
            let reach = big.radius() - radius + out;
            sphere(big.center() + reach * random.direction(), radius)
        });
        set.push(big);
        random.shuffle(&mut set);
        set
    }),
    ("collinear", |random| {
        let (from, along) = (random.point(), random.direction());
        some(random, 2..20, |random| sphere(from + 3.0 * random.uniform() * along, 0.3 * random.share()))
    }),
    ("coplanar", |random| {
        let (from, a, b) = (random.point(), random.direction(), random.direction());
        let flat = random.below(2) as f64 * 0.2;
        some(random, 2..20, |random| sphere(from + random.uniform() * a + random.uniform() * b, flat * random.share()))
    }),
    ("cospherical", |random| {
        let (center, radius) = (random.point(), 0.1 * random.below(3) as f64);
        some(random, 2..60, |random| sphere(center + random.direction(), radius))
    }),
    ("grid", |random| {
        let side = 1 + random.below(4);
        let radius = random.below(3) as f64;
        some(random, 2..60, |random| {
            let mut coordinate = || random.below(side + 1) as f64;
            sphere(DVec3::new(coordinate(), coordinate(), coordinate()), radius)
        })
    }),
    ("six decades of radii", |random| {
        some(random, 2..30, |random| sphere(random.point(), 10.0_f64.powf(-6.0 * random.share())))
    }),
    ("far offset", |random| {
        let offset = 1e8 * random.point();
        some(random, 2..30, |random| sphere(offset + random.point(), 0.3 * random.share()))
    }),
    ("any offset, pair", |random| {
        let (offset, size) = anywhere(random);
        some(random, 2..3, |random| sphere(offset + size * random.point(), size * random.share()))
    }),
    ("any offset", |random| {
        let (offset, size) = anywhere(random);
        let round = random.below(2) == 0;
        some(random, 2..17, |random| {
            let radius = if round { 0.0 } else { size * random.share() };
            sphere(offset + size * random.point(), radius)
        })
    }),
    ("any offset, nested", |random| {
        // Equal centers, or as good as equal; radii that differ by a few units in the last place, or touch from inside.
        let (offset, size) = anywhere(random);
        let big = size * (1.0 + random.share());
        some(random, 2..9, |random| match random.below(3) {
            0 => sphere(offset, f64::from_bits(big.to_bits() - random.bits() % 4)),
            1 => sphere(offset + 1e-15 * size * random.point(), big),
            _ => {
                let inner = size * random.share();
                sphere(offset + (big - inner) * random.direction(), inner)
            }
        })
    }),
    ("any offset, few units apart", |random| {
        // Half-way centers and reaches that are doubles.
        let unit = 10.0_f64.powf(584.0 * random.share() - 292.0);
        let unit = f64::from_bits(unit.to_bits() & 0x7ff0_0000_0000_0000);
        let far = (1_u64 << (52 - random.below(2) * 3)) as f64;
        some(random, 2..9, |random| {
            let mut coordinate = || (far + random.below(4) as f64) * unit;
            let center = DVec3::new(coordinate(), coordinate(), coordinate());
            sphere(center, random.below(3) as f64 * unit)
        })
    }),
    ("nearly degenerate", |random| {
        // Almost flat, almost a line or almost a point, at every thickness.
        let thin = 10.0_f64.powf(-16.0 * random.share());
        let thinner = thin * if random.below(2) == 0 { 1.0 } else { random.share() * 1e-3 };
        let radius = if random.below(2) == 0 { 0.0 } else { thin };
        some(random, 3..12, |random| sphere(random.point() * DVec3::new(1.0, thin, thinner), radius * random.share()))
    }),
    ("nearly nested", |random| {
        let big = sphere(random.point(), 1.0);
        let mut set = vec![big];
        for _ in 0..1 + random.below(6) {
            let radius = random.share();
            let out = 10.0_f64.powf(-17.0 * random.share());
            set.push(sphere(big.center() + (1.0 - radius + out) * random.direction(), radius));
        }
        random.shuffle(&mut set);
        set
    }),
    ("scales", |random| {
        let scale = 10.0_f64.powf(580.0 * random.share() - 290.0);
        some(random, 2..20, |random| sphere(scale * random.point(), scale * random.share()))
    }),
    ("mixed scales", |random| {
        some(random, 2..10, |random| {
            let mut wild = || random.uniform() * 10.0_f64.powf(570.0 * random.share() - 290.0);
            sphere(DVec3::new(wild(), wild(), wild()), wild().abs())
        })
    }),
    ("all bits", |random| {
        some(random, 1..8, |random| {
            let mut any =
                || f64::from_bits(random.bits() & !(3 << 61)) * if random.below(9) == 0 { 1e300 } else { 1.0 };
            sphere(DVec3::new(any(), any(), any()), any().abs())
        })
    }),
];

/// A point from 10^8 to 10^300 away, and the size of a set there, or both of them 10^-300 times as large: from as large
/// as its distance to smaller than the spacing of doubles.
fn anywhere(random: &mut Random) -> (DVec3, f64) {
    let distance = 10.0_f64.powf(8.0 + 292.0 * random.share());
    let distance = if random.below(4) == 0 { distance * 1e-300 } else { distance };
    let direction = if random.below(4) == 0 { DVec3::X } else { random.direction() };
    (distance * direction, distance * 10.0_f64.powf(-18.0 * random.share()))
}

fn some(
    random: &mut Random,
    sizes: std::ops::Range<usize>,
    mut item: impl FnMut(&mut Random) -> Sphere,
) -> Vec<Sphere> {
    let size = sizes.start + random.below(sizes.len());
    (0..size).map(|_| item(random)).collect()
}

fn ball(sphere: &Sphere) -> Ball {
    Ball::new(sphere.center(), sphere.radius())
}

/// Whether `outer` contains `inner`, in exact arithmetic.
fn contains(outer: &Sphere, inner: &Sphere) -> bool {
    ball(outer).contains(&ball(inner))
}

/// The excess of an answer over what doubles can express, relative to the radius. (Any center that costs at most one
/// spacing of doubles is good enough; that shows where sets lie anywhere.)
fn check(class: &str, spheres: &[Sphere], answer: &Enclosing) -> f64 {
    for sphere in spheres {
        assert!(contains(&answer.sphere, sphere), "{class}: {sphere:?} sticks out of {answer:?} in {spheres:?}");
    }
    let less = answer.sphere.radius().next_down();
    let less = Sphere::new(answer.sphere.center(), less).ok();
    assert!(
        less.is_none_or(|less| !spheres.iter().all(|sphere| contains(&less, sphere))),
        "{class}: a smaller radius than that of {answer:?} encloses {spheres:?}"
    );
    assert!(answer.lower_bound <= answer.sphere.radius(), "{class}: {answer:?}");
    let balls: Vec<Ball> = spheres.iter().map(ball).collect();
    let support: Vec<Ball> = answer.support().iter().map(|&index| balls[index].clone()).collect();
    assert!((1..=4).contains(&support.len()));
    if answer.sphere.radius() == 0.0 {
        return 0.0;
    }
    let tight = |found: &Certificate| {
        let spacing = answer.sphere.center().abs().max_element() * f64::EPSILON;
        &found.floor - &found.bound <= exact(1e-15 * answer.sphere.radius() + 2.0 * spacing)
    };
    // Sets that are degenerate up to rounding may have a support of which a part alone decides.
    let part = |mask: usize| -> Vec<Ball> {
        (0..support.len()).filter(|i| mask >> i & 1 == 1).map(|i| support[i].clone()).collect()
    };
    let certificate = Certificate::new(&balls, &support).filter(tight).or_else(|| {
        let parts = (1..1_usize << support.len()).filter_map(|mask| Certificate::new(&balls, &part(mask)));
        parts.max_by(|a, b| a.bound.cmp(&b.bound))
    });
    let certificate = certificate.expect("one sphere alone has a certificate");
    let radius = exact(answer.sphere.radius());
    // The bound that the answer states is below what every enclosing sphere needs.
    assert!(
        exact(answer.lower_bound) <= certificate.ceiling,
        "{class}: the bound of {answer:?} is too high in {spheres:?}"
    );
    let floor = certificate.floor.max(certificate.bound.clone());
    let tight = quotient(&(&floor - &certificate.bound), &radius);
    let spacing = answer.sphere.center().abs().max_element() * f64::EPSILON / answer.sphere.radius();
    let tight = tight.to_f64().value();
    assert!(tight <= 1e-15 + 2.0 * spacing, "{class}: {answer:?} is not minimal: {tight:e} in {spheres:?}");
    let free = if class.starts_with("any offset") { spacing } else { 0.0 };
    quotient(&(&radius - floor), &radius).to_f64().value() - free
}

#[test]
fn every_class_is_enclosed_exactly_and_minimally() {
    let long = std::env::var_os("RT_LONG").is_some();
    let cases = if long { 20_000 } else { 500 };
    let mut all = Vec::new();
    for (class, make) in CLASSES {
        let mut random = Random::new(7);
        let mut worst = 0.0_f64;
        for _ in 0..cases {
            let spheres = make(&mut random);
            let Some(answer) = enclosing_sphere(&spheres) else {
                assert!(spheres.iter().any(|sphere| sphere.center().length().max(sphere.radius()) > 1e307));
                continue;
            };
            let excess = check(class, &spheres, &answer);
            worst = worst.max(excess);
            all.push(excess);
        }
        println!("{class}: {worst:e}");
    }
    all.sort_by(f64::total_cmp);
    let (p99, worst) = (all[all.len() * 99 / 100], all[all.len() - 1]);
    println!("p99 {p99:e}, worst {worst:e}");
    assert!(p99 <= 2.3e-16 && worst <= 1e-14, "{p99:e} {worst:e}");
}

/// The radius that doubles cannot go below: the certified bound, and what rounding the center costs.
fn slack(answer: &Enclosing) -> f64 {
    let spacing = answer.sphere.center().abs().max_element() * f64::EPSILON;
    2.0 * f64::EPSILON * answer.sphere.radius() + spacing
}

#[test]
fn the_order_of_the_spheres_does_not_matter() {
    for (class, make) in CLASSES {
        let mut random = Random::new(11);
        for _ in 0..100 {
            let mut spheres = make(&mut random);
            let Some(first) = enclosing_sphere(&spheres) else { continue };
            random.shuffle(&mut spheres);
            let second = enclosing_sphere(&spheres).expect("order does not matter");
            let (a, b) = (first.sphere.radius(), second.sphere.radius());
            let limit = 2.0 * f64::EPSILON * a.min(b) + if *class == "far offset" { 0.0 } else { slack(&first) };
            assert!((a - b).abs() <= limit, "{class}: {a} {b} {spheres:?}");
        }
    }
}

#[test]
fn a_sphere_outside_of_the_support_can_go() {
    for (class, make) in CLASSES {
        let mut random = Random::new(13);
        for _ in 0..100 {
            let mut spheres = make(&mut random);
            let Some(first) = enclosing_sphere(&spheres) else { continue };
            let Some(out) = (0..spheres.len()).find(|index| !first.support().contains(index)) else {
                continue;
            };
            spheres.remove(out);
            let second = enclosing_sphere(&spheres).expect("fewer spheres");
            let (a, b) = (first.sphere.radius(), second.sphere.radius());
            assert!((a - b).abs() <= slack(&first), "{class}: {a} {b} without {out} {spheres:?}");
        }
    }
}

#[test]
fn large_sets_are_enclosed_and_minimal() {
    let mut random = Random::new(17);
    for (count, duplicates) in [(2049, 0), (5000, 0), (10_000, 4999), (70_000, 0)] {
        let mut spheres: Vec<Sphere> = (0..count).map(|_| sphere(random.direction(), 0.01 * random.share())).collect();
        let same = spheres[0];
        spheres[..duplicates * 2].fill(same);
        let answer = enclosing_sphere(&spheres).expect("finite");
        for inner in &spheres {
            let rough = (inner.center() - answer.sphere.center()).length() + inner.radius();
            if rough > answer.sphere.radius() * (1.0 - 1e-14) {
                assert!(contains(&answer.sphere, inner), "{inner:?} sticks out of {answer:?}");
            }
        }
        assert!(answer.sphere.radius() - answer.lower_bound <= 1e-15 * answer.sphere.radius(), "{answer:?}");
    }
}

#[test]
fn trees_of_two_balls_and_a_triangle_are_built_anywhere() {
    let mut random = Random::new(19);
    for round in 0..300 {
        let (offset, size) = if round == 0 { (DVec3::splat(1e14), 1.0) } else { anywhere(&mut random) };
        let spheres = vec![
            sphere(offset + size * random.point(), size * random.share()),
            sphere(offset + size * random.point(), size * random.share()),
        ];
        let [a, b, c] = [(); 3].map(|()| offset + size * random.point());
        let triangles = vec![Triangle::new(a, b, c).expect("finite")];
        let fast = Bvh::new(spheres.clone(), triangles.clone());
        let halves = SphereTree::new(spheres.clone(), triangles.clone());
        let sorted = SphereTree::sorted(spheres.clone(), triangles.clone());
        for target in [spheres[0].center(), spheres[1].center(), (a + b + c) / 3.0, a] {
            let Ok(ray) = Ray::new(DVec3::ZERO, target) else { continue };
            let range = 0.0..f64::INFINITY;
            let plain = spheres
                .iter()
                .map(|sphere| sphere.closest(&ray, range.clone()))
                .chain([triangles[0].closest(&ray, range.clone())])
                .enumerate()
                .filter_map(|(index, t)| t.map(|t| (t, index)))
                .min_by(|x, y| x.0.total_cmp(&y.0));
            for hit in [
                fast.closest(&ray, range.clone()),
                halves.closest(&ray, range.clone()),
                sorted.closest(&ray, range.clone()),
            ] {
                assert_eq!(hit.map(|hit| (hit.t, hit.index)), plain, "{spheres:?} {triangles:?} {ray:?}");
            }
        }
    }
}

#[test]
fn no_finite_sphere_encloses_the_ends_of_the_range() {
    let far = sphere(DVec3::splat(f64::MAX), f64::MAX);
    assert!(enclosing_sphere(&[far, sphere(-DVec3::splat(f64::MAX), f64::MAX)]).is_none());
    assert!(enclosing_sphere(&[]).is_none());
    assert_eq!(enclosing_sphere(&[far]).expect("itself").sphere, far);
}
