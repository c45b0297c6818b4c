#!/usr/bin/env python3
"""Measures how long sentences and paragraphs are, in pages and in the public comments of headers.

    scripts/check_words.py               one line per page over its limits, exit code 1 if there is one
    scripts/check_words.py --all         a line for every page
    scripts/check_words.py --longest     the longest sentence of each page beside it
    scripts/check_words.py --self-test   makes each mistake once and expects to be told

docs/project/documentation.md has the limits. Code, tables, headings, formulas and the targets of links do not count; a list item is a
paragraph. A colon or semicolon ends a sentence where a capital letter follows. Of headers the lines that begin with `///` count, all
together; those in a folder `inner` and in a namespace `inner` do not. A public comment that says no word but those of the name it
stands above is a mistake.
"""
import argparse
import re
import sys
import tempfile
from pathlib import Path

# Folder of docs, or the README -> mean words a sentence, share of sentences above LONG words, words of a paragraph.
SHORT, PLAIN = (15, 0.02, 100), (17, 0.04, 120)
LIMITS = {"README.md": SHORT, "start": SHORT, "tutorials": SHORT, "how_to": SHORT,
          "reference": PLAIN, "theory": PLAIN, "coming_from": PLAIN, "project": PLAIN}
LONG = 35
WORDS = 25_000  # of docs without evidence and decisions, programs, and the tables of the reference, which belong to the API


def paragraphs(page):
    """Of Markdown: text alone, a list item each."""
    text = re.sub(r"<!--.*?-->|```.*?```|\$\$.*?\$\$", "", page, flags=re.DOTALL)
    now = []
    for line in [*text.splitlines(), ""]:
        item = re.match(r"\s*(?:[-*+]|\d+\.)\s+", line)
        is_text = line.strip() and not re.match(r"\s*(?:#|\||<|!\[)", line)
        if now and (item or not is_text):
            yield " ".join(now)
            now = []
        if is_text:
            now.append(line[item.end() :] if item else line.strip(" >"))


def comments(header):
    """Of a header: the public comments, each with the name that follows it."""
    now, is_inner = [], False
    for line in header.splitlines():
        if re.match(r"namespace \S*\binner\b", line):
            is_inner = True
        elif is_inner and line.startswith("}"):
            is_inner = False
        said = re.match(r"\s*///(?!<)\s?(.*)", line)
        if said and said.group(1).strip():
            now.append(said.group(1))
            continue
        if said:  # an empty line between two paragraphs
            if now and not is_inner:
                yield " ".join(now), ""
            now = []
            continue
        if now and not is_inner:
            name = re.search(r"(\w+)\s*(?:[({;=]|$)", line)
            yield " ".join(now), name.group(1) if name else ""
        now = []
        beside = re.search(r"(\w+)[^\w]*;\s*///<\s*(.*)", line)
        if beside and not is_inner:
            yield beside.group(2), beside.group(1)


def sentences(paragraph):
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", paragraph)
    text = re.sub(r"`[^`]*`|\$[^$]*\$", "code", text)
    text = re.sub(r"\b(e\.g|i\.e|cf|vs|Fig|Eq|no|etc|al|Sec)\.", r"\1", text)
    return [s for s in re.split(r"(?<=[.!?:;])\s+(?=[\"'(A-Z0-9*_]|code)", text) if len(s.split()) > 2]


def repeats(said, name):
    """Whether a comment has no word but the name's, articles aside."""
    words = set(re.findall(r"[a-z]+", said.lower())) - {"a", "an", "the", "of", "its", "this"}
    parts = set(re.findall(r"[a-z]+", re.sub(r"([A-Z])", r" \1", name).replace("_", " ").lower()))
    return bool(words) and words <= parts


def words_of(page, is_reference):
    text = re.sub(r"<!-- pages -->.*<!-- end of pages -->|<!--.*?-->|```.*?```", "", page, flags=re.DOTALL)
    if is_reference:
        text = re.sub(r"^\|.*$", "", text, flags=re.MULTILINE)
    return len(re.findall(r"\w\S*", text))


class Tally:
    def __init__(self, texts):
        self.sentences = [s for text in texts for s in sentences(text)]
        self.lengths = [len(s.split()) for s in self.sentences] or [0]
        self.paragraph = max((len(text.split()) for text in texts), default=0)
        self.mean = sum(self.lengths) / len(self.lengths)
        self.long = sum(n > LONG for n in self.lengths) / len(self.lengths)

    def faults(self, limits):
        mean, long, paragraph = limits
        if self.mean > mean:
            yield f"{self.mean:.1f} words a sentence, {mean} at most"
        if self.long > long:
            yield f"{self.long:.0%} of the sentences are above {LONG} words, {long:.0%} at most"
        if self.paragraph > paragraph:
            yield f"a paragraph of {self.paragraph} words, {paragraph} at most"


def limits_of(name):
    parts = name.parts
    return LIMITS.get(parts[0] if parts[0] != "docs" or len(parts) < 3 else parts[1])


def complaints(root, shows_all=False, shows_longest=False):
    words = 0
    for page in [*sorted(root.glob("README.md")), *sorted((root / "docs").rglob("*.md"))]:
        name, text = page.relative_to(root), page.read_text(encoding="utf-8")
        if name.parts[0] == "docs" and not {"evidence", "decisions"} & set(name.parts):
            words += words_of(text, "reference" in name.parts)
        limits = limits_of(name)
        if limits is None:
            continue
        tally = Tally(list(paragraphs(text)))
        if shows_all:
            print(f"{name}: {tally.mean:.1f} words a sentence, {tally.long:.1%} above {LONG}, longest paragraph {tally.paragraph}")
        if shows_longest:
            print(f"    {max(tally.sentences, key=lambda s: len(s.split()), default='')}")
        for fault in tally.faults(limits):
            yield f"{name}: {fault}"
    if words > WORDS:
        yield f"docs: {words} words without evidence, decisions and the reference's tables, {WORDS} at most"
    said = [(text, name, header.relative_to(root)) for header in sorted((root / "include").rglob("*.hpp")) if "inner" not in header.parts
            for text, name in comments(header.read_text(encoding="utf-8"))]
    tally = Tally([text for text, _, _ in said])
    if shows_all:
        print(f"include: {tally.mean:.1f} words a sentence, {tally.long:.1%} above {LONG}, longest paragraph {tally.paragraph}; docs: {words} words")
    for fault in tally.faults(PLAIN):
        yield f"include: {fault}"
    for text, name, header in said:
        if repeats(text, name):
            yield f"{header}: the comment above {name} says no more than its name: {text}"


def self_test():
    long, short = " ".join(["word"] * 36) + ". ", "Here are a few words. "
    cases = [("README.md", short * 9, None), ("README.md", " ".join(["word"] * 16) + ".", "words a sentence"),
             ("docs/start/a.md", (short * 9 + "\n\n") * 4 + long, "above 35"), ("docs/how_to/a.md", short * 21, "a paragraph of"),
             ("docs/evidence/a.md", long * 9, None), ("docs/theory/a.md", "word " * 25_001, "words without evidence"),
             ("include/delassus/a.hpp", "/// The rest length.\ndouble rest_length = 0;\n", "no more than its name"),
             ("include/delassus/a.hpp", "/// Without load, m.\ndouble rest_length = 0;\n", None),
             ("include/delassus/a.hpp", "namespace delassus::inner {\n/// The rest length.\ndouble rest_length = 0;\n}\n", None)]
    failures = 0
    for name, text, word in cases:
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
            told = list(complaints(root))
        if bool(told) != (word is not None) or (word and not any(word in sentence for sentence in told)):
            failures += 1
            print(f"{name}: expected {word!r}, told {told}")
    print(f"check_words: {len(cases)} self-tests, {failures} failed")
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("root", nargs="?", type=Path, default=Path(__file__).resolve().parent.parent)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--longest", action="store_true")
    parser.add_argument("--self-test", action="store_true")
    a = parser.parse_args()
    if a.self_test:
        return 1 if self_test() else 0
    found = list(complaints(a.root, a.all, a.longest))
    for sentence in found:
        print(sentence)
    print(f"check_words: {len(found)} mistakes")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
