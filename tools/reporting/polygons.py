"""Polygons on the page: what each method loses beyond the exact one, and why where that does not vanish."""

import math

from .tables import EDGES, FINEST, STEPS, number, of_a_step, of_one_impact


def excess(row):
    return number(row["method_loss_1s_J"]) if row is not None and row["status"] == "ok" else math.nan


def excess_to_the_end(row):
    """As excess, by the end of the run, which at the finest step is before 1 s."""
    return number(row["loss_J"]) - number(row["polygon_loss_J"]) if row is not None and row["status"] == "ok" else math.nan


def cell(value):
    return "" if math.isnan(value) else f"{value:+.3f}"


def polygon_section(tables, notes):
    exact = {n: number(tables.polygon("stewart_trinkle", n, STEPS[0])["polygon_loss_1s_J"]) for n in EDGES}
    steps = [*(f"{h:g}" for h in STEPS[1:]), f"{FINEST:g}"]
    header = ["method"] + [text for n in EDGES for text in (f"N = {n}: h = {STEPS[0]:g}", *steps)]
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    methods = ["stewart_trinkle"] + [method for note in notes for method in note["methods"]]
    for method in methods:
        values = []
        for n in EDGES:
            values += [excess(tables.polygon(method, n, h)) for h in STEPS]
            values.append(excess_to_the_end(tables.polygon(method, n, FINEST)))
        if not all(math.isnan(value) for value in values):
            lines.append(f"| `{method}` | " + " | ".join(cell(value) for value in values) + " |")
    impacts = ", ".join(f"{of_one_impact(n):.4f} J ({n})" for n in EDGES)
    losses = ", ".join(f"{exact[n]:.3f} J ({n} edges)" for n in EDGES)
    return (
        "## Polygons: the shape's own physics, and the engine's error\n\n"
        "A disc that rolls keeps its energy; a rigid polygon loses some at each corner, whoever simulates it. The exact, "
        f"event-driven polygon loses in 1 s {losses}. What each method loses beyond that (+) or too little (-) by 1 s [J], at "
        f"h = {FINEST:g} s by 0.2 s:\n\n"
        + "\n".join(lines)
        + f"\n\nOne impact takes up to {impacts}, so below that the time of the last one decides. "
        + still_apart(tables, notes) + refusals(tables, methods)
        + "\n\n![What each method adds to the exact loss](disc_rolling/engines.png)\n\n"
        "![Energy over time of the same polygon in one method of each engine](disc_rolling/engines_energy.png)\n")


def is_apart(value, edges, h, time):
    """Whether an excess [J] is more than one impact and than what linearising the gap takes in `time` [s]."""
    return not math.isnan(value) and abs(value) > max(of_one_impact(edges), of_a_step(h) * time)


def apart(tables, method):
    """Whether `method` stays apart from the exact polygon at one of the two finest steps."""
    for edges in EDGES:
        fine, finest = (tables.polygon(method, edges, h) for h in (STEPS[-1], FINEST))
        if is_apart(excess(fine), edges, STEPS[-1], 1.0):
            return True
        if is_apart(excess_to_the_end(finest), edges, FINEST, number(finest["until_s"]) if finest else math.nan):
            return True
    return False


def quoted(names):
    return ", ".join(f"`{name}`" for name in names)


def still_apart(tables, notes):
    """Who does not approach the exact polygon, and who of them has nothing written that says why."""
    fine = f"h = {STEPS[-1]:g} or {FINEST:g} s"
    found = {method: "polygons" in note for note in notes for method in note["methods"] if apart(tables, method)}
    if not found:
        return f"At {fine} all methods are within that."
    text = (f"At {fine} these are further from the exact polygon than one impact and than what a gap linearised over a step "
            f"takes ({of_a_step(STEPS[-1]):.4f} J in 1 s at h = {STEPS[-1]:g} s): {quoted(sorted(found))}.")
    unexplained = sorted(method for method, explained in found.items() if not explained)
    if len(unexplained) < len(found):
        text += " The engines' sections say why."
    if unexplained:
        text += f" **Not explained: {quoted(unexplained)}.**"
    return text


def refusals(tables, methods):
    """Who has no polygons at all."""
    found = []
    for method in methods:
        rows = [row for row in (tables.polygon(method, n, STEPS[-1]) for n in EDGES) if row is not None]
        if rows and all(row["status"] == "unsupported" for row in rows):
            found.append(f"`{method}` ({rows[0]['reason']})")
    return " Without polygons: " + "; ".join(found) + "." if found else ""


def at_the_start(tables, note):
    """An experiment on time: how much less energy than the exact polygon there is early on, and how much at the end."""
    edges = note["polygons"]["edges"]
    found = []
    for method in note["methods"]:
        for h in (STEPS[-1], FINEST):
            exact, own = tables.energy("exact_polygon", edges, h), tables.energy(method, edges, h)
            times = sorted(set(exact) & set(own) - {0.0})
            if times:
                less = " and ".join(f"{exact[t] - own[t]:.4f} J by {t:g} s" for t in (times[0], times[-1]))
                found.append(f"`{method}`, h = {h:g} s: {less}")
    return f"Lost beyond the exact polygon with {edges} edges: {'; '.join(found)}." if found else ""


def variants(tables, note):
    """An experiment on options: the excess of methods and of their variants, all edges, at the smallest step with 1 s."""
    h = STEPS[-1]
    found = {}
    for row in tables.disc:
        if row["method"] in note["methods"] and row["edges"] in map(str, EDGES) and float(row["h_s"]) == h:
            changed = ", ".join(f"{option} {value}" for option, value in sorted(tables.changed(row).items()))
            label = f"`{row['method']}`" + (f" with {changed}" if changed else "")
            found.setdefault(label, {})[row["edges"]] = f"{excess(row):+.3f}"
    shown = "; ".join(f"{label} {', '.join(values[str(n)] for n in EDGES if str(n) in values)}"
                      for label, values in sorted(found.items()))
    return f"With {', '.join(map(str, EDGES))} edges at h = {h:g} s, in J: {shown}."


EXPERIMENTS = {"at_the_start": at_the_start, "variants": variants}


def polygon_verdict(tables, note):
    return f"**Polygons.** {note['polygons']['why']} {EXPERIMENTS[note['polygons']['experiment']](tables, note)}\n"
