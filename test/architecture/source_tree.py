"""What the tests of this folder ask of the source tree."""

import os
import re

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
ABOVE_LIBRARIES = ["ros_bridge", "nodes", "rviz_plugin", "cli"]


def library_order():
    """Our libraries, lowest layer first, as cmake/targets.cmake lists them."""
    with open(os.path.join(ROOT, "cmake", "targets.cmake")) as text:
        match = re.search(r"set\(OBJECT_MODELLING_LIBRARIES\s+([^)]*)\)", text.read())
    return match.group(1).split()


def cpp_files(*folders):
    """Paths of the C++ sources and headers below these folders of the root."""
    for folder in folders:
        for parent, _, names in os.walk(os.path.join(ROOT, folder)):
            for name in names:
                if name.endswith((".h", ".cpp")):
                    yield os.path.join(parent, name)


def includes(path):
    """Paths between the quotes or brackets of a file's #include lines."""
    with open(path) as text:
        return re.findall(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', text.read(), re.MULTILINE)


def library_of(path):
    """Which library a source or header of ours belongs to."""
    parts = os.path.relpath(path, ROOT).split(os.sep)
    return parts[2] if parts[0] == "include" else parts[1]
