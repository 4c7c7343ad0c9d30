"""The one table of figures: experiment -> figure name -> function of the experiment's directory."""

from . import box_on_incline, disc_rolling, euler_disc, rattleback, tippe_top

EXPERIMENTS = {
    "box_on_incline": {
        "threshold_map": box_on_incline.threshold_map,
        "wrong_cells": box_on_incline.wrong_cells,
    },
    "disc_rolling": {
        "figure_1a": disc_rolling.figure_1a,
        "figure_1b": disc_rolling.figure_1b,
        "loss": disc_rolling.loss,
    },
    "euler_disc": {
        "history": euler_disc.history,
        "torsion": euler_disc.torsion,
    },
    "rattleback": {
        "history": rattleback.history,
    },
    "tippe_top": {
        "history": tippe_top.history,
    },
}
