#!/usr/bin/env bash
# The report: a quick run must find the very errors that are stored, text and plots must follow from the JSON alone, and the
# committed report must be what its JSON says. Times are not compared.
# Where errors change on purpose, renew: cargo run --release -p report -- --quick --out DIR; cp DIR/report.json docs/report/quick.json
set -euo pipefail
cd "$(dirname "$0")/.."

# Times do not matter here: compiled in parallel.
export CARGO_PROFILE_RELEASE_CODEGEN_UNITS=16

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
report() { cargo run --release --quiet -p report -- "$@"; }

report --quick --out "$work/quick"
report --from "$work/quick/report.json" --out "$work/again"
diff -r "$work/quick" "$work/again"

report --quick --check docs/report/quick.json

report --from docs/report/report.json --out "$work/committed"
for file in "$work"/committed/*; do
    cmp "$file" "docs/report/$(basename "$file")"
done
echo "errors are those of docs/report/quick.json"
