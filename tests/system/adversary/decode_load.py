#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The processor time of lidardec for a robot that sends the dearest slices within its bandwidth.

Prints a line of JSON without and with max-decode-load.
"""
import argparse
import json
import pathlib
import time

import ends
import media
import wire

MOST_MBPS = 2
LOADS = (0, 0.2)


def run(load, seconds):
    options = f"max-decode-load={load}"
    port = ends.free_port()
    receiver = ends.Victim(ends.RECEIVER.format(port=port, options="").replace("lidardec", f"lidardec {options}"))
    sender = ends.HonestSender(ends.Recording(media.DEAR_CONFIG, []), port, start=False)
    for unit in media.split_unit(wire.config_unit(media.DEAR_CONFIG), sender.room):
        sender.send(sender.pack(unit))
    time.sleep(0.3)
    begin, cpu, sent, n = time.monotonic(), receiver.ask()["cpu"], 0, 0
    while (now := time.monotonic()) < begin + seconds:
        while sent < (now - begin) * MOST_MBPS * 125_000:
            packet = sender.pack(wire.slice_unit(media.dear_slice(n)))
            sender.send(packet)
            sent, n = sent + len(packet), n + 1
        time.sleep(0.005)
    used = receiver.ask()["cpu"] - cpu
    over = receiver.last["dec"]["slices-over-load"]
    stop = receiver.timed_close()
    sender.close()
    return {"load": load, "sent_mbps": round(8e-6 * sent / seconds, 2), "processor": round(used / seconds, 2),
            "over": over, "stop_s": round(stop, 2)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=20)
    args = parser.parse_args()
    ends.Victim.program = str(args.build.resolve() / "tests/system/adversary/victim")
    for load in LOADS:
        print(json.dumps(run(load, args.seconds)), flush=True)


if __name__ == "__main__":
    main()
