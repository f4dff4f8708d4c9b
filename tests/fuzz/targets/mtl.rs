//! Any bytes: the reader of material libraries gives colours from 0 to 1, or an error.
#![no_main]

use figures::import::mtl::Library;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut library = Library::default();
    let _ = library.read(bytes);
    assert!(library.colors.values().all(|color| color.to_array().iter().all(|channel| (0.0..=1.0).contains(channel))));
});
