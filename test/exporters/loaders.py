"""Programs of others that read what was exported; a test is skipped where one is missing."""
import os
import shutil
import subprocess
import tempfile
import unittest

import numpy as np


def run(program, *arguments):
    """stdout of one that must succeed."""
    if shutil.which(program) is None:
        raise unittest.SkipTest("the program %s is not installed" % program)
    finished = subprocess.run([program, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              universal_newlines=True, timeout=120)
    if finished.returncode != 0:
        raise AssertionError("%s: %s%s" % (program, finished.stdout, finished.stderr))
    return finished.stdout


class Loaded:
    """A mesh as Assimp reads it, in the file's root frame. corners: triangles x 3 x (vertex, texture coordinate)."""

    def __init__(self, path):
        with tempfile.TemporaryDirectory() as folder:
            text_path = os.path.join(folder, "mesh.obj")
            run("assimp", "export", path, text_path)
            with open(text_path) as text:
                lines = [line.split() for line in text if line.strip()]
        points = np.array([line[1:] for line in lines if line[0] == "v"], float)
        self.vertices, self.colours = points[:, :3], points[:, 3:]
        self.uv = np.array([line[1:3] for line in lines if line[0] == "vt"], float)
        faces = [[(corner.split("/") + [""])[:2] for corner in line[1:]] for line in lines if line[0] == "f"]
        self.corners = np.array([[[int(index or 0) - 1 for index in corner] for corner in face] for face in faces])

    def extents(self):
        return np.ptp(self.vertices, axis=0)

    def volume(self):
        a, b, c = (self.vertices[self.corners[:, i, 0]] for i in range(3))
        return np.einsum("ij,ij->", a, np.cross(b, c)) / 6
