"""What the benchmark of drawings fetches and runs: packages of drawings and maps, resvg, svgo, Inkscape, Chromium."""

from __future__ import annotations

import base64
import io
import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

#: packages of icons on the npm registry, and the folders in them whose drawings are no copies of others
ICONS = {
    "@tabler/icons@3.52.0": "icons",
    "@mdi/svg@7.4.47": "svg",
    "remixicon@4.9.1": "icons",
    "bootstrap-icons@1.13.2": "icons",
    "lucide-static@1.62.0": "icons",
}
TOOLS = ("@resvg/resvg-js@2.6.2", "svgo@4.1.0", "world-atlas@2.0.2", "topojson-client@3.1.0")
SIZE = 1000


def fetched(cache: Path) -> dict[str, list[Path]]:
    """Return the drawings of each package, fetched if they are not there yet: Debian's if there is apt."""
    cache.mkdir(parents=True, exist_ok=True)
    modules = cache / "node_modules"
    if not (modules / "svgo").exists():
        (cache / "package.json").write_text("{}")
        quiet = ["--no-audit", "--no-fund", "--ignore-scripts", "--silent"]
        subprocess.run(["npm", "install", *quiet, *TOOLS, *ICONS], cwd=cache, check=True)
    found = {}
    clip = cache / "openclipart"
    if not clip.exists() and shutil.which("apt-get"):
        subprocess.run(["apt-get", "download", "--quiet", "openclipart-svg"], cwd=cache, check=True)
        (package,) = cache.glob("openclipart-svg*.deb")
        subprocess.run(["dpkg", "-x", package, clip], check=True)
    if clip.exists():
        found["openclipart-svg"] = sorted(path for path in clip.rglob("*.svg") if path.is_file())
    for name, folder in ICONS.items():
        name = name[: name.rindex("@")]
        found[name] = sorted((modules / name / folder).rglob("*.svg"))
    return found


class Node:
    """A process of Node that renders and makes text shorter."""

    def __init__(self, cache: Path) -> None:
        script = Path(__file__).with_suffix("").parent / "drawings.mjs"
        command = ["node", str(script), str(cache.resolve())]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def ask(self, **request: Any) -> tuple[dict[str, Any], bytes]:
        """Return the answer to a request."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.write(json.dumps(request).encode() + b"\n")
        self.process.stdin.flush()
        told = json.loads(self.process.stdout.readline())
        return told, self.process.stdout.read(told["bytes"])

    def render(self, data: bytes) -> tuple[np.ndarray, float] | str:
        """Return an image of 1,000 pixels, and how many of them a px of the drawing is; or what is wrong."""
        told, pixels = self.ask(render=text_of(data), size=SIZE)
        if "error" in told:
            return str(told["error"])
        image = np.frombuffer(pixels, np.uint8).reshape(told["height"], told["width"], 4)[..., :3]
        return image, max(told["width"], told["height"]) / max(told["units"])

    def atlas(self, name: str) -> bytes:
        """Return a map of the package world-atlas as GeoJSON."""
        return self.ask(atlas=name)[1]

    def svgo(self, data: bytes) -> bytes:
        """Return what svgo makes of a drawing: itself, if it cannot."""
        told, found = self.ask(svgo=text_of(data))
        return data if "error" in told else found


def text_of(data: bytes) -> str:
    """Return the text of a drawing."""
    named = re.match(rb"<\?xml[^>]*encoding=[\"']([\w-]+)", data)
    return data.decode(named[1].decode() if named else "utf-8", "replace")


def simplified(files: list[Path], folder: Path) -> list[Path | None]:
    """Return what Inkscape's simplify makes of drawings, all in one process; None where it wrote nothing."""
    folder.mkdir(parents=True, exist_ok=True)
    targets = [folder / f"{i}.svg" for i in range(len(files))]
    lines = [
        f"file-open:{file.resolve()};select-all:all;path-simplify;export-filename:{target.resolve()};"
        "export-plain-svg;export-do;file-close"
        for file, target in zip(files, targets, strict=True)
    ]
    with open(folder / "told", "w") as told:
        subprocess.run(
            ["inkscape", "--shell"], input="\n".join([*lines, "quit", ""]), text=True, stdout=told, stderr=told
        )
    return [target if target.exists() else None for target in targets]


class Chromium:
    """A browser that loads drawings as images."""

    LOAD = """([data, width]) => new Promise(done => {
        document.body.style.margin = 0;
        document.body.replaceChildren(Object.assign(new Image(), {
            onload: () => done(true), onerror: () => done(false), width,
            src: "data:image/svg+xml;base64," + data }));
    })"""

    def __init__(self) -> None:
        from playwright.sync_api import sync_playwright

        system = shutil.which("chromium")
        self.play = sync_playwright().start()
        self.browser = self.play.chromium.launch(executable_path=system, args=["--no-sandbox"] if system else [])
        self.page = self.browser.new_page()

    def opens(self, data: bytes, width: int = SIZE) -> bool:
        """Load a drawing, and tell whether that succeeded."""
        return bool(self.page.evaluate(self.LOAD, [base64.b64encode(data).decode(), width]))

    def render(self, data: bytes, width: int, height: int) -> np.ndarray | None:
        """Return an image of a drawing; None if it does not open."""
        self.page.set_viewport_size({"width": width, "height": height})
        if not self.opens(data, width):
            return None
        return np.asarray(Image.open(io.BytesIO(self.page.screenshot())).convert("RGB"))

    def close(self) -> None:
        """Close the browser."""
        self.browser.close()
        self.play.stop()
