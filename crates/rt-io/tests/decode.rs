//! Every kind of PNG, JPEG and TIFF is either decoded sample by sample or refused by name.

use std::error::Error;
use std::fs;
use std::path::Path;

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use rt_io::ppm::{self, Encoding};
use rt_io::{DecodeError, Limits, decode_image, read_image};

const BASELINE: &[u8] = include_bytes!("images/baseline.jpg");
const PROGRESSIVE: &[u8] = include_bytes!("images/progressive.jpg");

fn decode(bytes: &[u8]) -> Result<rt_io::Decoded, DecodeError> {
    decode_image(bytes, &Limits::default())
}

/// The message with all its causes.
fn full_message(error: &dyn Error) -> String {
    match error.source() {
        Some(source) => format!("{error}: {}", full_message(source)),
        None => error.to_string(),
    }
}

fn message(bytes: &[u8]) -> String {
    full_message(&decode(bytes).expect_err("was read"))
}

fn png(width: u32, height: u32, color: ExtendedColorType, samples: &[u16]) -> Vec<u8> {
    let wide = color.bits_per_pixel() / u16::from(color.channel_count()) == 16;
    let bytes: Vec<u8> = if wide {
        samples.iter().flat_map(|sample| sample.to_ne_bytes()).collect()
    } else {
        samples.iter().map(|&sample| u8::try_from(sample).unwrap()).collect()
    };
    let mut file = Vec::new();
    PngEncoder::new(&mut file).write_image(&bytes, width, height, color).unwrap();
    file
}

#[test]
fn grey_becomes_rgb_and_alpha_is_dropped_with_a_word() {
    use ExtendedColorType::{L8, L16, La8, La16, Rgb8, Rgb16, Rgba8, Rgba16};
    let cases: [(_, &[u16], &[u16], _); 12] = [
        (L8, &[7, 255], &[7, 7, 7, 255, 255, 255], false),
        (L16, &[7, 65535], &[7, 7, 7, 65535, 65535, 65535], false),
        (La8, &[7, 255, 9, 255], &[7, 7, 7, 9, 9, 9], false),
        (La8, &[7, 255, 9, 254], &[7, 7, 7, 9, 9, 9], true),
        (La16, &[7, 65535, 9, 65535], &[7, 7, 7, 9, 9, 9], false),
        (La16, &[7, 65535, 9, 65534], &[7, 7, 7, 9, 9, 9], true),
        (Rgb8, &[1, 2, 3, 4, 5, 6], &[1, 2, 3, 4, 5, 6], false),
        (Rgb16, &[1, 2, 3, 4, 5, 65535], &[1, 2, 3, 4, 5, 65535], false),
        (Rgba8, &[1, 2, 3, 255, 4, 5, 6, 255], &[1, 2, 3, 4, 5, 6], false),
        (Rgba8, &[1, 2, 3, 0, 4, 5, 6, 255], &[1, 2, 3, 4, 5, 6], true),
        (Rgba16, &[1, 2, 3, 65535, 4, 5, 6, 65535], &[1, 2, 3, 4, 5, 6], false),
        (Rgba16, &[1, 2, 3, 65535, 4, 5, 6, 255], &[1, 2, 3, 4, 5, 6], true),
    ];
    for (color, samples, expected, transparent) in cases {
        let decoded = decode(&png(2, 1, color, samples)).unwrap();
        assert_eq!(decoded.pixmap.to_samples(), expected, "{color:?}");
        let wide = matches!(color, L16 | La16 | Rgb16 | Rgba16);
        assert_eq!(decoded.pixmap.maxval(), if wide { 65535 } else { 255 }, "{color:?}");
        assert_eq!(decoded.transparent, transparent, "{color:?} {samples:?}");
    }
}

/// A TIFF of one strip that holds `raster`, with these tags besides the strip's own; values are 16-bit numbers.
fn tiff(tags: &[(u16, &[u16])], raster: &[u8]) -> Vec<u8> {
    let mut entries: Vec<(u16, u16, Vec<u8>)> = Vec::new(); // tag, type, value
    for (tag, values) in tags {
        entries.push((*tag, 3, values.iter().flat_map(|value| value.to_le_bytes()).collect()));
    }
    let long = |value: usize| u32::try_from(value).unwrap().to_le_bytes();
    entries.push((273, 4, long(8).to_vec())); // StripOffsets
    entries.push((279, 4, long(raster.len()).to_vec())); // StripByteCounts
    entries.sort();

    let directory = (8 + raster.len()).next_multiple_of(2);
    let mut bytes = [b"II*\0", &long(directory)[..], raster].concat();
    bytes.resize(directory, 0);
    let mut beyond = directory + 2 + 12 * entries.len() + 4;
    bytes.extend(u16::try_from(entries.len()).unwrap().to_le_bytes());
    for (tag, kind, value) in &entries {
        bytes.extend(tag.to_le_bytes());
        bytes.extend(kind.to_le_bytes());
        bytes.extend(long(value.len() / if *kind == 3 { 2 } else { 4 }));
        if value.len() <= 4 {
            bytes.extend(value);
            bytes.resize(bytes.len() + 4 - value.len(), 0);
        } else {
            bytes.extend(long(beyond));
            beyond += value.len();
        }
    }
    bytes.extend([0; 4]);
    for (_, _, value) in entries.iter().filter(|(_, _, value)| value.len() > 4) {
        bytes.extend(value);
    }
    bytes
}

const WIDTH: u16 = 256;
const HEIGHT: u16 = 257;
const BITS: u16 = 258;
const PHOTOMETRIC: u16 = 262;
const ORIENTATION: u16 = 274;
const SAMPLES: u16 = 277;
const COMPRESSION: u16 = 259;
const COLOR_MAP: u16 = 320;
const EXTRA: u16 = 338;
const FORMAT: u16 = 339;

#[test]
fn a_tiff_is_turned_upright() {
    let raster = [1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5, 5, 5, 6, 6, 6];
    // 1 2 3
    // 4 5 6
    let expected: [(u16, usize, [u16; 6]); 9] = [
        (0, 3, [1, 2, 3, 4, 5, 6]), // no such orientation: as it is
        (1, 3, [1, 2, 3, 4, 5, 6]),
        (2, 3, [3, 2, 1, 6, 5, 4]),
        (3, 3, [6, 5, 4, 3, 2, 1]),
        (4, 3, [4, 5, 6, 1, 2, 3]),
        (5, 2, [1, 4, 2, 5, 3, 6]),
        (6, 2, [4, 1, 5, 2, 6, 3]),
        (7, 2, [6, 3, 5, 2, 4, 1]),
        (8, 2, [3, 6, 2, 5, 1, 4]),
    ];
    for (orientation, width, reds) in expected {
        let tags: &[(u16, &[u16])] = &[
            (WIDTH, &[3]),
            (HEIGHT, &[2]),
            (BITS, &[8, 8, 8]),
            (PHOTOMETRIC, &[2]),
            (ORIENTATION, &[orientation]),
            (SAMPLES, &[3]),
        ];
        let pixmap = decode(&tiff(tags, &raster)).unwrap().pixmap;
        assert_eq!(pixmap.width(), width, "orientation {orientation}");
        assert_eq!(pixmap.to_samples(), reds.map(|red| [red; 3]).concat(), "orientation {orientation}");

        let mut wide = tags.to_vec();
        wide[2] = (BITS, &[16, 16, 16]);
        let raster: Vec<u8> = raster.iter().flat_map(|&sample| [0, sample]).collect();
        let pixmap = decode(&tiff(&wide, &raster)).unwrap().pixmap;
        assert_eq!(pixmap.to_samples(), reds.map(|red| [red << 8; 3]).concat(), "orientation {orientation}");
    }
}

#[test]
fn kinds_of_tiff_are_read_or_refused_by_name() {
    let kind = |bits: &[u16], photometric: u16, more: &[(u16, &[u16])], raster: &[u8]| {
        let samples = [u16::try_from(bits.len()).unwrap()];
        let photometric = [photometric];
        let mut tags: Vec<(u16, &[u16])> = vec![
            (WIDTH, &[2]),
            (HEIGHT, &[1]),
            (BITS, bits),
            (PHOTOMETRIC, &photometric),
            (SAMPLES, &samples),
        ];
        tags.extend(more);
        decode(&tiff(&tags, raster))
    };
    let read = |bits: &[u16], photometric, more: &[(u16, &[u16])], raster: &[u8]| {
        let decoded = kind(bits, photometric, more, raster).unwrap();
        (decoded.pixmap.maxval(), decoded.pixmap.to_samples(), decoded.transparent)
    };
    let refused = |bits: &[u16], photometric, more: &[(u16, &[u16])], raster: &[u8]| {
        full_message(&kind(bits, photometric, more, raster).expect_err("was read"))
    };

    // Grey, black or white at 0, with alpha; one bit; 16 bits.
    assert_eq!(read(&[8], 1, &[], &[1, 200]), (255, vec![1, 1, 1, 200, 200, 200], false));
    assert_eq!(read(&[8], 0, &[], &[1, 200]), (255, vec![254, 254, 254, 55, 55, 55], false));
    assert_eq!(read(&[1], 1, &[], &[0x40]), (255, vec![0, 0, 0, 255, 255, 255], false));
    assert_eq!(read(&[1], 0, &[], &[0x40]), (255, vec![255, 255, 255, 0, 0, 0], false));
    assert_eq!(
        read(&[16], 1, &[], &[1, 2, 3, 4]),
        (65535, vec![0x201, 0x201, 0x201, 0x403, 0x403, 0x403], false)
    );
    assert_eq!(
        read(&[16], 0, &[], &[1, 0, 0, 0]),
        (65535, vec![65534, 65534, 65534, 65535, 65535, 65535], false)
    );
    // Colour: interleaved and in planes, with alpha.
    assert_eq!(read(&[8; 3], 2, &[], &[1, 2, 3, 4, 5, 6]), (255, vec![1, 2, 3, 4, 5, 6], false));
    assert_eq!(
        read(&[8; 4], 2, &[(EXTRA, &[2])], &[1, 2, 3, 255, 4, 5, 6, 255]),
        (255, vec![1, 2, 3, 4, 5, 6], false)
    );
    assert_eq!(
        read(&[8; 4], 2, &[(EXTRA, &[2])], &[1, 2, 3, 255, 4, 5, 6, 9]),
        (255, vec![1, 2, 3, 4, 5, 6], true)
    );

    // A palette, of 16-bit colours or of 8 in 16.
    let mut palette = [0; 768];
    for (channel, value) in [(0, 0x0100), (256, 0x0203), (512, 0xffff)] {
        palette[channel + 7] = value;
    }
    assert_eq!(read(&[8], 3, &[(COLOR_MAP, &palette)], &[7, 0]), (255, vec![1, 2, 255, 0, 0, 0], false));
    palette = palette.map(|value| value >> 8);
    assert_eq!(read(&[8], 3, &[(COLOR_MAP, &palette)], &[7, 0]), (255, vec![1, 2, 255, 0, 0, 0], false));

    // Not read.
    let grey = |tag, value| refused(&[8], 1, &[(tag, &[value])], &[0; 2]);
    for (message, what) in [
        (refused(&[8; 4], 5, &[], &[0; 8]), "CMYK colours"),
        (refused(&[8; 3], 6, &[], &[0; 6]), "YCbCr colours"),
        (refused(&[8; 3], 8, &[], &[0; 6]), "Lab colours"),
        (refused(&[1], 4, &[], &[0]), "a transparency mask"),
        (refused(&[8], 32803, &[], &[0; 2]), "photometric interpretation number 32803"),
        (refused(&[32; 3], 2, &[(FORMAT, &[3; 3])], &[0; 24]), "floating-point samples"),
        (grey(FORMAT, 2), "samples that are not unsigned integers"),
        (refused(&[4], 1, &[], &[0]), "4-bit grey"),
        (refused(&[32], 1, &[], &[0; 8]), "32-bit grey"),
        (refused(&[8; 2], 1, &[(EXTRA, &[2])], &[0; 4]), "grey of 2 samples"),
        (refused(&[4; 3], 2, &[], &[0; 3]), "4-bit colours"),
        (refused(&[8; 5], 2, &[], &[0; 10]), "colours of 5 samples"),
        (refused(&[4], 3, &[(COLOR_MAP, &[0; 48])], &[0]), "a palette of 4-bit indices"),
        (refused(&[8], 3, &[], &[0; 2]), "a palette of other than 256 colours"),
        (grey(COMPRESSION, 3), "fax group 3 compression"),
        (grey(COMPRESSION, 7), "JPEG compression"),
        (grey(COMPRESSION, 50000), "compression number 50000"),
    ] {
        assert_eq!(message, format!("TIFF with {what} is not read; convert it to PNG or PPM first"));
    }
}

#[test]
fn kinds_of_jpeg_that_are_not_read_are_named() {
    let frame = BASELINE.windows(2).position(|window| window == [0xff, 0xc0]).unwrap();
    let changed = |at: usize, byte: u8| {
        let mut bytes = BASELINE.to_vec();
        bytes[frame + at] = byte;
        message(&bytes)
    };
    let remedy = "is not read; convert it to PNG or PPM first";
    assert_eq!(changed(9, 4), format!("JPEG with four components (CMYK or YCCK) {remedy}"));
    assert_eq!(changed(9, 2), format!("JPEG with 2 components {remedy}"));
    assert_eq!(changed(4, 12), format!("JPEG with 12-bit samples {remedy}"));
    for process in [0xc3, 0xc5, 0xc9, 0xca, 0xcf] {
        assert_eq!(
            changed(1, process),
            format!("JPEG with lossless, hierarchical or arithmetic coding {remedy}")
        );
    }
    let mut flat = BASELINE.to_vec();
    flat[frame + 5..frame + 7].fill(0);
    assert!(message(&flat).starts_with("broken JPEG"), "{}", message(&flat));
}

#[test]
fn files_that_end_early_are_refused() {
    let whole = png(40, 30, ExtendedColorType::Rgb8, &[77; 3600]);
    let plain = include_bytes!("images/plain.tiff");
    let lzw = include_bytes!("images/lzw.tiff");
    for (name, file) in
        [("PNG", &whole[..]), ("JPEG", BASELINE), ("JPEG", PROGRESSIVE), ("TIFF", plain), ("TIFF", lzw)]
    {
        assert!(decode(file).is_ok());
        let needed = match name {
            // The last chunk says only that it is the last.
            "PNG" => file.len() - 12,
            // The directory comes last, but for values of tags that are not asked for.
            "TIFF" => {
                let directory = u32::from_le_bytes(*file[4..].first_chunk().unwrap()) as usize;
                directory + 2 + 12 * usize::from(file[directory])
            }
            _ => file.len(),
        };
        for length in 8..needed {
            let text = decode(&file[..length]).expect_err("was read").to_string();
            assert!(
                text == format!("the {name} ends early") || text == format!("broken {name}"),
                "{length}: {text}"
            );
        }
    }
}

#[test]
fn what_is_no_image_is_named() {
    assert_eq!(message(b""), "byte 0: expected P3 or P6 (PPM), P2 or P5 (PGM), found an empty file");
    assert_eq!(message(b"hello, world"), "not an image: expected PPM, PGM, PNG, JPEG or TIFF");
    assert_eq!(message(b"GIF89a......"), "GIF is not read; convert it to PNG or PPM first");
    assert_eq!(message(b"BM.........."), "BMP is not read; convert it to PNG or PPM first");
    assert_eq!(message(b"RIFF....WEBPVP8 "), "WebP is not read; convert it to PNG or PPM first");
    assert_eq!(
        message(b"P3 1 1 255 1 2"),
        "byte 14: the file ends inside the raster: expected 3 samples, found 2"
    );
    assert_eq!(message(b"P4 1 1 \x80"), "byte 0: `P4` is not read; convert it with netpbm: pamdepth 255");
}

#[test]
fn sizes_beyond_the_limit_or_the_file_are_refused() {
    let file = png(40, 30, ExtendedColorType::Rgb8, &[77; 3600]);
    let error = decode_image(&file, &Limits { max_pixels: 1199 }).unwrap_err();
    assert_eq!(error.to_string(), "40 x 30 pixels are more than the limit of 1199");
    assert!(decode_image(&file, &Limits { max_pixels: 1200 }).is_ok());
    let error = decode_image(BASELINE, &Limits { max_pixels: 19 * 13 - 1 }).unwrap_err();
    assert_eq!(error.to_string(), "19 x 13 pixels are more than the limit of 246");
    let error =
        decode_image(include_bytes!("images/lzw.tiff"), &Limits { max_pixels: 19 * 13 - 1 }).unwrap_err();
    assert_eq!(error.to_string(), "19 x 13 pixels are more than the limit of 246");

    let mut claims = file.clone();
    claims[16..24].copy_from_slice(&[0, 0, 0x3f, 0xff, 0, 0, 0x3f, 0xff]);
    let expected = format!("16383 x 16383 pixels are more than the {} bytes of a PNG can hold", file.len());
    assert_eq!(message(&claims), expected);
}

/// The densest file of each kind: one colour, as large as its file allows.
#[test]
fn the_bound_on_pixels_per_byte_refuses_no_whole_file() {
    let (width, height) = (8000, 4000);
    let flat = png(width, height, ExtendedColorType::L8, &vec![9; (width * height) as usize]);
    let pixmap = decode(&flat).unwrap().pixmap;
    assert_eq!(pixmap.pixel(7999, 3999), [9; 3]);
}

#[test]
fn a_file_is_read_by_its_content_and_errors_name_it() {
    let folder = std::env::temp_dir().join(format!("rt-io-decode-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join("misnamed.txt");
    let pixmap = decode(&png(1, 2, ExtendedColorType::Rgb8, &[1, 2, 3, 4, 5, 6])).unwrap().pixmap;
    for encoding in [Encoding::Raw, Encoding::Plain] {
        let mut bytes = Vec::new();
        ppm::write(&pixmap, encoding, &mut bytes).unwrap();
        fs::write(&path, bytes).unwrap();
        assert_eq!(read_image(&path, &Limits::default()).unwrap().pixmap, pixmap);
    }
    fs::write(&path, png(1, 2, ExtendedColorType::Rgb8, &[1, 2, 3, 4, 5, 6])).unwrap();
    assert_eq!(read_image(&path, &Limits::default()).unwrap().pixmap, pixmap);

    let message = |path: &Path, limits| full_message(&read_image(path, &limits).unwrap_err());
    fs::write(&path, "P6 2 2 255 ab").unwrap();
    assert_eq!(
        message(&path, Limits::default()),
        format!(
            "cannot read the image {}: byte 13: the file ends inside the raster: expected 12 samples, found 2",
            path.display()
        )
    );
    fs::write(&path, "").unwrap();
    assert!(message(&path, Limits::default()).ends_with("found an empty file"));
    let missing = folder.join("missing.png");
    assert_eq!(
        message(&missing, Limits::default()),
        format!(
            "cannot read the image {}: reading failed: No such file or directory (os error 2)",
            missing.display()
        )
    );
    assert_eq!(
        message(&folder, Limits::default()),
        format!("cannot read the image {}: reading failed: Is a directory (os error 21)", folder.display())
    );
    // A file that is far too long for its limit is not taken into memory.
    let long = folder.join("long.png");
    fs::write(&long, b"\x89PNG\r\n\x1a\n").unwrap();
    fs::File::options().write(true).open(&long).unwrap().set_len(40 << 20).unwrap();
    assert_eq!(
        message(&long, Limits { max_pixels: 100 }),
        format!(
            "cannot read the image {}: more than 33555232 bytes, the most for a picture within the limit of pixels",
            long.display()
        )
    );
    fs::remove_dir_all(&folder).unwrap();
}
