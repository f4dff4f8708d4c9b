//! Any bytes: the reader of sphere files gives spheres that each have a colour, or an error with its line, the same for
//! known and unknown length.
#![no_main]

use figures::import::spheres::Options;
use figures::import::xyz::read;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let options = Options { frame: bytes.len() as u64 % 3 + 1, ..Options::default() };
    let known = read(bytes, bytes.len() as u64, "fuzz.xyz", options);
    let unknown = read(bytes, 0, "fuzz.xyz", options);
    match (known, unknown) {
        (Ok(known), Ok(unknown)) => {
            assert_eq!(known.spheres, unknown.spheres);
            assert_eq!(known.spheres.len(), known.color_indices.len());
            assert!(known.color_indices.iter().all(|&index| (index as usize) < known.colors.len()));
        }
        (Err(known), Err(unknown)) => assert_eq!(known.to_string(), unknown.to_string()),
        (known, unknown) => panic!("{known:?} but {unknown:?}"),
    }
});
