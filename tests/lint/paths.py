#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every path and program that the docs or a comment name exists, and the scripts of printed commands can be run.

Every element has its page and every property its blurb, every message that docs/troubleshooting.md
explains exists, and every page is in the site.
"""
import json
import os
import pathlib
import re
import subprocess
import sys

TOPS = r"(?:\.ci|src|gst|ext|tests|docs|pipelines|packaging)"
PATH = re.compile(r"(?<![\w/.<>{}*$-])(" + TOPS + r"/[\w./*<>{},@$-]*)")
BUILT = re.compile(r"(?<![\w/.-])build(?:-asan|-tsan|-fuzz)?/(" + TOPS + r"/[\w./-]+)")
FILE = re.compile(r"[\w-]+\.(?:md|h|cpp|sh|py)")
PROGRAM = re.compile(r"(?:lidar|ouster|scream)-[a-z][a-z-]*(?![\w.=-])")
OPEN = re.compile(r"[<>{}*$]")  # characters of a pattern; such a text is not a path
SOURCES = (".h", ".cpp", ".sh", ".py", ".build")


def tree(root):
    """Returns the files of the tree: those of git, or of the folder if there is no git."""
    listed = subprocess.run(
        ["git", "-C", root, "ls-files", "-co", "--exclude-standard"], capture_output=True, text=True
    )
    if listed.returncode == 0:
        return [f for f in listed.stdout.splitlines() if (root / f).exists()]
    return [f.relative_to(root).as_posix() for f in root.rglob("*") if f.is_file()]


def programs(root, files):
    """Returns patterns of the names of programs that meson builds; a part that a loop fills in matches anything."""
    found = []
    for file in files:
        if file.endswith("meson.build"):
            for call in re.findall(
                r"(?:executable|library|shared_module)\(([^,]+),", (root / file).read_text()
            ):
                parts = re.findall(r"'([^']*)'|(\+ *\w+)", call)
                name = "".join(re.escape(text) if text else ".*" for text, _ in parts)
                found.append(re.compile(re.sub(r"@\\?\d\\?@", ".*", name) + "$"))
    return found


def code_of(page):
    """Yields (line number, text, whether it is a span in a line) of everything that is set as code."""
    fenced = False
    text = page.splitlines()
    for number, line in enumerate(text, 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif fenced or line.startswith("    "):
            yield number, line, False
        else:
            for span in re.findall(r"`([^`]+)`", line):
                yield number, span, True


class Checker:
    def __init__(self, root):
        self.root = root
        self.files = tree(root)
        self.names = {pathlib.PurePath(f).name for f in self.files}
        self.programs = programs(root, self.files)
        # The strings of the code. Names of properties and messages look like names of programs, but
        # are not reported.
        self.strings = {
            s
            for f in self.files
            if f.endswith((".h", ".cpp"))
            for s in re.findall(r'"([a-z-]+)"', (root / f).read_text())
        }
        self.problems = []

    def path(self, where, path):
        path = path.rstrip(".,")
        if OPEN.search(path):
            return
        if not (self.root / path).exists() and not self.is_built(path):
            self.problems.append(f"{where}: there is no {path}")

    def is_built(self, path):
        folder, _, name = path.rpartition("/")
        while folder and not (self.root / folder / "meson.build").exists():
            folder = folder.rpartition("/")[0]
        return bool(folder) and self.is_program(name)

    def is_program(self, name):
        return any(program.match(name) for program in self.programs)

    def code(self, where, code, inline):
        for match in BUILT.finditer(code):
            if not self.is_built(match.group(1)):
                self.problems.append(f"{where}: nothing builds {match.group(1)}")
        for match in PATH.finditer(BUILT.sub("", code)):
            self.path(where, match.group(1))
        word = code.split()[0] if code.split() else ""
        script = self.root / word
        if not inline and word.endswith((".py", ".sh")) and script.is_file() and not os.access(script, os.X_OK):
            self.problems.append(f"{where}: {word} cannot be run: chmod +x {word}")
        if inline and FILE.fullmatch(word) and word not in self.names:
            self.problems.append(f"{where}: no file is called {word}")
        if PROGRAM.fullmatch(word) and not self.is_program(word) and word not in self.strings:
            self.problems.append(f"{where}: no program is called {word}")

    def pages(self):
        for file in self.files:
            if file.endswith(".md"):
                for number, code, inline in code_of((self.root / file).read_text()):
                    self.code(f"{file}:{number}", code, inline)

    def comments(self):
        for file in self.files:
            if not file.endswith(SOURCES) or file.startswith("tests/lint/"):
                continue
            for number, line in enumerate((self.root / file).read_text().splitlines(), 1):
                comment = re.search(r"(?://|#(?!include)|\*)\s(.*)", line)
                for path in re.findall(
                    TOPS + r"/[\w./-]+\.(?:md|sh|py|json|h|cpp)\b",
                    comment.group(1) if comment else "",
                ):
                    self.path(f"{file}:{number}", path)

    def messages(self):
        page = self.root / "docs/troubleshooting.md"
        sources = [(self.root / f).read_text() for f in self.files if f.endswith(".cpp")]
        for message in re.findall(r'^### "(.+)"$', page.read_text(), re.M) if page.exists() else []:
            if not any(message in text for text in sources):
                self.problems.append(f'docs/troubleshooting.md: nobody says "{message}"')

    def site(self):
        site = self.root / "mkdocs.yml"
        listed = re.findall(r"^ +- (\S+\.md)$", site.read_text(), re.M) if site.exists() else []
        for file in self.files:
            if listed and file.startswith("docs/") and file.endswith(".md") and file[5:] not in listed:
                self.problems.append(f"mkdocs.yml: {file} is not in the site")

    def elements(self):
        cache = json.loads((self.root / "docs/plugins_cache.json").read_text())
        all_elements = [e for plugin in cache.values() for e in plugin.get("elements", {}).items()]
        elements = {name for name, _ in all_elements}
        pages = {page.stem for page in (self.root / "docs/elements").glob("*.md")}
        self.problems += [
            f"docs/elements/{e}.md: element {e} has no page" for e in sorted(elements - pages)
        ]
        self.problems += [
            f"docs/elements/{p}.md: there is no element {p}" for p in sorted(pages - elements)
        ]
        for name, element in all_elements:
            if name in pages:
                self.pipelines(name, f"docs/elements/{name}.md")
            self.properties(name, element.get("properties", {}))

    def pipelines(self, element, page):
        """Checks that the page has a pipeline with the element; the test printed-pipelines runs them."""
        text = (self.root / page).read_text()
        commands = re.findall(r"^ *(?:\w+=\S+ )*gst-launch-1\.0 (?:.*\\\n)*.*", text, re.M)
        if not any(re.search(rf"(?<![\w-]){element}\b", command) for command in commands):
            self.problems.append(f"{page}: no pipeline with {element}")

    def properties(self, element, properties):
        """Checks that each property has a blurb, because pages leave its description to gst-inspect-1.0."""
        self.problems += [
            f"{element}: no blurb of property {name}"
            for name, known in properties.items()
            if not known.get("blurb")
        ]


def check(root):
    checker = Checker(root)
    checker.pages()
    checker.comments()
    checker.elements()
    checker.messages()
    checker.site()
    return checker.problems


if __name__ == "__main__":
    found = check(pathlib.Path(sys.argv[1]).resolve())
    sys.exit("\n".join(found) or 0)
