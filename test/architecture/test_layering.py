"""Includes go one way: each library sees only those below it, and no ROS below ros_bridge."""

import os
import re
import unittest

import source_tree

ROS_HEADERS = ("ros/", "tf2", "sensor_msgs/", "geometry_msgs/", "std_msgs/", "nav_msgs/", "visualization_msgs/",
               "actionlib", "cv_bridge/", "rosbag/", "pcl_conversions/", "message_filters/", "interactive_markers/")

# Per pixel or per patch, or kept and solved again: a call and a matrix on the heap would cost more than the compiler.
DECOMPOSING_FILES = {"src/" + path for path in (
    "geometry/linear_systems.cpp", "geometry/transform.cpp", "bundle_adjustment/pose_covariance.cpp",
    "calibration/wall_view.cpp", "fusion/surfel_fit.cpp", "recognition/verification.cpp",
    "segmentation/plane_moments.cpp")}


class LayeringTest(unittest.TestCase):
    def test_every_library_folder_is_in_the_list(self):
        known = set(source_tree.library_order()) | set(source_tree.ABOVE_LIBRARIES)
        headers = set(os.listdir(os.path.join(source_tree.ROOT, "include", "object_modelling")))
        self.assertLessEqual(headers, known)

    def test_libraries_include_only_lower_ones(self):
        order = source_tree.library_order()
        seen = 0
        for path in source_tree.cpp_files("include", "src"):
            library = source_tree.library_of(path)
            if library not in order:
                continue
            for include in source_tree.includes(path):
                parts = include.split("/")
                if parts[0] != "object_modelling" or len(parts) < 3:
                    continue
                seen += 1
                self.assertIn(parts[1], order, f"{path} includes {include}, which is above the libraries")
                self.assertLessEqual(order.index(parts[1]), order.index(library),
                                     f"{path} includes {include}: {parts[1]} is above {library}")
        self.assertGreater(seen, 50, "the scan found next to no includes: is it looking in the right place?")

    def test_what_consumes_models_needs_neither_tracker_nor_alignment(self):
        order = source_tree.library_order()
        used = {library: set() for library in order}
        for path in source_tree.cpp_files("include", "src"):
            library = source_tree.library_of(path)
            for include in source_tree.includes(path) if library in order else ():
                parts = include.split("/")
                if parts[0] == "object_modelling" and len(parts) == 3:
                    used[library].add(parts[1])
        for foundation in ("mesh", "features", "registration", "database"):
            reached, front = set(), {foundation}
            while front:
                reached |= front
                front = set().union(*(used[library] for library in front)) - reached
            self.assertFalse(reached & {"tracking", "alignment", "pipeline"}, f"{foundation} reaches {sorted(reached)}")

    def test_no_ros_in_the_libraries(self):
        order = source_tree.library_order()
        for path in source_tree.cpp_files("include", "src"):
            if source_tree.library_of(path) not in order:
                continue
            for include in source_tree.includes(path):
                self.assertFalse(include.startswith(ROS_HEADERS), f"{path} includes {include}")
                generated = include.startswith("object_modelling/") and include.count("/") == 1
                self.assertFalse(generated, f"{path} includes the message {include}")
            with open(path) as text:
                self.assertNotRegex(text.read(), r"\bros::", f"{path} uses roscpp")

    def test_readme_names_the_layers_in_order(self):
        with open(os.path.join(source_tree.ROOT, "docs", "architecture.md")) as text:
            rows = [line.split("`")[1] for line in text if line.startswith("| `")]
        order = source_tree.library_order()
        self.assertEqual([row for row in rows if row in order], order)


class LibraryHabitsTest(unittest.TestCase):
    def test_no_exit_and_no_streams_in_libraries(self):
        order = source_tree.library_order()
        for path in source_tree.cpp_files("include", "src"):
            if source_tree.library_of(path) not in order:
                continue
            with open(path) as text:
                source = text.read()
            for banned in (r"\bexit\s*\(", r"\babort\s*\(", r"std::cout", r"std::cerr", r"\bsystem\s*\("):
                self.assertNotRegex(source, banned, f"{path}")

    def test_decompositions_are_compiled_once(self):
        """geometry/linear_systems and rotationBetween have them: Eigen's templates cost each file seconds."""
        costly = re.compile(r"\.(ldlt|llt|jacobiSvd|bdcSvd|colPivHouseholderQr|householderQr|fullPivLu|partialPivLu)\(|"
                            r"FromTwoVectors|Hyperplane<[^;]*::Through|\b(SelfAdjoint)?EigenSolver<|"
                            r"(JacobiSVD|[^l]LDLT|[^l]LLT)<")
        users = set()
        for path in source_tree.cpp_files("include", "src"):
            with open(path) as text:
                if costly.search(text.read()):
                    users.add(os.path.relpath(path, source_tree.ROOT))
        self.assertLessEqual(users, DECOMPOSING_FILES)
        self.assertLessEqual(DECOMPOSING_FILES, users, "no longer needed in the list")

    def test_files_stay_small(self):
        too_long = {}
        for path in source_tree.cpp_files("include", "src", "test"):
            with open(path) as text:
                lines = sum(1 for _ in text)
            if lines > 400:
                too_long[os.path.relpath(path, source_tree.ROOT)] = lines
        self.assertEqual(too_long, {})

    def test_functions_stay_short(self):
        """60 lines between the braces of a definition; clang-format puts those of a function at the line's start."""
        too_long = {}
        for path in source_tree.cpp_files("include", "src"):
            with open(path) as text:
                lines = text.read().split("\n")
            begin = None
            for number, line in enumerate(lines):
                if line == "{":
                    head = " ".join(lines[max(0, number - 3):number])
                    is_function = lines[number - 1].endswith((")", "const", "noexcept", "override")) or " : " in head
                    begin = number if is_function and not lines[number - 1].startswith(("class ", "struct ")) else None
                if line == "}" and begin is not None:
                    if number - begin - 1 > 60:
                        too_long[f"{os.path.relpath(path, source_tree.ROOT)}:{begin}"] = number - begin - 1
                    begin = None
        self.assertEqual(too_long, {})


if __name__ == "__main__":
    unittest.main()
