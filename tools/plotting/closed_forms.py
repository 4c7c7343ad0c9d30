"""Methods against motions in closed form: error and order, a cell for each method and scenario."""

import math

import matplotlib
from matplotlib.colors import LogNorm, Normalize
from matplotlib.patches import Rectangle

from . import style
from .table import read_table

OURS = ["implicit_ncp", "stewart_trinkle"]
LEAST, MOST = 1e-8, 1.0  # of the colours of relative errors
MARKS = {"unsupported": "–", "failed": "×"}


def read_summary(directory):
    columns = ["scenario", "method", "dimension", "h_s", "status", "observed_order", "relative_error"]
    return read_table(directory / "summary.csv", columns).require_rows("any case")


def method_order(method):
    return method not in OURS, method


def short(error):
    """One digit and the exponent: 3e-4; what is rounding alone: 0."""
    if error < 1e-9:
        return "0"
    exponent = math.floor(math.log10(error))
    digit = round(error / 10.0**exponent)
    if digit == 10:
        digit, exponent = 1, exponent + 1
    return f"{digit}e{exponent}"


def text_colour(colour):
    red, green, blue, _ = colour
    return "black" if 0.299 * red + 0.587 * green + 0.114 * blue > 0.5 else "white"


def draw_cell(axes, column, line, text, colour=None):
    if colour is not None:
        axes.add_patch(Rectangle((column - 0.5, line - 0.5), 1, 1, facecolor=colour, edgecolor="white", linewidth=1.2))
    ink = style.GREY if colour is None else text_colour(colour)
    axes.text(column, line, text, ha="center", va="center", fontsize=7.6, color=ink)


def cell_map(directory, quantity, paint, title, text, scale, scale_label):
    """One panel a dimension; `paint(row)` gives text and colour of a case that ran."""
    table = read_summary(directory)
    methods = sorted(set(table.texts("method")), key=method_order)
    scenarios = {dimension: sorted(set(table.where(dimension=float(dimension)).texts("scenario"))) for dimension in (2, 3)}
    figure, [panels] = style.new_figure(
        12.2, 7.2, panels=2, sharey=True, gridspec_kw={"width_ratios": [len(scenarios[2]), len(scenarios[3])]})
    figure.subplots_adjust(left=0.175, right=0.925, bottom=0.13, top=0.83, wspace=0.03)
    for axes, dimension in zip(panels, (2, 3)):
        for _, row in table.where(dimension=float(dimension)).rows:
            column, line = scenarios[dimension].index(row["scenario"]), methods.index(row["method"])
            if row["status"] == "ok":
                draw_cell(axes, column, line, *paint(row))
            else:
                draw_cell(axes, column, line, MARKS.get(row["status"], "?"))
        axes.set_xlim(-0.5, len(scenarios[dimension]) - 0.5)
        axes.set_ylim(len(methods) - 0.5, -0.5)
        axes.set_xticks(range(len(scenarios[dimension])), scenarios[dimension], rotation=38, ha="right")
        axes.set_yticks(range(len(methods)), methods)
        axes.grid(False)
        axes.tick_params(length=0)
        for spine in axes.spines.values():
            spine.set_visible(False)
        axes.set_title("in the plane" if dimension == 2 else "in space", fontsize=10.5)
    bar = figure.colorbar(scale, ax=panels, cax=figure.add_axes((0.94, 0.13, 0.012, 0.70)))
    bar.set_label(scale_label)
    bar.outline.set_visible(False)
    style.headline(figure, title, text)
    return figure


def error(directory):
    scale = matplotlib.cm.ScalarMappable(LogNorm(LEAST, MOST), matplotlib.colormaps["viridis_r"])
    step = max(read_summary(directory).numbers("h_s"))

    def paint(row):
        value = float(row["relative_error"])
        return short(value), scale.to_rgba(min(max(value, LEAST), MOST))

    return cell_map(
        directory, "relative_error", paint, "How far from the closed form, of the size of the motion",
        f"Largest relative error of position, orientation and final velocity over 1 s at h = {step:g} s; dark is far off. "
        "0: rounding alone; –: the method cannot\nrepresent it; ×: a step failed; blank: it is planar. First-order stepping gives about h. "
        "In space the motion is at 30° to every axis, which shows friction boxes and pyramids.",
        scale, "relative error")


def order(directory):
    scale = matplotlib.cm.ScalarMappable(Normalize(0.0, 2.0), matplotlib.colormaps["cividis"])

    def paint(row):
        if not row["observed_order"]:
            return "=", (0.93, 0.93, 0.93, 1.0)
        value = float(row["observed_order"])
        return f"{value:.1f}".replace("-0.0", "0.0"), scale.to_rgba(min(max(value, 0.0), 2.0))

    return cell_map(
        directory, "observed_order", paint, "Which errors vanish as the step falls",
        "Slope of log(error) over log(h), h from 0.02 to 0.0025 s: 1 is first order, 2 second; about 0 is an error that "
        "smaller steps do not mend. =: rounding alone;\n–: the method cannot represent it; ×: a step failed; blank: "
        "the method is planar.",
        scale, "observed order")
