import contextlib
import io
import os
import unittest

from object_modelling import demo

HERE = os.path.dirname(os.path.abspath(__file__))


class DemoArgumentsTest(unittest.TestCase):
    def exit_code(self, *arguments):
        with contextlib.redirect_stderr(io.StringIO()), contextlib.redirect_stdout(io.StringIO()) as out:
            with self.assertRaises(SystemExit) as caught:
                demo.parse(arguments)
        self.out = out.getvalue()
        return caught.exception.code

    def test_defaults(self):
        options = demo.parse([HERE])
        self.assertIsNone(options.rate, "lossless")
        self.assertEqual(options.object_id, "demo_object")

    def test_wrong_usage(self):
        self.assertEqual(self.exit_code(), demo.EXIT_USAGE)
        self.assertEqual(self.exit_code("/does/not/exist"), demo.EXIT_USAGE)
        self.assertEqual(self.exit_code(HERE, "--timeout", "0"), demo.EXIT_USAGE)
        self.assertEqual(self.exit_code(HERE, "--rate", "-1"), demo.EXIT_USAGE)

    def test_help_teaches_the_exit_codes(self):
        self.assertEqual(self.exit_code("--help"), 0)
        self.assertIn("--timeout has passed", self.out)


if __name__ == "__main__":
    unittest.main()
