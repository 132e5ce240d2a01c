"""What the editor starts beside itself ends with it."""

import subprocess
import sys

FOREVER = """
import time
from knotwork.editor import launch
launch.first_curve = lambda: (print("compiling", flush=True), time.sleep(600))
launch.compile_apart()
"""


def test_the_process_that_compiles_ends_with_the_editor():
    """However the editor ends, the pipe between them is closed."""
    given = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen([sys.executable, "-c", FOREVER], **given) as compiler:
        assert compiler.stdout.readline().strip() == b"compiling"
        compiler.stdin.close()
        assert compiler.wait(timeout=60) == 0
