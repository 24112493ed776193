#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Each rule of this folder finds a violation that is planted in a small tree, and nothing in a sound tree."""
import pathlib
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
import dependencies
import packaging
import pages
import paths
import reference
import versions
import words

HERE = pathlib.Path(__file__).resolve().parent
SCRIPTS = {"links": HERE / "links.sh", "widths": HERE / "widths.sh"}
MODULES = {
    "dependencies": dependencies,
    "packaging": packaging,
    "pages": pages,
    "paths": paths,
    "reference": reference,
    "versions": versions,
    "words": words,
}

SOUND = {
    "docs/architecture.md": """# Architecture

*Explanation.*

| folder | what | may use | libraries |
|---|---|---|---|
| `src/base` | units | – | liblzma |
| `src/cloud` | clouds | base | – |
| `src/tools/*` | programs | src, `gst/common`, `src/tools/common` | all |
| `gst/lidar` | metas | – | GStreamer |
| `gst/common` | helpers | base | GStreamer |
| `gst/net` | sockets | – | GStreamer, POSIX |
| `gst/*` | plugins | src, `gst/lidar`, `gst/common`, `gst/net` | GStreamer |
| `ext/draco` | Draco | src, `gst/common` | GStreamer, Draco |
| `tests` | tests | all | all |

See `src/base/units.h`, `units.h`, `gst/*`, `gst<name>.cpp`, `lidar-eval --help` and `lidar-port`.

    build/src/tools/eval/lidar-eval > out.csv
""",
    "docs/elements/alpha.md": "# alpha\n\n*Reference.*\n\n    gst-launch-1.0 fakesrc ! \\\n        alpha ! fakesink\n",
    "docs/plugins_cache.json": """
{"one": {"elements": {"alpha": {"description": "Turns clouds", "klass": "Filter/PointCloud",
  "pads": {"sink": {"direction": "sink", "caps": "application/x-pointcloud2"},
           "src": {"direction": "src", "caps": "ANY"}},
  "properties": {"speed": {"blurb": "How fast"}}}}}}
""",
    "docs/reference/elements.md": reference.HEAD
    + """
## Elements

`gst-inspect-1.0 ELEMENT` lists its pads, and every property with its range and default.

### Clouds and poses

- [`alpha`](../elements/alpha.md): Turns clouds

## Programs

`--help` lists the options of each, `--version` its release.

- `lidar-eval`: measures

## Scripts

They run from the source tree, as `pipelines/<name>.sh`; `--help` lists the options of each.

- `turn.sh`: Turns a cloud""",
    "pipelines/turn.sh": "#!/usr/bin/env bash\n# SPDX\n# Turns a cloud.",
    "tests/lint/reference.py": "",
    "pipelines/parts.sh": "# Sourced.",
    "docs/troubleshooting.md": '# Troubleshooting\n\n*How-to.*\n\n### "No cloud of %s."\n',
    "mkdocs.yml": """nav:
  - architecture.md
  - troubleshooting.md
  - Elements:
      - elements/alpha.md
  - reference/elements.md
""",
    "CHANGELOG.md": "# Changelog\n",
    "meson.build": """
dependency(name, version: name.startswith('gstreamer') ? '>= 1.20' : '>= 2.70')
""",
    "README.md": "See [the layout](docs/architecture.md).\n",
    "src/base/units.h": "#include <lzma.h>\n#include <vector>\n",
    "src/cloud/cloud.h": '#include "src/base/units.h"\n#include "src/cloud/cloud.h"\n',
    "src/tools/common/loop.cpp": "#include <sys/epoll.h>\nauto now = steady_clock::now();\n",
    "src/tools/eval/meson.build": """
executable('lidar-eval', 'main.cpp', dependencies: dependency('a'), install: true)
executable('lidar-helper', 'main.cpp', install: true, install_dir: helper_dir)
executable('lidar-lab', 'main.cpp')
""",
    "src/tools/meson.build": """
purposes = {
  'lidar-eval': 'measures',
}
""",
    "debian/control": "Build-Depends:\n libdraco-dev,\n liblzma-dev (>= 5),\n\nPackage: gst\n",
    "debian/gst.install": "usr/lib/*/gstreamer-1.0/libgstone.so\n",
    "debian/libgstlidar-1.0-0.symbols": " gst_lidar_init@Base 0.1.0\n",
    "tests/packages.txt": "g++\nlibdraco-dev\nlibgtest-dev\nliblzma-dev # for models\n",
    "gst/lidar/gstlidar.h": "#include <gst/gst.h>\nGST_LIDAR_API void gst_lidar_init(void);\n",
    "src/tools/eval/main.cpp": '#include "src/cloud/cloud.h"\n#include "src/tools/common/loop.h"\n',
    "gst/common/meta.h": '#include <gst/gst.h>\n#include "src/base/units.h"\n',
    "gst/net/socket.h": "#include <sys/socket.h>\n",
    "gst/alpha/alpha.cpp": """
#include "gst/common/meta.h"
#include "gst/lidar/gstlidar.h"
#include "gst/net/socket.h"
const char* kPort = "lidar-port";
const char* kWarning = "No cloud of %s.";
#if GST_CHECK_VERSION(1, 24, 0)
#elif GST_CHECK_VERSION(1, 22, 0)
auto id = gst_debug_message_get_id(nullptr);
#endif
#if !GLIB_CHECK_VERSION(2, 72, 0)
#else
auto* memory = g_aligned_alloc(1, 8, 8);
#endif
""",
    "ext/draco/draco.cpp": '#include <draco/draco.h>\n#include "gst/common/meta.h"\n',
    "tests/core/test.cpp": '#include "ext/draco/draco.h"\n#include "src/tools/eval/main.h"\n',
}

# For each rule: the path of a file, the new content of that file, and the problem that the rule
# must report.
PLANTED = {
    "dependencies": [
        ("src/base/a.h", '#include "src/cloud/cloud.h"', "src/base must not use src/cloud/cloud.h"),
        ("src/cloud/a.h", '#include "gst/common/meta.h"', "src/cloud must not use gst/common"),
        ("src/cloud/a.h", '#include "src/tools/common/loop.h"', "src/cloud must not use src/tools"),
        ("src/cloud/a.h", "#include <gst/gst.h>", "must not use GStreamer"),
        ("src/cloud/a.h", "#include <glib.h>", "must not use GStreamer"),
        ("src/cloud/a.h", "#include <sys/socket.h>", "must not use POSIX"),
        ("src/cloud/a.h", "#include <mutex>", "must not use threads"),
        ("src/cloud/a.h", "#include <nlohmann/json.hpp>", "must not use nlohmann_json"),
        (
            "src/cloud/a.h",
            "#include <boost/asio.hpp>",
            "must not use a library that the table does not name",
        ),
        (
            "src/cloud/a.h",
            "auto t = std::chrono::steady_clock::now();",
            "must not use steady_clock",
        ),
        ("src/cloud/a.h", 'std::cerr << "x";', "must not use cerr"),
        ("src/cloud/a.h", '#include "cloud.h"', "from the root of the tree"),
        ("src/stray/a.h", "", "no row of docs/architecture.md"),
        (
            "src/tools/eval/a.h",
            '#include "src/tools/bench/b.h"',
            "src/tools/* must not use src/tools/bench",
        ),
        ("gst/common/a.h", '#include "src/cloud/cloud.h"', "gst/common must not use src/cloud"),
        ("gst/common/a.h", '#include "gst/net/socket.h"', "gst/common must not use gst/net"),
        ("gst/common/a.h", "#include <gst/lidar/gstlidar.h>", "gst/common must not use gst/lidar"),
        ("gst/alpha/a.h", '#include "gst/beta/b.h"', "gst/* must not use gst/beta"),
        ("gst/alpha/a.h", '#include "ext/draco/d.h"', "gst/* must not use ext/draco"),
        ("gst/alpha/a.h", '#include "src/tools/common/loop.h"', "gst/* must not use src/tools"),
        ("gst/alpha/a.h", '#include "tests/core/a.h"', "gst/* must not use tests"),
        ("gst/alpha/a.h", "#include <draco/draco.h>", "must not use Draco"),
        ("ext/draco/a.h", '#include "ext/ouster/o.h"', "ext/draco must not use ext/ouster"),
        ("ext/draco/a.h", "#include <curl/curl.h>", "must not use libcurl"),
        ("src/cloud/cloud.h", "", "src/cloud does not use src/base: take it out"),
    ],
    "paths": [
        ("docs/a.md", "`src/cloud/gone.h`", "there is no src/cloud/gone.h"),
        ("docs/a.md", "See `src/gone`.", "there is no src/gone"),
        ("docs/a.md", "`gone.cpp`", "no file is called gone.cpp"),
        ("docs/a.md", "    pipelines/gone.sh --help", "there is no pipelines/gone.sh"),
        ("docs/a.md", "    pipelines/turn.sh --help", "pipelines/turn.sh cannot be run"),
        ("docs/a.md", "```\nlidar-gone --help\n```", "no program is called lidar-gone"),
        ("docs/a.md", "`lidar-gone`", "no program is called lidar-gone"),
        (
            "docs/a.md",
            "    build/src/tools/eval/lidar-gone",
            "nothing builds src/tools/eval/lidar-gone",
        ),
        ("src/base/a.h", "// See docs/gone.md.", "there is no docs/gone.md"),
        ("docs/elements/beta.md", "# beta", "there is no element beta"),
        (
            "docs/elements/alpha.md",
            "# alpha\n\n    gst-launch-1.0 alphabet ! fakesink\n",
            "docs/elements/alpha.md: no pipeline with alpha",
        ),
        (
            "docs/plugins_cache.json",
            '{"one": {"elements": {"alpha": {}, "beta": {}}}}',
            "element beta has no page",
        ),
        (
            "docs/plugins_cache.json",
            '{"one": {"elements": {"alpha": {"properties": {"speeds": {}}}}}}',
            "alpha: no blurb of property speeds",
        ),
        ("docs/troubleshooting.md", '### "No such cloud."', 'nobody says "No such cloud."'),
        ("docs/more.md", "# More", "docs/more.md is not in the site"),
    ],
    "reference": [
        ("docs/reference/elements.md", "", "docs/reference/elements.md is not what"),
        ("pipelines/new.sh", "#!/bin/sh\n# SPDX\n# New.", "is not what the tree has"),
    ],
    "pages": [
        ("docs/a.md", "# A\n\nText.", "docs/a.md:3: is it *Tutorial.*"),
        (
            "docs/results/a.md",
            "# A\n\n*Reference.*\n\n*Commit 1234567, 2026-01-01*\n\n| a |\n|---|\n\n## B\n\n| a |",
            "docs/results/a.md:12: no *Commit",
        ),
        (
            "docs/a.md",
            "# A\n\n*Reference.*\n\n| a | held by |\n|---|---|\n| b | `Suite.IsGone` |",
            "docs/a.md:7: no test is called Suite.IsGone",
        ),
    ],
    "links": [
        ("README.md", "[gone](docs/gone.md)", "no such file: docs/gone.md"),
    ],
    "packaging": [
        (
            "docs/plugins_cache.json",
            '{"one": {"elements": {"alpha": {}}}, "two": {}}',
            "no package has libgsttwo.so",
        ),
        (
            "src/tools/a/meson.build",
            "executable('lidar-a', 'main.cpp', install: true)",
            "lidar-a has no purpose",
        ),
        ("src/tools/eval/meson.build", "", "nothing installs lidar-eval"),
        (
            "gst/lidar/gstcloud.h",
            "GST_LIDAR_API const char* gst_lidar_name(int);",
            "no line for gst_lidar_name",
        ),
        ("gst/lidar/gstlidar.h", "", "nobody declares gst_lidar_init"),
        ("tests/packages.txt", "libnats-dev", "Build-Depends lacks libnats-dev"),
    ],
    "versions": [
        (
            "gst/alpha/a.h",
            "auto id = gst_debug_message_get_id(message);",
            "gst_debug_message_get_id is of GStreamer 1.22",
        ),
        (
            "gst/alpha/a.h",
            "#if GST_CHECK_VERSION(1, 22, 0)\n#else\ngst_debug_message_get_id(message);\n#endif",
            "gst/alpha/a.h:3: gst_debug_message_get_id is of GStreamer 1.22",
        ),
        (
            "gst/alpha/a.h",
            "#if !GST_CHECK_VERSION(1, 22, 0) && defined(X)\n#else\ngst_debug_message_get_id(m);\n#endif",
            "gst/alpha/a.h:3: gst_debug_message_get_id is of GStreamer 1.22",
        ),
        ("tests/core/a.h", "g_aligned_alloc", "is of GLib 2.72"),
        ("meson.build", "", "GStreamer: no lower bound in meson.build"),
    ],
    "words": [
        ("src/base/a.h", "// None where it is empty.", 'a comment begins with "None"'),
        ("gst/alpha/a.h", "int a = 1;  // In the order of b.", 'a comment begins with "In"'),
        ("src/base/a.h", "constexpr int kLong = 1;", "kLong says nothing by itself"),
        ("src/base/a.h", "// A list that nobody reads.", '"nobody" is a person'),
    ],
    "widths": [
        ("docs/a.md", "word " * 21, "docs/a.md:1: wider"),
        ("tests/data/a.md", "word " * 21, "tests/data/a.md:1: wider"),
    ],
}


def run(rule, tree):
    """Returns the report of the rule about the tree; empty if all is well."""
    if rule in MODULES:
        return "\n".join(MODULES[rule].check(pathlib.Path(tree)))
    result = subprocess.run([SCRIPTS[rule], tree], capture_output=True, text=True)
    return result.stderr or ("failed silently" if result.returncode else "")


def plant(tree, files):
    for name, text in files.items():
        path = pathlib.Path(tree) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text + "\n")


def main():
    failed = []
    with tempfile.TemporaryDirectory() as tree:
        plant(tree, SOUND)
        for rule in [*MODULES, *SCRIPTS]:
            said = run(rule, tree)
            if said:
                failed.append(f"{rule} finds fault with a sound tree:\n{said}")
    planted = [(rule, *row) for rule, rows in PLANTED.items() for row in rows]
    for rule, name, text, expected in planted:
        with tempfile.TemporaryDirectory() as tree:
            plant(tree, {**SOUND, name: text})
            said = run(rule, tree)
            if expected not in said:
                failed.append(f"{rule} does not see {text!r} in {name}: {said}")
    print("\n".join(failed) or f"{len(planted)} planted violations were found")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
