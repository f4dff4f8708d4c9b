//! Any bytes: the decoders of PNG, JPEG and TIFF give a picture or an error, and the fence around them has nothing to
//! do.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rt_io::{DecodeError, Limits};

fuzz_target!(|bytes: &[u8]| {
    let decoded = rt_io::decode_image(bytes, &Limits { max_pixels: 1 << 16 });
    if let Err(DecodeError::Panicked { format, message }) = decoded {
        panic!("the decoder of {format} panicked: {message}");
    }
});
