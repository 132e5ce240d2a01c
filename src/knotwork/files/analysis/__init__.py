"""Patches for isogeometric analysis: the NURBS toolbox and GeoPDEs, igakit and PetIGA, MFEM."""
