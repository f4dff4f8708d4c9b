//! Any bytes: the decoders of PNG, JPEG and TIFF give a picture or an error.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rt_io::Limits;

fuzz_target!(|bytes: &[u8]| {
    let _ = rt_io::decode_image(bytes, &Limits { max_pixels: 1 << 16 });
});
