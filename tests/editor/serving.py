"""A running editor of its own process, for tests that talk to it."""

import os
import re
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple
from urllib.parse import parse_qs, urlsplit

import knotwork as kw

START = """
import sys
from pathlib import Path
from knotwork.editor.launch import edit
announce = lambda said: print(said, flush=True)
edit(store=Path(sys.argv[1]), port=int(sys.argv[2]), browse=False, warm=sys.argv[3] == "warm", announce=announce)
"""


class Served(NamedTuple):
    """Where the editor is."""

    #: the whole address, with the token
    url: str
    port: int
    token: str
    process: subprocess.Popen

    def kill(self):
        """Kill it at once, as a power cut would."""
        self.process.kill()
        self.process.wait()


@contextmanager
def editor(store, port=0, warm=False, before=""):
    """Run the editor on a store until the block ends; `before` is Python that its process runs first."""
    source = str(Path(kw.__file__).parents[1])
    env = {**os.environ, "PYTHONPATH": os.pathsep.join([source, os.environ.get("PYTHONPATH", "")])}
    command = [sys.executable, "-c", before + START, str(store), str(port), "warm" if warm else ""]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=env) as process:
        try:
            url = process.stdout.readline().strip()
            assert re.match(r"http://127\.0\.0\.1:\d+/\?token=", url), url
            parts = urlsplit(url)
            yield Served(url, parts.port, parse_qs(parts.query)["token"][0], process)
        finally:
            process.kill()
