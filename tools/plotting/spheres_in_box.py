"""Many contacts: time of a step and memory over the number of contacts, as measured by spheres_in_box_scaling."""

from . import style
from .table import read_table

COLUMNS = ["spheres", "contacts", "step_s", "slowest_step_s", "memory_bytes", "exponent"]
FIRST_OF_FIT = 30  # spheres, as spheres_in_box_scaling has it


def scaling(directory):
    rows = read_table(directory / "scaling.csv", COLUMNS).require_rows("measured times")
    spheres, contacts = rows.numbers("spheres"), rows.numbers("contacts")
    times, slowest = rows.numbers("step_s"), rows.numbers("slowest_step_s")
    megabytes = [value / 1e6 for value in rows.numbers("memory_bytes")]
    exponent = rows.numbers("exponent")[0]
    figure, panels = style.new_figure(9.6, 4.9, 2)
    figure.subplots_adjust(left=0.085, right=0.985, bottom=0.13, top=0.80, wspace=0.24)
    time, memory = panels[0]
    time.loglog(contacts, times, "o", color=style.BLUE, label="median of the second half of the steps", zorder=3)
    time.loglog(contacts, slowest, "^", color=style.ORANGE, markersize=5, label="slowest of them", zorder=3)
    fitted = [(c, t) for n, c, t in zip(spheres, contacts, times) if n >= FIRST_OF_FIT]
    reference = fitted[-1]
    ends = [fitted[0][0], fitted[-1][0]]
    middle = 1.0
    for c, t in fitted:
        middle *= (t / c ** exponent) ** (1 / len(fitted))
    time.loglog(ends, [middle * c ** exponent for c in ends], color=style.BLUE,
                label=f"least squares, exponent {exponent:.2f}")
    time.loglog(ends, [reference[1] * (c / reference[0]) ** 1.2 for c in ends], color=style.GREY,
                linestyle=style.DASHES[1], linewidth=1.1, label="exponent 1.2, through the last")
    for n, c, t in zip(spheres, contacts, times):
        time.annotate(f"n = {n:g}", (c, t), xytext=(-7, -3), textcoords="offset points", fontsize=8, ha="right")
    time.set_xlabel("contacts with an impulse")
    time.set_ylabel("processor time of a step [s]")
    time.set_xlim(contacts[0] / 2.5, contacts[-1] * 1.5)  # room for the labels, left of their points
    time.legend(frameon=False, fontsize=style.LABEL_POINTS, loc="upper left")
    memory.loglog(contacts, megabytes, "o-", color=style.GREEN)
    memory.set_xlabel("contacts with an impulse")
    memory.set_ylabel("largest resident set [MB]")
    style.headline(figure, f"Time of a step grows with the number of contacts to the power {exponent:.2f}",
                   "Spheres that fall together in a box, implicit NCP, h = 0.01 s, every step solved to 1e-13. The box grows "
                   "in all\ndirections, so that the heap is as deep as it is wide.")
    return figure
