"""Scalars that kernels run over: one source of an algorithm tells what it computes, and what it costs."""

from knotwork.arithmetic.counting import Counting, Counts, counting

__all__ = ["Counting", "Counts", "counting"]
