#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plants the bug of a patch into a tree. Finds the place by the code, not by line numbers.

Looks in all sources for the lines that a hunk takes away, with as much of the context as can be found, without regard
to white space. So a patch survives moves of lines, files and folders, and line breaks. It fits if exactly one
place is found.
"""
import argparse
import pathlib
import re
import sys

FOLDERS = ("src", "gst", "ext", "pipelines")
ENDINGS = (".cpp", ".h", ".js", ".html", ".py", ".sh")


class Misfit(Exception):
    """The bug cannot be planted; the text names the reason."""


def hunks(patch):
    """Returns path and lines (kind, text) of each hunk."""
    found, path = [], None
    for line in patch.splitlines():
        if line.startswith("+++ "):
            path = re.sub(r"^\+\+\+ (b/)?", "", line)
        elif line.startswith("@@"):
            found.append((path, []))
        elif found and found[-1][0] == path and not line.startswith("--- "):
            found[-1][1].append((line[:1] or " ", line[1:]))
    return found


def sources(tree):
    return sorted(p for folder in FOLDERS for p in (tree / folder).rglob("*") if p.suffix in ENDINGS and p.is_file())


def squeeze(text):
    """Returns the text without white space."""
    return "".join(text.split())


class Tree:
    def __init__(self, root):
        self.root = root
        self.texts = {p: p.read_text(encoding="utf-8") for p in sources(root)}
        self.squeezed = {p: squeeze(t) for p, t in self.texts.items()}
        self.changed = set()

    def find(self, wanted, name):
        """Returns all places of `wanted`; only those in files called `name`, if there are any."""
        found = [(p, m.start()) for p, text in self.squeezed.items() if wanted in text
                 for m in re.finditer(f"(?={re.escape(wanted)})", text)]
        return [f for f in found if f[0].name == name] or found

    def replace(self, path, at, length, after):
        text = self.texts[path]
        places = [i for i, c in enumerate(text) if not c.isspace()]
        begin, end = places[at], places[at + length - 1] + 1
        self.texts[path] = text[:begin] + after + text[end:]
        self.squeezed[path] = squeeze(self.texts[path])
        self.changed.add(path)

    def take_back(self):
        for path in self.changed:
            self.texts[path] = path.read_text(encoding="utf-8")
            self.squeezed[path] = squeeze(self.texts[path])
        self.changed.clear()


def narrowed(lines):
    """Yields the hunk with less and less of its context, cut at its end and its begin in turns."""
    lines = list(lines)
    first = True
    while True:
        yield lines
        ends = [i for i in ((0, -1) if first else (-1, 0)) if len(lines) > 1 and lines[i][0] == " "]
        if not ends:
            return
        lines = lines[1:] if ends[0] == 0 else lines[:-1]
        first = not first


def plant(tree, path, lines):
    for part in narrowed(lines):
        before = squeeze("".join(text for kind, text in part if kind != "+"))
        after = "\n".join(text for kind, text in part if kind != "-")
        if not before:
            break
        places = tree.find(before, pathlib.PurePath(path).name)
        if len(places) == 1:
            return tree.replace(*places[0], len(before), after)
        if len(places) > 1:
            raise Misfit(f"the code of {path} stands at {len(places)} places")
    raise Misfit(f"the code of {path} is not found")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="change nothing: say which patches do not fit")
    parser.add_argument("tree", type=pathlib.Path)
    parser.add_argument("patches", type=pathlib.Path, nargs="+")
    args = parser.parse_args()
    tree = Tree(args.tree)
    misfits = 0
    for patch in args.patches:
        try:
            for path, lines in hunks(patch.read_text(encoding="utf-8")):
                plant(tree, path, lines)
        except Misfit as misfit:
            misfits += 1
            print(f"{patch.stem}: {misfit}", file=sys.stderr)
        if args.check or misfits:
            tree.take_back()
    for path in sorted(tree.changed):
        path.write_text(tree.texts[path], encoding="utf-8")
        print(path.relative_to(args.tree))
    if args.check:
        print(f"{misfits} of {len(args.patches)} do not fit")
    sys.exit(1 if misfits else 0)


if __name__ == "__main__":
    main()
