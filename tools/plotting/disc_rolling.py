"""Figure 1 of the paper and the loss behind it: a disc rolling on a plane, as polygons and as itself."""

import math

from . import style
from .table import read_table

POLICY_OF_FIGURE_1 = "reachable"
STEP_OF_EDGES_SWEEP = 0.01  # [s]
EDGES_OF_STEP_SWEEP = 1000
LOSS_TIME = 1.0  # [s]; later the losses of coarse polygons and large steps all crowd at 100 %


def read_energies(directory):
    return read_table(directory / "kinetic_energy.csv", ["sweep", "method", "options", "edges", "candidates", "h_s",
                                                         "t_s", "kinetic_J", "total_J"])


def select(energies, **wanted):
    """The rows that equal `wanted`, or a message that names what is not there."""
    what = ", ".join(f"{column} {value}" for column, value in wanted.items())
    return energies.where(**wanted).require_rows(what)


def one_variant(rows):
    """The rows of the first options: solvers of the same problem agree far below what a figure can show."""
    return rows.where(options=min(rows.texts("options")))


def kinetic_energy_figure(curves, reference, disc, title, text):
    """Kinetic energy against time, each curve named at its right end.

    @param curves     (label, rows) of the polygons, from the coarsest to the finest
    @param reference  (label, rows) of a closed form
    @param disc       (label, rows) of the smooth disc, the line on top
    """
    figure, [[axes]] = style.new_figure(8.6, 5.0)
    figure.subplots_adjust(left=0.075, right=0.715, bottom=0.105, top=0.825)
    looks = [dict(color=colour, linestyle=style.DASHES[i % len(style.DASHES)], zorder=3)
             for i, colour in enumerate(style.shades(len(curves)))]
    looks.append(dict(color=style.VERMILION, linestyle=(0, (1, 1.4)), linewidth=1.8, zorder=4))
    looks.append(dict(color=style.BLACK, linestyle="-", linewidth=2.4, zorder=5))
    ends = []
    for (label, rows), look in zip([*curves, reference, disc], looks):
        times, energies = rows.numbers("t_s"), rows.numbers("kinetic_J")
        axes.plot(times, energies, **look)
        ends.append((times[-1], energies[-1], label, look["color"], look["linestyle"]))
    axes.set_xlim(0, max(end[0] for end in ends))
    axes.set_ylim(0, None)
    axes.set_xlabel("time t [s]")
    axes.set_ylabel("kinetic energy [J]")
    style.label_line_ends(axes, ends, bold=[disc[0]])
    style.headline(figure, title, text)
    return figure


def figure_1a(directory):
    energies = read_energies(directory).where(sweep="edges")
    polygons = select(energies, method="stewart_trinkle", candidates=POLICY_OF_FIGURE_1)
    finest = max(polygons.numbers("edges"))
    return kinetic_energy_figure(
        [(f"N = {edges:.0f}", rows) for edges, rows in polygons.groups("edges")],
        ("step-limited closed form", select(energies, method="step_limited", edges=finest)),
        ("smooth disc, implicit NCP", one_variant(select(energies, method="implicit_ncp"))),
        "A rolling polygon loses its energy, however many edges it has",
        "A disc rolls on a plane without loss. Stewart-Trinkle LCP on a regular polygon of N edges, "
        f"h = {STEP_OF_EDGES_SWEEP} s: more\n"
        "edges lose less, down to a floor that the step sets. The implicit NCP on the disc itself loses nothing.")


def figure_1b(directory):
    energies = read_energies(directory).where(sweep="step_size")
    polygons = select(energies, method="stewart_trinkle", candidates=POLICY_OF_FIGURE_1)
    steps = polygons.numbers("h_s")
    return kinetic_energy_figure(
        [(f"h = {step:g} s", rows) for step, rows in reversed(polygons.groups("h_s"))],
        ("edge-limited closed form", select(energies, method="edge_limited", h_s=min(steps))),
        ("smooth disc, implicit NCP", one_variant(select(energies, method="implicit_ncp", h_s=max(steps)))),
        "Smaller steps help a polygon only until its corners show",
        "A disc rolls on a plane without loss. Stewart-Trinkle LCP on a regular polygon of "
        f"N = {EDGES_OF_STEP_SWEEP} edges: from h = 0.001 s\n"
        "down the loss hardly falls, for a real polygon loses as much. "
        f"The implicit NCP on the disc loses nothing, even at h = {max(steps):g} s.")


def loss_after(rows, time):
    """Total energy lost by `time` in percent of the kinetic energy at 0, of one case; NaN if it did not get there."""
    samples = {t: (kinetic, total) for t, kinetic, total in
               zip(rows.numbers("t_s"), rows.numbers("kinetic_J"), rows.numbers("total_J"))}
    if 0.0 not in samples or time not in samples:
        return math.nan
    return 100.0 * (samples[0.0][1] - samples[time][1]) / samples[0.0][0]


def losses(rows, column):
    """(values of the sweep's `column`, loss) of the cases that reached LOSS_TIME."""
    points = [(value, loss_after(case, LOSS_TIME)) for value, case in rows.groups(column)]
    points = [(value, lost) for value, lost in points if not math.isnan(lost)]
    return [value for value, _ in points], [lost for _, lost in points]


# Looks of the candidate policies, in the order of policy_order: open shapes that fit into each other, since many agree.
POLICY_LOOKS = [
    dict(marker="o", color=style.BLACK, markersize=3.6, zorder=6),
    dict(marker="s", color=style.BLUE, markersize=11, markerfacecolor="none", markeredgewidth=1.3),
    dict(marker="D", color=style.VERMILION, markersize=7.5, markerfacecolor="none", markeredgewidth=1.3),
    dict(marker="X", color=style.GREEN, markersize=8, markeredgecolor="white", markeredgewidth=0.6, zorder=5),
    dict(marker="v", color=style.PURPLE, markersize=9, markerfacecolor="none", markeredgewidth=1.5),
    dict(marker="^", color=style.ORANGE, markersize=9, markerfacecolor="none", markeredgewidth=1.5),
]
# What explains the points; the exact polygon lies on the edge-limited curve where that approximation is good.
TRUTH_LOOKS = {
    "edge_limited": dict(label="edge-limited closed form", color=style.SKY, linewidth=3.6),
    "step_limited": dict(label="step-limited closed form", color=style.ORANGE, linestyle=(0, (4, 1.5)), linewidth=2.2),
    "exact_polygon": dict(label="rigid polygon, exact", color=style.BLACK, linestyle=(0, (1, 1.6))),
}


def policy_order(policy):
    return policy != POLICY_OF_FIGURE_1, policy != "all", policy


def draw_policy(axes, values, lost, look, label):
    """Points of one policy; where it gained energy, which has no place on a logarithmic axis, a note at the bottom."""
    axes.plot([v for v, y in zip(values, lost) if y > 0], [y for y in lost if y > 0], linestyle="none", label=label,
              **look)
    for value in (v for v, y in zip(values, lost) if y <= 0):
        axes.plot(value, 0, transform=axes.get_xaxis_transform(), clip_on=False, **look)
        axes.annotate("gains\nenergy", (value, 0), xycoords=axes.get_xaxis_transform(), xytext=(0, 6),
                      textcoords="offset points", ha="center", fontsize=style.LABEL_POINTS)


def draw_loss_panel(axes, energies, column):
    """Points of every policy and the curves that explain them, against `column`, "edges" or "h_s"."""
    for method, look in TRUTH_LOOKS.items():
        axes.plot(*losses(energies.where(method=method), column), **look)
    polygons = select(energies, method="stewart_trinkle")
    axes.set_xscale("log")
    axes.set_yscale("log")
    for policy, look in zip(sorted(set(polygons.texts("candidates")), key=policy_order), POLICY_LOOKS):
        draw_policy(axes, *losses(polygons.where(candidates=policy), column), look, f"LCP, candidates {policy}")
    ticks = [value for value, _ in polygons.groups(column)]
    axes.set_xticks(ticks, [f"{tick if column == 'edges' else 1000 * tick:g}" for tick in ticks])
    axes.minorticks_off()


def percent_ticks(axes):
    """1, 2 and 5 of every decade within the limits, as percentages."""
    low, high = axes.get_ylim()
    ticks = [digit * 10.0**decade for decade in range(-6, 4) for digit in (1, 2, 5)]
    ticks = [tick for tick in ticks if low <= tick <= high]
    axes.set_yticks(ticks, [f"{tick:g} %" for tick in ticks])


def loss(directory):
    energies = read_energies(directory)
    figure, [[left, right]] = style.new_figure(9.4, 5.9, panels=2, sharey=True)
    figure.subplots_adjust(left=0.096, right=0.985, bottom=0.205, top=0.795, wspace=0.06)
    draw_loss_panel(left, energies.where(sweep="edges"), "edges")
    draw_loss_panel(right, energies.where(sweep="step_size"), "h_s")
    percent_ticks(left)
    left.set_xlabel(f"edges N of the polygon, at h = {STEP_OF_EDGES_SWEEP} s")
    right.set_xlabel(f"step h [ms], at N = {EDGES_OF_STEP_SWEEP}")
    left.set_ylabel(f"energy lost by t = {LOSS_TIME:g} s [% of the kinetic energy at 0]")
    handles, labels = left.get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=4, frameon=False, fontsize=style.LABEL_POINTS)
    style.headline(
        figure, "The larger of two losses wins: the polygon's corners, or the gap linearised over a step",
        "A disc that rolls as a polygon under the Stewart-Trinkle LCP. Where it sees every vertex that a step can reach, "
        "more\nedges help down to the step-limited curve, and smaller steps down to the edge-limited one. Where it sees "
        "only the\nnearest vertex it loses less, but sinks into the ground.")
    return figure
