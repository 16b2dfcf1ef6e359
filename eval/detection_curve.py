#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Recall against the evidence that the pictures hold, on made scenes: the detection curve.

Makes scenes of built-in parts in light that gets even and with noise, reconstructs them, and asks
of every true edge what its pictures show of it: in each view that sees most of it
(edges_visible/), the mean step of grey values across the projected edge, less what slopes
on both sides foretell, over its standard error. The evidence of an edge is the root of the sum
over views of the squares, less one each: the standard deviations by which all views together show
it. No edge detector is involved. Recall is the share of its length within 5 thousandths of a
stroke.

A logistic curve in the logarithm of the evidence, weighted by length, tells where half and nine
tenths are found. Scenes and results that are there already are used again.

  eval/detection_curve.py --binary build/pipelines/sketchsplat --work DIR [--detector 2dgs-sn]
"""

import argparse
import json
import os
import subprocess
import sys

import cv2
import numpy as np
from scipy.spatial import cKDTree

PARTS = ["countersunk-plate", "pocket-block", "corner-block", "plate-holes", "pleat-block",
         "slotted-sheet"]
# Share of even light (1: all faces have one shade), standard deviation of the noise.
CONDITIONS = [(0, 0.5), (0.9, 0.5), (0.97, 0.5), (0.99, 0.5), (0.9, 3), (0.97, 3), (0.99, 6)]
STEP = 0.002        # of samples along an edge, longest side 1
CLOSE = 0.005       # of a stroke to what it finds
LEAST_SHARE = 0.5   # of an edge that a view must see to tell of it
BINS = [0, 2, 4, 7, 11, 18, 30, 50, 80, 130, 220, 10 ** 9]


def run(arguments):
    done = subprocess.run(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode not in (0, 4):  # 4: too little in the scene
        sys.exit(done.stderr)


def make(arguments, part, even, noise):
    """Folders of a scene and of what was found in it."""
    name = f"{part}.{even}.{noise}"
    scene = f"{arguments.work}/scenes/{name}"
    result = f"{arguments.work}/{arguments.detector}/{name}"
    if not os.path.exists(scene + "/meta_data.json"):
        run([arguments.binary, "synthesize", part, "--out", scene, "-q", "--outputs", "edges",
             "--views", "24", "--resolution", "400", "--object-size", "0.5",
             "--even-light", str(even), "--noise", str(noise)])
    if not os.path.exists(result):
        run([arguments.binary, "reconstruct", scene, "--out", result, "-q", "--overlays", "0",
             "--detector", arguments.detector, "--threads", str(arguments.threads)])
        os.makedirs(result, exist_ok=True)
    return scene, result


def densify(points, step):
    out = []
    for a, b in zip(points[:-1], points[1:]):
        n = max(int(np.ceil(np.linalg.norm(b - a) / step)), 1)
        out.append(a + (b - a) * (np.arange(n) / n)[:, None])
    return np.concatenate(out + [points[-1:]])


def read_views(scene):
    """Per view: grey values, intrinsics, camera from world, standard deviation of the noise."""
    with open(scene + "/meta_data.json") as file:
        frames = json.load(file)["frames"]
    for frame in frames:
        image = cv2.imread(f"{scene}/color/{frame['rgb_path']}", cv2.IMREAD_UNCHANGED)
        image = image.astype(np.float32)
        alpha = image[..., 3] / 255 if image.shape[2] == 4 else np.ones(image.shape[:2], np.float32)
        grey = image[..., :3].mean(2) * alpha
        second = grey[:, 1:-1] - (grey[:, :-2] + grey[:, 2:]) / 2
        noise = 1.4826 * np.median(np.abs(second[alpha[:, 1:-1] > 0.99])) / np.sqrt(1.5)
        yield (grey, np.array(frame["intrinsics"])[:3, :3],
               np.linalg.inv(np.array(frame["camtoworld"])), max(float(noise), 0.3))


def visible_shares(scene, k, view, edges):
    """Of each true edge the share of its projected length that view k shows."""
    with open(f"{scene}/edges_visible/{k}.json") as file:
        visible = json.load(file)
    seen = np.zeros(len(edges))
    for curve, line in zip(visible["curve"], visible["polylines"]):
        seen[curve] += np.linalg.norm(np.diff(np.array(line), axis=0), axis=1).sum()
    _, intrinsics, world, _ = view
    whole = np.ones(len(edges))
    for i, points in enumerate(edges):
        u = (points @ world[:3, :3].T + world[:3, 3]) @ intrinsics.T
        whole[i] = np.linalg.norm(np.diff(u[:, :2] / u[:, 2:], axis=0), axis=1).sum()
    return seen / np.maximum(whole, 1e-9)


def step_over_error(view, points):
    """The step across the projected points, over its standard error; 0 where it is too short."""
    grey, k, world, noise = view
    x = points @ world[:3, :3].T + world[:3, 3]
    u = x @ k.T
    u = u[:, :2] / u[:, 2:]
    along = np.gradient(u, axis=0)
    length = np.linalg.norm(along, axis=1)
    if (x[:, 2] <= 0).any() or (length < 1e-9).any() or length.sum() < 4:
        return 0.0
    normal = np.stack([-along[:, 1], along[:, 0]], 1) / length[:, None]

    def at(offset):
        p = (u + offset * normal).astype(np.float32)
        return cv2.remap(grey, p[:, :1], p[:, 1:], cv2.INTER_LINEAR).ravel()

    near = [(at(1.5 * s) + at(2.5 * s)) / 2 for s in (1, -1)]
    far = [(at(4.5 * s) + at(5.5 * s)) / 2 for s in (1, -1)]
    steps = near[0] - near[1] - 4 * ((far[0] - near[0]) + (near[1] - far[1])) / 6
    sigma = noise * np.sqrt((1 + 4 / 6) ** 2 + (4 / 6) ** 2)
    per_block = max(len(steps) // 24, 1)
    blocks = steps[:len(steps) // per_block * per_block].reshape(-1, per_block).mean(1)
    error = sigma / np.sqrt(length.sum())
    if len(blocks) < 8:
        return steps.mean() / error
    middle = np.median(blocks)
    scatter = 1.4826 * np.median(np.abs(blocks - middle)) * 1.2533 / np.sqrt(len(blocks))
    return middle / max(error, scatter)


def strokes_found(result):
    """Points of all strokes a thousandth apart; None if there are none."""
    path = result + "/parametric_edges.json"
    if not os.path.exists(path):
        return None
    with open(path) as file:
        found = json.load(file)
    lines = [densify(np.array(e).reshape(2, 3), 0.001) for e in found["lines_end_pts"]]
    t = np.linspace(0, 1, 100)[:, None]
    for c in found["curves_ctl_pts"]:
        c = np.array(c).reshape(4, 3)
        lines.append(densify((1 - t) ** 3 * c[0] + 3 * (1 - t) ** 2 * t * c[1] +
                             3 * (1 - t) * t ** 2 * c[2] + t ** 3 * c[3], 0.001))
    return cKDTree(np.concatenate(lines)) if lines else None


def edges_of(scene, result):
    """Of each true edge: evidence, views that tell, share found, length."""
    with open(scene + "/groundtruth/gt.json") as file:
        edges = [np.array(e["points"]) for e in json.load(file)]
    found, views = strokes_found(result), list(read_views(scene))
    shares = [visible_shares(scene, k, view, edges) for k, view in enumerate(views)]
    for i, points in enumerate(edges):
        samples = densify(points, STEP)
        squares, telling = 0, 0
        for view, seen in zip(views, shares):
            if seen[i] < LEAST_SHARE:
                continue
            step = step_over_error(view, samples)
            squares += step * step - 1
            telling += abs(step) > 5
        share = float((found.query(samples)[0] < CLOSE).mean()) if found else 0.0
        yield max(squares, 0) ** 0.5, telling, share, len(samples) * STEP


def fit_logistic(evidence, share, weight):
    """Evidence at which half and nine tenths are found, Newton's method."""
    x = np.stack([np.log(np.maximum(evidence, 0.5)), np.ones(len(evidence))], 1)
    w = np.zeros(2)
    for _ in range(50):
        p = 1 / (1 + np.exp(-np.clip(x @ w, -30, 30)))
        hessian = (x.T * (weight * p * (1 - p))) @ x + 1e-6 * np.eye(2)
        move = np.linalg.solve(hessian, x.T @ (weight * (share - p)))
        w += np.clip(move, -2, 2)
    return np.exp(-w[1] / w[0]), np.exp((np.log(9) - w[1]) / w[0])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--binary", required=True)
    parser.add_argument("--work", required=True, help="folder of scenes and results")
    parser.add_argument("--detector", default="image")
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--parts", default=",".join(PARTS))
    parser.add_argument("--quick", action="store_true", help="a scene, to see that it runs")
    arguments = parser.parse_args()
    if arguments.quick:
        arguments.parts = "box"
    rows = []
    for even, noise in CONDITIONS[:1 if arguments.quick else None]:
        of_condition = []
        for part in arguments.parts.split(","):
            of_condition += list(edges_of(*make(arguments, part, even, noise)))
        r = np.array(of_condition)
        print(f"even light {even:4}, noise {noise:3}: {len(r):4d} edges, median evidence "
              f"{np.median(r[:, 0]):7.1f}, recall "
              f"{100 * np.average(r[:, 2], weights=r[:, 3]):5.1f}", flush=True)
        rows += of_condition
    r = np.array(rows)
    print(f"\n| evidence | edges | recall, {arguments.detector} |\n|---|---|---|")
    for low, high in zip(BINS, BINS[1:]):
        at = (r[:, 0] >= low) & (r[:, 0] < high)
        if at.any():
            name = f"{low} to {high}" if high < BINS[-1] else f"{low} and more"
            print(f"| {name} | {at.sum()} | {100 * np.average(r[at, 2], weights=r[at, 3]):.0f} |")
    if (r[:, 2] > 0.5).all() or (r[:, 2] <= 0.5).all():
        return  # nothing to tell from the other
    half, most = fit_logistic(r[:, 0], r[:, 2], r[:, 3])
    print(f"\nhalf is found at {half:.1f} standard deviations, nine tenths at {most:.1f}")


if __name__ == "__main__":
    main()
