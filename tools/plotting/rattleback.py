"""A rattleback's spin over time, in both senses."""

from . import style
from .table import read_table

COLUMNS = ["variant", "h_s", "method", "t_s", "spin_rad_s", "roll_rad_s", "pitch_rad_s", "truth_spin_rad_s", "total_J"]
SENSES = {"clockwise": "spun clockwise: turns back once", "counterclockwise": "spun counter-clockwise: goes on"}


def history(directory):
    rows = read_table(directory / "history.csv", COLUMNS).where(method="implicit_ncp")
    figure, panels = style.plt.subplots(2, 2, figsize=(9.6, 6.6), sharex=True, sharey="row",
                                        gridspec_kw=dict(height_ratios=[1.7, 1]))
    figure.subplots_adjust(left=0.075, right=0.985, bottom=0.12, top=0.8, wspace=0.06, hspace=0.12)
    for (spin, rocking), (variant, title) in zip(panels.T, SENSES.items()):
        steps = rows.where(variant=variant).require_rows(f"variant {variant}").groups("h_s")
        finest = steps[0][1]
        for case, look in style.coarse_to_fine(steps):
            spin.plot(case.numbers("t_s"), case.numbers("spin_rad_s"), **look)
        spin.plot(finest.numbers("t_s"), finest.numbers("truth_spin_rad_s"), color=style.VERMILION, linewidth=1.1,
                  label="rolling without slip, exact", zorder=1)
        spin.axhline(0, color="#8A8A8A", linewidth=0.9)
        spin.set_title(title, fontsize=10)
        rocking.plot(finest.numbers("t_s"), finest.numbers("pitch_rad_s"), color=style.BLUE, linewidth=0.6)
        rocking.plot(finest.numbers("t_s"), finest.numbers("roll_rad_s"), color=style.ORANGE, linewidth=0.6)
        rocking.set_xlabel("time t [s]")
    panels[0][0].set_ylabel("spin about the vertical [rad/s]")
    panels[1][0].set_ylabel(f"rocking [rad/s]\n(h = {1000 * steps[0][0]:g} ms)")
    panels[1][1].text(0.015, 0.93, "about the short axis", transform=panels[1][1].transAxes, color=style.BLUE,
                      fontsize=style.LABEL_POINTS, va="top")
    panels[1][1].text(0.015, 0.07, "about the long axis", transform=panels[1][1].transAxes, color="#9A6700",
                      fontsize=style.LABEL_POINTS)
    style.legend_below(figure, panels[0][0], columns=5)
    style.headline(figure, "A rattleback turns back in one sense only",
                   "Implicit NCP, no torsion, enough friction to roll. The spin goes into rocking, and out of it into the "
                   "other sense. A step takes\nenergy out of the rocking, so the spin that comes back is less than the "
                   "rolling body's, and grows towards it as h falls.")
    return figure
