//! The tables of the format, one to one: each value with its place in the text, nothing checked but its kind.

use std::collections::BTreeMap;
use std::fmt;
use std::marker::PhantomData;

use glam::DVec3;
use serde::de::{Deserialize, Deserializer, Error as _, SeqAccess, Visitor};
use toml::Spanned;

use crate::scene::Filter;

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneTable {
    #[serde(default)]
    pub(super) camera: Option<Spanned<CameraTable>>,
    #[serde(default)]
    pub(super) background: Option<VectorEntry>,
    #[serde(default)]
    pub(super) stage: Option<Spanned<bool>>,
    #[serde(default, deserialize_with = "tables")]
    pub(super) light: Vec<Spanned<LightTable>>,
    #[serde(default)]
    pub(super) material: BTreeMap<String, Spanned<MaterialTable>>,
    #[serde(default, deserialize_with = "tables")]
    pub(super) sphere: Vec<SphereTable>,
    #[serde(default, deserialize_with = "tables")]
    pub(super) spheres: Vec<SpheresTable>,
    #[serde(default, deserialize_with = "tables")]
    pub(super) triangle: Vec<Spanned<TriangleTable>>,
    #[serde(default, deserialize_with = "tables")]
    pub(super) mesh: Vec<MeshTable>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraTable {
    pub(super) eye: Option<VectorEntry>,
    pub(super) look_at: Option<VectorEntry>,
    pub(super) up: Option<VectorEntry>,
    pub(super) fov: Option<NumberEntry>,
    #[serde(default)]
    pub(super) fit: bool,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LightTable {
    pub(super) position: Option<VectorEntry>,
    pub(super) camera: Option<VectorEntry>,
    pub(super) color: Option<VectorEntry>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialTable {
    pub(super) color: Option<VectorEntry>,
    pub(super) texture: Option<Spanned<String>>,
    pub(super) mirrored: Option<Spanned<bool>>,
    pub(super) filter: Option<Spanned<Filter>>,
    pub(super) ambient: Option<NumberEntry>,
    pub(super) diffuse: Option<NumberEntry>,
    pub(super) specular: Option<NumberEntry>,
    pub(super) shininess: Option<NumberEntry>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SphereTable {
    pub(super) center: VectorEntry,
    pub(super) radius: NumberEntry,
    pub(super) material: Spanned<String>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SpheresTable {
    pub(super) file: Spanned<String>,
    pub(super) scale: Option<NumberEntry>,
    pub(super) radius: Option<NumberEntry>,
    pub(super) material: Option<Spanned<String>>,
    pub(super) frame: Option<Spanned<i64>>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TriangleTable {
    pub(super) a: VectorEntry,
    pub(super) b: VectorEntry,
    pub(super) c: VectorEntry,
    pub(super) material: Option<Spanned<String>>,
    pub(super) colors: Option<Spanned<Triple<VectorEntry>>>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MeshTable {
    pub(super) file: Spanned<String>,
    pub(super) material: Option<Spanned<String>>,
}

pub(super) type NumberEntry = Spanned<AnyNumber>;
pub(super) type VectorEntry = Spanned<Triple<AnyNumber>>;

/// A number, written as an integer or a float; not checked yet.
#[derive(Clone, Copy)]
pub(super) struct AnyNumber(pub(super) f64);

impl<'de> Deserialize<'de> for AnyNumber {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberVisitor;
        impl Visitor<'_> for NumberVisitor {
            type Value = AnyNumber;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number")
            }

            fn visit_f64<E>(self, value: f64) -> Result<AnyNumber, E> {
                Ok(AnyNumber(value))
            }

            fn visit_i64<E>(self, value: i64) -> Result<AnyNumber, E> {
                Ok(AnyNumber(value as f64)) // rounded to the nearest, as a float with these digits would be
            }
        }
        deserializer.deserialize_any(NumberVisitor)
    }
}

/// An array of exactly three values; what serde derives would ignore a fourth.
pub(super) struct Triple<T>(pub(super) [T; 3]);

impl Triple<AnyNumber> {
    pub(super) fn vector(&self) -> DVec3 {
        DVec3::from_array(self.0.each_ref().map(|number| number.0))
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Triple<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let expected = "an array of three";
        let found = deserializer.deserialize_any(List { expected, items: PhantomData })?;
        let length = found.len();
        found.try_into().map(Triple).map_err(|_| D::Error::invalid_length(length, &expected))
    }
}

/// Reads an array of tables, and says how to write one where there is something else.
fn tables<'de, T: Deserialize<'de>, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<T>, D::Error> {
    deserializer.deserialize_any(List { expected: "an array of tables, such as [[sphere]]", items: PhantomData })
}

/// Visits an array; anything else is an error that says what was expected.
struct List<T> {
    expected: &'static str,
    items: PhantomData<T>,
}

impl<'de, T: Deserialize<'de>> Visitor<'de> for List<T> {
    type Value = Vec<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.expected)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<Vec<T>, A::Error> {
        std::iter::from_fn(|| values.next_element().transpose()).collect()
    }
}
