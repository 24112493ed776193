#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Attacks receivers, senders and ouster_src, and says of each attack whether the promises held."""
import argparse
import concurrent.futures
import dataclasses
import random
import sys
import time
import traceback

import ends
import feedback
import media
import servers
import srtp
import strangers

# The number of attacks that run at the same time. They mostly wait.
AT_ONCE = 4
# The same number with sanitizers, which make the victims slow.
AT_ONCE_SANITIZED = 2
ATTACKS = media.ALL + strangers.ALL + feedback.ALL + srtp.ALL + servers.ALL


@dataclasses.dataclass
class Context:
    recording: ends.Recording
    other: ends.Recording
    random: random.Random
    seconds: float  # the duration of each attack
    sanitized: bool
    # The factor by which limits of memory are multiplied, because a sanitizer needs memory, too.
    memory_factor: int


def run(attack, context):
    """Returns (name, whether the promises held, what was seen)."""
    try:
        return attack.__name__, True, attack(context)
    except AssertionError as broken:
        return attack.__name__, False, str(broken) or traceback.format_exc(limit=-1)
    except Exception:  # pylint: disable=broad-except
        return attack.__name__, False, traceback.format_exc(limit=-2)


def show(name, good, text):
    print(f"{'held  ' if good else 'BROKEN'}  {name.replace('_', ' '):34} {text}", flush=True)


def one_round(chosen, at_once, make_context):
    results = []
    with concurrent.futures.ThreadPoolExecutor(at_once) as pool:
        pending = [pool.submit(run, attack, make_context()) for attack in chosen]
        for done in concurrent.futures.as_completed(pending):
            results.append(done.result())
            show(*results[-1])
    return results


def table(results):
    print(f"\n{'attack':36} runs  held")
    names = dict.fromkeys(name for name, _, _ in results)
    for name in names:
        runs = [good for n, good, _ in results if n == name]
        print(f"{name.replace('_', ' '):36} {len(runs):4}  {sum(runs):4}")
    broken = sum(not good for _, good, _ in results)
    print(f"{len(results)} attacks, {broken} broke a promise; the longest stop took {ends.Victim.longest_stop:.2f} s")
    return broken


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--victim", required=True, help="the program `victim` of this folder")
    parser.add_argument("--minutes", type=float, default=0, help="rounds for so long; 0 for one short round")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--sanitizers", default="none", help="meson's b_sanitize of the victim")
    parser.add_argument("--only", help="attacks whose name contains this")
    options = parser.parse_args()
    ends.Victim.program = options.victim
    sanitized = options.sanitizers != "none"
    # The shadow memory of ThreadSanitizer needs five to ten times the memory of the program. The
    # limits of memory are multiplied by this factor.
    memory_factor = 10 if "thread" in options.sanitizers else 3 if sanitized else 1
    rng = random.Random(options.seed)
    random.seed(options.seed)
    print(f"seed {options.seed}")
    recording, other = ends.record(1, 8), ends.record(2, 8)
    chosen = [a for a in ATTACKS if not options.only or options.only in a.__name__.replace("_", " ")]
    seconds = 8 if options.minutes else 0.5 if sanitized else 1
    until = time.monotonic() + 60 * options.minutes
    results = []
    while not results or time.monotonic() < until:
        rng.shuffle(chosen)
        at_once = AT_ONCE_SANITIZED if sanitized else AT_ONCE
        results += one_round(chosen, at_once, lambda: Context(recording, other, random.Random(rng.random()), seconds,
                                                              sanitized, memory_factor))
    return 1 if table(results) else 0


if __name__ == "__main__":
    sys.exit(main())
