"""Complementarity solvers: performance profiles (the share of problems each solves, by cost beside the best), and what a
step of a trajectory takes."""

from . import style
from .table import read_table

FAMILIES = {
    "literature": "problems of the literature",
    "random_lcp": "random linear problems",
    "step": "contact steps, geometry at the end of the step",
    "frozen_step": "contact steps, frozen geometry",
}

# (colour, dash): ours are drawn through, Siconos's broken.
LOOKS = {
    "solver_chain": (style.BLACK, "-"),
    "path_newton": (style.BLUE, "-"),
    "semismooth_newton": (style.GREEN, "-"),
    "elimination": (style.VERMILION, "-"),
    "lemke": (style.PURPLE, "-"),
    "siconos_mcp_fb": (style.ORANGE, style.DASHES[1]),
    "siconos_mcp_min": (style.SKY, style.DASHES[1]),
    "siconos_ncp_fb": (style.ORANGE, style.DASHES[3]),
    "siconos_ncp_min": (style.SKY, style.DASHES[3]),
    "siconos_ncp_path_search": (style.GREY, style.DASHES[2]),
    "siconos_lemke": (style.PURPLE, style.DASHES[3]),
    "siconos_fc3d_nsgs": (style.VERMILION, style.DASHES[1]),
    "siconos_fc3d_nsn_ac": (style.GREEN, style.DASHES[1]),
    "siconos_fc3d_nsn_fb": (style.GREEN, style.DASHES[3]),
    "siconos_fc3d_nsn_nm": (style.GREEN, style.DASHES[2]),
    "siconos_fc3d_admm": (style.GREY, style.DASHES[1]),
}
OURS = [method for method in LOOKS if not method.startswith("siconos")]

COLUMNS = ["family", "method", "ratio", "share"]


def name(method):
    if not method.startswith("siconos"):
        return method
    for long, short in (("siconos_", "Siconos "), ("ncp_path_search", "path search"), ("_", " ")):
        method = method.replace(long, short)
    return method


def draw_family(axes, rows, title, limit):
    """One step curve a method up to ratio `limit`, each named at its end."""
    ends = []
    for method, (colour, dash) in LOOKS.items():
        own = rows.where(method=method)
        points = [(r, s) for r, s in zip(own.numbers("ratio"), own.numbers("share")) if r <= limit]
        if not points:
            continue
        ratios = [r for r, _ in points] + [limit]
        shares = [s for _, s in points] + [points[-1][1]]
        ours = method in OURS
        # The chain often is its first solver: a wide line that shows behind that one's.
        width, order = (4.0, 2.5) if method == "solver_chain" else (2.0, 3) if ours else (1.4, 2)
        axes.step(ratios, shares, where="post", color=colour, linestyle=dash, linewidth=width, zorder=order)
        ends.append((limit, shares[-1], name(method), colour, dash))
    axes.set_xscale("log")
    axes.set_xlim(1, limit)
    axes.set_ylim(0, 1.03)
    axes.xaxis.set_major_formatter(style.plt.FuncFormatter(lambda value, _: f"{value:g}"))
    axes.set_title(title, loc="left", fontsize=10, pad=9)
    return ends


def profile(table, cost, limit, title, text):
    figure, panels = style.plt.subplots(2, 2, figsize=(13.4, 8.6))
    figure.subplots_adjust(left=0.05, right=0.83, bottom=0.065, top=0.855, wspace=0.68, hspace=0.3)
    for axes, (family, description) in zip(panels.flat, FAMILIES.items()):
        ends = draw_family(axes, table.where(family=family).require_rows(f"family {family}"), description, limit)
        style.label_line_ends(axes, ends, bold=OURS)
        axes.set_xlabel(f"{cost}, over the least of any solver")
        axes.set_ylabel("share of problems solved")
    style.headline(figure, title, text)
    return figure


def iterations(directory):
    return profile(
        read_table(directory / "profile.csv", COLUMNS), "iterations", 100,
        "Solved share of the problems, by iterations beside the best",
        "Performance profiles (Dolan and Moré 2002) over problems that have a solution, from every start. Solved: natural "
        "residual of at most 1e-10, whatever the\nsolver says. Iterations are Newton steps, sweeps (nsgs, admm) or pivots "
        "(lemke); of a chain those of all its stages. A solver stays below 1 where it fails\nor is not for the problem.")


def time(directory):
    """Of a run's own measurement, which is not committed; none where there is no such file."""
    path = directory / "profile_timing.csv"
    if not path.exists():
        return None
    return profile(
        read_table(path, COLUMNS), "processor time", 1000,
        "Solved share of the problems, by processor time beside the fastest",
        "Performance profiles (Dolan and Moré 2002) over problems that have a solution, from every start; as measured in this "
        "run, on one core. Solved: natural\nresidual of at most 1e-10, whatever the solver says. A solver stays below 1 where "
        "it fails or is not for the problem.")


# What a step takes: (method, start, siconos_start, column of the time, name, marker, colour, filled).
MARKS = [
    ("implicit_stepper", "extrapolated", "last", "median_s", "our stepper, all of a step", "s", style.BLACK, True),
    ("elimination", "extrapolated", "extrapolated", "median_s", "elimination from the extrapolated start", "o",
     style.VERMILION, True),
    ("elimination", "last", "last", "median_s", "elimination from the last solution", "o", style.VERMILION, False),
    ("elimination", "extrapolated", "extrapolated", "siconos_median_s",
     "Siconos's fastest that solves every step, from our extrapolated start", "D", style.BLUE, True),
    ("elimination", "last", "last", "siconos_median_s", "the same from the last solution", "D", style.BLUE, False),
]
TRAJECTORY_COLUMNS = ["scenario", "method", "start", "siconos_start", "median_s", "siconos_median_s", "median_ratio"]

# Ratios written beside each scene: (method, start, siconos_start, heading).
RATIOS = [
    ("elimination", "last", "last", "both from the\nlast solution"),
    ("elimination", "extrapolated", "extrapolated", "both from the\nextrapolated start"),
    ("elimination", "extrapolated", "last", "each from\nits own start"),
    ("implicit_stepper", "extrapolated", "last", "our whole step,\ntheir solve alone"),
]


def trajectories(directory):
    """Of a run's own measurement, as time(); none without Siconos either."""
    path = directory / "trajectory_timing.csv"
    if not path.exists():
        return None
    table = read_table(path, TRAJECTORY_COLUMNS)
    scenes = sorted({scene for scene in table.texts("scenario") if scene}, reverse=True)
    figure, axes = style.plt.subplots(figsize=(13.4, 5.4))
    figure.subplots_adjust(left=0.15, right=0.66, bottom=0.26, top=0.76)
    for method, start, theirs, column, name, marker, colour, filled in MARKS:
        rows = table.where(method=method, start=start, siconos_start=theirs)
        points = [(1e6 * value, scenes.index(scene))
                  for scene, value in zip(rows.texts("scenario"), rows.numbers(column)) if scene and value > 0]
        if not points:
            continue
        axes.plot(*zip(*points), marker, color=colour, markerfacecolor=colour if filled else "white", markersize=7.5,
                  markeredgewidth=1.6, label=name)
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter(style.plt.FuncFormatter(lambda value, _: f"{value:g}"))
    axes.set_xlabel("processor time of a step [\u00b5s], median over the steps")
    axes.set_yticks(range(len(scenes)), [scene.replace("_", " ") for scene in scenes])
    axes.set_ylim(-0.6, len(scenes) - 0.4)
    axes.legend(loc="upper left", bbox_to_anchor=(-0.19, -0.15), ncol=2, frameon=False)
    write_ratios(axes, table, scenes)
    style.headline(
        figure, "What an implicit step takes, ours and Siconos's, in one run",
        "Every step of a trajectory at h = 0.01 s, one problem each, solved to a natural residual of 1e-10 by all; the rows are "
        "evaluated by the same code. Siconos: the fastest single\nsolver that solves every step. Our stepper's own time "
        "includes the search for contacts, the start and keeping the solution, at its tolerance of 1e-13.")
    return figure


def write_ratios(axes, table, scenes):
    """Columns right of the axes: Siconos's time over ours."""
    for column, (method, start, theirs, heading) in enumerate(RATIOS):
        x = 1.07 + 0.155 * column
        axes.text(x, 1.03, heading, transform=axes.transAxes, ha="center", va="bottom", fontsize=8.5)
        rows = table.where(method=method, start=start, siconos_start=theirs)
        for scene, ratio in zip(rows.texts("scenario"), rows.numbers("median_ratio")):
            if scene and ratio > 0:
                axes.text(x, scenes.index(scene), f"{ratio:.1f}" if ratio < 10 else f"{ratio:.0f}",
                          transform=axes.get_yaxis_transform(), ha="center", va="center",
                          fontweight="bold" if ratio >= 5 else "normal")
    axes.text(1.07 - 0.06, 1.17, "Siconos's time over ours (bold: 5 and more)", transform=axes.transAxes, ha="left",
              fontsize=9.5, fontweight="bold")
