//! Image files made by hand.

/// A tag of a TIFF and its values.
pub type Tag<'a> = (u16, &'a [u16]);

/// A TIFF of one strip that holds `raster`, with these tags besides the strip's own; values are 16-bit numbers.
#[must_use]
pub fn tiff(tags: &[Tag<'_>], raster: &[u8]) -> Vec<u8> {
    tiff_in_chunks(tags, &[raster], [273, 279])
}

/// A TIFF whose chunks, strips or tiles, have their offsets and lengths under these tags.
#[must_use]
pub fn tiff_in_chunks(tags: &[Tag<'_>], chunks: &[&[u8]], [offsets, lengths]: [u16; 2]) -> Vec<u8> {
    let raster = chunks.concat();
    let mut entries: Vec<(u16, u16, Vec<u8>)> = Vec::new(); // tag, type, value
    for (tag, values) in tags {
        entries.push((*tag, 3, values.iter().flat_map(|value| value.to_le_bytes()).collect()));
    }
    let long = |value: usize| u32::try_from(value).unwrap().to_le_bytes();
    let mut at = 8;
    let (mut places, mut sizes) = (Vec::new(), Vec::new());
    for chunk in chunks {
        places.extend(long(at));
        sizes.extend(long(chunk.len()));
        at += chunk.len();
    }
    entries.extend([(offsets, 4, places), (lengths, 4, sizes)]);
    entries.sort();

    let directory = (8 + raster.len()).next_multiple_of(2);
    let mut bytes = [b"II*\0", &long(directory)[..], &raster].concat();
    bytes.resize(directory, 0);
    let mut beyond = directory + 2 + 12 * entries.len() + 4;
    bytes.extend(u16::try_from(entries.len()).unwrap().to_le_bytes());
    for (tag, kind, value) in &entries {
        bytes.extend(tag.to_le_bytes());
        bytes.extend(kind.to_le_bytes());
        bytes.extend(long(value.len() / if *kind == 3 { 2 } else { 4 }));
        if value.len() <= 4 {
            bytes.extend(value);
            bytes.resize(bytes.len() + 4 - value.len(), 0);
        } else {
            bytes.extend(long(beyond));
            beyond += value.len();
        }
    }
    bytes.extend([0; 4]);
    for (_, _, value) in entries.iter().filter(|(_, _, value)| value.len() > 4) {
        bytes.extend(value);
    }
    bytes
}

/// A JPEG whose coefficients are all zero: one code of one bit stands for nothing, be it a difference or the end of a
/// block.
#[must_use]
pub fn black_jpeg([width, height]: [u16; 2], progressive: bool, grey: bool) -> Vec<u8> {
    let ids: &[u8] = if grey { &[1] } else { &[1, 2, 3] };
    let count = if grey { 1 } else { 3 };
    let size = [height.to_be_bytes(), width.to_be_bytes()].concat();
    let length = |data: usize| u16::try_from(data + 2).unwrap().to_be_bytes();
    let mut bytes = vec![0xff, 0xd8];
    let mut segment = |marker: u8, data: &[u8]| {
        bytes.extend([0xff, marker]);
        bytes.extend(length(data.len()));
        bytes.extend(data);
    };
    segment(0xdb, &[&[0], &[1; 64][..]].concat());
    let table: Vec<u8> = [&[1][..], &[0; 15], &[0]].concat();
    segment(0xc4, &[&[0x00][..], &table, &[0x10], &table].concat());
    let components: Vec<u8> = ids.iter().flat_map(|&id| [id, 0x11, 0]).collect();
    segment(if progressive { 0xc2 } else { 0xc0 }, &[&[8][..], &size, &[count], &components].concat());
    let blocks = usize::from(width.div_ceil(8)) * usize::from(height.div_ceil(8));
    let mut scan = |ids: &[u8], band: [u8; 3], bits: usize| {
        let selectors: Vec<u8> = ids.iter().flat_map(|&id| [id, 0]).collect();
        let data = [&[u8::from(ids.len() > 1) * 2 + 1][..], &selectors, &band].concat();
        bytes.extend([0xff, 0xda]);
        bytes.extend(length(data.len()));
        bytes.extend(data);
        bytes.extend(vec![0; bits.div_ceil(8)]);
    };
    if progressive {
        scan(ids, [0, 0, 0], blocks * ids.len());
        for &id in ids {
            scan(&[id], [1, 63, 0], blocks);
        }
    } else {
        scan(ids, [0, 63, 0], 2 * blocks * ids.len());
    }
    bytes.extend([0xff, 0xd9]);
    bytes
}

/// The checksum of a PNG's chunk.
#[must_use]
pub fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0_u32, |crc, byte| {
        let step = |crc: u32, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 };
        (0..8).fold(crc ^ u32::from(*byte), step)
    })
}

#[test]
fn the_checksum_is_that_of_png() {
    assert_eq!(crc32(b"IEND"), 0xae42_6082);
}
