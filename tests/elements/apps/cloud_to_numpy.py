#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Clouds of a pipeline as numpy arrays: prints the nearest point of each scan."""
import sys

import gi
import numpy as np

gi.require_version("Gst", "1.0")
from gi.repository import Gst

NUMPY = dict(I8="i1", U8="u1", I16="<i2", U16="<u2", I32="<i4", U32="<u4", F32="<f4", F64="<f8")


def cloud_of(sample):
    """The points of a sample: a structured array of height x width."""
    caps, buffer = sample.get_caps().get_structure(0), sample.get_buffer()
    names, types, offsets = zip(*(f.split(":") for f in caps["fields"].split(",")))
    point = np.dtype(
        {
            "names": names,
            "formats": [NUMPY[t] for t in types],
            "offsets": [int(o) for o in offsets],
            "itemsize": caps["point-step"],
        }
    )
    data = buffer.extract_dup(0, buffer.get_size())
    return np.frombuffer(data, point).reshape(caps["height"], caps["width"])


def capture_time_of(sample):
    """Nanoseconds since 1970, or None."""
    meta = sample.get_buffer().get_reference_timestamp_meta(Gst.Caps("timestamp/x-unix"))
    return meta.timestamp if meta else None


def samples_of(pipeline):
    """The samples of the appsink until the end; an error ends the program."""
    sink, bus = pipeline.get_by_name("sink"), pipeline.get_bus()
    pipeline.set_state(Gst.State.PLAYING)
    while True:
        if sample := sink.emit("try-pull-sample", 100 * Gst.MSECOND):
            yield sample
        elif message := bus.pop_filtered(Gst.MessageType.ERROR):
            sys.exit(message.parse_error().gerror.message)
        elif sink.get_property("eos"):
            return


def main(source):
    Gst.init(None)
    pipeline = Gst.parse_launch(source + " ! appsink name=sink sync=false")
    for sample in samples_of(pipeline):
        cloud = cloud_of(sample)
        ranges = np.linalg.norm([cloud["x"], cloud["y"], cloud["z"]], axis=0)
        nearest = ranges[ranges > 0].min()
        print(f"{capture_time_of(sample)}: {cloud.shape} points, the nearest at {nearest:.2f} m")
    pipeline.set_state(Gst.State.NULL)


if __name__ == "__main__":
    main(sys.argv[1])
