# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ports for programs that get theirs as options. Prints one for each argument, `udp` or `tcp`."""
import random
import socket
import sys

KINDS = {"udp": socket.SOCK_DGRAM, "tcp": socket.SOCK_STREAM}


def free_port(kind="udp"):
    """Returns a free port below those that the kernel hands out, so that it stays free until the program binds it."""
    while True:
        port = random.SystemRandom().randrange(10000, 32768)
        with socket.socket(type=KINDS[kind]) as s:
            try:
                s.bind(("127.0.0.1", port))
                return port
            except OSError:
                pass  # taken


if __name__ == "__main__":
    for name in sys.argv[1:]:
        print(free_port(name))
