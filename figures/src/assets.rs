//! The files that are part of the program.

/// The scene files of the six figures, in order.
pub(crate) const FIGURE_SCENES: [&str; 6] = [
    include_str!("../scenes/figure-1.toml"),
    include_str!("../scenes/figure-2.toml"),
    include_str!("../scenes/figure-3.toml"),
    include_str!("../scenes/figure-4.toml"),
    include_str!("../scenes/figure-5.toml"),
    include_str!("../scenes/figure-6.toml"),
];

/// Returns the bytes of the file that a figure's scene names, if it is part of the program.
pub(crate) fn asset(path: &str) -> Option<&'static [u8]> {
    (path == "../assets/earth-natural-720x360.png").then_some(include_bytes!("../assets/earth-natural-720x360.png"))
}
