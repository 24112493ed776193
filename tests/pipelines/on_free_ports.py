#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""on_free_ports.py COUNT SCRIPT [options]: runs a script of pipelines/. PORT in its environment, and PORT that begins
one of its options, is the first of COUNT ports that are free. Its guarantees must hold (exit code 0, or 3 if little
came, as on a busy machine)."""
import os
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "support"))
from ports import free_port  # noqa: E402

port = str(free_port(int(sys.argv[1])))
options = [re.sub("^PORT", port, option) for option in sys.argv[3:]]
status = subprocess.run([sys.argv[2], *options], env={**os.environ, "PORT": port}).returncode
sys.exit(0 if status == 3 else status)
