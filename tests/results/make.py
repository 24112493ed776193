#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measures tables of docs/results and writes them into their pages.

A table stands in its page between `<!-- table NAME -->` and `<!-- end -->`. The module of this
folder that is named as the page has a function for each, which returns Markdown.
"""
import argparse
import importlib
import pathlib
import re
import sys

import common


def pages():
    """Returns {page: {name of a table: function that measures it}}."""
    found = {}
    for file in sorted(common.HERE.glob("page_*.py")):
        module = importlib.import_module(file.stem)
        found[file.stem.removeprefix("page_").replace("_", "-")] = module.TABLES
    return found


def write(page, table, text):
    path = common.ROOT / "docs/results" / f"{page}.md"
    old = path.read_text()
    block = re.compile(rf"(<!-- table {re.escape(table)} -->\n).*?(<!-- end -->)", re.S)
    if not block.search(old):
        sys.exit(f"{path} has no table {table}")
    head = f"*{common.provenance()}*\n\n"
    path.write_text(block.sub(lambda match: match[1] + head + text.strip() + "\n" + match[2], old))
    print(f"{page}:{table} is written", flush=True)


def main():
    parser = argparse.ArgumentParser(prog="tests/results.sh", description=__doc__.split("\n")[0])
    parser.add_argument("page", nargs="*", help="page, or page:table; without one, all")
    parser.add_argument("--list", action="store_true", help="name the pages and their tables")
    parser.add_argument("--print", action="store_true", help="print the tables, write nothing")
    parser.add_argument("--build", default=str(common.ROOT / "build"), help="a build tree")
    parser.add_argument(
        "--capture",
        action="append",
        default=[],
        metavar="NAME=FILE",
        help="one more row or column in the tables that compare sensors; repeatable",
    )
    arguments = parser.parse_args()
    known = pages()
    if arguments.list:
        for page, tables in known.items():
            print(f"{page}: {' '.join(tables)}")
        return
    common.use(arguments.build, dict(pair.split("=", 1) for pair in arguments.capture))
    for wanted in arguments.page or known:
        page, _, only = wanted.partition(":")
        if page not in known or only and only not in known[page]:
            parser.error(f"there is no table {wanted}: --list names them")
        for table, measure in known[page].items():
            if only in ("", table):
                text = common.lift_units(measure())
                print(text) if arguments.print else write(page, table, text)


if __name__ == "__main__":
    main()
