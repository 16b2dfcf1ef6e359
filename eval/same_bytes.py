#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Whether two builds of the program write the same bytes.

    same_bytes.py BINARY OTHER --scenes SCENE... --out DIR

Reconstructs each scene with both (--reproducible) and compares the folders of results. Reports name
the commit of their build: both should be of one. Prints a line for each scene; exit status 0 if all
files are the same, 1 if not.
"""
import argparse
import filecmp
import os
import subprocess
import sys


def reconstructed(binary, scene, folder):
    subprocess.run([binary, "reconstruct", scene, "--out", folder, "--reproducible", "--quiet"],
                   stdout=subprocess.DEVNULL, check=True)
    return {os.path.relpath(os.path.join(root, name), folder)
            for root, _, names in os.walk(folder) for name in names}


def differing(one, other, names):
    return [name for name in sorted(names)
            if not filecmp.cmp(os.path.join(one, name), os.path.join(other, name), shallow=False)]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("binary")
    parser.add_argument("other")
    parser.add_argument("--scenes", nargs="+", required=True)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    same = True
    for scene in arguments.scenes:
        name = os.path.basename(os.path.normpath(scene))
        folders = [os.path.join(arguments.out, which, name) for which in ("one", "other")]
        files = [reconstructed(binary, scene, folder)
                 for binary, folder in zip((arguments.binary, arguments.other), folders)]
        wrong = sorted(files[0] ^ files[1]) + differing(*folders, files[0] & files[1])
        print(f"{name}: {len(files[0] | files[1])} files,",
              "differ: " + ", ".join(wrong) if wrong else "the same")
        same = same and not wrong
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
