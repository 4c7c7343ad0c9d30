"""How every figure of this project looks: colour-blind safe, readable in grey, the same bytes on every run."""

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen first)

# Okabe and Ito's palette: eight colours that people with any common colour blindness tell apart.
BLACK = "#000000"
ORANGE = "#E69F00"
SKY = "#56B4E9"
GREEN = "#009E73"
BLUE = "#0072B2"
VERMILION = "#D55E00"
PURPLE = "#CC79A7"
GREY = "#6E6E6E"

# Neighbouring curves differ by dash as well as by shade, so that a grey print still tells them apart.
DASHES = ["-", (0, (6, 1.5)), (0, (4, 1.2, 1, 1.2)), (0, (1.6, 1.1))]

LABEL_POINTS = 9.0


def apply():
    """Sets matplotlib's parameters, whatever the reader's own configuration says."""
    matplotlib.rcdefaults()
    matplotlib.use("Agg")
    matplotlib.rcParams.update({
        "svg.hashsalt": "touchstone",
        "svg.fonttype": "path",
        "font.family": "DejaVu Sans",
        "font.size": 9.5,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.edgecolor": "#444444",
        "axes.grid": True,
        "axes.axisbelow": True,
        "grid.color": "#E4E4E4",
        "grid.linewidth": 0.7,
        "lines.linewidth": 1.6,
        "lines.solid_capstyle": "butt",
        "xtick.color": "#444444",
        "ytick.color": "#444444",
        "xtick.labelcolor": "black",
        "ytick.labelcolor": "black",
        "savefig.facecolor": "white",
    })


def shades(count):
    """`count` colours of an ordered quantity, light to dark, even in lightness (viridis without its pale end)."""
    viridis = matplotlib.colormaps["viridis"]
    return [matplotlib.colors.to_hex(viridis(0.84 * (1 - i / max(count - 1, 1)))) for i in range(count)]


def new_figure(width, height, panels=1, **subplot_options):
    """A figure of `panels` axes side by side, [inches]."""
    return plt.subplots(1, panels, figsize=(width, height), squeeze=False, **subplot_options)


def headline(figure, title, text):
    """What the reader should see, in bold, and below it the setting in plain words; both at the left edge.

    The title is also the label of the figure, which output.render writes into the files.
    """
    figure.set_label(title)
    figure.text(0.012, 0.985, title, ha="left", va="top", fontsize=12.5, fontweight="bold")
    offset = 0.30 / figure.get_figheight()
    figure.text(0.012, 0.985 - offset, text, ha="left", va="top", fontsize=9.5, color="#333333", linespacing=1.35)


def coarse_to_fine(steps):
    """(rows, look) of each step, the largest first: a shade, a dash and a label each.

    @param steps  [(h in s, rows)], ascending
    """
    for i, ((step, rows), colour) in enumerate(zip(reversed(steps), shades(len(steps)))):
        yield rows, dict(color=colour, linestyle=DASHES[i % len(DASHES)], label=f"h = {1000 * step:g} ms")


def legend_below(figure, axes, columns):
    """The labels of `axes` as one legend of the figure, below its panels."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=columns, frameon=False, fontsize=LABEL_POINTS)


def spread(positions, gap, low, high):
    """The positions moved as little as an ordered pass allows so that neighbours are `gap` apart, in [low, high].

    Blocks of labels that would overlap are merged and centred on the mean of what they label.
    """
    order = sorted(range(len(positions)), key=lambda i: positions[i])
    blocks = []  # [members, centre]
    for i in order:
        blocks.append([[i], positions[i]])
        while True:
            for block in blocks:
                half = 0.5 * gap * (len(block[0]) - 1)
                block[1] = min(max(block[1], low + half), high - half)
            if len(blocks) < 2:
                break
            (below, below_centre), (above, above_centre) = blocks[-2], blocks[-1]
            if above_centre - below_centre >= 0.5 * gap * (len(below) + len(above)):
                break
            members = below + above
            blocks[-2:] = [[members, sum(positions[j] for j in members) / len(members)]]
    placed = [0.0] * len(positions)
    for members, centre in blocks:
        for rank, i in enumerate(members):
            placed[i] = centre + gap * (rank - 0.5 * (len(members) - 1))
    return placed


def label_line_ends(axes, ends, bold=()):
    """Writes each text at the right of the axes, beside the end of its curve, without overlaps.

    @param ends  (x, y, text, colour, dash) a curve, in data coordinates; axes limits must be final
    @param bold  texts to be set in bold
    """
    figure = axes.figure
    height_points = axes.get_position().height * figure.get_figheight() * 72.0
    gap = 1.45 * LABEL_POINTS / height_points
    to_axes = axes.transData + axes.transAxes.inverted()
    points = [to_axes.transform((x, y)) for x, y, *_ in ends]
    heights = spread([y for _, y in points], gap, 0.0, 1.03)
    for (x, y), height, (_, _, text, colour, dash) in zip(points, heights, ends):
        axes.plot([x, x + 0.012, 1.045, 1.06], [y, y, height, height], transform=axes.transAxes, clip_on=False,
                  color=colour, linewidth=0.9, solid_joinstyle="round")
        axes.plot([1.06, 1.105], [height, height], transform=axes.transAxes, clip_on=False, color=colour,
                  linestyle=dash, linewidth=2.0)
        axes.text(1.115, height, text, transform=axes.transAxes, va="center", ha="left", fontsize=LABEL_POINTS,
                  fontweight="bold" if text in bold else "normal")
