#!/usr/bin/env bash
# The same bytes on other processors: tests and program on 64-bit Arm and on models of x86-64, emulated by QEMU. Compared
# with the processor that this runs on: the six figures (8 and 16 bits a sample), the hard scenes (16 bits), and the
# errors of a report with 32 cases a class, 1,000 spheres and pictures of 16 x 12 pixels. The tests, in the release
# profile as the program, compare with exact references; they run on Arm and on Nehalem, which has no FMA. Nothing is
# compared with stored files. The gate does not run this.
#
# Usage: .ci/by-hand/arm.sh [arm] [MODEL OF x86-64 ..] (default: Nehalem Haswell max arm). What is found goes to stdout,
# and is kept in docs/other-processors.txt. Needs an x86-64 Debian with rustup; the target of Rust and the packages are
# added where missing, the packages by root. On two cores of its own it takes an hour or more.
#
# LIMITS=3 makes all limits of time three times as long, for a machine that does other work, too. Steps that passed are
# not run again at the same commit until all have passed; they are kept in target/processors-COMMIT.
set -euo pipefail
cd "$(dirname "$0")/../.."

# Minutes that each step may take; one that takes longer has failed.
limits=${LIMITS:-1}
install=$((10 * limits)) build=$((40 * limits)) draw=$((10 * limits)) report=$((45 * limits)) test=$((20 * limits))
# Tests of these files run besides the unit tests of the three crates.
files=(pseudo_inverse pseudo_inverse_with_tolerance ray_sphere ray_triangle inside watertight)

[ "$(uname -m)" = x86_64 ] || { echo "pictures are compared with those of an x86-64 processor: none here" >&2; exit 1; }
target=${CARGO_TARGET_DIR:-target}
mkdir -p "$target"
target=$(cd "$target" && pwd)
commit=$(git describe --always --abbrev=12 --dirty --exclude='*')
work=$target/processors-$commit
case $commit in *-dirty) rm -rf "$work" ;; esac
mkdir -p "$work"
failed=0
within() { # MINUTES COMMAND ..: fails after that time
    timeout --kill-after=10 "$1m" "${@:2}"
}
judged() { # STEP MINUTES COMMAND ..: runs it, says how it ended, and counts what failed
    local started=$SECONDS code=0
    if [ -e "$work/$1.passed" ]; then cat "$work/$1.passed"; return; fi
    within "${@:2}" >"$work/step.log" 2>&1 || code=$?
    case $code in
        0) echo "$1: passed, $((SECONDS - started)) s" | tee "$work/$1.passed" ;;
        124 | 137) echo "$1: NOT DONE after $2 minutes"; failed=$((failed + 1)) ;;
        *) echo "$1: FAILED"; failed=$((failed + 1)); tail -n 40 "$work/step.log" >&2 ;;
    esac
}

packages=(qemu-user gcc-aarch64-linux-gnu libc6-dev-arm64-cross)
if ! dpkg-query -W "${packages[@]}" >/dev/null 2>&1; then
    [ "$(id -u)" = 0 ] || { echo "run once as root: QEMU and a linker for Arm are to be installed" >&2; exit 1; }
    export DEBIAN_FRONTEND=noninteractive
    within $install apt-get update -qq
    within $install apt-get install -y -qq --no-install-recommends "${packages[@]}" >/dev/null
fi

# What the program finds of a processor, as it asks: proof that an emulated model takes a path of its own.
cat >"$work/sees.rs" <<'RUST'
fn main() {
    #[cfg(target_arch = "x86_64")]
    let found = [
        ("sse2", is_x86_feature_detected!("sse2")),
        ("fma", is_x86_feature_detected!("fma")),
        ("avx2", is_x86_feature_detected!("avx2")),
        ("avx512f", is_x86_feature_detected!("avx512f")),
    ];
    #[cfg(target_arch = "aarch64")]
    let found = [("neon", std::arch::is_aarch64_feature_detected!("neon"))];
    let names: Vec<_> = found.iter().filter(|(_, has)| *has).map(|(name, _)| *name).collect();
    println!("{}", names.join(" "));
}
RUST

pictures() { # FOLDER COMMAND ..: draws with this command for the program
    rm -rf "$1"
    mkdir "$1"
    "${@:2}" all --quiet --size 320x240 --out "$1/8/"
    "${@:2}" all --quiet --size 320x240 --depth 16 --out "$1/16/"
    "${@:2}" render --quiet --size 160x120 --depth 16 --out "$1/hard/" figures/scenes/hard/*.toml
}
errors() { # REPORT FILE COMMAND ..: measures with the effort of REPORT, and writes all errors that are not those of REPORT
    "${@:3}" --check "$1" 2>&1 | grep -v '^qemu-x86_64: warning' >"$2" || true
}
compared() { # NAME "COMMAND BEFORE A PROGRAM" FOLDER OF PROGRAMS: draws and measures there, and compares
    local drawn="$work/$1"
    export -f pictures errors
    judged "$1, pictures drawn" $draw bash -euc 'pictures "$@"' - "$drawn" $2 "$3/figures"
    local same=0 differ=0 name
    for name in $(cd "$work/here" && find . -type f | sort); do
        if cmp "$work/here/$name" "$drawn/$name" >&2; then same=$((same + 1)); else differ=$((differ + 1)); fi
    done
    echo "$1, pictures: $differ of $((same + differ)) differ"
    failed=$((failed + differ))
    judged "$1, the report measured" $report bash -euc 'errors "$@"' - "$work/small.json" "$drawn/errors.txt" $2 "$3/report"
    if cmp "$work/errors.txt" "$drawn/errors.txt" >&2; then
        echo "$1, errors of the report: 0 of at least $measured differ"
    else
        echo "$1, errors of the report: DIFFER"
        failed=$((failed + 1))
        diff "$work/errors.txt" "$drawn/errors.txt" >&2 || true
    fi
}
tested() { # NAME "COMMAND BEFORE A PROGRAM" COMMAND OF CARGO ..: builds the tests, and runs each file with a limit of its own
    local what program
    within $build "${@:3}" --no-run -p rt-math -p rt-geom -p rt-shade --lib "${files[@]/#/--test=}" >"$work/step.log" 2>&1 || true
    sed -nE 's/^ *Executable (.*) \((.*)\)$/\2/p' "$work/step.log" >"$work/programs.txt"
    [ "$(wc -l <"$work/programs.txt")" = $((3 + ${#files[@]})) ] || { echo "$1: tests are MISSING"; failed=$((failed + 1)); }
    while read -r program; do
        what=$(basename "$program")
        judged "$1, ${what%-*}" $test $2 "$program" </dev/null
    done <"$work/programs.txt"
}

echo "Other processors, by .ci/by-hand/arm.sh, $(date -u +%F), commit $commit"
cpu=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)
echo "compared with: $cpu, $(rustc --version)"
echo "emulated by: $(qemu-x86_64 --version | head -n 1)"
within $build cargo build --release --quiet -p figures -p report
within 1 rustc -O "$work/sees.rs" -o "$work/sees"
echo "here: $("$work/sees")"
pictures "$work/here" "$target/release/figures"
[ -e "$work/report/report.json" ] || within $report "$target/release/report" --quick --out "$work/report"
# FMA and vectors are slow to emulate: less is measured than in a quick report, and nothing is timed twice. Since cases are
# others than in the report, its --check tells the new errors of nearly all entries, here as there.
sed -E '/"effort"/,/}/{s/("(rounds|timing)": )[0-9]+/\11/;s/("cases": )[0-9]+/\132/;s/("spheres": )[0-9]+/\11000/;s/("rows": )[0-9]+/\112/}' \
    "$work/report/report.json" >"$work/small.json"
errors "$work/small.json" "$work/errors.txt" "$target/release/report"
measured=$(grep -c ', now ' "$work/errors.txt")

[ $# -gt 0 ] || set -- Nehalem Haswell max arm
for name in "$@"; do
    echo ""
    if [ "$name" = arm ]; then
        # The same compiler. All of the C library is linked in: then no loader of another release of it is asked.
        arm=aarch64-unknown-linux-gnu emulated=qemu-aarch64 linker=aarch64-linux-gnu-gcc static="-C target-feature=+crt-static"
        rustup target list --installed | grep -qx $arm || within $install rustup target add $arm
        export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=$linker CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUSTFLAGS=$static
        within $build cargo build --release --quiet --target $arm -p figures -p report
        within 1 rustc -O --target $arm -C linker=$linker $static "$work/sees.rs" -o "$work/sees-arm"
        echo "arm sees: $($emulated "$work/sees-arm")"
        compared arm "$emulated" "$target/$arm/release"
        tested arm "$emulated" cargo test --release --target $arm
    else
        emulated="qemu-x86_64 -cpu $name"
        echo "$name sees: $($emulated "$work/sees" 2>/dev/null)"
        compared "$name" "$emulated" "$target/release"
        [ "$name" != Nehalem ] || tested "$name" "$emulated" cargo test --release
    fi
done

echo ""
[ $failed = 0 ] || { echo "FAILED: $failed"; exit 1; }
echo "passed: no byte and no error differs"
rm -rf "$work"
