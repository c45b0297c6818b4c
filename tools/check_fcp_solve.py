#!/usr/bin/env python3
"""Runs fcp_solve as a user would: check_fcp_solve.py PROGRAM. What it prints, writes and returns is checked."""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

# A box on a slope: one contact that slips (u = W λ + q with W = 1, μ = 0.5): λ = (1, -0.5, 0).
SLIPS = "fcp 1 sym\n1 1\n0.5\n-1 2 0\n0 0 1 0 0 0 1 0 0 0 1\n"


def run(program, *words):
    done = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=300)
    return done.returncode, done.stdout, done.stderr


def expect(holds, what):
    if not holds:
        sys.exit(f"check_fcp_solve: {what}")


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        problem, out, bad = Path(folder, "slips.fcp"), Path(folder, "out.txt"), Path(folder, "bad.fcp")
        problem.write_text(SLIPS)
        status, text, _ = run(program, problem, "--out", out)
        line = text.splitlines()[1].split()
        expect(status == 0 and line[:3] == ["slips", "1", "converged"], f"one contact: {status} {text}")
        expect(float(line[3]) <= 1e-8 and float(line[4]) <= 1e-8, f"errors: {text}")
        found = [float(x) for x in out.read_text().split()]
        expect(all(abs(a - b) < 1e-8 for a, b in zip(found, [1, -0.5, 0])) and len(found) == 3, f"impulses: {found}")
        status, text, _ = run(program, problem, "--warm", out)
        expect(status == 0 and text.splitlines()[1].split()[5] == "0", f"warm start without a sweep: {text}")
        status, text, _ = run(program, problem, problem, "--solver", "plain", "--stop", "err")
        expect(status == 0 and len(text.splitlines()) == 3, f"two problems: {text}")
        fclib = Path(folder, "slips.hdf5")
        status, text, error = run(program, problem, "--save", fclib)
        if "without HDF5" in error:
            expect(status == 2, f"no HDF5: {status}")
        else:
            expect(status == 0, f"saved in FCLIB's form: {status} {error}")
            again, back = run(program, fclib), Path(folder, "back.fcp")
            expect(again[0] == 0 and again[1].split()[11:16] == text.split()[11:16], f"the same solve: {again[1]} {text}")
            run(program, fclib, "--save", back)
            expect(back.read_text() == SLIPS, f"the same problem: {back.read_text()}")
        bad.write_text(SLIPS.replace("0.5", "-0.5"))
        status, _, error = run(program, bad)
        expect(status == 2 and f"{bad}, line 3: friction -0.5 must be >= 0" in error, f"a bad file: {status} {error}")
        # The eigenvalues of [[1, 2], [2, 1]] are 3 and −1.
        apart = "1 2 0 2 1 0 0 0 1"
        twice = SLIPS.replace("1 1\n", "1 2\n", 1) + "0 0 1 0 0 0 1 0 0 0 1\n"
        for text, line, reason in ((SLIPS.replace("1 0 0 0 1 0 0 0 1", apart), 5, "indefinite"),
                                   (SLIPS.replace("1 0 0 0 1 0 0 0 1", "1 0.5 0 0 1 0 0 0 1"), 5, "symmetric"),
                                   (twice, 6, "given twice, first on line 5")):
            bad.write_text(text)
            status, _, error = run(program, bad)
            expect(status == 2 and f"{bad}, line {line}: " in error and reason in error, f"a bad file: {status} {error}")
        status, text, error = run(program, problem, bad, Path(folder, "none.fcp"), problem)
        expect(status == 2 and [row.split()[2] for row in text.splitlines()[1:]] == ["converged"] * 2,
               f"good files beside bad ones: {status} {text}")
        expect(f"{bad}, line 6" in error and "none.fcp" in error, f"each bad file is told: {error}")
        # λ = 0 has Siconos' error 1/√(1 + μ²)/√5 = 4e-4 for μ = 1000, and all of the penetration.
        steep = Path(folder, "steep.fcp")
        steep.write_text(SLIPS.replace("0.5", "1000"))
        for stop in ("err", "err_s", "both"):
            for solver in ("accelerated", "plain", "path"):
                status, _, _ = run(program, steep, "--tolerance", "1e-3", "--stop", stop, "--solver", solver, "--out", out)
                normal = float(out.read_text().split()[0])
                expect(status == 0 and 1 - normal <= 1e-3 * 5 ** 0.5, f"{stop}, {solver}: no penetration, u_n = {normal - 1}")
        for word in ("--help", "-h"):
            status, text, _ = run(program, word)
            expect(status == 0 and text.startswith("usage: fcp_solve FILE"), f"{word}: {status} {text}")
        status, text, _ = run(program, "--version")
        expect(status == 0 and re.fullmatch(r"fcp_solve \d+\.\d+\.\d+\n", text), f"--version: {status} {text}")
        for words, reason in (([], "usage"), ([problem, "--solver", "magic"], "'magic'"), ([problem, "--tolerance", "x"], "'x'"), ([problem, "--tolerance", "inf"], "'inf'"),
                              ([problem, "--stop", "no"], "'no'"), ([problem, "--nothing", "1"], "--nothing")):
            status, _, error = run(program, *words)
            expect(status == 2 and reason in error, f"{words}: {status} {error}")

    problems = os.environ.get("DELASSUS_PROBLEMS")
    if not problems:
        print("check_fcp_solve: DELASSUS_PROBLEMS is not set, no problem file solved")
        return
    files = sorted(Path(problems).glob("*.fcp"))
    hard = [f for f in files if f.stem.startswith("RockPile")]
    status, text, _ = run(program, *[f for f in files if f not in hard], "--stop", "err")
    expect(status == 0, f"not all of {problems} reach 1e-8:\n{text}")
    # It may converge or not within the second, but says what its error is.
    for file in hard:
        status, text, _ = run(program, file, "--stop", "err", "--time-limit", 1)
        line = text.splitlines()[1].split()
        expect((status == 0) == (float(line[3]) <= 1e-8) == (line[2] == "converged"), f"{file.stem}: {status} {text}")
    # Two curves that are plain and two whose sweeps go in circles: the path leads there without a sweep, by both errors.
    plain = [f for f in files if f.stem.startswith(("OneObject", "BoxesStack", "LMGC"))]
    status, text, _ = run(program, *plain, "--solver", "path")
    expect(not plain or status == 0, f"not all reach 1e-8 along the path:\n{text}")
    expect(all(int(line.split()[5]) == 0 for line in text.splitlines()[1:]), f"sweeps along the path:\n{text}")
    # Minutes where the machine is slow: every problem to 1e-8 by both errors, RockPile too.
    if os.environ.get("DELASSUS_LONG"):
        status, text, _ = run(program, *files, "--solver", "path", "--time-limit", 40)
        expect(status == 0, f"not all of {problems} reach 1e-8 along the path:\n{text}")
    print(f"check_fcp_solve: {len(files)} problems")


if __name__ == "__main__":
    main()
