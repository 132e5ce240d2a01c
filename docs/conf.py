"""The site: `make docs` builds it from the pages of this folder, with two more that are made from the code."""

import re
from pathlib import Path
from typing import Any

import knotwork as kw

HERE = Path(__file__).parent
project, author, release = "Knotwork", "The Knotwork authors", kw.__version__
project_copyright = author
extensions = ["myst_parser", "sphinx_external_toc", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_click"]
smartquotes = False
external_toc_path = "toc.yml"
exclude_patterns = ["_build", "paper", "figures"]
myst_heading_anchors = 3
html_theme = "furo"
html_title = "Knotwork"
html_static_path = ["site"]
html_css_files = ["site.css"]
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#1f3a5f", "color-brand-content": "#2b5a94"},
    "dark_css_variables": {"color-brand-primary": "#a9c4e8", "color-brand-content": "#a9c4e8"},
}
autodoc_typehints = "none"
autodoc_member_order = "bysource"
napoleon_google_docstring = False
napoleon_use_ivar = True
napoleon_use_rtype = False


def names_by_task() -> str:
    """Return the page of all names with their help: the lists of reference.md, each name with its docstring."""
    page = (HERE / "reference.md").read_text(encoding="utf-8")
    lines = ["# Help, name by name", "", "What `help` shows, by task; in short: [all names](../reference.md)."]
    for line in page.splitlines():
        found = re.match(r"- `kw\.(\w+)`", line)
        if line.startswith("## ") and "has and does" not in line:
            lines += ["", line, ""]
        elif found and callable(thing := getattr(kw, found[1])):
            kind = "function"
            if isinstance(thing, type):
                kind = "exception" if issubclass(thing, BaseException) else "class"
            members = ["   :members:"] if kind == "class" else []
            lines += ["```{eval-rst}", f".. auto{kind}:: knotwork.{found[1]}", *members, "```"]
    return "\n".join(lines) + "\n"


COMMANDS = """# Every command

What `--help` says of each; [what holds for all of them](../command.md).

```{eval-rst}
.. click:: knotwork.cli:main
   :prog: knotwork
   :nested: full
```
"""


def plain_bars(app: object, what: str, name: str, thing: object, options: object, lines: list[str]) -> None:
    """Keep |x|, the size of x, from being read as a substitution."""
    lines[:] = [re.sub(r"\|(\w+)\|", r"\\|\1\\|", line) for line in lines]


def plain_stars(app: object, context: object, lines: list[str]) -> None:
    """Keep the stars of patterns of files from being read as emphasis."""
    lines[:] = [line.replace("*", r"\*") for line in lines]


def setup(app: Any) -> None:
    """Write the two pages that are made from the code, before anything is read."""
    app.connect("autodoc-process-docstring", plain_bars)
    app.connect("sphinx-click-process-description", plain_stars)
    folder = HERE / "made"
    folder.mkdir(exist_ok=True)
    for name, text in (("names.md", names_by_task()), ("commands.md", COMMANDS)):
        path = folder / name
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")
