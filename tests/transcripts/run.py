#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs the commands of transcripts, and compares what they print with what stands there.

    run.py TRANSCRIPT [PROGRAM...]

    # a comment
    mask REGEX => TEXT      a part of the output that differs from run to run
    tolerance 0.01          how far numbers may be off, as a share of them
    $ command               in one bash for all, in an empty folder; PROGRAMs are in its PATH
    > more of the command
    what it prints
    ! what it prints on standard error
    [2]                     its exit code, where that is not 0

UPDATE_GOLDEN=1 in the environment writes the transcript.
"""
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
MARK = "=end of command="
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+\.?\d*(?:e[-+]?\d+)?")
RUN = """{{ {command}
}} 2>$work/errors
status=$?
echo; sed 's/^/! /' $work/errors; echo "{mark} $status"
"""


class Transcript:
    def __init__(self, path):
        self.head, self.steps, self.masks, self.tolerance = [], [], [], 0.0
        for line in path.read_text().splitlines():
            words = line.split()
            if line.startswith("$ "):
                self.steps.append(([line], []))
            elif self.steps and line.startswith("> ") and not self.steps[-1][1]:
                self.steps[-1][0].append(line)
            elif self.steps:
                self.steps[-1][1].append(line)
            else:
                self.head.append(line)
                if words[:1] == ["mask"]:
                    regex, text = line[5:].split(" => ")
                    self.masks.append((re.compile(regex), text))
                elif words[:1] == ["tolerance"]:
                    self.tolerance = float(words[1])

    def play(self, programs):
        """Returns what each command prints, as lines."""
        with tempfile.TemporaryDirectory() as work, tempfile.TemporaryDirectory() as folder:
            path = [str(HERE)] + [str(pathlib.Path(p).resolve().parent) for p in programs] + [os.environ["PATH"]]
            environment = {**os.environ, "PATH": ":".join(path), "work": work, "LC_ALL": "C", "LIDAR_SOURCE": str(HERE.parents[1])}
            script = "".join(RUN.format(command="\n".join(c[2:] for c in command), mark=MARK) for command, _ in self.steps)
            script += "kill $(jobs -p) 2>/dev/null; wait\n"
            done = subprocess.run(["bash"], input=script, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                  errors="replace", cwd=folder, env=environment, check=False)
            outputs = [[]]
            for line in done.stdout.replace(folder, "FOLDER").replace(str(HERE.parents[1]), "SOURCE").splitlines():
                if line.startswith(MARK):
                    outputs[-1] = [x for x in outputs[-1] if x.strip()]
                    outputs[-1] += [f"[{line[len(MARK) + 1:]}]"] * (not line.endswith(" 0"))
                    outputs.append([])
                    continue
                line = line.rstrip()
                for regex, text in self.masks:
                    line = regex.sub(text, line)
                outputs[-1].append(line)
            return outputs[:-1]

    def same(self, is_line, was_line):
        if is_line == was_line:
            return True
        if self.tolerance == 0 or NUMBER.split(is_line) != NUMBER.split(was_line):
            return False
        return all(math.isclose(float(a), float(b), rel_tol=self.tolerance)
                   for a, b in zip(NUMBER.findall(is_line), NUMBER.findall(was_line)))


def main():
    path = pathlib.Path(sys.argv[1])
    transcript = Transcript(path)
    outputs = transcript.play(sys.argv[2:])
    if len(outputs) != len(transcript.steps):
        print(f"{path}: only {len(outputs)} of {len(transcript.steps)} commands have ended")
        return 1
    if "UPDATE_GOLDEN" in os.environ:
        lines = transcript.head + [line for (command, _), output in zip(transcript.steps, outputs) for line in command + output]
        path.write_text("\n".join(lines) + "\n")
        return 0
    failed = 0
    for (command, expected), output in zip(transcript.steps, outputs):
        if len(output) == len(expected) and all(map(transcript.same, output, expected)):
            continue
        failed = 1
        print("\n".join(command))
        for i in range(max(len(output), len(expected))):
            is_line, was_line = (lines[i] if i < len(lines) else None for lines in (output, expected))
            if is_line is None or was_line is None or not transcript.same(is_line, was_line):
                print(f"  - {was_line}\n  + {is_line}")
    if failed:
        print(f"{path}: where this is meant, UPDATE_GOLDEN=1 writes the file.")
    return failed


sys.exit(main())
