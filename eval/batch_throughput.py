#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What a batch takes, beside its scenes one by one.

    batch_throughput.py BINARY --work DIR [--scenes 100] [--jobs 1 2]

Makes small scenes of built-in parts, reconstructs and scores them with `batch`, and then by
`reconstruct` and `evaluate` of each in as many streams. Prints seconds, scenes a core and minute,
and the share of the throughput by hand that the batch reaches. Exit status 0 if that is 95 % or
more.
"""
import argparse
import os
import shutil
import subprocess
import sys
import threading
import time

PARTS = ["box", "l-bracket", "plate-holes"]
ONE_BY_ONE = ["--preset", "fast", "--threads", "1", "--quiet"]
LEAST_SHARE = 0.95


def run(*command):
    subprocess.run(command, stdout=subprocess.DEVNULL, check=True)


def make_scenes(binary, folder, count):
    for i in range(count):
        scene = os.path.join(folder, f"s{i}")
        if not os.path.exists(os.path.join(scene, "meta_data.json")):
            run(binary, "synthesize", PARTS[i % len(PARTS)], "--views", "12", "--resolution", "160",
                "--outputs", "none", "--quiet", "--threads", "1", "--seed", str(i), "--out", scene)


def by_hand(binary, scenes, out):
    for scene in scenes:
        result = os.path.join(out, os.path.basename(scene))
        run(binary, "reconstruct", scene, "--out", result, *ONE_BY_ONE)
        run(binary, "evaluate", "--pred", result, "--gt", scene, "--quiet", "--threads", "1")


def seconds_by_hand(binary, scenes, out, streams):
    threads = [threading.Thread(target=by_hand, args=(binary, scenes[k::streams], out))
               for k in range(streams)]
    start = time.monotonic()
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return time.monotonic() - start


def seconds_of_batch(binary, folder, out, jobs):
    start = time.monotonic()
    run(binary, "batch", folder, "--out", out, "--jobs", str(jobs), "--preset", "fast", "--quiet")
    return time.monotonic() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("binary")
    parser.add_argument("--work", required=True, help="folder for scenes and results")
    parser.add_argument("--scenes", type=int, default=100)
    parser.add_argument("--jobs", type=int, nargs="+", default=[1, 2])
    arguments = parser.parse_args()
    folder = os.path.join(arguments.work, "scenes")
    make_scenes(arguments.binary, folder, arguments.scenes)
    scenes = [os.path.join(folder, f"s{i}") for i in range(arguments.scenes)]
    least = 1
    for jobs in arguments.jobs:
        outs = [os.path.join(arguments.work, name) for name in ("batch", "hand")]
        for out in outs:
            shutil.rmtree(out, ignore_errors=True)
        batch = seconds_of_batch(arguments.binary, folder, outs[0], jobs)
        hand = seconds_by_hand(arguments.binary, scenes, outs[1], jobs)
        rate = 60 * len(scenes) / batch / jobs
        print(f"{len(scenes)} scenes, {jobs} at a time: batch {batch:.1f} s, {rate:.0f} a core and "
              f"minute; by hand {hand:.1f} s ({100 * hand / batch:.0f} %)", flush=True)
        least = min(least, hand / batch)
    return 0 if least >= LEAST_SHARE else 1


if __name__ == "__main__":
    sys.exit(main())
