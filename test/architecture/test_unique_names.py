"""Names in anonymous namespaces are unique in a folder: its files are compiled in batches, where two of them would meet."""

import collections
import os
import re
import unittest

import source_tree

CONSTANT = re.compile(r"^(?:inline |static )?(?:constexpr|const) [^;={(]*?(\w+)(?:\[\])? ?(?:=|\{)", re.MULTILINE)
TYPE = re.compile(r"^(?:struct|class|enum class) (\w+)", re.MULTILINE)
FUNCTION = re.compile(
    r"^(?!struct|class|return|using|constexpr|const \w+ [A-Z_]+ =)(?:\[\[\w+\]\] )?[\w:<>,\*& ]+? \*?&?(\w+)\(([^;{]*?)\)"
    r"(?: const)?\n\{", re.MULTILINE)


def types_of(parameters):
    """Types of a parameter list, without the names."""
    return re.sub(r"\s+", " ", ",".join(re.sub(r"\s\w+$", "", part.strip()) for part in parameters.split(",")))


def names_in(text):
    """Constants, types, and functions with their parameters' types, of a source's anonymous namespaces."""
    for block in re.findall(r"\nnamespace\s*\{(.*?)\n\}  // namespace\n", text, re.DOTALL):
        yield from CONSTANT.findall(block)
        yield from TYPE.findall(block)
        for name, parameters in FUNCTION.findall(block):
            yield f"{name}({types_of(parameters)})"


class UniqueNamesTest(unittest.TestCase):
    def test_names_are_unique_in_their_folder(self):
        found = collections.defaultdict(set)
        for path in source_tree.cpp_files("src"):
            if path.endswith(".cpp"):
                with open(path) as text:
                    for name in names_in(text.read()):
                        found[os.path.dirname(path), name].add(os.path.basename(path))
        self.assertGreater(len(found), 500, "the scan found next to no names: is it looking in the right place?")
        twice = {key: files for key, files in found.items() if len(files) > 1}
        self.assertEqual(twice, {}, "rename one of each, or share it")

    def test_a_name_that_is_there_twice_is_found(self):
        text = "\nnamespace\n{\nconstexpr int LEVELS = 3;\nstruct Cell\n{\n};\nint sum(int a, const B& b)\n{\n}\n}  // namespace\n"
        self.assertEqual(sorted(names_in(text)), ["Cell", "LEVELS", "sum(int,const B&)"])


if __name__ == "__main__":
    unittest.main()
