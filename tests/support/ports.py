# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ports for programs that get theirs as options. Prints for each argument the first of so many in a row."""
import contextlib
import random
import socket
import sys

_claims = contextlib.ExitStack()  # as long as this process runs


def free_port(count=1):
    """Returns the first of `count` ports that are free for UDP and TCP, below those that the kernel hands out, so that
    they stay free until the program binds them. Until this process ends, no other call here or in free_ports.h returns
    them, in any process."""
    while True:
        first = random.SystemRandom().randrange(10000, 32769 - count)
        with contextlib.ExitStack() as claims, contextlib.ExitStack() as probes:
            try:
                for port in range(first, first + count):
                    claim = claims.enter_context(socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM))
                    claim.bind(f"\0lidar-test-port-{port}")
                    for kind in (socket.SOCK_DGRAM, socket.SOCK_STREAM):
                        probes.enter_context(socket.socket(type=kind)).bind(("", port))
                _claims.push(claims.pop_all())
                return first
            except OSError:
                pass  # taken


if __name__ == "__main__":
    for number in sys.argv[1:]:
        print(free_port(int(number)))
