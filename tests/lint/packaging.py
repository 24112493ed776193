#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""debian/ lists what the build makes: each plugin, program, symbol and library."""
import json
import pathlib
import re
import sys

# Packages that only the tests need. The Debian packages do not depend on them.
TESTS_ONLY = {
    "libbenchmark-dev",
    "libclang-rt-dev",
    "libfastcdr-dev",
    "libfastrtps-dev",
    "libgirepository1.0-dev",
    "libgtest-dev",
}
EXECUTABLE = re.compile(r"executable\('([\w-]+)',(?:[^()]|\([^()]*\))*\)")


def installed(root):
    """Returns the programs that go into bindir."""
    for build in sorted((root / "src").rglob("meson.build")):
        for match in EXECUTABLE.finditer(build.read_text()):
            if "install: true" in match[0] and "install_dir" not in match[0]:
                yield match[1]


def plugins(root):
    listed = "".join(path.read_text() for path in sorted((root / "debian").glob("*.install")))
    for plugin in json.loads((root / "docs/plugins_cache.json").read_text()):
        if f"/libgst{plugin}.so\n" not in listed:
            yield f"debian: no package has libgst{plugin}.so"


def programs(root):
    build = root / "src/tools/meson.build"
    purposes = re.search(r"purposes = \{(.*?)\n\}", build.read_text(), re.S)
    named = set(re.findall(r"^ *'([\w-]+)':", purposes[1], re.M)) if purposes else set()
    there = set(installed(root))
    for name in sorted(there - named):
        yield f"src/tools/meson.build: {name} has no purpose, so it has no man page"
    for name in sorted(named - there):
        yield f"src/tools/meson.build: nothing installs {name}, which has a purpose"


def symbols(root):
    page = "debian/libgstlidar-1.0-0.symbols"
    listed = set(re.findall(r"^ (gst_\w+)@", (root / page).read_text(), re.M))
    declared = set()
    for header in sorted((root / "gst/lidar").glob("gst*.h")):
        text = header.read_text()
        declared |= set(re.findall(r"^GST_LIDAR_API [^;(]*?\b(gst_\w+)\(", text, re.M))
    for name in sorted(declared - listed):
        yield f"{page}: no line for {name}"
    for name in sorted(listed - declared):
        yield f"{page}: nobody declares {name}"


def libraries(root):
    control = (root / "debian/control").read_text().split("\n\n")[0]
    needed = {line.split("#")[0].strip() for line in (root / "tests/packages.txt").open()}
    for name in sorted(n for n in needed - TESTS_ONLY if n.endswith("-dev")):
        if not re.search(rf"^ {re.escape(name)}[ ,]", control, re.M):
            yield f"debian/control: Build-Depends lacks {name} of tests/packages.txt"


def check(root):
    return [problem for rule in (plugins, programs, symbols, libraries) for problem in rule(root)]


if __name__ == "__main__":
    found = check(pathlib.Path(sys.argv[1]).resolve())
    sys.exit("\n".join(found) or 0)
