//! A small file never makes a reader take more than 64 MiB, whatever it promises, and a whole one takes what it holds.
#![cfg(feature = "decode")]
#![expect(clippy::cast_possible_truncation, reason = "the sizes of these pictures are small")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::io;
use std::sync::atomic::{AtomicUsize, Ordering};

use ::png::{BitDepth, ColorType, Encoder};
use oracle::images::{Tag, black_jpeg, crc32, tiff};
use rt_io::ppm::{self, Encoding};
use rt_io::{Limits, Pixmap, decode_image, png};

/// The system's allocator, which also keeps the largest number of bytes that were in use at once.
struct Counting;

static USED: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

#[expect(unsafe_code, reason = "an allocator that counts is the only way to see every allocation")]
// SAFETY: every call goes to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        grow(layout.size());
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        grow(layout.size());
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // As if the block moved, so that both are there at once.
        grow(size);
        USED.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's promise is passed on.
        unsafe { System.realloc(block, layout, size) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        USED.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's promise is passed on.
        unsafe { System.dealloc(block, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn grow(size: usize) {
    PEAK.fetch_max(USED.fetch_add(size, Ordering::Relaxed) + size, Ordering::Relaxed);
}

/// What `work` gives, and the most bytes that it held at once.
fn peak_of<T>(work: impl FnOnce() -> T) -> (T, usize) {
    let before = USED.load(Ordering::Relaxed);
    PEAK.store(before, Ordering::Relaxed);
    let result = work();
    (result, PEAK.load(Ordering::Relaxed) - before)
}

const MOST: usize = 64 << 20;

/// A PNG of one pixel whose header claims another size, bit depth and colour type.
fn png_that_claims(width: u32, height: u32, depth: u8, color: u8, padding: usize) -> Vec<u8> {
    let mut bytes = Vec::new();
    png::write(&Pixmap::new(1, 1, 255, vec![1, 2, 3]).unwrap(), &mut bytes).unwrap();
    bytes[16..20].copy_from_slice(&width.to_be_bytes());
    bytes[20..24].copy_from_slice(&height.to_be_bytes());
    bytes[24] = depth;
    bytes[25] = color;
    let crc = crc32(&bytes[12..29]);
    bytes[29..33].copy_from_slice(&crc.to_be_bytes());
    bytes.resize(bytes.len() + padding, 0);
    bytes
}

fn jpeg_that_claims(width: u16, height: u16, progressive: bool, padding: usize) -> Vec<u8> {
    let file: &[u8] =
        if progressive { include_bytes!("images/progressive.jpg") } else { include_bytes!("images/baseline.jpg") };
    let mut bytes = file.to_vec();
    let marker = [0xff, if progressive { 0xc2 } else { 0xc0 }];
    let frame = bytes.windows(2).position(|window| window == marker).unwrap();
    bytes[frame + 5..frame + 7].copy_from_slice(&height.to_be_bytes());
    bytes[frame + 7..frame + 9].copy_from_slice(&width.to_be_bytes());
    bytes.resize(bytes.len() + padding, 0);
    bytes
}

fn tiff_that_claims(width: u16, height: u16, padding: usize) -> Vec<u8> {
    let mut bytes = include_bytes!("images/plain.tiff").to_vec();
    let directory = u32::from_le_bytes(*bytes[4..].first_chunk().unwrap()) as usize;
    let entries = usize::from(u16::from_le_bytes(*bytes[directory..].first_chunk().unwrap()));
    for entry in bytes[directory + 2..].as_chunks_mut::<12>().0.iter_mut().take(entries) {
        let value = match u16::from_le_bytes([entry[0], entry[1]]) {
            256 => width,
            257 => height,
            _ => continue,
        };
        assert_eq!(entry[2], 3, "a short number");
        entry[8..10].copy_from_slice(&value.to_le_bytes());
    }
    bytes.resize(bytes.len() + padding, 0);
    bytes
}

/// The one test of this file: a second one would share the counter.
#[test]
fn readers_take_memory_in_proportion_to_the_bytes() {
    let limits = Limits::default();
    let boundless = Limits { max_pixels: u64::MAX };

    // Sizes up to the default limit and beyond, from memory and from a pipe, with and without a limit.
    let headers = [
        "P6\n16384 16384\n255\n",
        "P6\n16384 16384\n65535\n",
        "P3\n16384 16384\n255\n",
        "P3\n16384 16384\n65535\n",
        "P5\n16384 16384\n255\n",
        "P5\n16384 16384\n65535\n",
        "P2\n16384 16384\n255\n",
        "P2\n16384 16384\n65535\n",
        "P6\n268435456 1\n255\n",
        "P6\n1 268435456\n65535\n",
        "P6\n4294967295 1\n255\n",
        "P6\n99999 99999\n255\n",
        "P6\n4294967295 4294967295\n65535\n",
        "P3\n4294967295 4294967295\n65535\n",
    ];
    for header in headers {
        for body in ["", "1", "1 2 3 4 5 6 7 8 9 "] {
            for limits in [limits, boundless] {
                let bytes = [header, body].concat();
                let (result, peak) = peak_of(|| ppm::read_bytes(bytes.as_bytes(), &limits));
                assert!(result.is_err() && peak < 1 << 20, "{bytes:?}: {peak} bytes");
                let (result, peak) = peak_of(|| ppm::read(bytes.as_bytes(), &limits));
                assert!(result.is_err() && peak < MOST, "{bytes:?} from a pipe: {peak} bytes");
            }
        }
    }

    // A raw raster that is long, and known to be too short, is not even begun.
    for header in ["P6\n16384 16384\n255\n", "P6\n16384 16384\n65535\n"] {
        let bytes = [header.as_bytes(), &vec![1; 8 << 20]].concat();
        let (result, peak) = peak_of(|| ppm::read_bytes(&bytes, &limits));
        assert!(result.is_err() && peak < 1 << 20, "{header:?}: {peak} bytes");
    }

    let mut hostile = vec![];
    for (width, height) in
        [(16384, 16384), (16000, 16000), (1 << 28, 1), (u32::MAX, u32::MAX), (900, 900), (3000, 2000)]
    {
        for (depth, color) in [(16, 6), (8, 2), (1, 0), (8, 3)] {
            hostile.push(png_that_claims(width, height, depth, color, 0));
            hostile.push(png_that_claims(width, height, depth, color, 700));
        }
    }
    for (width, height) in [(65535, 65535), (16384, 16384), (1, 65535), (65535, 1), (700, 700)] {
        for padding in [0, 10_000] {
            hostile.push(jpeg_that_claims(width, height, false, padding));
            hostile.push(jpeg_that_claims(width, height, true, padding));
            hostile.push(tiff_that_claims(width, height, padding));
        }
    }
    for bytes in hostile {
        for limits in [limits, boundless] {
            let (result, peak) = peak_of(|| decode_image(&bytes, &limits));
            // A JPEG decoder fills up what its file does not hold; that is no error if the sizes are possible.
            let claim = result.map(|decoded| (decoded.pixmap.width(), decoded.pixmap.height()));
            assert!(peak < MOST, "{claim:?} of {} bytes: {peak}", bytes.len());
        }
    }

    // A whole picture: its samples, one byte each up to maxval 255, and at most 64 MiB; a known length gives the exact
    // size.
    for (maxval, bytes_per_sample) in [(255, 1), (65535, 2)] {
        let pixmap = Pixmap::new(3000, 2000, maxval, vec![maxval; 18_000_000]).unwrap();
        for encoding in [Encoding::Raw, Encoding::Plain] {
            let mut bytes = Vec::new();
            ppm::write(&pixmap, encoding, &mut bytes).unwrap();
            let ((), peak) = peak_of(|| ppm::write(&pixmap, encoding, &mut io::sink()).unwrap());
            assert!(peak < 1 << 20, "{encoding:?} {maxval} written: {peak} bytes");
            let samples = 18_000_000 * bytes_per_sample;
            let (result, peak) = peak_of(|| ppm::read_bytes(&bytes, &limits));
            assert_eq!(result.unwrap(), pixmap);
            assert!(peak < samples + (1 << 20), "{encoding:?} {maxval}: {peak} bytes");
            let (result, peak) = peak_of(|| ppm::read(&bytes[..], &limits));
            assert_eq!(result.unwrap(), pixmap);
            assert!(peak < samples + MOST, "{encoding:?} {maxval} from a pipe: {peak} bytes");
        }
    }

    whole_pictures_take_what_the_limits_say();
}

const COLUMNS: usize = 3000;
const ROWS: usize = 2000;
const PIXELS: usize = COLUMNS * ROWS;

/// More than tables and rows take.
const LITTLE: usize = 1 << 20;

/// A PNG of zeros, not interlaced.
fn black_png(color: ColorType, depth: BitDepth) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, COLUMNS as u32, ROWS as u32);
    encoder.set_color(color);
    encoder.set_depth(depth);
    let bits = color.samples() * depth as usize;
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&vec![0; (COLUMNS * bits).div_ceil(8) * ROWS]).unwrap();
    drop(writer);
    bytes
}

/// Bytes a pixel, of the picture and while it is decoded, as the docs of `Limits` have them.
fn whole_pictures_take_what_the_limits_say() {
    let limits = Limits::default();
    let check = |name: &str, bytes: &[u8], most: usize, kept: usize| {
        let before = USED.load(Ordering::Relaxed);
        let (decoded, peak) = peak_of(|| decode_image(bytes, &limits));
        let pixmap = decoded.unwrap_or_else(|error| panic!("{name}: {error:?}")).pixmap;
        assert_eq!((pixmap.width(), pixmap.height()), (COLUMNS, ROWS), "{name}");
        let held = USED.load(Ordering::Relaxed) - before;
        assert_eq!(held, kept, "{name}: bytes of the picture");
        assert!(peak < most + LITTLE, "{name}: {peak} bytes");

        // To PPM, as `convert` has it, in pieces; to PNG, in memory, but no more than the samples once more.
        let ((), peak) = peak_of(|| ppm::write(&pixmap, Encoding::Raw, &mut io::sink()).unwrap());
        assert!(peak < LITTLE, "{name} to PPM: {peak} bytes");
        // The way to a texture takes nothing.
        let (stored, peak) = peak_of(|| pixmap.into_stored());
        assert!(peak < LITTLE, "{name} as it is stored: {peak} bytes");
        drop(stored);
    };

    use BitDepth::{Eight, One, Sixteen};
    for (color, depth, kept) in [
        (ColorType::Grayscale, One, 1),
        (ColorType::Grayscale, Eight, 1),
        (ColorType::Grayscale, Sixteen, 2),
        (ColorType::GrayscaleAlpha, Eight, 1),
        (ColorType::Rgb, Eight, 3),
        (ColorType::Rgba, Eight, 3),
        (ColorType::Rgba, Sixteen, 6),
    ] {
        let bytes = black_png(color, depth);
        check(&format!("PNG {color:?} {depth:?}"), &bytes, kept * PIXELS, kept * PIXELS);
    }

    for (progressive, grey) in [(false, false), (false, true), (true, false), (true, true)] {
        let bytes = black_jpeg([COLUMNS as u16, ROWS as u16], progressive, grey);
        let kept = if grey { PIXELS } else { 3 * PIXELS };
        // Two bytes a coefficient; its sizes are multiples of a block.
        let most = if progressive { 3 * kept } else { kept };
        check(&format!("JPEG, progressive: {progressive}, grey: {grey}"), &bytes, most, kept);
    }

    // One bit, in one strip that packs to next to nothing.
    let row_bytes = COLUMNS.div_ceil(8);
    let packed: Vec<u8> = (0..row_bytes * ROWS / 125).flat_map(|_| [130, 0]).collect();
    let tags: [Tag<'_>; 5] =
        [(256, &[COLUMNS as u16]), (257, &[ROWS as u16]), (258, &[1]), (259, &[32773]), (262, &[1])];
    check("TIFF of one bit", &tiff(&tags, &packed), PIXELS + row_bytes * ROWS, PIXELS);
}
