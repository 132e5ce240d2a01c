"""Draw the figures of chapters 1 and 2 for the documentation: python docs/figures_progressive.py."""

from pathlib import Path

from knotwork.diagrams import figure
from knotwork.diagrams.progressive_figures import FIGURES

IMAGES = Path(__file__).with_name("images") / "progressive"

if __name__ == "__main__":
    IMAGES.mkdir(parents=True, exist_ok=True)
    for number in FIGURES:
        (IMAGES / f"figure-{number}.svg").write_text(figure(number).svg(), encoding="utf-8")
