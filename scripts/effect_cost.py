#!/usr/bin/env python3
"""What each effect costs: instructions of a step of ten boxes, counted by callgrind.

    scripts/effect_cost.py                    prints the table
    scripts/effect_cost.py --docs FILE        and puts it between the two marks `effects` of a page
    scripts/effect_cost.py NAME...            only these rows, "ball joint" say; with --docs the others stay as the page has them

Counts depend on compiler, flags and Eigen, not on the machine's load. Every row is a program of its own, compiled with -O3: some
five seconds and 400 MB each. The steps counted are the hundred after the first three hundred, in which the boxes come to rest.
"""
import argparse
import os
import re
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "zero_cost"))
from programs import has_valgrind, instructions, run  # noqa: E402

SETTLED, COUNTED = 300, 100

# Row of the table · name in effects.cpp · which variant of it · the row it is compared with · whether it can be stacked
EFFECTS = [
    ("bodies that fall, nothing else", "bodies_alone", "one", None, False),
    ("contact without friction", "frictionless", "one", "bodies that fall, nothing else", True),
    ("Coulomb friction", "friction", "one", "contact without friction", True),
    ("restitution", "restitution", "one", "Coulomb friction", True),
    ("no warm start", "cold_start", "one", "Coulomb friction", True),
    ("`SoftContact` for `Baumgarte`", "soft_contact", "one", "Coulomb friction", True),
    ("`Sleeping`, all awake", "sleeping", "one", "Coulomb friction", True),
    ("`Sleeping`, all asleep", "sleeping", "other", "Coulomb friction", True),
    ("listener `Stopwatch`", "stopwatch", "one", "Coulomb friction", True),
    ("a ball joint each, no contact", "ball_joint", "one", "bodies that fall, nothing else", False),
    ("a hinge each, no contact", "hinge", "one", "bodies that fall, nothing else", False),
    ("a limit on each hinge, out of reach", "hinge_limit", "one", "a hinge each, no contact", False),
    ("a limit on each hinge, at its stop", "hinge_limit", "other", "a hinge each, no contact", False),
    ("`PositionProjection` for `Baumgarte`", "position_projection", "one", "Coulomb friction", True),
    ("`ProximalNewton` for sweeps", "newton", "one", "Coulomb friction", True),
    ("listener `DoubleBuffer`", "double_buffer", "one", "Coulomb friction", True),
    ("a joint law without a joint", "law_without_item", "one", "Coulomb friction", True),
    ("`Penalty` springs with friction", "penalty", "one", "Coulomb friction", True),
    ("`PredictiveScheme`", "prediction", "one", "Coulomb friction", True),
    ("`Substeps`, four", "substeps", "one", "Coulomb friction", True),
    ("listener `Recorder`", "recorder", "one", "Coulomb friction", True),
    ("a virtual coupling that holds one box", "coupling", "one", "Coulomb friction", True),
    ("`HapticChannel` that publishes it", "haptics", "one", "a virtual coupling that holds one box", True),
    ("a motor on each hinge", "hinge_motor", "one", "a hinge each, no contact", False),
]


def count(program, place, variant):
    """Instructions of one step."""
    less, more = (instructions(program, place, variant, steps)[0] for steps in (SETTLED, SETTLED + COUNTED))
    return (more - less) / COUNTED


def measure(names, compiler, system):
    """{row: [apart, stacked or None]}"""
    figures = {}
    with tempfile.TemporaryDirectory() as folder:
        for title, effect, variant, _, can_stack in EFFECTS:
            if names and not any(name in title or name == effect for name in names):
                continue
            program = Path(folder) / effect
            if not program.exists():
                run(compiler, "-std=c++20", "-O3", "-DNDEBUG", f"-DDELASSUS_EFFECT={effect}", "-I", ROOT / "include", "-isystem",
                    system, ROOT / "scripts" / "effect_cost" / "effects.cpp", "-o", program)
            figures[title] = [count(program, place, variant) if place == "apart" or can_stack else None
                              for place in ("apart", "stacked")]
            print(title, figures[title], flush=True)
    return figures


def number(value):
    return "" if value is None else f"{round(value):,}".replace(",", " ")


def beside(value, base):
    """How much more than another row, in per cent or in times."""
    if value is None or base is None:
        return ""
    ratio = value / base
    if ratio >= 2:
        return f"{ratio:.2g} ×"
    more = 100 * (ratio - 1)
    digits = ".2g" if abs(more) < 10 else ".1f" if more < -90 else ".0f"
    return f"{more:+{digits}} %".replace("-", "−")


def table(figures):
    lines = ["| effect | compared with | apart | beside it | stacked | beside it |", "| --- | --- | --: | --: | --: | --: |"]
    for title, _, _, base, _ in EFFECTS:
        if title not in figures:
            continue
        own, other = figures[title], figures.get(base, [None, None])
        cells = [title, base or "", number(own[0]), beside(own[0], other[0]), number(own[1]), beside(own[1], other[1])]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def published(page):
    """What the page has: {row: [apart, stacked or None]}."""
    figures = {}
    for line in page.read_text(encoding="utf-8").split("<!-- effects -->")[-1].split("<!-- end of effects -->")[0].splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 6 and cells[2].replace(" ", "").isdigit():
            figures[cells[0]] = [int(cell.replace(" ", "")) if cell else None for cell in (cells[2], cells[4])]
    return figures


def put(page, text):
    old = page.read_text(encoding="utf-8")
    new, found = re.subn(r"(<!-- effects -->\n).*?(<!-- end of effects -->)", lambda m: m[1] + text + m[2], old, flags=re.DOTALL)
    if found != 1:
        sys.exit(f"{page} has no lines '<!-- effects -->' and '<!-- end of effects -->' for the table to stand between")
    page.write_text(new, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--docs", type=Path)
    parser.add_argument("--compiler", default=os.environ.get("CXX", "g++"))
    parser.add_argument("--system", default="/usr/include/eigen3", help="the include directory of Eigen")
    options = parser.parse_args()
    if not has_valgrind():
        return 1
    figures = measure(options.names, options.compiler, options.system)
    if not figures:
        print("no effect of this name")
        return 2
    if options.docs:
        figures = {**(published(options.docs) if options.names else {}), **figures}
    text = table(figures)
    print(text, end="")
    if options.docs:
        put(options.docs, text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
