//! JPEG: baseline, extended and progressive Huffman coding, 8 bits, grey or three components of any whole sampling ratio.
//!
//! The samples are those of libjpeg-turbo as `djpeg` runs it: the same integer transform, the same "fancy" upsampling
//! where a component has half the columns, rows or both (repetition for every other ratio), the same colour
//! conversion. Unlike libjpeg, which fills up what is missing with a warning, a file that ends early or breaks the rules
//! of its coding is an error.
//!
//! A sequential file gives each block of coefficients once: it is transformed at once into its component's plane. A
//! progressive one sends a block in many scans, so that all coefficients are kept to the end.
//!
//! Source: ITU-T T.81 (1992); section numbers below are its own. T.871 (JFIF) for the colours.

mod color;
mod huffman;
mod idct;
mod scan;

use crate::Limits;
use crate::decode::{DecodeError, Decoded, Size};
use crate::pixmap::{Pixmap, Samples};
use huffman::Table;
use idct::Plane;

/// One component of the frame.
struct Component {
    id: u8,
    /// Sampling factors: blocks in an interleaved unit, across and down.
    across: usize,
    down: usize,
    quantization: usize,
    /// The table that was in force when the component's first scan began (B.2.4.1).
    steps: Option<[u16; 64]>,
    plane: Plane,
    /// Blocks of a row, in zigzag order; a progressive file alone has them.
    coefficients: Vec<[i16; 64]>,
    /// The lowest bit that has been sent of each coefficient, `None` before the first: 0 when it is complete.
    sent: [Option<u8>; 64],
}

/// The frame header and what the scans have filled so far.
struct Frame {
    progressive: bool,
    width: usize,
    height: usize,
    size: Size,
    components: Vec<Component>,
    /// Largest sampling factors.
    across: usize,
    down: usize,
}

/// What the marker segments set up for later ones.
#[derive(Default)]
struct Tables {
    quantization: [Option<[u16; 64]>; 4],
    dc: [Option<Box<Table>>; 4],
    ac: [Option<Box<Table>>; 4],
    restart_interval: usize,
    jfif: bool,
    /// The byte of Adobe's segment that tells the colours.
    adobe_transform: Option<u8>,
}

fn broken(what: impl Into<String>) -> DecodeError {
    DecodeError::broken("JPEG", what.into())
}

fn refuse<T>(what: impl Into<String>) -> Result<T, DecodeError> {
    Err(DecodeError::Kind { format: "JPEG", what: what.into() })
}

const ENDS: DecodeError = DecodeError::Truncated { format: "JPEG" };

/// Decodes the first picture of a file that begins with a JPEG's marker.
pub(super) fn decode(bytes: &[u8], limits: &Limits) -> Result<Decoded, DecodeError> {
    let mut tables = Tables::default();
    let mut frame: Option<Frame> = None;
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
        let length =
            usize::from(u16::from_be_bytes(*bytes.get(at..).and_then(<[u8]>::first_chunk).ok_or(ENDS)?));
        let segment = bytes.get(at + 2..at + length).ok_or(if length < 2 {
            broken("a segment without a length")
        } else {
            ENDS
        })?;
        at += length;
        match marker {
            0xc0..=0xc2 if frame.is_some() => return Err(broken("a second frame header")),
            0xc0..=0xc2 => frame = Some(Frame::new(marker == 0xc2, segment, bytes, limits)?),
            0xc3 => return refuse("lossless coding"),
            0xc9 | 0xca => return refuse("arithmetic coding"),
            0xcb => return refuse("lossless arithmetic coding"),
            0xc5..=0xc7 | 0xcd..=0xcf | 0xde | 0xdf => return refuse("hierarchical coding"),
            0xc4 => tables.set_huffman(segment)?,
            0xdb => tables.set_quantization(segment)?,
            0xdd => {
                let &interval =
                    segment.first_chunk().ok_or_else(|| broken("a restart interval without a value"))?;
                tables.restart_interval = u16::from_be_bytes(interval).into();
            }
            0xda => {
                let frame = frame.as_mut().ok_or_else(|| broken("a scan before the frame header"))?;
                at = scan::read(frame, &tables, segment, bytes, at)?;
            }
            0xe0 => tables.jfif |= segment.starts_with(b"JFIF\0"),
            0xee if segment.starts_with(b"Adobe") => tables.adobe_transform = segment.get(11).copied(),
            _ => {}
        }
    }
    let mut frame = frame.ok_or(ENDS)?;
    // Scans that are missing altogether.
    if frame.components.iter().any(|component| component.sent != [Some(0); 64]) {
        return Err(ENDS);
    }
    frame.transform()?;
    let pixmap = frame.into_pixmap(&tables)?;
    Ok(Decoded { pixmap, transparent: false })
}

/// The next marker at or behind `at`, which is left behind it. Bytes before it are passed over, as by libjpeg.
fn next_marker(bytes: &[u8], at: &mut usize) -> Option<u8> {
    *at += bytes.get(*at..)?.iter().position(|&byte| byte == 0xff)?;
    // Any number of 0xff may stand before a marker.
    *at += bytes.get(*at..)?.iter().position(|&byte| byte != 0xff)?;
    *at += 1;
    Some(bytes[*at - 1])
}

impl Tables {
    /// Section B.2.4.1.
    fn set_quantization(&mut self, mut segment: &[u8]) -> Result<(), DecodeError> {
        let short = || broken("a quantization table ends early");
        while let Some((&head, rest)) = segment.split_first() {
            let steps = match head >> 4 {
                0 => {
                    let (steps, rest) = rest.split_first_chunk::<64>().ok_or_else(short)?;
                    segment = rest;
                    steps.map(u16::from)
                }
                1 => {
                    let (steps, rest) = rest.split_first_chunk::<128>().ok_or_else(short)?;
                    segment = rest;
                    let mut pairs = steps.as_chunks().0.iter();
                    [(); 64].map(|()| pairs.next().map_or(0, |&pair| u16::from_be_bytes(pair)))
                }
                _ => return Err(broken("a quantization table of neither 8 nor 16 bits")),
            };
            let slot = self.quantization.get_mut(usize::from(head & 15));
            *slot.ok_or_else(|| broken("a quantization table beyond the fourth"))? = Some(steps);
        }
        Ok(())
    }

    /// Section B.2.4.2.
    fn set_huffman(&mut self, mut segment: &[u8]) -> Result<(), DecodeError> {
        let short = || broken("a Huffman table ends early");
        while let Some((&head, rest)) = segment.split_first() {
            let (counts, rest) = rest.split_first_chunk::<16>().ok_or_else(short)?;
            let length = counts.iter().map(|&count| usize::from(count)).sum();
            let (values, rest) = rest.split_at_checked(length).ok_or_else(short)?;
            segment = rest;
            let tables = match head >> 4 {
                0 => &mut self.dc,
                1 => &mut self.ac,
                _ => return Err(broken("a Huffman table of neither kind")),
            };
            let slot = tables.get_mut(usize::from(head & 15));
            let slot = slot.ok_or_else(|| broken("a Huffman table beyond the fourth"))?;
            let table =
                Table::new(counts, values).ok_or_else(|| broken("a Huffman table with too many codes"))?;
            *slot = Some(Box::new(table));
        }
        Ok(())
    }
}

impl Frame {
    /// Reads the frame header (B.2.2), judges it, and makes room for what it promises.
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
        let specified =
            specified.get(..usize::from(count)).ok_or_else(|| broken("a frame header ends early"))?;
        let factors: Vec<(usize, usize)> = specified
            .iter()
            .map(|&[_, factors, _]| (usize::from(factors >> 4), usize::from(factors & 15)))
            .collect();
        let across = factors.iter().map(|factor| factor.0).max().unwrap_or(0);
        let down = factors.iter().map(|factor| factor.1).max().unwrap_or(0);
        let valid = |most: usize, factor: usize| (1..=4).contains(&factor) && most.is_multiple_of(factor);
        if !factors.iter().all(|&(x, y)| valid(across, x) && valid(down, y)) {
            let list: Vec<String> = factors.iter().map(|(x, y)| format!("{x}x{y}")).collect();
            return refuse(format!("sampling {}", list.join(",")));
        }
        // Every block of 8 x 8 samples takes a bit or more. The fewest blocks for an area: one component has a quarter of
        // the rows, one a quarter of the columns, one of both, that is 4 + 4 + 1 blocks for 32 x 32 pixels.
        let size = Size::check("JPEG", width.into(), height.into(), bytes, 8 * 32 * 32 / 9 + 1, limits)?;

        let (width, height) = (usize::from(width), usize::from(height));
        let units = (width.div_ceil(8 * across), height.div_ceil(8 * down));
        let mut components = Vec::new();
        for (&[id, _, quantization], (x, y)) in specified.iter().zip(factors) {
            let blocks = (units.0 * x, units.1 * y);
            components.push(Component {
                id,
                across: x,
                down: y,
                quantization: quantization.into(),
                steps: None,
                plane: Plane {
                    width: (width * x).div_ceil(across),
                    height: (height * y).div_ceil(down),
                    stride: 8 * blocks.0,
                    samples: size.filled(64 * blocks.0 * blocks.1, 0)?,
                },
                coefficients: size.filled(if progressive { blocks.0 * blocks.1 } else { 0 }, [0; 64])?,
                sent: [None; 64],
            });
        }
        Ok(Self { progressive, width, height, size, components, across, down })
    }

    /// Turns the coefficients of a progressive file, now complete, into samples.
    fn transform(&mut self) -> Result<(), DecodeError> {
        for component in &mut self.components {
            let steps = component.steps.as_ref().ok_or_else(|| broken("a component without a scan"))?;
            let columns = component.plane.stride / 8;
            for (index, block) in component.coefficients.iter().enumerate() {
                component.plane.set_block(index % columns, index / columns, &block.map(i32::from), steps);
            }
            component.coefficients = Vec::new();
        }
        Ok(())
    }

    fn into_pixmap(mut self, tables: &Tables) -> Result<Pixmap, DecodeError> {
        let samples = match &mut self.components[..] {
            [grey] => {
                // The largest factors are its own, so that the plane is the picture, but for what fills its blocks up.
                let Plane { stride, samples, .. } = &mut grey.plane;
                for row in 1..self.height {
                    samples.copy_within(row * *stride..row * *stride + self.width, row * self.width);
                }
                samples.truncate(self.width * self.height);
                std::mem::take(samples)
            }
            components => {
                let mut samples = self.size.room(3 * self.width * self.height)?;
                let is_rgb = tables.is_rgb(components);
                // Each component repeats its samples up to a whole unit.
                let mut rows = [(); 3].map(|()| vec![0; self.width.next_multiple_of(8 * self.across)]);
                for y in 0..self.height {
                    for (component, row) in components.iter().zip(&mut rows) {
                        let ratio = (self.across / component.across, self.down / component.down);
                        color::upsample(&component.plane, y, ratio, row);
                    }
                    let [a, b, c] = &rows;
                    let pixels = a.iter().zip(b).zip(c).take(self.width);
                    if is_rgb {
                        samples.extend(pixels.flat_map(|((&a, &b), &c)| [a, b, c]));
                    } else {
                        samples.extend(pixels.flat_map(|((&a, &b), &c)| color::ycc_to_rgb(a, b, c)));
                    }
                }
                samples
            }
        };
        let pixmap = Pixmap::from_checked(self.width, self.height, 255, Samples::Eight(samples));
        pixmap.ok_or(broken("no pixels"))
    }
}

impl Tables {
    /// Whether three components are red, green and blue and not luma and chroma: libjpeg's rule, for files that leave it open.
    fn is_rgb(&self, components: &[Component]) -> bool {
        match self.adobe_transform {
            _ if self.jfif => false,
            Some(transform) => transform == 0,
            None => components.iter().map(|component| component.id).eq(*b"RGB"),
        }
    }
}
