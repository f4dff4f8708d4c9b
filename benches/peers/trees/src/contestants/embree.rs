//! Embree 3.13 through its C interface: sphere points, one scene per contestant, one thread.

use std::ffi::{CString, c_char, c_int, c_uint, c_void};
use std::mem::{offset_of, size_of};
use std::ptr::null_mut;

use crate::{Contestant, Hit, Ray, Sphere, Tracer, memory};

type Handle = *mut c_void;

const SPHERE_POINT: c_int = 50;
const TRIANGLE: c_int = 0;
const INDEX: c_int = 0;
const VERTEX: c_int = 1;
const FLOAT3: c_int = 0x9003;
const UINT3: c_int = 0x5003;
const FLOAT4: c_int = 0x9004;
const MEDIUM: c_int = 1;
const HIGH: c_int = 2;
const COMPACT: c_int = 2;
const ROBUST: c_int = 4;
const COHERENT: c_int = 1;
const NO_ID: c_uint = c_uint::MAX;

#[repr(C)]
struct Context {
    flags: c_int,
    filter: *const c_void,
    inst: c_uint,
}

/// `RTCRayHit` (N = 1) and `RTCRayHit8/16`: the same fields, each an array of N.
#[repr(C, align(64))]
#[derive(Clone, Copy)]
struct Packet<const N: usize> {
    org: [[f32; N]; 3],
    near: [f32; N],
    dir: [[f32; N]; 3],
    time: [f32; N],
    far: [f32; N],
    mask: [c_uint; N],
    id: [c_uint; N],
    flags: [c_uint; N],
    normal: [[f32; N]; 3],
    uv: [[f32; N]; 2],
    prim: [c_uint; N],
    geom: [c_uint; N],
    inst: [c_uint; N],
}

const _: () = assert!(offset_of!(Packet<1>, normal) == 48 && size_of::<Packet<1>>() == 128);
const _: () = assert!(offset_of!(Packet<16>, geom) == 18 * 64);

unsafe extern "C" {
    fn rtcNewDevice(config: *const c_char) -> Handle;
    fn rtcReleaseDevice(device: Handle);
    fn rtcGetDeviceProperty(device: Handle, property: c_int) -> isize;
    fn rtcSetDeviceMemoryMonitorFunction(
        device: Handle,
        f: extern "C" fn(*mut c_void, isize, bool) -> bool,
        user: *mut c_void,
    );
    fn rtcGetDeviceError(device: Handle) -> c_int;
    fn rtcNewScene(device: Handle) -> Handle;
    fn rtcReleaseScene(scene: Handle);
    fn rtcSetSceneBuildQuality(scene: Handle, quality: c_int);
    fn rtcSetSceneFlags(scene: Handle, flags: c_int);
    fn rtcCommitScene(scene: Handle);
    fn rtcNewGeometry(device: Handle, kind: c_int) -> Handle;
    fn rtcReleaseGeometry(geometry: Handle);
    fn rtcSetGeometryBuildQuality(geometry: Handle, quality: c_int);
    fn rtcSetSharedGeometryBuffer(
        geometry: Handle,
        kind: c_int,
        slot: c_uint,
        format: c_int,
        data: *const c_void,
        offset: usize,
        stride: usize,
        count: usize,
    );
    fn rtcCommitGeometry(geometry: Handle);
    fn rtcAttachGeometry(scene: Handle, geometry: Handle) -> c_uint;
    fn rtcIntersect1(scene: Handle, context: *mut Context, ray: *mut Packet<1>);
    fn rtcIntersect8(v: *const c_int, scene: Handle, context: *mut Context, ray: *mut Packet<8>);
    fn rtcIntersect16(v: *const c_int, scene: Handle, context: *mut Context, ray: *mut Packet<16>);
    fn rtcIntersect1M(scene: Handle, c: *mut Context, ray: *mut Packet<1>, m: c_uint, stride: usize);
    fn rtcOccluded1(scene: Handle, context: *mut Context, ray: *mut Packet<1>);
}

extern "C" fn count_bytes(_: *mut c_void, bytes: isize, _post: bool) -> bool {
    if bytes >= 0 { memory::grow(bytes as usize) } else { memory::shrink(bytes.unsigned_abs()) }
    true
}

/// How rays are handed over.
#[derive(Clone, Copy, PartialEq)]
enum Mode {
    Single,
    /// Screen tiles of the given width and height (the ray set is a square image in scan order).
    Packet8(usize, usize),
    Packet16(usize, usize),
    /// `rtcIntersect1M`, this many rays a call.
    Stream(usize),
}

#[derive(Clone, Copy)]
struct Variant {
    config: &'static str,
    quality: c_int,
    flags: c_int,
    mode: Mode,
    /// Hand the spheres over in Morton order: leaves gather them by index from this buffer.
    sorted: bool,
}

struct Embree {
    /// Spheres or corners, shared with Embree.
    _vertices: Vec<f32>,
    _triangles: Vec<[u32; 3]>,
    /// From Embree's indices to the input's; empty where they are the same.
    ids: Vec<u32>,
    device: Handle,
    scene: Handle,
    mode: Mode,
}

impl Embree {
    fn new(spheres: &[Sphere], v: Variant) -> Self {
        let ids = if v.sorted { morton_order(spheres) } else { Vec::new() };
        let spheres = if v.sorted {
            ids.iter().map(|&i| spheres[i as usize]).collect()
        } else {
            spheres.to_vec()
        };
        let vertices = spheres.into_iter().flatten().collect();
        Self::commit(vertices, Vec::new(), ids, v)
    }

    /// A scene of triangles if there are any, else of spheres.
    fn commit(vertices: Vec<f32>, triangles: Vec<[u32; 3]>, ids: Vec<u32>, v: Variant) -> Self {
        let config = CString::new(v.config).expect("no NUL in a literal");
        let kind = if triangles.is_empty() { SPHERE_POINT } else { TRIANGLE };
        unsafe {
            let device = rtcNewDevice(config.as_ptr());
            rtcSetDeviceMemoryMonitorFunction(device, count_bytes, null_mut());
            let scene = rtcNewScene(device);
            rtcSetSceneBuildQuality(scene, v.quality);
            rtcSetSceneFlags(scene, v.flags);
            let shapes = rtcNewGeometry(device, kind);
            rtcSetGeometryBuildQuality(shapes, v.quality);
            let data = vertices.as_ptr().cast();
            if triangles.is_empty() {
                rtcSetSharedGeometryBuffer(shapes, VERTEX, 0, FLOAT4, data, 0, 16, vertices.len() / 4);
            } else {
                rtcSetSharedGeometryBuffer(shapes, VERTEX, 0, FLOAT3, data, 0, 12, vertices.len() / 3);
                let corners = triangles.as_ptr().cast();
                rtcSetSharedGeometryBuffer(shapes, INDEX, 0, UINT3, corners, 0, 12, triangles.len());
            }
            rtcCommitGeometry(shapes);
            rtcAttachGeometry(scene, shapes);
            rtcReleaseGeometry(shapes);
            rtcCommitScene(scene);
            let error = rtcGetDeviceError(device);
            assert_eq!(error, 0, "Embree refused {}", v.config);
            Embree { _vertices: vertices, _triangles: triangles, ids, device, scene, mode: v.mode }
        }
    }

    fn packets<const N: usize>(
        &self,
        rays: &[Ray],
        hits: &mut [Hit],
        (w, h): (usize, usize),
        call: unsafe extern "C" fn(*const c_int, Handle, *mut Context, *mut Packet<N>),
    ) {
        let side = rays.len().isqrt();
        assert!(side * side == rays.len() && side % w == 0 && side % h == 0 && w * h == N);
        let (valid, mut context) = ([-1; N], context(COHERENT));
        for y in (0..side).step_by(h) {
            for x in (0..side).step_by(w) {
                let pixel: [usize; N] = std::array::from_fn(|k| (y + k / w) * side + x + k % w);
                let mut p = packet(pixel.map(|i| &rays[i]));
                unsafe { call(valid.as_ptr(), self.scene, &mut context, &mut p) };
                for k in 0..N {
                    hits[pixel[k]] = p.hit(k);
                }
            }
        }
    }
}

fn morton_order(spheres: &[Sphere]) -> Vec<u32> {
    let (mut lo, mut hi) = (f32::MAX, f32::MIN);
    for v in spheres.iter().flat_map(|s| &s[..3]) {
        (lo, hi) = (lo.min(*v), hi.max(*v));
    }
    let spread = |v: f32| {
        let q = ((v - lo) / (hi - lo) * 1023.0) as u32;
        (0..10).fold(0u32, |out, bit| out | ((q >> bit & 1) << (3 * bit)))
    };
    let key = |&i: &u32| {
        let [x, y, z, _] = spheres[i as usize];
        spread(x) << 2 | spread(y) << 1 | spread(z)
    };
    let mut ids: Vec<u32> = (0..spheres.len() as u32).collect();
    ids.sort_by_cached_key(key);
    ids
}

impl Drop for Embree {
    fn drop(&mut self) {
        unsafe {
            rtcReleaseScene(self.scene);
            rtcReleaseDevice(self.device);
        }
    }
}

fn context(flags: c_int) -> Context {
    Context { flags, filter: null_mut(), inst: NO_ID }
}

#[inline(always)]
fn packet<const N: usize>(r: [&Ray; N]) -> Packet<N> {
    Packet {
        org: std::array::from_fn(|a| r.map(|r| r.origin[a])),
        near: [0.0; N],
        dir: std::array::from_fn(|a| r.map(|r| r.direction[a])),
        time: [0.0; N],
        far: [f32::INFINITY; N],
        mask: [NO_ID; N],
        id: [0; N],
        flags: [0; N],
        normal: [[0.0; N]; 3],
        uv: [[0.0; N]; 2],
        prim: [NO_ID; N],
        geom: [NO_ID; N],
        inst: [NO_ID; N],
    }
}

impl<const N: usize> Packet<N> {
    #[inline(always)]
    fn hit(&self, k: usize) -> Hit {
        if self.geom[k] == NO_ID { Hit::MISS } else { Hit { t: self.far[k], id: self.prim[k] } }
    }
}

impl Tracer for Embree {
    fn closest(&self, rays: &[Ray], hits: &mut [Hit]) {
        match self.mode {
            Mode::Single => {
                let mut context = context(0);
                for (ray, hit) in rays.iter().zip(hits) {
                    let mut p = packet([ray]);
                    unsafe { rtcIntersect1(self.scene, &mut context, &mut p) };
                    *hit = p.hit(0);
                    if let Some(&id) = self.ids.get(hit.id as usize) {
                        hit.id = id;
                    }
                }
            }
            Mode::Packet8(w, h) => self.packets(rays, hits, (w, h), rtcIntersect8),
            Mode::Packet16(w, h) => self.packets(rays, hits, (w, h), rtcIntersect16),
            Mode::Stream(m) => {
                let mut context = context(COHERENT);
                let mut buffer = Vec::with_capacity(m);
                for (rays, hits) in rays.chunks(m).zip(hits.chunks_mut(m)) {
                    buffer.clear();
                    buffer.extend(rays.iter().map(|r| packet([r])));
                    let (count, stride) = (buffer.len() as c_uint, size_of::<Packet<1>>());
                    let first = buffer.as_mut_ptr();
                    unsafe { rtcIntersect1M(self.scene, &mut context, first, count, stride) };
                    for (p, hit) in buffer.iter().zip(hits) {
                        *hit = p.hit(0);
                    }
                }
            }
        }
    }

    fn occluded(&self, rays: &[Ray]) -> Option<usize> {
        if self.mode != Mode::Single {
            return None;
        }
        let mut context = context(0);
        let blocked = |ray: &&Ray| {
            let mut p = packet([*ray]);
            unsafe { rtcOccluded1(self.scene, &mut context, &mut p) };
            p.far[0] < 0.0
        };
        Some(rays.iter().filter(blocked).count())
    }
}

/// A mesh, `rtcIntersect1`, with Embree's robust flag or without.
pub fn mesh(corners: &[[f32; 3]], triangles: &[[u32; 3]], robust: bool) -> Box<dyn Tracer> {
    let flags = if robust { ROBUST } else { 0 };
    let variant = Variant { config: "threads=1", quality: MEDIUM, flags, mode: Mode::Single, sorted: false };
    // Embree reads 16 bytes of the last corner.
    let vertices = corners.iter().flatten().copied().chain([0.0]).collect::<Vec<f32>>();
    Box::new(Embree::commit(vertices, triangles.to_vec(), Vec::new(), variant))
}

/// Version and what the library says it can do here.
pub fn describe() -> String {
    unsafe {
        let device = rtcNewDevice(c"threads=1".as_ptr());
        let version = rtcGetDeviceProperty(device, 0);
        let packets = [32, 33, 34].map(|p| rtcGetDeviceProperty(device, p));
        rtcReleaseDevice(device);
        format!("Embree {version}, native packets of 4/8/16: {packets:?}")
    }
}

pub fn contestants() -> Vec<Contestant> {
    const ONE: &str = "threads=1";
    // Sphere points go through Embree's hair builder, which ignores the quality; both are listed
    // to show it.
    let row = |name, config, quality, flags, mode, sorted| {
        let variant = Variant { config, quality, flags, mode, sorted };
        Contestant {
            name,
            camera_only: matches!(mode, Mode::Packet8(..) | Mode::Packet16(..)),
            slow: false,
            build: Box::new(move |spheres| Box::new(Embree::new(spheres, variant))),
        }
    };
    let v = |name, config, quality, flags, mode| row(name, config, quality, flags, mode, false);
    vec![
        row("embree presorted", ONE, HIGH, 0, Mode::Single, true),
        v("embree high", ONE, HIGH, 0, Mode::Single),
        v("embree medium", ONE, MEDIUM, 0, Mode::Single),
        v("embree high robust", ONE, HIGH, ROBUST, Mode::Single),
        v("embree high compact", ONE, HIGH, COMPACT, Mode::Single),
        v("embree packet8 8x1", ONE, HIGH, 0, Mode::Packet8(8, 1)),
        v("embree packet8 4x2", ONE, HIGH, 0, Mode::Packet8(4, 2)),
        v("embree packet16 16x1", ONE, HIGH, 0, Mode::Packet16(16, 1)),
        v("embree packet16 4x4", ONE, HIGH, 0, Mode::Packet16(4, 4)),
        v("embree stream 256", ONE, HIGH, 0, Mode::Stream(256)),
        v("embree stream 1024", ONE, HIGH, 0, Mode::Stream(1024)),
    ]
}
