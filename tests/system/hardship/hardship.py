#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machines that give too little: processor time, buffers, files, disk; and applications that fork, stop or
change what they stream. Streams survive, or report why they cannot."""
import argparse
import concurrent.futures
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import traceback

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "adversary"))
import ends  # noqa: E402
from machine import Skip, cpu_group, small_disk  # noqa: E402

AT_ONCE = 3
# The longest wait [s] for something that takes a moment on an idle machine.
PATIENCE = 30


def comes_true(condition):
    """Returns whether `condition` becomes true within PATIENCE."""
    start = time.monotonic()
    while not condition():
        if time.monotonic() - start > PATIENCE:
            return False
        time.sleep(0.1)
    return True


class Stream:
    """A real sender and a real receiver."""

    def __init__(self, receiver="", sender="", **process):
        self.port = ends.free_port()
        self.receiver = ends.Victim(ends.RECEIVER.format(port=self.port, options=receiver), **process)
        self.sender = ends.Victim(ends.SENDER.format(port=self.port, seed=1, options=sender))
        self.await_clouds()

    def clouds(self):
        return self.receiver.ask()["clouds"]

    def await_clouds(self, more=5):
        """Waits until so many more clouds came. Returns the seconds that it took."""
        start, before = time.monotonic(), self.clouds()
        while self.clouds() < before + more:
            assert time.monotonic() - start < PATIENCE, f"no clouds within {PATIENCE} s"
            time.sleep(0.02)
        return time.monotonic() - start

    def rate(self, seconds=1.0):
        """Returns the clouds a second; 80 are sent."""
        before, start = self.clouds(), time.monotonic()
        time.sleep(seconds)
        return (self.clouds() - before) / (time.monotonic() - start)

    def full_rate(self):
        """Returns the clouds a second once nearly all come: other programs may use the machine for a while."""
        start = time.monotonic()
        while (rate := self.rate()) <= 60:
            assert time.monotonic() - start < PATIENCE, f"{rate:.0f} clouds a second come after {PATIENCE} s"
        return rate

    def finish(self):
        for end in (self.sender, self.receiver):
            assert not end.ask()["error"], end.last["error"]
            end.close()


def tenth_of_a_processor(options):
    """Either end gets 10 % of a processor for some seconds."""
    if options.sanitizers != "none":
        raise Skip("a sanitizer needs more than that")
    seen = []
    with cpu_group(10) as procs:
        for name in ("receiver", "sender"):
            stream = Stream()
            end = getattr(stream, name)
            procs.write_text(str(end.process.pid))
            time.sleep(0.5)
            rate = stream.rate(options.seconds)
            assert rate > 5, f"{rate:.0f} clouds a second come with a tenth of a processor at the {name}"
            rss = end.ask()["rss_kb"]
            (procs.parent.parent / "cgroup.procs").write_text(str(end.process.pid))
            stream.await_clouds()
            recovered = stream.full_rate()
            assert end.last["rss_kb"] < rss + 50_000
            stream.finish()
            seen.append(f"{name}: {rate:.0f} of 80 clouds/s, then {recovered:.0f}")
    return "; ".join(seen)


def stopped(options):
    """A process is stopped, as a debugger or a suspended virtual machine does."""
    seen = []
    for name in ("receiver", "sender"):
        stream = Stream()
        pid = getattr(stream, name).process.pid
        os.kill(pid, signal.SIGSTOP)
        time.sleep(options.stop_seconds)
        os.kill(pid, signal.SIGCONT)
        took = stream.await_clouds()
        stream.full_rate()
        stream.finish()
        seen.append(f"{name} after {1000 * took:.0f} ms")
    return f"{options.stop_seconds:g} s; clouds again: " + ", ".join(seen)


def buffers_of_4_kb(_options):
    """Socket buffers that hold three packets."""
    stream = Stream("buffer-size=4096", "ecnudpsink::buffer-size=4096 ecnudpsrc::buffer-size=4096")
    rate = stream.rate(2)
    dropped = stream.receiver.last["net"]["dropped-by-kernel"]
    lost = stream.receiver.last["depay"]["slices-lost"]
    assert rate > 20, f"{rate:.0f} of 80 clouds a second"
    stream.finish()
    return f"{rate:.0f} of 80 clouds/s; the kernel dropped {dropped:.0f} packets, {lost:.0f} slices were lost"


def forks(_options):
    """The application forks while it streams."""
    stream = Stream()
    for end in (stream.sender, stream.receiver):
        for _ in range(3):
            assert end.ask("fork")["took"] == 0, "a child did not end"
            sockets = end.ask("spawn")["took"]
            assert sockets == 0, f"a program that was started sees {sockets} of our sockets"
    rate = stream.full_rate()
    stream.finish()
    return f"12 children, {rate:.0f} clouds/s"


def clock_of_another(_options):
    """The edge plays by the robot's clock, and the robot by the edge's, over the network."""
    stream = Stream()
    for server, client in ((stream.sender, stream.receiver), (stream.receiver, stream.sender)):
        port = server.ask("provide")["took"]
        assert client.ask(f"follow {port}")["took"] == 1, "the clock was not taken"
        stream.await_clouds()
        rate = stream.full_rate()
    stream.finish()
    return f"{rate:.0f} clouds/s"


def pads_that_come_and_go(_options):
    """Streams are added to a sender and taken away under load, some at once."""
    stream = Stream("eos-on-bye=false")
    threads = stream.sender.ask()["threads"]
    stream.sender.ask("pads 30")
    rate = stream.full_rate()
    ended = comes_true(lambda: stream.sender.ask()["threads"] - threads <= 2)
    assert ended, f"{stream.sender.last['threads'] - threads} threads are left"
    stream.finish()
    return f"30 pads, then {rate:.0f} clouds/s of the stream that stayed"


def many_receivers(options):
    """200 receivers in one process: a thread or two each, and all end."""
    count = 200 if options.sanitizers == "none" else 50
    victim = ends.Victim("fakesrc num-buffers=1 ! fakesink async=false")
    few = victim.ask()["threads"]
    victim.close()
    parts = " ".join("screamsrc address=127.0.0.1 port=0 ! rtplidardepay ! lidardec ! fakesink async=false"
                     for _ in range(count))
    victim = ends.Victim(parts)
    threads = victim.ask()["threads"] - few
    assert not victim.last["error"], victim.last["error"]
    assert threads <= 2 * count + 5, f"{threads} threads for {count} receivers"
    took = victim.ask("null")["took"]
    assert took < 1000 * PATIENCE, f"stopping took {took} ms"
    # GLib ends idle threads of its pool after a while. It keeps 8 of them since version 2.84.
    ended = comes_true(lambda: victim.ask()["threads"] - few <= 8)
    assert ended, f"{victim.last['threads'] - few} threads are left"
    victim.close()
    return f"{threads} threads for {count} receivers, stopped within {took} ms"


def many_streams(options):
    """50 streams through one sender and one port."""
    count = 50
    port = ends.free_port()
    caps = ("application/x-rtp-pt-map,96=(string)\\\"application/x-rtp,media=application,clock-rate=90000,"
            "encoding-name=X-LIDAR-DRACO\\\"")
    pads = " ".join(f"net.src_{n} ! rtplidardepay ! fakesink async=false sync=false" for n in range(1, count + 1))
    receiver = ends.Victim(f'screamsrc name=net address=127.0.0.1 port={port} pt-map="{caps}" {pads}')
    sources = " ".join(f"lidartestsrc is-live=true model=os0-32 mode=512x10 slices-per-scan=1 num-buffers=200 ! "
                       f"lidarenc effort=0 max-error=0.2 ! rtplidarpay ssrc={n} ! net." for n in range(1, count + 1))
    sender = ends.Victim(f"screamsink name=net host=127.0.0.1 port={port} max-bitrate=20000000 {sources}")
    arrived = comes_true(lambda: receiver.ask()["net"]["ssrcs"] == count)
    assert arrived, f"{receiver.last['net']['ssrcs']:.0f} of {count} streams arrived"
    flows = comes_true(lambda: sender.stat("net", "feedback-accepted") > 20 and sender.last["net"]["packets-sent"] > 300)
    assert flows, sender.last["net"]
    threads = sender.last["threads"]
    assert not sender.last["error"], sender.last["error"]
    assert threads <= count + 12, f"{threads} threads for {count} streams"
    edge = receiver.last["threads"]
    assert edge <= 12, f"{edge} threads at the receiver"
    for end in (sender, receiver):
        end.ask("null")
        end.close()
    return f"{count} streams: {threads} threads at the sender (one each is the source's), {edge} at the receiver"


FEW_FILES = {
    "screamsrc": "screamsrc address=127.0.0.1 port=0 ! fakesink async=false",
    "screamsink": "lidartestsrc is-live=true ! lidarenc ! rtplidarpay ! screamsink host=127.0.0.1 port=9",
    "ecnudpsrc": "ecnudpsrc address=127.0.0.1 port=0 ! fakesink async=false",
    "ouster_src": "ouster_src hostname=127.0.0.1:9 ! fakesink async=false",
    "ouster_src capture": "ouster_src location={data}/OS-0-32-U1_v2.2.0_1024x10.pcap ! fakesink async=false",
    "lidarodometry": "lidartestsrc num-buffers=8 ! lidarodometry trajectory={folder}/few.tum ! fakesink async=false",
}


def few_files(options):
    """Limits of `ulimit -n` near what pipelines need: each pipeline works, or gives an error that names the limit."""
    data = pathlib.Path(__file__).resolve().parents[2] / "data" / "ouster"
    told = worked = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, pipeline in FEW_FILES.items():
            for limit in (8, 9, 10, 11, 12, 14, 16, 20):
                run = subprocess.run(
                    [ends.Victim.program, pipeline.format(data=data, folder=folder)], input="report\n", text=True,
                    capture_output=True, timeout=60, check=False,
                    env=dict(os.environ, G_DEBUG=""),  # because GStreamer 1.26 logs a critical message
                    preexec_fn=lambda n=limit: resource.setrlimit(resource.RLIMIT_NOFILE, (n, n)))
                said = run.stdout + run.stderr
                assert run.returncode >= 0, f"{name} with {limit} files: signal {-run.returncode}: {said[-300:]}"
                clear = any(word in said for word in ("Too many open files", "too few file descriptors", "ulimit"))
                failed = run.returncode != 0 or '"error":""' not in run.stdout
                assert not failed or clear, f"{name} with {limit} files: {said[-300:]}"
                told += failed
                worked += not failed
    assert worked > 0
    return f"{told} runs said that there are too few files, {worked} worked"


# Elements that write a file. {file} is its path.
WRITERS = {
    "lidarodometry": "lidartestsrc num-buffers=2000 model=os0-32 mode=512x10 ! lidarodometry trajectory={file} ! "
                     "fakesink async=false",
    "lidartestsrc": "lidartestsrc num-buffers=4000 model=os0-32 mode=512x10 slices-per-scan=64 "
                    "trajectory-location={file} ! fakesink async=false",
    "pcdenc": "lidartestsrc num-buffers=80 model=os0-32 mode=512x10 ! scanassembler ! pcdenc ! filesink location={file}",
    "plyenc": "lidartestsrc num-buffers=80 model=os0-32 mode=512x10 ! scanassembler ! plyenc ! filesink location={file}",
}


def play_to_the_end(pipeline, limit=30):
    victim = ends.Victim(pipeline)
    start = time.monotonic()
    while time.monotonic() - start < limit:
        report = victim.ask()
        if report["error"] or report["eos"]:
            break
        time.sleep(0.05)
    victim.ask("null")
    last = victim.ask()
    victim.close()
    return last


def full_disk(_options):
    """A disk without room: every writer reports it, and leaves no empty file."""
    with small_disk() as disk:
        (disk / "ballast").write_bytes(b"x" * 65536)
        for name, pipeline in WRITERS.items():
            file = disk / "out"
            last = play_to_the_end(pipeline.format(file=file))
            assert last["error"] or last["warnings"], f"{name} does not say that the disk is full"
            left = file.exists() and file.stat().st_size == 0
            assert not left or "filesink" in pipeline, f"{name} left an empty file"
            file.unlink(missing_ok=True)
    return f"{len(WRITERS)} elements"


def disk_that_fills(_options):
    """A disk that is full after the first rows: what was written stays, and the error names the reason."""
    with small_disk() as disk:
        for name in ("lidarodometry", "lidartestsrc"):
            (disk / "ballast").write_bytes(b"x" * (65536 - 8192))
            file = disk / "out"
            last = play_to_the_end(WRITERS[name].format(file=file))
            assert last["error"] or last["warnings"], f"{name} does not say that the disk is full"
            assert file.stat().st_size >= 4096, f"{name} left {file.stat().st_size} bytes"
            file.unlink()
    return "rows that were written stay"


def read_only_disk(_options):
    """A folder that may not be written to."""
    with small_disk() as disk:
        subprocess.run(["mount", "-o", "remount,ro", str(disk)], check=True)
        for name, pipeline in WRITERS.items():
            last = play_to_the_end(pipeline.format(file=disk / "out"))
            assert "out" in last["error"], f"{name}: {last['error']!r}"
    return f"{len(WRITERS)} elements name the file"


def programs_on_a_full_disk(options):
    """Command-line programs exit with an error that names the file, and leave nothing empty."""
    tools = pathlib.Path(options.tools)
    data = pathlib.Path(__file__).resolve().parents[2] / "data" / "ouster"
    capture = data / "OS-0-32-U1_v2.2.0_1024x10.pcap"
    rd = ["rd", str(capture), "--scans", "1", "--errors", "0.1", "--slices", "1"]
    # For each program: its arguments, and a word that its error message must contain.
    commands = {
        "lidar-eval rd": (rd + ["--csv", "{file}"], "out"),
        "lidar-eval slam": (["slam", "synth:os0-32:street:512", "--scans", "3", "--out", "{file}"], "out"),
        "lidar-demo": (["--duration", "1", "--no-plots", "--output", "{file}"], ""),
        "lidar-trace": (["--duration", "3600"], "standard output"),
        "lidar-eval": (rd, "standard output"),
        "codec-tables": ([str(data)], "standard output"),
    }
    ran = 0
    with small_disk() as disk:
        (disk / "ballast").write_bytes(b"x" * 65536)
        for name, (arguments, word) in commands.items():
            program = tools / name.split()[0]
            if not program.exists():
                continue
            file = disk / "out"
            with open("/dev/full", "w") as full:
                writes = "{file}" in arguments
                run = subprocess.run([program] + [a.format(file=file) for a in arguments], text=True, timeout=60,
                                     stdout=subprocess.DEVNULL if writes else full, stderr=subprocess.PIPE, check=False)
            said = run.stderr[-300:]
            assert run.returncode > 0, f"{name} ended with {run.returncode}: {said}"
            assert said and word in said, f"{name} does not name the file: {said}"
            for left in list(disk.glob("out")) + list(disk.glob("out/*")):
                assert left.is_dir() or left.stat().st_size > 0 or left.suffix == ".log", f"{name} left {left.name} empty"
            shutil.rmtree(file, ignore_errors=True)
            file.unlink(missing_ok=True)
            ran += 1
    if ran == 0:
        raise Skip("the programs are not built")
    return f"{ran} programs"


ALL = [tenth_of_a_processor, stopped, buffers_of_4_kb, forks, clock_of_another, pads_that_come_and_go, many_receivers,
       many_streams, few_files, full_disk, disk_that_fills, read_only_disk, programs_on_a_full_disk]


def run(hardship, options):
    try:
        return hardship.__name__, "held", hardship(options)
    except Skip as reason:
        return hardship.__name__, "skipped", str(reason)
    except AssertionError as broken:
        return hardship.__name__, "BROKEN", str(broken) or traceback.format_exc(limit=-1)
    except Exception:  # pylint: disable=broad-except
        return hardship.__name__, "BROKEN", traceback.format_exc(limit=-2)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--victim", required=True, help="the program tests/system/adversary/victim")
    parser.add_argument("--tools", default="", help="the folder of the command-line programs")
    parser.add_argument("--seconds", type=float, default=2, help="of each hardship")
    parser.add_argument("--stop-seconds", type=float, default=2, help="for which a process is stopped")
    parser.add_argument("--sanitizers", default="none", help="meson's b_sanitize of the victim")
    parser.add_argument("--only", help="hardships whose name contains this")
    options = parser.parse_args()
    ends.Victim.program = options.victim
    chosen = [h for h in ALL if not options.only or options.only in h.__name__]
    broken = 0
    with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
        for done in concurrent.futures.as_completed([pool.submit(run, h, options) for h in chosen]):
            name, verdict, text = done.result()
            broken += verdict == "BROKEN"
            print(f"{verdict:8} {name.replace('_', ' '):26} {text}", flush=True)
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
