"""Most of these jobs are too small to compile for; that both forms agree is tested elsewhere."""

import pytest

from knotwork.arithmetic import kernel


@pytest.fixture(autouse=True)
def plain(monkeypatch):
    monkeypatch.setattr(kernel, "mode", "never")
