# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the modules of this folder share: the build, the sources, commands and Markdown."""
import csv
import datetime
import functools
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(ROOT / "tests/support"))
import build_tree  # noqa: E402

DATA = ROOT / "tests/data/ouster"
SOURCES = {
    "OS0-32": f"{DATA}/OS-0-32-U1_v2.2.0_1024x10.pcap",
    "OS1-128": f"{DATA}/OS-1-128_v2.3.0_1024x10_lb_n3.pcap,{DATA}/OS-1-128_v2.3.0_1024x10.json",
    "OS0-128": f"{DATA}/OS-0-128-U1_v2.3.0_1024x10.pcap",
    "OS1-32, first generation": f"{DATA}/OS-1-32-G_v2.1.1_1024x10.pcap",
}
build = ROOT / "build"
LIDARS = ROOT / "tests/data/lidars"
# Each of these clouds is a single row of points without a sensor model.
CLOUDS = {"AT128": f"{LIDARS}/at128.pcd", "VLP-16": f"{LIDARS}/vlp16.pcd"}


def use(folder, captures):
    """Sets the build tree `folder`, and adds `captures` to the sources, by name."""
    global build
    build = pathlib.Path(folder).resolve()
    if not (build / "build.ninja").exists():
        raise SystemExit(f"There is no build in {build}: meson setup build && ninja -C build")
    for name, path in captures.items():
        (CLOUDS if path.endswith((".pcd", ".bin")) else SOURCES)[name] = path


def program(name):
    found = [path for path in build.rglob(name) if path.is_file() and os.access(path, os.X_OK)]
    if not found:
        raise SystemExit(f"{build} has no {name}: ninja -C {build}")
    return str(found[0])


@functools.lru_cache
def environment():
    """Returns an environment with plugins and programs of the build tree first, and a registry of their own."""
    programs = {str(path.parent) for path in (build / "src").rglob("ouster-replay")}
    return {
        **build_tree.environment(build, "results-registry.bin"),
        "PATH": ":".join([*programs, os.environ["PATH"]]),
        "BUILD_DIR": str(build),
    }


def run(*command, **options):
    """Returns what a command prints. It runs in the project's folder."""
    options = {"env": environment(), "cwd": ROOT, "check": True, **options}
    words = [str(word) for word in command]
    return subprocess.run(words, stdout=subprocess.PIPE, text=True, **options).stdout


def lidar_eval(*arguments):
    return run(program("lidar-eval"), *arguments)


def rate_distortion(source, *arguments):
    """Returns the rows of `lidar-eval rd` for one source, by column."""
    with tempfile.NamedTemporaryFile(suffix=".csv") as file:
        lidar_eval("rd", source, *arguments, "--csv", file.name)
        with open(file.name) as table:
            return list(csv.DictReader(table))


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def as_printed(text):
    """Returns the tables that a command has printed. Without tables, its output becomes code."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    return "\n".join(lines) if lines else "```\n" + text.strip() + "\n```"


def provenance():
    """Returns commit, date and machine, for the head of a table."""
    commit = run("git", "rev-parse", "--short", "HEAD").strip()
    cpu = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    model = re.sub(r"\(R\)| Processor", "", cpu[1]).strip() if cpu else os.uname().machine
    today = datetime.date.today().isoformat()
    return f"Commit {commit}, {today}, {os.cpu_count()} {model} cores, load {os.getloadavg()[1]:.0f}"


UNITS = ("%", "m", "mm", "cm", "m/s", "s", "ms", "µs", "MB", "Mbit/s", "scans/s", "frames/s", "cores")


def lift_units(text):
    """Moves the unit that all cells of a column share to the column's head."""
    lines = text.split("\n")
    head = next((i for i, line in enumerate(lines) if re.fullmatch(r"\|( ?-+ ?\|)+", line)), 0) - 1
    if head < 0:
        return text
    end = head + 2
    while end < len(lines) and lines[end].startswith("|"):
        end += 1
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in [lines[head], *lines[head + 2:end]]]
    for column, name in enumerate(rows[0]):
        cells = [row[column].rsplit(" ", 1) for row in rows[1:] if row[column] not in ("", "–")]
        units = {cell[1] if len(cell) == 2 and re.fullmatch(r"-?[\d.]+", cell[0]) and cell[1] in UNITS else None for cell in cells}
        if len(units) == 1 and (unit := units.pop()):
            rows[0][column] = f"{name} [{unit}]"
            for row in rows[1:]:
                row[column] = row[column].removesuffix(f" {unit}")
    made = table(rows[0], rows[1:]).split("\n")
    return "\n".join([*lines[:head], *made, lift_units("\n".join(lines[end:]))])
