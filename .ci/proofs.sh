#!/usr/bin/env bash
# The proofs of docs/proofs: every file is checked by Coq, every constant has a theorem, and no theorem rests on more than
# the axioms listed in docs/proofs/axioms.txt. Coq and Flocq are installed where they are missing; without them the gate
# stays shut.
set -euo pipefail
cd "$(dirname "$0")/.."

if ! command -v coq_makefile >/dev/null || ! command -v make >/dev/null || ! [ -d "$(coqc -where)/user-contrib/Flocq" ]; then
    if command -v apt-get >/dev/null && [ "$(id -u)" = 0 ]; then
        apt-get update -qq
        DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends make coq libcoq-flocq >/dev/null
    else
        echo "the proofs need coq, libcoq-flocq and make (Debian's names), and nobody may install them here" >&2
        exit 1
    fi
fi

# Nothing may be taken for granted: what this finds would be an axiom, or a proof that is not finished.
if grep -nwE 'Admitted|Axioms?|Parameters?|Conjecture|admit|Abort|give_up|Unset|bypass_check' docs/proofs/*.v; then
    echo "docs/proofs: not proved" >&2
    exit 1
fi

build="${CARGO_TARGET_DIR:-target}/proofs"
mkdir -p "$build"
find "$build" -maxdepth 1 -name '*.v' -delete
cp -p docs/proofs/*.v "$build"

# Every constant NAME, in capitals, needs a theorem NAME_holds. All theorems are asked at once what they rest on.
theorems=()
for file in docs/proofs/*.v; do
    module=$(basename "$file" .v)
    [ "$module" = Rounding ] || for name in $(sed -nE 's/^Definition ([A-Z][A-Z0-9_]+) .*/\1/p' "$file"); do
        grep -qE "^Theorem ${name}_holds\b" "$file" || { echo "$file: $name has no theorem ${name}_holds" >&2; exit 1; }
    done
    theorems+=($(sed -nE "s/^Theorem ([A-Za-z0-9_']+).*/$module.\1/p" "$file"))
done
{
    for file in docs/proofs/*.v; do echo "From Proofs Require $(basename "$file" .v)."; done
    echo "Definition everything := (I$(printf ', %s' "${theorems[@]}"))."
    echo "Print Assumptions everything."
} > "$build/Assumptions.v"

cd "$build"
coq_makefile -Q . Proofs -o Makefile $(ls ./*.v | grep -v Assumptions)
make -j2 --no-print-directory
coqc -Q . Proofs Assumptions.v > answers.txt

grep -qE '^(Axioms:|Closed under the global context)' answers.txt
# An axiom stands at the start of a line, its type behind it or below.
grep -oE "^[A-Za-z_][A-Za-z0-9_.']*" answers.txt | grep -vx 'Axioms\|Closed' | sort -u > found.txt || true
unlisted=$(comm -23 found.txt <(sort -u "$OLDPWD/docs/proofs/axioms.txt"))
[ -z "$unlisted" ] || { echo "axioms that docs/proofs/axioms.txt does not list: $unlisted" >&2; exit 1; }
echo "${#theorems[@]} theorems hold"
