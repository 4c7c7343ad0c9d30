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
from reporting.notes import cause, read_notes, without_notes  # noqa: E402

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

    def __init__(self, closed_forms=(), features=(), disc=(), curves=()):
        self.closed_forms, self.features = list(closed_forms), list(features)
        self.disc, self.curves = list(disc), list(curves)

    settings = page.Tables.settings
    changed = page.Tables.changed
    polygon = page.Tables.polygon
    energy = page.Tables.energy


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


def rolled(method, excess, h="0.0001", options="", edges="100"):
    """A row of the disc, over 1 s, or over 0.2 s at the finest step."""
    return {"method": method, "edges": edges, "h_s": h, "status": "ok", "options": options, "reason": "",
            "method_loss_1s_J": excess if h == "0.0001" else "", "polygon_loss_J": "0.5", "loss_J": str(0.5 + float(excess)),
            "until_s": "1" if h == "0.0001" else "0.2"}


def notes_on(*methods, polygons=False):
    note = {"name": "E", "methods": list(methods)}
    return {**note, "polygons": {"why": "w", "experiment": "variants"}} if polygons else note


class Polygons(unittest.TestCase):
    def test_names_who_is_apart_at_one_of_the_finest_steps_and_has_no_reason(self):
        rows = [rolled("near", "0.01"), rolled("near", "0.001", "2e-05"), rolled("far", "-0.4"),
                rolled("late", "0.01"), rolled("late", "0.1", "2e-05")]
        text = polygons.still_apart(FakeTables(disc=rows), [notes_on("near", "far"), notes_on("late", polygons=True)])
        self.assertNotIn("`near`", text)
        self.assertIn("`far`, `late`.", text)
        self.assertIn("**Not explained: `far`.**", text)
        self.assertIn("all methods", polygons.still_apart(FakeTables(disc=rows[:2]), [notes_on("near")]))

    def test_a_variant_is_not_the_method_itself(self):
        tables = FakeTables([case("m", "free_fall", options="a=1")], disc=[rolled("m", "-0.4", options="a=2"),
                                                                          rolled("m", "0.01", options="a=1")])
        self.assertEqual(polygons.excess(tables.polygon("m", 100, 0.0001)), 0.01)
        text = polygons.variants(tables, notes_on("m"))
        self.assertIn("`m` +0.010; `m` with a 2 -0.400", text)

    def test_energy_lost_early_is_told_from_energy_lost_all_the_time(self):
        curves = [{"method": m, "edges": "100", "h_s": "0.0001", "options": "", "t_s": t, "total_J": e}
                  for m, t, e in (("exact_polygon", "0.1", "9"), ("exact_polygon", "1", "8"), ("m", "0.1", "8.5"),
                                  ("m", "1", "7.5"), ("m", "0", "10"), ("exact_polygon", "0", "10"))]
        text = polygons.at_the_start(FakeTables(curves=curves), {"methods": ["m"], "polygons": {"edges": 100}})
        self.assertIn("0.5000 J by 0.1 s and 0.5000 J by 1 s", text)

    def test_a_method_without_polygons_is_named_with_its_reason(self):
        row = {**rolled("m", "0"), "status": "unsupported", "reason": "only spheres"}
        self.assertIn("`m` (only spheres)", polygons.refusals(FakeTables(disc=[row]), ["m"]))


class Notes(unittest.TestCase):
    def test_the_notes_beside_the_adapters_are_well_formed_and_one_method_is_in_one(self):
        notes = read_notes(TOOLS.parent / "baselines" / "engines")
        methods = [method for note in notes for method in note["methods"]]
        self.assertEqual(len(methods), len(set(methods)))
        for note in notes:
            for one in note.get("causes", []):
                self.assertLessEqual(set(one["methods"]), set(note["methods"]), note["name"])

    def test_an_engine_without_notes_is_on_the_page_and_told_where_they_belong(self):
        [note] = without_notes(["engine_a", "new_x", "new_y"], [NOTE])
        self.assertEqual(note["methods"], ["new_x", "new_y"])
        tables = FakeTables([case("new_x", "free_fall", options="erp=0.2"), case("new_y", "free_fall", options="")])
        text = page.engine_section(tables, note, {})
        self.assertIn("`baselines/engines/new.toml`", text)
        self.assertIn("| `erp` | 0.2 | not noted |", text)

    def test_notes_that_leave_a_method_out_are_refused(self):
        with self.assertRaisesRegex(InputProblem, "engine_c"):
            without_notes(["engine_a", "engine_c"], [NOTE])

    def test_a_missing_key_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "x.toml").write_text('name = "X"\n', encoding="utf-8")
            with self.assertRaisesRegex(InputProblem, "package"):
                read_notes(Path(folder))


class Timing(unittest.TestCase):
    def test_a_table_that_was_never_measured_is_no_error(self):
        self.assertEqual(timing.read(Path("/nowhere/step_time.csv")), {})
        times = {name: {"step_us": us, "ratio": "1", "processor": "P"}
                 for name, us in ((timing.OURS, "0.5"), ("box2d", "1.25"), (timing.SPHERES_OURS, "3"),
                                  (timing.SPHERES + "ode_step", "1.2"))}
        text = page.timing_section(times)
        self.assertIn("| `box2d` | 1.25 | 1 | 0.4 |", text)
        self.assertIn("| `ode_step` | 1.2 | 1 | 2.5 |", text)
        self.assertIn("Not measured", page.timing_section({}))


if __name__ == "__main__":
    unittest.main()
