#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How many numbers the main path of `reconstruct` holds, and of which kind.

    constants.py [--list accept|scale|budget]

Counts constants (constexpr or const scalars named k...) and numeric members of structs named
...Options, ...Model, ...Prices or ...Cost in the folders that a plain `reconstruct` of a rendered
scene runs. Their names sort them: "scale" are standard deviations, prices and priors; "budget" are
numbers of steps, samples and other limits of effort, and tolerances of arithmetic; everything else
accepts or rejects something.
"""
import argparse
import re
import subprocess

FOLDERS = ["edges/image", "edges/views", "edges/contrast", "sketches", "topology", "pipelines/base",
           "pipelines/survey", "pipelines/candidates", "pipelines/join", "pipelines/adjust",
           "pipelines/detectors", "pipelines/options", "pipelines/cameras", "pipelines/method"]
APART = ["sketches/io/"]  # formats of files
SCALE = re.compile(
    r"sigma|noise|price|nats?$|nat_|cost|prior|odds|scatter|weight|deviation|rate|share_of|probab"
    r"|dof|freedom|loss|tukey|huber|scale|log_", re.I)
BUDGET = re.compile(
    r"most_|^k_?most|steps|rounds|iterations|trials|samples|spacing|grid|bins|cells|tries"
    r"|budget|max_|buffer|bytes|epsilon|tiny|digits|threads|chunk|block|seed|version|columns"
    r"|levels|stride|sweep|per_|size_of|eps$|relative$|numer|zero|candidates|passes|seconds"
    r"|step$|depth_|octave|order|degree|knots|precision|places$|pieces|k_points|directions"
    r"|modes|halvings|repeats|k_cell|lookup|window|num_|root2|kinds|unknowns|infinity|never"
    r"|starts|rays|heights|nulls|white|k_pad|moves$|matchings|maxima|check|every", re.I)
CONSTANT = re.compile(
    r"\b(?:constexpr|const)\s+(?:static\s+)?"
    r"(?:double|float|int|size_t|long|unsigned|uint\w+_t|int\w+_t)\s+(k[A-Z]\w*)\s*=")
STRUCT = re.compile(r"\bstruct\s+(\w*(?:Options|Model|Prices|Cost))\b[^;{]*\{(.*?)\n\};", re.S)
MEMBER = re.compile(r"^\s*(?:double|float|int|size_t)\s+([^;(]*=[^;]*);", re.M)


def without_comments(text):
    return re.sub(r"//[^\n]*", "", re.sub(r"/\*.*?\*/", "", text, flags=re.S))


def numbers():
    """Of every number: its name and its file."""
    files = subprocess.run(["git", "ls-files", *FOLDERS], check=True, capture_output=True,
                           text=True).stdout
    for path in files.split():
        if not path.endswith((".cc", ".h")) or path.startswith(tuple(APART)):
            continue
        with open(path, encoding="utf-8") as file:
            text = without_comments(file.read())
        for match in CONSTANT.finditer(text):
            yield match.group(1), path
        for struct in STRUCT.finditer(text):
            for member in MEMBER.finditer(struct.group(2)):
                for one in member.group(1).split(","):
                    if "=" in one:
                        yield one.split("=")[0].strip(), path


def kind(name):
    if SCALE.search(name):
        return "scale"
    return "budget" if BUDGET.search(re.sub(r"(?<!^)(?=[A-Z])", "_", name)) else "accept"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", choices=["accept", "scale", "budget"],
                        help="name each of this kind, too")
    arguments = parser.parse_args()
    found = sorted(numbers())
    for which in ("accept", "scale", "budget"):
        print(f"{sum(kind(name) == which for name, _ in found):5} {which}")
    print(f"{len(found):5} all")
    for name, path in found:
        if kind(name) == arguments.list:
            print(name, path)


if __name__ == "__main__":
    main()
