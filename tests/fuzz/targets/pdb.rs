//! Any bytes: the reader of PDB files gives spheres that each have a colour, or an error with its line.
#![no_main]

use figures::import::pdb;
use figures::import::spheres::Options;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let frame = u64::from(bytes.first().copied().unwrap_or(0) % 4) + 1;
    if let Ok(found) = pdb::read(bytes, "fuzz.pdb", Options { frame, ..Options::default() }) {
        assert_eq!(found.spheres.len(), found.color_indices.len());
        assert!(found.color_indices.iter().all(|&index| (index as usize) < found.colors.len()));
    }
});
