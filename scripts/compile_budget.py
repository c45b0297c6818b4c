#!/usr/bin/env python3
"""Measures what the umbrella header and each example cost to compile, and keeps memory and functions from growing.

    scripts/compile_budget.py           compiles each (-O0), with delassus/compiled.hpp and without, and writes docs/evidence/compile_budget.md
    scripts/compile_budget.py --check [NAME...]
                                        compiles those, or those that have a budget of their own and the three that need
                                        most memory by docs/evidence/compile_budget.md, prints, writes nothing

With --check, exit code 1 if one needs more memory, or makes more functions, than its budget and a tenth more than
docs/evidence/compile_budget.md records of the same compiler: no load changes these two. CPU time is printed in units of what
`#include <Eigen/Dense>` takes beside it, and never fails.
"""
import argparse
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

# What is compiled -> (MB, functions), and the same with compiled.hpp. An example not listed has the budget of "any other".
BUDGETS = {
    "delassus.hpp": (290, None),
    "falling_box": (330, 1000),
    "stack": (420, 3000),
    "crane": (520, 5000),
    "any other": (520, 5000),
}
COMPILED_BUDGETS = {"stack": (300, 800), "crane": (320, 1000)}
CHECKED_COMPILED = ("stack", "crane")


def cost(command, object_file):
    """Runs a compiler; returns (CPU seconds, peak MB, functions in the object), or exits with what it said."""
    with tempfile.TemporaryFile() as said:
        child = subprocess.Popen([*command, "-o", object_file], stdout=said, stderr=said, env={**os.environ, "CCACHE_DISABLE": "1"})
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode != 0:
            said.seek(0)
            sys.exit(f"{' '.join(command)}\n{said.read().decode(errors='replace')}")
    symbols = subprocess.run(["nm", object_file], text=True, capture_output=True, check=True).stdout
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, len(re.findall(r" [tTwW] ", symbols))


def measure(root, compiler, system, absent, runs, only=None):
    """E in seconds, then rows (name, cost, cost with compiled.hpp or None) of all, or of those in `only`; of so many runs the one of
    least CPU time, since company only adds to it. A check compiles with compiled.hpp what has a budget for it."""
    command = [compiler, "-std=c++20", "-O0", f"-I{root / 'include'}", *(f"-isystem{d}" for d in system), "-c"]
    units = []
    if only is None or "delassus.hpp" in only:
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
    with tempfile.TemporaryDirectory() as folder:
        out, eigen = os.path.join(folder, "out.o"), os.path.join(folder, "eigen.cpp")
        Path(eigen).write_text("#include <Eigen/Dense>\n")
        yield min(cost([*command, eigen], out) for _ in range(max(runs, 2)))[0]
        for name, arguments in units:
            alone = min(cost([*command, *arguments], out) for _ in range(runs))
            once = None
            if name != "delassus.hpp" and (only is None or name in CHECKED_COMPILED):
                once = min(cost([*command, "-include", "delassus/compiled.hpp", *arguments], out) for _ in range(runs))
            yield name, alone, once


def version_of(compiler):
    first = subprocess.run([compiler, "--version"], text=True, capture_output=True, check=True).stdout.splitlines()[0]
    return first[first.index("("):]  # g++ and c++ are one


def recorded(page, version):
    """What the page records of this compiler: name -> (MB, functions, the same with compiled.hpp or None); nothing of another one."""
    text = page.read_text(encoding="utf-8") if page.exists() else ""
    if version not in text:
        return {}
    rows = re.findall(r"^\| (\S+) \| [\d.]+ \| (\d+) \| (\d+) \| \S+ \| (\d+|–) \| (\d+|–) \|", text, re.MULTILINE)
    return {name: tuple(float(x) if x != "–" else None for x in numbers) for name, *numbers in rows}


def table(eigen, rows, version):
    lines = [
        "# What a program costs to compile", "",
        f"g++ {version}, `-std=c++20 -O0`.", "",
        "Written by `scripts/compile_budget.py`. E is the CPU time of `#include <Eigen/Dense>`, least of two runs like the others; it needs",
        "196 MB. MB is the compiler's peak, functions are those in the object (`nm`): these two no load changes, and a test keeps",
        "them from growing. *Compiled once*: the same file with `delassus/compiled.hpp`, which leaves to `delassus::compiled` what files of",
        "a program share ([how to](../how_to/keep_a_loop_in_a_class.md)).", "",
        "| program | E | MB | functions | E, compiled once | MB | functions |",
        "|---|--:|--:|--:|--:|--:|--:|",
    ]
    for name, alone, once in rows:
        rest = f"{once[0] / eigen:.1f} | {once[1]:.0f} | {once[2]}" if once else "– | – | –"
        lines.append(f"| {name} | {alone[0] / eigen:.1f} | {alone[1]:.0f} | {alone[2]} | {rest} |")
    lines += ["", "Budgets, MB and functions: " + "; ".join(
        f"{name} {memory}" + (f" and {functions}" if functions else "") for name, (memory, functions) in BUDGETS.items()) +
        ". Compiled once: " + "; ".join(f"{name} {memory} and {functions}" for name, (memory, functions) in COMPILED_BUDGETS.items()) + "."]
    over = [f"{name} {got[k]:.0f} {unit}" + (", compiled once" if budgets is COMPILED_BUDGETS else "")
            for name, alone, once in rows for budgets, got in ((BUDGETS, alone), (COMPILED_BUDGETS, once)) if got
            for k, unit in ((1, "MB"), (2, "functions"))
            if (most := budgets.get(name, BUDGETS["any other"] if budgets is BUDGETS else (None, None))[k - 1]) and got[k] > most]
    if over:
        lines.append("Over their budgets are: " + "; ".join(over) + ".")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("root", nargs="?", type=Path, default=Path(__file__).resolve().parent.parent)
    parser.add_argument("--compiler", default="g++")
    parser.add_argument("--system", nargs="*", default=["/usr/include/eigen3"])
    parser.add_argument("--absent", nargs="*", default=[])
    parser.add_argument("--check", nargs="*", metavar="NAME")
    a = parser.parse_args()

    version, page = version_of(a.compiler), a.root / "docs/evidence/compile_budget.md"
    before = recorded(page, version)
    checks = a.check is not None
    only = set(a.check or (*BUDGETS, *sorted(before, key=lambda name: before[name][0])[-3:])) if checks and before else None
    eigen, *rows = measure(a.root, a.compiler, a.system, a.absent, 1 if checks else 2, only)
    text = table(eigen, rows, version)
    print(text, end="")
    if not checks:
        page.write_text(text, encoding="utf-8")
        return 0
    grown = []
    for name, alone, once in rows:
        if name not in before:
            continue
        was = before[name]
        most = BUDGETS.get(name, BUDGETS["any other"]) + COMPILED_BUDGETS.get(name, (None, None))
        now = alone[1:] + (once[1:] if once else (None, None))
        units = ("MB", "functions", "MB, compiled once", "functions, compiled once")
        for n, w, m, unit in zip(now, was, most, units):
            # Two in a hundred, for another build of the same compiler.
            is_held = name in BUDGETS and m and w and w <= m
            if n and w and n > (1.02 * m if is_held else max(m or 0, 1.1 * w)):
                grown.append(f"{name} needs {n:.0f} {unit}, " + (f"more than its {m}" if is_held else f"a tenth more than {w:.0f}"))
    for sentence in grown:
        print(f"compile_budget: {sentence}")
    return 1 if grown else 0


if __name__ == "__main__":
    sys.exit(main())
