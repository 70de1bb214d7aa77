"""The scripts of the root explain themselves and refuse unknown arguments, before they install or build anything."""

import os
import subprocess
import unittest

import source_tree


def run(*command):
    return subprocess.run(command, cwd=source_tree.ROOT, universal_newlines=True, timeout=60,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)


class ShellScriptsTest(unittest.TestCase):
    def test_help(self):
        for script in ("./demo.sh", "./test.sh", "./run.sh"):
            answer = run(script, "--help")
            self.assertEqual(answer.returncode, 0, answer.stderr)
            self.assertIn("usage: " + script, answer.stdout)

    def test_unknown_arguments_are_named(self):
        for script in ("./demo.sh", "./test.sh"):
            answer = run(script, "--no-such-option")
            self.assertNotEqual(answer.returncode, 0)
            self.assertIn("--no-such-option", answer.stderr)

    def test_syntax(self):
        for script in ("demo.sh", "test.sh", "run.sh", "tools/environment.sh", ".ci/run"):
            self.assertEqual(run("bash", "-n", script).returncode, 0, script)
            self.assertTrue(script.startswith("tools/") or os.access(os.path.join(source_tree.ROOT, script), os.X_OK))


if __name__ == "__main__":
    unittest.main()
