#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Each comment of a file begins with its subject or verb, and names of constants have a meaning.

Usage: words.py [FILE ...], as a hook of git runs it over the files of a commit. Without files it
reads all code except the rooms of LATER.

A comment that begins with a pronoun without a noun, or with a preposition, has to be read twice:
"After so long a gap is no gap" for "A longer gap is the link's new capacity".
"""
import pathlib
import re
import sys

PRONOUNS = "None|Nobody|Nothing|One|Those|Whoever|Whatever|Where|Whose"
PREPOSITIONS = (
    "About|Above|After|Against|Among|At|Before|Behind|Below|Beside|Besides|Between|Beyond|By|From|In"
    "|Into|Of|On|Out|Over|Past|Since|Through|To|Toward|Under|Until|Upon|With|Within|Without"
)
BEGIN = re.compile(rf"(?:{PRONOUNS}|{PREPOSITIONS}) (?!\w*\(|- )(?!most|least)")
# Words that describe code as a person.
PERSONS = re.compile(r"//.*\b([Nn]obody|[Ww]hoever|[Ss]omebody|[Aa]nybody|[Ee]verybody|[Tt]ells|[Bb]eliev\w*)\b")
LATER = ()
# Names of constants that have no meaning without the code around them.
VAGUE = re.compile(r"\bk(?:Back|Enough|Gone|Long|Longer|Soon|Sure)\b")
def comments(text):
    """(line number, first line) of each comment: a block of lines counts once."""
    inside = False
    for number, line in enumerate(text.splitlines(), 1):
        match = re.match(r"(\s*)///? ?(.*)", line)
        if match:
            if not inside:
                yield number, match[2].lstrip("<! ")
            inside = True
            continue
        inside = False
        behind = re.search(r"[;,{})]\s+///?<? ([^\"]*)$", line)
        if behind:
            yield number, behind[1]
            inside = True  # further lines of the same comment


def check_file(name, text):
    for number, comment in comments(text):
        if BEGIN.match(comment):
            yield f'{name}:{number}: a comment begins with "{comment.split()[0]}": {comment}'
    for number, line in enumerate(text.splitlines(), 1):
        person = PERSONS.search(line)
        if person:
            yield f'{name}:{number}: "{person[1]}" is a person: {line.strip()}'
        vague = VAGUE.search(re.sub(r'"[^"]*"|//.*', "", line))
        if vague:
            yield f"{name}:{number}: {vague[0]} says nothing by itself"


def check(root, files=None):
    """Problems of `files`, or of all code below `root`."""
    files = files or [
        f
        for room in ("src", "gst", "ext")
        for f in sorted((root / room).rglob("*"))
        if not str(f.relative_to(root)).startswith(LATER)
    ]
    return [
        problem
        for file in files
        if file.suffix in (".h", ".cpp")
        for problem in check_file(str(file.relative_to(root)), file.read_text())
    ]


if __name__ == "__main__":
    top = pathlib.Path(__file__).resolve().parents[2]
    found = check(top, [pathlib.Path(name).resolve() for name in sys.argv[1:]])
    sys.exit("\n".join(found) or 0)
