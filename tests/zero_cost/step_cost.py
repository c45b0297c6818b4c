#!/usr/bin/env python3
"""Instructions of a step against the same step written by hand, counted by callgrind.

  step_cost.py <root> --compiler g++ [--system <include dir>...]

Counts do not depend on the machine's load, only on compiler, flags and Eigen. Exit status 77: valgrind is not here.
"""
import sys
import tempfile

from programs import NO_VALGRIND, arguments, build, has_valgrind, instructions, verdict

# Scene and way, limit of library / hand. Those of pendulums by W guard what was reached; docs/evidence/performance.md says where it goes.
LIMITS = {("particles", "library"): 1.02, ("bodies", "library"): 1.05,
          ("pendulum", "visits"): 1.30, ("pendulums", "visits"): 1.12,
          ("pendulum", "library"): 4.0, ("pendulums", "library"): 2.75}
# Instructions of a step that a law without items may add: 666 of 5765 and 3498 of 417 930 were reached. Either step, and so their
# difference, is a few instructions up or down with what the compiler inlines.
UNUSED = {"pendulum": 750, "pendulums": 5000}


def instructions_of_a_step(program, scene, how, steps=100):
    """The difference of two runs, so that the set-up is not counted. And where the scene went."""
    (less, _), (more, answer) = (instructions(program, scene, how, n) for n in (steps, 3 * steps))
    return (more - less) / (2 * steps), float(answer)


def main():
    given = arguments(__doc__)
    if not has_valgrind():
        return NO_VALGRIND
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        # A program each: in one, how the compiler inlines one way depends on what else calls the same functions.
        program = build(given, "step_cost", folder, "-O3")
        programs = {"library": program, "visits": build(given, "step_cost_visits", folder, "-O3")}
        hand = build(given, "step_cost_by_hand", folder, "-O3")

        library, by_hand = {}, {}
        print(f"{'scene':<12}{'way':<9}{'library':>10}{'by hand':>10}{'ratio':>8}{'limit':>8}   instructions of a step")
        for (scene, way), limit in LIMITS.items():
            counted, ours = instructions_of_a_step(programs[way], scene, way)
            if way == "library":
                library[scene] = counted
            if scene not in by_hand:
                by_hand[scene] = instructions_of_a_step(hand, scene, "hand")
            least, theirs = by_hand[scene]
            ratio = counted / least
            print(f"{scene:<12}{way:<9}{counted:>10.0f}{least:>10.0f}{ratio:>8.3f}{limit:>8.2f}")
            if abs(ours - theirs) > 1e-12:
                wrong.append(f"{scene}, {way}: the two ways end at {ours} and {theirs}: they are not the same step")
            if ratio > limit:
                wrong.append(f"{scene}, {way}: {ratio:.3f} times the step by hand, the limit is {limit}")

        named, _ = instructions_of_a_step(program, "bodies", "named")
        print(f"defaults named and a listener that hears nothing: {named - library['bodies']:+.0f}")
        if named != library["bodies"]:
            wrong.append("naming the defaults, or a listener that hears nothing, costs instructions")
        for scene, limit in UNUSED.items():
            more = instructions_of_a_step(program, scene, "unused")[0] - library[scene]
            print(f"{scene}, a law without items: {more:+.0f}, the limit is {limit}")
            if more > limit:
                wrong.append(f"{scene}: a law without items costs {more:.0f} instructions a step, the limit is {limit}")
    return verdict(wrong)


if __name__ == "__main__":
    sys.exit(main())
