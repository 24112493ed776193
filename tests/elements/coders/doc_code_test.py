#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The code that a page shows is the code that is tested.

Usage: doc_code_test.py SOURCE_ROOT PAGE LANGUAGE=FILE ...
"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
page = root / sys.argv[2]
missing, shown = [], 0
for language, file in (pair.split("=") for pair in sys.argv[3:]):
    code = (root / file).read_text()
    blocks = re.findall(rf"```{language}\n(.*?)```", page.read_text(), re.S)
    shown += len(blocks)
    missing += [(file, b) for b in blocks if b not in code]
for file, block in missing:
    print(f"{page.name} shows what {file} does not have:\n{block}", file=sys.stderr)
sys.exit(1 if missing or not shown else 0)
