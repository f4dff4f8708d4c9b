//! The f64 referee: a plain median-split box tree with padded boxes, and sphere roots in f64.

use crate::{Ray, Sphere};

struct Node {
    lo: [f64; 3],
    hi: [f64; 3],
    /// Leaf: `first..first + count` in `order`. Inner (`count == 0`): children `first`, `first + 1`.
    first: usize,
    count: usize,
}

pub struct Reference<'a> {
    spheres: &'a [Sphere],
    order: Vec<u32>,
    nodes: Vec<Node>,
}

/// `(t, id)` of the closest hit.
pub type Answer = Option<(f64, u32)>;

impl<'a> Reference<'a> {
    pub fn new(spheres: &'a [Sphere]) -> Self {
        let mut r = Self { spheres, order: (0..spheres.len() as u32).collect(), nodes: Vec::new() };
        if !spheres.is_empty() {
            let root = r.bound(0, spheres.len());
            r.nodes.push(root);
            r.split(0);
        }
        r
    }

    fn bound(&self, first: usize, count: usize) -> Node {
        let (mut lo, mut hi) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for &i in &self.order[first..first + count] {
            let s = self.spheres[i as usize].map(f64::from);
            for k in 0..3 {
                lo[k] = lo[k].min(s[k] - s[3] * (1.0 + 1e-9) - 1e-12);
                hi[k] = hi[k].max(s[k] + s[3] * (1.0 + 1e-9) + 1e-12);
            }
        }
        Node { lo, hi, first, count }
    }

    fn split(&mut self, at: usize) {
        let Node { first, count, .. } = self.nodes[at];
        if count <= 4 {
            return;
        }
        let spheres = self.spheres;
        let part = &mut self.order[first..first + count];
        let spread = |k: usize| {
            let (lo, hi) = part.iter().fold((f32::MAX, f32::MIN), |(lo, hi), &i| {
                let v = spheres[i as usize][k];
                (lo.min(v), hi.max(v))
            });
            hi - lo
        };
        let axis = (0..3).max_by(|&a, &b| spread(a).total_cmp(&spread(b))).unwrap_or(0);
        let mid = count / 2;
        part.select_nth_unstable_by(mid, |&a, &b| spheres[a as usize][axis].total_cmp(&spheres[b as usize][axis]));
        let child = self.nodes.len();
        let (left, right) = (self.bound(first, mid), self.bound(first + mid, count - mid));
        self.nodes.extend([left, right]);
        self.nodes[at].first = child;
        self.nodes[at].count = 0;
        self.split(child);
        self.split(child + 1);
    }

    pub fn closest(&self, ray: &Ray) -> Answer {
        let (o, d) = (ray.origin.map(f64::from), ray.direction.map(f64::from));
        let mut best: Answer = None;
        let mut stack = vec![0usize];
        while let Some(at) = stack.pop() {
            let Some(n) = self.nodes.get(at) else { continue };
            let tmax = best.map_or(f64::INFINITY, |b| b.0);
            let Some(_) = enters(n, o, d, tmax) else { continue };
            if n.count > 0 {
                for &i in &self.order[n.first..n.first + n.count] {
                    best = nearer(best, sphere(&self.spheres[i as usize], o, d), i);
                }
            } else {
                let t = |c: usize| enters(&self.nodes[c], o, d, tmax).unwrap_or(f64::INFINITY);
                let (a, b) = (n.first, n.first + 1);
                stack.extend(if t(a) < t(b) { [b, a] } else { [a, b] });
            }
        }
        best
    }

    pub fn brute_force(&self, ray: &Ray) -> Answer {
        let (o, d) = (ray.origin.map(f64::from), ray.direction.map(f64::from));
        (0..self.spheres.len()).fold(None, |best, i| nearer(best, sphere(&self.spheres[i], o, d), i as u32))
    }
}

fn nearer(best: Answer, t: Option<f64>, id: u32) -> Answer {
    match (best, t) {
        (Some((b, other)), Some(t)) if t < b || (t == b && id < other) => Some((t, id)),
        (None, Some(t)) => Some((t, id)),
        _ => best,
    }
}

fn enters(n: &Node, o: [f64; 3], d: [f64; 3], tmax: f64) -> Option<f64> {
    let (mut near, mut far) = (0.0f64, tmax);
    for k in 0..3 {
        if d[k] == 0.0 {
            if o[k] < n.lo[k] || o[k] > n.hi[k] {
                return None;
            }
            continue;
        }
        let (a, b) = ((n.lo[k] - o[k]) / d[k], (n.hi[k] - o[k]) / d[k]);
        near = near.max(a.min(b));
        far = far.min(a.max(b));
    }
    (near <= far * (1.0 + 1e-12) + 1e-15).then_some(near)
}

/// Smallest non-negative root on one sphere.
pub fn sphere(s: &Sphere, o: [f64; 3], d: [f64; 3]) -> Option<f64> {
    let c: [f64; 3] = std::array::from_fn(|k| f64::from(s[k]) - o[k]);
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let dd = dot(d, d);
    let mid = dot(c, d) / dd;
    let p: [f64; 3] = std::array::from_fn(|k| c[k] - mid * d[k]);
    let gap = f64::from(s[3]).powi(2) - dot(p, p);
    if gap < 0.0 {
        return None;
    }
    let half = (gap / dd).sqrt();
    [mid - half, mid + half].into_iter().find(|&t| t >= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tree_agrees_with_brute_force() {
        for scene in crate::workload::SCENES {
            let spheres = crate::workload::spheres(scene, 700);
            let reference = Reference::new(&spheres);
            for ray in crate::workload::random_rays(500).iter().chain(&crate::workload::camera_rays(24)) {
                assert_eq!(reference.closest(ray), reference.brute_force(ray), "{scene} {ray:?}");
            }
        }
    }
}
