"""Thresholds of a box on an incline: what the implicit NCP and every other method say in each cell of the map."""

import numpy as np

from . import style
from .table import read_table

REFERENCE = "implicit_ncp"
APART = 0.035  # how far from its threshold a cell beside it is drawn, of the width of the panel
COLUMNS = ["method", "space", "aspect", "tangent", "mu", "threshold", "offset", "status", "truth_mode", "release_mode",
           "release_right", "end_mode", "end_right"]

# Regions of the truth and the marker of each mode, in the order in which they are explained.
MODES = {
    "rests": dict(label="rests", region="#F2F2F2", marker="s", color=style.GREY),
    "slides": dict(label="slides", region="#D6EAF6", marker="o", color=style.BLUE),
    "tips": dict(label="tips over its lower edge", region="#FBE7C6", marker="^", color=style.VERMILION),
    "tips_and_slides": dict(label="tips and slides", region="#F1DDE9", marker="D", color=style.PURPLE),
}


def tip_in_place(k, tangent):
    """Friction above which the block that tips does not slide at once."""
    return (tangent * (k * k + 0.25) + 0.75 * k) / (1 + 0.25 * k * k + 0.75 * k * tangent)


def truth_map(k, tangent, mu):
    """Index in MODES of the closed thresholds, for arrays."""
    rests = (tangent <= mu) & (tangent <= k)
    slides = ~rests & ((tangent <= k) | (mu <= k))
    in_place = ~rests & ~slides & (mu >= tip_in_place(k, tangent))
    return np.select([rests, slides, in_place], [0, 1, 2], 3)


def draw_regions(axes, k, limit):
    grid = np.linspace(0, limit, 801)
    tangent, mu = np.meshgrid(grid, grid)
    regions = truth_map(k, tangent, mu)
    axes.contourf(tangent, mu, regions, levels=[-0.5, 0.5, 1.5, 2.5, 3.5], zorder=0,
                  colors=[mode["region"] for mode in MODES.values()])
    axes.contour(tangent, mu, regions, levels=[0.5, 1.5, 2.5], colors="#8A8A8A", linewidths=0.8, zorder=1)
    axes.set_xlim(0, limit)
    axes.set_ylim(0, limit)
    axes.grid(False)


def places(cells, limit):
    """Where cells are drawn: those beside a threshold moved away from it, so that its two sides can be told apart."""
    drawn = []
    for k, tangent, mu, threshold, offset in zip(cells.numbers("aspect"), cells.numbers("tangent"), cells.numbers("mu"),
                                                 cells.texts("threshold"), cells.numbers("offset")):
        apart = APART * limit
        if (threshold == "slide_tip" and offset > 0) or (threshold == "tip_slide" and offset < 0):
            apart = min(apart, 0.3 * (tip_in_place(k, tangent) - k))  # stay within the strip between the two
        if threshold == "tip_in_place":
            tangent += np.copysign(apart, offset)
        elif threshold:
            mu += np.copysign(apart, offset)
        drawn.append((tangent, mu))
    return drawn


def threshold_map(directory):
    rows = read_table(directory / "summary.csv", COLUMNS).where(method=REFERENCE, space="space")
    rows.require_rows(f"method {REFERENCE}, space space")
    aspects = rows.groups("aspect")
    figure, [panels] = style.new_figure(4.0 * len(aspects) + 0.5, 5.6, panels=len(aspects), sharey=True)
    figure.subplots_adjust(left=0.06, right=0.985, bottom=0.185, top=0.77, wspace=0.06)
    limit = max(rows.numbers("tangent") + rows.numbers("mu")) * 1.06
    for axes, (k, cells) in zip(panels, aspects):
        draw_regions(axes, k, limit)
        for name, mode in MODES.items():
            found = cells.where(release_mode=name)
            for threshold in (False, True):
                chosen = [place for place, beside in zip(places(found, limit), found.texts("threshold"))
                      if bool(beside) == threshold]
                axes.plot([t for t, _ in chosen], [m for _, m in chosen], linestyle="none", zorder=4,
                          marker=mode["marker"], markersize=4.5 if threshold else 6.5, color=mode["color"],
                          markerfacecolor="white" if threshold else mode["color"], markeredgewidth=1.1,
                          label=None if threshold or k != aspects[0][0] else mode["label"])
        wrong = [place for place, right in zip(places(cells, limit), cells.numbers("release_right")) if right != 1]
        axes.plot([t for t, _ in wrong], [m for _, m in wrong], linestyle="none", marker="x", markersize=11,
                  color="black", markeredgewidth=2.2, zorder=6)
        axes.set_title(f"length / height = {k:g}: {len(cells) - len(wrong)} of {len(cells)} right", fontsize=10)
        axes.set_xlabel("slope, tan $\\theta$")
    panels[0].set_ylabel("coefficient of friction $\\mu$")
    panels[0].plot([], [], linestyle="none", marker="s", markersize=4.5, color=style.GREY, markerfacecolor="white",
                   label="hollow: 0.05 % beside a threshold (drawn apart)")
    style.legend_below(figure, panels[0], columns=5)
    style.headline(figure, "A box on an incline stays, slides or tips on the right side of every threshold",
                   "Areas: the mode that the equations of plane motion allow when the box is let go. Marks: what the "
                   "implicit NCP, in space and with a\nsingle flat contact, makes of it after five steps of 1 ms.")
    return figure


def wrong_cells(directory):
    """For each method the cells on the wrong side, over slope and friction, all aspect ratios together."""
    rows = read_table(directory / "summary.csv", COLUMNS)
    methods = sorted({(method, space) for method, space in zip(rows.texts("method"), rows.texts("space"))})
    columns = 6
    lines = -(-len(methods) // columns)
    figure, grid = style.plt.subplots(lines, columns, figsize=(2.15 * columns, 2.3 * lines + 1.6), squeeze=False,
                                      sharex=True, sharey=True)
    figure.subplots_adjust(left=0.055, right=0.985, bottom=0.11, top=1 - 1.35 / (2.3 * lines + 1.6), wspace=0.08,
                           hspace=0.33)
    for axes in grid.flat[len(methods):]:
        axes.set_visible(False)
    for axes, (method, space) in zip(grid.flat, methods):
        draw_wrong_panel(axes, rows.where(method=method, space=space), method, space)
    for axes in grid[:, 0]:
        axes.set_ylabel("$\\mu$ / k")
    for i, axes in enumerate(grid.flat[:len(methods)]):
        if i + columns >= len(methods):
            axes.set_xlabel("tan $\\theta$ / k")
            axes.tick_params(labelbottom=True)
    style.legend_below(figure, grid[0][0], columns=4)
    style.headline(figure, "Who is wrong where: cells of the map in which a method's box does what it should not",
                   "60 ms after the box is let go: does it rest, slide or tip? All aspect ratios k = length / height in "
                   "one panel, slope and friction over k.\nGrey lines are the thresholds. In the upper left the box "
                   "should rest; soft contacts and friction solved by few iterations creep there.")
    return figure


def draw_wrong_panel(axes, rows, method, space):
    limit = 4.5
    axes.plot([0, 1], [0, 1], color="#B0B0B0", linewidth=1.0, zorder=1)
    axes.plot([1, 1], [1, limit], color="#B0B0B0", linewidth=1.0, zorder=1)
    axes.plot([1, limit], [1, 1], color="#B0B0B0", linewidth=1.0, zorder=1)
    looks = {
        "right": dict(marker="o", markersize=2.2, color="#9A9A9A", label="right"),
        "moves": dict(marker="x", markersize=5.5, color=style.VERMILION, markeredgewidth=1.5,
                      label="wrong: moves, should rest"),
        "other": dict(marker="D", markersize=4.2, color=style.BLUE, markerfacecolor="none", markeredgewidth=1.3,
                      label="wrong: another motion, or rests"),
        "failed": dict(marker="s", markersize=5.0, color="black", markerfacecolor="none", label="step failed"),
    }
    points = {name: [] for name in looks}
    for k, t, m, status, truth, right in zip(rows.numbers("aspect"), rows.numbers("tangent"), rows.numbers("mu"),
                                             rows.texts("status"), rows.texts("truth_mode"), rows.texts("end_right")):
        name = "right" if right == "1" else "moves" if truth == "rests" else "other"
        points["failed" if status == "failed" else name].append((t / k, m / k))
    axes.set_xlim(0, limit)
    axes.set_ylim(0, limit)
    axes.set_xticks([0, 1, 2, 3, 4])
    axes.set_yticks([0, 1, 2, 3, 4])
    name = f"{method}, plane" if space == "plane" else method
    if set(rows.texts("status")) == {"unsupported"}:
        axes.set_title(f"{name}\n", fontsize=8.5)
        axes.text(0.5, 0.5, "has no boxes", transform=axes.transAxes, ha="center", color=style.GREY)
        points = {name: [] for name in looks}
    else:
        wrong = sum(len(found) for kind, found in points.items() if kind != "right")
        axes.set_title(f"{name}\n{wrong} of {len(rows)} wrong", fontsize=8.5,
                       fontweight="bold" if wrong == 0 else "normal")
    for kind, look in looks.items():
        axes.plot([x for x, _ in points[kind]], [y for _, y in points[kind]], linestyle="none", zorder=3, **look)
