#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every include obeys the table "Layout" of docs/architecture.md.

That table is the only list of who may use what.
"""
import pathlib
import re
import sys

# For each library in the table of dependencies: how the paths of its headers begin.
LIBRARIES = {
    "liblzma": ("lzma",),
    "liblz4": ("lz4",),
    "liblzf": ("lzf",),
    "libzstd": ("zstd",),
    "zlib": ("zlib",),
    "nlohmann_json": ("nlohmann/",),
    "libpcap": ("pcap/", "pcap."),
    "Eigen": ("Eigen/", "unsupported/Eigen/"),
    "Ceres": ("ceres/",),
    "robin-map": ("tsl/",),
    "Draco": ("draco/",),
    "Cyclone DDS": ("dds/",),
    "libcurl": ("curl/",),
    "libsoup": ("libsoup/",),
    "libnats": ("nats/",),
    "CLI11": ("CLI/",),
    "GStreamer": ("gst/", "glib", "gio/", "gmodule"),
    "POSIX": (
        "sys/",
        "netinet/",
        "arpa/",
        "net/",
        "linux/",
        "ifaddrs.h",
        "netdb.h",
        "poll.h",
        "unistd.h",
        "fcntl.h",
        "sched.h",
        "pthread.h",
        "signal.h",
    ),
    "threads": ("thread", "mutex", "shared_mutex", "condition_variable", "future"),
}
# Names that the table uses for several folders, and how the paths of these folders begin. Programs
# are not part of src.
GROUPS = {
    "all": "",
    "src": "src/",
    "gst": ("gst/lidar/", "gst/common/"),
    "ext": "ext/",
}
SYSTEM = ("POSIX", "threads")  # elements have both through GStreamer
FREE = ("emmintrin.h", "immintrin.h", "arm_neon.h", "wasm_simd128.h", "limits.h")
# Functions that src/ must not call. The check of includes does not find these calls. Programs may
# call these functions.
WORLD = re.compile(
    r"\b(steady_clock|system_clock|high_resolution_clock|random_device|getenv"
    r"|printf|fprintf|cout|cerr)\b"
)
OURS = ("src", "gst", "ext", "tests")
# Installed headers include each other in the same way as their users do.
PUBLIC = "gst/lidar/"


def cell_names(cell):
    return [name.strip(" `") for name in cell.split(",") if name.strip(" `") not in ("", "–")]


def read_table(root):
    """Returns {folder: (folders it may use, libraries it may use)}."""
    page = (root / "docs/architecture.md").read_text()
    rows = {}
    for line in page.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if len(cells) == 4 and re.match(r"`(src|gst|ext|tests)\b", cells[0]):
            for folder in cell_names(cells[0]):
                rows[folder] = (cell_names(cells[2]), cell_names(cells[3]))
    return rows


def row_of(path, rows):
    """Returns the row for a path: its own, a parent's, or the row with a star in place of its name."""
    parts = path.split("/")
    for length in range(len(parts), 0, -1):
        folder = "/".join(parts[:length])
        if folder in rows:
            return folder
        star = "/".join(parts[: length - 1] + ["*"])
        if star in rows:
            return star
    return None


def folder_of(path, row):
    """Returns the folder that `row` names, with its star filled in."""
    return "/".join(path.split("/")[: row.count("/") + 1])


def may_use(uses, target):
    for use in uses:
        use = use if "/" in use or use in GROUPS else "src/" + use
        if target.startswith(GROUPS.get(use, use + "/")) and not (
            use == "src" and target.startswith("src/tools/")
        ):
            return True
    return False


def library_of(header):
    if header in FREE:
        return None
    for name, starts in LIBRARIES.items():
        for start in starts:
            if (
                header == start
                or (not start.isalpha() or "." in header)
                and header.startswith(start)
            ):
                return name
    return (
        "a library that the table does not name"
        if "/" in header or header.endswith((".h", ".hpp"))
        else None
    )


def check_line(root, path, line, rows, row, used):
    """Returns what is wrong with one line, or None."""
    uses, libraries = rows[row]
    match = re.match(r'\s*#\s*include\s*(["<])([^">]+)[">]', line)
    if not match:
        if path.startswith("src/") and "all" not in libraries:
            found = WORLD.search(line.split("//")[0])
            return f"{row} must not use {found.group(1)}" if found else None
        return None
    quote, header = match.groups()
    if quote == '"' or header.startswith(PUBLIC):
        if header.split("/")[0] not in OURS:
            generated = (root / path).parent / (header + ".in")
            return (
                None
                if generated.exists()
                else f'write the include from the root of the tree: "{header}"'
            )
        if header.startswith(folder_of(path, row) + "/"):
            return None
        used.add((row, header))
        return None if may_use(uses, header) else f"{row} must not use {header}"
    library = library_of(header)
    if library is None or "all" in libraries or library in libraries:
        return None
    if library in SYSTEM and "GStreamer" in libraries:
        return None
    return f"{row} must not use {library} (<{header}>)"


def check(root):
    rows = read_table(root)
    problems = [] if rows else ["docs/architecture.md: no table of folders"]
    used = set()
    for top in OURS:
        for file in sorted((root / top).rglob("*")):
            if file.suffix not in (".h", ".cpp"):
                continue
            path = file.relative_to(root).as_posix()
            row = row_of(path, rows)
            if row is None:
                problems.append(f"{path}: no row of docs/architecture.md is about this folder")
                continue
            for number, line in enumerate(file.read_text().splitlines(), 1):
                problem = check_line(root, path, line, rows, row, used)
                if problem:
                    problems.append(f"{path}:{number}: {problem}")
    for folder, (uses, _) in rows.items():
        if "*" not in folder and not (root / folder).is_dir():
            problems.append(f"docs/architecture.md: there is no folder {folder}")
        # A permission that is not used is reported, because it would hide a later violation.
        for use in uses:
            target = use if "/" in use else "src/" + use
            if use in GROUPS or "*" in folder:
                continue
            if not (root / target).is_dir():
                problems.append(
                    f"docs/architecture.md: {folder} may use {target}, which there is not"
                )
            elif not any(
                user == folder and header.startswith(target + "/") for user, header in used
            ):
                problems.append(
                    f"docs/architecture.md: {folder} does not use {target}: take it out"
                )
    return problems


if __name__ == "__main__":
    found = check(pathlib.Path(sys.argv[1]).resolve())
    sys.exit("\n".join(found) or 0)
