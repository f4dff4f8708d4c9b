//! Embree 3 and 4 through their C interface: one scene per contestant, one thread. The libraries are opened at run time.

use std::ffi::{CString, c_char, c_int, c_uint, c_void};
use std::mem::{offset_of, size_of};
use std::ptr::{null, null_mut};
use std::sync::OnceLock;

use crate::workload::Mesh;
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
/// The same in Embree 4.
const COHERENT_4: c_int = 1 << 16;
const NO_ID: c_uint = c_uint::MAX;

#[repr(C)]
struct Context {
    flags: c_int,
    filter: *const c_void,
    inst: c_uint,
}

/// `RTCIntersectArguments` of Embree 4: flags, mask of features, and pointers that nothing here sets.
#[repr(C)]
struct Arguments {
    flags: c_int,
    features: c_uint,
    rest: [*const c_void; 4],
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
    /// Embree 4 alone writes it.
    inst_prim: [c_uint; N],
}

const _: () = assert!(offset_of!(Packet<1>, normal) == 48 && size_of::<Packet<1>>() == 128);
const _: () = assert!(offset_of!(Packet<16>, geom) == 18 * 64);

unsafe extern "C" {
    fn dlopen(file: *const c_char, flags: c_int) -> Handle;
    fn dlsym(library: Handle, name: *const c_char) -> Handle;
}

/// Declares the functions that both versions have alike, and finds them in an opened library.
macro_rules! api {
    ($($name:ident($($kind:ty),*) $(-> $answer:ty)?;)*) => {
        #[allow(non_snake_case)]
        struct Api {
            /// 3 or 4: queries take a context or, if anything, arguments.
            version: u32,
            library: Handle,
            $($name: unsafe extern "C" fn($($kind),*) $(-> $answer)?,)*
        }

        impl Api {
            unsafe fn load(version: u32, library: Handle) -> Self {
                unsafe {
                    Api { version, library, $($name: function(library, stringify!($name)),)* }
                }
            }
        }
    };
}

api! {
    rtcNewDevice(*const c_char) -> Handle;
    rtcReleaseDevice(Handle);
    rtcGetDeviceProperty(Handle, c_int) -> isize;
    rtcSetDeviceMemoryMonitorFunction(Handle, extern "C" fn(*mut c_void, isize, bool) -> bool, *mut c_void);
    rtcGetDeviceError(Handle) -> c_int;
    rtcNewScene(Handle) -> Handle;
    rtcReleaseScene(Handle);
    rtcSetSceneBuildQuality(Handle, c_int);
    rtcSetSceneFlags(Handle, c_int);
    rtcCommitScene(Handle);
    rtcNewGeometry(Handle, c_int) -> Handle;
    rtcReleaseGeometry(Handle);
    rtcSetGeometryBuildQuality(Handle, c_int);
    rtcSetSharedGeometryBuffer(Handle, c_int, c_uint, c_int, *const c_void, usize, usize, usize);
    rtcCommitGeometry(Handle);
    rtcAttachGeometry(Handle, Handle) -> c_uint;
}

/// One ray: Embree 3's third argument is the ray, Embree 4's second.
type Single3 = unsafe extern "C" fn(Handle, *mut Context, *mut Packet<1>);
type Single4 = unsafe extern "C" fn(Handle, *mut Packet<1>, *const c_void);
type Packet3<const N: usize> = unsafe extern "C" fn(*const c_int, Handle, *mut Context, *mut Packet<N>);
type Packet4<const N: usize> = unsafe extern "C" fn(*const c_int, Handle, *mut Packet<N>, *const c_void);
type Stream3 = unsafe extern "C" fn(Handle, *mut Context, *mut Packet<1>, c_uint, usize);

unsafe fn function<F>(library: Handle, name: &str) -> F {
    let name = CString::new(name).expect("no NUL in a name");
    let found = unsafe { dlsym(library, name.as_ptr()) };
    assert!(!found.is_null(), "the Embree library has no {name:?}");
    assert_eq!(size_of::<F>(), size_of::<Handle>());
    unsafe { std::mem::transmute_copy(&found) }
}

/// Opens the library of a version: the file that `EMBREE3` or `EMBREE4` names, else the system's. `None` without one.
fn api(version: u32) -> Option<&'static Api> {
    static APIS: [OnceLock<Option<Api>>; 2] = [const { OnceLock::new() }; 2];
    const NOW_AND_BY_ITSELF: c_int = 2 | 8;
    let open = || {
        let file = std::env::var(format!("EMBREE{version}")).unwrap_or(format!("libembree{version}.so.{version}"));
        let file = CString::new(file).ok()?;
        let library = unsafe { dlopen(file.as_ptr(), NOW_AND_BY_ITSELF) };
        (!library.is_null()).then(|| unsafe { Api::load(version, library) })
    };
    APIS[version as usize - 3].get_or_init(open).as_ref()
}

// Handles of a library that is never closed, and functions.
unsafe impl Send for Api {}
unsafe impl Sync for Api {}

impl Api {
    fn single(&self, name: &str) -> impl Fn(Handle, &mut Context, &mut Packet<1>) + use<> {
        let (three, four): (Option<Single3>, Option<Single4>) = unsafe {
            if self.version == 3 {
                (Some(function(self.library, name)), None)
            } else {
                (None, Some(function(self.library, name)))
            }
        };
        move |scene, context, ray| unsafe {
            match (three, four) {
                (Some(call), _) => call(scene, context, ray),
                (_, Some(call)) => call(scene, ray, null()),
                _ => unreachable!("one of the two was found"),
            }
        }
    }

    fn packet<const N: usize>(&self) -> impl Fn(&[c_int; N], Handle, &mut Context, &mut Packet<N>) + use<N> {
        let (name, version, library) = (format!("rtcIntersect{N}"), self.version, self.library);
        let found: Handle = unsafe { function(library, &name) };
        move |valid, scene, context, rays| unsafe {
            if version == 3 {
                std::mem::transmute::<Handle, Packet3<N>>(found)(valid.as_ptr(), scene, context, rays);
            } else {
                let arguments = Arguments { flags: COHERENT_4, features: NO_ID, rest: [null(); 4] };
                std::mem::transmute::<Handle, Packet4<N>>(found)(
                    valid.as_ptr(),
                    scene,
                    rays,
                    (&raw const arguments).cast(),
                );
            }
        }
    }
}

extern "C" fn count_bytes(_: *mut c_void, bytes: isize, _post: bool) -> bool {
    if bytes >= 0 {
        memory::grow(bytes as usize)
    } else {
        memory::shrink(bytes.unsigned_abs())
    }
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
    api: &'static Api,
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
    fn new(api: &'static Api, spheres: &[Sphere], v: Variant) -> Self {
        let ids = if v.sorted { morton_order(spheres) } else { Vec::new() };
        let spheres = if v.sorted { ids.iter().map(|&i| spheres[i as usize]).collect() } else { spheres.to_vec() };
        let vertices = spheres.into_iter().flatten().collect();
        Self::commit(api, vertices, Vec::new(), ids, v)
    }

    /// A scene of triangles if there are any, else of spheres.
    fn commit(api: &'static Api, vertices: Vec<f32>, triangles: Vec<[u32; 3]>, ids: Vec<u32>, v: Variant) -> Self {
        let config = CString::new(v.config).expect("no NUL in a literal");
        let kind = if triangles.is_empty() { SPHERE_POINT } else { TRIANGLE };
        unsafe {
            let device = (api.rtcNewDevice)(config.as_ptr());
            (api.rtcSetDeviceMemoryMonitorFunction)(device, count_bytes, null_mut());
            let scene = (api.rtcNewScene)(device);
            (api.rtcSetSceneBuildQuality)(scene, v.quality);
            (api.rtcSetSceneFlags)(scene, v.flags);
            let shapes = (api.rtcNewGeometry)(device, kind);
            (api.rtcSetGeometryBuildQuality)(shapes, v.quality);
            let data = vertices.as_ptr().cast();
            if triangles.is_empty() {
                (api.rtcSetSharedGeometryBuffer)(shapes, VERTEX, 0, FLOAT4, data, 0, 16, vertices.len() / 4);
            } else {
                (api.rtcSetSharedGeometryBuffer)(shapes, VERTEX, 0, FLOAT3, data, 0, 12, vertices.len() / 3);
                let corners = triangles.as_ptr().cast();
                (api.rtcSetSharedGeometryBuffer)(shapes, INDEX, 0, UINT3, corners, 0, 12, triangles.len());
            }
            (api.rtcCommitGeometry)(shapes);
            (api.rtcAttachGeometry)(scene, shapes);
            (api.rtcReleaseGeometry)(shapes);
            (api.rtcCommitScene)(scene);
            let error = (api.rtcGetDeviceError)(device);
            assert_eq!(error, 0, "Embree refused {}", v.config);
            Embree { api, _vertices: vertices, _triangles: triangles, ids, device, scene, mode: v.mode }
        }
    }

    fn packets<const N: usize>(&self, rays: &[Ray], hits: &mut [Hit], (w, h): (usize, usize)) {
        let side = rays.len().isqrt();
        assert!(side * side == rays.len() && side % w == 0 && side % h == 0 && w * h == N);
        let (call, valid, mut context) = (self.api.packet::<N>(), [-1; N], context(COHERENT));
        for y in (0..side).step_by(h) {
            for x in (0..side).step_by(w) {
                let pixel: [usize; N] = std::array::from_fn(|k| (y + k / w) * side + x + k % w);
                let mut p = packet(pixel.map(|i| &rays[i]));
                call(&valid, self.scene, &mut context, &mut p);
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
            (self.api.rtcReleaseScene)(self.scene);
            (self.api.rtcReleaseDevice)(self.device);
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
        inst_prim: [NO_ID; N],
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
                let (call, mut context) = (self.api.single("rtcIntersect1"), context(0));
                for (ray, hit) in rays.iter().zip(hits) {
                    let mut p = packet([ray]);
                    call(self.scene, &mut context, &mut p);
                    *hit = p.hit(0);
                    if let Some(&id) = self.ids.get(hit.id as usize) {
                        hit.id = id;
                    }
                }
            }
            Mode::Packet8(w, h) => self.packets::<8>(rays, hits, (w, h)),
            Mode::Packet16(w, h) => self.packets::<16>(rays, hits, (w, h)),
            Mode::Stream(m) => {
                let call: Stream3 = unsafe { function(self.api.library, "rtcIntersect1M") };
                let mut context = context(COHERENT);
                let mut buffer = Vec::with_capacity(m);
                for (rays, hits) in rays.chunks(m).zip(hits.chunks_mut(m)) {
                    buffer.clear();
                    buffer.extend(rays.iter().map(|r| packet([r])));
                    let (count, stride) = (buffer.len() as c_uint, size_of::<Packet<1>>());
                    let first = buffer.as_mut_ptr();
                    unsafe { call(self.scene, &mut context, first, count, stride) };
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
        let (call, mut context) = (self.api.single("rtcOccluded1"), context(0));
        let blocked = |ray: &&Ray| {
            let mut p = packet([*ray]);
            // The ray's part alone is read and written.
            call(self.scene, &mut context, &mut p);
            p.far[0] < 0.0
        };
        Some(rays.iter().filter(blocked).count())
    }
}

/// A mesh, by Embree 3 or 4, with its robust flag or without; `None` without the library.
pub fn mesh(version: u32, mesh: &Mesh, robust: bool, tiles: bool) -> Option<Box<dyn Tracer>> {
    let (corners, triangles) = mesh;
    let flags = if robust { ROBUST } else { 0 };
    let mode = if tiles { Mode::Packet16(4, 4) } else { Mode::Single };
    let variant = Variant { config: "threads=1", quality: HIGH, flags, mode, sorted: false };
    // Embree reads 16 bytes of the last corner.
    let vertices = corners.iter().flatten().copied().chain([0.0]).collect::<Vec<f32>>();
    Some(Box::new(Embree::commit(api(version)?, vertices, triangles.to_vec(), Vec::new(), variant)))
}

/// How often a ray meets a mesh by Embree 4 with its robust flag: it is asked again from the float after each hit.
pub fn every_hit(mesh: &Mesh) -> Option<impl Fn(&Ray) -> u32> {
    let (corners, triangles) = mesh;
    let variant = Variant { config: "threads=1", quality: MEDIUM, flags: ROBUST, mode: Mode::Single, sorted: false };
    let vertices = corners.iter().flatten().copied().chain([0.0]).collect::<Vec<f32>>();
    let scene = Embree::commit(api(4)?, vertices, triangles.to_vec(), Vec::new(), variant);
    let call = scene.api.single("rtcIntersect1");
    Some(move |ray: &Ray| {
        // The whole of it, so that it lives as long as the closure.
        let scene = &scene;
        let mut context = context(0);
        let (mut near, mut count) = ([0.0], 0);
        loop {
            let mut p = Packet { near, ..packet([ray]) };
            call(scene.scene, &mut context, &mut p);
            if p.geom[0] == NO_ID {
                return count;
            }
            count += 1;
            near = [p.far[0].next_up()];
        }
    })
}

/// Version and what each library says it can do here.
pub fn describe() -> String {
    let describe = |version| {
        let Some(api) = api(version) else { return format!("no Embree {version}") };
        unsafe {
            let device = (api.rtcNewDevice)(c"threads=1".as_ptr());
            let version = (api.rtcGetDeviceProperty)(device, 0);
            let packets = [32, 33, 34].map(|p| (api.rtcGetDeviceProperty)(device, p));
            (api.rtcReleaseDevice)(device);
            format!("Embree {version}, native packets of 4/8/16: {packets:?}")
        }
    };
    [3, 4].map(describe).join("; ")
}

pub fn contestants() -> Vec<Contestant> {
    const ONE: &str = "threads=1";
    let row = |version, name, config, quality, flags, mode, sorted| {
        let variant = Variant { config, quality, flags, mode, sorted };
        let api = api(version)?;
        Some(Contestant {
            name,
            camera_only: matches!(mode, Mode::Packet8(..) | Mode::Packet16(..)),
            slow: false,
            build: Box::new(move |spheres| Box::new(Embree::new(api, spheres, variant))),
        })
    };
    let v = |version, name, quality, flags, mode| row(version, name, ONE, quality, flags, mode, false);
    // Sphere points go through Embree's hair builder, which ignores the quality; both are listed to show it.
    let all = [
        row(3, "embree presorted", ONE, HIGH, 0, Mode::Single, true),
        v(3, "embree high", HIGH, 0, Mode::Single),
        v(3, "embree medium", MEDIUM, 0, Mode::Single),
        v(3, "embree high robust", HIGH, ROBUST, Mode::Single),
        v(3, "embree high compact", HIGH, COMPACT, Mode::Single),
        v(3, "embree packet8 8x1", HIGH, 0, Mode::Packet8(8, 1)),
        v(3, "embree packet8 4x2", HIGH, 0, Mode::Packet8(4, 2)),
        v(3, "embree packet16 16x1", HIGH, 0, Mode::Packet16(16, 1)),
        v(3, "embree packet16 4x4", HIGH, 0, Mode::Packet16(4, 4)),
        v(3, "embree stream 256", HIGH, 0, Mode::Stream(256)),
        v(3, "embree stream 1024", HIGH, 0, Mode::Stream(1024)),
        v(4, "embree4", HIGH, 0, Mode::Single),
        v(4, "embree4 packet8 4x2", HIGH, 0, Mode::Packet8(4, 2)),
        v(4, "embree4 packet16 4x4", HIGH, 0, Mode::Packet16(4, 4)),
    ];
    all.into_iter().flatten().collect()
}
