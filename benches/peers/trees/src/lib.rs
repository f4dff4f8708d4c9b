//! One small trait for every ray caster measured here, and the numerics that they share.

pub mod contestants;
pub mod memory;
pub mod reference;

pub mod workload;

pub use workload::{Ray, Sphere};

/// The answer to a closest-hit query: the smallest `t >= 0` with `origin + t * direction` on a
/// sphere (entering or leaving), `t` in units of the given, possibly unnormalised, direction.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    pub t: f32,
    /// Index into the input spheres; `u32::MAX` for a miss.
    pub id: u32,
}

impl Hit {
    pub const MISS: Hit = Hit { t: f32::INFINITY, id: u32::MAX };
    pub fn is_hit(&self) -> bool {
        self.id != u32::MAX
    }
}

/// A built scene that answers rays, one thread. Calls are by batch so that the harness pays one
/// virtual call per ray set; unless it says so in its name, a contestant takes rays one by one.
pub trait Tracer {
    /// Writes the closest hit of each ray.
    fn closest(&self, rays: &[Ray], hits: &mut [Hit]);
    /// How many rays meet anything at all; `None` where the contestant has no any-hit query.
    fn occluded(&self, rays: &[Ray]) -> Option<usize>;
}

pub struct Contestant {
    pub name: &'static str,
    /// Contestants that only make sense for coherent rays (packets) skip the random set.
    pub camera_only: bool,
    /// Timed on every `THIN`-th ray only.
    pub slow: bool,
    pub build: Box<dyn Fn(&[Sphere]) -> Box<dyn Tracer>>,
}

/// Near root if it is in `[0, tmax]`, else far root, else infinity; f32 throughout. The distance
/// from centre to ray is taken after projection, which is the cancellation-safe form.
#[inline(always)]
pub fn sphere_f32(s: &Sphere, o: [f32; 3], d: [f32; 3], inv_dd: f32, tmax: f32) -> f32 {
    let c = [s[0] - o[0], s[1] - o[1], s[2] - o[2]];
    let mid = (c[0] * d[0] + c[1] * d[1] + c[2] * d[2]) * inv_dd;
    let p = [c[0] - mid * d[0], c[1] - mid * d[1], c[2] - mid * d[2]];
    let gap = s[3] * s[3] - (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    if gap < 0.0 {
        return f32::INFINITY;
    }
    let half = (gap * inv_dd).sqrt();
    let t = if mid >= half { mid - half } else { mid + half };
    if t >= 0.0 && t <= tmax { t } else { f32::INFINITY }
}

pub fn inv_dd(d: [f32; 3]) -> f32 {
    (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).recip()
}

/// CPU time of this process, all threads, in seconds.
pub fn cpu_seconds() -> f64 {
    #[repr(C)]
    struct Timespec {
        seconds: i64,
        nanos: i64,
    }
    unsafe extern "C" {
        fn clock_gettime(clock: i32, out: *mut Timespec) -> i32;
    }
    const CLOCK_PROCESS_CPUTIME_ID: i32 = 2;
    let mut now = Timespec { seconds: 0, nanos: 0 };
    let status = unsafe { clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &mut now) };
    assert_eq!(status, 0, "no CPU clock");
    now.seconds as f64 + now.nanos as f64 * 1e-9
}
