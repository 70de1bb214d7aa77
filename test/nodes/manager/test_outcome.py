import unittest

from object_modelling.msg import Status
from object_modelling.outcome import Code


class CodesTest(unittest.TestCase):
    def test_numbers_of_the_message(self):
        for code in Code:
            self.assertEqual(getattr(Status, code.name), code)


if __name__ == "__main__":
    unittest.main()
