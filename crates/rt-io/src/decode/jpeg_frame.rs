//! A JPEG's frame header: its size and its kind of coding, before a decoder sees it.

/// What a JPEG's frame header says.
pub(super) struct JpegFrame {
    /// The marker: which kind of coding.
    pub(super) process: u8,
    pub(super) precision: u8,
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) components: u8,
    /// Index of the byte behind it.
    pub(super) end: usize,
}

impl JpegFrame {
    /// Walks from segment to segment to the frame header; `None` if the bytes end before it.
    pub(super) fn new(bytes: &[u8]) -> Option<Self> {
        let mut at = 2;
        loop {
            // Any number of 0xff may stand before a marker.
            while *bytes.get(at)? != 0xff {
                at += 1;
            }
            while *bytes.get(at)? == 0xff {
                at += 1;
            }
            let marker = bytes[at];
            at += 1;
            if matches!(marker, 0x00 | 0x01 | 0xd0..=0xd8) {
                continue; // Markers without a segment.
            }
            let length = usize::from(u16::from_be_bytes(*bytes.get(at..)?.first_chunk()?));
            // Frame headers but for 0xc4, 0xc8, 0xcc, which are tables and a reserved one.
            if matches!(marker, 0xc0..=0xcf) && marker & 3 != 0 || marker == 0xc0 {
                let &[precision, h1, h0, w1, w0, components] = bytes.get(at + 2..)?.first_chunk()?;
                return Some(Self {
                    process: marker,
                    precision,
                    width: u16::from_be_bytes([w1, w0]).into(),
                    height: u16::from_be_bytes([h1, h0]).into(),
                    components,
                    end: (at + length).min(bytes.len()),
                });
            }
            at += length;
        }
    }
}
