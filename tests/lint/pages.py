#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Each page of docs says what kind it is, and each table of results where and when it was measured."""
import pathlib
import re
import sys

KIND = re.compile(r"\*(Tutorial|How-to|Reference|Explanation)\b.*")
# "Held by": a test fails where the table is wrong.
HEAD = re.compile(r"\*(Commit [0-9a-f]{7,}, \d{4}-\d\d-\d\d|Held by )")
FREE = ("index.md", "results/scream.md")


def headless_tables(text):
    """Numbers of the lines where a table begins whose section has no head before it."""
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


def check(root):
    docs = root / "docs"
    problems = []
    for path in sorted(docs.rglob("*.md")):
        page = path.relative_to(docs).as_posix()
        text = path.read_text()
        lines = [*text.splitlines(), "", ""]
        if path.name not in ("index.md", "README.md") and not KIND.fullmatch(lines[2]):
            problems.append(f"docs/{page}:3: is it *Tutorial.*, *How-to.*, *Reference.* or *Explanation.*?")
        if page.startswith("results/") and page not in FREE:
            problems += [f"docs/{page}:{n}: no *Commit ...* above this table" for n in headless_tables(text)]
    return problems


if __name__ == "__main__":
    found = check(pathlib.Path(sys.argv[1]).resolve())
    sys.exit("\n".join(found) or 0)
