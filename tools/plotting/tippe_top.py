"""A tippe top: inclination, spin, energy and Jellett's constant over time."""

import math

from . import style
from .table import read_table

COLUMNS = ["variant", "h_s", "method", "t_s", "inclination_rad", "spin_vertical_rad_s", "spin_axis_rad_s", "slip_m_s",
           "jellett_kg_m2_s", "total_J", "friction_loss_J"]


def history(directory):
    rows = read_table(directory / "history.csv", COLUMNS).where(method="implicit_ncp")
    steps = rows.where(variant="vertical").require_rows("variant vertical").groups("h_s")
    finest = steps[0][1]
    figure, panels = style.plt.subplots(2, 2, figsize=(9.6, 7.0), sharex=True)
    figure.subplots_adjust(left=0.08, right=0.985, bottom=0.115, top=0.83, wspace=0.22, hspace=0.14)
    (inclination, jellett), (spin, energy) = panels
    for case, look in style.coarse_to_fine(steps):
        times = case.numbers("t_s")
        inclination.plot(times, [math.degrees(a) for a in case.numbers("inclination_rad")], **look)
        values = case.numbers("jellett_kg_m2_s")
        jellett.plot(times, [100 * (value / values[0] - 1) for value in values], **look)
    control = rows.where(variant="axis", h_s=steps[0][0]).require_rows("variant axis")
    inclination.plot(control.numbers("t_s"), [math.degrees(a) for a in control.numbers("inclination_rad")],
                     color=style.VERMILION, linewidth=1.4, linestyle=(0, (1, 1.2)))
    inclination.axhline(90, color="#8A8A8A", linewidth=0.8)
    inclination.text(0.99, 0.065, "spun about its own axis: rolls, stays up", transform=inclination.transAxes,
                     ha="right", color=style.VERMILION, fontsize=style.LABEL_POINTS)
    inclination.set_ylabel("inclination of the axis [degrees]")
    inclination.set_ylim(0, 180)
    inclination.set_yticks([0, 45, 90, 135, 180])
    jellett.axhline(0, color="black", linewidth=1.2, linestyle=(0, (1, 1.4)), zorder=1)
    jellett.set_ylabel("Jellett's constant, change [%]")
    times = finest.numbers("t_s")
    spin.plot(times, finest.numbers("spin_vertical_rad_s"), color=style.BLACK)
    spin.plot(times, finest.numbers("spin_axis_rad_s"), color=style.BLUE, linestyle=style.DASHES[1])
    spin.text(0.98, 0.86, "about the vertical", transform=spin.transAxes, ha="right", fontsize=style.LABEL_POINTS)
    spin.text(0.98, 0.16, "about its own axis", transform=spin.transAxes, ha="right",
              color=style.BLUE, fontsize=style.LABEL_POINTS)
    spin.axhline(0, color="#8A8A8A", linewidth=0.8)
    spin.set_ylabel(f"spin [rad/s], h = {1000 * steps[0][0]:g} ms")
    totals = finest.numbers("total_J")
    energy.plot(times, [1000 * value for value in totals], color=style.BLACK)
    energy.plot(times, [1000 * value for value in finest.numbers("friction_loss_J")], color=style.ORANGE,
                linestyle=style.DASHES[1])
    energy.text(0.98, 0.66, "total energy", transform=energy.transAxes, ha="right", fontsize=style.LABEL_POINTS)
    energy.text(0.98, 0.29, "lost to friction", transform=energy.transAxes, ha="right", color="#9A6700",
                fontsize=style.LABEL_POINTS)
    energy.set_ylim(0, None)
    energy.set_ylabel(f"energy [mJ], h = {1000 * steps[0][0]:g} ms")
    for axes in (spin, energy):
        axes.set_xlabel("time t [s]")
    style.legend_below(figure, jellett, columns=4)
    style.headline(figure, "A tippe top turns over; Jellett's constant is kept to first order in the step",
                   "Implicit NCP, mu = 0.2, no torsion, spun at 200 rad/s about the vertical with its axis tilted by 0.1 "
                   "rad. Friction at the sliding\ncontact lifts the centre of mass; halving the step halves the change of "
                   "Jellett's constant.")
    return figure
