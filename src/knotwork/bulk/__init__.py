"""Work on many curves and files: `batch` in parts, and the plain functions that it maps."""

from knotwork.bulk.curves import Outcome, convert_curves, fit_curves, flatten_curves, reduce_curves
from knotwork.bulk.face import Summary, batch

__all__ = ["Outcome", "Summary", "batch", "convert_curves", "fit_curves", "flatten_curves", "reduce_curves"]
