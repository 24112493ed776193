#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""docs/reference/elements.md lists what the tree has; `reference.py ROOT --write` makes it.

Elements come from docs/plugins_cache.json, which the test `inspect` compares with what
gst-inspect-1.0 shows. Programs come with the purposes of their man pages, scripts with the sentence
at their head.
"""
import json
import pathlib
import re
import sys
import textwrap

PAGE = "docs/reference/elements.md"
HEAD = """# Elements, programs, scripts

*Reference. `tests/lint/reference.py . --write` makes this page; edit the code that it reads.*
"""
# For each heading of the page: a pattern of the classes of its elements.
KINDS = {
    "Sources": "Source/",
    "Coders and files of one scan": "Codec/(Encoder|Decoder|Parser)",
    "RTP payloads": "Codec/(Pay|Depay)loader",
    "Clouds and poses": "(Filter|Converter)/(?!Network)",
    "Congestion control": "Filter/Network",
    "Sinks": "Sink/",
}


def item(name, purpose):
    return textwrap.fill(
        f"- {name}: {purpose}", 100, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False
    )


def element_lists(root):
    cache = json.loads((root / "docs/plugins_cache.json").read_text())
    elements = {
        name: element
        for content in cache.values()
        for name, element in content.get("elements", {}).items()
    }
    for heading, pattern in KINDS.items():
        rows = [
            item(f"[`{name}`](../elements/{name}.md)", element["description"])
            for name, element in sorted(elements.items())
            if re.match(pattern, element["klass"])
        ]
        if rows:
            yield "\n".join([f"### {heading}\n", *rows])


def page_of(root, name):
    """Returns a link to the page or the section about a program or a script; its name if there is none."""
    code = f"`{name}`"
    stem = name.removesuffix(".sh")
    if (root / f"docs/{stem}.md").exists():
        return f"[{code}](../{stem}.md)"
    for page in sorted((root / "docs").rglob("*.md")):
        for heading in re.findall(r"^##+ (.*)$", page.read_text(), re.M):
            if heading == name or heading.startswith(f"{code}"):
                anchor = re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")
                return f"[{code}](../{page.relative_to(root / 'docs').as_posix()}#{anchor})"
    return code


def program_list(root):
    for build in sorted((root / "src").rglob("meson.build")):
        purposes = re.search(r"^purposes = \{(.*?)\n\}", build.read_text(), re.S | re.M)
        for name, purpose in re.findall(r"'([\w-]+)': '([^']+)'", purposes[1]) if purposes else []:
            yield item(page_of(root, name), purpose)


def script_list(root):
    for script in sorted((root / "pipelines").glob("*.sh")):
        lines = script.read_text().splitlines()
        if lines[0].startswith("#!"):
            yield item(page_of(root, script.name), lines[2].lstrip("# ").rstrip("."))


def page(root):
    elements = "\n\n".join(element_lists(root))
    return f"""{HEAD}
## Elements

`gst-inspect-1.0 ELEMENT` lists its pads, and every property with its range and default.

{elements}

## Programs

`--help` lists the options of each, `--version` its release.

{chr(10).join(program_list(root))}

## Scripts

They run from the source tree, as `pipelines/<name>.sh`; `--help` lists the options of each.

{chr(10).join(script_list(root))}
"""


def check(root):
    path = root / PAGE
    if path.exists() and path.read_text() == page(root):
        return []
    return [f"{PAGE} is not what the tree has: tests/lint/reference.py . --write"]


if __name__ == "__main__":
    top = pathlib.Path(sys.argv[1]).resolve()
    if "--write" in sys.argv[2:]:
        (top / PAGE).write_text(page(top))
    sys.exit("\n".join(check(top)) or 0)
