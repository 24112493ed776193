#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measures viewers of foxglovesink's slices: over slow links, and many at a time. Prints two tables.

With --check it ends with an error if a goal is missed. It needs the plugins of GST_PLUGIN_PATH_1_0.
"""
import sys
import threading
import time

from edge import Edge
from viewer import Bottleneck, Viewer

SETTLE, SECONDS, MANY = 5, 20, 20
# The columns are: the name of a link, its rate [Mbit/s], its one-way delay [s], the least number of
# scans per second, and the greatest age [ms].
LINKS = [
    ("loopback", None, None, 9.5, 100),
    ("4 Mbit/s, 80 ms round trip", 4, 0.04, 9.5, 400),
    ("1 Mbit/s, 80 ms round trip", 1, 0.04, 3, 600),
]
MOST_OVER_SLICES, MOST_CORES = 1.1, 0.5
# The limit of the delay allows for the 6 ms of the sensor's time that a slice spans, and for twenty
# viewers that share two cores with the sensor.
MOST_DELAY = 10  # [ms] above the delay without viewers
misses = []


def expect(good, text):
    if not good:
        misses.append(text)


def slow_links():
    print("| viewer of 2 Mbit/s | scans/s | age, p95 | downlink | of the slices | coded anew |")
    print("|---|---|---|---|---|---|")
    with Edge(coder="effort=2") as edge:
        time.sleep(SETTLE)
        for name, mbit, delay, scans, age in LINKS:
            viewer = Viewer(Bottleneck(edge.port, mbit, delay).port if mbit else edge.port)
            viewer.run(SETTLE)
            viewer.forget()
            viewer.run(SECONDS)
            f = viewer.figures(SECONDS)
            print(
                f"| {name} | {f['scans_per_second']:.1f} | {f['age_p95_ms']} ms | {f['mbit_per_second']} Mbit/s "
                f"| {f['over_slices']:.2f} times | {100 * f['recoded']:.0f} % |"
            )
            viewer.socket.socket.close()
            expect(f["scans_per_second"] >= scans, f"{name}: {f['scans_per_second']} scans/s")
            expect(f["age_p95_ms"] <= age, f"{name}: {f['age_p95_ms']} ms")
            expect(f["over_slices"] <= MOST_OVER_SLICES, f"{name}: {f['over_slices']} times the slices")


def many_viewers():
    print("| OS1-128 1024x10, viewers | pipeline's delay, p95 | age, p95 of the worst | scans/s of the worst | processor of the edge |")
    print("|---|---|---|---|---|")
    delay_of_none = None
    with Edge(model="os1-128", mbit=4, sink=f"max-clients={MANY}") as edge:
        time.sleep(SETTLE)
        for count in (0, 1, MANY):
            viewers = [Viewer(edge.port) for _ in range(count)]
            run_all(viewers, SETTLE)
            for viewer in viewers:
                viewer.forget()
            edge.delay_ms()
            before = edge.processor_seconds()
            run_all(viewers, SECONDS)
            cores, delay = (edge.processor_seconds() - before) / SECONDS, edge.delay_ms()
            delay_of_none = delay if count == 0 else delay_of_none
            figures = [v.figures(SECONDS) for v in viewers]
            age = f"{max(f['age_p95_ms'] for f in figures)} ms" if viewers else "–"
            scans = f"{min(f['scans_per_second'] for f in figures):.1f}" if viewers else "–"
            print(f"| {count} | {delay:.1f} ms | {age} | {scans} | {cores:.2f} cores |")
            expect(cores <= MOST_CORES, f"{count} viewers: {cores:.2f} cores")
            expect(delay <= delay_of_none + MOST_DELAY, f"{count} viewers: the pipeline's delay is {delay:.1f} ms")
            for viewer in viewers:
                viewer.socket.socket.close()


def run_all(viewers, seconds):
    if not viewers:
        time.sleep(seconds)
    threads = [threading.Thread(target=v.run, args=(seconds,)) for v in viewers]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def main():
    slow_links()
    print()
    many_viewers()
    if "--check" in sys.argv and misses:
        sys.exit("missed: " + "; ".join(misses))


if __name__ == "__main__":
    main()
