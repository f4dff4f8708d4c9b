//! Any text: the reader of scene files gives a scene whose lists agree with each other, or an error in one line.
#![no_main]

use figures::scene_file;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    match scene_file::embedded(text, "fuzz.toml") {
        Ok(scene) => scene.check(),
        Err(error) => {
            let message = error.to_string();
            assert!(message.starts_with("fuzz.toml:") && !message.contains('\n'), "{message:?}");
        }
    }
});
