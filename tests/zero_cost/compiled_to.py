#!/usr/bin/env python3
"""What programs are compiled to: no code of rooms they do not use, no call inside a sweep, and not twice what is compiled once.

  compiled_to.py <root> --compiler g++ [--system <include dir>...]

Every instruction of a program has a line in its debug information (-g1), inlined ones too: the rooms those lines come from
are the rooms whose code is in the program. A list of names would rot; this needs none.
"""
import pathlib
import re
import sys
import tempfile

from programs import arguments, build, run, verdict

ABSENT = ("collision", "constraints", "compliance", "solvers", "stabilisation")
# Of what `delassus/compiled.hpp` leaves out, a header of each part that no other part needs.
LEFT_OUT = {"a pair's distance": "collision/gjk.hpp", "the broad phase": "collision/inner/dynamic_tree.hpp",
            "contact points": "collision/manifold.hpp", "a solve": "solvers/inner/momentum.hpp",
            "Newton's method": "solvers/inner/proximal_point.hpp", "a body's input": "bodies/body_input.hpp"}


def rooms_in(program):
    """Room -> headers of it that put an instruction into the program."""
    found = {}
    for room, header in re.findall(r"include/delassus/(\w+)/([\w/]+\.hpp)",
                                   run("objdump", "--dwarf=decodedline", program).stdout):
        found.setdefault(room, set()).add(header)
    return found


def lines_in(program):
    """Header -> lines of it that put an instruction into the program."""
    found, header = {}, None
    for line in run("objdump", "--dwarf=decodedline", program).stdout.splitlines():
        place = re.search(r"include/delassus/([\w/]+\.hpp):", line)
        if place or line.endswith(":"):
            header = place and place.group(1)
            continue
        number = re.match(r"\S+\.hpp\s+(\d+)\s+0x", line)
        if header and number:
            found.setdefault(header, set()).add(int(number.group(1)))
    return found


def functions_in(program):
    """Name, without `Serial` among its types -> the instructions' names, of which there are several lists where it is there twice. Padding is left out."""
    found, name = {}, None
    for line in run("objdump", "-d", "-C", "--no-show-raw-insn", program).stdout.splitlines():
        head = re.match(r"^[0-9a-f]+ <(.+)>:$", line)
        if head:
            name = head.group(1).replace(" ", "").replace(",delassus::Serial", "")
            found.setdefault(name, []).append([])
        word = re.match(r"^\s*[0-9a-f]+:\t(\S+)", line)
        if word and name and not re.match(r"nop|xchg|data16|cs$", word.group(1)):
            found[name][-1].append(word.group(1))
    return {name: sorted(lists) for name, lists in found.items()}


def calls_from(program, start, aside=()):
    """Names of library functions that the function whose name begins with `start` can reach by calls, through any function of
    ours but those with one of `aside` in their names."""
    body, name = {}, None
    for line in run("objdump", "-d", "-C", "--no-show-raw-insn", program).stdout.splitlines():
        head = re.match(r"^[0-9a-f]+ <(.+)>:$", line)
        if head:
            name = head.group(1)
            body[name] = set()
        target = re.search(r"\t(?:call|jmp|j[a-z]+)\s+(?:[0-9a-f]+ )?<(.+?)(?:\+0x[0-9a-f]+)?>$", line)
        if target and name:
            body[name].add(target.group(1))
        elif name and re.search(r"\tcall\s+\*", line):
            body[name].add("a function pointer")
    starts = [name for name in body if name.startswith(start)]
    if len(starts) != 1:
        sys.exit(f"{start} is {len(starts)} times in the program, not once")
    seen, todo, outside = set(), starts, set()
    while todo:
        name = todo.pop()
        if name in seen or any(word in name for word in aside):
            continue
        seen.add(name)
        if name not in body or name.endswith("@plt"):
            outside.add(name)
        else:
            todo.extend(body[name])
    return outside


def main():
    given = arguments(__doc__)
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        program = build(given, "falling_box", folder, "-O2", "-g1")
        found = rooms_in(program)
        for room in ABSENT:
            if room in found:
                wrong.append(f"a falling box holds code of {room}: {', '.join(sorted(found[room]))}")
        print("a falling box is made of", ", ".join(sorted(found)))
        run(program)

        program = build(given, "sweep", folder, "-O2", "-g1")
        found = rooms_in(program)
        for room in ABSENT:  # else the look into the falling box would prove nothing
            if room not in found:
                wrong.append(f"no code of {room} is seen in a program that uses it")
        # sqrt of a negative number sets errno in the C library; the instruction does all others. What is aside is for a W that is
        # not one list of square blocks, and for one that is no matrix.
        calls = calls_from(program, "delassus::inner::LawLoops<delassus::Contact<delassus::Coulomb>, double>::sweep(",
                           aside=("_otherwise<", "tell_change<")) - {"sqrt@plt", "sqrtf@plt"}
        print("a sweep calls", ", ".join(sorted(calls)) or "nothing")
        if calls:
            wrong.append(f"a sweep of Coulomb contacts calls {', '.join(sorted(calls))}")
        run(program)

        # A loop that names one thread is one that names nothing.
        silent, named = (functions_in(build(given, "counted_ten_boxes", folder, "-O2", *flags)) for flags in ([], ["-DNAMED=,Serial{}"]))
        # Which registers g++ takes, and a small inlining here and there, follow the order of names: counts are within a thousandth.
        different = sorted(silent.keys() ^ named.keys())
        counts = [sum(len(body) for lists in functions.values() for body in lists) for functions in (silent, named)]
        if different or not silent or abs(counts[0] - counts[1]) > 1e-3 * counts[0]:
            wrong.append(f"a loop that names Serial is {counts[1]} instructions, one that does not {counts[0]}; functions of one alone: {different[:3]}")
        schedulers = [name for name in named if re.search(r"InParallel|InParts|Crew|Threads|tbb|pthread", name)]
        if schedulers:
            wrong.append(f"a loop of one thread has code of a scheduler: {schedulers[:3]}")
        print(len(silent), "functions with and without Serial,", *counts, "instructions")

        # Constructors of what a loop holds stay; a tenth of the lines of a part would be more than those.
        lines_of_all = {}
        once = pathlib.Path(folder) / "stack.o"
        include = [word for directory in given.system for word in ("-isystem", directory)]
        for header, is_left_out in ("delassus/delassus.hpp", False), ("delassus/compiled.hpp", True):
            run(given.compiler, "-std=c++20", "-O2", "-g1", "-I", given.root / "include", *include, "-include", header,
                "-c", given.root / "examples" / "stack.cpp", "-o", once)
            lines = lines_in(once)
            for what, place in LEFT_OUT.items():
                count = len(lines.get(place, ()))
                if not is_left_out:
                    lines_of_all[place] = count
                    if count == 0:
                        wrong.append(f"a stack with <{header}> holds no code of {what}, {place}")
                elif count > 0.1 * lines_of_all[place]:
                    wrong.append(f"a stack with <{header}> holds code of {what}: {count} of {lines_of_all[place]} lines of {place}")
    return verdict(wrong)


if __name__ == "__main__":
    sys.exit(main())
