# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts of a machine that are made small for a while."""
import contextlib
import os
import pathlib
import subprocess
import tempfile
import time


class Skip(Exception):
    """This machine cannot do it; the text names the reason."""


@contextlib.contextmanager
def cpu_group(percent):
    """Makes a cgroup that gets `percent` of a processor; yields its file cgroup.procs."""
    name = f"lidar-hardship-{os.getpid()}"
    v1, v2 = pathlib.Path("/sys/fs/cgroup/cpu"), pathlib.Path("/sys/fs/cgroup")
    try:
        if (v2 / "cgroup.controllers").exists():
            group, limits = v2 / name, {"cpu.max": f"{percent * 1000} 100000"}
        elif v1.exists():
            group, limits = v1 / name, {"cpu.cfs_period_us": "100000", "cpu.cfs_quota_us": f"{percent * 1000}"}
        else:
            raise Skip("there is no cgroup for processor time")
        group.mkdir()
    except OSError as error:
        raise Skip(f"no cgroup can be made: {error}") from None
    try:
        for file, value in limits.items():
            (group / file).write_text(value)
    except OSError as error:
        group.rmdir()
        raise Skip(f"the cgroup cannot be limited: {error}") from None
    try:
        yield group / "cgroup.procs"
    finally:
        for _ in range(100):
            with contextlib.suppress(OSError):
                group.rmdir()
                break
            time.sleep(0.05)


@contextlib.contextmanager
def small_disk():
    """A folder of 64 kB; another process may fill it."""
    with tempfile.TemporaryDirectory() as folder:
        mount = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "none", folder], capture_output=True,
                               text=True, check=False)
        if mount.returncode != 0:
            raise Skip(f"no disk can be made: {mount.stderr.strip()}")
        try:
            yield pathlib.Path(folder)
        finally:
            subprocess.run(["umount", folder], check=False)
