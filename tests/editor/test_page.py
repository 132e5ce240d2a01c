"""The page's own code: TypeScript checks the types that its comments state."""

import shutil
import subprocess
from pathlib import Path

import pytest

from knotwork import editor

PAGE = Path(editor.__file__).parent / "static" / "main.js"
STRICT = ["--noEmit", "--allowJs", "--checkJs", "--strict", "--moduleResolution", "node"]
LANGUAGE = ["--target", "es2022", "--module", "es2022", "--lib", "es2022,dom,dom.iterable"]


@pytest.mark.skipif(shutil.which("tsc") is None, reason="there is no TypeScript")
def test_the_types_of_the_page_hold():
    run = subprocess.run([shutil.which("tsc"), *STRICT, *LANGUAGE, PAGE], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout
