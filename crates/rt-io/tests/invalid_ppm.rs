//! Every invalid PPM is refused with a message that names the fault and its byte; every odd but valid one is read.

use std::io::{self, Read};

use rt_io::ppm::{self, PpmError};
use rt_io::{Limits, Pixmap};

/// What is in the file, and the message.
#[rustfmt::skip]
const INVALID: &[(&[u8], &str)] = &[
    // The magic number.
    (b"", "byte 0: expected P3 or P6 (PPM), P2 or P5 (PGM), found an empty file"),
    (b"P", "byte 0: expected P3 or P6 (PPM), P2 or P5 (PGM), found `P`"),
    (b"p6 1 1 255 abc", "byte 0: expected P3 or P6 (PPM), P2 or P5 (PGM), found `p6`"),
    (b" P6 1 1 255 abc", "byte 0: expected P3 or P6 (PPM), P2 or P5 (PGM), found bytes 0x20 0x50"),
    (b"#c\nP6 1 1 255 abc", "byte 0: expected P3 or P6 (PPM), P2 or P5 (PGM), found `#c`"),
    (b"\xef\xbb\xbfP3 1 1 255 1 2 3", "byte 0: expected P3 or P6 (PPM), P2 or P5 (PGM), found bytes 0xef 0xbb"),
    (b"P\n6 1 1 255 abc", "byte 0: expected P3 or P6 (PPM), P2 or P5 (PGM), found bytes 0x50 0x0a"),
    (b"P8 1 1 255 abc", "byte 0: expected P3 or P6 (PPM), P2 or P5 (PGM), found `P8`"),
    (b"P1 1 1 1", "byte 0: `P1` is not read; convert it with netpbm: pamdepth 255"),
    (b"P4 1 1 \x80", "byte 0: `P4` is not read; convert it with netpbm: pamdepth 255"),
    (b"P7\nWIDTH 1\n", "byte 0: `P7` is not read; convert it with netpbm: pamtopnm"),
    (b"P61 1 255 abc", "byte 2: expected white space after the magic number, found `1`"),
    (b"P3x1 1 255 1 2 3", "byte 2: expected white space after the magic number, found `x`"),
    (b"P6\0", "byte 2: expected white space after the magic number, found byte 0x00"),
    // The header ends early.
    (b"P6", "byte 2: the file ends before the width"),
    (b"P6 ", "byte 3: the file ends before the width"),
    (b"P6 # nothing but a comment", "byte 26: the file ends before the width"),
    (b"P6 1", "byte 4: the file ends before the height"),
    (b"P6 1 ", "byte 5: the file ends before the height"),
    (b"P6 1#", "byte 5: the file ends before the height"),
    (b"P6 1 1", "byte 6: the file ends before maxval"),
    (b"P6 1 1\n", "byte 7: the file ends before maxval"),
    (b"P3 1 1 # 255", "byte 12: the file ends before maxval"),
    // Width and height.
    (b"P6 -1 1 255 abc", "byte 3: expected the width in decimal digits, found `-`"),
    (b"P6 +1 1 255 abc", "byte 3: expected the width in decimal digits, found `+`"),
    (b"P6 .5 1 255 abc", "byte 3: expected the width in decimal digits, found `.`"),
    (b"P6 x 1 255 abc", "byte 3: expected the width in decimal digits, found `x`"),
    (b"P6 \xff 1 255 abc", "byte 3: expected the width in decimal digits, found byte 0xff"),
    (b"P6 0x1 1 255 abc", "byte 4: expected white space after the width, found `x`"),
    (b"P6 1.0 1 255 abc", "byte 4: expected white space after the width, found `.`"),
    (b"P6 1e0 1 255 abc", "byte 4: expected white space after the width, found `e`"),
    (b"P6 1,1 255 abc", "byte 4: expected white space after the width, found `,`"),
    (b"P6 1x1 255 abc", "byte 4: expected white space after the width, found `x`"),
    (b"P6 1\x001 255 abc", "byte 4: expected white space after the width, found byte 0x00"),
    (b"P6 1 -1 255 abc", "byte 5: expected the height in decimal digits, found `-`"),
    (b"P6 1 1_ 255 abc", "byte 6: expected white space after the height, found `_`"),
    (b"P6 0 1 255 ", "byte 3: the width must be at least 1, found 0"),
    (b"P6 00 1 255 ", "byte 3: the width must be at least 1, found 0"),
    (b"P6 1 0 255 ", "byte 5: the height must be at least 1, found 0"),
    (b"P3 0 0 255 ", "byte 3: the width must be at least 1, found 0"),
    (b"P6 4294967296 1 255 abc", "byte 3: the width must be at most 4294967295"),
    (b"P6 1 99999999999999999999999 255 abc", "byte 5: the height must be at most 4294967295"),
    (b"P6 4294967295 1 255 abc", "byte 3: 4294967295 x 1 pixels are more than the limit of 268435456"),
    (b"P6 4294967295 4294967295 255 abc",
        "byte 3: 4294967295 x 4294967295 pixels are more than the limit of 268435456"),
    (b"P5 16385 16384 255 abc", "byte 3: 16385 x 16384 pixels are more than the limit of 268435456"),
    // maxval.
    (b"P6 1 1 0 abc", "byte 7: maxval must be in 1..=65535, found 0"),
    (b"P6 1 1 65536 abcdef", "byte 7: maxval must be in 1..=65535, found 65536"),
    (b"P3 1 1 4294967295 1 2 3", "byte 7: maxval must be in 1..=65535, found 4294967295"),
    (b"P3 1 1 4294967296 1 2 3", "byte 7: maxval must be at most 4294967295"),
    (b"P6 1 1 -255 abc", "byte 7: expected maxval in decimal digits, found `-`"),
    (b"P6 1 1 255.0 abc", "byte 10: expected white space after maxval, found `.`"),
    (b"P6 1 1 255abc", "byte 10: expected white space after maxval, found `a`"),
    (b"P6 1 1 0xff abc", "byte 8: expected white space after maxval, found `x`"),
    // The raw raster.
    (b"P6 1 1 255", "byte 10: the file ends inside the raster: expected 3 samples, found 0"),
    (b"P6 1 1 255#", "byte 11: the file ends inside the raster: expected 3 samples, found 0"),
    (b"P6 1 1 255#comment", "byte 18: the file ends inside the raster: expected 3 samples, found 0"),
    (b"P6 1 1 255 ", "byte 11: the file ends inside the raster: expected 3 samples, found 0"),
    (b"P6 1 1 255 ab", "byte 13: the file ends inside the raster: expected 3 samples, found 2"),
    (b"P5 2 2 255 abc", "byte 14: the file ends inside the raster: expected 4 samples, found 3"),
    (b"P6 1 1 256 \0a\0b\0", "byte 16: the file ends inside the raster: expected 3 samples, found 2"),
    (b"P6 1 1 65535 abc", "byte 16: the file ends inside the raster: expected 3 samples, found 1"),
    (b"P6 16384 16384 65535 abc",
        "byte 24: the file ends inside the raster: expected 805306368 samples, found 1"),
    (b"P6 1 1 254 \x01\xff\x01", "byte 12: a sample must be at most maxval = 254, found 255"),
    (b"P6 1 1 1 \x01\x01\x02", "byte 11: a sample must be at most maxval = 1, found 2"),
    (b"P5 2 1 31 \x1f\x20", "byte 11: a sample must be at most maxval = 31, found 32"),
    (b"P6 1 1 256 \0\0\x01\x00\x01\x01", "byte 15: a sample must be at most maxval = 256, found 257"),
    (b"P5 1 1 65534 \xff\xff", "byte 13: a sample must be at most maxval = 65534, found 65535"),
    // The plain raster.
    (b"P3 1 1 255", "byte 10: the file ends inside the raster: expected 3 samples, found 0"),
    (b"P3 1 1 255 1 2", "byte 14: the file ends inside the raster: expected 3 samples, found 2"),
    (b"P3 1 1 255 1 2 # 3\n", "byte 19: the file ends inside the raster: expected 3 samples, found 2"),
    (b"P2 2 1 255 1", "byte 12: the file ends inside the raster: expected 2 samples, found 1"),
    (b"P3 16384 16384 65535 1 2 3",
        "byte 26: the file ends inside the raster: expected 805306368 samples, found 3"),
    (b"P3 1 1 255 1 256 3", "byte 13: a sample must be at most maxval = 255, found 256"),
    (b"P3 1 1 255 1 2 65791", "byte 15: a sample must be at most maxval = 255, found 65791"),
    (b"P3 1 1 65535 1 2 65536", "byte 17: a sample must be at most maxval = 65535, found 65536"),
    (b"P3 1 1 65535 1 2 9999999 ", "byte 17: a sample must be at most maxval = 65535, found 9999999"),
    (b"P3 1 1 7 8 2 3", "byte 9: a sample must be at most maxval = 7, found 8"),
    (b"P3 1 1 255 1 256 3 with more text behind", "byte 13: a sample must be at most maxval = 255, found 256"),
    (b"P3 1 1 255 1 2 65791 with more text behind", "byte 15: a sample must be at most maxval = 255, found 65791"),
    (b"P3 1 1 65535 65536 with more text behind", "byte 13: a sample must be at most maxval = 65535, found 65536"),
    (b"P3 1 1 65535 9999999 with more text", "byte 13: a sample must be at most maxval = 65535, found 9999999"),
    (b"P2 1 1 100 101", "byte 11: a sample must be at most maxval = 100, found 101"),
    (b"P3 1 1 255 1 4294967296 3", "byte 13: a sample must be at most 4294967295"),
    (b"P3 1 1 255 1 18446744073709551617 3", "byte 13: a sample must be at most 4294967295"),
    (b"P3 1 1 255 -1 2 3", "byte 11: expected a sample in decimal digits, found `-`"),
    (b"P3 1 1 255 1 +2 3", "byte 13: expected a sample in decimal digits, found `+`"),
    (b"P3 1 1 255 1.5 2 3", "byte 12: expected white space after a sample, found `.`"),
    (b"P3 1 1 255 1,2,3", "byte 12: expected white space after a sample, found `,`"),
    (b"P3 1 1 255 0x1 2 3 4 5 6 7 8 9", "byte 12: expected white space after a sample, found `x`"),
    (b"P3 1 1 255 1 2 3x", "byte 16: expected white space after a sample, found `x`"),
    (b"P3 1 1 255 1 2 abc", "byte 15: expected a sample in decimal digits, found `a`"),
    (b"P3 1 1 255 1 2 \xb2", "byte 15: expected a sample in decimal digits, found byte 0xb2"),
    (b"P3 1 1 255 1 2 \0", "byte 15: expected a sample in decimal digits, found byte 0x00"),
    (b"P3 1 1 255 1 2\xa03 4 5 6 7 8 9", "byte 14: expected white space after a sample, found byte 0xa0"),
];

/// What is in the file, `maxval`, and the samples of its one row.
#[rustfmt::skip]
const VALID: &[(&[u8], u16, &[u16])] = &[
    // Comments touch numbers, end with CR or CRLF, are empty, hold `#`, stand in a plain raster.
    (b"P6#c\n1#w\n1#h\n255#m\nabc", 255, &[97, 98, 99]),
    (b"P6#\n#\n#\n1 1 255\nabc", 255, &[97, 98, 99]),
    (b"P6 # a # b\r1 1 255\nabc", 255, &[97, 98, 99]),
    (b"P6\r\n# c\r\n1 1\r\n255 abc", 255, &[97, 98, 99]),
    (b"P6 1 1#\xff\0\x80\n255 abc", 255, &[97, 98, 99]),
    (b"P3 1 1 255 1#one\n2 #two\r#\n3", 255, &[1, 2, 3]),
    (b"P3 1 1 255#m\r1#\n2#\n3#", 255, &[1, 2, 3]),
    (b"P3 1 1 255 1 2 3#comment without an end", 255, &[1, 2, 3]),
    // The byte that ends maxval is one byte, whatever follows.
    (b"P6 1 1 255\n\n\n\n", 255, &[10, 10, 10]),
    (b"P6 1 1 255\r\nab", 255, &[10, 97, 98]),
    (b"P6 1 1 255 #ab", 255, &[35, 97, 98]),
    (b"P6 1 1 255#m\r\nab", 255, &[10, 97, 98]),
    (b"P6 1 1 255\n# c", 255, &[35, 32, 99]),
    // All six kinds of white space.
    (b"P6\t1\x0b1\x0c255\rabc", 255, &[97, 98, 99]),
    (b"P3\n1\r1\t255\x0b1\x0c2 3", 255, &[1, 2, 3]),
    (b"P3   1\n\n\n1\t \t255     1          2\r\n\r\n3", 255, &[1, 2, 3]),
    // Zeros before a number.
    (b"P6 0001 01 000255 abc", 255, &[97, 98, 99]),
    (b"P3 1 1 255 0000000000000000001 000000002 0000003", 255, &[1, 2, 3]),
    (b"P3 1 1 255 0000255 00000255 000 0", 255, &[255, 255, 0]),
    // What follows the picture does not count, nor does a missing line end.
    (b"P6 1 1 255 abcP6 1 1 255 def", 255, &[97, 98, 99]),
    (b"P3 1 1 255 1 2 3 P3 trailing 999 -5", 255, &[1, 2, 3]),
    (b"P3 1 1 255 1 2 3\n", 255, &[1, 2, 3]),
    (b"P3 1 1 255 1 2 3", 255, &[1, 2, 3]),
    // Every maxval; samples stay as they are.
    (b"P6 1 1 1 \x01\x00\x01", 1, &[1, 0, 1]),
    (b"P6 1 1 254 \xfe\x00\x01", 254, &[254, 0, 1]),
    (b"P6 1 1 256 \x01\x00\x00\xff\x00\x01", 256, &[256, 255, 1]),
    (b"P6 1 1 65535 \xff\xff\x01\x02\x00\x00", 65535, &[65535, 0x0102, 0]),
    (b"P3 1 1 65535 65535 256 0", 65535, &[65535, 256, 0]),
    (b"P3 1 1 12345 12345 1 9999", 12345, &[12345, 1, 9999]),
    // Grey.
    (b"P5 2 1 255 ab", 255, &[97, 97, 97, 98, 98, 98]),
    (b"P5 1 1 65535 \x01\x02", 65535, &[0x0102; 3]),
    (b"P2 2 1 15 15#\n0", 15, &[15, 15, 15, 0, 0, 0]),
    (b"P2 1 1 1000 1000", 1000, &[1000; 3]),
];

/// Hands out one byte a time, as a slow pipe may.
struct Drip<'a>(&'a [u8]);

impl Read for Drip<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.0.len().min(buffer.len()).min(1);
        buffer[..count].copy_from_slice(&self.0[..count]);
        self.0 = &self.0[count..];
        Ok(count)
    }
}

/// Reads by all three ways in: known length, unknown length, unknown length byte by byte.
fn read_all_ways(bytes: &[u8]) -> [Result<Pixmap, PpmError>; 3] {
    let limits = Limits::default();
    [ppm::read_bytes(bytes, &limits), ppm::read(bytes, &limits), ppm::read(Drip(bytes), &limits)]
}

#[test]
fn invalid_files_are_refused_with_the_fault_and_its_byte() {
    assert!(INVALID.len() >= 60);
    for (bytes, message) in INVALID {
        for result in read_all_ways(bytes) {
            let error = result.expect_err(&format!("{:?} was read", bytes.escape_ascii().to_string()));
            assert_eq!(&error.to_string(), message, "{}", bytes.escape_ascii());
        }
    }
}

#[test]
fn odd_but_valid_files_are_read() {
    for (bytes, maxval, samples) in VALID {
        for result in read_all_ways(bytes) {
            let pixmap = result.unwrap_or_else(|error| panic!("{}: {error}", bytes.escape_ascii()));
            assert_eq!(pixmap.maxval(), *maxval, "{}", bytes.escape_ascii());
            assert_eq!(&pixmap.to_samples(), samples, "{}", bytes.escape_ascii());
        }
    }
}

#[test]
fn the_limit_of_pixels_is_the_callers() {
    let bytes = b"P3 3 2 9 1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9";
    assert!(ppm::read_bytes(bytes, &Limits { max_pixels: 6 }).is_ok());
    let error = ppm::read_bytes(bytes, &Limits { max_pixels: 5 }).unwrap_err();
    assert_eq!(error.to_string(), "byte 3: 3 x 2 pixels are more than the limit of 5");
    // However high, nothing overflows and nothing is allocated for what is not there.
    let huge = b"P6 4294967295 4294967295 65535 abc";
    assert!(ppm::read_bytes(huge, &Limits { max_pixels: u64::MAX }).is_err());
    assert!(ppm::read(&huge[..], &Limits { max_pixels: u64::MAX }).is_err());
    let long = b"P6 4294967295 357913941 65535 abc";
    assert!(ppm::read_bytes(long, &Limits { max_pixels: u64::MAX }).is_err());
    assert!(ppm::read(&long[..], &Limits { max_pixels: u64::MAX }).is_err());
}

#[test]
fn a_reader_that_fails_is_an_error_with_its_byte() {
    struct Fails;
    impl Read for Fails {
        fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
            Err(io::Error::other("the cable is out"))
        }
    }
    for head in ["", "P6 1", "P6 1 1 255 a", "P6 1 1 256 abc", "P3 1 1 255 12"] {
        let error = ppm::read(head.as_bytes().chain(Fails), &Limits::default()).unwrap_err();
        assert_eq!(error.to_string(), format!("byte {}: cannot read on", head.len()), "{head}");
        assert_eq!(std::error::Error::source(&error).unwrap().to_string(), "the cable is out");
    }
}

#[test]
fn comments_of_the_header_are_given_back() {
    let read = |bytes: &[u8]| ppm::read_with_comments(Drip(bytes), &Limits::default()).unwrap().1;
    assert_eq!(read(b"P6 1 1 255\n# c"), [""; 0]);
    assert_eq!(read(b"P3 1#yes\n1 255 # no\n1 2#no\n3"), ["yes"]);
    assert_eq!(read(b"P6#a\n # b \r1#c#d\n1#\n255# \xff\nabc"), ["a", "b ", "c#d", "", "\u{fffd}"]);
    // A long one is cut and the picture is read.
    let bytes = [b"P6#", &[b'x'; 100_000][..], b"\n# left out\n1 1 255 abc"].concat();
    let (pixmap, comments) = ppm::read_with_comments(&bytes[..], &Limits::default()).unwrap();
    assert_eq!(pixmap.to_samples(), [97, 98, 99]);
    assert_eq!(comments, ["x".repeat(65535)]);
}

#[test]
fn a_comment_of_two_lines_is_not_written() {
    let pixmap = Pixmap::new(1, 1, 255, vec![1, 2, 3]).unwrap();
    for comment in ["two\nlines", "two\rlines"] {
        let mut bytes = Vec::new();
        let error = ppm::write_with_comment(&pixmap, ppm::Encoding::Raw, comment, &mut bytes).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::InvalidInput);
        assert!(bytes.is_empty());
    }
}
