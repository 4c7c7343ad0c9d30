"""A coin that rolls about its centre: inclination, precession and energy, and the family of steady motions."""

import math

from . import style
from .table import read_table

COLUMNS = ["variant", "h_s", "method", "t_s", "inclination_rad", "precession_rad_s", "steady_precession_rad_s",
           "contact_spin_rad_s", "total_J", "friction_loss_J", "energy_drift_J"]


def known(xs, ys):
    """The pairs in which both are numbers."""
    pairs = [(x, y) for x, y in zip(xs, ys) if not (math.isnan(x) or math.isnan(y))]
    return [x for x, _ in pairs], [y for _, y in pairs]


def history(directory):
    rows = read_table(directory / "history.csv", COLUMNS).where(method="implicit_ncp", variant="rolling")
    rows.require_rows("variant rolling")
    steps = rows.groups("h_s")
    figure, panels = style.plt.subplots(2, 2, figsize=(9.6, 7.0))
    figure.subplots_adjust(left=0.08, right=0.985, bottom=0.115, top=0.83, wspace=0.22, hspace=0.3)
    (inclination, precession), (energy, family) = panels
    for case, look in style.coarse_to_fine(steps):
        degrees = [math.degrees(a) for a in case.numbers("inclination_rad")]
        inclination.plot(case.numbers("t_s"), degrees, **look)
        precession.plot(*known(case.numbers("t_s"), case.numbers("precession_rad_s")), **look)
        energy.plot(case.numbers("t_s"), case.numbers("total_J"), **look)
        family.plot(*known(degrees, case.numbers("precession_rad_s")), **look)
    coarsest = steps[-1][1]
    truth = coarsest.where(t_s=0.0)
    start = dict(inclination=math.degrees(truth.numbers("inclination_rad")[0]),
                 precession=truth.numbers("steady_precession_rad_s")[0], energy=truth.numbers("total_J")[0])
    exact = dict(color="black", linewidth=1.2, linestyle=(0, (1, 1.4)), zorder=1)
    for axes, key in ((inclination, "inclination"), (precession, "precession"), (energy, "energy")):
        axes.axhline(start[key], label="nothing lost: for ever as at the start", **exact)
        axes.set_xlabel("time t [s]")
        axes.set_ylim(0, None)
    precession.set_ylim(0, 60)
    inclination.set_ylabel("inclination [degrees]")
    precession.set_ylabel("precession rate [rad/s]")
    energy.set_ylabel("energy [J]")
    family.plot(*known([math.degrees(a) for a in coarsest.numbers("inclination_rad")],
                       coarsest.numbers("steady_precession_rad_s")), color=style.VERMILION, linewidth=4.5, alpha=0.45,
                zorder=1, label="steady motion at that inclination")
    family.set_xlim(left=0)
    family.set_ylim(0, 60)
    family.set_xlabel("inclination [degrees]")
    family.set_ylabel("precession rate [rad/s]")
    family.legend(handles=[family.lines[-1]], frameon=False, fontsize=style.LABEL_POINTS)
    style.legend_below(figure, inclination, columns=5)
    style.headline(figure, "Euler's disc: what a step takes makes the coin sink through steady motions",
                   "Implicit NCP, no torsion. Without loss the coin rolls for ever as it started. A step takes energy in "
                   "proportion to h, so the\ncoin comes down as a real one does, round faster and faster, and keeps to "
                   "the closed form of steady rolling on its way.")
    return figure


def torsion(directory):
    rows = read_table(directory / "history.csv", COLUMNS).where(method="implicit_ncp", variant="torsion")
    rows.require_rows("variant torsion")
    steps = rows.groups("h_s")
    figure, [[spin, energy]] = style.new_figure(9.4, 4.3, panels=2)
    figure.subplots_adjust(left=0.08, right=0.985, bottom=0.225, top=0.77, wspace=0.2)
    for case, look in style.coarse_to_fine(steps):
        spin.plot(case.numbers("t_s"), case.numbers("contact_spin_rad_s"), **look)
        energy.plot(case.numbers("t_s"), case.numbers("friction_loss_J"), **look)
    spin.set_ylabel("turn about the contact's normal [rad/s]")
    energy.set_ylabel("energy lost to torsion [J]")
    for axes in (spin, energy):
        axes.set_xlabel("time t [s]")
    style.legend_below(figure, spin, columns=4)
    style.headline(figure, "A friction torque stops the coin's turn about its contact, and then takes nothing more",
                   "Implicit NCP, e_r = 0.05 m. Once the coin no longer turns about the contact's normal it rolls round "
                   "a circle without loss,\nexcept for what the step takes.")
    return figure
