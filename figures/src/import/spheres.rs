//! Spheres as they come from a file: the options for reading them, their colours, each once, and notes on their names.

use std::collections::HashMap;

use foldhash::fast::RandomState;
use glam::DVec3;
use rt_geom::Sphere;

use super::elements;
use super::problem::{FileProblem, ImportError, LineProblem};
use crate::scene::{LookIndex, Scene};
use crate::text::quoted;

/// How a file's spheres are taken.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Positions and radii are multiplied by this; finite and more than 0.
    pub scale: f64,
    /// The radius of spheres without a radius column, in place of their elements' radii; before scaling.
    pub radius: Option<f64>,
    /// Whether colours are wanted; if not, all spheres have the same.
    pub colored: bool,
    /// The frame of a trajectory, or the model of a PDB file, counted from 1.
    pub frame: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self { scale: 1.0, radius: None, colored: true, frame: 1 }
    }
}

/// The spheres of a file, each with its colour.
#[derive(Debug, Default)]
pub struct Spheres {
    /// The spheres, in the file's order.
    pub spheres: Vec<Sphere>,
    /// For each sphere, the position of its colour in `colors`.
    pub color_indices: Vec<u32>,
    /// The colours that occur, in order of appearance: each once, unless there are more than 65,536.
    pub colors: Vec<DVec3>,
    /// Names that are not symbols, and what is passed over.
    pub warnings: Vec<String>,
    /// Other frames, and what is drawn otherwise than the file says.
    pub notes: Vec<String>,
}

impl Spheres {
    /// Adds the spheres, read from the file called `name`, to a scene: all with one look, or each in its own colour.
    ///
    /// # Errors
    /// More colours than can be numbered; the spheres are not added then.
    pub fn add_to(self, scene: &mut Scene, look: Option<LookIndex>, name: &str) -> Result<(), ImportError> {
        let Self { spheres, color_indices, colors, warnings, notes } = self;
        scene.warnings.extend(warnings.into_iter().map(|warning| format!("{name}: {warning}")));
        scene.notes.extend(notes.into_iter().map(|note| format!("{name}: {note}")));
        let first = scene.colors.len();
        let own = |index: u32| LookIndex::color(first + index as usize);
        let looks: Option<Vec<_>> = color_indices.into_iter().map(|index| look.or_else(|| own(index))).collect();
        let looks = looks.ok_or(FileProblem::TooManyColors)?;
        if look.is_none() {
            append(&mut scene.colors, colors);
        }
        append(&mut scene.spheres, spheres);
        append(&mut scene.sphere_looks, looks);
        Ok(())
    }
}

/// Adds a list to another, without a copy if that one is empty.
pub(super) fn append<T>(list: &mut Vec<T>, more: Vec<T>) {
    if list.is_empty() { *list = more } else { list.extend(more) }
}

/// Names that are no plain symbols, each once, with what they were taken for: some of them.
#[derive(Default)]
pub(super) struct Names(pub(super) Vec<(Vec<u8>, u8)>);

impl Names {
    /// How many are listed in the note.
    const TOLD: usize = 8;

    /// Remembers a name. One more than is listed is enough, here and in each piece of a file, so that the list does not
    /// depend on how the file is cut.
    pub(super) fn add(&mut self, name: &[u8], element: u8) {
        if self.0.len() <= Self::TOLD && !self.0.iter().any(|(known, _)| known == name) {
            self.0.push((name.to_vec(), element));
        }
    }

    pub(super) fn note(&self) -> Option<String> {
        let told = self.0.iter().take(Self::TOLD).map(|(name, element)| {
            format!("{} as {}", quoted(&String::from_utf8_lossy(name)), elements::symbol(*element))
        });
        let told = told.collect::<Vec<_>>().join(", ");
        let more = if self.0.len() > Self::TOLD { " and more" } else { "" };
        (!told.is_empty()).then(|| format!("names are read by their letters: {told}{more}"))
    }
}

/// What decides an atom's colour.
#[derive(Clone, Copy)]
pub(super) enum AtomColor {
    Element(u8),
    Color(DVec3),
    Nothing,
}

/// This many colours are deduplicated. A file with more has about one for each sphere; storing 24 bytes is then cheaper
/// than a look-up.
pub(super) const REMEMBERED: usize = 1 << 16;

/// The indices of the colours so far.
pub(super) struct Palette {
    elements: [Option<u32>; 256],
    colors: HashMap<[u64; 3], u32, RandomState>,
    /// The last colour and its number: neighbours in a file are often of one colour.
    last: Option<([u64; 3], u32)>,
}

impl Default for Palette {
    fn default() -> Self {
        Self { elements: [None; 256], colors: HashMap::default(), last: None }
    }
}

impl Palette {
    #[inline]
    pub(super) fn index(&mut self, paint: AtomColor, colors: &mut Vec<DVec3>) -> Result<u32, LineProblem> {
        let color = match paint {
            AtomColor::Element(element) => match self.elements[usize::from(element)] {
                Some(index) => return Ok(index),
                None => elements::color(element),
            },
            AtomColor::Color(color) => color,
            AtomColor::Nothing => DVec3::splat(0.8),
        };
        let bits = color.to_array().map(f64::to_bits);
        if let Some((_, index)) = self.last.filter(|(last, _)| *last == bits) {
            return Ok(index);
        }
        let index = match self.colors.get(&bits) {
            Some(&index) => index,
            None => {
                let next = u32::try_from(colors.len()).ok().filter(|&next| next < LookIndex::MOST);
                let next = next.ok_or(LineProblem::TooManyColors)?;
                colors.push(color);
                if self.colors.len() < REMEMBERED {
                    self.colors.insert(bits, next);
                }
                next
            }
        };
        if let AtomColor::Element(element) = paint {
            self.elements[usize::from(element)] = Some(index);
        }
        self.last = Some((bits, index));
        Ok(index)
    }
}
