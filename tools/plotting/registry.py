"""The one table of figures: experiment -> figure name -> function of the experiment's directory."""

from . import disc_rolling

EXPERIMENTS = {
    "disc_rolling": {
        "figure_1a": disc_rolling.figure_1a,
        "figure_1b": disc_rolling.figure_1b,
        "loss": disc_rolling.loss,
    },
}
