//! The results of one run.

use serde::{Deserialize, Serialize};

use super::kernels::kernels;
use super::machine::Machine;
use super::measure::{Effort, Kernel};
use super::pictures::{Pictured, pictures};
use super::trees::{Growth, growth};

/// All that one run measured, and where.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Report {
    pub(super) machine: Machine,
    pub(super) effort: Effort,
    pub(super) kernels: Vec<Kernel>,
    pub(super) trees: Vec<Growth>,
    pub(super) pictures: Vec<Pictured>,
}

impl Report {
    /// Measures everything.
    pub(super) fn measure(effort: Effort) -> Self {
        // Asked before the work, which is load itself.
        let machine = Machine::this();
        Self { machine, effort, kernels: kernels(effort), trees: growth(effort), pictures: pictures(effort) }
    }
}
