//! The sphere sets and ray sets on which the project and its peers are measured side by side.
//!
//! Every coordinate is an f32 value, so single- and double-precision tracers see the same input.
//! The generators are deterministic: same name, same size, same bits on every machine.

/// `[x, y, z, radius]`
pub type Sphere = [f32; 4];

#[derive(Clone, Copy, Debug)]
pub struct Ray {
    pub origin: [f32; 3],
    /// Not normalised in every set; never zero.
    pub direction: [f32; 3],
}

pub struct SplitMix(pub u64);
impl SplitMix {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }
    /// Uniform in [0, 1), with 24 bits: exact in f32.
    pub fn unit(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1u64 << 24) as f32
    }
    pub fn signed(&mut self) -> f32 {
        2.0 * self.unit() - 1.0
    }
}

/// Names accepted by [`spheres`].
pub const SCENES: [&str; 10] =
    ["uniform", "flake", "packed", "mixed", "line", "lattice", "heights", "walls", "stars", "decades"];
/// Names accepted by [`mesh`] for every size.
pub const MESHES: [&str; 4] = ["globe", "terrain", "soup", "city"];

/// All scenes lie in a cube of about side 2 around (0, 0, -3), so the camera
/// (at the origin, looking down -z, view plane z = -1) sees each of them whole.
///
/// - `uniform`: centres uniform in the cube, equal radii, about 10 % of the volume filled.
/// - `flake`: Haines' sphereflake, nine children per sphere at a third of the radius.
/// - `packed`: a face-centred lattice with overlapping neighbours, jittered: a molecule's space-filling model.
/// - `mixed`: centres uniform, radii log-uniform over three decades.
/// - `line`: touching spheres along x.
/// - `lattice`: a cubic lattice, every sphere a third of its cell, without jitter.
/// - `heights`: a square of touching spheres, as high as hills.
/// - `walls`: `uniform` in a room of five spheres of radius 1e5.
/// - `stars`: in the camera's view, distances log-uniform over six decades, all of the same apparent size.
/// - `decades`: radii log-uniform over twelve decades; what is larger than a tenth touches the cube from outside.
pub fn spheres(scene: &str, n: usize) -> Vec<Sphere> {
    let mut rng = SplitMix(0x5EED ^ n as u64);
    match scene {
        "uniform" => {
            // n * 4/3 pi r^3 = 0.1 * 8
            let r = (0.8 / (n as f32 * 4.188_790_3)).cbrt();
            (0..n).map(|_| [rng.signed(), rng.signed(), rng.signed() - 3.0, r]).collect()
        }
        "flake" => flake(n),
        "packed" => {
            let per_side = ((n as f32 / 4.0).cbrt().ceil() as usize).max(1);
            let cell = 2.0 / per_side as f32;
            let r = cell * 0.42;
            let mut out = Vec::with_capacity(n);
            'fill: for i in 0..per_side {
                for j in 0..per_side {
                    for k in 0..per_side {
                        for b in [[0.0f32, 0.0, 0.0], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]] {
                            if out.len() == n {
                                break 'fill;
                            }
                            let p = |g: usize, o: f32, j: f32| (g as f32 + o + 0.1 * j) * cell - 1.0;
                            out.push([
                                p(i, b[0], rng.signed()),
                                p(j, b[1], rng.signed()),
                                p(k, b[2], rng.signed()) - 3.0,
                                r,
                            ]);
                        }
                    }
                }
            }
            // Input order is random, so a tree that halves by index gets no free locality.
            for i in (1..out.len()).rev() {
                let j = (rng.next() % (i as u64 + 1)) as usize;
                out.swap(i, j);
            }
            out
        }
        "mixed" => (0..n)
            .map(|_| {
                let r = 0.2 * (n as f32).cbrt().recip() * 10f32.powf(1.5 * rng.signed());
                [rng.signed(), rng.signed(), rng.signed() - 3.0, r]
            })
            .collect(),
        "line" => {
            let r = 1.0 / n as f32;
            (0..n).map(|i| [(2 * i + 1) as f32 * r - 1.0, 0.0, -3.0, r]).collect()
        }
        "lattice" | "heights" => {
            let flat = scene == "heights";
            let side = (n as f64).powf(if flat { 0.5 } else { 1.0 / 3.0 }).ceil() as usize;
            let cell = 2.0 / side as f32;
            let at = |i: usize| (i as f32 + 0.5) * cell - 1.0;
            let place = |i: usize| {
                let (x, y) = (at(i % side), at(i / side % side));
                if flat {
                    [x, y, 0.2 * (5.0 * x).sin() * (4.0 * y).cos() - 3.0, 0.5 * cell]
                } else {
                    [x, y, at(i / side / side) - 3.0, cell / 3.0]
                }
            };
            (0..n).map(place).collect()
        }
        "walls" => {
            const FAR: f32 = 1e5;
            let mut room = spheres("uniform", n.saturating_sub(5));
            let walls = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]];
            room.extend(
                walls.map(|[x, y, z]: [f32; 3]| [x * (FAR + 1.0), y * (FAR + 1.0), z * (FAR + 1.0) - 3.0, FAR]),
            );
            room
        }
        "stars" => (0..n)
            .map(|_| {
                let far = 10f32.powf(6.0 * rng.unit());
                [0.5 * far * rng.signed(), 0.5 * far * rng.signed(), -far, 0.3 * far / (n as f32).sqrt()]
            })
            .collect(),
        "decades" => (0..n)
            .map(|_| {
                let r = 10f32.powf(12.0 * rng.unit() - 9.0);
                let at = [rng.signed(), rng.signed(), rng.signed()];
                // Out along its own direction, until it touches the ball around the cube.
                let out = if r > 0.1 { (r + 1.75) / at.iter().map(|v| v * v).sum::<f32>().sqrt() } else { 1.0 };
                [at[0] * out, at[1] * out, at[2] * out - 3.0, r]
            })
            .collect(),
        other => panic!("no scene {other}"),
    }
}

fn flake(n: usize) -> Vec<Sphere> {
    // Breadth first: each sphere carries an orthonormal frame whose z points away from its parent.
    struct Node {
        c: [f64; 3],
        r: f64,
        z: [f64; 3],
    }
    let mut queue = std::collections::VecDeque::from([Node { c: [0.0, 0.0, -3.0], r: 0.5, z: [0.0, 0.0, 1.0] }]);
    let mut out = Vec::with_capacity(n);
    while out.len() < n {
        let Some(Node { c, r, z }) = queue.pop_front() else { break };
        out.push([c[0] as f32, c[1] as f32, c[2] as f32, r as f32]);
        if queue.len() + out.len() > 2 * n + 16 {
            continue;
        }
        let a = if z[0].abs() < 0.6 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
        let x = norm(cross(a, z));
        let y = cross(z, x);
        for k in 0..9 {
            let (elev, turn): (f64, f64) = if k < 6 {
                (0.0, k as f64 * std::f64::consts::FRAC_PI_3)
            } else {
                (0.955_316_618, (k - 6) as f64 * 2.0 * std::f64::consts::FRAC_PI_3 + 0.523_598_776)
            };
            let d: [f64; 3] =
                std::array::from_fn(|i| elev.cos() * (turn.cos() * x[i] + turn.sin() * y[i]) + elev.sin() * z[i]);
            let rr = r / 3.0;
            queue.push_back(Node { c: std::array::from_fn(|i| c[i] + (r + rr) * d[i]), r: rr, z: d });
        }
    }
    out
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
fn norm(a: [f64; 3]) -> [f64; 3] {
    let l = (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt();
    a.map(|v| v / l)
}

/// Primary rays of the camera, `side` x `side`, scan order: eye at the origin, plane z = -1,
/// half-width 0.5 so that the cube fills the view. Directions are not normalised (z = -1).
pub fn camera_rays(side: usize) -> Vec<Ray> {
    let mut out = Vec::with_capacity(side * side);
    for j in 0..side {
        for i in 0..side {
            let u = (i as f32 + 0.5) / side as f32 - 0.5;
            let v = 0.5 - (j as f32 + 0.5) / side as f32;
            out.push(Ray { origin: [0.0; 3], direction: [u, v, -1.0] });
        }
    }
    out
}

/// Incoherent rays: origins uniform in the cube, directions uniform on the unit sphere.
pub fn random_rays(n: usize) -> Vec<Ray> {
    let mut rng = SplitMix(0xD1CE);
    (0..n)
        .map(|_| {
            let origin = [rng.signed(), rng.signed(), rng.signed() - 3.0];
            Ray { origin, direction: unit_vector(&mut rng) }
        })
        .collect()
}

/// From every hit of the camera's rays, in a random direction: the second ray of a path.
pub fn bounce_rays(hits: &[(Ray, f64)]) -> Vec<Ray> {
    let mut rng = SplitMix(0xB0);
    let bounce = |(ray, t): &(Ray, f64)| Ray {
        origin: std::array::from_fn(|k| (f64::from(ray.origin[k]) + t * f64::from(ray.direction[k])) as f32),
        direction: unit_vector(&mut rng),
    };
    hits.iter().map(bounce).collect()
}

fn unit_vector(rng: &mut SplitMix) -> [f32; 3] {
    loop {
        let d = [rng.signed(), rng.signed(), rng.signed()];
        let l2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        if l2 > 1e-4 && l2 <= 1.0 {
            let l = l2.sqrt();
            return d.map(|v| v / l);
        }
    }
}

/// Corners and triangles.
pub type Mesh = (Vec<[f32; 3]>, Vec<[u32; 3]>);

/// A ball of radius 1 around (0, 0, -3): an icosahedron, each face cut in four `cuts` times; closed.
pub fn icosphere(cuts: u32) -> Mesh {
    let (a, b) = (1.0, (1.0 + 5f64.sqrt()) / 2.0);
    let mut corners: Vec<[f64; 3]> = Vec::new();
    for (x, y) in [(-a, b), (a, b), (-a, -b), (a, -b)] {
        corners.extend([[x, y, 0.0], [0.0, x, y], [y, 0.0, x]]);
    }
    let near = |p: [f64; 3], q: [f64; 3]| (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>() < 4.1;
    let mut faces = Vec::new();
    for i in 0..12usize {
        for j in i + 1..12 {
            for k in j + 1..12 {
                let [p, q, r] = [corners[i], corners[j], corners[k]];
                if near(p, q) && near(q, r) && near(r, p) {
                    faces.push([i, j, k]);
                }
            }
        }
    }
    let mut middles = std::collections::HashMap::new();
    for _ in 0..cuts {
        let mut middle = |p: usize, q: usize| {
            *middles.entry((p.min(q), p.max(q))).or_insert_with(|| {
                corners.push(std::array::from_fn(|k| 0.5 * (norm(corners[p])[k] + norm(corners[q])[k])));
                corners.len() - 1
            })
        };
        let cut = |&[p, q, r]: &[usize; 3]| {
            let [a, b, c] = [middle(p, q), middle(q, r), middle(r, p)];
            [[p, a, c], [a, q, b], [c, b, r], [a, b, c]]
        };
        faces = faces.iter().flat_map(cut).collect();
    }
    let place = |&p: &[f64; 3]| norm(p).map(|x| x as f32);
    let corners = corners.iter().map(place).map(|[x, y, z]| [x, y, z - 3.0]).collect();
    (corners, faces.iter().map(|face| face.map(|i| i as u32)).collect())
}

/// About `n` triangles in the place of the spheres' cube:
///
/// - `globe`: a sphere of radius 1 by rings and sectors, closed.
/// - `terrain`: a square of hills seen from above, open.
/// - `soup`: triangles anywhere in the cube, as long as the mean distance.
/// - `city`: boxes on a square, without their floors.
pub fn mesh(name: &str, n: usize) -> Mesh {
    let mut rng = SplitMix(0x50FA);
    if name == "soup" {
        let long = 2.0 / (n as f32).cbrt();
        let mut corners = Vec::with_capacity(3 * n);
        for _ in 0..n {
            let at = [rng.signed(), rng.signed(), rng.signed() - 3.0];
            corners.extend([(); 3].map(|()| at.map(|x| x + 0.5 * long * rng.signed())));
        }
        return (corners, (0..n as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect());
    }
    if name == "city" {
        let side = (n as f64 / 10.0).sqrt().round().max(1.0) as u32;
        let cell = 2.0 / side as f32;
        let (mut corners, mut triangles) = (Vec::new(), Vec::new());
        for block in 0..side * side {
            let (x, y) = ((block % side) as f32 * cell - 1.0, (block / side) as f32 * cell - 1.0);
            let (wide, deep, high) =
                (cell * (0.4 + 0.5 * rng.unit()), cell * (0.4 + 0.5 * rng.unit()), 0.3 * rng.unit() * rng.unit());
            let first = corners.len() as u32;
            corners
                .extend((0..8).map(|k| {
                    [x + wide * (k & 1) as f32, y + deep * (k >> 1 & 1) as f32, high * (k >> 2) as f32 - 3.0]
                }));
            let sides = [[4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
            triangles.extend(
                sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|t| t.map(|k: u32| first + k)),
            );
        }
        return (corners, triangles);
    }
    let across = (n as f64 / 2.0).sqrt().round() as u32;
    let at = |i: u32, j: u32| {
        let (u, v) = (f64::from(i) / f64::from(across), f64::from(j) / f64::from(across));
        let p = match name {
            "globe" => {
                let (turn, tilt) = (std::f64::consts::TAU * (u % 1.0), std::f64::consts::PI * v);
                [tilt.sin() * turn.cos(), tilt.cos(), tilt.sin() * turn.sin() - 3.0]
            }
            "terrain" => {
                let hills = 0.15 * (9.0 * u).sin() * (7.0 * v).cos() + 0.02 * (61.0 * u + 5.0 * v).sin();
                [2.0 * u - 1.0, 2.0 * v - 1.0, hills - 3.0]
            }
            other => panic!("no mesh {other}"),
        };
        p.map(|x| x as f32)
    };
    let corners = (0..=across).flat_map(|j| (0..=across).map(move |i| at(i, j))).collect();
    let corner = |i: u32, j: u32| j * (across + 1) + i;
    let cell = |(i, j): (u32, u32)| {
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1)];
        [[a, b, d], [a, d, c]]
    };
    let cells = (0..across).flat_map(|j| (0..across).map(move |i| (i, j)));
    (corners, cells.flat_map(cell).collect())
}
