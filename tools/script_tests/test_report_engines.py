"""tools/report_engines: the page is the tables' and the notes', and refuses what does not agree."""

import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
TOOLS = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOOLS))

from plotting.errors import InputProblem  # noqa: E402
from reporting import page, polygons, timing  # noqa: E402
from reporting.notes import cause, read_notes  # noqa: E402

NOTE = {
    "name": "Engine", "package": "libengine-dev", "methods": ["engine_a", "engine_b"], "about": "About.",
    "effect_of_skin": "None.", "settings": {"erp": "as by default"},
    "causes": [{"methods": ["engine_a"], "scenarios": ["slide"], "dimension": 3, "text": "a friction box"}],
}


def case(method, scenario, dimension="3", status="ok", error="0.1", order="0.0", options="edges=0;erp=0.2", reason=""):
    return {"method": method, "scenario": scenario, "dimension": dimension, "status": status, "reason": reason,
            "relative_error": error, "observed_order": order, "options": options, "h_s": "0.0025"}


class FakeTables:
    """Rows without files."""

    def __init__(self, closed_forms=(), features=(), disc=()):
        self.closed_forms, self.features, self.disc = list(closed_forms), list(features), list(disc)

    settings = page.Tables.settings
    polygon = page.Tables.polygon


class Judged(unittest.TestCase):
    def test_tells_rounding_first_order_and_what_stays_apart(self):
        tables = FakeTables([case("engine_a", "rest", error="1e-12", order=""), case("engine_a", "fall", error="0.003", order="1.0"),
                             case("engine_a", "slide"), case("engine_a", "slide", dimension="2"),
                             case("engine_a", "stack", status="failed", error="", order="", reason="step 3")])
        text = "\n".join(page.judged(tables, NOTE, "engine_a"))
        self.assertIn("to rounding: rest (space)", text)
        self.assertIn("at most 0.003: fall (space)", text)
        self.assertIn("a friction box: slide (space) 0.1 (order 0.0)", text)
        self.assertIn("cause not known: slide (plane)", text)
        self.assertIn("stack (space) failed, step 3", text)

    def test_cause_holds_for_its_dimension_and_methods_only(self):
        self.assertEqual(cause(NOTE, "engine_a", "slide", 3), "a friction box")
        self.assertEqual(cause(NOTE, "engine_a", "slide", 2), "")
        self.assertEqual(cause(NOTE, "engine_b", "slide", 3), "")


class Settings(unittest.TestCase):
    def test_every_option_in_force_needs_a_reason(self):
        tables = FakeTables([case("engine_a", "free_fall", options="cfm=1;erp=0.2"), case("engine_b", "free_fall")])
        with self.assertRaisesRegex(InputProblem, "settings: cfm"):
            page.settings_section(tables, NOTE)

    def test_values_are_those_in_force(self):
        tables = FakeTables([case("engine_a", "free_fall", options="edges=0;erp=0.8"), case("engine_b", "free_fall")])
        text = page.settings_section(tables, NOTE)
        self.assertIn("| `erp` | 0.2 (`engine_b`), 0.8 (`engine_a`) | as by default |", text)


class Matrix(unittest.TestCase):
    def test_methods_of_one_engine_with_the_same_results_share_a_column(self):
        features = [{"dimension": "2", "method": m, "feature": "box", "result": r, "reason": "", "question": "a box"}
                    for m, r in (("engine_a", "yes"), ("engine_b", "yes"), ("other", "no"))]
        text = page.matrix_section(FakeTables(features=features))
        self.assertIn("|  | engine_a<br>engine_b | other |", text)
        self.assertIn("| a box | yes | - |", text)


class Polygons(unittest.TestCase):
    def test_names_who_is_apart_at_the_smallest_step(self):
        rows = [{"method": m, "edges": "100", "h_s": "0.0001", "status": "ok", "method_loss_1s_J": v, "options": ""}
                for m, v in (("near", "0.01"), ("far", "-0.4"))]
        text = polygons.still_apart(FakeTables(disc=rows), ["near", "far"])
        self.assertIn("`far`", text)
        self.assertNotIn("`near`", text)


class Notes(unittest.TestCase):
    def test_the_notes_beside_the_adapters_are_well_formed_and_one_method_is_in_one(self):
        notes = read_notes(TOOLS.parent / "baselines" / "engines")
        methods = [method for note in notes for method in note["methods"]]
        self.assertEqual(len(methods), len(set(methods)))
        for note in notes:
            for one in note.get("causes", []):
                self.assertLessEqual(set(one["methods"]), set(note["methods"]), note["name"])

    def test_a_missing_key_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "x.toml").write_text('name = "X"\n', encoding="utf-8")
            with self.assertRaisesRegex(InputProblem, "package"):
                read_notes(Path(folder))


class Timing(unittest.TestCase):
    def test_a_table_that_was_never_measured_is_no_error(self):
        self.assertEqual(timing.read(Path("/nowhere/step_time.csv")), {})
        self.assertIn("Not measured", page.timing_section({}, set()))


if __name__ == "__main__":
    unittest.main()
