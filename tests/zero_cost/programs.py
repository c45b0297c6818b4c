"""Programs that are built and counted: what the scripts of this folder share."""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys

NO_VALGRIND = 77  # exit status: nothing was counted


def arguments(description):
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("root", type=pathlib.Path)
    parser.add_argument("--compiler", default="g++")
    parser.add_argument("--system", nargs="*", default=[], help="include directories of Eigen")
    return parser.parse_args()


def run(*words):
    """Runs it in the C locale; ends this script when it fails."""
    done = subprocess.run([str(w) for w in words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          env={"LC_ALL": "C", "PATH": "/usr/local/bin:/usr/bin:/bin"})
    if done.returncode != 0:
        sys.exit(f"{' '.join(str(w) for w in words)}\nfailed:\n{done.stdout}{done.stderr}")
    return done


def build(given, name, folder, *flags):
    """The program of tests/zero_cost/<name>.cpp."""
    program = pathlib.Path(folder) / name
    include = [word for directory in given.system for word in ("-isystem", directory)]
    run(given.compiler, "-std=c++20", *flags, "-DNDEBUG", "-I", given.root / "include", *include,
        given.root / "tests" / "zero_cost" / f"{name}.cpp", "-o", program)
    return program


def has_valgrind():
    if shutil.which("valgrind"):
        return True
    print("valgrind is not here (apt-get install valgrind): nothing was counted")
    return False


def instructions(program, *words):
    """How many the program executes, by callgrind, and what it printed."""
    done = run("valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, *words)
    return int(re.search(r"refs:\s*([\d,]+)", done.stderr).group(1).replace(",", "")), done.stdout


def verdict(wrong):
    for sentence in wrong:
        print(sentence)
    return 1 if wrong else 0
