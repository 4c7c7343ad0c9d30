"""Every method on the rolling disc and on polygons of it: what it loses beyond the exact motion, and over time."""

import math

from . import style
from .table import read_table

REPORT_TIME = 1  # [s]
STEPS = [0.01, 0.001, 0.0001]  # [s]
STEP_LOOKS = {0.01: dict(marker="o", color=style.SKY), 0.001: dict(marker="s", color=style.BLUE),
              0.0001: dict(marker="D", color=style.BLACK)}
FLOOR = 1e-15  # of the initial energy; what is smaller is drawn here
OURS = ["implicit_ncp", "stewart_trinkle"]
EDGES_OF_CURVES = 1000
STEP_OF_CURVES = 0.01
# One method of each engine: with its own first choice of solver.
CURVES = ["stewart_trinkle", "box2d", "bullet_si", "chipmunk", "dart_dantzig", "mujoco_elliptic", "ode_step",
          "siconos_nsn", "simbody_pgs"]
LOOKS_OF_CURVES = [(style.BLACK, "-"), (style.ORANGE, "-"), (style.SKY, "-"), (style.GREEN, "-"), (style.BLUE, "-"),
                   (style.VERMILION, "-"), (style.PURPLE, "-"), (style.GREY, "-"), (style.ORANGE, (0, (4, 1.5)))]


def read_engines(directory):
    columns = ["sweep", "method", "options", "edges", "h_s", "status", f"method_loss_{REPORT_TIME}s_J", "loss_J",
               "relative_energy_loss"]
    return read_table(directory / "summary.csv", columns).where(sweep="engines").require_rows("sweep engines")


def label_of(row):
    """The method, and the option by which it differs from another row of the same method."""
    return row["method"] + (" *" if "dampratio=5" in row["options"].split(";") else "")


def order_of(label):
    return label.split()[0] not in OURS, label


def initial_energy(table):
    """What every case started with [J]."""
    for _, row in table.rows:
        if row["loss_J"] and row["relative_energy_loss"] and float(row["relative_energy_loss"]) > 1e-3:
            return float(row["loss_J"]) / float(row["relative_energy_loss"])
    return math.nan


def excess(table, edges):
    """{(label, h): loss beyond the exact motion over the initial energy} for polygons of `edges`, "" for the disc."""
    energy = initial_energy(table)
    column = f"method_loss_{REPORT_TIME}s_J"
    rows = [row for _, row in table.rows if row["edges"] == edges and row[column]]
    return {(label_of(row), float(row["h_s"])): float(row[column]) / energy for row in rows}


def of_one_impact(edges):
    """Share of the energy that a polygon loses when it rolls over one corner, for I = m R^2 / 2."""
    kept = (0.5 + math.cos(2 * math.pi / edges)) / 1.5
    return 1 - kept * kept


def draw_panel(axes, values, labels):
    for (label, h), value in values.items():
        if h not in STEP_LOOKS:
            continue
        look = STEP_LOOKS[h]
        axes.plot(max(abs(value), FLOOR), labels.index(label), linestyle="none", markersize=5.5,
                  markerfacecolor=look["color"] if value > 0 else "white", markeredgecolor=look["color"],
                  markeredgewidth=1.4, marker=look["marker"], zorder=3)
    axes.set_xscale("log")
    axes.grid(axis="y", color="#EEEEEE")


def engines(directory):
    table = read_engines(directory)
    labels = sorted({label_of(row) for _, row in table.rows if row["status"] == "ok" and row["loss_J"]
                     and not row["method"].endswith("_limited") and row["method"] != "exact_polygon"}, key=order_of)
    figure, [panels] = style.new_figure(11.0, 6.6, panels=4, sharey=True, gridspec_kw={"width_ratios": [1.25, 1, 1, 1]})
    figure.subplots_adjust(left=0.185, right=0.985, bottom=0.115, top=0.80, wspace=0.07)
    for axes, edges in zip(panels, ["", "30", "100", "1000"]):
        draw_panel(axes, excess(table, edges), labels)
        axes.set_title(f"{edges} edges" if edges else "the disc itself", fontsize=10.5)
        if edges:
            axes.set_xlim(3e-6, 0.5)
            axes.axvspan(3e-6, of_one_impact(int(edges)), color="#EFEFEF", zorder=0)
        else:
            axes.set_xlim(FLOOR / 3, 1e-2)
    panels[0].set_yticks(range(len(labels)), labels)
    panels[0].set_ylim(len(labels) - 0.4, -0.6)
    figure.supxlabel(f"|energy lost by t = {REPORT_TIME} s, less what the exact motion loses|, over the energy at 0",
                     fontsize=9.5, y=0.04)
    for h in STEPS:
        panels[0].plot([], [], linestyle="none", label=f"h = {h:g} s", markersize=5.5, **STEP_LOOKS[h])
    panels[0].plot([], [], linestyle="none", marker="o", color=style.GREY, label="filled: loses too much")
    panels[0].plot([], [], linestyle="none", marker="o", color=style.GREY, markerfacecolor="white",
                   label="hollow: too little")
    handles, names = panels[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="lower center", ncol=5, frameon=False, fontsize=style.LABEL_POINTS,
                  bbox_to_anchor=(0.5, -0.005))
    style.headline(
        figure, "A rigid polygon loses energy at its corners; this is what each method adds to that",
        "A disc that rolls on a plane, as itself and as polygons, beside the exact, event-driven polygon. "
        f"Values below {FLOOR:g} are drawn there.\n"
        "Grey: less than one corner's impact, where the time of the last impact decides. "
        "* with dampratio = 5; simbody_hunt_crossley has no polygons.")
    return figure


def energy_over_time(directory):
    columns = ["sweep", "method", "edges", "h_s", "t_s", "kinetic_J"]
    table = read_table(directory / "kinetic_energy.csv", columns).where(sweep="engines", h_s=STEP_OF_CURVES)
    table.require_rows(f"sweep engines at h = {STEP_OF_CURVES} s")
    figure, [[axes]] = style.new_figure(8.6, 5.0)
    figure.subplots_adjust(left=0.075, right=0.735, bottom=0.105, top=0.825)
    curves = [("smooth disc, implicit NCP", table.where(method="implicit_ncp"), style.BLACK, "-", 2.4),
              ("rigid polygon, exact", table.where(method="exact_polygon", edges=float(EDGES_OF_CURVES)), style.BLACK,
               (0, (1, 1.4)), 2.0)]
    for method, (colour, dash) in zip(CURVES, LOOKS_OF_CURVES):
        curves.append((method, table.where(method=method, edges=float(EDGES_OF_CURVES)), colour, dash, 1.5))
    horizon = max(table.numbers("t_s"))
    ends, kept = [], []
    for label, rows, colour, dash, width in curves:
        if not len(rows):
            continue
        times, energies = rows.numbers("t_s"), rows.numbers("kinetic_J")
        axes.plot(times, energies, color=colour, linestyle=dash, linewidth=width)
        failed = times[-1] < horizon
        if failed:
            axes.plot(times[-1], energies[-1], marker="x", markersize=7, markeredgewidth=2, color=colour)
        ends.append((times[-1], energies[-1], label + (", then fails" if failed else ""), colour, dash))
        if label in CURVES and not failed:
            kept.append(100 * energies[-1] / energies[0])
    axes.set_xlim(0, horizon)
    axes.set_ylim(0, None)
    axes.set_xlabel("time t [s]")
    axes.set_ylabel("kinetic energy [J]")
    style.label_line_ends(axes, ends)
    style.headline(
        figure, f"The same polygon keeps from {min(kept):.0f} to {max(kept):.0f} % of its energy, as the method has it",
        f"A disc as a polygon of {EDGES_OF_CURVES} edges, h = {STEP_OF_CURVES} s, five edges a step, in one method of "
        "each engine. Those that see every\ncorner that a step passes brake it; those that see one or two keep about "
        "as much as the exact polygon, or more.")
    return figure
