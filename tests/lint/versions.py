#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tree uses nothing of GStreamer or GLib that is newer than meson.build asks for.

The .gir files of the installed libraries have the version that added each symbol. A newer symbol must
stand below `#if GST_CHECK_VERSION(...)` or `#if GLIB_CHECK_VERSION(...)` of that version.
"""
import functools
import pathlib
import re
import sys
import xml.etree.ElementTree

GIRS = pathlib.Path("/usr/share/gir-1.0")
# For each library: its files, and the pattern of its lowest version in meson.build.
LIBRARIES = {
    "GStreamer": (("Gst*.gir",), r"startswith\('gstreamer'\) \? '>= ([\d.]+)'"),
    "GLib": (("GLib-2.0.gir", "GObject-2.0.gir", "Gio-2.0.gir"), r": '>= (2\.[\d.]+)'"),
}
C = "{http://www.gtk.org/introspection/c/1.0}"
GLIB = "{http://www.gtk.org/introspection/glib/1.0}"
IDENTIFIER = re.compile(r"\b[Gg]\w+")
CONDITION = re.compile(r"\s*#\s*(if|ifdef|ifndef|elif|else|endif)\b(.*)")
GUARD = re.compile(r"(!?)\s*(GST|GLIB)_CHECK_VERSION\s*\(\s*(\d+)\s*,\s*(\d+)")
TEXT = re.compile(r'//.*|"(?:\\.|[^"\\])*"')
FOLDERS = ("src", "gst", "ext", "tests")


def version(text):
    return tuple(int(part) for part in text.split(".")[:2])


@functools.cache
def newer(girs, bound):
    """Returns {symbol: (version, file)} of symbols that are newer than `bound`."""
    found = {}

    def visit(element, since, name):
        own = element.get("version", "")
        if element.tag.endswith(("}namespace", "}repository")):
            own = ""  # this attribute is the version of the file format
        since = version(own) if re.fullmatch(r"\d+\.\d+(\.\d+)?", own) else since
        # An odd minor version is a development version. Its functions are first released in the
        # next even version.
        if since and since[1] % 2:
            since = (since[0], since[1] + 1)
        if since and since > bound:
            for attribute in (C + "identifier", C + "type", GLIB + "get-type"):
                if element.get(attribute) and not element.tag.endswith(("}type", "}array")):
                    found[element.get(attribute)] = (since, name)
        for child in element:
            if not child.tag.endswith(("}doc", "}parameters", "}return-value")):
                visit(child, since, name)

    for gir in girs:
        visit(xml.etree.ElementTree.parse(gir).getroot(), None, gir.name)
    return found


class Guards:
    """Follows the conditions around a line: each says (library, version, whether it has that version)."""

    def __init__(self):
        # For each open #if: the facts that follow because its earlier branches are not compiled,
        # and the facts of its present branch.
        self.stack = []

    def see(self, line):
        match = CONDITION.match(line)
        if not match:
            return
        word, rest = match.groups()
        if word.startswith("if"):
            self.stack.append(([], self.read(rest)))
        elif self.stack:
            left, said = self.stack.pop()
            if word != "endif":
                # This branch is compiled if the earlier condition is false. If that condition has
                # several terms, it is unknown which of them is false.
                if len(said) == 1:
                    left.append((said[0][0], said[0][1], not said[0][2]))
                self.stack.append((left, self.read(rest)))

    @staticmethod
    def read(condition):
        """Returns what the terms of a condition say; none if it has ||, because then no term must hold."""
        if "||" in condition:
            return []
        terms = [GUARD.search(term) for term in condition.split("&&")]
        return [
            m and (m[2], (int(m[3]), int(m[4])), not m[1]) for m in terms if m or len(terms) > 1
        ]

    def promise(self, library, since):
        said = [one for left, now in self.stack for one in left + now if one]
        return any(k == library and there and bound >= since for k, bound, there in said)


def check(root, girs=GIRS):
    build = (root / "meson.build").read_text()
    problems = []
    known = {}
    for library, (patterns, bound_pattern) in LIBRARIES.items():
        bound = re.search(bound_pattern, build)
        files = [f for pattern in patterns for f in sorted(girs.glob(pattern))]
        if not bound or not files:
            problems.append(f"{library}: no lower bound in meson.build, or no .gir file in {girs}")
            continue
        prefix = "GST" if library == "GStreamer" else "GLIB"
        for symbol, (since, gir) in newer(tuple(files), version(bound[1])).items():
            known[symbol] = (library, prefix, since, gir)
    for folder in FOLDERS:
        for file in sorted((root / folder).rglob("*")):
            if file.suffix in (".h", ".cpp", ".c"):
                problems += check_file(file, file.relative_to(root), known)
    return problems


def check_file(file, name, known):
    guards = Guards()
    problems = []
    for number, line in enumerate(file.read_text().splitlines(), 1):
        guards.see(line)
        for symbol in IDENTIFIER.findall(TEXT.sub("", line)):
            if symbol in known:
                library, prefix, since, gir = known[symbol]
                if not guards.promise(prefix, since):
                    since = ".".join(str(part) for part in since)
                    problems.append(f"{name}:{number}: {symbol} is of {library} {since} ({gir})")
    return problems


if __name__ == "__main__":
    found = check(pathlib.Path(sys.argv[1]).resolve())
    sys.exit("\n".join(found) or 0)
