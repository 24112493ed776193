# SPDX-License-Identifier: LGPL-2.1-or-later
"""Environment of programs that take their plugins from a build tree."""
import os
import pathlib


def environment(build, registry="benchmark-registry.bin"):
    """Returns os.environ with the plugins of `build` first, and a registry of their own."""
    build = pathlib.Path(build).resolve()
    plugins = sorted({str(path.parent) for part in ("gst", "ext") for path in (build / part).rglob("libgst*.so")})
    if not plugins:
        raise SystemExit(f"There are no plugins in {build}: meson setup {build} && ninja -C {build}")
    return os.environ | {"GST_PLUGIN_PATH_1_0": ":".join(plugins), "GST_REGISTRY": str(build / registry)}
