//! Reading and writing PPM, raw and plain, beside the `image` crate, netpbm where it is installed (a process of its
//! own, so its start and the pipes count), and the copy of as many bytes, which no reader can beat.

use std::hint::black_box;
use std::io::Write;
use std::process::{Command, Stdio};
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use image::codecs::pnm::{PnmEncoder, PnmSubtype, SampleEncoding};
use image::{ExtendedColorType, ImageEncoder, ImageFormat};
use rt_io::ppm::{self, Encoding};
use rt_io::{Limits, Pixmap};

const WIDTH: usize = 2000;
const HEIGHT: usize = 1500;

/// Values of all lengths without any order, so that no branch can be foreseen.
fn picture(maxval: u16) -> Pixmap {
    let mut random = oracle::Random::new(1);
    let samples =
        (0..3 * WIDTH * HEIGHT).map(|_| u16::try_from(random.below(usize::from(maxval) + 1)).expect("at most maxval"));
    Pixmap::new(WIDTH, HEIGHT, maxval, samples.collect()).expect("as many samples as the size says")
}

fn encode(pixmap: &Pixmap, encoding: Encoding) -> Vec<u8> {
    let mut bytes = Vec::new();
    ppm::write(pixmap, encoding, &mut bytes).expect("memory takes all");
    bytes
}

/// Has a tool of netpbm read `input` and write to nowhere; `false` if it is not installed.
fn netpbm(tool: &str, options: &[&str], input: &[u8]) -> bool {
    let mut command = Command::new(tool);
    command.args(options).stdin(Stdio::piped()).stdout(Stdio::null());
    let Ok(mut child) = command.spawn() else { return false };
    child.stdin.take().expect("piped").write_all(input).expect("the tool reads all");
    child.wait().expect("it was started").success()
}

fn read(criterion: &mut Criterion) {
    for (name, maxval, encoding) in [
        ("read_raw_8", 255, Encoding::Raw),
        ("read_raw_16", 65535, Encoding::Raw),
        ("read_plain_8", 255, Encoding::Plain),
        ("read_plain_16", 65535, Encoding::Plain),
    ] {
        let bytes = encode(&picture(maxval), encoding);
        let mut group = criterion.benchmark_group(format!("ppm_{name}"));
        group.throughput(Throughput::Bytes(bytes.len() as u64)).sample_size(10);
        group.warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(1));
        group.bench_function("rt-io", |bencher| {
            bencher.iter(|| ppm::read_bytes(black_box(&bytes), &Limits::default()).expect("a valid file"));
        });
        group.bench_function("image", |bencher| {
            bencher.iter(|| {
                image::load_from_memory_with_format(black_box(&bytes), ImageFormat::Pnm).expect("a valid file")
            });
        });
        if netpbm("pnmtopnm", &[], &bytes) {
            group.bench_function("netpbm", |bencher| {
                bencher.iter(|| netpbm("pnmtopnm", &[], black_box(&bytes)));
            });
        }
        group.bench_function("copy", |bencher| bencher.iter(|| black_box(&bytes).clone()));
    }
}

fn write(criterion: &mut Criterion) {
    for (name, maxval, encoding) in [
        ("write_raw_8", 255, Encoding::Raw),
        ("write_raw_16", 65535, Encoding::Raw),
        ("write_plain_8", 255, Encoding::Plain),
        ("write_plain_16", 65535, Encoding::Plain),
    ] {
        let pixmap = picture(maxval);
        let bytes = encode(&pixmap, encoding);
        let raw = encode(&pixmap, Encoding::Raw);
        let mut group = criterion.benchmark_group(format!("ppm_{name}"));
        group.throughput(Throughput::Bytes(bytes.len() as u64)).sample_size(10);
        group.warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(1));
        let mut out = Vec::with_capacity(bytes.len());
        group.bench_function("rt-io", |bencher| {
            bencher.iter(|| {
                out.clear();
                ppm::write(black_box(&pixmap), encoding, &mut out).expect("memory takes all");
            });
        });
        // It cannot write 16 bits.
        if maxval == 255 {
            let samples = &raw[raw.len() - 3 * WIDTH * HEIGHT..];
            let sample_encoding =
                if encoding == Encoding::Raw { SampleEncoding::Binary } else { SampleEncoding::Ascii };
            group.bench_function("image", |bencher| {
                bencher.iter(|| {
                    out.clear();
                    PnmEncoder::new(&mut out)
                        .with_subtype(PnmSubtype::Pixmap(sample_encoding))
                        .write_image(
                            black_box(samples),
                            u32::try_from(WIDTH).expect("small"),
                            u32::try_from(HEIGHT).expect("small"),
                            ExtendedColorType::Rgb8,
                        )
                        .expect("memory takes all");
                });
            });
        }
        let options: &[&str] = if encoding == Encoding::Raw { &[] } else { &["-plain"] };
        if netpbm("pnmtopnm", options, &raw) {
            group.bench_function("netpbm", |bencher| {
                bencher.iter(|| netpbm("pnmtopnm", options, black_box(&raw)));
            });
        }
        group.bench_function("copy", |bencher| {
            bencher.iter(|| {
                out.clear();
                out.extend_from_slice(black_box(&bytes));
            });
        });
    }
}

criterion_group!(benches, read, write);
criterion_main!(benches);
