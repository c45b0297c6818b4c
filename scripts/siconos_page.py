#!/usr/bin/env python3
"""Tables and diagrams of what compare_siconos measured.

    scripts/siconos_page.py results RESULTS.csv [--svg FILE]    the tables of docs/evidence/siconos.md on stdout, performance profiles
    scripts/siconos_page.py curves CURVES.csv --svg FILE        error against time

A performance profile tells of each solver which share of the problems it solves within τ times the time of the fastest.
Source: [DolanMore2002].
"""
import argparse
import csv
import math
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


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["results", "curves"])
    parser.add_argument("table")
    parser.add_argument("--svg")
    given = parser.parse_args()
    rows = read(given.table)
    if given.what == "curves":
        return draw_curves(rows, given.svg)
    tolerances = [t for t in dict.fromkeys(r["tolerance"] for r in rows) if t != "sweep"]
    tolerances.sort(key=float, reverse=True)
    print_times(rows, tolerances)
    print()
    print_sweeps(rows)
    print()
    print_robustness(rows, tolerances)
    if given.svg:
        draw_profiles(rows, tolerances, given.svg)


if __name__ == "__main__":
    main()
