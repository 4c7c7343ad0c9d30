"""The one table of figures: experiment -> figure name -> function of the experiment's directory."""

from . import closed_forms, disc_rolling, disc_rolling_engines

EXPERIMENTS = {
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
}
