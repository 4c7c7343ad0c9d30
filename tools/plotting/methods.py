"""How each method is drawn wherever several are compared: one hue a family, markers and fill within it."""

import math

from . import style

FILLED = dict(markersize=6.0, markeredgecolor="white", markeredgewidth=0.5)
HOLLOW = dict(markersize=6.0, markerfacecolor="none", markeredgewidth=1.3)

# key -> (label, look). A method of the tables that is not here is drawn in grey under its key.
LOOKS = {
    "implicit_ncp": ("implicit NCP", dict(color=style.BLACK, marker="o", linewidth=2.2, zorder=6, **FILLED)),
    "implicit_ncp_extrapolated": ("implicit NCP, extrapolated",
                                  dict(color=style.BLACK, marker="D", linestyle=(0, (4, 1.5)), zorder=6, **HOLLOW)),
    "stewart_trinkle": ("Stewart-Trinkle LCP", dict(color=style.VERMILION, marker="s", zorder=5, **FILLED)),
    "ode_step": ("ODE, Step", dict(color=style.GREEN, marker="X", **FILLED)),
    "ode_quickstep": ("ODE, QuickStep", dict(color=style.GREEN, marker="X", linestyle=(0, (4, 1.5)), **HOLLOW)),
    "mujoco_elliptic": ("MuJoCo, elliptic", dict(color=style.PURPLE, marker="v", **FILLED)),
    "mujoco_elliptic_stiff": ("MuJoCo, elliptic, stiff",
                              dict(color=style.PURPLE, marker="v", linestyle=(0, (4, 1.5)), **HOLLOW)),
    "mujoco_pyramidal": ("MuJoCo, pyramidal", dict(color=style.ORANGE, marker="^", **FILLED)),
    "mujoco_pyramidal_stiff": ("MuJoCo, pyramidal, stiff",
                               dict(color=style.ORANGE, marker="^", linestyle=(0, (4, 1.5)), **HOLLOW)),
    "bullet_si": ("Bullet, SI", dict(color=style.BLUE, marker="P", **FILLED)),
    "bullet_nncg": ("Bullet, NNCG", dict(color=style.BLUE, marker="P", linestyle=(0, (4, 1.5)), **HOLLOW)),
    "bullet_si_float": ("Bullet, SI, single precision",
                        dict(color=style.SKY, marker="*", linestyle=(0, (1.6, 1.1)), **FILLED)),
}


def present(table):
    """(label, look, rows) of every method with rows, in the order of LOOKS, then others by name."""
    names = sorted(set(table.texts("method")), key=lambda name: (rank(name), name))
    return [(*look_of(name), table.where(method=name)) for name in names]


def rank(name):
    return list(LOOKS).index(name) if name in LOOKS else len(LOOKS)


def look_of(name):
    return LOOKS.get(name, (name, dict(color=style.GREY, marker=".", linestyle=(0, (1.6, 1.1)))))


def order_guides(axes, steps, anchors):
    """Grey lines of the slopes h and h^2, each labelled half way.

    @param steps    [s]; the guides run from the smallest to the largest
    @param anchors  {order: (value at the largest step, "above" or "below" for the label)}
    """
    low, high = min(steps), max(steps)
    middle = math.sqrt(low * high)
    for order, (value, side) in anchors.items():
        axes.plot([low, high], [value * (low / high) ** order, value], color="#9A9A9A", linewidth=1.0,
                  linestyle=(0, (2, 2)), zorder=1)
        above = side == "above"
        axes.annotate(f"order {order}", (middle, value * (middle / high) ** order),
                      xytext=(-4, 3) if above else (5, -3), textcoords="offset points", fontsize=style.LABEL_POINTS, color="#5A5A5A",
                      ha="right" if above else "left", va="bottom" if above else "top")


def step_ticks(axes, steps):
    """The steps themselves as ticks, in milliseconds."""
    axes.set_xscale("log")
    axes.set_xticks(sorted(steps), [f"{1000 * step:g}" for step in sorted(steps)])
    axes.minorticks_off()
    axes.set_xlabel("step h [ms]")
