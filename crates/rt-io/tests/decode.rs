//! Every kind of PNG, JPEG and TIFF is either decoded sample by sample or refused by name.
#![cfg(feature = "decode")]

use std::fs;
use std::path::Path;

use oracle::files::{folder, full_message};
use oracle::images::{Tag, crc32, tiff, tiff_in_chunks};
use png::{BitDepth, ColorType, Encoder};
use rt_io::ppm::{self, Encoding};
use rt_io::{DecodeError, Limits, decode_image, read_image};

const BASELINE: &[u8] = include_bytes!("images/baseline.jpg");
const PROGRESSIVE: &[u8] = include_bytes!("images/progressive.jpg");

fn decode(bytes: &[u8]) -> Result<rt_io::Decoded, DecodeError> {
    decode_image(bytes, &Limits::default())
}

fn message(bytes: &[u8]) -> String {
    full_message(&decode(bytes).expect_err("was read"))
}

fn png(width: u32, height: u32, color: ColorType, depth: BitDepth, samples: &[u16]) -> Vec<u8> {
    let bytes: Vec<u8> = match depth {
        BitDepth::Sixteen => samples.iter().flat_map(|sample| sample.to_be_bytes()).collect(),
        _ => samples.iter().map(|&sample| u8::try_from(sample).unwrap()).collect(),
    };
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.write_header().unwrap().write_image_data(&bytes).unwrap();
    file
}

fn rgb_png(width: u32, height: u32, samples: &[u16]) -> Vec<u8> {
    png(width, height, ColorType::Rgb, BitDepth::Eight, samples)
}

#[test]
fn grey_becomes_rgb_and_alpha_is_dropped_with_a_word() {
    use BitDepth::{Eight, Sixteen};
    use ColorType::{Grayscale, GrayscaleAlpha, Rgb, Rgba};
    let cases: [(_, _, &[u16], &[u16], _); 12] = [
        (Grayscale, Eight, &[7, 255], &[7, 7, 7, 255, 255, 255], false),
        (Grayscale, Sixteen, &[7, 65535], &[7, 7, 7, 65535, 65535, 65535], false),
        (GrayscaleAlpha, Eight, &[7, 255, 9, 255], &[7, 7, 7, 9, 9, 9], false),
        (GrayscaleAlpha, Eight, &[7, 255, 9, 254], &[7, 7, 7, 9, 9, 9], true),
        (GrayscaleAlpha, Sixteen, &[7, 65535, 9, 65535], &[7, 7, 7, 9, 9, 9], false),
        (GrayscaleAlpha, Sixteen, &[7, 65535, 9, 65534], &[7, 7, 7, 9, 9, 9], true),
        (Rgb, Eight, &[1, 2, 3, 4, 5, 6], &[1, 2, 3, 4, 5, 6], false),
        (Rgb, Sixteen, &[1, 2, 3, 4, 5, 65535], &[1, 2, 3, 4, 5, 65535], false),
        (Rgba, Eight, &[1, 2, 3, 255, 4, 5, 6, 255], &[1, 2, 3, 4, 5, 6], false),
        (Rgba, Eight, &[1, 2, 3, 0, 4, 5, 6, 255], &[1, 2, 3, 4, 5, 6], true),
        (Rgba, Sixteen, &[1, 2, 3, 65535, 4, 5, 6, 65535], &[1, 2, 3, 4, 5, 6], false),
        (Rgba, Sixteen, &[1, 2, 3, 65535, 4, 5, 6, 255], &[1, 2, 3, 4, 5, 6], true),
    ];
    for (color, depth, samples, expected, transparent) in cases {
        let decoded = decode(&png(2, 1, color, depth, samples)).unwrap();
        assert_eq!(decoded.pixmap.to_samples(), expected, "{color:?} {depth:?}");
        assert_eq!(decoded.pixmap.maxval(), if depth == Sixteen { 65535 } else { 255 }, "{color:?}");
        assert_eq!(decoded.transparent, transparent, "{color:?} {samples:?}");
    }
}

const WIDTH: u16 = 256;
const HEIGHT: u16 = 257;
const BITS: u16 = 258;
const PHOTOMETRIC: u16 = 262;
const ORIENTATION: u16 = 274;
const FILL_ORDER: u16 = 266;
const SAMPLES: u16 = 277;
const PLANAR: u16 = 284;
const PREDICTOR: u16 = 317;
const TILE_WIDTH: u16 = 322;
const TILE_LENGTH: u16 = 323;
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
        let tags: &[Tag<'_>] = &[
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
    let kind = |bits: &[u16], photometric: u16, more: &[Tag<'_>], raster: &[u8]| {
        let samples = [u16::try_from(bits.len()).unwrap()];
        let photometric = [photometric];
        let mut tags: Vec<Tag<'_>> =
            vec![(WIDTH, &[2]), (HEIGHT, &[1]), (BITS, bits), (PHOTOMETRIC, &photometric), (SAMPLES, &samples)];
        tags.extend(more);
        decode(&tiff(&tags, raster))
    };
    let read = |bits: &[u16], photometric, more: &[Tag<'_>], raster: &[u8]| {
        let decoded = kind(bits, photometric, more, raster).unwrap();
        (decoded.pixmap.maxval(), decoded.pixmap.to_samples(), decoded.transparent)
    };
    let refused = |bits: &[u16], photometric, more: &[Tag<'_>], raster: &[u8]| {
        full_message(&kind(bits, photometric, more, raster).expect_err("was read"))
    };

    // Grey, black or white at 0, with alpha; one bit; 16 bits.
    assert_eq!(read(&[8], 1, &[], &[1, 200]), (255, vec![1, 1, 1, 200, 200, 200], false));
    assert_eq!(read(&[8], 0, &[], &[1, 200]), (255, vec![254, 254, 254, 55, 55, 55], false));
    assert_eq!(read(&[1], 1, &[], &[0x40]), (255, vec![0, 0, 0, 255, 255, 255], false));
    assert_eq!(read(&[1], 0, &[], &[0x40]), (255, vec![255, 255, 255, 0, 0, 0], false));
    assert_eq!(read(&[16], 1, &[], &[1, 2, 3, 4]), (65535, vec![0x201, 0x201, 0x201, 0x403, 0x403, 0x403], false));
    assert_eq!(read(&[16], 0, &[], &[1, 0, 0, 0]), (65535, vec![65534, 65534, 65534, 65535, 65535, 65535], false));
    // Two and four bits; grey with alpha, and with another sample.
    assert_eq!(read(&[2], 1, &[], &[0x60]), (255, vec![85, 85, 85, 170, 170, 170], false));
    assert_eq!(read(&[4], 0, &[], &[0x0e]), (255, vec![255, 255, 255, 17, 17, 17], false));
    assert_eq!(read(&[8; 2], 1, &[(EXTRA, &[2])], &[1, 255, 2, 254]), (255, vec![1, 1, 1, 2, 2, 2], true));
    assert_eq!(read(&[8; 2], 0, &[(EXTRA, &[0])], &[1, 255, 2, 254]), (255, vec![254, 254, 254, 253, 253, 253], false));
    // Colour: interleaved and in planes, with alpha.
    assert_eq!(read(&[8; 3], 2, &[], &[1, 2, 3, 4, 5, 6]), (255, vec![1, 2, 3, 4, 5, 6], false));
    assert_eq!(read(&[8; 4], 2, &[(EXTRA, &[2])], &[1, 2, 3, 255, 4, 5, 6, 255]), (255, vec![1, 2, 3, 4, 5, 6], false));
    assert_eq!(read(&[8; 4], 2, &[(EXTRA, &[2])], &[1, 2, 3, 255, 4, 5, 6, 9]), (255, vec![1, 2, 3, 4, 5, 6], true));
    assert_eq!(read(&[8; 4], 2, &[(EXTRA, &[0])], &[1, 2, 3, 255, 4, 5, 6, 9]), (255, vec![1, 2, 3, 4, 5, 6], false));

    // A palette, of 16-bit colours or of 8 in 16.
    let mut palette = [0; 768];
    for (channel, value) in [(0, 0x0100), (256, 0x0203), (512, 0xffff)] {
        palette[channel + 7] = value;
    }
    assert_eq!(read(&[8], 3, &[(COLOR_MAP, &palette)], &[7, 0]), (255, vec![1, 2, 255, 0, 0, 0], false));
    palette = palette.map(|value| value >> 8);
    assert_eq!(read(&[8], 3, &[(COLOR_MAP, &palette)], &[7, 0]), (255, vec![1, 2, 255, 0, 0, 0], false));
    let few: Vec<u16> = (0..12).map(|value| value << 8).collect();
    assert_eq!(read(&[2], 3, &[(COLOR_MAP, &few)], &[0xc0]), (255, vec![3, 7, 11, 0, 4, 8], false));

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
        (refused(&[3], 1, &[], &[0]), "3-bit grey"),
        (refused(&[32], 1, &[], &[0; 8]), "32-bit grey"),
        (refused(&[8; 3], 1, &[(EXTRA, &[2, 0])], &[0; 6]), "grey of 3 samples"),
        (refused(&[4; 3], 2, &[], &[0; 3]), "4-bit colours"),
        (refused(&[8; 5], 2, &[], &[0; 10]), "colours of 5 samples"),
        (refused(&[16], 3, &[(COLOR_MAP, &[0; 48])], &[0; 4]), "a palette of 16-bit indices"),
        (refused(&[4], 3, &[(COLOR_MAP, &[0; 768])], &[0]), "a palette of other than 16 colours"),
        (refused(&[8], 3, &[], &[0; 2]), "a palette of other than 256 colours"),
        (grey(FILL_ORDER, 2), "its bits in reverse (FillOrder 2)"),
        (refused(&[4], 1, &[(PREDICTOR, &[2])], &[0]), "a predictor of 4-bit samples"),
        (grey(COMPRESSION, 3), "fax group 3 compression"),
        (grey(COMPRESSION, 7), "JPEG compression"),
        (grey(COMPRESSION, 50000), "compression number 50000"),
    ] {
        assert_eq!(message, format!("TIFF with {what} is not read; convert it to PNG or PPM first"));
    }
}

/// Every way to cut a picture up, each with the byte order and depth that matter to it.
#[test]
fn a_tiff_in_strips_tiles_and_planes_is_read_alike() {
    let (width, height) = (37_u16, 21_u16);
    let value = |x: u16, y: u16, channel: u16| (x * 7 + y * 5 + channel * 81) % 256;
    let place = |index: u16| (index % width, index / width);
    let expected: Vec<u16> = (0..width * height)
        .flat_map(|index| [0, 1, 2].map(|channel| value(place(index).0, place(index).1, channel)))
        .collect();
    for (planar, tile) in [(1, None), (2, None), (1, Some((16, 16))), (2, Some((16, 16))), (2, Some((48, 32)))] {
        let (across, down) = tile.unwrap_or((width, 8));
        let planes: &[&[u16]] = if planar == 2 { &[&[0], &[1], &[2]] } else { &[&[0, 1, 2]] };
        let mut chunks = Vec::new();
        for channels in planes {
            for top in (0..height).step_by(down.into()) {
                for left in (0..width).step_by(across.into()) {
                    // The last strip has fewer rows, the last tiles are filled up.
                    let rows = if tile.is_some() { down } else { down.min(height - top) };
                    let pixels = (0..rows).flat_map(|y| (0..across).map(move |x| (left + x, top + y)));
                    let samples = pixels.flat_map(|(x, y)| channels.iter().map(move |&channel| value(x, y, channel)));
                    chunks.push(samples.map(|sample| u8::try_from(sample).unwrap()).collect::<Vec<u8>>());
                }
            }
        }
        let mut tags: Vec<Tag<'_>> = vec![
            (WIDTH, std::slice::from_ref(&width)),
            (HEIGHT, std::slice::from_ref(&height)),
            (BITS, &[8; 3]),
            (PHOTOMETRIC, &[2]),
            (SAMPLES, &[3]),
        ];
        let planar = [planar];
        tags.push((PLANAR, &planar));
        let (across, down) = ([across], [down]);
        let slices: Vec<&[u8]> = chunks.iter().map(Vec::as_slice).collect();
        let file = if tile.is_some() {
            tags.extend([(TILE_WIDTH, &across[..]), (TILE_LENGTH, &down[..])]);
            tiff_in_chunks(&tags, &slices, [324, 325])
        } else {
            tags.push((278, &down)); // RowsPerStrip
            tiff_in_chunks(&tags, &slices, [273, 279])
        };
        let decoded = decode(&file).unwrap_or_else(|error| panic!("{planar:?} {tile:?}: {}", full_message(&error)));
        assert_eq!(decoded.pixmap.to_samples(), expected, "{planar:?} {tile:?}");
    }
}

/// Tiles that `tiffcp` wrote with LZW, whose last column is narrower: the decoder alone finds no end in them.
#[test]
fn a_tiff_in_narrow_lzw_tiles_is_read() {
    let tiles = decode(include_bytes!("images/lzw-tiles.tiff")).unwrap().pixmap;
    assert_eq!((tiles.width(), tiles.height()), (21, 18));
    for y in 0..18 {
        for x in 0..21 {
            let grey = u16::try_from((x * 37 + y * 91) % 256).unwrap();
            assert_eq!(tiles.pixel(x, y), [grey; 3], "{x} {y}");
        }
    }
}

#[test]
fn a_png_with_a_piece_of_a_colour_in_its_palette_is_refused() {
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, 2, 1);
    encoder.set_color(ColorType::Indexed);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_palette(vec![1, 2, 3, 4]);
    encoder.write_header().unwrap().write_image_data(&[0, 1]).unwrap();
    let expected = "broken PNG: a palette of 4 bytes, which are no whole colours";
    assert!(message(&file).contains(expected), "{}", message(&file));
}

#[test]
fn a_png_whose_checksum_is_wrong_is_refused() {
    let mut file = rgb_png(2, 1, &[1, 2, 3, 4, 5, 6]);
    let data = file.windows(4).position(|window| window == b"IDAT").unwrap() + 4;
    let length = u32::from_be_bytes(*file[data - 8..].first_chunk().unwrap()) as usize;
    // The sum of the samples, in the last bytes of the data; the sum of the chunk is right.
    file[data + length - 1] ^= 1;
    let sum = crc32(&file[data - 4..data + length]);
    file[data + length..data + length + 4].copy_from_slice(&sum.to_be_bytes());
    let text = message(&file);
    assert!(text.starts_with("broken PNG: ") && text.contains("Checksum"), "{text}");
    file[data + length - 1] ^= 1;
    let text = message(&file);
    assert!(text.starts_with("broken PNG: CRC error"), "{text}");
}

/// Files of `cjpeg -sample` with what `djpeg` makes of them: rows alone halved; red, green and blue.
#[test]
fn a_jpeg_of_odd_sampling_is_near_to_djpeg() {
    let cases: [(&str, &[u8], &[u8], u16); 2] = [
        ("12-11-11", include_bytes!("images/12-11-11.jpg"), include_bytes!("images/12-11-11.ppm"), 2),
        ("rgb", include_bytes!("images/rgb.jpg"), include_bytes!("images/rgb.ppm"), 1),
    ];
    for (name, file, expected, most) in cases {
        let expected = ppm::read_bytes(expected, &Limits::default()).unwrap();
        let found = decode(file).unwrap().pixmap;
        assert_eq!((found.width(), found.height()), (expected.width(), expected.height()), "{name}");
        let pairs = found.to_samples().into_iter().zip(expected.to_samples());
        let apart = pairs.map(|(ours, theirs)| ours.abs_diff(theirs)).max();
        assert!(apart <= Some(most), "{name}: {apart:?}");
    }
}

/// Luma sampled less than a chroma, which the decoder gets wrong, and a quarter of the columns.
#[test]
fn a_jpeg_of_other_sampling_is_refused_by_name() {
    let cases: [(&str, &[u8]); 2] = [
        ("1x1,2x2,1x1", include_bytes!("images/11-22-11.jpg")),
        ("4x1,1x1,2x1", include_bytes!("images/41-11-21.jpg")),
    ];
    for (sampling, file) in cases {
        let expected = format!("JPEG with sampling {sampling} is not read; convert it to PNG or PPM first");
        assert_eq!(message(file), expected);
    }
}

/// A file cut anywhere in its data and closed again says so: nothing is filled up.
#[test]
fn a_jpeg_cut_short_but_closed_is_refused() {
    for file in [BASELINE, PROGRESSIVE, include_bytes!("images/12-11-11.jpg")] {
        let scan = file.windows(2).position(|window| window == [0xff, 0xda]).unwrap();
        for length in scan..file.len() - 3 {
            let cut = [&file[..length], &[0xff, 0xd9]].concat();
            let Err(error) = decode(&cut) else { panic!("{length} of {}: was read", file.len()) };
            let text = full_message(&error);
            assert!(text == "the JPEG ends early" || text.starts_with("broken JPEG: "), "{length}: {text}");
        }
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
    for (process, name) in [
        (0xc3, "lossless coding"),
        (0xc5, "hierarchical coding"),
        (0xc9, "arithmetic coding"),
        (0xca, "arithmetic coding"),
        (0xcb, "lossless arithmetic coding"),
        (0xcf, "hierarchical coding"),
    ] {
        assert_eq!(changed(1, process), format!("JPEG with {name} {remedy}"));
    }
    // Sampling that is no whole ratio, or none at all.
    assert_eq!(changed(14, 0x31), format!("JPEG with sampling 2x2,3x1,1x1 {remedy}"));
    assert_eq!(changed(14, 0x01), format!("JPEG with sampling 2x2,0x1,1x1 {remedy}"));
    assert_eq!(changed(14, 0x15), format!("JPEG with sampling 2x2,1x5,1x1 {remedy}"));
    let mut flat = BASELINE.to_vec();
    flat[frame + 5..frame + 7].fill(0);
    assert_eq!(message(&flat), format!("JPEG with its height behind the picture {remedy}"));
    flat[frame + 5..frame + 9].copy_from_slice(&[0, 1, 0, 0]);
    assert_eq!(message(&flat), "broken JPEG: a width of 0");

    // Luma and chroma under the letters of red, green and blue; a scan of one component among three.
    let scan = BASELINE.windows(2).position(|window| window == [0xff, 0xda]).unwrap();
    let mut named = BASELINE.to_vec();
    for (index, letter) in b"RGB".iter().enumerate() {
        named[frame + 10 + 3 * index] = *letter;
        named[scan + 5 + 2 * index] = *letter;
    }
    let what = "luma and chroma in components named R, G and B";
    assert_eq!(message(&named), format!("JPEG with {what} {remedy}"));
    let one = [0xff, 0xda, 0, 8, 1, BASELINE[scan + 5], 0, 0, 63, 0];
    let apart = [&BASELINE[..scan], &one, &BASELINE[scan + 14..]].concat();
    assert_eq!(message(&apart), format!("JPEG with its components in several scans {remedy}"));
}

#[test]
fn files_that_end_early_are_refused() {
    let whole = rgb_png(40, 30, &[77; 3600]);
    let plain = include_bytes!("images/plain.tiff");
    let lzw = include_bytes!("images/lzw.tiff");
    for (name, file) in [("PNG", &whole[..]), ("JPEG", BASELINE), ("JPEG", PROGRESSIVE), ("TIFF", plain), ("TIFF", lzw)]
    {
        assert!(decode(file).is_ok());
        let needed = match name {
            // The directory comes last, but for values of tags that are not asked for.
            "TIFF" => {
                let directory = u32::from_le_bytes(*file[4..].first_chunk().unwrap()) as usize;
                directory + 2 + 12 * usize::from(file[directory])
            }
            _ => file.len(),
        };
        for length in 8..needed {
            let text = decode(&file[..length]).expect_err("was read").to_string();
            assert!(text == format!("the {name} ends early") || text == format!("broken {name}"), "{length}: {text}");
        }
    }
}

#[test]
fn what_is_no_image_is_named() {
    assert_eq!(message(b""), "byte 0: expected P3 or P6 (PPM), P2 or P5 (PGM), found an empty file");
    assert_eq!(message(b"hello, world"), "not an image: expected PPM, PGM, PNG, JPEG or TIFF");
    for big in [b"II+\0........", b"MM\0+........"] {
        let remedy = "is not read; convert it to PNG or PPM first";
        assert_eq!(message(big), format!("TIFF with 64-bit offsets (BigTIFF) {remedy}"));
    }
    assert_eq!(message(b"GIF89a......"), "GIF is not read; convert it to PNG or PPM first");
    assert_eq!(message(b"BM.........."), "BMP is not read; convert it to PNG or PPM first");
    assert_eq!(message(b"RIFF....WEBPVP8 "), "WebP is not read; convert it to PNG or PPM first");
    assert_eq!(message(b"P3 1 1 255 1 2"), "byte 14: the file ends inside the raster: expected 3 samples, found 2");
    assert_eq!(message(b"P4 1 1 \x80"), "byte 0: `P4` is not read; convert it with netpbm: pamdepth 255");
}

#[test]
fn sizes_beyond_the_limit_or_the_file_are_refused() {
    let file = rgb_png(40, 30, &[77; 3600]);
    let error = decode_image(&file, &Limits { max_pixels: 1199 }).unwrap_err();
    assert_eq!(error.to_string(), "40 x 30 pixels are more than the limit of 1199");
    assert!(decode_image(&file, &Limits { max_pixels: 1200 }).is_ok());
    let error = decode_image(BASELINE, &Limits { max_pixels: 19 * 13 - 1 }).unwrap_err();
    assert_eq!(error.to_string(), "19 x 13 pixels are more than the limit of 246");
    let error = decode_image(include_bytes!("images/lzw.tiff"), &Limits { max_pixels: 19 * 13 - 1 }).unwrap_err();
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
    let flat = png(width, height, ColorType::Grayscale, BitDepth::Eight, &vec![9; (width * height) as usize]);
    let pixmap = decode(&flat).unwrap().pixmap;
    assert_eq!(pixmap.pixel(7999, 3999), [9; 3]);
}

#[test]
fn a_file_is_read_by_its_content_and_errors_name_it() {
    let folder = folder();
    let folder = folder.path();
    let path = folder.join("misnamed.txt");
    let pixmap = decode(&rgb_png(1, 2, &[1, 2, 3, 4, 5, 6])).unwrap().pixmap;
    for encoding in [Encoding::Raw, Encoding::Plain] {
        let mut bytes = Vec::new();
        ppm::write(&pixmap, encoding, &mut bytes).unwrap();
        fs::write(&path, bytes).unwrap();
        assert_eq!(read_image(&path, &Limits::default()).unwrap().pixmap, pixmap);
    }
    fs::write(&path, rgb_png(1, 2, &[1, 2, 3, 4, 5, 6])).unwrap();
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
        format!("cannot read the image {}: reading failed: No such file or directory (os error 2)", missing.display())
    );
    assert_eq!(
        message(folder, Limits::default()),
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
}
