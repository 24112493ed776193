#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs every gst-launch-1.0 command of the README and the docs as it is printed.

A command passes where it ends with exit code 0, or still runs without an error after a few seconds. Windows become
fakesinks; commands that name a sensor by `hostname=` are left out, and said so.
"""
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

SECONDS = 4


def commands(page):
    """Each command of `page` with its continuation lines joined."""
    command = None
    for line in page.read_text().splitlines():
        line = line.strip()
        if command is None and re.match(r"(\w+=\S+ )*gst-launch-1\.0 ", line):
            command = ""
        if command is None:
            continue
        command += line.removesuffix("\\").rstrip() + " "
        if not line.endswith("\\"):
            yield command.strip().removesuffix("&").strip()
            command = None


def run(command, folder):
    """None, or what went wrong."""
    shown = command.replace("autovideosink", "fakesink")
    process = subprocess.Popen(["bash", "-c", "exec " + shown], cwd=folder, text=True, stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    try:
        output, _ = process.communicate(timeout=SECONDS)
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGINT)
        try:
            output, _ = process.communicate(timeout=10)
        except subprocess.TimeoutExpired:
            process.kill()
            return "does not stop on SIGINT"
    bad = [l for l in output.splitlines() if re.search(r"ERROR|CRITICAL|WARNING: erroneous|could not link", l)]
    if bad:
        return "\n".join(bad[:5])
    if process.returncode not in (0, -signal.SIGINT):
        return f"exit code {process.returncode}\n" + "\n".join(output.splitlines()[-5:])
    return None


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    pages = [root / "README.md", *sorted((root / "docs").rglob("*.md"))]
    ran, failed = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        # Pages name the committed captures from the project's folder; what commands write goes elsewhere.
        (pathlib.Path(folder) / "tests").symlink_to(root / "tests")
        for page in pages:
            for command in commands(page):
                if "hostname=" in command:
                    print(f"left out, needs a sensor: {command}")
                    continue
                ran += 1
                problem = run(command, folder)
                if problem:
                    failed += 1
                    print(f"FAILED {page.relative_to(root)}:\n  {command}\n  {problem}")
    print(f"{ran} commands ran, {failed} failed")
    return 1 if failed or ran == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
