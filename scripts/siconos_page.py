#!/usr/bin/env python3
"""Tables and diagrams of what compare_siconos measured.

    scripts/siconos_page.py results RESULTS.csv [--svg FILE]    the tables of docs/evidence/siconos.md on stdout, performance profiles
    scripts/siconos_page.py curves CURVES.csv --svg FILE        error against time
    scripts/siconos_page.py halves SCENES.csv --limit S         the problems of scenes, in two halves; S is the limit of a solve, s
    scripts/siconos_page.py --self-test                         what tests of the tree run

A problem is of the tuning half or of the reported half by a hash of its name: of FNV-1a with 64 bits, bit 32.
A performance profile tells of each solver which share of the problems it solves within τ times the time of the fastest.
Source: [DolanMore2002].
"""
import argparse
import csv
import math
import re
import statistics
from pathlib import Path

OWN, PLAIN = "delassus", "delassus-plain"
COLOURS = ["#c0392b", "#1f4e79", "#2e86c1", "#7fb3d5", "#117a65", "#58b09c", "#8e44ad", "#b7950b", "#7f8c8d", "#e84393", "#d35400"]
INK, GRID = "#333333", "#dddddd"


def read(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def solved(row):
    return row is not None and row["status"] in ("converged", "timed")


def seconds(row):
    return float(row["seconds"])


def mean(ratios):
    return math.exp(statistics.fmean(map(math.log, ratios))) if ratios else float("nan")


def by_problem(rows, tolerance):
    """{problem: {solver: row}} in the order of the number of contacts."""
    table = {}
    for row in sorted(rows, key=lambda r: (-int(r["contacts"]), r["problem"])):
        if row["tolerance"] == tolerance:
            table.setdefault(row["problem"], {})[row["solver"]] = row
    return table


def best(row_of):
    """The fastest of Siconos' that got there, or None."""
    there = [r for s, r in row_of.items() if not s.startswith(OWN) and solved(r)]
    return min(there, key=seconds) if there else None


def fnv1a(text):
    """FNV-1a with 64 bits."""
    value = 0xCBF29CE484222325
    for byte in text.encode():
        value = (value ^ byte) * 0x100000001B3 % 2**64
    return value


def half(problem):
    return "reported" if fnv1a(problem) >> 32 & 1 else "tuning"


def milliseconds(row):
    return f"{1e3 * seconds(row):.3g}" if solved(row) else "–"


# --- tables ------------------------------------------------------------------------------------------------------------

def cell(row_of):
    own, other = row_of.get(OWN), best(row_of)
    if solved(own) and other:
        return f"{milliseconds(own)} / {milliseconds(other)} {other['solver']} / {seconds(other) / seconds(own):.1f}"
    return f"{milliseconds(own)} / {milliseconds(other) + ' ' + other['solver'] if other else '–'} /"


def print_times(rows, tolerances):
    tables = {t: by_problem(rows, t) for t in tolerances}
    print("| problem | contacts | " + " | ".join(tolerances) + " |")
    print("|---|--:|" + "---|" * len(tolerances))
    for problem, row_of in tables[tolerances[0]].items():
        contacts = next(iter(row_of.values()))["contacts"]
        print(f"| {problem} | {contacts} | " + " | ".join(cell(tables[t].get(problem, {})) for t in tolerances) + " |")
    print("\n| tolerance | problems of 20 contacts and more | mean ratio | with `build` | least | against NSGS as it is by default | all problems |")
    print("|---|--:|--:|--:|--:|--:|--:|")
    for t in tolerances:
        large, built, default, every = [], [], [], []
        for row_of in tables[t].values():
            own, other, plain = row_of.get(OWN), best(row_of), row_of.get("NSGS")
            if not solved(own) or other is None:
                continue
            ratio = seconds(other) / seconds(own)
            every.append(ratio)
            if int(own["contacts"]) < 20:
                continue
            large.append(ratio)
            built.append(seconds(other) / (seconds(own) + float(own["build"])))
            if solved(plain):
                default.append(seconds(plain) / seconds(own))
        print(f"| {t} | {len(large)} | {mean(large):.1f} | {mean(built):.1f} | {min(large):.1f} | {mean(default):.0f} ({len(default)} solved) | {mean(every):.1f} |")


class Tally:
    """Ratios of some problems at one tolerance: Siconos' fastest over ours."""

    def __init__(self, rows_of, limit):
        self.ratios, self.with_limit, self.ours, self.theirs, self.neither = [], [], 0, 0, 0
        for row_of in rows_of:
            own, other = row_of.get(OWN), best(row_of)
            times = seconds(own) if solved(own) else None, seconds(other) if other else None
            if None not in times:
                self.ratios.append(times[1] / times[0])
            self.ours += times[0] is not None
            self.theirs += times[1] is not None
            self.neither += times == (None, None)
            if times != (None, None):  # who did not get there takes the limit at least
                self.with_limit.append((times[1] or limit) / (times[0] or limit))
        self.count = len(rows_of)

    def cells(self):
        least = f"{min(self.ratios):.2g}" if self.ratios else "–"
        counts = f"{self.count} | {self.ours} | {self.theirs} | {self.neither}"
        return f"{counts} | {len(self.ratios)} | {mean(self.ratios):.1f} | {least} | {mean(self.with_limit):.1f}"


SIZES = [(20, 60), (60, 180), (180, 540), (540, 3001)]


def halves_page(rows, limit):
    """The tables of the problems of scenes, as text."""
    tolerances = tolerances_of(rows)
    tables = {t: by_problem(rows, t) for t in tolerances}
    out = ["| half | error | problems | solved by delassus | by Siconos | by neither | by both | mean ratio | least | with the limit |",
           "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|"]
    for which in ("reported", "tuning"):
        for t in tolerances:
            out.append(f"| {which} | {t} | {Tally([r for p, r in tables[t].items() if half(p) == which], limit).cells()} |")
    out += ["", "By the number of contacts:", "", "| contacts | reported, tuning | " + " | ".join(f"{t}, reported | tuning" for t in tolerances) + " |",
            "|---|--:|" + "--:|" * 2 * len(tolerances)]
    for low, high in SIZES:
        cells, counts = [], []
        for t in tolerances:
            for which in ("reported", "tuning"):
                some = [r for p, r in tables[t].items() if half(p) == which and low <= int(r[OWN]["contacts"]) < high]
                tally = Tally(some, limit)
                counts.append(str(tally.count))
                cells.append(f"{mean(tally.ratios):.1f} ({len(tally.ratios)})" if tally.ratios else "– (0)")
        out.append(f"| {low} to {high - 1} | {', '.join(counts[:2])} | " + " | ".join(cells) + " |")
    return "\n".join(out) + "\n"


def means(rows, limit, which):
    """`8.9, 12.7 and 13.3`, as the front page has them."""
    figures = [f"{mean(Tally([r for p, r in by_problem(rows, t).items() if half(p) == which], limit).ratios):.1f}" for t in tolerances_of(rows)]
    return ", ".join(figures[:-1]) + " and " + figures[-1]


def tolerances_of(rows):
    tolerances = [t for t in dict.fromkeys(r["tolerance"] for r in rows) if t != "sweep"]
    return sorted(tolerances, key=float, reverse=True)


def print_sweeps(rows):
    print("| problem | blocks a row | µs | ns a block | Siconos' fastest, µs | ratio | its default, µs | ratio |")
    print("|---|--:|--:|--:|--:|--:|--:|--:|")
    fastest, default = [], []
    for problem, row_of in by_problem(rows, "sweep").items():
        own, other, plain = row_of.get(PLAIN), best(row_of), row_of.get("NSGS")
        if not solved(own) or other is None or int(own["contacts"]) < 20:
            continue
        blocks = int(own["blocks"])
        fastest.append(seconds(other) / seconds(own))
        line = f"| {problem} | {blocks / int(own['contacts']):.1f} | {1e6 * seconds(own):.2f} | {1e9 * seconds(own) / blocks:.1f} | "
        line += f"{1e6 * seconds(other):.2f} {other['solver']} | {fastest[-1]:.1f} | "
        if solved(plain):
            default.append(seconds(plain) / seconds(own))
            line += f"{1e6 * seconds(plain):.1f} | {default[-1]:.1f} |"
        print(line if solved(plain) else line + "– | – |")
    print(f"\nMedians: {statistics.median(fastest):.1f} × its fastest local solver, {statistics.median(default):.1f} × its default; "
          f"geometric means {mean(fastest):.1f} and {mean(default):.1f}.")


def print_robustness(rows, tolerances):
    """Who reaches what within the limit, over all problems."""
    names = sorted({r["solver"] for r in rows if r["tolerance"] in tolerances})
    print("| solver | " + " | ".join(tolerances) + " |")
    print("|---|" + "--:|" * len(tolerances))
    for name in names:
        counts = [sum(solved(row_of.get(name)) for row_of in by_problem(rows, t).values()) for t in tolerances]
        print(f"| {name} | " + " | ".join(map(str, counts)) + " |")


# --- diagrams ----------------------------------------------------------------------------------------------------------

class Panel:
    """Axes with log scale in x; y is given in [0, 1] from below."""

    def __init__(self, left, top, width, height, low, high, title):
        self.left, self.top, self.width, self.height, self.low, self.high = left, top, width, height, math.log10(low), math.log10(high)
        self.parts = [f'<text x="{left + width / 2:.0f}" y="{top - 10:.0f}" text-anchor="middle" font-weight="bold">{title}</text>']

    def x(self, value):
        return self.left + self.width * (math.log10(value) - self.low) / (self.high - self.low)

    def y(self, share):
        return self.top + self.height * (1 - share)

    def frame(self, y_marks, x_label):
        for k in range(math.ceil(self.low), math.floor(self.high) + 1):
            at = self.x(10.0**k)
            self.parts.append(f'<line x1="{at:.1f}" y1="{self.top}" x2="{at:.1f}" y2="{self.top + self.height}" stroke="{GRID}"/>')
            self.parts.append(f'<text x="{at:.1f}" y="{self.top + self.height + 16}" text-anchor="middle">{power(k)}</text>')
        for share, mark in y_marks:
            self.parts.append(f'<line x1="{self.left}" y1="{self.y(share):.1f}" x2="{self.left + self.width}" y2="{self.y(share):.1f}" stroke="{GRID}"/>')
            self.parts.append(f'<text x="{self.left - 6}" y="{self.y(share) + 4:.1f}" text-anchor="end">{mark}</text>')
        self.parts.append(f'<text x="{self.left + self.width / 2:.0f}" y="{self.top + self.height + 34}" text-anchor="middle">{x_label}</text>')

    def line(self, points, colour, is_own, marks=False):
        path = " ".join(f"{self.x(a):.1f},{self.y(b):.1f}" for a, b in points)
        self.parts.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="{3 if is_own else 1.6}"/>')
        if marks:
            self.parts += [f'<circle cx="{self.x(a):.1f}" cy="{self.y(b):.1f}" r="2.5" fill="{colour}"/>' for a, b in points]


def power(k):
    return {0: "1", 1: "10", 2: "100"}.get(k, f'10<tspan dy="-4" font-size="9">{k}</tspan><tspan dy="4"> </tspan>')


def write_svg(path, panels, names, width, height):
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12" fill="{INK}">',
             f'<rect width="{width}" height="{height}" fill="white"/>']
    for panel in panels:
        parts += panel.parts
    across = 6
    for k, name in enumerate(names):
        x, y = 50 + (k % across) * (width - 60) / across, height - 34 + 18 * (k // across)
        parts.append(f'<line x1="{x:.0f}" y1="{y - 4}" x2="{x + 20:.0f}" y2="{y - 4}" stroke="{COLOURS[k % len(COLOURS)]}" stroke-width="{3 if name == OWN else 1.6}"/>')
        parts.append(f'<text x="{x + 26:.0f}" y="{y}">{name}</text>')
    Path(path).write_text("\n".join(parts + ["</svg>", ""]), encoding="utf-8")


def draw_profiles(rows, tolerances, path):
    names = [OWN] + sorted({r["solver"] for r in rows if not r["solver"].startswith(OWN)} - {"NSGS-NSN_GP", "NSN_AC_TEST", "NSGS-relaxed"})
    panels = []
    for k, t in enumerate(tolerances):
        table = by_problem(rows, t)
        panel = Panel(60 + 320 * k, 40, 270, 250, 1, 1e4, f"error {t}")
        panel.frame([(s / 4, f"{25 * s} %") for s in range(5)], "time / time of the fastest")
        for name in reversed(names):
            ratios = []
            for row_of in table.values():
                there = [seconds(r) for r in row_of.values() if solved(r) and r["solver"] in names]
                if solved(row_of.get(name)):
                    ratios.append(seconds(row_of[name]) / min(there))
            points, share = [(1, 0)], 0
            for ratio in sorted(ratios):
                if ratio > 1e4:
                    break
                points += [(ratio, share)]
                share += 1 / len(table)
                points += [(ratio, share)]
            panel.line(points + [(1e4, share)], COLOURS[names.index(name) % len(COLOURS)], name == OWN)
        panels.append(panel)
    write_svg(path, panels, names, 1000, 400)


def draw_curves(rows, path):
    rows = [r for r in rows if solved(r) and float(r["err"]) > 0 and r["solver"] != PLAIN]
    problems = list(dict.fromkeys(r["problem"] for r in rows))
    names = [OWN] + sorted({r["solver"] for r in rows} - {OWN, "NSGS-NSN_GP", "NSN_AC_TEST", "NSGS-relaxed", "NSGS-QUARTIC-full"})
    panels = []
    for k, problem in enumerate(problems):
        some = [r for r in rows if r["problem"] == problem and r["solver"] in names]
        low, high = min(map(seconds, some)), max(map(seconds, some))
        panel = Panel(60 + 490 * (k % 2), 40 + 320 * (k // 2), 420, 230, 1e3 * low * 0.8, 1e3 * high * 1.2, problem)
        panel.frame([(e / 10, power(e - 10)) for e in range(0, 11, 2)], "ms")
        for name in reversed(names):
            points = sorted((1e3 * seconds(r), min(max(1 + math.log10(float(r["err"])) / 10, 0), 1)) for r in some if r["solver"] == name)
            if points:
                panel.line(points, COLOURS[names.index(name) % len(COLOURS)], name == OWN, marks=True)
        panels.append(panel)
    write_svg(path, panels, names, 1000, 70 + 320 * math.ceil(len(problems) / 2) + 30)


# --- its test ------------------------------------------------------------------------------------------------------------

def self_test():
    for text, value in [("", 0xCBF29CE484222325), ("a", 0xAF63DC4C8601EC8C), ("foobar", 0x85944171F73967E8)]:
        assert fnv1a(text) == value, f"FNV-1a of '{text}'"
    assert [half(p) for p in ("", "a", "foobar")] == ["tuning", "tuning", "reported"]

    def row(solver, time):
        return {"solver": solver, "status": "converged" if time else "time", "seconds": str(time or 0)}

    both, alone, lost, none = ({r["solver"]: r for r in (row(OWN, a), row("NSGS", b), row("PROX", c))}
                               for a, b, c in [(1, 8, 4), (1, 0, 0), (0, 2, 0), (0, 0, 0)])
    tally = Tally([both, alone, lost, none], 16)
    assert (tally.ours, tally.theirs, tally.neither, tally.ratios) == (2, 2, 1, [4])
    assert tally.with_limit == [4, 16, 2 / 16], "who did not get there takes the limit"

    docs = Path(__file__).resolve().parent.parent / "docs" / "evidence"
    rows, page = read(docs / "siconos" / "scenes.csv"), (docs / "siconos.md").read_text(encoding="utf-8")
    sizes = {r["problem"]: int(r["contacts"]) for r in rows}
    assert len(sizes) >= 80 and min(sizes.values()) >= 20 and max(sizes.values()) <= 3000
    limit = float(re.search(r"halves \S+ --limit ([0-9.]+)", page)[1])
    assert halves_page(rows, limit) in page, "docs/evidence/siconos.md is not what halves prints of siconos/scenes.csv"
    front = (docs.parent.parent / "README.md").read_text(encoding="utf-8")
    for which in ("reported", "tuning"):
        assert means(rows, limit, which) in front, f"README.md has other figures for the {which} half than siconos/scenes.csv"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["results", "curves", "halves"], nargs="?")
    parser.add_argument("table", nargs="?")
    parser.add_argument("--svg")
    parser.add_argument("--limit", type=float)
    parser.add_argument("--self-test", action="store_true")
    given = parser.parse_args()
    if given.self_test:
        return self_test()
    if given.table is None or (given.what == "halves" and given.limit is None):
        parser.error("name what to print, its table, and for halves the limit of a solve")
    rows = read(given.table)
    if given.what == "halves":
        return print(halves_page(rows, given.limit), end="")
    if given.what == "curves":
        return draw_curves(rows, given.svg)
    tolerances = tolerances_of(rows)
    print_times(rows, tolerances)
    print()
    print_sweeps(rows)
    print()
    print_robustness(rows, tolerances)
    if given.svg:
        draw_profiles(rows, tolerances, given.svg)


if __name__ == "__main__":
    main()
