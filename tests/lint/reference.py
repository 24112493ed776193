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

PAGE = "docs/reference/elements.md"
HEAD = """# Elements, programs, scripts

*Reference. `tests/lint/reference.py . --write` makes this page; edit the code that it reads.*
"""
# Kinds of elements: how their classes begin, and the heading of each.
KINDS = {
    "Sources": "Source/",
    "Coders and files of one scan": "Codec/(Encoder|Decoder|Parser)",
    "RTP payloads": "Codec/(Pay|Depay)loader",
    "Clouds and poses": "(Filter|Converter)/(?!Network)",
    "Congestion control": "Filter/Network",
    "Sinks": "Sink/",
}


def element_tables(root):
    cache = json.loads((root / "docs/plugins_cache.json").read_text())
    elements = {
        name: element
        for content in cache.values()
        for name, element in content.get("elements", {}).items()
    }
    for heading, pattern in KINDS.items():
        rows = [
            f"| [`{name}`](../elements/{name}.md) | {element['description']} |"
            for name, element in sorted(elements.items())
            if re.match(pattern, element["klass"])
        ]
        if rows:
            head = "| element | what it does |\n|---|---|"
            yield "\n".join([f"### {heading}\n", head, *rows])


def page_of(root, name):
    """A link to the page or the section about a program or a script; without one, its name."""
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


def program_table(root):
    yield "| program | what it does |\n|---|---|"
    for build in sorted((root / "src").rglob("meson.build")):
        purposes = re.search(r"^purposes = \{(.*?)\n\}", build.read_text(), re.S | re.M)
        for name, purpose in re.findall(r"'([\w-]+)': '([^']+)'", purposes[1]) if purposes else []:
            yield f"| {page_of(root, name)} | {purpose} |"


def script_table(root):
    yield "| script | what it does |\n|---|---|"
    for script in sorted((root / "pipelines").glob("*.sh")):
        lines = script.read_text().splitlines()
        if lines[0].startswith("#!"):
            yield f"| {page_of(root, script.name)} | {lines[2].lstrip('# ').rstrip('.')} |"


def page(root):
    elements = "\n\n".join(element_tables(root))
    return f"""{HEAD}
## Elements

`gst-inspect-1.0 ELEMENT` lists its pads, and every property with its range and default.

{elements}

## Programs

`--help` lists the options of each, `--version` its release.

{chr(10).join(program_table(root))}

## Scripts

They run from the source tree, as `pipelines/<name>.sh`; `--help` lists the options of each.

{chr(10).join(script_table(root))}
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
