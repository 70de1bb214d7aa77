"""tools/packages.txt and package.xml ask for the same things."""

import os
import re
import unittest
import xml.etree.ElementTree as ElementTree

import source_tree

# Brought by others of the list, or by ROS itself.
IMPLIED = {"message_runtime"}


def listed_packages():
    """(Debian package, rosdep key or '-') per row of the list."""
    with open(os.path.join(source_tree.ROOT, "tools", "packages.txt")) as lines:
        return [tuple(line.split()) for line in lines if line.strip() and not line.startswith("#")]


def package_xml_keys():
    root = ElementTree.parse(os.path.join(source_tree.ROOT, "package.xml")).getroot()
    return {element.text for element in root if element.tag.endswith("depend")} - IMPLIED


class PackagesTest(unittest.TestCase):
    def test_rows_are_well_formed_and_unique(self):
        rows = listed_packages()
        self.assertTrue(all(len(row) == 2 for row in rows))
        names = [row[0] for row in rows]
        self.assertEqual(sorted(set(names)), sorted(names))

    def test_both_lists_name_the_same_keys(self):
        listed = {key for _, key in listed_packages()} - {"-"}
        self.assertEqual(listed, package_xml_keys())

    def test_cmake_finds_only_listed_catkin_packages(self):
        with open(os.path.join(source_tree.ROOT, "CMakeLists.txt")) as text:
            match = re.search(r"find_package\(catkin REQUIRED COMPONENTS\s+([^)]*)\)", text.read())
        self.assertLessEqual(set(match.group(1).split()), package_xml_keys())


if __name__ == "__main__":
    unittest.main()
