#!/usr/bin/env python3
"""Writes the table of docs/README.md that says what holds, out of the one of docs/evidence/ladders.md.

    scripts/front_page.py            writes it
    scripts/front_page.py --check    exit code 1 if it is not what would be written; a test of the tree

Of each hard case on which another engine was measured: how far the parts that get furthest get.
"""
import re
import sys
from pathlib import Path

DOCS = Path(__file__).resolve().parent.parent / "docs"
MARKS = re.compile(r"(<!-- what holds -->\n).*?(<!-- end of what holds -->)", re.DOTALL)


def rows(page):
    """The rows of the ladders' table, each a dictionary."""
    table = page.split("<!-- ladders -->\n")[1].split("<!-- end of ladders -->")[0].splitlines()
    lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in table]
    return [dict(zip(lines[0], cells)) for cells in lines[2:]]


def rungs(cell):
    """How many of a row's rungs a cell says are reached, as a share of all."""
    if cell.startswith("all"):
        return 1.0
    found = re.match(r"(\d+) of (\d+)", cell)
    return int(found[1]) / int(found[2]) if found else 0.0


def table(page):
    cases = {}
    for row in rows(page):
        if row["best peer"] == "not measured" or row["best peer"].startswith("–"):
            continue
        best = cases.get(row["case"])
        order = [(rungs(r["silver"]), rungs(r["gold"])) for r in (row, best) if r]
        if best is None or order[0] > order[1]:
            cases[row["case"]] = row
    lines = ["| hard case | parts besides the defaults | silver | gold | best peer, and ours so |", "| --- | --- | --- | --- | --- |"]
    for case, row in cases.items():
        lines.append(f"| {case} | {row['parts']} | {row['silver']} | {row['gold']} | {row['best peer']} |")
    return "\n".join(lines) + "\n"


def main():
    page = DOCS / "README.md"
    old = page.read_text(encoding="utf-8")
    text = table((DOCS / "ladders.md").read_text(encoding="utf-8"))
    new, found = MARKS.subn(lambda m: m[1] + text + m[2], old)
    if found != 1:
        print(f"{page.name} has no marks for the table of what holds")
        return 1
    if "--check" not in sys.argv:
        page.write_text(new, encoding="utf-8")
    elif new != old:
        print("docs/README.md does not say what docs/evidence/ladders.md says; scripts/front_page.py brings it up to date")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
