#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The Python module: what it takes, gives and refuses. Needs SKETCHSPLAT_BINARY."""
import json
import os
import pathlib
import subprocess
import tempfile
import threading
import time
import unittest

import numpy as np

import sketchsplat


def square_scene(count=10, size=240):
    """Images of a white rectangle, 1 x 0.8, in the plane z = 0; K; cam_from_world."""
    K = np.array([[300, 0, 119.5], [0, 300, 119.5], [0, 0, 1]])
    images, poses = [], []
    for k in range(count):
        a, axis = 0.6, np.array([np.cos(k), np.sin(k), 0])
        W = np.array([[0, 0, axis[1]], [0, 0, -axis[0]], [-axis[1], axis[0], 0]])
        R = np.eye(3) + np.sin(a) * W + (1 - np.cos(a)) * W @ W
        t = np.array([0, 0, 3.0])
        y, x = np.mgrid[:size, :size]
        rays = np.stack([x, y, np.ones_like(x)], -1) @ np.linalg.inv(K).T @ R
        eye = -R.T @ t
        at = eye - (eye[2] / rays[..., 2:]) * rays
        inside = (abs(at[..., 0]) < 0.5) & (abs(at[..., 1]) < 0.4)
        images.append(np.where(inside, 220, 20).astype(np.uint8))
        poses.append(np.c_[R, t])
    return images, K, np.array(poses)


class Module(unittest.TestCase):
    def test_a_rectangle_is_four_lines_with_their_evidence(self):
        images, K, poses = square_scene()
        sketch = sketchsplat.reconstruct(images, K, poses)
        self.assertEqual(sketch.ending, "done")
        self.assertEqual([c.kind for c in sketch.curves], ["line"] * 4)
        lengths = sorted(c.length for c in sketch.curves)
        np.testing.assert_allclose(lengths, [0.8, 0.8, 1, 1], atol=0.02)
        self.assertEqual(sketch.nodes.shape, (4, 3))
        c = sketch.curves[0]
        np.testing.assert_array_equal(c.controls, sketch.nodes[[c.begin, c.end]])
        self.assertGreater(len(c.views), 5)
        self.assertEqual(c.covariance.shape, (6, 6))
        self.assertLessEqual(np.diff(sketch.sample(0, 0.1)[:, 0]).max(), 0.1)

    def test_colour_alpha_and_strides_make_no_difference(self):
        images, K, poses = square_scene()
        a = sketchsplat.reconstruct(images, K, poses, preset="fast", threads=1)
        wide = [np.repeat(i[..., None], 6, axis=2)[..., ::2] for i in images]  # not contiguous
        b = sketchsplat.reconstruct(wide, np.stack([K] * 10), poses, preset="fast", threads=2)
        np.testing.assert_allclose(a.nodes, b.nodes, atol=1e-5)

    def test_edges_of_others_become_curves(self):
        _, K, poses = square_scene()
        angle = np.linspace(0, 2 * np.pi, 400)
        circle = 0.4 * np.stack([np.cos(angle), np.sin(angle), 0 * angle], 1)
        edges = []
        for P in poses:
            p = (circle @ P[:, :3].T + P[:, 3]) @ K.T
            edges.append([p[:, :2] / p[:, 2:]])
        sketch = sketchsplat.reconstruct_edges(edges, (240, 240), K, poses)
        self.assertEqual([c.kind for c in sketch.curves], ["circle"])
        self.assertAlmostEqual(sketch.curves[0].radius, 0.4, delta=0.004)

    def test_files_are_written_and_read(self):
        images, K, poses = square_scene()
        sketch = sketchsplat.reconstruct(images, K, poses)
        with tempfile.TemporaryDirectory() as folder:
            for ending in ("step", "dxf", "obj", "ply", "json"):
                path = pathlib.Path(folder) / ("part." + ending)
                sketch.write(str(path))
                self.assertGreater(path.stat().st_size, 100, ending)
            again = sketchsplat.read(folder + "/part.json")
            np.testing.assert_array_equal(again.nodes, sketch.nodes)
            with self.assertRaises(ValueError):
                sketch.write(folder + "/part.xyz")
            with self.assertRaises(RuntimeError):
                sketch.write(folder + "/none/part.step")

    def test_a_folder_is_reconstructed_and_evaluated(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([os.environ["SKETCHSPLAT_BINARY"], "synthesize", "box", "--views", "12",
                            "--resolution", "200", "--outputs", "none", "--quiet", "--out", folder],
                           check=True, stdout=subprocess.DEVNULL)
            sketch = sketchsplat.reconstruct_folder(folder, preset="fast")
            self.assertGreater(sketchsplat.evaluate(sketch, folder)["F5"], 90)
            self.assertEqual(sketch.solid.faces, {"plane": 6})
            self.assertGreater(sketch.solid.volume, 0.1)
            sketch.solid.write(folder + "/part_solid.step", scale=10, unit="cm")
            with open(folder + "/part_solid.step", encoding="utf-8") as file:
                self.assertIn("MANIFOLD_SOLID_BREP('part_solid'", file.read())
            with self.assertRaises(ValueError):
                sketch.solid.write(folder + "/part_solid.obj")
            alone = sketchsplat.reconstruct_folder(folder, preset="fast", expert={"solid": "off"})
            self.assertIsNone(alone.solid)
            with self.assertRaises(ValueError):
                sketchsplat.evaluate(sketch, folder, "best")
        with self.assertRaises(RuntimeError):
            sketchsplat.reconstruct_folder(folder)  # gone

    def test_progress_may_cancel(self):
        images, K, poses = square_scene()
        stages = []

        def enough(stage, done, total):
            stages.append(stage)
            return stage != "lift"

        sketch = sketchsplat.reconstruct(images, K, poses, progress=enough)
        self.assertEqual((sketch.ending, len(sketch)), ("cancelled", 0))
        self.assertEqual(stages[0], "detect")
        self.assertEqual(stages[-1], "lift")

    def test_other_threads_run_meanwhile(self):
        images, K, poses = square_scene()
        work = threading.Thread(target=sketchsplat.reconstruct, args=(images, K, poses))
        work.start()
        ticks = 0
        while work.is_alive():
            time.sleep(0.001)
            ticks += 1
        self.assertGreater(ticks, 3)

    def test_too_little_is_no_error_and_wrong_use_is(self):
        images, K, poses = square_scene()
        nothing = sketchsplat.reconstruct([0 * i for i in images], K, poses)
        self.assertEqual(nothing.ending, "too little")
        self.assertIn("expected", nothing.message)
        for wrong in (dict(preset="best"), dict(expert={"no_such": 1}), dict(detector="maps:X"),
                      dict(expert={"rounds": "many"}), dict(masks=[images[0][:5]] * 10)):
            with self.assertRaises(ValueError, msg=str(wrong)):
                sketchsplat.reconstruct(images, K, poses, **wrong)
        with self.assertRaises(ValueError):
            sketchsplat.reconstruct(images, K, 2 * poses)
        with self.assertRaises(ValueError):
            sketchsplat.reconstruct(images, K[:2], poses)
        with self.assertRaises(TypeError):
            sketchsplat.reconstruct([i / 255 for i in images], K, poses)


if __name__ == "__main__":
    unittest.main()
