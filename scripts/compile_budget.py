#!/usr/bin/env python3
"""Measures what the umbrella header and each example cost to compile, beside their budgets, and keeps the memory from growing.

    scripts/compile_budget.py           compiles each (-O0, object to /dev/null) and writes docs/compile_budget.md
    scripts/compile_budget.py --check [NAME...]
                                        compiles those, or those that have a budget of their own and the three that need
                                        most memory by docs/compile_budget.md, prints, writes nothing

With --check, exit code 1 if one needs more memory than its budget and a tenth more than docs/compile_budget.md records
of the same compiler. Seconds are printed and never fail: they depend on the machine.
"""
import argparse
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

# What is compiled -> (CPU seconds, MB). An example not listed has the budget of "any other".
BUDGETS = {
    "delassus.hpp": (1.5, 300),
    "falling_box": (3, 500),
    "any other": (8, 500),
}


def cost(command):
    """Runs a compiler; returns (CPU seconds, peak MB) of it and its children, or exits with what it said."""
    with tempfile.TemporaryFile() as said:
        child = subprocess.Popen(command, stdout=said, stderr=said, env={**os.environ, "CCACHE_DISABLE": "1"})
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode != 0:
            said.seek(0)
            sys.exit(f"{' '.join(command)}\n{said.read().decode(errors='replace')}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def measure(root, compiler, system, absent, runs, only=None):
    """Rows (name, seconds, MB, budget seconds, budget MB, seconds and MB with compiled.hpp) of all, or of those in `only`;
    the least of so many runs, since company only adds time. A check leaves the last two out."""
    command = [compiler, "-std=c++20", "-O0", f"-I{root / 'include'}", *(f"-isystem{d}" for d in system),
               "-c", "-o", os.devnull]
    units = []
    if (root / "include/delassus/delassus.hpp").exists() and (only is None or "delassus.hpp" in only):
        units.append(("delassus.hpp", ["-x", "c++", str(root / "include/delassus/delassus.hpp")]))
    for path in sorted((root / "examples").glob("*.cpp")):
        if only is not None and path.stem not in only:
            continue
        adapters = re.findall(r"^#include <delassus/adapters/(\w+)", path.read_text(encoding="utf-8"), re.MULTILINE)
        missing = [name for name in absent if any(a.startswith(name) for a in adapters)]
        if missing:
            print(f"{path.stem} is left out: it needs {', '.join(missing)}")
        else:
            units.append((path.stem, [str(path)]))
    for name, arguments in units:
        seconds, memory = min(cost(command + arguments) for _ in range(runs))
        once = None
        if only is None:
            once = min(cost(command + ["-include", "delassus/compiled.hpp"] + arguments) for _ in range(runs))
        yield name, seconds, memory, *BUDGETS.get(name, BUDGETS["any other"]), once


def version_of(compiler):
    first = subprocess.run([compiler, "--version"], text=True, capture_output=True, check=True).stdout.splitlines()[0]
    return first[first.index("("):]  # g++ and c++ are one


def recorded(page, version):
    """What the page records of this compiler: name -> MB; nothing of another one."""
    text = page.read_text(encoding="utf-8") if page.exists() else ""
    if version not in text:
        return {}
    return {name: float(memory) for name, memory in re.findall(r"^\| (\S+) \| [\d.]+ \| [\d.]+ \| (\d+) \|", text, re.MULTILINE)}


def table(rows, version):
    lines = [
        "# What a program costs to compile", "",
        f"g++ {version}, `-std=c++20 -O0`.", "",
        "Written by `scripts/compile_budget.py`. CPU seconds are the least of two runs on one machine, the memory is the",
        "compiler's peak. Eigen's headers alone take 0.75 s and 196 MB. A test keeps the memory of the first two and of the three",
        "largest from growing by a tenth over what stands here; the budgets are the aim, and what is over them is not reached",
        "yet. *Compiled once*: the same file where `delassus/compiled.hpp` leaves to `delassus::compiled` what files of a program share",
        "([guide](guide.md#programs-of-many-files)).", "",
        "| program | CPU s | budget | peak MB | budget | CPU s, compiled once | peak MB |",
        "|---|--:|--:|--:|--:|--:|--:|",
    ]
    for name, seconds, memory, most_seconds, most_memory, once in rows:
        rest = f"{once[0]:.2f} | {once[1]:.0f}" if once else "– | –"
        lines.append(f"| {name} | {seconds:.2f} | {most_seconds:g} | {memory:.0f} | {most_memory:g} | {rest} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("root", nargs="?", type=Path, default=Path(__file__).resolve().parent.parent)
    parser.add_argument("--compiler", default="g++")
    parser.add_argument("--system", nargs="*", default=["/usr/include/eigen3"])
    parser.add_argument("--absent", nargs="*", default=[])
    parser.add_argument("--check", nargs="*", metavar="NAME")
    a = parser.parse_args()

    version, page = version_of(a.compiler), a.root / "docs/compile_budget.md"
    before = recorded(page, version)
    checks = a.check is not None
    only = set(a.check or (*BUDGETS, *sorted(before, key=before.get)[-3:])) if checks and before else None
    rows = list(measure(a.root, a.compiler, a.system, a.absent, 1 if checks else 2, only))
    text = table(rows, version)
    print(text, end="")
    if not checks:
        page.write_text(text, encoding="utf-8")
        return 0
    grown = [(name, memory, before[name]) for name, _, memory, _, most, _ in rows
             if name in before and memory > max(most, 1.1 * before[name])]
    for name, memory, was in grown:
        print(f"compile_budget: {name} needs {memory:.0f} MB, a tenth more than its {was:.0f} MB")
    return 1 if grown else 0


if __name__ == "__main__":
    sys.exit(main())
