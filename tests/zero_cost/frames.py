#!/usr/bin/env python3
"""How many frames a debugger shows between `step` and the answer of a law to one contact, in a program without optimisation.

  frames.py <root> --compiler g++ [--system <include dir>...]

Whoever steps into a step of ten boxes walks through these frames. None of them is a lambda or std::apply.
"""
import pathlib
import re
import shutil
import sys
import tempfile

from programs import NO_VALGRIND as NOTHING_SEEN
from programs import arguments, run, verdict

MOST = 12  # frames, `step` and the law's own included
LAW = "delassus::Coulomb::solve_local"


def frames(program):
    """Their names, from the law outwards, without the program's own."""
    said = run("gdb", "-q", "-batch", "-nx", "-ex", "set width 0", "-ex", "set breakpoint pending on", "-ex", f"break {LAW}<double>", "-ex",
               "run", "-ex", "bt", program).stdout
    names = [re.sub(r"^#\d+\s+(?:0x[0-9a-f]+ in )?", "", line) for line in said.splitlines() if line.startswith("#")]
    if not names or not names[0].startswith(LAW):
        sys.exit(f"the program did not stop in {LAW}:\n{said}")
    return names[:next(i for i, name in enumerate(names) if re.match(r"delassus::AnimationLoop<.*>::step\b", name)) + 1]


def without_arguments(name):
    """Of templates and of the call."""
    while "<" in name and (inner := re.sub(r"<[^<>]*>", "", name)) != name:
        name = inner
    return re.sub(r"\s*\(.*", "", name)


def main():
    given = arguments(__doc__.splitlines()[0])
    if not shutil.which("gdb"):
        print("gdb is not here (apt-get install gdb): no frame was counted")
        return NOTHING_SEEN
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(folder) / "stack"
        include = [word for directory in given.system for word in ("-isystem", directory)]
        run(given.compiler, "-std=c++20", "-O0", "-g", "-I", given.root / "include", *include, given.root / "examples/stack.cpp", "-o",
            program)
        found = frames(program)
    for name in found:
        print(without_arguments(name))
    wrong = [f"{without_arguments(name)} stands between a step and its law" for name in found if re.search(r"[{<]lambda\(|std::apply", name)]
    if len(found) > MOST:
        wrong.append(f"{len(found)} frames from a step to {LAW}, {MOST} at the most")
    print(f"{len(found)} frames, {MOST} at the most")
    return verdict(wrong)


if __name__ == "__main__":
    sys.exit(main())
