"""Every script explains itself, and refuses what it does not know with exit code 2 and the value it got."""

import subprocess
import unittest
from pathlib import Path

TOOLS = Path(__file__).resolve().parents[1]


def run(script, *arguments):
    return subprocess.run([TOOLS / script, *arguments], capture_output=True, text=True, check=False,
                          stdin=subprocess.DEVNULL, cwd="/")


class CommandLines(unittest.TestCase):
    def test_help(self):
        for script in ("setup", "test", "reproduce", "plot", "report_engines", "check_equation_tags"):
            done = run(script, "--help")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("Exit codes", done.stdout)

    def test_bad_usage_names_the_value(self):
        for script, *arguments in (["setup", "--frob"], ["test", "--frob"], ["reproduce", "--frob"], ["plot", "--frob"],
                                   ["report_engines", "--frob"], ["report_engines", "--results", "/frob"],
                                   ["test", "--only", "frob"], ["plot", "frob"],
                                   ["test", "--jobs", "frob"], ["reproduce", "--jobs", "frob"]):
            done = run(script, *arguments)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertIn("frob", done.stderr)

    def test_missing_value(self):
        for script, argument in (("test", "--only"), ("reproduce", "--out")):
            done = run(script, argument)
            self.assertEqual(done.returncode, 2)
            self.assertIn(argument, done.stderr)

    def test_unwritable_output(self):
        done = run("reproduce", "--out", "/dev/null/results")
        self.assertEqual(done.returncode, 3)
        self.assertIn("/dev/null/results", done.stderr)


if __name__ == "__main__":
    unittest.main()
