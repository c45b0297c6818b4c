#!/usr/bin/env python3
"""Instructions of a step of ten thousand boxes at rest, asleep against awake, counted by callgrind.

  sleep_cost.py <root> --compiler g++ [--system <include dir>...]

Exit status 77: valgrind is not here.
"""
import sys
import tempfile

from programs import NO_VALGRIND, arguments, build, has_valgrind, instructions, verdict

LIMIT = 0.01  # of an awake step


def count(program, how, steps):
    total, printed = instructions(program, how, steps)
    return total, *(int(word) for word in printed.split())


def main():
    given = arguments(__doc__)
    if not has_valgrind():
        return NO_VALGRIND
    with tempfile.TemporaryDirectory() as folder:
        program = build(given, "sleep_cost", folder, "-O3")
        awake = count(program, "awake", 2)[0] - count(program, "awake", 1)[0]
        wrong = []
        print(f"awake    {awake:>12} instructions a step")
        for how, most_pairs in [("asleep", 0), ("visited", 1)]:
            (less, *_), (more, pairs, rows, asleep) = count(program, how, 10), count(program, how, 60)
            step = (more - less) / 50
            print(f"{how:<9}{step:>12.0f}, {step / awake:.2%} of it, {pairs} pairs, {rows} rows")
            if asleep != 10000 or pairs > most_pairs or rows > 3 * most_pairs:
                wrong.append(f"{how}: {asleep} sleep, {pairs} pairs, {rows} rows")
            if step > LIMIT * awake:
                wrong.append(f"{how}: {step / awake:.2%} of an awake step, the limit is {LIMIT:.0%}")
    return verdict(wrong)


if __name__ == "__main__":
    sys.exit(main())
