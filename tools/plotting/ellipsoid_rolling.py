"""Ellipsoids that roll without slip: error and energy against the step, and the paths of the contact."""

import math

from . import methods, style
from .table import read_table

TRUTH = "rolling_ode"
CONTROL = "stewart_trinkle"
SCENARIOS = {"ellipsoid_rolling": "on a plane, rocking", "ellipsoid_on_ellipsoid": "on a fixed ellipsoid, rocking",
             "ellipsoid_over_its_end": "over its sharp end", "ellipsoid_spinning": "spinning fast"}


def factor_note(axes, cases, factor):
    """Writes by what the control exceeds the NCP at the largest and at the smallest step."""
    rows = cases.where(method=CONTROL).require_rows(CONTROL)
    factors = [value for _, value in sorted(zip(rows.numbers("h_s"), rows.numbers(factor)), reverse=True)]
    axes.text(0.97, 0.03, f"LCP over NCP:\n{factors[0]:.2g} (h = {1000 * max(rows.numbers('h_s')):g} ms) to "
                          f"{factors[-1]:.2g}", transform=axes.transAxes, ha="right", va="bottom",
              fontsize=style.LABEL_POINTS, color="#333333",
              bbox=dict(boxstyle="round,pad=0.25", facecolor="white", edgecolor="#BBBBBB", linewidth=0.6), zorder=8)


def panels_against_step(directory, column, factor, label, anchors, title, text):
    """One panel a scenario: `column` of every method over the step, with guides of order 1 and 2.

    @param factor   column with that of a method over that of the NCP
    @param anchors  {scenario: {order: as methods.order_guides takes them}}
    """
    summary = read_table(directory / "summary.csv", ["scenario", "method", "status", "h_s", column, factor])
    summary = summary.where(status="ok").require_rows("status ok")
    figure, [row] = style.new_figure(13.4, 5.2, panels=len(SCENARIOS), sharey=True)
    figure.subplots_adjust(left=0.06, right=0.988, bottom=0.18, top=0.765, wspace=0.07)
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
        factor_note(axes, cases, factor)
        axes.set_title(name, fontsize=10, loc="left")
    row[0].set_ylabel(label)
    figure.legend(list(handles.values()), list(handles), loc="lower center", ncol=len(handles), frameon=False,
                  fontsize=style.LABEL_POINTS)
    style.headline(figure, title, text)
    return figure


def errors(directory):
    return panels_against_step(
        directory, "largest_velocity_error", "error_over_ncp", "largest velocity error [m/s, rad/s]",
        {"ellipsoid_rolling": {1: (3.0, "above"), 2: (0.5, "below")},
         "ellipsoid_on_ellipsoid": {1: (1.2, "above"), 2: (0.02, "below")},
         "ellipsoid_over_its_end": {1: (1.2, "above"), 2: (0.0012, "below")},
         "ellipsoid_spinning": {1: (0.045, "below"), 2: (0.03, "below")}},
        "First order either way; which step is nearer depends on the motion",
        "Velocity errors at t = 0.5, 1, 1.5 and 2 s against the rolling ODE. Geometry frozen at the start of the step "
        "(Stewart-Trinkle) is nearer for a body that rocks on its flat side, where it\nbehaves as symplectic Euler and the "
        "implicit step as implicit Euler; it is farther where the body rolls over its sharp end, or spins fast above its contact.")


def energy_drift(directory):
    return panels_against_step(
        directory, "relative_energy_drift", "drift_over_ncp", "largest |E - E(0)| over the initial kinetic energy",
        {"ellipsoid_rolling": {1: (2.5, "above"), 2: (0.03, "below")},
         "ellipsoid_on_ellipsoid": {1: (2.5, "above"), 2: (0.03, "below")},
         "ellipsoid_over_its_end": {1: (0.3, "above"), 2: (0.0002, "below")},
         "ellipsoid_spinning": {1: (0.02, "above"), 2: (0.002, "below")}},
        "Rolling keeps its energy; the drift that a step makes of it falls with the step",
        "Largest change of the total energy over 2 s. Rolling loses nothing to friction: all of it is drift. On a flat side "
        "the implicit step damps and the frozen one does not;\non a sharp side the implicit step's drift adds up evenly, the "
        "frozen one's grows as the body would fall.")


def paths(directory):
    table = read_table(directory / "path.csv", ["scenario", "method", "t_s", "contact_x_m", "contact_y_m"])
    figure, row = style.new_figure(13.4, 4.7, panels=len(SCENARIOS))
    figure.subplots_adjust(left=0.055, right=0.988, bottom=0.205, top=0.775, wspace=0.24)
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
        axes.locator_params(axis="x", nbins=5)
    row[0][0].set_ylabel("y of the contact [m]")
    figure.legend(list(handles.values()), list(handles), loc="lower center", ncol=len(handles), frameon=False,
                  fontsize=style.LABEL_POINTS)
    style.headline(figure, "The path of the contact, seen from above",
                   "Triaxial ellipsoids that roll without slip for 2 s, h = 0.01 s, a marker every 0.2 s.")
    return figure
