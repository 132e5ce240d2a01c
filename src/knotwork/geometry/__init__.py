"""Bézier nets, lengths and distances: what files, sketches and reduction share."""
