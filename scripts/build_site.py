"""Build the documentation site from docs/, the registries and the shipped cases.

python scripts/build_site.py          into build/docs/site
python scripts/build_site.py DIR      into DIR/site
"""

from __future__ import annotations

import importlib.util
import re
import shutil
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
OUT = ROOT / "build" / "docs"
GENERATOR = {"sphinx": "sphinx", "furo": "furo", "myst_parser": "myst-parser"}
"""Modules of the generator and the packages that bring them; all are of the extra `docs`."""
_BLOCK = re.compile(
    r"<!-- (?:table: \w+|end|results of make verify|end of results|"
    r"figures of the tests|end of figures) -->\n?"
)
_FIGURE = re.compile(r"<!-- figure: (\w+) -->")
_TURNING = "<!-- turning cam -->"
_LINK = re.compile(r"\]\(([\w/.-]+\.md)(#[^)\s]+)?\)")
_NAMED = {
    '<aside class="sidebar-drawer">': '<aside class="sidebar-drawer" aria-label="pages">',
    '<aside class="toc-drawer">': '<aside class="toc-drawer" aria-label="on this page">',
    '<div id="search-results">': '<h1>Search</h1>\n<div id="search-results">',
}
"""Parts of the theme's templates that a screen reader needs a name of."""
_RENAMED = {"search.md": "search-methods.md"}
"""Pages of docs/ whose name the generator needs for a page of its own."""
_LANGUAGES = {"csv": "text"}


def missing() -> str:
    """One line on what is to be installed; "" if nothing is."""
    absent = [
        name for module, name in GENERATOR.items() if importlib.util.find_spec(module) is None
    ]
    if not absent:
        return ""
    return f"make docs needs {', '.join(absent)}: .venv/bin/python -m pip install -e '.[docs]'"


def say(words: str) -> None:
    """Print a line at once."""
    sys.stdout.write(f"{words}\n")
    sys.stdout.flush()


def texts() -> dict[str, str]:
    """Texts of the site by their path in its source: those of docs/, and the reference pages."""
    import site_reference as reference

    pages = {
        _site_name(file.relative_to(DOCS).as_posix()): file.read_text(encoding="utf-8")
        for file in sorted(DOCS.rglob("*.md"))
        if "site" not in file.relative_to(DOCS).parts[:1]
    }
    checks = reference.split_checks(pages["checks.md"])
    keys = reference.split_keys(pages["case-file.md"])
    pages |= {"checks.md": checks.text, "case-file.md": keys.text, **checks.pages, **keys.pages}
    pages |= {"commands.md": reference.commands(), **reference.api()}
    pages["index.md"] = (DOCS / "site" / "index.md").read_text(encoding="utf-8")
    places = {"checks.md": checks.places, "case-file.md": keys.places}
    return {name: _plain(name, text, places) for name, text in pages.items()}


def _site_name(name: str) -> str:
    return _RENAMED.get(name, name)


def _plain(name: str, text: str, places: Mapping[str, Mapping[str, str]]) -> str:
    """A page without the marks of its tables, with links to pages laid out on several."""
    up = "../" * name.count("/")

    def there(match: re.Match[str]) -> str:
        target, anchor = match[1], match[2] or ""
        whole = target.removeprefix(up)
        page = places.get(whole, {}).get(anchor.removeprefix("#"), _site_name(whole))
        return f"]({up}{page}{anchor})" if page != whole else match[0]

    text = _LINK.sub(there, _BLOCK.sub("", text))
    return re.sub(
        r"^```(\w+)$", lambda m: f"```{_LANGUAGES.get(m[1], m[1])}", text, flags=re.MULTILINE
    )


def pictured(pages: Mapping[str, str]) -> dict[str, str]:
    """The pages with the gallery and the figures in their text."""
    import site_figures
    import site_gallery
    import site_reference as reference

    checks = reference.split_checks((DOCS / "checks.md").read_text(encoding="utf-8"))
    cases = site_gallery.solved(ROOT, say)
    gallery = site_gallery.gallery(cases, reference.check_links(checks.places))
    (first,) = (each for each in cases if each.file == ROOT / site_figures.CASE)
    figures = site_figures.Figures(first.trial)

    def drawn(match: re.Match[str]) -> str:
        return f"```{{raw}} html\n{figures.html(match[1])}\n```"

    turning = site_gallery.cam_of(first, "cam")
    return {
        name: _FIGURE.sub(drawn, text.replace(_TURNING, turning))
        for name, text in {**pages, **gallery}.items()
    }


def laid_out(folder: Path, pages: Mapping[str, str]) -> None:
    """Write the source of the site: its pages, images and settings."""
    shutil.rmtree(folder, ignore_errors=True)
    for name, text in pages.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    shutil.copytree(DOCS / "images", folder / "images")
    shutil.copy(DOCS / "notebook.ipynb", folder)
    for file in ("conf.py", "camwright_colours.py"):
        shutil.copy(DOCS / "site" / file, folder)
    shutil.copytree(DOCS / "site" / "static", folder / "static")


def generated(source: Path, site: Path) -> int:
    """Run the generator; exit code, 1 for a warning, too."""
    from sphinx.cmd.build import build_main

    shutil.rmtree(site, ignore_errors=True)
    sys.path.insert(0, str(source))  # the colours of the code
    trees = site.parent / "doctrees"
    shutil.rmtree(trees, ignore_errors=True)
    words = [
        "-b",
        "html",
        "-q",
        "-W",
        "--keep-going",
        "-d",
        str(trees),
        str(source),
        str(site),
    ]
    code = int(build_main(words))
    (site / ".buildinfo").unlink(missing_ok=True)
    for file in site.rglob("*.html"):
        text = file.read_text(encoding="utf-8")
        for old, new in _NAMED.items():
            text = text.replace(old, new)
        file.write_text(text, encoding="utf-8")
    return code


def main(arguments: Sequence[str]) -> int:
    """Build the site; 0 built, 1 a warning of the generator, 2 it is not installed."""
    if words := missing():
        sys.stderr.write(f"{words}\n")
        return 2
    out = Path(arguments[0]).resolve() if arguments else OUT
    say("pictures of the shipped cases:")
    pages = pictured(texts())
    laid_out(out / "source", pages)
    code = generated(out / "source", out / "site")
    if code == 0:
        say(f"site: {out / 'site' / 'index.html'}")
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
