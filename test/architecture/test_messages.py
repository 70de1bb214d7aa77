"""Every message, service and action is complete: listed for generation, commented, with a Status first in answers."""

import glob
import os
import re
import unittest

import source_tree


def definitions(kind):
    return sorted(glob.glob(os.path.join(source_tree.ROOT, kind, "*." + kind)))


def fields(text):
    """(type, name, comment) per field; constants left out."""
    for line in text.splitlines():
        code, _, comment = line.partition("#")
        words = code.split()
        if len(words) == 2 and "=" not in code:
            yield words[0], words[1], comment.strip()


class MessagesTest(unittest.TestCase):
    def test_all_are_generated(self):
        with open(os.path.join(source_tree.ROOT, "cmake", "messages.cmake")) as text:
            listed = set(re.findall(r"\b(\w+\.(?:msg|srv|action))\b", text.read()))
        present = {os.path.basename(path) for kind in ("msg", "srv", "action") for path in definitions(kind)}
        self.assertEqual(listed, present)
        self.assertGreater(len(present), 20)

    def test_answers_begin_with_status(self):
        for path in definitions("srv") + definitions("action"):
            with open(path) as text:
                answer = text.read().split("---")[1]
            first = next(fields(answer), None)
            self.assertIsNotNone(first, f"{path}: empty answer")
            self.assertTrue(first[0].endswith("Status") and first[1] == "status", f"{path} answers {first[:2]} first")

    def test_field_names_are_lower_case_and_numbers_have_units_or_comments(self):
        for path in definitions("msg") + definitions("srv") + definitions("action"):
            with open(path) as text:
                content = text.read()
            for kind, name, comment in fields(content):
                self.assertRegex(name, r"^[a-z][a-z0-9_]*$", path)
                if kind.startswith("float"):
                    has_unit = re.search(r"_(m|s|rad|hz|px|ratio|mm|deg|sigmas|m_per_s|rad_per_s|ms)$", name)
                    self.assertTrue(has_unit or comment, f"{path}: {name} has neither a unit in its name nor a comment")


if __name__ == "__main__":
    unittest.main()
