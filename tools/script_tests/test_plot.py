"""tools/plot on small tables of its own: the same bytes every time, and messages that name what is wrong."""

import contextlib
import csv
import io
import math
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
from pathlib import Path

TOOLS = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOOLS))

FIGURES = [f"{name}.{suffix}" for name in ("figure_1a", "figure_1b", "loss", "engines", "engines_energy") for suffix in ("svg", "png")]
HEADER = ["sweep", "method", "options", "edges", "candidates", "h_s", "t_s", "kinetic_J", "total_J"]


def rows_of_cases():
    """Decaying energies for a handful of cases of every method that the figures show."""
    places = [("edges", edges, 0.01) for edges in (10, 100, 1000)] + [("step_size", 1000, h) for h in (0.05, 0.001)]
    places.append(("engines", 1000, 0.01))
    for sweep, edges, h in places:
        for method, policy in (("stewart_trinkle", "all"), ("stewart_trinkle", "reachable"), ("exact_polygon", ""),
                               ("edge_limited", ""), ("step_limited", ""), ("implicit_ncp", "")):
            smooth = method == "implicit_ncp"
            rate = 0.0 if smooth else 3 * h + 5 / edges
            for t in (0.0, 0.5, 1.0, 2.0):
                energy = 6.75 * math.exp(-rate * t)
                yield [sweep, method, "", "" if smooth else edges, policy, h, t, energy, energy + 9.81]


SUMMARY_HEADER = ["sweep", "method", "options", "edges", "h_s", "status", "method_loss_1s_J", "loss_J",
                  "relative_energy_loss"]


def rows_of_summary():
    """Losses beyond the exact motion, of both signs, 0, and none where the method has no polygons."""
    for method, loss in (("implicit_ncp", 0.0), ("box2d", -0.1), ("mujoco_elliptic_stiff", 0.2)):
        for edges in ("", 30, 100, 1000):
            for h in (0.01, 0.001, 0.0001):
                ran = method != "implicit_ncp" or edges == ""
                yield ["engines", method, "dampratio=5" if h == 0.001 else "", edges, h, "ok" if ran else "unsupported",
                       h * loss if ran else "", 1.35 if ran else "", 0.2 if ran else ""]


class Plot(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.results = Path(scratch.name)
        self.directory = self.results / "disc_rolling"
        self.directory.mkdir()
        self.table = self.directory / "kinetic_energy.csv"
        with self.table.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(HEADER)
            writer.writerows(rows_of_cases())
        with (self.directory / "summary.csv").open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(SUMMARY_HEADER)
            writer.writerows(rows_of_summary())

    def plot(self):
        return subprocess.run([TOOLS / "plot", "--results", self.results, "disc_rolling"], capture_output=True,
                              text=True, check=False)

    def assert_refused(self, code, *fragments):
        done = self.plot()
        self.assertEqual(done.returncode, code, done.stderr)
        for fragment in fragments:
            self.assertIn(fragment, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, "one message")
        self.assertEqual(list(self.directory.glob("*.tmp")), [])

    def edit(self, old, new):
        text = self.table.read_text(encoding="utf-8")
        self.assertIn(old, text)
        self.table.write_text(text.replace(old, new, 1), encoding="utf-8")

    def figures(self):
        return {name: (self.directory / name).read_bytes() for name in FIGURES}

    def test_same_bytes_every_time(self):
        self.assertEqual(self.plot().returncode, 0)
        first = self.figures()
        self.assertEqual(self.plot().returncode, 0)
        self.assertEqual(self.figures(), first)
        for name, content in first.items():
            self.assertNotIn(b"Matplotlib v", content, name)
            self.assertNotIn(b"<dc:date>", content, name)

    def test_leaves_no_figure_open(self):
        from plotting import cli, style

        open_before = []

        def figure(_directory):
            open_before.append(len(style.plt.get_fignums()))
            return style.plt.figure()

        table = {"some": {"first": figure, "second": figure}}
        with unittest.mock.patch.object(cli, "EXPERIMENTS", table), contextlib.redirect_stdout(io.StringIO()):
            cli.draw("some", self.directory)
        self.assertEqual(open_before, [0, 0])
        self.assertEqual(style.plt.get_fignums(), [])

    def test_missing_file(self):
        self.table.unlink()
        self.assert_refused(2, "kinetic_energy.csv", "no such file")

    def test_missing_column(self):
        self.edit("kinetic_J", "kinetic_energy")
        self.assert_refused(2, "kinetic_energy.csv", "no column kinetic_J")

    def test_bad_number_is_named_with_its_line(self):
        self.edit("0.5,", "half,")
        self.assert_refused(2, "kinetic_energy.csv:3: t_s", "'half'")

    def test_missing_method(self):
        self.table.write_text(self.table.read_text(encoding="utf-8").replace("implicit_ncp", "other"), encoding="utf-8")
        self.assert_refused(2, "kinetic_energy.csv", "no rows of method implicit_ncp")

    def test_short_row(self):
        self.edit("reachable,", "")
        self.assert_refused(2, "kinetic_energy.csv:", "cells")

    def test_unwritable_figure_leaves_earlier_ones(self):
        (self.directory / "figure_1a.svg").mkdir()
        self.assert_refused(3, "figure_1a.svg", "cannot be written")


class ClosedForms(unittest.TestCase):
    def test_errors_are_short_and_rounding_is_zero(self):
        from plotting.closed_forms import short

        self.assertEqual([short(x) for x in (3.4e-4, 9.7e-3, 0.12, 1.0, 2e-15)], ["3e-4", "1e-2", "1e-1", "1e0", "0"])

    def test_same_bytes_whatever_became_of_a_case(self):
        header = ["scenario", "method", "dimension", "h_s", "status", "observed_order", "relative_error"]
        rows = [["drop", "implicit_ncp", d, 0.01, "ok", 1.0, 0.005] for d in (2, 3)]
        rows += [["bounce", "implicit_ncp", d, 0.01, "unsupported", "", ""] for d in (2, 3)]
        rows += [["drop", "box2d", 2, 0.01, "failed", "", ""], ["bounce", "box2d", 2, 0.01, "ok", "", 0.0]]
        with tempfile.TemporaryDirectory() as folder:
            directory = Path(folder) / "closed_forms"
            directory.mkdir()
            with (directory / "summary.csv").open("w", newline="", encoding="utf-8") as file:
                csv.writer(file, lineterminator="\n").writerows([header, *rows])
            drawn = []
            for _ in range(2):
                done = subprocess.run([TOOLS / "plot", "--results", folder, "closed_forms"], capture_output=True, check=False)
                self.assertEqual(done.returncode, 0, done.stderr)
                drawn.append([(directory / f"{name}.png").read_bytes() for name in ("error", "order")])
            self.assertEqual(drawn[0], drawn[1])


class Spread(unittest.TestCase):
    def test_labels_do_not_overlap_and_keep_their_order(self):
        from plotting.style import spread

        for positions in ([0.5], [0.1, 0.1, 0.1], [0.9, 0.91, 0.2, 0.0, 1.0], [0.0] * 8 + [1.0] * 4):
            placed = spread(positions, 0.06, 0.0, 1.0)
            by_position = sorted(range(len(positions)), key=lambda i: positions[i])
            ordered = [placed[i] for i in by_position]
            for below, above in zip(ordered, ordered[1:]):
                self.assertGreaterEqual(above - below, 0.06 - 1e-12)
            self.assertGreaterEqual(ordered[0], -1e-12)
            self.assertLessEqual(ordered[-1], 1 + 1e-12)

    def test_labels_with_room_stay(self):
        from plotting.style import spread

        self.assertEqual(spread([0.8, 0.2], 0.06, 0.0, 1.0), [0.8, 0.2])


if __name__ == "__main__":
    unittest.main()
