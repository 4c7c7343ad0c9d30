"""Polygons on the page: what each method loses beyond the exact one, and why where that does not vanish."""

import math

from .tables import EDGES, STEPS, number, of_a_step, of_one_impact, options_of


def excess(row):
    return number(row["method_loss_1s_J"]) if row is not None and row["status"] == "ok" else math.nan


def cell(value):
    return "" if math.isnan(value) else f"{value:+.3f}"


def polygon_section(tables, notes):
    exact = {n: number(tables.polygon("stewart_trinkle", n, STEPS[0])["polygon_loss_1s_J"]) for n in EDGES}
    header = ["method"] + [f"N = {n}: h = {h:g}" if h == STEPS[0] else f"{h:g}" for n in EDGES for h in STEPS]
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    methods = ["stewart_trinkle"] + [method for note in notes for method in note["methods"]]
    for method in methods:
        values = [excess(tables.polygon(method, n, h)) for n in EDGES for h in STEPS]
        if not all(math.isnan(value) for value in values):
            lines.append(f"| `{method}` | " + " | ".join(cell(value) for value in values) + " |")
    impacts = ", ".join(f"{of_one_impact(n):.4f} J ({n})" for n in EDGES)
    losses = ", ".join(f"{exact[n]:.3f} J ({n} edges)" for n in EDGES)
    return (
        "## Polygons: the shape's own physics, and the engine's error\n\n"
        "A disc that rolls keeps its energy; a rigid polygon loses some at each corner, whoever simulates it. The exact, "
        f"event-driven polygon loses in 1 s {losses}. What each method loses beyond that (+) or too little (-) by 1 s [J]:\n\n"
        + "\n".join(lines)
        + f"\n\nOne impact takes up to {impacts}, so below that the time of the last one decides. "
        + still_apart(tables, methods)
        + "\n\n![What each method adds to the exact loss](disc_rolling/engines.png)\n\n"
        "![Energy over time of the same polygon in one method of each engine](disc_rolling/engines_energy.png)\n")


def still_apart(tables, methods):
    """Methods whose excess at the smallest step is more than an impact, which are to say why."""
    apart = [(method, n, excess(tables.polygon(method, n, STEPS[-1]))) for method in methods for n in EDGES]
    apart = [(m, n, v) for m, n, v in apart if not math.isnan(v) and abs(v) > max(of_one_impact(n), of_a_step(STEPS[-1]))]
    if not apart:
        return f"At h = {STEPS[-1]:g} s all methods are within that."
    names = sorted({method for method, _, _ in apart})
    return (f"At h = {STEPS[-1]:g} s these are further from the exact polygon than one impact and than the "
            f"{of_a_step(STEPS[-1]):.4f} J that a gap linearised over a step takes: "
            + ", ".join(f"`{name}`" for name in names) + "; their sections say why.")


def loss_per_step(tables, note):
    """An experiment on rounding: the excess for each step, at two steps."""
    method, edges = note["methods"][0], note["polygons"]["edges"]
    found = []
    for h in (0.0001, 0.00002):
        row = tables.polygon(method, edges, h)
        if row is None or row["status"] != "ok":
            return ""
        extra = (number(row["loss_J"]) - number(row["polygon_loss_J"])) / number(row["steps"])
        found.append(f"{extra:.1e} J a step at h = {h:g} s")
    return f"With {edges} edges the excess is {' and '.join(found)}, over 10,000 steps each."


def variants(tables, note):
    """An experiment on options: the excess of methods and of their variants at the smallest step."""
    edges, h = note["polygons"]["edges"], STEPS[-1]
    found = []
    for row in tables.disc:
        if row["method"] in note["methods"] and row["edges"] == str(edges) and float(row["h_s"]) == h:
            option = options_of(row["options"]).get("impratio", "1")
            found.append(f"`{row['method']}`" + (f" with impratio {option}" if option != "1" else "") + f" {excess(row):+.3f} J")
    return f"With {edges} edges at h = {h:g} s: " + ", ".join(found) + "."


EXPERIMENTS = {"loss_per_step": loss_per_step, "variants": variants}


def polygon_verdict(tables, note):
    return f"**Polygons.** {note['polygons']['why']} {EXPERIMENTS[note['polygons']['experiment']](tables, note)}\n"
