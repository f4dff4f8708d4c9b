//! Any bytes: the PPM reader gives a valid picture or an error, the same for known and unknown length, and what it
//! reads survives being written and read again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rt_io::Limits;
use rt_io::ppm::{self, Encoding};

fuzz_target!(|bytes: &[u8]| {
    let limits = Limits { max_pixels: 1 << 16 };
    let known = ppm::read_bytes(bytes, &limits);
    let unknown = ppm::read(bytes, &limits);
    match (known, unknown) {
        (Ok(known), Ok(unknown)) => {
            assert_eq!(known, unknown);
            for encoding in [Encoding::Raw, Encoding::Plain] {
                let mut written = Vec::new();
                ppm::write(&known, encoding, &mut written).unwrap();
                assert_eq!(ppm::read_bytes(&written, &limits).unwrap(), known);
            }
        }
        (Err(known), Err(unknown)) => assert_eq!(known.to_string(), unknown.to_string()),
        (known, unknown) => panic!("{known:?} but {unknown:?}"),
    }
});
