#!/usr/bin/env bash
# What a user of the crates adds: few packages, and rt-io without its decoders.
set -euo pipefail
cd "$(dirname "$0")/.."

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
