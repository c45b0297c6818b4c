#!/usr/bin/env python3
"""Says which test sources reach a header, and can build and run just those.

    scripts/tests_of.py HEADER...          a line a source: includes from it to the header, and the source
    scripts/tests_of.py --build HEADER...  builds each of them as a program of its own in build/quick
    scripts/tests_of.py --run HEADER...    builds and runs them

A HEADER is given as rows/islands.hpp or include/delassus/rows/islands.hpp. Nearest first: the test that mirrors the header, then by the
number of includes between. A source that includes delassus/delassus.hpp reaches every header through it; those come last, marked
"umbrella", and only --all builds them too.
"""
import argparse
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^">]+)[">]', re.MULTILINE)
# Sources that are not a Catch2 program by themselves.
OTHER = ("compile_fail", "fuzz", "mutants", "odr", "package", "static", "thread_sanitizer", "trace", "zero_cost")


def header_name(word):
    """rows/islands.hpp of any way to write it; exits where there is none."""
    name = word.removeprefix("./").removeprefix("include/").removeprefix("delassus/")
    if not (ROOT / "include/delassus" / name).is_file():
        sys.exit(f"{word}: there is no header include/delassus/{name}")
    return name


def sources():
    for path in sorted((ROOT / "tests").rglob("*.cpp")):
        if path.relative_to(ROOT / "tests").parts[0] not in OTHER:
            yield path


def target_of(source):
    """The name of the program that CMake's preset quick makes of a test source."""
    return "one_" + "_".join(source.relative_to(ROOT / "tests").with_suffix("").parts)


class Includes:
    """Who includes whom, read once."""

    def __init__(self):
        self.known = {}

    def of(self, path):
        if path not in self.known:
            found = []
            for name in INCLUDE.findall(path.read_text(encoding="utf-8")):
                for folder in (ROOT / "include", path.parent, ROOT / "tests"):
                    if (folder / name).is_file():
                        found.append((folder / name).resolve())
                        break
            self.known[path] = found
        return self.known[path]

    def hops(self, source, through_umbrella=False):
        """Each file that `source` reaches -> the number of includes between them."""
        umbrella = ROOT / "include/delassus/delassus.hpp"
        reached, edge = {source: 0}, [source]
        while edge:
            following = []
            for path in edge:
                if path == umbrella and not through_umbrella:
                    continue
                for target in self.of(path):
                    if target not in reached:
                        reached[target] = reached[path] + 1
                        following.append(target)
            edge = following
        return reached


def tests_of(headers):
    """(hops, source) of each source that reaches one of the headers; hops is None where it does through the umbrella alone."""
    includes, wanted, found = Includes(), [ROOT / "include/delassus" / name for name in headers], []
    umbrella = ROOT / "include/delassus/delassus.hpp"
    mirrors = {Path("tests") / Path(name).with_suffix("") for name in headers}
    for source in sources():
        reached = includes.hops(source)
        hops = [reached[path] for path in wanted if path in reached]
        stem = source.relative_to(ROOT).with_suffix("")
        if any(stem == mirror or (stem.parent == mirror.parent and stem.name.startswith(mirror.name + "_")) for mirror in mirrors):
            found.append((0, source))
        elif hops:
            found.append((min(hops), source))
        elif umbrella in reached and any(path in includes.hops(source, True) for path in wanted):
            found.append((None, source))
    return sorted(found, key=lambda pair: (pair[0] is None, pair[0] or 0, pair[1]))


def build(targets, preset="quick"):
    """Builds these targets; returns those that do not build, and what else does not."""
    folder = ROOT / "build" / preset
    if not (folder / "build.ninja").exists():
        subprocess.run(["cmake", "--preset", preset], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["ninja", "-C", str(folder), "build.ninja"], stdout=subprocess.DEVNULL, check=True)  # sources may have come
    known = subprocess.run(["ninja", "-C", str(folder), "-t", "targets", "all"], text=True, capture_output=True, check=True).stdout
    known = {line.split(":")[0].rsplit("/", 1)[-1] for line in known.splitlines()}
    here = [target for target in targets if target in known]
    for target in set(targets) - set(here):
        print(f"{target} is left out: it needs a component that is not here")
    if not here:
        return []
    jobs = os.environ.get("DELASSUS_JOBS", str(os.cpu_count() or 1))
    failed = []
    with subprocess.Popen(["ninja", "-C", str(folder), "-k", "0", "-j", jobs, *here], cwd=ROOT, text=True, stdout=subprocess.PIPE) as ninja:
        for line in ninja.stdout:
            print(line, end="", flush=True)
            if line.startswith("FAILED: "):
                failed += line.split()[1:]
    if ninja.returncode == 0:
        return []

    def is_of(place, target):
        return place.endswith(f"/{target}") or f"/{target}.dir/" in place

    others = [place for place in failed if not any(is_of(place, target) for target in here)]  # what several targets need
    return [target for target in here if any(is_of(place, target) for place in failed)] + others or here


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("headers", nargs="+", metavar="HEADER")
    parser.add_argument("--build", action="store_true")
    parser.add_argument("--run", action="store_true")
    parser.add_argument("--all", action="store_true", help="also those that reach it through the umbrella alone")
    options = parser.parse_args()
    found = tests_of([header_name(word) for word in options.headers])
    for hops, source in found:
        print(f"{'umbrella' if hops is None else hops:>8}  {source.relative_to(ROOT)}")
    if not (options.build or options.run):
        return 0
    targets = [target_of(source) for hops, source in found if options.all or hops is not None]
    wrong = build(targets)
    for target in wrong:
        print(f"{target} does not build")
    if options.run:
        for target in targets:
            program = ROOT / "build/quick/tests" / target
            if target not in wrong and program.exists() and subprocess.run([str(program)], cwd=program.parent).returncode:
                wrong.append(target)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
