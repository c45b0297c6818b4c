#!/usr/bin/env python3
"""Counts the library's lines of code, after clang-format.

    scripts/lines.py                   a line for each room of include/delassus, and the total
    scripts/lines.py loop bodies       those rooms only
    scripts/lines.py --files           every header as well
    scripts/lines.py --if-constexpr    how often `if constexpr` occurs, in a second column
    scripts/lines.py --root DIR        the same of another tree, which has include/delassus below it

Not counted: blank lines, lines of comment alone, #include and #pragma once lines and the text inside raw string literals. Headers
outside the rooms stand under the room "." . clang-format reads each header from a pipe; no file is changed.
"""
import argparse
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# A raw string, a string, a character or a comment, whichever begins first; the digit guards 1'000.
TOKEN = re.compile(
    r'(?P<raw>\bR"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)")|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\''
    r"|(?P<comment>//[^\n]*|/\*.*?\*/)", re.DOTALL)
NO_CODE = re.compile(r"\s*(#\s*(include\b|pragma\s+once)|$)")
IF_CONSTEXPR = re.compile(r"\bif\s+constexpr\b")


def bare(match):
    """What stays of a token: a comment leaves nothing, a raw string its two ends."""
    if match["comment"]:
        return " "
    return '""' if match["raw"] else match[0]


def formatted(header, style):
    command = ["clang-format", f"--style=file:{style}", "--assume-filename=header.hpp"]
    return subprocess.run(command, input=header.read_text(encoding="utf-8"), capture_output=True, text=True, check=True).stdout


def count(header, style):
    """Lines of code of a header, and how many `if constexpr` are in them."""
    code = TOKEN.sub(bare, formatted(header, style))
    lines = [line for line in code.splitlines() if not NO_CODE.match(line)]
    return len(lines), len(IF_CONSTEXPR.findall("\n".join(lines)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rooms", nargs="*", metavar="ROOM")
    parser.add_argument("--files", action="store_true")
    parser.add_argument("--if-constexpr", action="store_true")
    parser.add_argument("--root", type=Path, default=ROOT)
    args = parser.parse_args()
    if not shutil.which("clang-format"):
        sys.exit("lines.py needs clang-format, which is not on the PATH: lines are counted as it lays them out")
    library = args.root / "include/delassus"
    rooms = {}
    for header in sorted(library.rglob("*.hpp")):
        name = header.relative_to(library)
        rooms.setdefault(name.parts[0] if len(name.parts) > 1 else ".", []).append(header)
    unknown = [room for room in args.rooms if room not in rooms]
    if unknown or not rooms:
        sys.exit(f"{library} has no room {unknown[0]}" if unknown else f"{library} holds no headers")

    def row(lines, branches, name):
        print(f"{lines:7}  " + (f"{branches:4}  " if args.if_constexpr else "") + str(name))

    total = [0, 0]
    for room in args.rooms or sorted(rooms):
        with ThreadPoolExecutor() as pool:
            counts = list(pool.map(lambda header: count(header, ROOT / ".clang-format"), rooms[room]))
        if args.files:
            for header, (lines, branches) in zip(rooms[room], counts):
                row(lines, branches, header.relative_to(library))
        sums = [sum(column) for column in zip(*counts)]
        row(*sums, f"{room}/" if room != "." else ".")
        total = [a + b for a, b in zip(total, sums)]
    row(*total, "total")


if __name__ == "__main__":
    main()
