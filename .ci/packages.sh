#!/usr/bin/env bash
# The crates as others take them: few packages each, complete, and of use to a crate outside the workspace.
set -euo pipefail
cd "$(dirname "$0")/.."
crates="rt-math rt-geom rt-shade rt-io"

# weigh MOST CRATE [FLAGS]: a crate and all that it needs are at most that many packages.
weigh() {
    local most=$1 crate=$2 found
    shift
    found=$(cargo tree -p "$@" -e normal --prefix none --no-dedupe | cut -d' ' -f1,2 | sort -u)
    [ "$(wc -l <<<"$found")" -le "$most" ] || { printf '%s must be at most %s packages, found:\n%s\n' "$crate" "$most" "$found" >&2; exit 1; }
}
weigh 2 rt-math
weigh 10 rt-geom
weigh 4 rt-shade
weigh 5 rt-io --no-default-features

cargo clippy -p rt-io --no-default-features --all-targets -- -D warnings
RUSTDOCFLAGS="-D warnings" cargo doc -p rt-io --no-default-features --no-deps
cargo test -p rt-io --no-default-features

# All that `cargo publish --dry-run` does but ask the registry, and to build: that comes below.
# shellcheck disable=SC2046,SC2086
cargo package --allow-dirty --no-verify $(printf -- '-p %s ' $crates)

# The packages as a workspace of their own: their examples and the examples of their pages, without `oracle`.
target=$(cargo metadata --no-deps --format-version 1 | grep -o '"target_directory":"[^"]*"' | cut -d'"' -f4)
outside=$(mktemp -d)
trap 'rm -rf "$outside"' EXIT
cp Cargo.lock "$outside/"
printf '[workspace]\nresolver = "3"\nmembers = ["rt-*"]\n[patch.crates-io]\nrt-math.path = "rt-math"\n' > "$outside/Cargo.toml"
for crate in $crates; do
    mkdir "$outside/$crate"
    tar -xzf "$(ls -t "$target/package/$crate"-*.crate | head -n 1)" -C "$outside/$crate" --strip-components 1
    for file in LICENSE-MIT LICENSE-APACHE README.md; do
        [ -s "$outside/$crate/$file" ] || { echo "the package $crate lacks $file" >&2; exit 1; }
    done
    # A page of proofs that the code names is in the package; links are whole addresses or places in the same page.
    for page in $(grep -rhoE 'docs/[a-z-]+\.md' "$outside/$crate/src" "$outside/$crate/README.md" | sort -u); do
        [ -s "$outside/$crate/$page" ] || { echo "the package $crate lacks $page" >&2; exit 1; }
    done
    if grep -rnE '\]\([^)#h]' "$outside/$crate" --include=*.md; then
        echo "these links leave the package $crate" >&2
        exit 1
    fi
done
cd "$outside"
export CARGO_TARGET_DIR="$target/outside"
cargo test --quiet --workspace --doc
cargo test --quiet --workspace --examples
