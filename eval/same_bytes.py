#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Whether two builds of the program, or several numbers of threads, write the same bytes.

    same_bytes.py BINARY [OTHER] --scenes SCENE... --out DIR [--threads N...]

Reconstructs each scene with every binary and number of threads (--reproducible) and compares the
folders of results with the first. Reports name the commit of their build: both should be of one.
Prints a line for each scene; exit status 0 if all files are the same, 1 if not.
"""
import argparse
import filecmp
import os
import subprocess
import sys


def reconstructed(binary, threads, scene, folder):
    """Names of the files that a run writes."""
    subprocess.run([binary, "reconstruct", scene, "--out", folder, "--reproducible", "--quiet",
                    "--threads", str(threads)], stdout=subprocess.DEVNULL, check=True)
    return {os.path.relpath(os.path.join(root, name), folder)
            for root, _, names in os.walk(folder) for name in names}


def differing_files(binaries, threads, scene, out):
    """Names of the files that any run lacks or writes otherwise than the first; and of all."""
    first, folder, differing, names = None, None, set(), set()
    for b, binary in enumerate(binaries):
        for n in threads:
            place = os.path.join(out, f"{b}-{n}", os.path.basename(os.path.normpath(scene)))
            names = reconstructed(binary, n, scene, place)
            if first is None:
                first, folder = names, place
                continue
            differing |= first ^ names
            differing |= {name for name in first & names
                          if not filecmp.cmp(os.path.join(folder, name),
                                             os.path.join(place, name), shallow=False)}
    return sorted(differing), sorted(first | names)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("binaries", nargs="+")
    parser.add_argument("--scenes", nargs="+", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--threads", nargs="+", type=int, default=[0])
    arguments = parser.parse_args()
    same = True
    for scene in arguments.scenes:
        differing, names = differing_files(arguments.binaries, arguments.threads, scene,
                                           arguments.out)
        print(f"{os.path.basename(os.path.normpath(scene))}: {len(names)} files,",
              "differ: " + ", ".join(differing) if differing else "the same")
        same = same and not differing
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
