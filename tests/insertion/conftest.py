"""The methods of the catalogue run plain here: tests/test_kernel.py compiles each once, and compares the bits."""

from __future__ import annotations

import pytest

from knotwork.arithmetic import kernel

#: what runs as it does for users
COMPILED = {"test_insert", "test_pieces"}


@pytest.fixture(autouse=True)
def plain(request, monkeypatch):
    if request.module.__name__.rpartition(".")[2] not in COMPILED:
        monkeypatch.setattr(kernel, "mode", "never")
