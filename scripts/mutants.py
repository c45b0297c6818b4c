#!/usr/bin/env python3
"""Tests the tests: breaks the library in one place at a time and expects the named test to notice.

    scripts/mutants.py [NAME...]     each mutant: its test program must pass on the library as it is and fail on the mutant
    scripts/mutants.py --check       only: each mutant still finds what it replaces, once (no compiler; a test of the tree)
    scripts/mutants.py --self-test   a mutant that breaks nothing, and one that finds nothing, must be told

A mutant is a file tests/mutants/NAME.txt: what it breaks, in which header, which test kills it, and pairs of lines, "- " what
stands there once and "+ " what takes its place. Exit code 1 if a mutant lives.
"""
import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


class Mutant:
    def __init__(self, name, text):
        self.name, self.changes, old = name, [], None
        said = {}
        for line in text.splitlines():
            if line.startswith("- "):
                old = line[2:]
            elif line.startswith("+ ") or line == "+":
                self.changes.append((old, line[2:]))
            else:
                key, _, value = line.partition(": ")
                said[key] = value
        self.what, self.header, self.test = said["what"], said["file"], said["killed by"]

    def apply(self, text):
        """The header with the mutation, or a sentence that says why it has none."""
        for old, new in self.changes:
            # A line of the mutant may be a part of another's: the whole text counts.
            if text.count(old) != 1:
                return None, f"{self.name}: {self.header} has '{old}' {text.count(old)} times, not once"
            text = text.replace(old, new)
        return text, None


def mutants(names=()):
    for path in sorted((ROOT / "tests" / "mutants").glob("*.txt")):
        if not names or path.stem in names:
            yield Mutant(path.stem, path.read_text(encoding="utf-8"))


def compile_and_run(compiler, system, include, test, main, folder):
    """'passes', 'fails', or 'does not compile' or 'hangs'."""
    program = folder / "program"
    is_trace = "/trace/" in test  # it has a main of its own, and compares with what is stored
    build = [compiler, "-std=c++20", "-O1", "-w", f"-I{include}", f"-I{ROOT / 'tests'}", "-isystem", system,
             str(ROOT / test), *([] if is_trace else [str(main)]), "-o", str(program)]
    words = ["--data", str(ROOT / "tests/trace/data")] if is_trace else []
    if subprocess.run(build, capture_output=True).returncode:
        return "does not compile"
    try:
        done = subprocess.run([str(program), *words], capture_output=True, timeout=120, cwd=folder)
    except subprocess.TimeoutExpired:
        return "hangs"
    return "fails" if done.returncode else "passes"


def check():
    wrong = [said for mutant in mutants() for _, said in [mutant.apply((ROOT / mutant.header).read_text(encoding="utf-8"))] if said]
    for said in wrong:
        print(said)
    for mutant in mutants():
        if not (ROOT / mutant.test).exists():
            wrong.append(f"{mutant.name}: there is no {mutant.test}")
            print(wrong[-1])
    return not wrong


def hunt(list_of_mutants, compiler, system):
    alive, sound = 0, {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        main = folder / "main.o"
        source = folder / "main.cpp"
        source.write_text('#define CATCH_CONFIG_MAIN\n#include "catch.hpp"\n')
        subprocess.run([compiler, "-std=c++20", "-O1", "-w", f"-I{ROOT / 'tests'}", "-c", str(source), "-o", str(main)], check=True)
        for mutant in list_of_mutants:
            start = time.monotonic()
            if mutant.test not in sound:
                sound[mutant.test] = compile_and_run(compiler, system, ROOT / "include", mutant.test, main, folder)
            text, said = mutant.apply((ROOT / mutant.header).read_text(encoding="utf-8"))
            if text is None:
                verdict = said
            elif sound[mutant.test] != "passes":
                verdict = f"{mutant.test} {sound[mutant.test]} on the library as it is"
            else:
                copy = folder / "include"
                shutil.copytree(ROOT / "include", copy)
                (copy / Path(mutant.header).relative_to("include")).write_text(text, encoding="utf-8")
                result = compile_and_run(compiler, system, copy, mutant.test, main, folder)
                shutil.rmtree(copy)
                verdict = {"fails": "killed", "hangs": "killed, it hangs"}.get(result, f"LIVES: {mutant.test} {result}")
            alive += not verdict.startswith("killed")
            print(f"{mutant.name}: {verdict} ({mutant.what}; {time.monotonic() - start:.0f} s)", flush=True)
    return alive


def self_test(compiler, system):
    base = "file: include/delassus/stabilisation/baumgarte.hpp\nkilled by: tests/stabilisation/baumgarte.cpp\n"
    harmless = Mutant("harmless", "what: nothing\n" + base + "- double max_speed = 1;\n+ double max_speed = 1.0;\n")
    lost = Mutant("lost", "what: nothing\n" + base + "- no such line\n+ x\n")
    if hunt([harmless, lost], compiler, system) != 2:
        print("self-test: a mutant that lives, or finds nothing, was not told")
        return False
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--self-test", action="store_true")
    parser.add_argument("--compiler", default=os.environ.get("CXX", "g++"))
    parser.add_argument("--system", default="/usr/include/eigen3", help="the include directory of Eigen")
    options = parser.parse_args()
    if options.check:
        return 0 if check() else 1
    if options.self_test:
        return 0 if self_test(options.compiler, options.system) else 1
    chosen = list(mutants(options.names))
    if not chosen:
        print("no mutant of this name in tests/mutants")
        return 2
    alive = hunt(chosen, options.compiler, options.system)
    print(f"{len(chosen) - alive} of {len(chosen)} mutants killed")
    return 1 if alive else 0


if __name__ == "__main__":
    sys.exit(main())
