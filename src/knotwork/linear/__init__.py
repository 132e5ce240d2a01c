"""Linear algebra of narrow bands: matrices, elimination, least squares; exact over exact numbers."""
