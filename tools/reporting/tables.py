"""The tables that the page is made of, and what it asks of them."""

import json
import math

from plotting.errors import InputProblem
from plotting.table import read_table

STEPS = [0.01, 0.001, 0.0001]  # [s]
FINEST = 0.00002  # [s]; over 0.2 s
EDGES = [30, 100, 1000]


def options_of(text):
    return dict(item.split("=", 1) for item in text.split(";") if item)


def number(text):
    return float(text) if text else math.nan


class Tables:
    """The rows of the experiments and of the conformance suite, as dictionaries."""

    def __init__(self, results):
        self.closed_forms = self._rows(results / "closed_forms" / "summary.csv",
                                       ["method", "scenario", "dimension", "status", "reason", "relative_error",
                                        "observed_order", "options", "h_s"])
        disc = self._rows(results / "disc_rolling" / "summary.csv",
                          ["method", "sweep", "edges", "h_s", "status", "polygon_loss_1s_J", "method_loss_1s_J",
                           "loss_J", "polygon_loss_J", "until_s", "reason", "options"])
        self.disc = [row for row in disc if row["sweep"] == "engines"]
        curves = self._rows(results / "disc_rolling" / "kinetic_energy.csv",
                            ["method", "sweep", "edges", "h_s", "options", "t_s", "total_J"])
        self.curves = [row for row in curves if row["sweep"] == "engines"]
        self.features = self._rows(results / "engines" / "capabilities.csv",
                                   ["dimension", "method", "feature", "result", "reason", "question"])
        self.versions = self._versions(results / "closed_forms" / "summary.meta.json")

    @staticmethod
    def _rows(path, columns):
        return [row for _, row in read_table(path, columns).require_rows("anything").rows]

    @staticmethod
    def _versions(path):
        try:
            return json.loads(path.read_text(encoding="utf-8"))["engines"]
        except (OSError, ValueError, KeyError) as error:
            raise InputProblem(f"{path}: {error}") from None

    def settings(self, method):
        """{option: value} in force, of the first case in which the method was made; scene options are left out."""
        for row in self.closed_forms:
            if row["method"] == method and row["options"] and row["scenario"] == "free_fall":
                return {k: v for k, v in options_of(row["options"]).items() if k not in ("edges", "disc_as")}
        return {}

    def changed(self, row):
        """{option: value} of a row of the disc in which it differs from the method's settings elsewhere."""
        usual = self.settings(row["method"])
        return {k: v for k, v in options_of(row["options"]).items() if usual.get(k, v) != v}

    def polygon(self, method, edges, h):
        """The row of the sweep over all methods, with the method's usual settings, or None."""
        for row in self.disc:
            same = row["method"] == method and row["edges"] == (str(edges) if edges else "")
            if same and float(row["h_s"]) == h and not self.changed(row):
                return row
        return None

    def energy(self, method, edges, h):
        """{t: total energy [J]} of a case of the sweep over all methods, with the method's usual settings."""
        return {float(row["t_s"]): number(row["total_J"]) for row in self.curves
                if row["method"] == method and row["edges"] == str(edges) and float(row["h_s"]) == h
                and not self.changed(row)}


def of_one_impact(edges):
    """Energy [J] that the polygon has less after rolling over one corner at 6.75 J, with I = m R^2 / 2."""
    kept = (0.5 + math.cos(2 * math.pi / edges)) / 1.5
    return 6.75 * (1 - kept * kept)


def of_a_step(h):
    """Energy [J] that a gap linearised over the step takes in 1 s, KE0 (4/3) g h t / R: the size of a first-order error."""
    return 6.75 * (4 / 3) * 9.81 * h
