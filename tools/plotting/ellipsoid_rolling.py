"""Ellipsoids that roll without slip: error and energy against the step, and the paths of the contact."""

import math

from . import methods, style
from .table import read_table

TRUTH = "rolling_ode"
SCENARIOS = {"ellipsoid_rolling": "on a plane", "ellipsoid_spinning": "on a plane, spinning fast",
             "ellipsoid_on_ellipsoid": "on a fixed ellipsoid"}


def panels_against_step(directory, column, label, anchors, title, text):
    """One panel a scenario: `column` of every method over the step, with guides of order 1 and 2.

    @param anchors  {scenario: {order: as methods.order_guides takes them}}
    """
    summary = read_table(directory / "summary.csv", ["scenario", "method", "status", "h_s", column])
    summary = summary.where(status="ok").require_rows("status ok")
    figure, [row] = style.new_figure(11.2, 5.0, panels=len(SCENARIOS), sharey=True)
    figure.subplots_adjust(left=0.07, right=0.985, bottom=0.185, top=0.755, wspace=0.08)
    handles = {}
    for axes, (scenario, name) in zip(row, SCENARIOS.items()):
        cases = summary.where(scenario=scenario).require_rows(scenario)
        axes.set_yscale("log")
        for method, look, rows in methods.present(cases):
            points = [(h, value) for h, value in sorted(zip(rows.numbers("h_s"), rows.numbers(column)))
                      if not math.isnan(h) and value > 0]
            if points:
                handles[method], = axes.plot([h for h, _ in points], [value for _, value in points], **look)
        steps = [h for h, _ in cases.groups("h_s")]
        methods.order_guides(axes, steps, anchors[scenario])
        methods.step_ticks(axes, steps)
        axes.set_title(name, fontsize=10, loc="left")
    row[0].set_ylabel(label)
    figure.legend(list(handles.values()), list(handles), loc="lower center", ncol=len(handles), frameon=False,
                  fontsize=style.LABEL_POINTS)
    style.headline(figure, title, text)
    return figure


def errors(directory):
    return panels_against_step(
        directory, "largest_velocity_error", "largest velocity error [m/s, rad/s]",
        {"ellipsoid_rolling": {1: (3.0, "above"), 2: (0.5, "below")},
         "ellipsoid_spinning": {1: (0.045, "below"), 2: (0.03, "below")},
         "ellipsoid_on_ellipsoid": {1: (1.2, "above"), 2: (0.02, "below")}},
        "First order either way; which step is nearer depends on the motion",
        "Velocity errors at t = 0.5, 1, 1.5 and 2 s against the rolling ODE. Geometry frozen at the start of the step is "
        "nearer for a body that rocks, where it\nbehaves as symplectic Euler and the implicit step as implicit Euler; it "
        "is worse where the body spins fast above its contact.")


def energy_drift(directory):
    return panels_against_step(
        directory, "relative_energy_drift", "largest |E - E(0)| over the initial kinetic energy",
        {"ellipsoid_rolling": {1: (2.5, "above"), 2: (0.25, "below")},
         "ellipsoid_spinning": {1: (0.02, "above"), 2: (0.002, "below")},
         "ellipsoid_on_ellipsoid": {1: (2.5, "above"), 2: (0.25, "below")}},
        "Rolling keeps its energy; the drift that a step makes of it falls with the step",
        "Largest change of the total energy over 2 s. Rolling loses nothing to friction: all of it is drift.\n"
        "The implicit step damps the rocking to and fro.")


def paths(directory):
    table = read_table(directory / "path.csv", ["scenario", "method", "t_s", "contact_x_m", "contact_y_m"])
    figure, row = style.new_figure(11.2, 4.9, panels=len(SCENARIOS))
    figure.subplots_adjust(left=0.065, right=0.985, bottom=0.2, top=0.76, wspace=0.24)
    handles = {}
    for axes, (scenario, name) in zip(row[0], SCENARIOS.items()):
        cases = table.where(scenario=scenario).require_rows(scenario)
        truth = cases.where(method=TRUTH).require_rows(TRUTH)
        handles["rolling ODE"], = axes.plot(truth.numbers("contact_x_m"), truth.numbers("contact_y_m"),
                                            color=style.ORANGE, linewidth=4.0, alpha=0.6)
        for method, look, rows in methods.present(cases):
            if TRUTH in rows.texts("method"):
                continue
            points = [(x, y) for x, y in zip(rows.numbers("contact_x_m"), rows.numbers("contact_y_m"))
                      if not math.isnan(x)]
            handles[method], = axes.plot([x for x, _ in points], [y for _, y in points],
                                         **{**look, "linewidth": 1.2, "markersize": 4, "markevery": 10})
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_title(name, fontsize=10, loc="left")
        axes.set_xlabel("x of the contact [m]")
    row[0][0].set_ylabel("y of the contact [m]")
    figure.legend(list(handles.values()), list(handles), loc="lower center", ncol=len(handles), frameon=False,
                  fontsize=style.LABEL_POINTS)
    style.headline(figure, "The path of the contact, seen from above",
                   "Triaxial ellipsoids that roll without slip for 2 s, h = 0.01 s, a marker every 0.2 s.")
    return figure
