#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The code that docs/writing-an-encoder.md shows is the code that is tested."""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
page = root / "docs/writing-an-encoder.md"
code = (root / "tests/elements/coders/example_coder.cpp").read_text()
blocks = re.findall(r"```cpp\n(.*?)```", page.read_text(), re.S)
missing = [b for b in blocks if b not in code]
for block in missing:
    print(f"{page.name} shows what example_coder.cpp does not have:\n{block}", file=sys.stderr)
sys.exit(1 if missing or not blocks else 0)
