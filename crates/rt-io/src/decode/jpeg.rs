//! JPEG: baseline, extended and progressive Huffman coding, 8 bits, grey or three components, through `zune-jpeg`.
//!
//! That decoder gives garbage for some samplings, and fills up with zeros what a broken file leaves out, in its
//! strict mode too. So the file is walked through first: what would be decoded wrong is refused by name, and what is
//! left is decoded with ones after the data of each scan, which are no Huffman code (T.81, C.2): a decoder that
//! needs more than there is fails on them. A whole file leaves them unread, like the ones that fill up its last byte
//! (F.1.2.3).
//!
//! Measured against libjpeg-turbo's `djpeg`, samples are at most 3 of 255 off where all components have the same size,
//! and 4 where some have half the columns or rows, except in two places where the standard leaves the decoder free, and
//! hard edges made a difference of up to 99: the last column or row, if their number is even and no multiple of 16
//! (libjpeg repeats the component's last sample; this decoder takes the one that the encoder has filled its block up
//! with), and pictures of at most four columns (libjpeg repeats samples there, this decoder goes on to mix neighbours).
//!
//! Source: ITU-T T.81 (1992); section numbers are its own. T.871 (JFIF) for the colours.

use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::dimensions::Dimensions;
use super::outcome::{DecodeError, Decoded};
use crate::limits::Limits;
use crate::pixmap::{Pixmap, Samples};

fn broken(what: impl Into<String>) -> DecodeError {
    DecodeError::broken("JPEG", what.into())
}

fn refuse<T>(what: impl Into<String>) -> Result<T, DecodeError> {
    Err(DecodeError::Kind { format: "JPEG", what: what.into() })
}

const ENDS: DecodeError = DecodeError::Truncated { format: "JPEG" };

/// Bytes of ones after the data of a scan or restart interval: more than the 16 bits of the longest code, the 16 bits
/// of the number after it, and the 7 that its last byte may lack.
const ONES: usize = 8;

/// Decodes the first picture of a file that begins with a JPEG's marker.
pub(super) fn decode(bytes: &[u8], limits: &Limits) -> Result<Decoded, DecodeError> {
    let walk = Walk::new(bytes, ONES, limits)?;
    let frame = walk.frame.ok_or_else(|| broken("no frame header"))?;
    let (columns, rows) = frame.size.in_memory()?;
    let mut samples = frame.size.filled(columns * rows * frame.components.len(), 0)?;
    // The decoder aborts where it cannot have the coefficients of a progressive file.
    drop(frame.size.room::<i16>(if frame.progressive { frame.coefficients() } else { 0 })?);

    if let Err(message) = run(&walk.file, &mut samples) {
        // Whether it is for lack of data: without the ones the decoder fills up what is missing.
        let plain = Walk::new(bytes, 0, limits)?;
        return Err(if run(&plain.file, &mut samples).is_ok() { ENDS } else { broken(message) });
    }
    // Bits that refine coefficients have no code that ones could break. If the last of them are missing, it makes a
    // difference that the decoder fills up with zeros here.
    if frame.refines {
        let plain = Walk::new(bytes, 0, limits)?;
        let mut filled_up = frame.size.filled(samples.len(), 0)?;
        if run(&plain.file, &mut filled_up).is_err() || filled_up != samples {
            return Err(ENDS);
        }
    }
    let pixmap = Pixmap::from_checked(columns, rows, 255, Samples::Eight(samples));
    Ok(Decoded { pixmap: pixmap.ok_or_else(|| broken("no pixels"))?, transparent: false })
}

/// Fills `samples` from a file whose frame was checked, or returns the error of the decoder.
fn run(file: &[u8], samples: &mut [u8]) -> Result<(), String> {
    let options =
        DecoderOptions::default().set_strict_mode(true).set_max_width(u16::MAX.into()).set_max_height(u16::MAX.into());
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(file), options);
    decoder.decode_headers().map_err(|error| format!("{error:?}"))?;
    if decoder.input_colorspace() == Some(ColorSpace::Luma) {
        decoder.set_options(options.jpeg_set_out_colorspace(ColorSpace::Luma));
    }
    if decoder.output_buffer_size() != Some(samples.len()) {
        return Err("a frame of another size".to_string());
    }
    decoder.decode_into(samples).map_err(|error| format!("{error:?}"))
}

/// One component of the frame.
struct Component {
    id: u8,
    /// Sampling factors: blocks in an interleaved unit, across and down.
    across: usize,
    down: usize,
    /// The lowest bit that has been sent of each coefficient, `None` before the first: 0 when it is complete.
    sent: [Option<u8>; 64],
}

/// What the frame header says.
struct JpegFrame {
    progressive: bool,
    /// Whether a scan refines coefficients.
    refines: bool,
    size: Dimensions,
    components: Vec<Component>,
    /// Largest sampling factors.
    across: usize,
    down: usize,
}

/// A file that was walked through from segment to segment.
#[derive(Default)]
struct Walk {
    /// Bytes of ones that it gets after the data of scans and restart intervals.
    ones: usize,
    frame: Option<JpegFrame>,
    /// What the decoder gets.
    file: Vec<u8>,
    restart_interval: usize,
    jfif: bool,
    /// The byte of Adobe's segment that states the colour space.
    adobe_transform: Option<u8>,
    scans: usize,
}

impl Walk {
    fn new(bytes: &[u8], ones: usize, limits: &Limits) -> Result<Self, DecodeError> {
        let mut walk = Self { ones, ..Self::default() };
        let room = bytes.len().saturating_mul(2);
        walk.file.try_reserve(room).map_err(|error| DecodeError::Read(error.into()))?;
        walk.file.extend(&bytes[..2]);
        let mut at = 2;
        loop {
            let marker = next_marker(bytes, &mut at).ok_or(ENDS)?;
            // Markers without a segment: fill, reserved, restart and start of image.
            if matches!(marker, 0x00 | 0x01 | 0xd0..=0xd8) {
                continue;
            }
            if marker == 0xd9 {
                break;
            }
            let length = usize::from(u16::from_be_bytes(*bytes.get(at..).and_then(<[u8]>::first_chunk).ok_or(ENDS)?));
            if length < 2 {
                return Err(broken("a segment without a length"));
            }
            let whole = at - 2..at + length;
            let segment = bytes.get(at + 2..at + length).ok_or(ENDS)?;
            at += length;
            if marker == 0xda {
                walk.scan(&bytes[whole], segment, bytes, &mut at)?;
            } else if walk.segment(marker, segment, bytes, limits)? {
                walk.file.extend(&bytes[whole]);
                if let (0xc0..=0xc2, [.., factors, _]) = (marker, &mut walk.file[..])
                    && segment.get(5) == Some(&1)
                {
                    *factors = 0x11; // Grey is its own measure.
                }
            }
        }
        let frame = walk.frame.as_ref().ok_or_else(|| broken("no frame header"))?;
        if frame.components.iter().any(|component| component.sent != [Some(0); 64]) {
            return Err(ENDS);
        }
        walk.file.extend([0xff, 0xd9]);
        Ok(walk)
    }

    /// Checks a segment other than a scan, and keeps what it says; returns whether the decoder gets it.
    fn segment(&mut self, marker: u8, segment: &[u8], bytes: &[u8], limits: &Limits) -> Result<bool, DecodeError> {
        match marker {
            0xc0..=0xc2 if self.frame.is_some() => return Err(broken("a second frame header")),
            0xc0..=0xc2 => self.frame = Some(JpegFrame::new(marker == 0xc2, segment, bytes, limits)?),
            0xc3 => return refuse("lossless coding"),
            0xc9 | 0xca => return refuse("arithmetic coding"),
            0xcb => return refuse("lossless arithmetic coding"),
            0xc5..=0xc7 | 0xcd..=0xcf | 0xde | 0xdf => return refuse("hierarchical coding"),
            0xdc => return refuse("its height behind the picture"),
            0xc4 | 0xdb => {}
            0xdd => {
                let &interval = segment.first_chunk().ok_or_else(|| broken("a restart interval"))?;
                self.restart_interval = u16::from_be_bytes(interval).into();
            }
            0xe0 if segment.starts_with(b"JFIF\0") => {
                self.jfif = true;
                return Ok(false);
            }
            0xee if segment.starts_with(b"Adobe") => {
                self.adobe_transform = segment.get(11).copied();
                return Ok(false);
            }
            // Comments, profiles and the like.
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Copies a scan, its header and its data; `at` is after the header.
    fn scan(&mut self, whole: &[u8], header: &[u8], bytes: &[u8], at: &mut usize) -> Result<(), DecodeError> {
        let frame = self.frame.as_mut().ok_or_else(|| broken("a scan before the frame header"))?;
        let mut units = frame.begin_scan(header)?;
        if self.scans == 0 {
            let ids_are_rgb = frame.components.iter().map(|component| component.id).eq(*b"RGB");
            // libjpeg's rule, for files that leave it open.
            let is_rgb = match self.adobe_transform {
                _ if self.jfif => false,
                Some(transform) => transform == 0,
                None => ids_are_rgb,
            };
            if ids_are_rgb && !is_rgb {
                return refuse("luma and chroma in components named R, G and B");
            }
            let transform = u8::from(!is_rgb);
            if frame.components.len() == 3 {
                self.file.extend([0xff, 0xee, 0, 14]);
                self.file.extend(*b"Adobe\0\x64\0\0\0\0");
                self.file.push(transform);
            }
        }
        let begin = self.file.len();
        self.file.extend(whole);
        // In the first scan of a progressive file the decoder needs the marker right after the data: it gets that scan
        // once as it is and once again with ones.
        let mut plain = if self.scans == 0 && frame.progressive && self.ones > 0 { whole.to_vec() } else { Vec::new() };
        self.scans += 1;
        loop {
            let interval = data(bytes, *at).ok_or(ENDS)?;
            *at += interval.len();
            units -= if self.restart_interval == 0 { units } else { self.restart_interval.min(units) };
            let room = self.file.try_reserve(2 * interval.len() + 2 * self.ones + 2);
            room.map_err(|error| DecodeError::Read(error.into()))?;
            self.file.extend(interval);
            self.file.extend([0xff, 0].repeat(self.ones));
            if !plain.is_empty() {
                plain.extend(interval);
            }
            let mut behind = *at;
            let marker = next_marker(bytes, &mut behind).ok_or(ENDS)?;
            if !matches!(marker, 0xd0..=0xd7) {
                break;
            }
            *at = behind;
            if units == 0 {
                // One restart too many, which some encoders write.
                break;
            }
            self.file.extend([0xff, marker]);
            if !plain.is_empty() {
                plain.extend([0xff, marker]);
            }
        }
        if units > 0 {
            return Err(ENDS);
        }
        self.file.splice(begin..begin, plain);
        Ok(())
    }
}

fn next_marker(bytes: &[u8], at: &mut usize) -> Option<u8> {
    *at += bytes.get(*at..)?.iter().position(|&byte| byte == 0xff)?;
    // Any number of 0xff may stand before a marker.
    *at += bytes.get(*at..)?.iter().position(|&byte| byte != 0xff)?;
    *at += 1;
    Some(bytes[*at - 1])
}

/// The entropy-coded bytes from `at` to the next marker.
fn data(bytes: &[u8], at: usize) -> Option<&[u8]> {
    let rest = bytes.get(at..)?;
    let length = rest.windows(2).position(|pair| pair[0] == 0xff && pair[1] != 0)?;
    Some(&rest[..length])
}

impl JpegFrame {
    /// Reads and checks the frame header (B.2.2).
    fn new(progressive: bool, segment: &[u8], bytes: &[u8], limits: &Limits) -> Result<Self, DecodeError> {
        let Some((&[precision, h1, h0, w1, w0, count], rest)) = segment.split_first_chunk::<6>() else {
            return Err(broken("a frame header ends early"));
        };
        let (width, height) = (u16::from_be_bytes([w1, w0]), u16::from_be_bytes([h1, h0]));
        match (precision, count) {
            (8, 1 | 3) => {}
            (8, 4) => return refuse("four components (CMYK or YCCK)"),
            (8, _) => return refuse(format!("{count} components")),
            _ => return refuse(format!("{precision}-bit samples")),
        }
        if height == 0 {
            return refuse("its height behind the picture");
        }
        if width == 0 {
            return Err(broken("a width of 0"));
        }
        let (specified, _) = rest.as_chunks::<3>();
        let specified = specified.get(..usize::from(count)).ok_or_else(|| broken("a frame header ends early"))?;
        let component = |&[id, factors, _]: &[u8; 3]| Component {
            id,
            across: usize::from(factors >> 4),
            down: usize::from(factors & 15),
            sent: [None; 64],
        };
        let mut components: Vec<Component> = specified.iter().map(component).collect();
        let (across, down) = (components[0].across, components[0].down);
        // The first has the largest factors, all are 1 or 2: what the decoder has been compared for.
        let valid = |most: usize, factor: usize| (1..=most).contains(&factor) && most <= 2;
        if count == 1 && (1..=4).contains(&across) && (1..=4).contains(&down) {
            // A single component is its own measure.
            (components[0].across, components[0].down) = (1, 1);
        } else if !components.iter().all(|one| valid(across, one.across) && valid(down, one.down)) {
            let list: Vec<String> = components.iter().map(|one| format!("{}x{}", one.across, one.down)).collect();
            return refuse(format!("sampling {}", list.join(",")));
        }
        // Every block of 8 x 8 samples of the first component takes a bit or more.
        let size = Dimensions::check("JPEG", width.into(), height.into(), bytes, 8 * 64, limits)?;
        let (across, down) = (components[0].across, components[0].down);
        Ok(Self { progressive, refines: false, size, components, across, down })
    }

    /// Blocks of a component: those of whole units, or those that the picture needs.
    fn units(&self) -> usize {
        (self.size.width as usize).div_ceil(8 * self.across) * (self.size.height as usize).div_ceil(8 * self.down)
    }

    fn coefficients(&self) -> usize {
        let blocks: usize = self.components.iter().map(|one| one.across * one.down).sum();
        64 * self.units() * blocks
    }

    /// Reads a scan header (B.2.3) and notes what the scan sends. Each bit is sent once, from the highest down
    /// (G.1.1.1.2), so that scans are few. Returns the number of interleaved units, or of blocks if there is one
    /// component.
    fn begin_scan(&mut self, header: &[u8]) -> Result<usize, DecodeError> {
        let Some((&count, rest)) = header.split_first() else { return Err(broken("a scan header")) };
        let (selectors, band) = rest.split_at_checked(2 * usize::from(count)).ok_or(broken("a scan header"))?;
        let &[first, last, bits] = band else { return Err(broken("a scan header")) };
        let (high, low) = (bits >> 4, bits & 15);
        if !self.progressive && usize::from(count) != self.components.len() {
            return refuse("its components in several scans");
        }
        let (first, last, high, low) = if self.progressive { (first, last, high, low) } else { (0, 63, 0, 0) };
        if first > last || last > 63 || low > 13 || (self.progressive && first == 0 && last > 0) {
            return Err(broken("a band of coefficients that no scan can have"));
        }
        if high > 0 && high != low + 1 || first > 0 && count != 1 {
            return Err(broken("a scan out of turn"));
        }
        for selector in selectors.as_chunks::<2>().0 {
            let component = self.components.iter_mut().find(|component| component.id == selector[0]);
            let component = component.ok_or_else(|| broken("a scan of a component that is not there"))?;
            for sent in &mut component.sent[usize::from(first)..=usize::from(last)] {
                if *sent != (high > 0).then_some(high) {
                    return Err(broken("a scan out of turn"));
                }
                *sent = Some(low);
            }
        }
        self.refines |= high > 0;
        let mut units = self.units();
        if let [id, _] = *selectors {
            let one = self.components.iter().find(|component| component.id == id).map(|one| (one.across, one.down));
            let (x, y) = one.unwrap_or((1, 1));
            let (width, height) = (self.size.width as usize, self.size.height as usize);
            units = (width * x).div_ceil(8 * self.across) * (height * y).div_ceil(8 * self.down);
        }
        Ok(units)
    }
}
