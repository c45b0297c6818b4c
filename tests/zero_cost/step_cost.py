#!/usr/bin/env python3
"""Instructions of a step against the same step written by hand, counted by callgrind.

  step_cost.py <root> --compiler g++ [--system <include dir>...]

Counts do not depend on the machine's load, only on compiler, flags and Eigen. Exit status 77: valgrind is not here.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# Scene, limit of library / hand. The joint's limits guard what was reached; docs/performance.md says why it is no 1.1.
LIMITS = {"particles": 1.02, "bodies": 1.05, "pendulum": 4.0, "pendulums": 3.0}


def run(*words):
    done = subprocess.run([str(w) for w in words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(str(w) for w in words)}\nfailed:\n{done.stdout}{done.stderr}")
    return done


def instructions(program, scene, how, steps=100):
    """Of one step: the difference of two runs, so that the set-up is not counted. And where the scene went."""
    def count(n):
        done = run("valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, scene, how, n)
        return int(re.search(r"refs:\s*([\d,]+)", done.stderr).group(1).replace(",", "")), done.stdout
    (less, _), (more, answer) = count(steps), count(3 * steps)
    return (more - less) / (2 * steps), float(answer)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("root", type=pathlib.Path)
    parser.add_argument("--compiler", default="g++")
    parser.add_argument("--system", nargs="*", default=[])
    arguments = parser.parse_args()
    if not shutil.which("valgrind"):
        print("valgrind is not here (apt-get install valgrind): nothing was counted")
        return 77
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(folder) / "step_cost"
        include = [word for directory in arguments.system for word in ("-isystem", directory)]
        run(arguments.compiler, "-std=c++20", "-O3", "-DNDEBUG", "-I", arguments.root / "include", *include,
            arguments.root / "tests" / "zero_cost" / "step_cost.cpp", "-o", program)

        library = {}
        print(f"{'scene':<12}{'library':>10}{'by hand':>10}{'ratio':>8}{'limit':>8}   instructions of a step")
        for scene, limit in LIMITS.items():
            library[scene], ours = instructions(program, scene, "library")
            by_hand, theirs = instructions(program, scene, "hand")
            ratio = library[scene] / by_hand
            print(f"{scene:<12}{library[scene]:>10.0f}{by_hand:>10.0f}{ratio:>8.3f}{limit:>8.2f}")
            if abs(ours - theirs) > 1e-12:
                wrong.append(f"{scene}: the two ways end at {ours} and {theirs}: they are not the same step")
            if ratio > limit:
                wrong.append(f"{scene}: {ratio:.3f} times the step by hand, the limit is {limit}")

        named, _ = instructions(program, "bodies", "named")
        print(f"defaults named and a listener that hears nothing: {named - library['bodies']:+.0f}")
        if named != library["bodies"]:
            wrong.append("naming the defaults, or a listener that hears nothing, costs instructions")
        more = [instructions(program, scene, "unused")[0] - library[scene] for scene in ("pendulum", "pendulums")]
        print(f"a law without items: {more[0]:+.0f} with one joint of another law, {more[1]:+.0f} with a hundred")
    for sentence in wrong:
        print(sentence)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
