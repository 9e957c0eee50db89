"""Small figures of one style."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

plt.rcParams.update({"figure.figsize": (6.4, 3.2), "figure.dpi": 80, "font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "legend.frameon": False,
                     "axes.spines.top": False, "axes.spines.right": False, "svg.hashsalt": "talus"})


def save(figure, directory, name):
    """Writes directory/name.png. Returns the line of Markdown that shows it."""
    directory.mkdir(parents=True, exist_ok=True)
    figure.savefig(directory / f"{name}.png", bbox_inches="tight", metadata={"Software": None})
    plt.close(figure)
    return f"![{name}]({directory.name}/{name}.png)\n"
