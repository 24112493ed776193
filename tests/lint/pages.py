#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Each page of docs names its kind, each table of results where and when it was measured, and a column "held by"
names tests that exist."""
import pathlib
import re
import sys

KIND = re.compile(r"\*(Tutorial|How-to|Reference|Explanation)\b.*")
# A table with "Held by" needs no commit, because a test fails if the table is wrong.
HEAD = re.compile(r"\*(Commit [0-9a-f]{7,}, \d{4}-\d\d-\d\d|Held by )")
FREE = ("index.md",)


def headless_tables(text):
    """Yields the line numbers of tables that have no head before them in their section."""
    head, fenced, before = False, False, ""
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("```"):
            fenced = not fenced
        elif not fenced and line.startswith("#"):
            head = False
        elif HEAD.match(line):
            head = True
        elif line.startswith("|") and not before.startswith("|") and not head:
            yield number
        before = line


def tests_of(root):
    """Returns suites, tests as Suite.Name, and the names of attacks in scripts of tests/system."""
    names = set()
    for path in (root / "tests").rglob("*"):
        if path.suffix == ".cpp":
            for suite, name in re.findall(r"^TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)", path.read_text(), re.M):
                names |= {suite, f"{suite}.{name}"}
        elif path.suffix == ".py" and path.parent.name == "adversary":
            names |= {path.name, *re.findall(r"^def (\w+)\(context\)", path.read_text(), re.M)}
    return names


def unknown_tests(text, known):
    """Yields (line number, name) of names in a last column "held by" that are no tests."""
    held = False
    for number, line in enumerate(text.splitlines(), 1):
        cells = line.strip("|").split("|") if line.startswith("|") else []
        held = bool(cells) and (held or cells[-1].strip() == "held by")
        for name in re.findall(r"`([\w.]+)`", cells[-1]) if held else []:
            if (name[0].isupper() or "_" in name) and name not in known:
                yield number, name


def check(root):
    docs = root / "docs"
    known = tests_of(root)
    problems = []
    for path in sorted(docs.rglob("*.md")):
        page = path.relative_to(docs).as_posix()
        text = path.read_text()
        lines = [*text.splitlines(), "", ""]
        if path.name not in ("index.md", "README.md") and not KIND.fullmatch(lines[2]):
            problems.append(f"docs/{page}:3: is it *Tutorial.*, *How-to.*, *Reference.* or *Explanation.*?")
        if page.startswith("results/") and page not in FREE:
            problems += [f"docs/{page}:{n}: no *Commit ...* above this table" for n in headless_tables(text)]
        problems += [f"docs/{page}:{n}: no test is called {name}" for n, name in unknown_tests(text, known)]
    return problems


if __name__ == "__main__":
    found = check(pathlib.Path(sys.argv[1]).resolve())
    sys.exit("\n".join(found) or 0)
