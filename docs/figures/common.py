"""What the scripts of this folder share: where things are, colours, axes without a box."""

from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("agg")
from matplotlib import pyplot as plt

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"
IMAGES = ROOT / "docs" / "images"
GREEN, GOLD, PLUM, GREY = "#3c8d6e", "#b58a1b", "#7a4f9a", "#70757a"

__all__ = ["EXAMPLES", "GOLD", "GREEN", "GREY", "IMAGES", "PLUM", "ROOT", "plain", "plt", "save"]


def plain(ax: Any, **what: Any) -> None:
    """Take the box away and set what is given."""
    ax.spines[["top", "right"]].set_visible(False)
    ax.set(**what)


def save(fig: Any, name: str, dpi: int = 150) -> None:
    """Write a picture into docs/images."""
    path = IMAGES / name
    path.parent.mkdir(parents=True, exist_ok=True)
    fig.savefig(path, dpi=dpi)
    plt.close(fig)
