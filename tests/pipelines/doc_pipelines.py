#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs every gst-launch-1.0 command of the README and the docs, or of the pages named, as it is printed.

A command passes if it ends with exit code 0, or still runs without an error a moment after it plays. With -q it does
not print when it plays: then it passes if it runs for some seconds without an error. A command that writes a
file and ends by itself may take longer, because the next ones may read the file.
Windows become fakesinks, and each page has ports and a folder of its own: several pages run at a time, with low
priority.
docs/examples are left out: they have their own elements and test.
Commands that name a sensor by `hostname=` are left out, and reported.
"""
import concurrent.futures
import os
import pathlib
import re
import select
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "support"))
from ports import free_port  # noqa: E402

PLAYING = b"Setting pipeline to PLAYING"  # gst-launch-1.0 prints this, except with -q
ENDS = b"Got EOS from"  # gst-launch-1.0 prints this before it ends by itself
QUIET_SECONDS, PLAY_SECONDS = 4, 1.5
# The error that an element may post while a pipeline stops. Its source pad is deactivated before
# its sink pad, so it may fail to push the first events of a stream.
REFUSED_EVENT = re.compile(rb"ERROR: from element \S+ Internal data stream error\.(?:\n.*){2}\n.*reason error \(-5\)")
PATIENCE = 180  # the longest wait on a busy machine [s]
AT_A_TIME = 4


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


def with_ports(command, ports):
    """Returns `command` with free ports; equal ports stay equal. `ports` are those of the page so far."""

    def replace(match):
        if match.group(2) not in ports:
            ports[match.group(2)] = free_port()
        return match.group(1) + str(ports[match.group(2)])

    # foxglovesink listens at the fixed port 8765 by default, so a port must be set.
    command = re.sub(r"\bfoxglovesink ?", "foxglovesink port=8765 ", command)
    return re.sub(r"(\b(?:\w+-)?port=)(\d+)", replace, command)


def output_for_a_while(process, quiet, play_seconds):
    """Returns what the process prints until it ends or is stopped, and whether it was stopped before it played."""
    output, plays = b"", False
    until = time.monotonic() + (QUIET_SECONDS if quiet else PATIENCE)
    while select.select([process.stdout], [], [], max(0, until - time.monotonic()))[0]:
        printed = os.read(process.stdout.fileno(), 65536)
        if not printed:
            return output, False
        output += printed
        if not plays and PLAYING in output:
            plays = True
            until = time.monotonic() + play_seconds
        # gst-launch-1.0 removes its handler of SIGINT before it has freed everything, so it is not
        # interrupted any more.
        if ENDS in output:
            until = time.monotonic() + PATIENCE
        if time.monotonic() > until:
            break
    process.send_signal(signal.SIGINT)
    return output, not plays and not quiet


def run(command, folder, ports):
    """Returns what went wrong, or None."""
    shown = with_ports(command.replace("autovideosink", "fakesink"), ports)
    process = subprocess.Popen(
        ["bash", "-c", "exec " + shown],
        cwd=folder,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    writes = re.search(r"num-buffers=.*sink [^!]*location=", shown)
    output, never_played = output_for_a_while(
        process, quiet=" -q " in shown, play_seconds=PATIENCE if writes else PLAY_SECONDS
    )
    try:
        rest = process.communicate(timeout=PATIENCE)[0]
    except subprocess.TimeoutExpired:
        process.kill()
        return "does not stop on SIGINT"
    rest, refusals = REFUSED_EVENT.subn(b"", rest)
    output = (output + rest).decode(errors="replace")
    if re.search(r"ERROR|CRITICAL|WARNING: erroneous|could not link|construction is invalid", output):
        return "\n".join(output.splitlines()[-15:])
    if never_played:
        return f"does not play within {PATIENCE} s\n" + "\n".join(output.splitlines()[-5:])
    if process.returncode not in (0, -signal.SIGINT) and not refusals:
        return f"exit code {process.returncode}\n" + "\n".join(output.splitlines()[-5:])
    return None


def run_page(page, root, folder):
    """Returns lines about the page's commands, and how many ran and failed."""
    folder.mkdir()
    # The pages use paths of committed captures relative to the project's folder. The commands run
    # in another folder, because they write files.
    (folder / "tests").symlink_to(root / "tests")
    ports, said, ran, failed = {}, [], 0, 0
    for command in commands(page):
        if "hostname=" in command:
            said.append(f"left out, needs a sensor: {command}")
            continue
        ran += 1
        problem = run(command, folder, ports)
        if problem:
            failed += 1
            said.append(f"FAILED {page.relative_to(root)}:\n  {command}\n  {problem}")
    return said, ran, failed


def main():
    os.nice(5)
    root = pathlib.Path(sys.argv[1]).resolve()
    named = [root / page for page in sys.argv[2:]]
    pages = named or [
        root / "README.md",
        *(p for p in sorted((root / "docs").rglob("*.md")) if "examples" not in p.parts),
    ]
    ran, failed = 0, 0
    with tempfile.TemporaryDirectory() as parent:
        folders = [pathlib.Path(parent) / str(number) for number in range(len(pages))]
        with concurrent.futures.ThreadPoolExecutor(AT_A_TIME) as pool:
            for result in pool.map(run_page, pages, [root] * len(pages), folders):
                print("\n".join(result[0]), end="\n" if result[0] else "")
                ran += result[1]
                failed += result[2]
    print(f"{ran} commands ran, {failed} failed")
    return 1 if failed or ran == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
