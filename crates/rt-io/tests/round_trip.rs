//! What is written is read back, whatever the encoding, depth and way in; no bytes at all make a reader panic.
#![cfg(feature = "decode")]

mod pictures;

use pictures::{encode, pixmaps};
use proptest::prelude::*;
use rt_io::ppm::{self, Encoding};
use rt_io::{Limits, Pixmap, decode_image, png};

fn encodings() -> impl Strategy<Value = Encoding> {
    prop_oneof![Just(Encoding::Raw), Just(Encoding::Plain)]
}

/// The rules of a plain PPM in the most obvious way: without comments, by splitting at white space. `None` if the text
/// is not a P3 of at most 10^4 samples that this can judge.
fn obvious_plain(text: &str) -> Option<Pixmap> {
    let mut words = text.strip_prefix("P3")?.split_ascii_whitespace().map(|word| word.parse::<u16>().ok());
    let (width, height, maxval) = (words.next()??, words.next()??, words.next()??);
    let count = 3 * usize::from(width) * usize::from(height);
    let samples = (0..count.min(10_000)).map(|_| words.next()?).collect::<Option<Vec<_>>>()?;
    Pixmap::new(width.into(), height.into(), maxval, samples).ok()
}

/// A change of a file's bytes.
#[derive(Clone, Debug)]
enum Mutation {
    Overwrite(prop::sample::Index, u8),
    Insert(prop::sample::Index, Vec<u8>),
    Remove(prop::sample::Index, usize),
    Truncate(prop::sample::Index),
}

fn mutations() -> impl Strategy<Value = Vec<Mutation>> {
    let place = any::<prop::sample::Index>;
    // What tends to break parsers.
    let piece = prop_oneof![
        prop::sample::select("#,\n, ,-1,0,99999999999,65536,P6,1.5,\r\n,\u{b},#x\n".split(',').collect::<Vec<_>>())
            .prop_map(|text| text.as_bytes().to_vec()),
        prop::collection::vec(any::<u8>(), 0..9),
    ];
    let mutation = prop_oneof![
        (place(), any::<u8>()).prop_map(|(at, byte)| Mutation::Overwrite(at, byte)),
        (place(), piece).prop_map(|(at, bytes)| Mutation::Insert(at, bytes)),
        (place(), 1..20_usize).prop_map(|(at, count)| Mutation::Remove(at, count)),
        place().prop_map(Mutation::Truncate),
    ];
    prop::collection::vec(mutation, 1..4)
}

fn mutate(mut bytes: Vec<u8>, mutations: &[Mutation]) -> Vec<u8> {
    for mutation in mutations {
        let end = bytes.len();
        match mutation {
            Mutation::Overwrite(at, byte) if end > 0 => bytes[at.index(end)] = *byte,
            Mutation::Insert(at, piece) => {
                let at = at.index(end + 1);
                bytes.splice(at..at, piece.iter().copied());
            }
            Mutation::Remove(at, count) if end > 0 => {
                let at = at.index(end);
                bytes.drain(at..(at + count).min(end));
            }
            Mutation::Truncate(at) => bytes.truncate(at.index(end + 1)),
            _ => {}
        }
    }
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn written_pictures_are_read_back(pixmap in pixmaps(30, 8), encoding in encodings()) {
        let bytes = encode(&pixmap, encoding);
        prop_assert_eq!(&ppm::read_bytes(&bytes, &Limits::default()).unwrap(), &pixmap);
        prop_assert_eq!(&ppm::read(&bytes[..], &Limits::default()).unwrap(), &pixmap);
        let decoded = decode_image(&bytes, &Limits::default()).unwrap();
        prop_assert_eq!(&decoded.pixmap, &pixmap);
        prop_assert!(!decoded.transparent);
    }

    #[test]
    fn every_shorter_file_is_an_error(pixmap in pixmaps(30, 8), encoding in encodings(), at in any::<prop::sample::Index>()) {
        let bytes = encode(&pixmap, encoding);
        // Up to the place of the last number; a raw file needs every byte.
        let needed = match encoding {
            Encoding::Raw => bytes.len(),
            Encoding::Plain => bytes.trim_ascii_end().iter().rposition(|byte| *byte == b' ').unwrap() + 1,
        };
        let cut = &bytes[..at.index(needed)];
        prop_assert!(ppm::read_bytes(cut, &Limits::default()).is_err());
        prop_assert!(ppm::read(cut, &Limits::default()).is_err());
    }

    #[test]
    fn the_fast_plain_reader_agrees_with_the_obvious_one(
        size in (1..5_usize, 1..5_usize),
        maxval in prop_oneof![Just(1), Just(255), Just(65535), 1..=65535_u16],
        words in prop::collection::vec((prop_oneof![0..300_u32, 0..66_000_u32], 0..9_usize, "[ \t\r\n\u{b}\u{c}]{1,3}"), 0..60),
    ) {
        let mut text = format!("P3 {} {} {maxval}\n", size.0, size.1);
        for (value, zeros, space) in words {
            text.push_str(&"0".repeat(if zeros > 6 { zeros } else { 0 }));
            text.push_str(&format!("{value}{space}"));
        }
        // `split_ascii_whitespace` does not know the vertical tab.
        let obvious = obvious_plain(&text.replace('\u{b}', " "));
        let found = ppm::read_bytes(text.as_bytes(), &Limits::default());
        prop_assert_eq!(found.as_ref().ok(), obvious.as_ref(), "{:?}", text);
        // In windows cut at any byte.
        let mut rest = text.as_bytes();
        let dripping = std::iter::from_fn(|| {
            let (first, others) = rest.split_at(rest.len().min(3));
            rest = others;
            (!first.is_empty()).then_some(first)
        });
        let found = ppm::read(Pieces(dripping), &Limits::default());
        prop_assert_eq!(found.ok(), obvious);
    }

    #[test]
    fn png_gives_back_what_its_depth_holds(pixmap in pixmaps(30, 8)) {
        let mut bytes = Vec::new();
        png::write(&pixmap, &mut bytes).unwrap();
        let decoded = decode_image(&bytes, &Limits::default()).unwrap();
        let maxval = if pixmap.maxval() <= 255 { 255 } else { 65535 };
        prop_assert_eq!(&decoded.pixmap, &pixmap.scaled(maxval));
        prop_assert!(!decoded.transparent);
        // Up to the full depth and back is no change.
        prop_assert_eq!(decoded.pixmap.scaled(pixmap.maxval()), pixmap);
    }
}

/// Reads piece by piece.
struct Pieces<I>(I);

impl<'a, I: Iterator<Item = &'a [u8]>> std::io::Read for Pieces<I> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let piece = self.0.next().unwrap_or_default();
        buffer[..piece.len()].copy_from_slice(piece);
        Ok(piece.len())
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn mutated_ppm_files_never_panic(pixmap in pixmaps(30, 8), encoding in encodings(), grey: bool, mutations in mutations()) {
        let mut bytes = encode(&pixmap, encoding);
        if grey {
            bytes[1] -= 1; // P2 or P5, with a raster three times as long as needed
        }
        let bytes = mutate(bytes, &mutations);
        let limits = Limits { max_pixels: 1 << 16 };
        let known = ppm::read_bytes(&bytes, &limits);
        let unknown = ppm::read(&bytes[..], &limits);
        match (known, unknown) {
            (Ok(known), Ok(unknown)) => {
                prop_assert_eq!(&known, &unknown);
                // What was read is a valid picture: written and read again it is the same.
                prop_assert_eq!(ppm::read_bytes(&encode(&known, encoding), &limits).unwrap(), known);
            }
            (Err(known), Err(unknown)) => prop_assert_eq!(known.to_string(), unknown.to_string()),
            (known, unknown) => prop_assert!(false, "{known:?} but {unknown:?}"),
        }
    }

    #[test]
    fn arbitrary_bytes_never_panic(magic in "(P[1-7][ \n#]|)", bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let bytes = [magic.as_bytes(), &bytes].concat();
        let limits = Limits { max_pixels: 1 << 16 };
        let _ = ppm::read_bytes(&bytes, &limits);
        let _ = ppm::read(&bytes[..], &limits);
        let _ = decode_image(&bytes, &limits);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn mutated_png_files_never_panic(pixmap in pixmaps(30, 8), mutations in mutations()) {
        let mut bytes = Vec::new();
        png::write(&pixmap, &mut bytes).unwrap();
        let _ = decode_image(&mutate(bytes, &mutations), &Limits { max_pixels: 1 << 16 });
    }

    #[test]
    fn mutated_jpeg_files_never_panic(mutations in mutations(), progressive: bool) {
        let bytes = if progressive { &include_bytes!("images/progressive.jpg")[..] } else { include_bytes!("images/baseline.jpg") };
        let _ = decode_image(&mutate(bytes.to_vec(), &mutations), &Limits { max_pixels: 1 << 16 });
    }

    #[test]
    fn mutated_tiff_files_never_panic(mutations in mutations(), kind in 0..3_usize) {
        let files: [&[u8]; 3] =
            [include_bytes!("images/plain.tiff"), include_bytes!("images/lzw.tiff"), include_bytes!("images/palette.tiff")];
        let _ = decode_image(&mutate(files[kind].to_vec(), &mutations), &Limits { max_pixels: 1 << 16 });
    }
}
