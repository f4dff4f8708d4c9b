#!/usr/bin/env bash
# rt-math on its own: glam is all it needs, its package is complete, and a crate outside the workspace can use it.
set -euo pipefail
cd "$(dirname "$0")/.."

needed=$(cargo tree -p rt-math -e normal --depth 1 --prefix none | tail -n +2 | cut -d' ' -f1)
[ "$needed" = glam ] || { echo "rt-math must need glam alone, found: $needed" >&2; exit 1; }

cargo package -p rt-math --allow-dirty

target=$(cargo metadata --no-deps --format-version 1 | grep -o '"target_directory":"[^"]*"' | cut -d'"' -f4)
package=$(ls -d "$target"/package/rt-math-*/ | tail -n 1)
crate=$(mktemp -d)
trap 'rm -rf "$crate"' EXIT
mkdir "$crate/src"
cat > "$crate/Cargo.toml" <<TOML
[package]
name = "outsider"
edition = "2024"

[dependencies]
rt-math = { path = "$package" }
glam = { version = "0.34", default-features = false, features = ["std", "f64"] }

[workspace]
TOML
cp Cargo.lock "$crate/"
cat > "$crate/src/main.rs" <<'RUST'
use glam::{DMat3, DVec3};
use rt_math::{Roots, pseudo_inverse, reflect, solve_quadratic};

fn main() {
    assert_eq!(solve_quadratic(1.0, -3.0, 2.0), Roots::Two(1.0, 2.0));
    assert_eq!(reflect(DVec3::new(1.0, -1.0, 0.0), DVec3::Y), DVec3::new(1.0, 1.0, 0.0));
    assert_eq!(pseudo_inverse(DMat3::from_diagonal(DVec3::new(2.0, 4.0, 0.0))).rank, 2);
    println!("rt-math works alone");
}
RUST
(cd "$crate" && CARGO_TARGET_DIR="$target/outsider" cargo run --quiet)
