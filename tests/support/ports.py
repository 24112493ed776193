# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ports for programs that get theirs as options. Prints for each argument the first of so many in a row."""
import contextlib
import random
import socket
import sys


def free_port(count=1):
    """Returns the first of `count` ports that are free for UDP and TCP, below those that the kernel hands out, so that
    they stay free until the program binds them."""
    while True:
        first = random.SystemRandom().randrange(10000, 32769 - count)
        with contextlib.ExitStack() as stack:
            try:
                for port in range(first, first + count):
                    for kind in (socket.SOCK_DGRAM, socket.SOCK_STREAM):
                        stack.enter_context(socket.socket(type=kind)).bind(("", port))
                return first
            except OSError:
                pass  # taken


if __name__ == "__main__":
    for number in sys.argv[1:]:
        print(free_port(int(number)))
