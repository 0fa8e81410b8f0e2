"""Renders what is made from docs/data: short tables, tables in documents, pictures."""
import subprocess

from .programs import ROOT
from .summaries import write_summaries

PLOTS = ("plot_speed_accuracy", "plot_pace", "plot_stability", "plot_work_cost")
INPUTS = {"plot_pace": "pace.csv", "plot_stability": "stability.csv", "plot_work_cost": "work_cost.csv",
          "plot_speed_accuracy": "speed_accuracy.csv"}


def render(data):
    """Whether all could be rendered."""
    write_summaries(data)
    sound = True
    if data.resolve() != ROOT / "docs/data":
        return sound  # the documents show docs/data
    commands = [[plot] for plot in PLOTS if (data / INPUTS[plot]).exists()] + [["tables"]]
    for command in commands:
        sound = subprocess.run([str(ROOT / "scripts" / command[0])] + command[1:]).returncode == 0 and sound
    return sound
