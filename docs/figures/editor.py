"""Take the picture of the editor from itself: python docs/figures/editor.py (needs Playwright and Chromium)."""

import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from common import IMAGES, ROOT
from playwright.sync_api import sync_playwright

import knotwork as kw


def main() -> None:
    """Open the curve of §7.6, draw what the book draws, and take a picture."""
    chromium = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))))
    record = json.loads((ROOT / "tests" / "sketch" / "knob.json").read_text())
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as driver:
        curve = Path(folder) / "session.json"
        kw.write(curve, kw.curve(record["points"], record["degree"], record["knots"]))
        command = [sys.executable, "-m", "knotwork", "edit", str(curve), "--store", f"{folder}/store", "--no-browser"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
            try:
                browser = driver.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
                page = browser.new_page(viewport={"width": 1280, "height": 760})
                page.goto(process.stdout.readline().split()[-1])
                page.wait_for_timeout(3000)
                page.click("#zoom")
                for stroke in record["strokes"]:
                    ends = [page.evaluate(PLACE, point) for point in (stroke[0], stroke[-1])]
                    page.mouse.move(*ends[0])
                    page.mouse.down()
                    page.mouse.move(*ends[1], steps=12)
                    page.mouse.up()
                    page.wait_for_timeout(700)
                    if page.evaluate("app.drawing.curves.length") > 1:  # too short on this screen: read as a new curve
                        page.keyboard.press("Control+z")
                        page.wait_for_timeout(400)
                page.screenshot(path=IMAGES / "editor.png")
                browser.close()
            finally:
                process.kill()


PLACE = """p => { const box = app.sheet.getBoundingClientRect(), [x, y] = app.camera.toScreen(p);
               return [x + box.left, y + box.top]; }"""

if __name__ == "__main__":
    main()
