//! Any bytes as a file without an ending: known by its content, unpacked if it is packed, and read or refused in one
//! line.
#![no_main]

use figures::load::load;
use figures::outcome::Failure;
use figures::scene_file::Changes;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let path = std::env::temp_dir().join(format!("figures-fuzz-{}", std::process::id()));
    std::fs::write(&path, bytes).unwrap();
    match load(&path, &Changes::default()) {
        Ok(scene) => scene.check(),
        Err(Failure::Failed(error)) => assert!(!error.to_string().contains('\n'), "{error}"),
        Err(other) => panic!("{other:?}"),
    }
});
