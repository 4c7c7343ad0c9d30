"""The one table of figures: experiment -> figure name -> function of the experiment's directory.

A function gives None where the table of its figure belongs to a run and is not there.
"""

from . import box_on_incline, closed_forms, disc_rolling, disc_rolling_engines, ellipsoid_rolling, euler_disc
from . import rattleback, solver_comparison, sphere_on_spheres, sphere_spin, spheres_in_box, tippe_top

EXPERIMENTS = {
    "box_on_incline": {
        "threshold_map": box_on_incline.threshold_map,
        "wrong_cells": box_on_incline.wrong_cells,
    },
    "closed_forms": {
        "error": closed_forms.error,
        "order": closed_forms.order,
    },
    "disc_rolling": {
        "figure_1a": disc_rolling.figure_1a,
        "figure_1b": disc_rolling.figure_1b,
        "loss": disc_rolling.loss,
        "engines": disc_rolling_engines.engines,
        "engines_energy": disc_rolling_engines.energy_over_time,
    },
    "ellipsoid_rolling": {
        "errors": ellipsoid_rolling.errors,
        "energy_drift": ellipsoid_rolling.energy_drift,
        "paths": ellipsoid_rolling.paths,
    },
    "solver_comparison": {
        "profile": solver_comparison.iterations,
        "profile_timing": solver_comparison.time,
        "trajectory_timing": solver_comparison.trajectories,
    },
    "sphere_on_spheres": {
        "figure_6": sphere_on_spheres.figure_6,
        "figure_7": sphere_on_spheres.figure_7,
        "figure_8": sphere_on_spheres.figure_8,
        "errors": sphere_on_spheres.errors,
        "deviations": sphere_on_spheres.deviations,
    },
    "sphere_spin": {
        "figure_3": sphere_spin.figure_3,
        "figure_4": sphere_spin.figure_4,
        "errors": sphere_spin.errors,
    },
    "euler_disc": {
        "history": euler_disc.history,
        "torsion": euler_disc.torsion,
    },
    "rattleback": {
        "history": rattleback.history,
    },
    "spheres_in_box": {
        "scaling": spheres_in_box.scaling,
    },
    "tippe_top": {
        "history": tippe_top.history,
    },
}
