#!/usr/bin/env python3
"""Instructions of a step of ten thousand boxes at rest, asleep against awake, counted by callgrind.

  sleep_cost.py <root> --compiler g++ [--system <include dir>...]

Exit status 77: valgrind is not here.
"""
import argparse
import pathlib
import re
import shutil
import sys
import tempfile

from step_cost import run

LIMIT = 0.01  # of an awake step


def count(program, how, steps):
    done = run("valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, how, steps)
    pairs, rows, asleep = (int(word) for word in done.stdout.split())
    return int(re.search(r"refs:\s*([\d,]+)", done.stderr).group(1).replace(",", "")), pairs, rows, asleep


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("root", type=pathlib.Path)
    parser.add_argument("--compiler", default="g++")
    parser.add_argument("--system", nargs="*", default=[])
    arguments = parser.parse_args()
    if not shutil.which("valgrind"):
        print("valgrind is not here (apt-get install valgrind): nothing was counted")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(folder) / "sleep_cost"
        include = [word for directory in arguments.system for word in ("-isystem", directory)]
        run(arguments.compiler, "-std=c++20", "-O3", "-DNDEBUG", "-I", arguments.root / "include", *include,
            arguments.root / "tests" / "zero_cost" / "sleep_cost.cpp", "-o", program)
        awake = count(program, "awake", 2)[0] - count(program, "awake", 1)[0]
        wrong = []
        print(f"awake    {awake:>12} instructions a step")
        for how, most_pairs in [("asleep", 0), ("visited", 1)]:
            (less, *_), (more, pairs, rows, asleep) = count(program, how, 10), count(program, how, 60)
            step = (more - less) / 50
            print(f"{how:<9}{step:>12.0f}, {step / awake:.2%} of it, {pairs} pairs, {rows} rows")
            if asleep != 10000 or pairs > most_pairs or rows > 3 * most_pairs:
                wrong.append(f"{how}: {asleep} sleep, {pairs} pairs, {rows} rows")
            if step > LIMIT * awake:
                wrong.append(f"{how}: {step / awake:.2%} of an awake step, the limit is {LIMIT:.0%}")
    for sentence in wrong:
        print(sentence)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
