"""Many contacts: time of a step and memory over the number of contacts, as measured by spheres_in_box_scaling."""

import math

from . import style
from .table import read_table

COLUMNS = ["box", "spheres", "contacts", "step_s", "slowest_step_s", "memory_bytes", "largest_residual", "exponent"]
BOXES = {"tray": (style.BLUE, "o", "tray, four layers deep"), "cube": (style.ORANGE, "s", "cube, as deep as wide")}


def fit(rows, exponent):
    """Ends of the line of least squares of the logarithms."""
    points = list(zip(rows.numbers("contacts"), rows.numbers("step_s")))
    factor = 1.0
    for c, t in points:
        factor *= (t / c ** exponent) ** (1 / len(points))
    return [(c, factor * c ** exponent) for c in (points[0][0], points[-1][0])]


def scaling(directory):
    table = read_table(directory / "scaling.csv", COLUMNS).require_rows("measured times")
    figure, panels = style.new_figure(9.6, 4.9, 2)
    figure.subplots_adjust(left=0.085, right=0.985, bottom=0.13, top=0.80, wspace=0.24)
    time, memory = panels[0]
    exponents = {}
    for box, (color, marker, label) in BOXES.items():
        rows = table.where(box=box)
        contacts, times = rows.numbers("contacts"), rows.numbers("step_s")
        exponents[box] = rows.numbers("exponent")[0]
        time.loglog(contacts, times, marker, color=color, zorder=3,
                    label=f"{label}: exponent {exponents[box]:.2f}")
        time.loglog(contacts, rows.numbers("slowest_step_s"), "^", color=color, markersize=4, alpha=0.5)
        line = fit(rows, exponents[box])
        time.loglog([c for c, _ in line], [t for _, t in line], color=color, linewidth=1.1)
        memory.loglog(contacts, [value / 1e6 for value in rows.numbers("memory_bytes")], marker + "-", color=color,
                      label=label)
        if box == "tray":
            for n, c, t in zip(rows.numbers("spheres"), contacts, times):
                time.annotate(f"n = {n:g}", (c, t), xytext=(7, -9), textcoords="offset points",
                              fontsize=style.LABEL_POINTS)
            (first, start), (last, _) = line
            time.loglog([first, last], [start, start * (last / first) ** 1.2], color=style.GREY,
                        linestyle=style.DASHES[1], linewidth=1.1, label="exponent 1.2")
    time.plot([], [], "^", color=style.GREY, markersize=4, label="slowest step")
    time.set_xlabel("contacts with an impulse")
    time.set_ylabel("processor time of a step [s]")
    low, high = time.get_xlim()
    time.set_xlim(low, 2.5 * high)  # room for the labels, right of their points
    low, high = time.get_ylim()
    time.set_ylim(low / 2, 60 * high)  # and for the lowest of them and the legend
    time.legend(frameon=False, fontsize=style.LABEL_POINTS, loc="upper left")
    memory.set_xlabel("contacts with an impulse")
    memory.set_ylabel("largest resident set [MB]")
    memory.legend(frameon=False, fontsize=style.LABEL_POINTS, loc="upper left")
    residual = 10.0 ** math.ceil(math.log10(max(table.numbers("largest_residual"))))
    style.headline(figure, f"Time of a step grows with the number of contacts to the power {exponents['tray']:.2f}",
                   f"Spheres that fall together in a box, implicit NCP, h = 0.01 s, residual below {residual:.0e}; median of the "
                   "second half of the steps.\nSeveral trays of each n, and one cube, which grows in depth too. Memory and time jump where a step needs Newton's method.")
    return figure
