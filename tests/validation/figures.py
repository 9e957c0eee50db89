"""Figures in one style; the colours of Okabe and Ito can be told apart by colour-blind readers."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

OKABE_ITO = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]
plt.rcParams.update({"axes.prop_cycle": plt.cycler(color=OKABE_ITO), "figure.figsize": (6.4, 3.2), "figure.dpi": 110, "font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "legend.frameon": False,
                     "axes.spines.top": False, "axes.spines.right": False, "svg.hashsalt": "talus"})


def save(figure, directory, name):
    """Writes directory/name.png and returns the line of Markdown that shows it."""
    directory.mkdir(parents=True, exist_ok=True)
    figure.savefig(directory / f"{name}.png", bbox_inches="tight", metadata={"Software": None})
    plt.close(figure)
    return f"![{name}]({directory.name}/{name}.png)\n"
