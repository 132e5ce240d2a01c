"""Draw the figures of chapters 1 to 4 for the pages: python docs/figures/schemes.py."""

from common import IMAGES

from knotwork.diagrams import FIGURES, figure

if __name__ == "__main__":
    for number in FIGURES:
        place = IMAGES / ("progressive" if number < "3" else "insertion") / f"figure-{number}.svg"
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(figure(number).svg(), encoding="utf-8")
