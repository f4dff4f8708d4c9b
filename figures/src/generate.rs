//! Set pieces: scenes of any size that tests, benches and galleries need, made by a rule.
//!
//! The random ones come from one fixed seed, so the same name and size give the same file. Sphereflake: E. Haines,
//! "A Proposal for Standard Graphics Environments", IEEE Computer Graphics and Applications 7(11), 1987.

use std::collections::HashMap;
use std::f64::consts::TAU;
use std::io::{self, Write};

use clap::ValueEnum;
use glam::{DMat3, DVec3};

/// A rule that makes spheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Rule {
    /// Centers anywhere in a cube, all of one size, a tenth of the cube filled.
    Uniform,
    /// A jittered face-centred lattice whose neighbours overlap, as in a molecule, listed in random order.
    Packed,
    /// Centers anywhere in a cube, radii over three decades.
    Mixed,
}

/// A sphere and its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColoredBall {
    /// Its center.
    pub center: DVec3,
    /// Its radius.
    pub radius: f64,
    /// Its colour.
    pub color: DVec3,
}

/// Writes spheres as an extended XYZ file.
///
/// # Errors
/// What `out` reports.
pub fn write_xyz(balls: &[ColoredBall], comment: &str, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "{}\n{comment} Properties=pos:R:3:radius:R:1:color:R:3", balls.len())?;
    for ColoredBall { center, radius, color } in balls {
        writeln!(
            out,
            "{:.6} {:.6} {:.6} {radius:.7} {:.3} {:.3} {:.3}",
            center.x, center.y, center.z, color.x, color.y, color.z
        )?;
    }
    Ok(())
}

/// Writes spheres as a scene in TOML, with a camera that fits them and two lights.
///
/// # Errors
/// What `out` reports.
pub fn write_toml(balls: &[ColoredBall], comment: &str, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "# {comment}\n\nbackground = [0.05, 0.06, 0.08]\n\nsphere = [")?;
    // The colours in order, and the place of each.
    let mut colors: Vec<DVec3> = Vec::new();
    let mut places: HashMap<[u64; 3], usize> = HashMap::new();
    for ColoredBall { center, radius, color } in balls {
        places.try_reserve(1).map_err(|_| io::ErrorKind::OutOfMemory)?;
        colors.try_reserve(1).map_err(|_| io::ErrorKind::OutOfMemory)?;
        let material = *places.entry(color.to_array().map(f64::to_bits)).or_insert_with(|| {
            colors.push(*color);
            colors.len() - 1
        });
        writeln!(
            out,
            "    {{ center = [{:.6}, {:.6}, {:.6}], radius = {radius:.7}, material = \"color-{material}\" }},",
            center.x, center.y, center.z
        )?;
    }
    writeln!(out, "]\n\n[camera]\nfov = 30\nfit = true\n")?;
    writeln!(
        out,
        "[[light]]\nposition = [-40, 60, 90]\n\n[[light]]\nposition = [80, -10, 30]\ncolor = [0.25, 0.3, 0.4]\n"
    )?;
    writeln!(out, "[material]")?;
    for (material, color) in colors.iter().enumerate() {
        writeln!(out, "color-{material} = {{ color = [{:.3}, {:.3}, {:.3}] }}", color.x, color.y, color.z)?;
    }
    Ok(())
}

/// Returns the sphereflake of this depth: a sphere of radius 1 with nine of a third of its size on it, and so on:
/// `(9^(depth + 1) - 1) / 8` spheres, parents before children.
///
/// Six children stand around the equator, three above, seen from where the parent touches its own parent.
pub fn sphereflake(depth: u32) -> Vec<ColoredBall> {
    let half_root = 0.75_f64.sqrt(); // sin 60 degrees
    let equator = [(1.0, 0.0), (0.5, half_root), (-0.5, half_root), (-1.0, 0.0), (-0.5, -half_root), (0.5, -half_root)];
    let mut directions: Vec<DVec3> = equator.iter().map(|&(x, y)| DVec3::new(x, y, 0.0)).collect();
    // Above, between the equator's, at the height where all nine are evenly apart.
    let (low, high) = ((1.0_f64 / 3.0).sqrt(), (2.0_f64 / 3.0).sqrt());
    directions
        .extend([(half_root, 0.5), (-half_root, 0.5), (0.0, -1.0)].map(|(x, y)| DVec3::new(low * x, low * y, high)));

    let mut balls = Vec::with_capacity(flake_spheres(depth));
    // A sphere and its frame, whose z axis points away from the parent. The root's points up, turned a little to the
    // eye.
    let mut level = vec![(DVec3::ZERO, frame(DVec3::new(0.15, 1.0, 0.45).normalize()))];
    let mut radius = 1.0;
    for generation in 0..=depth {
        let color = shade(generation);
        balls.extend(level.iter().map(|&(center, _)| ColoredBall { center, radius, color }));
        if generation < depth {
            let reach = radius + radius / 3.0;
            let children = |&(center, axes): &(DVec3, DMat3)| {
                directions.clone().into_iter().map(move |direction| {
                    let outward = axes * direction;
                    (center + reach * outward, frame(outward))
                })
            };
            let mut next = Vec::with_capacity(9 * level.len());
            next.extend(level.iter().flat_map(children));
            level = next;
            radius /= 3.0;
        }
    }
    balls
}

/// How many spheres a sphereflake has.
fn flake_spheres(depth: u32) -> usize {
    (9_usize.pow(depth + 1) - 1) / 8
}

/// Bytes of memory that [`sphereflake`] takes: its spheres, and those of the last two generations once more with their
/// frames.
pub(crate) fn sphereflake_memory(depth: u32) -> u64 {
    let frames = 9_usize.pow(depth) + 9_usize.pow(depth.saturating_sub(1));
    (flake_spheres(depth) * size_of::<ColoredBall>() + frames * size_of::<(DVec3, DMat3)>()) as u64
}

/// An orthonormal frame with this z axis, a unit vector.
fn frame(z: DVec3) -> DMat3 {
    let (x, y) = z.any_orthonormal_pair();
    DMat3::from_cols(x, y, z)
}

/// Colours from deep blue to gold, one for each generation.
fn shade(generation: u32) -> DVec3 {
    const SHADES: [[f64; 3]; 7] = [
        [0.11, 0.22, 0.48],
        [0.13, 0.47, 0.62],
        [0.26, 0.66, 0.56],
        [0.91, 0.77, 0.42],
        [0.95, 0.55, 0.3],
        [0.85, 0.3, 0.33],
        [0.55, 0.2, 0.42],
    ];
    DVec3::from_array(SHADES[generation as usize % SHADES.len()])
}

/// Returns `count` spheres by a rule, in a cube of side 2 around `(0, 0, -3)`.
pub fn random(rule: Rule, count: u32) -> Vec<ColoredBall> {
    let mut numbers = SplitMix(0x5EED ^ u64::from(count));
    let n = f64::from(count.max(1));
    let ball = |center: DVec3, radius| {
        // The colour follows the place, so that depth and direction can be seen.
        let color = DVec3::splat(0.55) + 0.4 * (center - DVec3::new(0.0, 0.0, -3.0));
        ColoredBall { center, radius, color: color.clamp(DVec3::splat(0.1), DVec3::ONE) }
    };
    match rule {
        Rule::Uniform => {
            // n 4/3 pi r^3 is a tenth of the cube's 8.
            let radius = (0.8 / (n * 2.0 / 3.0 * TAU)).cbrt();
            (0..count).map(|_| ball(numbers.in_cube(), radius)).collect()
        }
        Rule::Mixed => {
            let mean = 0.2 / n.cbrt();
            let radius = |numbers: &mut SplitMix| mean * 10_f64.powf(1.5 * numbers.signed());
            (0..count)
                .map(|_| {
                    let center = numbers.in_cube();
                    ball(center, radius(&mut numbers))
                })
                .collect()
        }
        Rule::Packed => {
            let side = (1..).find(|side: &u32| 4 * u64::from(*side).pow(3) >= u64::from(count)).unwrap_or(1);
            let cell = 2.0 / f64::from(side);
            let places = (0..side).flat_map(|i| (0..side).flat_map(move |j| (0..side).map(move |k| [i, j, k])));
            let basis = [DVec3::ZERO, DVec3::new(0.5, 0.5, 0.0), DVec3::new(0.5, 0.0, 0.5), DVec3::new(0.0, 0.5, 0.5)];
            let sites = places.flat_map(|place| basis.map(|offset| DVec3::from_array(place.map(f64::from)) + offset));
            // The iterator does not know its length.
            let mut balls = Vec::with_capacity(count as usize);
            balls.extend(sites.take(count as usize).map(|site| {
                let jitter = 0.1 * DVec3::new(numbers.signed(), numbers.signed(), numbers.signed());
                ball((site + jitter) * cell - DVec3::new(1.0, 1.0, 4.0), 0.42 * cell)
            }));
            for last in (1..balls.len()).rev() {
                balls.swap(last, numbers.below(last + 1));
            }
            balls
        }
    }
}

/// Writes a torus knot as an OBJ mesh with colours at its vertices: a tube of `segments` rings, each of a tenth as many
/// vertices and at least 8, so that its faces are about square.
///
/// # Errors
/// What `out` reports.
pub fn write_knot(segments: u32, out: &mut dyn Write) -> io::Result<()> {
    let sides = (segments / 10).max(8);
    // The (2, 3) torus knot.
    let curve = |turn: f64| {
        let (around, along) = (3.0 * turn, 2.0 * turn);
        let distance = 2.0 + around.cos();
        DVec3::new(distance * along.cos(), distance * along.sin(), around.sin())
    };
    writeln!(out, "# a torus knot: {segments} rings of {sides} vertices")?;
    for ring in 0..segments {
        let turn = TAU * f64::from(ring) / f64::from(segments);
        let (here, ahead) = (curve(turn), curve(turn + 1e-4));
        let tangent = (ahead - here).normalize();
        // Straight away from the torus' core, made perpendicular to the curve.
        let core = DVec3::new(2.0 * (2.0 * turn).cos(), 2.0 * (2.0 * turn).sin(), 0.0);
        let outward = (here - core).reject_from(tangent).normalize();
        let sideways = tangent.cross(outward);
        for step in 0..sides {
            let (sine, cosine) = (TAU * f64::from(step) / f64::from(sides)).sin_cos();
            let p = here + 0.45 * (cosine * outward + sine * sideways);
            let color = [0.0, 1.0, 2.0].map(|third| 0.55 + 0.4 * (turn + third * TAU / 3.0).cos());
            let [red, green, blue] = color;
            writeln!(out, "v {:.6} {:.6} {:.6} {red:.4} {green:.4} {blue:.4}", p.x, p.y, p.z)?;
        }
    }
    let vertex = |ring: u32, step: u32| ring % segments * sides + step % sides + 1;
    for (ring, step) in (0..segments).flat_map(|ring| (0..sides).map(move |step| (ring, step))) {
        let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(r, s)| vertex(ring + r, step + s));
        let [a, b, c, d] = corners;
        writeln!(out, "f {a} {b} {c} {d}")?;
    }
    Ok(())
}

/// `SplitMix64`: G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number generators", 2014.
struct SplitMix(u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in -1..1.
    fn signed(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Uniform in the cube of side 2 around `(0, 0, -3)`.
    fn in_cube(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed() - 3.0)
    }

    /// One of the numbers below `end`, which is more than 0.
    #[expect(clippy::cast_possible_truncation, reason = "the remainder is below a usize")]
    fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sphereflake_has_the_known_number_of_spheres_and_they_touch() {
        for (depth, count) in [(0, 1), (1, 10), (2, 91), (3, 820), (4, 7381)] {
            assert_eq!(sphereflake(depth).len(), count);
        }
        let balls = sphereflake(3);
        for (index, child) in balls.iter().enumerate().skip(1) {
            let parent = balls[(index - 1) / 9];
            let gap = child.center.distance(parent.center) - child.radius - parent.radius;
            assert!(gap.abs() < 1e-14, "sphere {index} is {gap} away from its parent");
        }
    }

    #[test]
    fn the_rules_give_as_many_as_asked_for_within_their_cube() {
        for rule in [Rule::Uniform, Rule::Packed, Rule::Mixed] {
            for count in [1, 2, 5, 1000] {
                let balls = random(rule, count);
                assert_eq!(balls.len(), count as usize, "{rule:?}");
                let inside = |ball: &ColoredBall| (ball.center + DVec3::new(0.0, 0.0, 3.0)).abs().max_element() <= 1.3;
                assert!(balls.iter().all(|ball| inside(ball) && ball.radius > 0.0), "{rule:?} {count}");
            }
        }
    }
}
