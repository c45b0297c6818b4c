#!/usr/bin/env python3
"""Checks the pages: programs shown in them are the examples, letter by letter, and links to files lead somewhere.

    scripts/check_docs.py [ROOT]         one line per mistake, exit code 1 if there is one
    scripts/check_docs.py --write        copies the examples into the pages that show them
    scripts/check_docs.py --self-test    makes each mistake once and expects to be told

A page shows an example by a code block after the line `<!-- from examples/x.cpp -->`. The example's leading comments
speak to its tests and are left out. A part of a program stands after `<!-- part of docs/snippets/x.cpp -->`: a run of its
lines, but for the common indent. Every other block of C++ is a mistake, but for those in docs/decisions.

A table of a how-to has a column `evidence`, or a line after it that names a test: `Test: `tests/loop/x.cpp`.` A file of tests that
a page of docs/ names is there.
"""
import re
import sys
import tempfile
import textwrap
from pathlib import Path

SHOWN = re.compile(r"(<!-- from (\S+) -->\n```(?:cpp|xml)\n)(.*?)(```)", re.DOTALL)
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")
PART = re.compile(r"<!-- part of (\S+) -->\n```cpp\n(.*?)```", re.DOTALL)
BLOCK = re.compile(r"([^\n]*)\n```(?:cpp|c\+\+)\n(.*?)```", re.DOTALL)
TABLE = re.compile(r"^(\|[^\n]*)\n\|[-:| ]+\n(?:\|[^\n]*\n)*\n*([^\n]*)", re.MULTILINE)
TEST = re.compile(r"`((?:tests|tools)/[\w/]+\.(?:cpp|py|cmake))`")
CODE = re.compile(r"```.*?```|`[^`\n]*`", re.DOTALL)


def pages(root):
    yield from sorted(root.glob("*.md"))
    yield from sorted((root / "docs").rglob("*.md"))


def program(path):
    """The text of an example, from its first line that is no comment."""
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    while lines and (lines[0].startswith("//") or not lines[0].strip()):
        lines.pop(0)
    return "".join(lines)


def lines_of(text):
    return [line.strip() for line in textwrap.dedent(text).splitlines()]


def is_part(shown, whole):
    """Whether the lines follow each other in the program."""
    some, every = lines_of(shown), lines_of(whole)
    return any(every[k : k + len(some)] == some for k in range(len(every) - len(some) + 1))


def complaints(root):
    for page in pages(root):
        name, text = page.relative_to(root), page.read_text(encoding="utf-8")
        for _, source, shown, _ in SHOWN.findall(text):
            if not (root / source).exists():
                yield f"{name}: shows {source}, which does not exist"
            elif shown != program(root / source):
                yield f"{name}: what it shows of {source} is not that program; scripts/check_docs.py --write copies it"
        for source, shown in PART.findall(text):
            if not (root / source).exists():
                yield f"{name}: shows a part of {source}, which does not exist"
            elif not is_part(shown, (root / source).read_text(encoding="utf-8")):
                yield f"{name}: what it shows as a part of {source} is none: {lines_of(shown)[0]}"
        if "decisions" not in name.parts:
            for before, shown in BLOCK.findall("\n" + text):
                if not re.match(r"<!-- (from|part of) \S+ -->$", before):
                    yield f"{name}: no program is named above the block that begins with {shown.splitlines()[0].strip()!r}"
        if "how_to" in name.parts:
            for head, after in TABLE.findall(text):
                if "evidence" not in head and not re.match(r"Tests?: `|Evidence: ", after):
                    yield f"{name}: the table {head!r} names no test; write `Test: ` and its file after it"
        for test in TEST.findall(text):
            if name.parts[0] == "docs" and "decisions" not in name.parts and not (root / test).exists():
                yield f"{name}: there is no {test}"
        for word in re.findall(r"^[A-Z]+_[A-Z_]+$", text, re.MULTILINE):
            yield f"{name}: {word} stands for a text that is not there yet"
        for target in LINK.findall(CODE.sub("", text)):
            if "://" not in target and not target.startswith("mailto:") and not (page.parent / target).exists():
                yield f"{name}: the link to {target} leads nowhere"


def write(root):
    for page in pages(root):
        text = page.read_text(encoding="utf-8")
        new = SHOWN.sub(lambda m: m[1] + program(root / m[2]) + m[4], text)
        if new != text:
            page.write_text(new, encoding="utf-8")
            print(f"{page.relative_to(root)}: brought up to date")


def self_test():
    example = "// prints: x\nint main() {}\n"
    cases = [
        ("<!-- from examples/a.cpp -->\n```cpp\nint main() {}\n```\n[a](examples/a.cpp) [b](https://x.y)\n", None),
        ("<!-- from examples/a.cpp -->\n```cpp\nint main(){}\n```\n", "is not that program"),
        ("<!-- from examples/b.cpp -->\n```cpp\nint main() {}\n```\n", "does not exist"),
        ("[a](docs/gone.md)\n", "leads nowhere"),
        ("<!-- part of examples/a.cpp -->\n```cpp\nint main() {}\n```\n", None),
        ("<!-- part of examples/a.cpp -->\n```cpp\nint x;\n```\n", "is none"),
        ("<!-- part of examples/b.cpp -->\n```cpp\nint x;\n```\n", "does not exist"),
        ("# A\n\nA_CAPTION\n", "not there yet"),
        ("text\n```cpp\nint x;\n```\n", "no program is named"),
        ("`tests/gone.cpp`\n", "there is no", "docs/how_to/a.md"),
        ("| a |\n|---|\n| b |\n\ntext\n", "names no test", "docs/how_to/a.md"),
        ("| a |\n|---|\n| b |\n", "names no test", "docs/how_to/a.md"),
        ("| a |\n|---|\n| b |\n\nTest: `tests/a.cpp`.\n", None, "docs/how_to/a.md"),
        ("| a | evidence |\n|---|---|\n| b | HC-01 |\n", None, "docs/how_to/a.md"),
    ]
    failures = 0
    for text, word, *page in cases:
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            for room in ("examples", "tests", "docs/how_to"):
                (root / room).mkdir(parents=True)
            (root / "tests/a.cpp").touch()
            (root / "examples/a.cpp").write_text(example)
            (root / (page or ["README.md"])[0]).write_text(text)
            told = list(complaints(root))
        if bool(told) != (word is not None) or (word and word not in told[0]):
            failures += 1
            print(f"expected {word!r}, told {told}")
    print(f"check_docs: {len(cases)} self-tests, {failures} failed")
    return failures


def main():
    if sys.argv[1:] == ["--self-test"]:
        return 1 if self_test() else 0
    here = Path(__file__).resolve().parent.parent
    if sys.argv[1:] == ["--write"]:
        write(here)
    root = Path(sys.argv[1]) if sys.argv[1:] and sys.argv[1] != "--write" else here
    found = list(complaints(root))
    for sentence in found:
        print(sentence)
    print(f"check_docs: {len(list(pages(root)))} pages, {len(found)} mistakes")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
