#!/usr/bin/env python3
"""Checks a change in minutes: what `./run quick` does.

    scripts/quick.py [HEADER|ROOM...]   what is named, or else what differs from the last commit, or else what that changed
    scripts/quick.py --all              every trace, every wrong program of one compiler and every example too
    scripts/quick.py --write            writes tests/zero_cost/counts.txt anew, and checks nothing

In this order: rooms and levels; each changed header alone; a wrong program of each role; memory and functions of examples/stack.cpp; then
the programs are built: the traces (tests/trace; for laws alone those of contacts, joints, particles and problems), the steps that are
counted, warm steps without allocation, and the tests nearest to the change; then they run. Each line says what it checked, how long it
took and what it found; exit code 1 if anything is wrong.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from compile_budget import cost
from tests_of import ROOT, build, target_of, tests_of

FOLDER = ROOT / "build/quick"
COUNTS = ROOT / "tests/zero_cost/counts.txt"
EIGEN = os.environ.get("DELASSUS_EIGEN", "/usr/include/eigen3")
ONE_A_ROLE = ("bodies_of_no_set integrator_without_advance collision_without_detect compliance_without_operator "
              "law_without_linearize stabilisation_without_equality solver_without_solve scheme_without_run "
              "listener_without_after policy_without_role contact_of_nothing item_without_ends").split()
MOST_TESTS = 6  # of those nearest to the change; scripts/tests_of.py runs the rest
LAW_TRACES, LAW_TESTS = ("contacts", "joints", "particles", "problems"), 3  # a law's rows are all made and solved in these
MORE = {"instructions": 1.02, "MB": 1.03, "functions": 1.0}  # than the count that is stored


def run(*words, **more):
    return subprocess.run([str(w) for w in words], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd=ROOT, **more)


class Report:
    def __init__(self):
        self.wrong = 0

    def line(self, title, seconds, said=""):
        """One check: what it found wrong, or nothing."""
        print(f"{title:<66}{seconds:7.1f} s{'  FAILED' if said else ''}", flush=True)
        if said:
            self.wrong += 1
            print("  " + "\n  ".join(said.rstrip().splitlines()[-40:]), flush=True)

    def each(self, tasks, together=""):
        """Runs (title, function) two at a time; a function returns what is wrong, or nothing. `together`: one line for all that pass."""
        def timed(task):
            start = time.monotonic()
            said = task[1]()
            return time.monotonic() - start, said
        start = time.monotonic()
        wrong = self.wrong
        with ThreadPoolExecutor(2) as pool:
            for task, (seconds, said) in zip(tasks, pool.map(timed, tasks)):
                if said or not together:
                    self.line(task[0], seconds, said)
        if together and self.wrong == wrong:
            self.line(together, time.monotonic() - start)


def changed(words):
    """(headers below include/delassus, test sources) that the words name, or that git says were changed."""
    if words:
        headers = []
        for word in words:
            place = ROOT / "include/delassus" / word.removeprefix("include/").removeprefix("delassus/")
            if place.is_dir():
                headers += sorted(place.rglob("*.hpp"))
            elif place.is_file():
                headers.append(place)
            else:
                sys.exit(f"./run quick: '{word}' is neither a header nor a room of include/delassus")
        return [path.relative_to(ROOT / "include/delassus").as_posix() for path in headers], []
    since = ["git", "status", "--porcelain", "-uall", "--no-renames"]
    files = [line[3:] for line in run(*since).stdout.splitlines()]
    if not any(name.startswith(("include/", "tests/")) for name in files):
        files = run("git", "diff", "--name-only", "HEAD~1", "HEAD").stdout.splitlines()
    files = [name for name in files if (ROOT / name).is_file()]
    headers = [name.removeprefix("include/delassus/") for name in files if re.match(r"include/delassus/.*\.hpp$", name)]
    tests = [ROOT / name for name in files if re.match(r"tests/(?!compile_fail|trace|zero_cost).*\.cpp$", name)]
    return headers, tests


def headers_alone(headers):
    def check():
        done = run(sys.executable, ROOT / "scripts/check_headers.py", "--compiler", "clang++", "--system", EIGEN, "--cache",
                   FOLDER / "headers_alone", "--jobs", "1", "--only", *(f"delassus/{name}" for name in headers))
        return done.stdout if done.returncode else ""
    return check


def wrong_program(name):
    def check():
        done = run("cmake", f"-DSOURCE={ROOT}/tests/compile_fail/{name}.cpp", "-DCOMPILER=clang++", f"-DINCLUDE={ROOT}/include",
                   f"-DSYSTEM={EIGEN}", f"-DPRECOMPILED={FOLDER}/compile_fail", "-P", ROOT / "tests/compile_fail/expect_error.cmake")
        return done.stdout if done.returncode else ""
    return check


def precompile():
    done = run("cmake", "-DCOMPILER=clang++", "-DIS_CLANG=ON", f"-DINCLUDE={ROOT}/include", f"-DSYSTEM={EIGEN}",
               f"-DPRECOMPILED={FOLDER}/compile_fail", "-P", ROOT / "tests/compile_fail/precompile.cmake")
    return done.stdout if done.returncode else ""


def cost_of_stack():
    """Peak MB and functions of examples/stack.cpp, g++ -O0."""
    result = FOLDER / "stack.o"
    result.parent.mkdir(parents=True, exist_ok=True)
    _, memory, functions = cost(["g++", "-std=c++20", "-O0", f"-I{ROOT}/include", "-isystem", EIGEN, "-c",
                                 str(ROOT / "examples/stack.cpp")], str(result))
    return {"stack MB": memory, "stack functions": functions}


def instructions_of(name, steps):
    """Instructions of one step, by the difference of two runs, so that the set-up is not counted."""
    def count(n):
        said = run("valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", FOLDER / "tests" / f"counted_{name}", n).stdout
        return int(re.search(r"refs:\s*([\d,]+)", said).group(1).replace(",", ""))
    return {f"{name} instructions": (count(3 * steps) - count(steps)) / (2 * steps)}


def stored():
    lines = (line.split() for line in COUNTS.read_text().splitlines() if line and not line.startswith("#"))
    return {" ".join(words[:-1]): float(words[-1]) for words in lines}


def against(count):
    """What of {name: count} is more than is stored."""
    def check():
        before, said = stored(), ""
        for name, value in count().items():
            limit = before[name] * MORE[name.split()[-1]]
            if value > limit:
                said += f"{name}: {value:.0f}, at most {limit:.0f} ({before[name]:.0f} are stored)\n"
        return said
    return check


def program_check(path, *words):
    def check():
        done = run(path, *words)
        return done.stdout + f"\n{path.name} ended with {done.returncode}" if done.returncode else ""
    return check


def near(headers, tests, most):
    """The tests to run, nearest first, and how many more reach the headers."""
    found = [source for hops, source in tests_of(headers) if hops is not None] if headers else []
    chosen = list(dict.fromkeys([*tests, *found]))
    return chosen[:max(most, len(tests))], len(chosen) - min(len(chosen), max(most, len(tests)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", nargs="*", metavar="HEADER|ROOM")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    start, report = time.monotonic(), Report()
    headers, tests = changed(options.words)

    if not (FOLDER / "build.ninja").exists() or options.all:
        done = run("cmake", "--preset", "quick")
        if done.returncode:
            report.line("configure (quick)", time.monotonic() - start, done.stdout)
            return 1
    counted = ["ten_boxes", "pendulum"] if shutil.which("valgrind") else []
    if options.write:
        build([f"counted_{name}" for name in counted])
        counts = cost_of_stack()
        for name in counted:
            counts |= instructions_of(name, 100)
        text = "".join(line + "\n" for line in COUNTS.read_text().splitlines() if line.startswith("#")) if COUNTS.exists() else ""
        COUNTS.write_text(text + "".join(f"{name} {value:.0f}\n" for name, value in counts.items()))
        print(COUNTS.read_text(), end="")
        return 0

    print(f"changed: {' '.join(headers) or 'no header'}")
    tasks = [("rooms and levels", program_check(ROOT / "scripts/check_includes.py"))]
    if headers:
        tasks.append((f"{len(headers)} changed headers alone (clang++)", headers_alone(headers)))
    if shutil.which("g++"):
        tasks.append(("stack.cpp, g++ -O0: peak memory and functions", against(cost_of_stack)))
    tasks.append(("the umbrella precompiled", precompile))
    report.each(tasks)
    wrong = sorted(path.stem for path in (ROOT / "tests/compile_fail").glob("*.cpp")) if options.all else ONE_A_ROLE
    report.each([(f"one sentence for {name}", wrong_program(name)) for name in wrong], f"{len(wrong)} wrong programs, one sentence each")

    traces = sorted(path.stem for path in (ROOT / "tests/trace").glob("*.cpp"))
    if not options.all:
        traces = [name for name in traces if not name.endswith("_more")]
    is_law = headers and not options.all and all(re.match("constraints/(contact|joints)/", name) for name in headers)
    if is_law:
        print(f"only laws were changed: the traces {', '.join(name for name in traces if name not in LAW_TRACES)} are left out")
        traces = [name for name in traces if name in LAW_TRACES]
    near_tests, left = near(headers, tests, LAW_TESTS if is_law else MOST_TESTS)
    programs = {**{f"trace_{name}": ("--data", ROOT / "tests/trace/data") for name in traces}, "one_allocations_plain_steps": (),
                **{target_of(source): () for source in near_tests}}
    examples = [f"example_{path.stem}" for path in sorted((ROOT / "examples").glob("*.cpp"))] if options.all else []
    began = time.monotonic()
    print(f"building {len(traces)} traces, {len(counted)} counted steps, {len(programs) - len(traces)} tests"
          f"{f', {len(examples)} examples' if examples else ''}", flush=True)
    unbuilt = build([*programs, *(f"counted_{name}" for name in counted), *examples])
    report.line("build", time.monotonic() - began, "\n".join(f"{name} does not build" for name in unbuilt))

    tasks = [(f"{name}: instructions of a step", against(lambda name=name: instructions_of(name, 100)))
             for name in counted if f"counted_{name}" not in unbuilt]
    tasks += [(name, program_check(FOLDER / "tests" / name, *words)) for name, words in programs.items()
              if name not in unbuilt and (FOLDER / "tests" / name).exists()]
    report.each(tasks)
    if examples:
        began = time.monotonic()
        done = run("ctest", "--test-dir", FOLDER, "-R", "^example/", "-j", "2", "--output-on-failure")
        report.line("what the examples print", time.monotonic() - began, done.stdout if done.returncode else "")
    if left:
        print(f"{left} more tests reach this: scripts/tests_of.py --run {' '.join(headers[:3])}{' …' if len(headers) > 3 else ''}")
    print(f"./run quick: {report.wrong} wrong, {time.monotonic() - start:.0f} s")
    return 1 if report.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
