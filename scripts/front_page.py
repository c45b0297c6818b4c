#!/usr/bin/env python3
"""Makes what the front page of docs/ shows of the rest: two pictures of the evidence, and the list of pages.

    scripts/front_page.py            writes docs/pictures/hard_cases.svg, docs/pictures/effects.svg, the table of docs/evidence/what_holds.md
                                     and the list of docs/README.md
    scripts/front_page.py --check    exit code 1 if they are not what would be written; a test of the tree

The pictures are of docs/evidence/ladders/peers.csv and of the table of docs/evidence/effects.md, the table is of docs/evidence/ladders.md.
"""
import csv
import html
import re
import sys
from pathlib import Path

import build_site as site

DOCS = Path(__file__).resolve().parent.parent / "docs"
MARKS = re.compile(r"(<!-- what holds -->\n).*?(<!-- end of what holds -->)", re.DOTALL)
PAGES = re.compile(r"(<!-- pages -->\n).*?(<!-- end of pages -->)", re.DOTALL)
ENGINES = ["delassus", "MuJoCo", "DART", "ODE", "Bullet"]
ALL, SOME, NONE = "#2c7fb8", "#a6cfe3", "#f2ab7c"
TEXT = 'font-family="sans-serif" fill="#333"'


# --- the table ------------------------------------------------------------------------------------------------------------

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
    """Of each hard case on which another engine was measured: how far the parts that get furthest get."""
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


# --- the pictures ----------------------------------------------------------------------------------------------------------

def picture(width, height, parts):
    return "\n".join([f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}">',
                      f'<rect width="{width}" height="{height}" fill="white"/>', *parts, "</svg>"]) + "\n"


def word(x, y, text, size=13, anchor="start"):
    return f'<text x="{x}" y="{y}" font-size="{size}" text-anchor="{anchor}" {TEXT}>{html.escape(text)}</text>'


def hard_cases(results):
    """A square for each case and engine: silver on all rungs, on some, on none, by the engine's setting that got furthest. Cases on which no
    other engine ran are left out; an engine that did not run has no square."""
    shares, titles = {}, {}
    for row in results:
        engine = next(e for e in ENGINES if row["engine"].startswith(e))
        if not row["silver"]:
            continue
        titles[row["case"], row["title"]] = True
        key = (row["case"], row["title"], engine)
        shares[key] = max(shares.get(key, 0), int(row["silver"]) / int(row["rungs"]))
    cases = [c for c in titles if any((*c, e) in shares for e in ENGINES[1:])]
    wide, left, side, top = 110, 380, 18, 70
    parts = [word(left + wide * (k + 0.5), top - 10, engine, 14, "middle") for k, engine in enumerate(ENGINES)]
    for k, (colour, text) in enumerate(((ALL, "good on every rung"), (SOME, "on some"), (NONE, "on none"))):
        parts += [f'<rect x="{10 + 190 * k}" y="10" width="{side}" height="{side}" fill="{colour}"/>', word(34 + 190 * k, 24, text, 14)]
    for line, case in enumerate(cases):
        y = top + line * (side + 3)
        parts.append(word(left - 12, y + 13, f"{case[0]} {case[1]}", 12, "end"))
        for k, engine in enumerate(ENGINES):
            share = shares.get((*case, engine))
            if share is not None:
                colour = ALL if share == 1 else SOME if share > 0 else NONE
                parts.append(f'<rect x="{left + wide * k + 8}" y="{y}" width="{wide - 16}" height="{side}" rx="3" fill="{colour}"/>')
    return picture(left + wide * len(ENGINES) + 10, top + len(cases) * (side + 3) + 10, parts)


def effects(page):
    """A bar for each effect: instructions of a step of ten boxes with it, as a multiple of those without, apart from each other."""
    text = page.split("<!-- effects -->\n")[1].split("<!-- end of effects -->")[0].splitlines()[2:]
    cells = [[c.strip() for c in line.strip("|").split("|")] for line in text]
    counts = {name: int(apart.replace(" ", "")) for name, _, apart, *_ in cells}
    bars = [(name, base, counts[name] / counts[base]) for name, base, *_ in cells if base]
    left, step, top, scale = 480, 24, 44, 34
    parts = [word(10, 24, "Instructions of a step, as a multiple of the step without the effect (ten boxes apart)", 14)]
    for line, (name, base, ratio) in enumerate(bars):
        y = top + line * step
        parts += [word(left - 10, y + 14, f"{name.replace('`', '')}, on top of: {base}" if base != "Coulomb friction" else name.replace("`", ""), 12, "end"),
                  f'<rect x="{left}" y="{y}" width="{max(ratio, 0.02) * scale:.0f}" height="18" rx="3" fill="{ALL if ratio <= 1.1 else SOME if ratio <= 2 else NONE}"/>',
                  word(left + max(ratio, 1) * scale + 8, y + 14, f"{ratio:.2f} ×", 12)]
    parts.append(f'<line x1="{left + scale}" x2="{left + scale}" y1="{top - 6}" y2="{top + len(bars) * step}" stroke="#333" stroke-dasharray="3 3"/>')
    return picture(left + 420, top + len(bars) * step + 12, parts)


def all_pages():
    """A line for each folder: its pages by their titles."""
    lines = []
    for folder, title in site.MENU.items():
        pages = [f"[{site.title_of(page).replace('`', '')}]({page.relative_to(DOCS)})" for page in site.pages_in(folder)]
        lines.append(f"- **{title}**: " + (" · ".join(pages) if folder != "decisions" else "[a question, a choice and its reasons each](decisions)"))
    return "\n".join([*lines, "- **Sources**: [references](references.md)"]) + "\n"


def made():
    """Path -> text of all that this writes."""
    front = DOCS / "README.md"
    list_of_pages, found = PAGES.subn(lambda m: m[1] + all_pages() + m[2], front.read_text(encoding="utf-8"))
    if found != 1:
        sys.exit(f"{front.name} has no marks for the list of pages")
    held = DOCS / "evidence/what_holds.md"
    text, found = MARKS.subn(lambda m: m[1] + table((DOCS / "evidence/ladders.md").read_text(encoding="utf-8")) + m[2], held.read_text(encoding="utf-8"))
    if found != 1:
        sys.exit(f"{held.name} has no marks for the table of what holds")
    with open(DOCS / "evidence/ladders/peers.csv", encoding="utf-8", newline="") as results:
        cases = hard_cases(list(csv.DictReader(results)))
    return {front: list_of_pages, held: text, DOCS / "pictures/hard_cases.svg": cases,
            DOCS / "pictures/effects.svg": effects((DOCS / "evidence/effects.md").read_text(encoding="utf-8"))}


def main():
    is_old = False
    for path, text in made().items():
        if "--check" not in sys.argv:
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, encoding="utf-8")
        elif not path.exists() or path.read_text(encoding="utf-8") != text:
            print(f"{path.relative_to(DOCS.parent)} is not of the evidence; scripts/front_page.py brings it up to date")
            is_old = True
    return 1 if is_old else 0


if __name__ == "__main__":
    sys.exit(main())
