"""tools/check_equation_tags on a small repository: the sound map passes, and each way to dangle is found."""

import subprocess
import tempfile
import unittest
from pathlib import Path

TOOL = Path(__file__).resolve().parents[1] / "check_equation_tags"

SOUND = {
    "core/README.md": "# Map\n\n| equation | function | test |\n|---|---|---|\n"
                      "| 9 | `core/gap.h:signed_gap` | `tests/gap_test.cpp:Gap.IsSigned` |\n"
                      "| Eqs. 10-11 | `core/step.cpp:Step::evaluate` | `tests/gap_test.cpp:Step.Solves` |\n",
    "core/gap.h": "/// Eq. 9 in signed-gap form.\ndouble signed_gap();\n",
    "core/step.cpp": "// Eqs. 10-11\nvoid Step::evaluate() {}\n",
    "tests/gap_test.cpp": "TEST(Gap, IsSigned) {}\nTEST_F(Step,\n       Solves) {}\n",
}


class EquationTags(unittest.TestCase):
    def run_with(self, changes):
        """Exit code and output for the sound repository with files replaced; None removes one."""
        with tempfile.TemporaryDirectory() as root:
            for name, text in {**SOUND, **changes}.items():
                if text is not None:
                    path = Path(root) / name
                    path.parent.mkdir(parents=True, exist_ok=True)
                    path.write_text(text, encoding="utf-8")
            done = subprocess.run([TOOL, "--root", root], capture_output=True, text=True, check=False)
            return done.returncode, done.stdout + done.stderr

    def assert_found(self, message, changes):
        code, output = self.run_with(changes)
        self.assertEqual(code, 1, output)
        self.assertIn(message, output)

    def test_sound_map_passes(self):
        code, output = self.run_with({})
        self.assertEqual(code, 0, output)

    def test_missing_symbol(self):
        self.assert_found("core/gap.h has no signed_gap", {"core/gap.h": "// Eq. 9\ndouble gap();\n"})

    def test_symbol_in_a_comment_only(self):
        self.assert_found("core/gap.h has no signed_gap", {"core/gap.h": "// Eq. 9: signed_gap\ndouble gap();\n"})

    def test_missing_file(self):
        self.assert_found("no file core/gap.h", {"core/gap.h": None})

    def test_function_that_does_not_cite_its_equation(self):
        self.assert_found("does not cite Eq. 9", {"core/gap.h": "double signed_gap();\n"})

    def test_missing_test(self):
        self.assert_found("has no test Gap.IsSigned",
                          {"tests/gap_test.cpp": "// TEST(Gap, IsSigned)\nTEST_F(Step, Solves) {}\n"})

    def test_cited_equation_without_a_row(self):
        self.assert_found("core/law.h cites Eq. 5", {"core/law.h": "// Eq. 5\n"})

    def test_no_map(self):
        for text in (None, "# Map\n"):
            code, output = self.run_with({"core/README.md": text})
            self.assertEqual(code, 2, output)


if __name__ == "__main__":
    unittest.main()
