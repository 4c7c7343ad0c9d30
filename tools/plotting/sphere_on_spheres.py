"""Figures 6, 7 and 8 of the paper, a ball that rolls and slides on two balls, and how far every method is from it."""

import math

from . import methods, style
from .table import read_table

TRUTH = "event_driven"
VELOCITIES = ["vx_m_s", "vy_m_s", "vz_m_s", "wx_rad_s", "wy_rad_s", "wz_rad_s"]
EVENTS = {"contact_2_slides_s": "2 slides", "contact_1_separates_s": "1 separates",
          "contact_2_separates_s": "2 separates"}
FRICTION = 0.2
MODES = {"rolling": "#DCEBF7", "sliding": "#FBE8CC", "apart": "#F2F2F2"}


def contact_columns(contact):
    return [f"mode_{contact}", f"normal_{contact}_N", f"friction_norm_{contact}_N", f"slip_{contact}_m_s"]


def read_trajectories(directory):
    return read_table(directory / "trajectory.csv", ["method", "options", "h_s", "t_s", *VELOCITIES,
                                                     *contact_columns(1), *contact_columns(2)])


def one_variant(rows):
    """The rows of the first options: solvers of the same problem agree far below what a figure can show."""
    return rows.where(options=min(rows.texts("options")))


def reference(trajectories):
    """(the implicit NCP, the truth)."""
    ncp = trajectories.where(method="implicit_ncp").require_rows("implicit_ncp")
    return one_variant(ncp), trajectories.where(method=TRUTH).require_rows(TRUTH)


def true_events(directory):
    """(time, name) of the truth's events."""
    rows = read_table(directory / "summary.csv", ["method", *EVENTS]).where(method=TRUTH).require_rows(TRUTH)
    return [(rows.numbers(column)[0], name) for column, name in EVENTS.items()]


def mark_events(axes, events):
    """Dotted verticals, lettered above the axes as legend_of_events explains."""
    for (time, _), letter in zip(events, "abc"):
        axes.axvline(time, color="#8A8A8A", linewidth=0.9, linestyle=(0, (1.6, 1.6)), zorder=1)
        axes.annotate(letter, (time, 1), xycoords=axes.get_xaxis_transform(), xytext=(0, 2), textcoords="offset points",
                      fontsize=style.LABEL_POINTS, ha="center", va="bottom", color="#3A3A3A")


def legend_of_events(events):
    return ", ".join(f"{letter}: {name}" for (_, name), letter in zip(events, "abc"))


def figure_6(directory):
    ncp, truth = reference(read_trajectories(directory))
    events = true_events(directory)
    figure, [[left, right]] = style.new_figure(10.0, 5.0, panels=2)
    figure.subplots_adjust(left=0.065, right=0.985, bottom=0.11, top=0.80, wspace=0.2)
    for axes, columns, symbol in ((left, VELOCITIES[:3], "v"), (right, VELOCITIES[3:], r"\omega")):
        colours = (style.BLUE, style.VERMILION, style.GREEN)
        for column, letter, colour, dash in zip(columns, "xyz", colours, style.DASHES):
            axes.plot(truth.numbers("t_s"), truth.numbers(column), color=colour, linewidth=4.5, alpha=0.3)
            axes.plot(ncp.numbers("t_s"), ncp.numbers(column), color=colour, linestyle=dash,
                      label=f"${symbol}_{letter}$")
        mark_events(axes, events)
        axes.set_xlim(0, max(ncp.numbers("t_s")))
        axes.set_xlabel("time t [s]")
        axes.legend(frameon=False, loc="lower left" if axes is left else "upper left")
    left.set_ylabel("velocity of the centre [m/s]")
    right.set_ylabel("angular velocity [rad/s]")
    style.headline(figure, "Smooth velocities through rolling, sliding and both separations",
                   "Example 3, Fig. 6 of the paper: a ball on two balls, h = 0.01 s. Lines: implicit NCP; broad pale bands: "
                   "the event-driven truth.\nNothing jumps where a contact lets go. Its contacts: "
                   f"{legend_of_events(events)}.")
    return figure


def shade_modes(axes, rows, contact):
    """Behind the curves, the mode in which each step ends."""
    times, modes = rows.numbers("t_s"), rows.texts(f"mode_{contact}")
    start = 0.0
    for i, mode in enumerate(modes):
        if not mode:
            continue
        if i + 1 == len(modes) or modes[i + 1] != mode:
            axes.axvspan(start, times[i], color=MODES[mode], linewidth=0, zorder=0)
            axes.annotate(mode, (0.5 * (start + times[i]), 1), xycoords=axes.get_xaxis_transform(), xytext=(0, -4),
                          textcoords="offset points", ha="center", va="top", fontsize=style.LABEL_POINTS,
                          rotation=0 if times[i] - start > 0.6 else 90)
            start = times[i]


def contact_figure(directory, contact, number, title):
    ncp, truth = reference(read_trajectories(directory))
    mode, normal, friction, slip = contact_columns(contact)
    figure, [[left, right]] = style.new_figure(10.0, 4.8, panels=2)
    figure.subplots_adjust(left=0.07, right=0.985, bottom=0.11, top=0.79, wspace=0.17)
    for rows, look in ((truth, dict(linewidth=5.0, alpha=0.3)), (ncp, {})):
        times = rows.numbers("t_s")
        here = "" if rows is ncp else "_"
        left.plot(times, [FRICTION * n for n in rows.numbers(normal)], color=style.BLUE, **look,
                  label=here + r"$\mu \lambda_n$, the friction limit")
        left.plot(times, rows.numbers(friction), color=style.VERMILION,
                  linestyle=style.DASHES[1] if rows is ncp else "-", **look,
                  label=here + r"$|E^{-1} \lambda_f|$, friction")
        right.plot(times, rows.numbers(slip), color=style.BLACK, **look)
    for axes in (left, right):
        shade_modes(axes, ncp, contact)
        axes.grid(False)
        axes.set_xlim(0, max(ncp.numbers("t_s")))
        axes.set_ylim(0, 1.14 * axes.get_ylim()[1])
        axes.set_xlabel("time t [s]")
    left.set_ylabel("force [N]")
    right.set_ylabel("sliding speed [m/s]")
    left.legend(frameon=False, loc="lower left")
    style.headline(figure, title,
                   f"Example 3, Fig. {number} of the paper, h = 0.01 s. Lines: implicit NCP, shaded by the mode that its "
                   "impulses tell; broad pale bands: the\nevent-driven truth. Friction is compared in the norm of the "
                   "ellipsoid, torsion included.")
    return figure


def figure_7(directory):
    return contact_figure(
        directory, 1, 7, "Contact 1 slides from the start: friction lies on its limit until the ball lets go")


def figure_8(directory):
    return contact_figure(
        directory, 2, 8, "Contact 2 rolls without any slip until its friction reaches the limit, and slides from there")


def errors(directory):
    summary = read_table(directory / "summary.csv", ["method", "options", "status", "h_s", "largest_velocity_error"])
    summary = summary.where(status="ok").require_rows("status ok")
    figure, [[axes]] = style.new_figure(8.8, 5.2)
    figure.subplots_adjust(left=0.085, right=0.70, bottom=0.105, top=0.80)
    axes.set_yscale("log")
    for label, look, rows in methods.present(summary):
        points = sorted(set(zip(rows.numbers("h_s"), rows.numbers("largest_velocity_error"))))
        points = [(h, error) for h, error in points if not math.isnan(h) and not math.isnan(error)]
        if points:
            axes.plot([h for h, _ in points], [error for _, error in points], label=label, **look)
    steps = [h for h, _ in summary.groups("h_s")]
    methods.order_guides(axes, steps, {1: (0.75, "below"), 2: (0.55, "below")})
    methods.step_ticks(axes, steps)
    axes.set_ylabel("largest velocity error at t = 2, 2.5, 3.5, 4 s [m/s, rad/s]")
    axes.set_ylim(5e-4, 5)
    axes.legend(frameon=False, loc="center left", bbox_to_anchor=(1.02, 0.5), fontsize=style.LABEL_POINTS)
    style.headline(figure, "Smaller steps help only a method that has the laws of the problem right",
                   "Example 3 against the event-driven truth. The implicit NCP is of first order. Friction boxes, pyramids "
                   "and soft contacts\nsolve another problem, which no step size brings nearer.")
    return figure


def deviations(directory):
    trajectories = read_trajectories(directory)
    _, truth = reference(trajectories)
    at = {round(t, 9): values for t, *values in zip(*(truth.numbers(c) for c in ["t_s", *VELOCITIES]))}
    figure, [[axes]] = style.new_figure(8.8, 5.2)
    figure.subplots_adjust(left=0.085, right=0.70, bottom=0.105, top=0.80)
    axes.set_yscale("log")
    for label, look, rows in methods.present(trajectories):
        if TRUTH in rows.texts("method"):
            continue
        points = [(t, max(abs(a - b) for a, b in zip(values, at[round(t, 9)])))
                  for t, *values in zip(*(one_variant(rows).numbers(c) for c in ["t_s", *VELOCITIES]))
                  if t > 0 and round(t, 9) in at]
        axes.plot([t for t, _ in points], [error for _, error in points], label=label,
                  **{**look, "markevery": max(1, len(points) // 12), "linewidth": 1.3})
    events = true_events(directory)
    mark_events(axes, events)
    axes.set_xlim(0, max(truth.numbers("t_s")))
    axes.set_xlabel("time t [s]")
    axes.set_ylabel("largest velocity error [m/s, rad/s]")
    axes.legend(frameon=False, loc="center left", bbox_to_anchor=(1.02, 0.5), fontsize=style.LABEL_POINTS)
    style.headline(figure, "Where each method leaves the true motion",
                   "Example 3 at h = 0.01 s, the largest of the six velocity errors over time. Soft contacts sink and hop "
                   "from the start;\nthe others depart as friction first turns the ball. The truth's contacts: "
                   f"{legend_of_events(events)}.")
    return figure
