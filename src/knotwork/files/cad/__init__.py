"""Files of CAD: curves and surfaces among much else, which is left as it is."""
