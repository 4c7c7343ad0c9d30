"""Figures 3 and 4 of the paper, a sphere that torsional friction stops, and how far every method is from it."""

from . import methods, style
from .table import read_table

PAPER_STEP = 0.07  # [s]
FINE_STEP = 0.01  # [s]; at which the closed form is drawn
VELOCITIES = {"wz_rad_s": "spin", "vx_m_s": "v_x", "vy_m_s": "v_y", "vz_m_s": "v_z", "wx_rad_s": "w_x",
              "wy_rad_s": "w_y"}


def read_trajectories(directory):
    return read_table(directory / "trajectory.csv", ["method", "h_s", "t_s", *VELOCITIES, "tangent_x_N", "tangent_y_N",
                                                     "torsion_Nm"])


def reference(trajectories):
    """(the implicit NCP at the paper's step, the closed form at a fine one)."""
    return (trajectories.where(method="implicit_ncp", h_s=PAPER_STEP).require_rows("implicit_ncp at h = 0.07"),
            trajectories.where(method="closed_form", h_s=FINE_STEP).require_rows("closed_form at h = 0.01"))


def figure_3(directory):
    trajectories = read_trajectories(directory)
    ncp, truth = reference(trajectories)
    figure, [[left, right]] = style.new_figure(11.0, 4.9, panels=2)
    figure.subplots_adjust(left=0.065, right=0.775, bottom=0.115, top=0.79, wspace=0.28)
    left.plot(truth.numbers("t_s"), truth.numbers("wz_rad_s"), color=style.ORANGE, linewidth=3.4,
              label="closed form of the spin")
    left.plot(ncp.numbers("t_s"), ncp.numbers("wz_rad_s"), color=style.BLACK, marker="o", markersize=4, linewidth=1.2,
              label="spin, implicit NCP")
    for column in list(VELOCITIES)[1:]:
        left.plot(ncp.numbers("t_s"), ncp.numbers(column), color=style.BLUE, linestyle=(0, (4, 1.5)), linewidth=1.2,
                  label="the other five velocities" if column == "vx_m_s" else None)
    left.set_ylabel("velocity [rad/s, m/s]")
    left.legend(frameon=False, loc="upper right", fontsize=style.LABEL_POINTS)
    draw_deviations(right, trajectories)
    right.set_ylabel("spin less its closed form [rad/s]")
    right.legend(frameon=False, loc="center left", bbox_to_anchor=(1.02, 0.5), fontsize=style.LABEL_POINTS)
    for axes in (left, right):
        axes.set_xlim(0, max(ncp.numbers("t_s")))
        axes.set_xlabel("time t [s]")
    style.headline(figure, "Torsional friction stops the sphere at 1 s, and a step of 0.07 s says so at 1.05 s",
                   "Example 2, Fig. 3 of the paper, h = 0.07 s. Left: the spin falls by 1.962 h a step, the last one "
                   "to exactly zero. Right: every method\nthat has torsional friction. Soft contacts sink first, and push "
                   "and brake by turns; the others give the discrete truth.")
    return figure


def draw_deviations(axes, trajectories):
    """The spin of every method less that of the closed form at the same times."""
    at_step = trajectories.where(h_s=PAPER_STEP)
    truth = dict(zip(*(at_step.where(method="closed_form").numbers(column) for column in ("t_s", "wz_rad_s"))))
    for label, look, rows in methods.present(at_step):
        if set(rows.texts("method")) & {"closed_form", "discrete_form"}:
            continue
        times = rows.numbers("t_s")
        deviations = [spin - truth[t] for t, spin in zip(times, rows.numbers("wz_rad_s"))]
        axes.plot(times, deviations, label=label, **{**look, "linewidth": 1.2, "markersize": 4.5})


def figure_4(directory):
    ncp, truth = reference(read_trajectories(directory))
    figure, [[axes]] = style.new_figure(7.6, 4.5)
    figure.subplots_adjust(left=0.1, right=0.975, bottom=0.115, top=0.79)
    times, moments = ncp.numbers("t_s")[1:], ncp.numbers("torsion_Nm")[1:]  # nothing has acted yet at t = 0
    axes.plot(truth.numbers("t_s"), truth.numbers("torsion_Nm"), color=style.ORANGE, linewidth=3.4,
              drawstyle="steps-post", label="closed form of the moment")
    axes.plot(times, moments, color=style.BLACK, linewidth=1.4, drawstyle="steps-pre", marker="o", markersize=4,
              label="torsional moment, implicit NCP, mean over the step [N m]")
    for column in ("tangent_x_N", "tangent_y_N"):
        axes.plot(times, ncp.numbers(column)[1:], color=style.BLUE, linestyle=(0, (4, 1.5)), linewidth=1.2,
                  label="both tangential forces [N]" if column == "tangent_x_N" else None)
    last = max(i for i, moment in enumerate(moments) if abs(moment) > 1e-9)
    axes.annotate(f"{moments[last]:.4f} N m\nin the step that\nstops the spin", (times[last], moments[last]),
                  xytext=(14, -14), textcoords="offset points", fontsize=style.LABEL_POINTS, va="top")
    axes.set_xlim(0, max(times))
    axes.set_xlabel("time t [s]")
    axes.set_ylabel("force [N], moment [N m]")
    axes.legend(frameon=False, loc="upper left", fontsize=style.LABEL_POINTS, bbox_to_anchor=(0.0, 0.93))
    style.headline(figure, "The last step brakes with what is left: 0.02/0.07 of the full moment",
                   "Example 2, Fig. 4 of the paper, h = 0.07 s. The sphere brakes from 0.98 s to 1 s only; the step's "
                   "moment is the\nmean over its 0.07 s. With impulses as unknowns friction need not drop to zero at once.")
    return figure


def errors(directory):
    summary = read_table(directory / "summary.csv", ["method", "status", "h_s", "largest_spin_error_rad_s"])
    summary = summary.where(status="ok").require_rows("status ok")
    figure, [[axes]] = style.new_figure(8.6, 4.9)
    figure.subplots_adjust(left=0.09, right=0.69, bottom=0.115, top=0.79)
    axes.set_yscale("log")
    for label, look, rows in methods.present(summary):
        if set(rows.texts("method")) & {"closed_form", "discrete_form"}:
            continue
        points = sorted(zip(rows.numbers("h_s"), rows.numbers("largest_spin_error_rad_s")))
        axes.plot([h for h, _ in points], [max(error, 1e-17) for _, error in points], label=label, **look)
    methods.step_ticks(axes, {h for h, _ in summary.groups("h_s")})
    axes.set_ylabel("largest error of the spin [rad/s]")
    axes.legend(frameon=False, loc="center left", bbox_to_anchor=(1.02, 0.5), fontsize=style.LABEL_POINTS)
    style.headline(figure, "A linear fall is exact at every step, to the precision that a method works in",
                   "Example 2. The spin falls linearly, so that a step of any size ends on the truth: rigid methods are off "
                   "by their rounding.\nODE shows its constraint-force mixing, MuJoCo its softness.")
    return figure
