"""tools/packages.txt and package.xml ask for the same things."""

import os
import re
import subprocess
import unittest
import xml.etree.ElementTree as ElementTree

import source_tree

# Brought by others of the list, or by ROS itself.
IMPLIED = {"message_runtime"}


def listed_packages():
    """(Debian package, rosdep key or '-', where it counts if not everywhere) per row of the list."""
    with open(os.path.join(source_tree.ROOT, "tools", "packages.txt")) as lines:
        return [tuple(line.split()) for line in lines if line.strip() and not line.startswith("#")]


def wanted(*release_and_ros):
    answer = subprocess.run(["bash", "-c", '. tools/environment.sh && wanted_packages "$@"', "-", *release_and_ros],
                            cwd=source_tree.ROOT, universal_newlines=True, timeout=60, check=True, stdout=subprocess.PIPE)
    return set(answer.stdout.split())


def package_xml_keys():
    root = ElementTree.parse(os.path.join(source_tree.ROOT, "package.xml")).getroot()
    return {element.text for element in root if element.tag.endswith("depend")} - IMPLIED


class PackagesTest(unittest.TestCase):
    def test_rows_are_well_formed_and_unique(self):
        rows = listed_packages()
        self.assertTrue(all(len(row) == 2 or re.match(r"^(ros|-[a-z,]+)$", row[2]) for row in rows))
        names = [row[0] for row in rows]
        self.assertEqual(sorted(set(names)), sorted(names))

    def test_both_lists_name_the_same_keys(self):
        listed = {row[1] for row in listed_packages()} - {"-"}
        self.assertEqual(listed, package_xml_keys())

    def test_a_release_gets_the_packages_that_it_has(self):
        self.assertEqual(wanted("bookworm"), {row[0] for row in listed_packages()})
        self.assertEqual(wanted("bookworm") - wanted("bullseye"), {"libcli11-dev", "libopenmesh-dev"})

    def test_ros_of_opt_has_its_own_names(self):
        names = wanted("focal", "noetic")
        self.assertLessEqual({"ros-noetic-cv-bridge", "ros-noetic-rviz", "libpcl-dev"}, names)
        self.assertFalse(names & {"libcv-bridge-dev", "python3-cv-bridge", "rviz", "libcli11-dev", "chromium"})

    def test_cmake_finds_only_listed_catkin_packages(self):
        with open(os.path.join(source_tree.ROOT, "CMakeLists.txt")) as text:
            match = re.search(r"find_package\(catkin REQUIRED COMPONENTS\s+([^)]*)\)", text.read())
        self.assertLessEqual(set(match.group(1).split()), package_xml_keys())


if __name__ == "__main__":
    unittest.main()
