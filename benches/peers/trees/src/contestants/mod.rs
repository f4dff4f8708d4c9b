use crate::Contestant;

pub mod embree;
mod obvhs;
pub mod ours;

pub use embree::describe as describe_embree;

/// Contestants marked `slow` trace every seventh ray (prime to every tile and stride used here).
pub const THIN: usize = 7;

/// Everything that takes part, in the order of the tables.
pub fn all() -> Vec<Contestant> {
    let mut all = ours::contestants();
    all.extend(embree::contestants());
    all.extend(obvhs::contestants());
    all
}
