#!/usr/bin/env python3
"""Checks who includes whom: the rooms and levels of docs/project/architecture.md, and the form of a header's first lines.

    scripts/check_includes.py [ROOT]       one line per broken rule, exit code 1 if there is one
    scripts/check_includes.py --self-test  breaks every rule once and expects to be told
"""
import re
import sys
import tempfile
from pathlib import Path

LEVELS = {
    "core": 0, "math": 1, "geometry": 2, "linear": 2, "rows": 2, "bodies": 3, "fem": 4, "constraints": 4, "collision": 5,
    "compliance": 5, "solvers": 5, "step": 6, "integrators": 7, "stabilisation": 7, "schemes": 7, "activity": 7,
    "steppers": 8, "loop": 9, "problems": 10, "listeners": 10, "haptics": 11, "io": 12, "model": 12, "study": 13, "adapters": 13,
}
# Files that name every part, up to the listeners: what a new part may edit.
GATHERING = {"delassus.hpp": 11, "fwd.hpp": 11, "loop/defaults.hpp": 11}
# Files outside the rooms that anyone may include.
FREE = {"version.hpp", "fwd.hpp"}
# Files around the umbrella: they may include it and each other, and nothing else of the library may include them.
AROUND = {"compiled.hpp", "compile_here.hpp"}

EIGEN = {"Eigen/Core", "Eigen/Geometry", "Eigen/Cholesky"}
EIGEN_LINEAR = {"Eigen/LU", "Eigen/OrderingMethods", "Eigen/SparseCore"}
HEAVY = {"iostream", "ranges", "regex", "execution"}
WRAPPED = {"cmath": "core/cmath.hpp"}  # no guard of their own: read again at each inclusion
COMPILERS = {"immintrin.h", "arm_neon.h"}  # the compiler's own names of the processor's instructions, in math/
STANDARD = re.compile(r"^[a-z_0-9]+(\.h)?$")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def room_of(name):
    return name.split("/")[0] if "/" in name else None


def why_not(header, target):
    """Why `header` (a path below include/delassus) may not include the delassus header `target`; None if it may."""
    if target in FREE and header != "version.hpp":
        return None
    if header in AROUND and (target in AROUND | {"delassus.hpp"} or LEVELS.get(room_of(target), 99) <= LEVELS["listeners"]):
        return None
    if target in AROUND | {"delassus.hpp"}:
        return "the umbrella is for users, not for the library"
    theirs = room_of(target)
    if theirs not in LEVELS:
        return f"there is no room {theirs or target!r}"
    if header in GATHERING:
        limit = GATHERING[header]
        return None if LEVELS[theirs] <= limit else f"{header} gathers levels up to {limit}, {theirs} is {LEVELS[theirs]}"
    ours = room_of(header)
    if ours is None:
        return f"{header} belongs to no room"
    if ours == theirs or LEVELS[theirs] < LEVELS[ours]:
        return None
    return f"{ours} is level {LEVELS[ours]}, {theirs} is level {LEVELS[theirs]}: includes go downhill only"


def why_not_foreign(header, target):
    """The same for a header that is not ours."""
    room = room_of(header)
    if target.startswith("Eigen/"):
        if target in EIGEN or (target in EIGEN_LINEAR and room == "linear") or room == "adapters":
            return None
        return f"Eigen comes as {', '.join(sorted(EIGEN))} (and {', '.join(sorted(EIGEN_LINEAR))} in linear/)"
    if target in HEAVY:
        return "too heavy for a header"
    if target in WRAPPED:
        return None if header == WRAPPED[target] else f"include <delassus/{WRAPPED[target]}>, which is read once"
    if STANDARD.match(target) and not target.endswith(".h"):
        return None
    if target in COMPILERS and room == "math":
        return None
    return None if room == "adapters" else "a third party lives in adapters/ alone"


def complaints(include):
    """All broken rules below `include`/delassus, as (file, line, sentence)."""
    base = include / "delassus"
    for path in sorted(base.rglob("*.hpp")):
        header = path.relative_to(base).as_posix()
        lines = path.read_text(encoding="utf-8").splitlines()
        if not re.match(r"/// \S", lines[0] if lines else ""):
            yield header, 1, "the first line is not a /// sentence"
        if "#pragma once" not in lines:
            yield header, 1, "#pragma once is missing"
        if room_of(header) not in LEVELS and header not in {*GATHERING, *FREE, *AROUND}:
            yield header, 1, "belongs to no room of the list"
        for number, line in enumerate(lines, 1):
            match = INCLUDE.match(line)
            if not match:
                continue
            bracket, target = match.groups()
            if bracket == '"':
                yield header, number, f'"{target}": include with <delassus/...>'
            elif target.startswith("delassus/"):
                reason = why_not(header, target.removeprefix("delassus/"))
                if not reason and not (include / target).exists():
                    reason = "no such header"
                if reason:
                    yield header, number, f"<{target}>: {reason}"
            else:
                reason = why_not_foreign(header, target)
                if reason:
                    yield header, number, f"<{target}>: {reason}"


# header text -> a word of the complaint it must raise, or None if it is allowed.
SELF_TEST = [
    ("core/a.hpp", "#include <vector>", None),
    ("solvers/a.hpp", "#include <delassus/rows/ok.hpp>", None),
    ("solvers/a.hpp", "#include <delassus/solvers/ok.hpp>", None),
    ("linear/a.hpp", "#include <Eigen/SparseCore>", None),
    ("math/a.hpp", "#include <immintrin.h>", None),
    ("linear/a.hpp", "#include <immintrin.h>", "third party"),
    ("adapters/fcl.hpp", "#include <fcl/narrowphase/collision.h>", None),
    ("loop/defaults.hpp", "#include <delassus/listeners/ok.hpp>", None),
    ("delassus.hpp", "#include <delassus/loop/ok.hpp>", None),
    ("core/a.hpp", "#include <delassus/math/ok.hpp>", "downhill"),
    ("solvers/a.hpp", "#include <delassus/compliance/ok.hpp>", "downhill"),
    ("geometry/a.hpp", "#include <delassus/rows/ok.hpp>", "downhill"),
    ("loop/a.hpp", "#include <delassus/listeners/ok.hpp>", "downhill"),
    ("loop/a.hpp", "#include <delassus/delassus.hpp>", "umbrella"),
    ("loop/a.hpp", "#include <delassus/compiled.hpp>", "umbrella"),
    ("compiled.hpp", "#include <delassus/study/ok.hpp>", "no room"),
    ("delassus.hpp", "#include <delassus/study/ok.hpp>", "gathers"),
    ("math/a.hpp", "#include <Eigen/Dense>", "Eigen comes as"),
    ("bodies/a.hpp", "#include <Eigen/SparseCore>", "Eigen comes as"),
    ("collision/a.hpp", "#include <fcl/fcl.h>", "third party"),
    ("collision/a.hpp", "#include <ccd/ccd.h>", "third party"),
    ("core/a.hpp", "#include <iostream>", "heavy"),
    ("core/cmath.hpp", "#include <cmath>", None),
    ("rows/a.hpp", "#include <cmath>", "read once"),
    ("core/a.hpp", '#include "ok.hpp"', "include with"),
    ("core/a.hpp", "#include <delassus/core/gone.hpp>", "no such header"),
    ("cellar/a.hpp", "", "no room"),
]


def self_test():
    failures = 0

    def expect(files, word):
        nonlocal failures
        with tempfile.TemporaryDirectory() as folder:
            include = Path(folder)
            for room in LEVELS:
                (include / "delassus" / room).mkdir(parents=True)
                (include / "delassus" / room / "ok.hpp").write_text("/// Fine.\n#pragma once\n")
            for name, text in files.items():
                (include / "delassus" / name).parent.mkdir(exist_ok=True)
                (include / "delassus" / name).write_text(text)
            told = [sentence for _, _, sentence in complaints(include)]
        if (word is None and told) or (word is not None and not any(word in sentence for sentence in told)):
            failures += 1
            print(f"{files}: expected {word!r}, told {told}")

    for name, line, word in SELF_TEST:
        expect({name: f"/// Fine.\n#pragma once\n{line}\n"}, word)
    expect({"core/a.hpp": "#pragma once\n"}, "sentence")
    expect({"core/a.hpp": "/// Fine.\n"}, "#pragma once")
    print(f"check_includes: {len(SELF_TEST) + 2} self-tests, {failures} failed")
    return failures


def main():
    if sys.argv[1:] == ["--self-test"]:
        return 1 if self_test() else 0
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent
    found = list(complaints(root / "include"))
    for header, line, sentence in found:
        print(f"include/delassus/{header}:{line}: {sentence}")
    print(f"check_includes: {len(list((root / 'include').rglob('*.hpp')))} headers, {len(found)} broken rules")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
