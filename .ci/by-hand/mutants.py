#!/usr/bin/env python3
"""Mutation of the exact kernels: does any test, or any proof, notice a wrong constant, comparison or rung?

A copy of the tree is made in a scratch folder, and every mutant is put into it, switched at run time by the variable
MUTANT of the environment. So one build has all mutants, and the shipped code has none. Then each test is run once
alone, and notes which mutants it reaches; each mutant is run against the tests that reach it, the quickest first,
until one is red. `docs/mutants.md` has the kinds, the score and what is left.

Usage, from anywhere:
    .ci/by-hand/mutants.py list                         mutants of each file, by kind
    .ci/by-hand/mutants.py run [--sample N --seed S]    builds, runs, and writes RESULTS, one JSON object a line; N of each kind
    .ci/by-hand/mutants.py show KEY..                   the tests that reach these mutants
    .ci/by-hand/mutants.py table                        the score of each file, and the survivors, from RESULTS
Options: --scratch DIR (/tmp/mutants), --results FILE (SCRATCH/results.jsonl), --only A,B (mutants whose key has one),
--packages A,B (whose tests are run), --of A,B (whose mutants, if others), --longest S (without tests that take longer),
--again (those that survived or hung and no proof notices, once more). A run that was stopped goes on where it
was. Python's standard library alone.
"""

import argparse
import bisect
import collections
import json
import os
import random
import re
import resource
import selectors
import signal
import shutil
import subprocess
import sys
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

# The kernels: what decides, rounds, bounds or culls. Left out: the shape of the tree (`bvh/build`, `groups`, `rank`,
# `hilbert`: any shape gives the same answers), and what has no number of its own (`lib`, `mod` of exact, dispatch).
KERNELS = {
    "crates/rt-math/src": """reflect quadratic pseudo_inverse/fixed pseudo_inverse/integers pseudo_inverse/mod
        pseudo_inverse/regular pseudo_inverse/truncated pseudo_inverse/whole exact/ball exact/dot exact/double_double
        exact/dyadic exact/enclosure exact/error_free exact/fixed exact/radius exact/round exact/scaling exact/wide""",
    "crates/rt-geom/src": """ray plane crossings questions lanes leaf sphere_tree sphere/exact sphere/filter
        sphere/finish sphere/lanes sphere/mod triangle/exact triangle/filter triangle/finish triangle/lanes
        triangle/locate triangle/mod surface/exact surface/filter surface/finish surface/mod enclosing/apart
        enclosing/certify enclosing/exact enclosing/extreme enclosing/mod enclosing/nodes enclosing/pivot
        enclosing/refine enclosing/scan enclosing/tangent bvh/crown bvh/cull bvh/node bvh/walk bvh/batch bvh/tile
        bvh/tile_walk bvh/tiles""",
    "crates/rt-shade/src": """arctangent double_word mapping phong phong_batch power texture certified/arctangent
        certified/mod certified/phong certified/power certified/texture""",
    "figures/src": "certify seen",
}
# Definitions, not choices: with another unit roundoff or another zero there is nothing left to test.
DEFINITIONS = {"U", "ZERO", "ONE", "EMPTY", "NOTHING", "NONE", "UNKNOWN", "INFINITY", "NOWHERE", "NO_TWIN"}
PACKAGES = ["rt-math", "rt-geom", "rt-shade"]
NUMBERS = {"f64", "f32", "usize", "u64", "u32", "i32", "i64"}
TURNED = {"<": ">=", ">=": "<", ">": "<=", "<=": ">", "==": "!=", "!=": "=="}

RUNTIME = r"""//! Which mutant is on: `MUTANT`, eight times its number and its kind; `MUTANT_REACHED`, a file for those reached.
#![allow(missing_docs, clippy::all)]
use std::ops::{Range, RangeInclusive};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};

const UNREAD: u32 = u32::MAX;
const REACHED: u32 = u32::MAX - 1;
const NONE: u32 = u32::MAX - 8;
static ON: AtomicU32 = AtomicU32::new(UNREAD);
static SEEN: [AtomicBool; COUNT] = [const { AtomicBool::new(false) }; COUNT];

/// The kind of mutant `id` that is on, or zero.
#[inline(always)]
pub fn kind(id: u32) -> u32 {
    let on = ON.load(Relaxed);
    if on >> 3 != id && on < REACHED { 0 } else { other(id, on) }
}

#[cold]
#[inline(never)]
fn other(id: u32, on: u32) -> u32 {
    if on >> 3 == id {
        return on & 7;
    }
    if on == UNREAD {
        let number = std::env::var("MUTANT").ok().and_then(|s| s.parse().ok()).unwrap_or(NONE);
        ON.store(if std::env::var_os("MUTANT_REACHED").is_some() { REACHED } else { number }, Relaxed);
        return kind(id);
    }
    if !SEEN[id as usize].swap(true, Relaxed) {
        use std::io::Write;
        let name = std::env::var_os("MUTANT_REACHED").unwrap();
        let mut file = std::fs::OpenOptions::new().append(true).create(true).open(name).unwrap();
        file.write_all(format!("{id}\n").as_bytes()).unwrap();
    }
    0
}

pub trait Constant: Sized {
    fn changed(self, kind: u32) -> Self;
}

macro_rules! number {
    ($($type:ty)*) => { $(impl Constant for $type {
        #[inline(always)]
        fn changed(self, kind: u32) -> Self {
            match kind { 1 => self / (64 as $type), 2 => self * (64 as $type), _ => 0 as $type }
        }
    })* };
}
macro_rules! integer {
    ($($type:ty)*) => { $(impl Constant for $type {
        #[inline(always)]
        fn changed(self, kind: u32) -> Self {
            match kind { 1 => self / 64, 2 => self.saturating_mul(64), _ => 0 }
        }
    })* };
}
number! { f64 f32 }
integer! { usize u64 u32 i32 i64 }

impl<T: Constant> Constant for Range<T> {
    fn changed(self, kind: u32) -> Self {
        if kind < 4 { self.start.changed(kind)..self.end } else { self.start..self.end.changed(kind - 3) }
    }
}
impl<T: Constant + Clone> Constant for RangeInclusive<T> {
    fn changed(self, kind: u32) -> Self {
        let (start, end) = self.into_inner();
        if kind < 4 { start.changed(kind)..=end } else { start..=end.changed(kind - 3) }
    }
}

/// A constant, changed if its mutant is on.
#[inline(always)]
pub fn constant<T: Constant>(id: u32, value: T) -> T {
    let kind = kind(id);
    if kind == 0 { value } else { value.changed(kind) }
}

/// A rung of a ladder, which decides nothing if its mutant is on.
#[inline(always)]
pub fn rung<T>(id: u32, value: Option<T>) -> Option<T> {
    if kind(id) == 0 { value } else { None }
}
"""


def masked(text):
    """The text with comments, strings and characters blanked, of the same length."""
    out, i, n = list(text), 0, len(text)

    def blank(a, b):
        for k in range(a, b):
            if out[k] != "\n":
                out[k] = " "

    while i < n:
        if text.startswith("//", i):
            end = text.find("\n", i)
            end = n if end < 0 else end
        elif text.startswith("/*", i):
            end = text.index("*/", i) + 2
        elif text[i] == '"' or text.startswith('r"', i) and not text[i - 1].isalnum():
            raw = text[i] == "r"
            end = i + 1 + raw
            while text[end] != '"':
                end += 2 if text[end] == "\\" and not raw else 1
            end += 1
        elif match := re.compile(r"'(\\.[^']*|[^'\\])'").match(text, i):
            end = match.end()
        else:
            i += 1
            continue
        blank(i, end)
        i = end
    return "".join(out)


PAIRS = {"(": ")", "[": "]", "{": "}"}


def brackets(code):
    """For each bracket the place of its partner."""
    partner, stack = {}, []
    for i, c in enumerate(code):
        if c in PAIRS:
            stack.append(i)
        elif c in PAIRS.values() and stack:
            j = stack.pop()
            partner[i], partner[j] = j, i
    return partner


class Source:
    def __init__(self, path):
        self.path = path
        self.text = open(os.path.join(ROOT, path), encoding="utf-8").read()
        self.code = masked(self.text)
        self.partner = brackets(self.code)
        self.lines = [0] + [m.end() for m in re.finditer("\n", self.text)]
        self.tests = self.regions(r"#\[cfg\((all\()?test\b[^\]]*\]")
        self.constants = [(m.start(), self.end_of_item(m.end())) for m in re.finditer(r"(?m)^\s*(?:pub(?:\([a-z: ]+\))? )?(?:const|static) [A-Z_][A-Z_0-9]*\s*:", self.code)]
        other = self.regions(r"\bconst fn\b") + self.regions(r"\bdebug_assert\w*!") + self.regions(r"\btrait\b", head=True)
        other += [(m.start(), self.partner.get(m.end() - 1, m.end())) for m in re.finditer(r"#!?\[", self.code)]
        other += [(m.start(), self.code.index(";", m.end())) for m in re.finditer(r"\buse ", self.code)]
        self.excluded = sorted(self.constants + other)

    def regions(self, pattern, head=False):
        """From each match to the end of the item that follows."""
        found = []
        for m in re.finditer(pattern, self.code):
            i = m.end()
            while self.code[i] not in ("{;" if "assert" not in pattern else "("):
                i = self.partner[i] + 1 if self.code[i] in "([" else i + 1
            found.append((m.start(), i if head else self.partner.get(i, i)))
        return found

    def end_of_item(self, i):
        while self.code[i] != ";":
            i = self.partner[i] + 1 if self.code[i] in PAIRS else i + 1
        return i

    def within(self, i, regions):
        return any(a <= i < b for a, b in regions)

    def place(self, i):
        line = bisect.bisect_right(self.lines, i)
        return line, i - self.lines[line - 1] + 1

    def line_text(self, i):
        return self.text[self.lines[self.place(i)[0] - 1]:].split("\n", 1)[0].strip()


STOP_WORDS = {"if", "while", "return", "match", "let", "in", "else", "move", "break"}


def operands(source, start, end):
    """The operands of the comparison whose operator is at start..end."""
    code, partner = source.code, source.partner
    i = start
    while i > 0:
        c = code[i - 1]
        if c in ")]":
            i = partner[i - 1]
            continue
        if c == "}":
            if code[i] in ".?":
                i = partner[i - 1]
                continue
            break
        if c in "([{;," or code[i - 2:i] in ("&&", "||", "=>"):
            break
        if c == "=" and code[i - 2] not in "=!<>" and code[i] == " ":
            if code[i - 3:i] != "..=":
                break
        if c == ":" and code[i].isspace() and code[i - 2] != ":":
            break
        if c == "|" and code[i] in " " and code[i - 2] != " ":
            break
        if c.isalnum() or c == "_":
            j = i
            while code[j - 1].isalnum() or code[j - 1] == "_":
                j -= 1
            if code[j:i] in STOP_WORDS:
                break
            i = j
            continue
        i -= 1
    while code[i].isspace():
        i += 1
    # A comment or an attribute is no part of it.
    j = end
    while j < len(code):
        c = code[j]
        if c in "([":
            j = partner[j] + 1
            continue
        if c in "{});],;" or code[j:j + 2] in ("&&", "||", "=>") or re.match(r"\s=\s", code[j:j + 3]):
            break
        j += 1
    while code[j - 1].isspace():
        j -= 1
    return i, j


class Mutant:
    def __init__(self, number, source, at, kind, what, kinds, span, value=None):
        self.number, self.file, self.kind, self.what, self.kinds, self.span = number, source.path, kind, what, kinds, span
        self.line, self.column = source.place(at)
        self.text = source.line_text(at)
        self.sites, self.value = [], value


CHANGES = {1: "/ 64", 2: "* 64", 3: "0", 4: "end / 64", 5: "end * 64", 6: "end 0"}


class Copy:
    """All mutants, and the edits that put them into the copy."""

    def __init__(self):
        self.mutants, self.edits, self.sources = [], collections.defaultdict(list), {}
        for folder, names in KERNELS.items():
            for name in names.split():
                path = f"{folder}/{name}.rs"
                self.sources[path] = Source(path)
        shared = {}
        for path, source in self.sources.items():
            self.named_constants(source, shared)
        for path, source in self.sources.items():
            self.uses_of_others(source, shared)
            self.literals(source)
            self.comparisons(source)
            self.conditions(source)
            self.rungs(source)

    def new(self, source, at, kind, what, kinds, span, value=None):
        mutant = Mutant(len(self.mutants), source, at, kind, what, kinds, span, value)
        self.mutants.append(mutant)
        return mutant

    @staticmethod
    def runtime(path):
        return ("crate" if "rt-math" in path else "rt_math") + "::mutant"

    def wrap(self, source, mutant, start, end, before, after, operator=None):
        mutant.sites.append((source.path, start, end))
        self.edits[source.path].append((mutant.number, start, end, before, after, operator))

    def use(self, source, mutant, start, end):
        self.wrap(source, mutant, start, end, f"{self.runtime(source.path)}::constant({mutant.number}, ", ")")

    def named_constants(self, source, shared):
        pattern = re.compile(r"(?m)^\s*(pub(?:\([a-z: ]+\))? )?const ([A-Z][A-Z_0-9]*): ([^=;]+?)\s*=\s*")
        found = []
        for m in pattern.finditer(source.code):
            if source.within(m.start(), source.tests) or m[2] in DEFINITIONS:
                continue
            end = source.end_of_item(m.end())
            kind = m[3].split("::")[-1]
            inner = re.fullmatch(r"Range(Inclusive)?<(\w+)>", kind)
            if (inner[2] if inner else kind) not in NUMBERS:
                continue
            kinds = [1, 2, 3] if not inner else [1, 2, 3, 4, 5, 6]
            mutant = self.new(source, m.start(2), "constant", m[2], kinds, (m.end(), end), kind)
            # Known within the block around it.
            depth, i = 0, m.start()
            while i >= 0 and depth <= 0:
                i -= 1
                if i >= 0:
                    depth += {"{": 1, "}": -1}.get(source.code[i], 0)
            block = (i, source.partner[i]) if i >= 0 else (0, len(source.code))
            found.append((block, mutant))
            if m[1]:
                shared.setdefault(m[2], []).append((source.path, mutant))
        for m in re.finditer(r"(?:\b(?:Self|Window::<\w+>)::)?\b([A-Z][A-Z_0-9]+)\b(?![:!<(])", source.code):
            if self.no_use(source, m):
                continue
            fitting = [(b - a, mutant) for (a, b), mutant in found if a <= m.start() < b and mutant.what == m[1]]
            if fitting:
                _, mutant = min(fitting, key=lambda x: x[0])
                self.use(source, mutant, m.start(), m.end())

    @staticmethod
    def no_use(source, m):
        before = source.code[max(0, m.start() - 8):m.start()]
        outside_tests = [r for r in source.excluded if not source.within(r[0], source.tests)]
        return before.endswith("::") or re.search(r"const $|static $", before) or source.within(m.start(), outside_tests) \
            or any(a <= m.start() < b for a, b in source.constants)

    def uses_of_others(self, source, shared):
        own = set(re.findall(r"const ([A-Z][A-Z_0-9]*):", source.code))
        crate = source.path.split("/src/")[0]
        for m in re.finditer(r"\b((?:\w+::)*)([A-Z][A-Z_0-9]+)\b(?!\s*[:{!<(]|::)", source.code):
            for path, mutant in shared.get(m[2], []):
                same = path.split("/src/")[0] == crate or "exact" in path
                if path == source.path or m[2] in own or not same or self.no_use(source, m) or m[1].startswith(("f64", "f32", "u", "i", "Self")):
                    continue
                self.use(source, mutant, m.start(), m.end())
                break

    def literals(self, source):
        for m in re.finditer(r"(?<![\w.])(\d[\d_]*\.\d[\d_]*(?:e[-+]?\d+)?(?:_?f(?:32|64))?|\d[\d_]*e-?\d+|power_of_two\((?=-?\d+\)))", source.code):
            if source.within(m.start(), source.excluded) or source.within(m.start(), source.tests):
                continue
            end = m.end()
            if m[1].endswith("("):
                end = source.partner[m.end() - 1] + 1
            elif float(re.sub(r"_?f(32|64)$", "", m[1]).replace("_", "")) == 0.0:
                continue
            mutant = self.new(source, m.start(), "literal", source.text[m.start():end], [1, 2, 3], (m.start(), end))
            self.use(source, mutant, m.start(), end)

    def comparisons(self, source):
        for m in re.finditer(r"(?<=\s)(<=|>=|==|!=|<|>)(?=\s)", source.code):
            if source.within(m.start(), source.excluded) or source.within(m.start(), source.tests):
                continue
            start, end = operands(source, m.start(), m.end())
            mutant = self.new(source, m.start(), "comparison", f"{source.text[start:end]}", [1], (start, end))
            self.wrap(source, mutant, start, end, "(match (&(",
                      f")) {{ (l, r) => if {self.runtime(source.path)}::kind({mutant.number}) != 0 "
                      f"{{ l {TURNED[m[1]]} r }} else {{ l {m[1]} r }} }})", (m.start(), m.end()))
        for m in re.finditer(r"\.simd_(lt|le|gt|ge|eq)\(", source.code):
            if source.within(m.start(), source.excluded) or source.within(m.start(), source.tests):
                continue
            end, start = source.partner[m.end() - 1] + 1, m.start()
            while source.code[start - 1] in ")]" or re.match(r"[\w.:?]", source.code[start - 1]):
                start = source.partner[start - 1] if source.code[start - 1] in ")]" else start - 1
            # An equality is turned into one that never holds.
            turned = {"lt": "ge", "ge": "lt", "gt": "le", "le": "gt", "eq": "lt"}[m[1]]
            mutant = self.new(source, m.start(), "comparison", source.text[start:end], [1], (start, end))
            argument = source.text[m.end():end - 1]
            receiver = source.text[start:m.start()]
            # The whole is written anew.
            mutant.sites.append((source.path, start, end))
            self.edits[source.path].append((mutant.number, start, end, None, (
                f"(if {self.runtime(source.path)}::kind({mutant.number}) != 0 "
                f"{{ ({receiver}).simd_{turned}({argument}) }} else {{ ({receiver}).simd_{m[1]}({argument}) }})"), None))

    def conditions(self, source):
        for m in re.finditer(r"\b(?:if|while) (?!let\b)", source.code):
            if source.within(m.start(), source.excluded) or source.within(m.start(), source.tests):
                continue
            i = m.end()
            while source.code[i] not in "{;" and source.code[i:i + 2] != "=>":
                i = source.partner[i] + 1 if source.code[i] in "([" else i + 1
            end = i
            while source.code[end - 1].isspace():
                end -= 1
            condition = source.code[m.end():end]
            if re.search(r"\s(<|>|<=|>=|==|!=)\s|\blet\b", condition) or re.fullmatch(r"!?[A-Z_]+(::[A-Z_]+)?|Q::ANY", condition):
                continue
            mutant = self.new(source, m.end(), "condition", source.text[m.end():end], [1], (m.end(), end))
            self.wrap(source, mutant, m.end(), end, f"({self.runtime(source.path)}::kind({mutant.number}) != 0) ^ (", ")")

    def rungs(self, source):
        code, partial = source.code, set()
        for m in re.finditer(r"\bfn (\w+)", code):
            if source.within(m.start(), source.excluded) or source.within(m.start(), source.tests):
                continue
            i = code.index("(", m.end())
            if "<" in code[m.end():i]:
                depth, i = 0, code.index("<", m.end())
                while True:
                    depth += {"<": 1, ">": -(code[i - 1] not in "-=")}.get(code[i], 0)
                    if depth == 0:
                        break
                    i += 1
                i = code.index("(", i)
            i = source.partner[i] + 1
            body = i
            while body < len(code) and code[body] not in "{;=":
                body += 1
            returned = re.match(r"\s*->\s*(\w+)<", code[i:body])
            if not returned or code[body] != "{":
                continue
            if returned[1] == "Option":
                nothing = "None"
                partial.add(m[1])
            elif returned[1] == "FilterVerdict":
                nothing = "FilterVerdict::Unsure"
            else:
                continue
            mutant = self.new(source, m.start(), "rung", f"fn {m[1]}", [1], (m.start(), body))
            self.wrap(source, mutant, body + 1, body + 1, "", f" if {self.runtime(source.path)}::kind({mutant.number}) != 0 {{ return {nothing}; }}")
        # A ladder asks one function for several sizes: each call is a rung.
        for m in re.finditer(r"(?<![\w:])(\w+)::<[\d, ]+>(::new)?\(", code):
            if source.within(m.start(), source.excluded) or source.within(m.start(), source.tests):
                continue
            if m[1] not in partial and not (m[2] and "new" in partial):
                continue
            end = source.partner[m.end() - 1] + 1
            mutant = self.new(source, m.start(), "rung", source.text[m.start():end], [1], (m.start(), end))
            self.wrap(source, mutant, m.start(), end, f"{self.runtime(source.path)}::rung({mutant.number}, ", ")")

    def instrumented(self, path, dropped):
        """The text of a file with its mutants, and where in it each stands."""
        source = self.sources[path]
        pieces = []
        for number, start, end, before, after, operator in self.edits[path]:
            if (number, path, start) in dropped:
                continue
            length = end - start
            if before is None:
                # What is within it is not mutated again.
                pieces.append((start, 1, -length, end, after, number))
                continue
            if before:
                pieces.append((start, 1, -length, start, before, number))
            if operator:
                pieces.append((operator[0], 1, 0, operator[1], "), &(", number))
            pieces.append((end, 0, length, end, after, number))
        pieces.sort(key=lambda p: (p[0], p[1], p[2]))
        out, at, where, length = [], 0, [], 0
        for start, _, _, end, text, number in pieces:
            if start < at:
                continue
            out.append(source.text[at:start])
            length += start - at
            where.append((length, length + len(text), number, start))
            out.append(text)
            length += len(text)
            at = end
        out.append(source.text[at:])
        return "".join(out), where

    def changes(self):
        """Every single mutant: key, mutant, kind."""
        for mutant in self.mutants:
            for kind in mutant.kinds:
                change = CHANGES[kind] if mutant.kind in ("constant", "literal") else "turned" if mutant.kind != "rung" else "skipped"
                yield f"{mutant.file}:{mutant.line}:{mutant.column} {mutant.kind} {change}", mutant, kind


def limits(seconds):
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
    resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    os.setsid()


def run_test(test, extra, limit):
    """Whether it passes, or None where it took too much of the processor; and the seconds."""
    # A property is tested with the same cases each time, and what fails is not kept for the next mutant.
    environment = dict(os.environ, CARGO_MANIFEST_DIR=test["folder"], RAYON_NUM_THREADS="2", PROPTEST_RNG_SEED="1",
                       PROPTEST_DISABLE_FAILURE_PERSISTENCE="true", **extra)
    command = [test["binary"], "--exact", test["name"], "--test-threads=1"]
    start = time.time()
    child = subprocess.Popen(command, env=environment, cwd=test["folder"], stdout=subprocess.DEVNULL,
                             stderr=subprocess.DEVNULL, preexec_fn=lambda: limits(int(limit)))
    try:
        # By itself it may take far longer than of the processor's time, if others have that.
        code = child.wait(timeout=300 + 10 * limit)
        good = None if code in (-signal.SIGXCPU, -signal.SIGKILL) else code == 0
    except subprocess.TimeoutExpired:
        os.killpg(child.pid, signal.SIGKILL)
        child.wait()
        good = None
    return good, time.time() - start


class Session:
    def __init__(self, options):
        self.options, self.scratch = options, options.scratch
        self.tree = os.path.join(self.scratch, "tree")
        self.copy = Copy()
        # With fewer mutants the copy is built far sooner.
        meant = {mutant.number for key, mutant, _ in self.copy.changes() if self.meant(key)}
        for edits in self.copy.edits.values():
            edits[:] = [edit for edit in edits if edit[0] in meant]
        self.environment = dict(os.environ, CARGO_TARGET_DIR=os.path.join(self.scratch, "target"), CARGO_INCREMENTAL="1",
                                CARGO_NET_OFFLINE="true")

    def cargo(self, *arguments):
        packages = [x for p in self.options.packages for x in ("-p", p)]
        return subprocess.run(["cargo", *arguments, *packages, "--message-format=json"], cwd=self.tree, env=self.environment,
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False).stdout

    def files(self):
        return subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True).stdout.split("\n")[:-1]

    def write(self, path, text):
        path = os.path.join(self.tree, path)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        if not os.path.exists(path) or open(path, encoding="utf-8").read() != text:
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)

    def build(self):
        """The copy with all mutants that compile; returns the numbers of these."""
        for path in self.files():
            if path in self.copy.sources or path == "crates/rt-math/src/lib.rs" or not os.path.isfile(os.path.join(ROOT, path)):
                continue
            target = os.path.join(self.tree, path)
            os.makedirs(os.path.dirname(target), exist_ok=True)
            if not os.path.exists(target) or open(target, "rb").read() != open(os.path.join(ROOT, path), "rb").read():
                shutil.copy(os.path.join(ROOT, path), target)
        lib = open(os.path.join(ROOT, "crates/rt-math/src/lib.rs"), encoding="utf-8").read()
        self.write("crates/rt-math/src/lib.rs", lib.replace("pub mod exact;", "pub mod exact;\npub mod mutant;", 1))
        self.write("crates/rt-math/src/mutant.rs", RUNTIME.replace("COUNT", str(len(self.copy.mutants))))
        name = os.path.join(self.scratch, "dropped.json")
        dropped = {tuple(x) for x in json.load(open(name))} if os.path.exists(name) else set()
        for _ in range(40):
            places = {}
            for path in self.copy.sources:
                text, places[path] = self.copy.instrumented(path, dropped)
                self.write(path, text)
            bad = self.errors(places)
            if not bad:
                break
            print(f"{len(bad)} places do not compile", flush=True)
            dropped |= bad
            json.dump(sorted(dropped), open(name, "w"))
        else:
            sys.exit("does not compile")
        # A constant that is a size as well would have two values at once.
        return {m.number for m in self.copy.mutants if m.sites and not any((m.number, p, a) in dropped for p, a, _ in m.sites)}

    def errors(self, places):
        bad, seen = set(), 0
        for line in self.cargo("test", "--no-run", "--lib", "--tests").splitlines():
            message = json.loads(line).get("message")
            if not isinstance(message, dict) or message.get("level") != "error":
                continue
            seen += 1
            spans, todo = [], [message]
            while todo:
                m = todo.pop()
                todo += m.get("children", [])
                spans += m.get("spans", [])
            hits = set()
            for span in [s for s in spans if s["is_primary"]] + spans:
                while span.get("expansion") and span["file_name"] not in places:
                    span = span["expansion"]["span"]
                path = span["file_name"]
                if path not in places:
                    continue
                text = open(os.path.join(self.tree, path), "rb").read()
                first, last = len(text[:span["byte_start"]].decode()), len(text[:span["byte_end"]].decode())
                fitting = [(number, path, start) for a, b, number, start in places[path] if a < last and first < b]
                if not fitting:
                    lines = text.decode().split("\n")
                    a0 = sum(len(x) + 1 for x in lines[:span["line_start"] - 1])
                    b0 = sum(len(x) + 1 for x in lines[:span["line_end"]])
                    fitting = [(number, path, start) for a, b, number, start in places[path] if a < b0 and a0 < b]
                hits |= self.sites(fitting)
                if hits:
                    break
            if not hits and message.get("spans"):
                print(message["rendered"][:600], flush=True)
            bad |= hits
        if seen and not bad:
            sys.exit("an error where no mutant stands")
        return bad

    def sites(self, fitting):
        """The beginnings of the sites that these pieces belong to."""
        found = set()
        for number, path, place in fitting:
            for p, start, end in self.copy.mutants[number].sites:
                if p == path and start <= place <= end:
                    found.add((number, path, start))
        return found

    def tests(self):
        """All tests, with the time each takes and the mutants it reaches; kept beside the binaries."""
        binaries = []
        for line in self.cargo("test", "--no-run", "--lib", "--tests").splitlines():
            message = json.loads(line)
            if message.get("executable") and message.get("profile", {}).get("test"):
                binaries.append((message["executable"], os.path.dirname(message["manifest_path"])))
        if not binaries:
            sys.exit("no test binary was built")
        name = os.path.join(self.scratch, "tests.json")
        known = json.load(open(name)) if os.path.exists(name) else {}
        tests = []
        for binary, folder in binaries:
            stamp = os.path.getmtime(binary)
            listed = subprocess.run([binary, "--list", "--format=terse"], stdout=subprocess.PIPE, text=True, check=True, cwd=folder).stdout
            for test in re.findall(r"^(.+): test$", listed, re.M):
                entry = known.get(f"{binary} {test}")
                if not entry or entry["stamp"] != stamp:
                    entry = {"binary": binary, "folder": folder, "name": test, "stamp": stamp}
                    reached = os.path.join(self.scratch, "reached")
                    if os.path.exists(reached):
                        os.remove(reached)
                    good, seconds = run_test(entry, {"MUTANT_REACHED": reached}, min(600, 5 + 2 * self.options.longest))
                    entry["seconds"] = seconds
                    entry["reached"] = [int(x) for x in open(reached)] if os.path.exists(reached) else []
                    entry["good"] = good
                    print(f"{seconds:7.2f} s  {len(entry['reached']):5} mutants  {good}  {os.path.basename(binary)} {test}", flush=True)
                    known[f"{binary} {test}"] = entry
                    json.dump(known, open(name, "w"))
                if entry["good"]:
                    tests.append(entry)
        return sorted(tests, key=lambda t: t["seconds"])

    def proofs(self):
        """The test that holds the constants to the proofs, built alone; and a tree of sources to change."""
        folder = self.options.results + ".proofs"
        for path in self.files():
            if path.startswith(("docs/proofs/", "docs/numerics.md", "crates/", "figures/src/")) and path.endswith((".v", ".md", ".rs")):
                target = os.path.join(folder, path)
                os.makedirs(os.path.dirname(target), exist_ok=True)
                shutil.copy(os.path.join(ROOT, path), target)
        binary = os.path.join(folder, "test")
        subprocess.run(["rustc", "--edition", "2024", "--test", os.path.join(ROOT, "tests/proofs.rs"), "-o", binary],
                       env=dict(os.environ, CARGO_MANIFEST_DIR=folder), check=True, stderr=subprocess.DEVNULL)
        if subprocess.run([binary], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False).returncode:
            sys.exit("tests/proofs.rs is red without a mutant")
        return folder, binary

    def proof_notices(self, mutant, kind):
        if mutant.kind not in ("constant", "literal"):
            return False
        folder, binary = self.proved
        source, (a, b) = self.copy.sources[mutant.file], mutant.span
        value = source.text[a:b]
        whole = mutant.kind == "constant" and mutant.value not in ("f64", "f32")
        if "Range" in (mutant.value or ""):
            return False
        number = "64" if whole else "64.0"
        changed = {1: f"({value}) / {number}", 2: f"({value}) * {number}", 3: "0" if whole else "0.0"}[kind]
        if mutant.kind == "literal" and kind != 3:
            changed = f"({changed})"
        path = os.path.join(folder, mutant.file)
        with open(path, "w", encoding="utf-8") as file:
            file.write(source.text[:a] + changed + source.text[b:])
        red = subprocess.run([binary], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False).returncode != 0
        with open(path, "w", encoding="utf-8") as file:
            file.write(source.text)
        return red

    def run(self):
        alive = self.build()
        tests = self.tests()
        self.proved = self.proofs()
        done = results(self.options.results)
        ours = tuple(f"crates/{p}/" if p.startswith("rt-") else f"{p}/" for p in self.options.of or self.options.packages)
        # The constants and the rungs first; each kind in an order of chance, so that what is done of it is a sample.
        chance = lambda x: random.Random(f"{self.options.seed} {x[0]}").random()
        todo = sorted((x for x in self.copy.changes() if self.meant(x[0]) and x[0].startswith(ours)), key=chance)
        groups = [[x for x in todo if x[1].kind == kind][:self.options.sample]
                  for kind in ("constant", "rung", "comparison", "condition", "literal")]
        todo = [x for group in groups for x in group]
        if self.options.again:
            open_ = {k for k, e in done.items() if e["result"] in ("survived", "unreached", "hangs") and not e["proof"]}
            todo = [x for x in todo if x[0] in open_]
        else:
            todo = [x for x in todo if x[0] not in done]
        reach = collections.defaultdict(list)
        for test in tests:
            if test["seconds"] > self.options.longest:
                continue
            for number in test["reached"]:
                reach[number].append(test)
        print(f"{len(todo)} mutants, {len(tests)} tests", flush=True)
        start = time.time()
        kills = collections.Counter()
        for count, (key, mutant, kind) in enumerate(todo):
            begun, killer, result = time.time(), None, "survived"
            if mutant.number not in alive:
                result = "not compiled"
            elif not reach[mutant.number]:
                result = "unreached"
            else:
                home = mutant.file.split("/src/")[0]
                order = sorted(reach[mutant.number], key=lambda t: (not t["folder"].endswith(home), t["seconds"] / (1 + kills[t["name"], mutant.file])))
                for test in order:
                    good, _ = run_test(test, {"MUTANT": str(8 * mutant.number + kind)}, 5 + 5 * test["seconds"])
                    if not good:
                        kills[test["name"], mutant.file] += 1
                        result, killer = ("killed" if good is False else "hangs"), test["name"]
                        break
            entry = {"key": key, "file": mutant.file, "line": mutant.line, "kind": mutant.kind, "what": mutant.what,
                     "change": key.split(" ", 2)[2], "text": mutant.text, "result": result, "by": killer,
                     "proof": self.proof_notices(mutant, kind), "seconds": round(time.time() - begun, 2)}
            with open(self.options.results, "a", encoding="utf-8") as file:
                file.write(json.dumps(entry) + "\n")
            if result != "killed":
                print(f"{count}/{len(todo)} {time.time() - start:.0f} s {result} {'(proof) ' if entry['proof'] else ''}{key}: {mutant.what}", flush=True)

    def meant(self, key):
        return any(text in key for text in self.options.only)

    def show(self, keys):
        names = os.path.join(self.scratch, "tests.json")
        for key, mutant, _ in self.copy.changes():
            if any(k in key for k in keys):
                print(key, "|", mutant.what)
                for entry in json.load(open(names)).values():
                    if mutant.number in entry["reached"]:
                        print(f"    {entry['seconds']:.2f} {os.path.basename(entry['binary'])} {entry['name']}")


def results(name):
    """The last result of each mutant."""
    found = {}
    if os.path.exists(name):
        for line in open(name, encoding="utf-8"):
            entry = json.loads(line)
            found[entry["key"]] = entry
    return found


def noticed(entry):
    return entry["result"] in ("killed", "hangs") or entry["proof"]


def table(found):
    """The score of each file, and the survivors, in Markdown."""
    rows = collections.defaultdict(collections.Counter)
    for entry in found.values():
        if entry["result"] == "not compiled" and not entry["proof"]:
            rows[entry["file"]]["not compiled"] += 1
            continue
        row = rows[entry["file"]]
        row["mutants"] += 1
        row["tests"] += entry["result"] in ("killed", "hangs")
        row["proof alone"] += entry["proof"] and entry["result"] not in ("killed", "hangs")
        row["survive"] += not noticed(entry)
    columns = ["mutants", "tests", "proof alone", "survive", "not compiled"]
    print("| file | " + " | ".join(columns) + " |\n|---|" + "---:|" * len(columns))
    for file in sorted(rows):
        print(f"| `{file}` | " + " | ".join(str(rows[file][c]) for c in columns) + " |")
    print("| all | " + " | ".join(str(sum(r[c] for r in rows.values())) for c in columns) + " |\n")
    for key in sorted(found):
        entry = found[key]
        if not noticed(entry) and entry["result"] != "not compiled":
            print(f"- {entry['result']}: `{key}`: `{entry['what']}`")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", choices=["list", "run", "show", "table"])
    parser.add_argument("keys", nargs="*")
    parser.add_argument("--scratch", default="/tmp/mutants")
    parser.add_argument("--results")
    parser.add_argument("--only", type=lambda s: s.split(","), default=[""])
    parser.add_argument("--packages", type=lambda s: s.split(","), default=PACKAGES)
    parser.add_argument("--of", type=lambda s: s.split(","))
    parser.add_argument("--sample", type=int)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--longest", type=float, default=1e9)
    parser.add_argument("--again", action="store_true")
    options = parser.parse_args()
    options.results = options.results or os.path.join(options.scratch, "results.jsonl")
    os.makedirs(options.scratch, exist_ok=True)
    if options.command == "list":
        counts = collections.Counter()
        for key, mutant, _ in Copy().changes():
            if any(text in key for text in options.only):
                counts[mutant.file, mutant.kind] += 1
        for (file, kind), count in sorted(counts.items()):
            print(f"{count:5} {kind:10} {file}")
        print(sum(counts.values()))
    elif options.command == "table":
        table(results(options.results))
    elif options.command == "show":
        Session(options).show(options.keys)
    else:
        Session(options).run()


if __name__ == "__main__":
    main()
