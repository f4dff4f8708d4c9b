//! One scan: its header, and the coefficients that its bits give or refine.

use super::huffman::{Bits, Table};
use super::{Frame, Tables, broken, refuse};
use crate::decode::DecodeError;

/// The part of a scan that belongs to one component.
struct Part<'a> {
    component: usize,
    dc: Option<&'a Table>,
    ac: Option<&'a Table>,
    /// The last constant coefficient; each is coded by its difference (F.1.1.5.1).
    predicted: i32,
}

/// Which bits of which coefficients a scan holds.
#[derive(Clone, Copy)]
struct Band {
    first: usize,
    last: usize,
    /// The lowest bit that was sent before; 0: none.
    high: u8,
    /// The lowest bit that is sent now.
    low: u8,
}

/// Reads the scan whose header is `segment` and whose data begin at `at`; returns where they end.
pub(super) fn read(
    frame: &mut Frame,
    tables: &Tables,
    segment: &[u8],
    bytes: &[u8],
    at: usize,
) -> Result<usize, DecodeError> {
    let (mut parts, band) = header(frame, tables, segment)?;
    begin(frame, tables, &parts, band)?;

    // A scan of one component goes block by block, one of several unit by unit (A.2).
    let (columns, rows) = match &parts[..] {
        [part] => {
            let plane = &frame.components[part.component].plane;
            (plane.width.div_ceil(8), plane.height.div_ceil(8))
        }
        _ => (frame.width.div_ceil(8 * frame.across), frame.height.div_ceil(8 * frame.down)),
    };
    let mut bits = Bits::new(bytes, at);
    let mut run = 0_u16;
    for unit in 0..columns * rows {
        let interval = tables.restart_interval;
        if interval > 0 && unit > 0 && unit % interval == 0 {
            bits.restart(unit / interval - 1)?;
            run = 0;
            parts.iter_mut().for_each(|part| part.predicted = 0);
        }
        let (column, row) = (unit % columns, unit / columns);
        let alone = parts.len() == 1;
        for part in &mut parts {
            let component = &mut frame.components[part.component];
            let (across, down) = if alone { (1, 1) } else { (component.across, component.down) };
            for block in 0..across * down {
                let (x, y) = (column * across + block % across, row * down + block / across);
                if frame.progressive {
                    let index = y * (component.plane.stride / 8) + x;
                    let block = &mut component.coefficients[index];
                    match (band.first, band.high) {
                        (0, 0) => block[0] = shifted(part.next_dc(&mut bits)?, band.low)?,
                        (0, _) => block[0] |= i16::from(bits.take(1)? == 1) << band.low,
                        (_, 0) => part.first_ac(&mut bits, block, band, &mut run)?,
                        (_, _) => part.refine_ac(&mut bits, block, band, &mut run)?,
                    }
                } else {
                    let block = part.sequential(&mut bits)?;
                    let steps = component.steps.as_ref().ok_or_else(|| broken("no quantization table"))?;
                    component.plane.set_block(x, y, &block, steps);
                }
            }
        }
    }
    Ok(bits.position())
}

/// Section B.2.3.
fn header<'a>(
    frame: &Frame,
    tables: &'a Tables,
    segment: &[u8],
) -> Result<(Vec<Part<'a>>, Band), DecodeError> {
    let short = || broken("a scan header ends early");
    let (&count, rest) = segment.split_first().ok_or_else(short)?;
    let count = usize::from(count);
    let (selectors, rest) = rest.split_at_checked(2 * count).ok_or_else(short)?;
    let &[first, last, bits] = rest.first_chunk().ok_or_else(short)?;
    let mut parts: Vec<Part<'_>> = Vec::new();
    for &[id, slots] in selectors.as_chunks().0 {
        let component = frame.components.iter().position(|component| component.id == id);
        let component = component.ok_or_else(|| broken("a scan of a component that the frame has not"))?;
        if parts.iter().any(|part| part.component >= component) {
            return Err(broken("a scan whose components are out of order"));
        }
        let table = |tables: &'a [Option<Box<Table>>; 4], slot: u8| tables.get(usize::from(slot))?.as_deref();
        let (dc, ac) = (table(&tables.dc, slots >> 4), table(&tables.ac, slots & 15));
        parts.push(Part { component, dc, ac, predicted: 0 });
    }
    if parts.is_empty() {
        return Err(broken("a scan without components"));
    }
    let blocks =
        parts.iter().map(|part| &frame.components[part.component]).map(|part| part.across * part.down);
    if parts.len() > 1 && blocks.sum::<usize>() > 10 {
        return Err(broken("a scan of more than ten blocks a unit"));
    }
    if !frame.progressive {
        // The other fields mean nothing here; some writers leave them 0.
        return Ok((parts, Band { first: 0, last: 63, high: 0, low: 0 }));
    }
    let band = Band { first: first.into(), last: last.into(), high: bits >> 4, low: bits & 15 };
    let dc = band.first == 0 && band.last == 0;
    let ac = parts.len() == 1 && (1..=63).contains(&band.first) && (band.first..=63).contains(&band.last);
    // 8-bit samples have coefficients of 11 bits and a sign (F.1.1.4).
    if !(dc || ac) || band.low > 13 || (band.high > 0 && band.high != band.low + 1) {
        return Err(broken("a scan of coefficients that cannot be"));
    }
    Ok((parts, band))
}

/// Notes what the scan sends. Each bit is sent once, from the highest down (G.1.1.1.2), so that scans are few.
fn begin(frame: &mut Frame, tables: &Tables, parts: &[Part<'_>], band: Band) -> Result<(), DecodeError> {
    for part in parts {
        let component = &mut frame.components[part.component];
        if component.steps.is_none() {
            let steps = tables.quantization.get(component.quantization);
            component.steps = steps.copied().flatten();
            if component.steps.is_none() {
                return Err(broken("a component without its quantization table"));
            }
        }
        for sent in &mut component.sent[band.first..=band.last] {
            if *sent != (band.high > 0).then_some(band.high) {
                return refuse("scans out of order");
            }
            *sent = Some(band.low);
        }
    }
    Ok(())
}

/// `value` times `2^low`, if a coefficient can be that large.
fn shifted(value: i32, low: u8) -> Result<i16, DecodeError> {
    i16::try_from(value << low).map_err(|_| broken("a coefficient beyond 16 bits"))
}

impl Part<'_> {
    fn ac(&self) -> Result<&Table, DecodeError> {
        self.ac.ok_or_else(|| broken("a scan without its Huffman table"))
    }

    /// The next constant coefficient (F.2.2.1).
    fn next_dc(&mut self, bits: &mut Bits<'_>) -> Result<i32, DecodeError> {
        let size = bits.decode(self.dc.ok_or_else(|| broken("a scan without its Huffman table"))?)?;
        if size > 15 {
            return Err(broken("a coefficient beyond 16 bits"));
        }
        self.predicted += bits.signed(size)?;
        shifted(self.predicted, 0)?;
        Ok(self.predicted)
    }

    /// A whole block, in zigzag order (F.2.2).
    fn sequential(&mut self, bits: &mut Bits<'_>) -> Result<[i32; 64], DecodeError> {
        let mut block = [0; 64];
        block[0] = self.next_dc(bits)?;
        let table = self.ac()?;
        let mut at = 1;
        while at < 64 {
            let code = bits.decode(table)?;
            let (zeros, size) = (usize::from(code >> 4), code & 15);
            match (zeros, size) {
                (15, 0) => at += 16,
                (_, 0) => break,
                _ => {
                    at += zeros;
                    *block.get_mut(at).ok_or_else(|| broken("a run beyond its block"))? =
                        bits.signed(size)?;
                    at += 1;
                }
            }
        }
        Ok(block)
    }

    /// The first bits of a band (G.1.2.2). `run` counts the blocks to come of which the rest is zero.
    fn first_ac(
        &self,
        bits: &mut Bits<'_>,
        block: &mut [i16; 64],
        band: Band,
        run: &mut u16,
    ) -> Result<(), DecodeError> {
        if *run > 0 {
            *run -= 1;
            return Ok(());
        }
        let table = self.ac()?;
        let mut at = band.first;
        while at <= band.last {
            let code = bits.decode(table)?;
            let (zeros, size) = (code >> 4, code & 15);
            match (zeros, size) {
                (15, 0) => at += 16,
                (_, 0) => {
                    *run = (1 << zeros) - 1 + bits.take(zeros.into())?;
                    break;
                }
                _ => {
                    at += usize::from(zeros);
                    if at > band.last {
                        return Err(broken("a run beyond its band"));
                    }
                    block[at] = shifted(bits.signed(size)?, band.low)?;
                    at += 1;
                }
            }
        }
        Ok(())
    }

    /// One more bit of each coefficient of a band (G.1.2.3): those that are not zero yet, in passing, by a bit of their own;
    /// new ones, of either sign, behind a run of those that stay zero.
    fn refine_ac(
        &self,
        bits: &mut Bits<'_>,
        block: &mut [i16; 64],
        band: Band,
        run: &mut u16,
    ) -> Result<(), DecodeError> {
        let one = 1_i16 << band.low;
        let table = self.ac()?;
        let mut at = band.first;
        while *run == 0 && at <= band.last {
            let code = bits.decode(table)?;
            let (mut zeros, size) = (code >> 4, code & 15);
            let value = match (zeros, size) {
                (15, 0) => 0,
                (_, 0) => {
                    *run = (1 << zeros) + bits.take(zeros.into())?;
                    break;
                }
                (_, 1) => {
                    if bits.take(1)? == 1 {
                        one
                    } else {
                        -one
                    }
                }
                _ => return Err(broken("a coefficient that grows by more than a bit")),
            };
            while at <= band.last {
                if block[at] != 0 {
                    refine(bits, &mut block[at], one)?;
                } else if zeros == 0 {
                    break;
                } else {
                    zeros -= 1;
                }
                at += 1;
            }
            if value != 0 {
                if at > band.last {
                    return Err(broken("a run beyond its band"));
                }
                block[at] = value;
            }
            at += 1;
        }
        if *run > 0 {
            *run -= 1;
            for coefficient in block.iter_mut().take(band.last + 1).skip(at).filter(|value| **value != 0) {
                refine(bits, coefficient, one)?;
            }
        }
        Ok(())
    }
}

/// Adds the next bit to a coefficient that is not zero, away from zero.
fn refine(bits: &mut Bits<'_>, coefficient: &mut i16, one: i16) -> Result<(), DecodeError> {
    if bits.take(1)? == 1 {
        let step = if *coefficient > 0 { one } else { -one };
        *coefficient = coefficient.checked_add(step).ok_or_else(|| broken("a coefficient beyond 16 bits"))?;
    }
    Ok(())
}
