#!/usr/bin/env python3
"""Compiles every header by itself, with each compiler, two at a time; syntax only.

    scripts/check_headers.py [ROOT] --compiler g++ clang++ --system /usr/include/eigen3 [--absent fcl] [--cache DIR] [--shown]
                             [--only HEADER...]

The first compiler sees the header alone; what the header reaches of Eigen, and no more, it finds precompiled. A clang after it
is asked for what it alone refuses: it starts from a precompiled Eigen and gets sixteen headers at a time, and only where it
refuses them each by itself.

A header that passed is not compiled again until it, or a delassus header it includes, has changed (--cache).
Adapters of an absent component are skipped, and counted. --shown takes those alone that README, docs/ and examples/ include.
"""
import argparse
import hashlib
import os
import re
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

INCLUDE = re.compile(r"^\s*#\s*include\s*<(delassus/[^>]+)>", re.MULTILINE)
EIGEN = re.compile(r"^\s*#\s*include\s*<(Eigen/[^>]+)>", re.MULTILINE)
PART_OF_EIGEN = "delassus/math/eigen.hpp"  # leaves parts of Eigen out, which a head start must not bring
# The warnings of cmake/programs.cmake, as errors: a user may compile with all of them.
FLAGS = ["-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wnon-virtual-dtor",
         "-Woverloaded-virtual", "-Werror", "-Wno-missing-field-initializers"]


def closure(include, header, seen):
    """`header` and every delassus header it reaches, as paths below include/."""
    if header not in seen and (include / header).exists():
        seen.add(header)
        for target in INCLUDE.findall((include / header).read_text(encoding="utf-8")):
            closure(include, target, seen)
    return seen


def eigen_of(include, header):
    """The headers of Eigen that `header` reaches, or of ours that reads a part of it, sorted."""
    if header == PART_OF_EIGEN:
        return ()
    parts = closure(include, header, set())
    texts = [(include / part).read_text(encoding="utf-8") for part in parts - {PART_OF_EIGEN}]
    return tuple(sorted({name for text in texts for name in EIGEN.findall(text)} | parts & {PART_OF_EIGEN}))


def stamp_of(include, header, command):
    """A name for this header, compiled by this command: equal names, equal outcome."""
    digest = hashlib.sha256(repr(command).encode())
    for part in sorted(closure(include, header, set())):
        digest.update(part.encode() + (include / part).read_bytes())
    return digest.hexdigest()


def compile_unit(headers, command, head_start):
    """Returns what the compiler said, or None if it takes the headers."""
    # Included twice: the second time, #pragma once must make it vanish.
    unit = "".join(f"#include <{header}>\n#include <{header}>\n" for header in headers)
    done = subprocess.run(command + head_start + ["-x", "c++", "-"], input=unit, text=True, capture_output=True)
    return done.stderr if done.returncode != 0 else None


def compile_batch(include, headers, command, head_start, cache):
    """(header, what the compiler said) for each that is refused by itself, or the first of a batch that is refused as one."""
    stamps = [cache / stamp_of(include, header, command) for header in headers] if cache else []
    if stamps and all(stamp.exists() for stamp in stamps):
        return []
    said = compile_unit(headers, command, head_start)
    if said is None:
        for stamp in stamps:
            stamp.touch()
        return []
    if len(headers) == 1:
        return [(headers[0], said)]
    alone = [(header, compile_unit([header], command, head_start)) for header in headers]
    return [(header, text) for header, text in alone if text is not None] or [(headers[0], said)]


def precompiled(folder, command, version, names):
    """Flags by which this compiler starts from these headers of Eigen, precompiled."""
    source = Path(folder) / (hashlib.sha256(repr((command, names)).encode()).hexdigest()[:8] + ".hpp")
    source.write_text("".join(f"#include <{name}>\n" for name in names))
    is_clang = "clang" in version
    result = Path(f"{source}.pch" if is_clang else f"{source}.gch")
    command = [part for part in command if part != "-fsyntax-only"]
    subprocess.run(command + ["-x", "c++-header", str(source), "-o", str(result)], check=True)
    return ["-include-pch", str(result)] if is_clang else ["-include", str(source)]


def shown(root):
    """The headers that pages and examples include."""
    files = [root / "README.md", *(p for folder in ("docs", "examples") for p in (root / folder).rglob("*.[chm]*"))]
    return sorted({name for p in files for name in INCLUDE.findall(p.read_text(encoding="utf-8"))})


def check(include, compilers, system, absent, cache, jobs, only=None):
    started = time.monotonic()
    headers = only or sorted(p.relative_to(include).as_posix() for p in include.rglob("*.hpp"))
    skipped = [h for h in headers if any(h.startswith(f"delassus/adapters/{name}") for name in absent)]
    headers = [h for h in headers if h not in skipped]
    if cache:
        cache.mkdir(parents=True, exist_ok=True)
    tasks = []
    folder = tempfile.TemporaryDirectory()
    for compiler in compilers:
        version = subprocess.run([compiler, "--version"], text=True, capture_output=True, check=True).stdout
        command = [compiler, *FLAGS, f"-I{include}", *(f"-isystem{d}" for d in system),
                   f"-DDELASSUS_CHECKED_BY_{hashlib.sha256(version.encode()).hexdigest()[:8]}"]
        if compiler != compilers[0] and "clang" in version and system:
            head_start = precompiled(folder.name, command, version, [PART_OF_EIGEN])
            tasks += [(compiler, headers[k:k + 16], command, head_start) for k in range(0, len(headers), 16)]
            continue
        by_eigen = {}
        for header in headers:
            by_eigen.setdefault(eigen_of(include, header), []).append(header)
        for names, those in by_eigen.items():
            # Precompiling takes as long as two headers do.
            head_start = precompiled(folder.name, command, version, names) if names and len(those) > 3 else []
            tasks += [(compiler, [header], command, head_start) for header in those]
    with ThreadPoolExecutor(jobs) as pool:
        said = list(pool.map(lambda task: compile_batch(include, *task[1:], cache), tasks))
    failed = [(task[0], header, text) for task, refused in zip(tasks, said) for header, text in refused]
    for compiler, header, text in failed:
        print(f"{header} does not compile alone with {compiler}:\n{text}")
    print(f"check_headers: {len(headers)} headers x {len(compilers)} compilers, {len(skipped)} skipped, "
          f"{len(failed)} failed, {time.monotonic() - started:.1f} s")
    return failed


def self_test(compilers):
    """A sound header passes; one that lacks an include, or its #pragma once, is told."""
    wrong = 0
    for name, text, fails in [("sound", "#pragma once\n#include <vector>\nstruct A { std::vector<int> x; };\n", False),
                              ("lacks_include", "#pragma once\nstruct A { std::vector<int> x; };\n", True),
                              ("lacks_once", "struct A {};\n", True)]:
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "delassus").mkdir()
            (Path(folder) / "delassus" / f"{name}.hpp").write_text(text)
            failed = check(Path(folder), compilers, [], [], None, 1)
            if len(failed) != (len(compilers) if fails else 0):
                wrong += 1
                print(f"self-test {name}: expected {'a failure' if fails else 'success'} of each compiler")
    print(f"check_headers: 3 self-tests, {wrong} failed")
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("root", nargs="?", type=Path, default=Path(__file__).resolve().parent.parent)
    parser.add_argument("--compiler", nargs="+", default=["g++"])
    parser.add_argument("--system", nargs="*", default=["/usr/include/eigen3"])
    parser.add_argument("--absent", nargs="*", default=[])
    parser.add_argument("--cache", type=Path)
    parser.add_argument("--jobs", type=int, default=min(2, os.cpu_count() or 1))
    parser.add_argument("--only", nargs="*", metavar="HEADER", help="as delassus/rows/islands.hpp")
    parser.add_argument("--shown", action="store_true")
    parser.add_argument("--self-test", action="store_true")
    a = parser.parse_args()
    if a.self_test:
        return 1 if self_test(a.compiler) else 0
    return 1 if check(a.root / "include", a.compiler, a.system, a.absent, a.cache, a.jobs, a.only or (shown(a.root) if a.shown else None)) else 0


if __name__ == "__main__":
    sys.exit(main())
