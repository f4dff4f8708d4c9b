#!/bin/sh
# Usage: ./run.sh TARGET [libFuzzer options], e.g. ./run.sh ppm -runs=10000000
set -eu
cd "$(dirname "$0")"
target=$1
shift
# The coverage that libFuzzer steers by; the pass is part of stable LLVM. An explicit --target keeps these flags from
# build scripts and macros.
flags="-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
-Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
-Cllvm-args=-sanitizer-coverage-trace-compares -Ccodegen-units=1 --cfg fuzzing"
host=$(rustc -vV | sed -n 's/^host: //p')
RUSTFLAGS="${RUSTFLAGS-} $flags" cargo build --release --target "$host" --bin "$target"
mkdir -p "corpus/$target"
exec "target/$host/release/$target" "corpus/$target" "seeds/$target" \
    -rss_limit_mb=256 -timeout=10 -artifact_prefix="./$target-" "$@"
