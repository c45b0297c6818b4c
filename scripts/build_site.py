#!/usr/bin/env python3
"""Builds the site: the pages of docs/ in their order, and the API from the public headers.

    scripts/build_site.py                  writes out/docs/index.html; exit code 1 at a warning of Doxygen, a page that it does not
                                           understand, a dead link inside of the site, or a public name without a comment
    scripts/build_site.py --out DIR        the same into another folder
    scripts/build_site.py --undocumented   lists the public names without a comment, writes no site

Public is what docs/site/Doxyfile reads. What a concept asks of a type is documented at the concept: docs/site/concepts.txt names
these members, which need no comment of their own.
"""
import argparse
import html
import os
import re
import shutil
import subprocess
import sys
import tempfile
import urllib.parse
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# Folders of docs, in the order of the menu. A page that FIRST names comes before the others, which stand in the order of their titles.
MENU = {"start": "Start", "tutorials": "Tutorials", "how_to": "How to", "reference": "Reference", "theory": "Theory", "evidence": "Evidence",
        "coming_from": "Coming from", "project": "Project", "decisions": "Decisions"}
FIRST = ["start/what_it_is", "start/install", "start/first_stack", "start/read_a_report", "tutorials/stack", "tutorials/pendulum",
         "tutorials/gripper", "tutorials/soft_block", "tutorials/needle", "tutorials/haptics", "how_to/choose_parts", "reference/policies",
         "reference/step_report", "theory/equations", "project/architecture"]


def title_of(page):
    return re.search(r"^# (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE).group(1)


def pages_in(folder):
    place = {name: k for k, name in enumerate(FIRST)}
    return sorted((ROOT / "docs" / folder).glob("*.md"), key=lambda p: (place.get(f"{folder}/{p.stem}", len(FIRST)), title_of(p)))


def label(page, heading=""):
    """What Doxygen calls a page, or a heading of one."""
    return re.sub(r"\W+", "_", str(page.relative_to(ROOT / "docs").with_suffix("")) + ("_at_" + heading if heading else ""))


def slug(heading):
    """The place of a heading as links to a page of Markdown name it."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def prepared(page, out):
    """The text of a page for Doxygen: headings with labels, links to pages by these, and links to other files to copies of them."""
    is_first = True

    def heading(match):
        nonlocal is_first
        name = label(page) if is_first else label(page, slug(match.group(2)))
        is_first = False
        return f"{match.group(1)} {match.group(2).replace('`', '')} {{#{name}}}"  # Doxygen shows the tags of code in a heading

    def link(match):
        picture, text, target, place = match.groups()
        text = " ".join(text.split())  # a reference that goes on in the next line ends what Doxygen understands of a page
        if re.match(r"[a-z]+:", target):
            return match.group(0)
        file = (page.parent / target).resolve() if target else page
        if file.suffix == ".md" and file.is_relative_to(ROOT / "docs"):
            text = text.replace("`", "")  # Doxygen shows them in a reference
            return f"[{text}](@ref {label(file, place[1:]) if place else label(file)})"
        if file.is_dir() or file.suffix == ".md":
            return text
        copy = out / "files" / file.relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, copy)
        return f"{picture}[{text}](files/{file.relative_to(ROOT)})"

    blocks = re.split(r"(```.*?```)", page.read_text(encoding="utf-8"), flags=re.DOTALL)  # code stays as it is
    for k in range(0, len(blocks), 2):
        blocks[k] = re.sub(r"^(#{1,4}) (.+)$", heading, blocks[k], flags=re.MULTILINE)
        blocks[k] = re.sub(r"(!?)\[([^\]]*)\]\(([^)#\s]*)(#[^)]*)?\)", link, blocks[k])
    return "".join(blocks)


def attribute(text):
    return html.escape(text, quote=False).replace('"', "&quot;").replace("`", "")


def layout():
    tabs = ['<tab type="mainpage" visible="yes" title="delassus"/>']
    for folder, title in MENU.items():
        if not (pages := pages_in(folder)):
            continue
        tabs.append(f'<tab type="usergroup" visible="yes" title="{title}">')
        tabs += [f'<tab type="user" url="@ref {label(page)}" title="{attribute(title_of(page))}"/>' for page in pages]
        if folder == "reference":
            tabs.append('<tab type="classlist" visible="yes" title="API: all types"/>')
        tabs.append("</tab>")
    tabs.append(f'<tab type="user" url="@ref {label(ROOT / "docs/references.md")}" title="Sources"/>')
    return '<doxygenlayout version="1.0"><navindex>' + "\n".join(tabs) + "</navindex></doxygenlayout>\n"


def doxygen(out, *settings):
    """Runs it; returns its warnings."""
    with tempfile.TemporaryDirectory() as folder:
        there = Path(folder)
        (there / "layout.xml").write_text(layout(), encoding="utf-8")
        for page in (ROOT / "docs").rglob("*.md"):
            (there / f"{label(page)}.md").write_text(prepared(page, out), encoding="utf-8")
        text = (ROOT / "docs/site/Doxyfile").read_text(encoding="utf-8")
        text += "\n".join([f"OUTPUT_DIRECTORY = {out}", f"LAYOUT_FILE = {there / 'layout.xml'}", f"INPUT += {there}",
                           f"USE_MDFILE_AS_MAINPAGE = {there / 'README.md'}", f"STRIP_FROM_PATH += {there}", *settings]) + "\n"
        done = subprocess.run(["doxygen", "-"], input=text, cwd=ROOT, text=True, capture_output=True)
        if done.returncode != 0:
            sys.exit(done.stdout + done.stderr)
        said = done.stderr.replace(f"{ROOT}/", "").replace(f"{there}/", "docs/")
    return [line for line in said.splitlines() if re.search(r"(warning|error):", line)]


def undocumented():
    """The public names without a comment."""
    concepts = set((ROOT / "docs/site/concepts.txt").read_text(encoding="utf-8").split())
    with tempfile.TemporaryDirectory() as folder:
        said = doxygen(Path(folder), "GENERATE_HTML = NO", "GENERATE_XML = YES", "HIDE_UNDOC_MEMBERS = NO", "HIDE_UNDOC_CLASSES = NO",
                       "WARN_IF_UNDOCUMENTED = YES")
    for line in said:
        member = re.search(r"Member ([^\s(]+).*\((function|variable|typedef|enumeration|enumvalue)\) of (.*) is not documented", line)
        if member and member.group(1) not in concepts and not member.group(1).startswith(("operator", "~")):
            yield line
        elif "warning: Compound" in line:
            yield line


def left_as_written(out):
    """Pages of which Doxygen has not understood a part: its commands, or tags that it has made itself, stand in the text."""
    for page in sorted(out.glob("*.html")):
        text = re.sub(r'<(pre|code|tt)\b.*?</\1>|<div class="(?:line|fragment)">.*?</div>', "", page.read_text(encoding="utf-8", errors="replace"), flags=re.DOTALL)
        if found := re.search(r"[@\\](?:section|subsection|ref|code|anchor|page)\b|&lt;/?(?:tt|b|em|td|tr|table)\b|`", text):
            yield f"{page.name}: {found.group(0)} stands in the text"


def dead_links(out):
    """Links of the site's pages to files or places that are not there."""
    names = {}

    def places(file):
        if file not in names:
            names[file] = set(re.findall(r'(?:id|name)="([^"]+)"', file.read_text(encoding="utf-8", errors="replace"))) if file.suffix == ".html" else set()
        return names[file]

    for page in sorted(out.glob("*.html")):
        for target in set(re.findall(r'(?:href|src)="([^"]+)"', page.read_text(encoding="utf-8", errors="replace"))):
            target = urllib.parse.unquote(html.unescape(target))
            if re.match(r"[a-z]+:|//|\$", target):
                continue
            path, _, place = target.partition("#")
            file = page if not path else out / path
            if not file.exists():
                yield f"{page.name}: the link to {target} leads nowhere"
            elif place and file.suffix == ".html" and place not in places(file):
                yield f"{page.name}: {path or page.name} has no place {place}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=ROOT / "out/docs")
    parser.add_argument("--undocumented", action="store_true")
    a = parser.parse_args()
    missing = list(undocumented())
    if a.undocumented:
        print("\n".join([*missing, f"build_site: {len(missing)} public names without a comment"]))
        return 1 if missing else 0
    if (a.out / "doxygen.css").exists():  # an older site
        shutil.rmtree(a.out)
    os.makedirs(a.out, exist_ok=True)
    mistakes = [*doxygen(a.out), *missing]
    mistakes += [*dead_links(a.out), *left_as_written(a.out)]
    print("\n".join([*mistakes, f"build_site: {len(mistakes)} mistakes; open {a.out / 'index.html'}"]))
    return 1 if mistakes else 0


if __name__ == "__main__":
    sys.exit(main())
