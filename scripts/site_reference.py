"""Reference pages of the documentation site, from the command line, docstrings and registries."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

import camwright
from camwright.pipeline.checks.registry import CHECKS, MODULES
from camwright.pipeline.commands.arguments import Command, arguments_of, help_of
from camwright.pipeline.commands.command_tree import TREE
from camwright.pipeline.commands.terminal import EXIT_CODES

RETURNED = (
    *("Run", "Sizing", "CrownDesign", "ScreenedDesigns"),
    *("Lift", "Contour", "Cycle", "CaseRun"),
)
"""Classes that the public functions take or return and that are not public names themselves."""
_ROOT = Path(__file__).resolve().parents[1]


def commands() -> str:
    """Page of every command with its arguments and options, as its help has them."""
    rows = "\n".join(
        f"| [`{path}`](#{slug(f'camwright {path}')}) | {_cell(entry.purpose)} |"
        for path, entry in TREE.items()
    )
    codes = "\n".join(f"| {code} | {_cell(words)} |" for code, words in EXIT_CODES.items())
    parts = [
        "# Commands",
        "Every command, from the program itself; `camwright COMMAND --help` prints the same.",
        f"| command | purpose |\n| --- | --- |\n{rows}",
        f"## Exit codes\n\n| code | meaning |\n| --- | --- |\n{codes}",
        *(_command(path, entry.command) for path, entry in TREE.items()),
    ]
    return "\n\n".join(parts) + "\n"


def _command(path: str, command: Command) -> str:
    """A command: usage, what it does, an example, table of its arguments and options."""
    usage = help_of(path, command).partition("\n")[0].removeprefix("usage: ")
    words = [
        " ".join(part.split()) for part in inspect.cleandoc(command.__doc__ or "").split("\n\n")
    ]
    *about, example = (part.replace("``", "`") for part in words)
    rows = "\n".join(
        f"| {_code_cell(each.usage)} | {_cell(each.words.help)} |" for each in arguments_of(command)
    )
    table = f"| argument or option | meaning |\n| --- | --- |\n{rows}"
    line = example.removeprefix("Example: ").strip("`")
    parts = [f"## `camwright {path}`", f"```text\n{usage}\n```", *map(_escaped, about), table,
             f"```text\n{line}\n```"]  # fmt: skip
    return "\n\n".join(parts)


def _code_cell(text: str) -> str:
    return "`" + text.replace("|", "\\|") + "`"


def _cell(text: str) -> str:
    return _escaped(" ".join(text.split())).replace("|", r"\|")


def _escaped(text: str) -> str:
    """Text as Markdown shows it: outside of code neither a tag nor emphasis."""
    parts = text.replace("``", "`").split("`")
    parts[::2] = [re.sub(r"([<*_])", r"\\\1", part) for part in parts[::2]]
    return "`".join(parts)


class Entry(NamedTuple):
    """A parameter, result or error of a docstring."""

    name: str
    kind: str
    words: str


class Docstring:
    """A docstring of the house: summary, prose, and sections of entries.

    An entry is `name : kind   words`, `name   words` or `name`; indented lines go on with it.
    """

    _SECTION = re.compile(r"^(\w[\w ]*)\n-{3,}\n", re.MULTILINE)
    _ENTRY = re.compile(
        r"^(?P<name>\S(?:.*?\S)??)(?: : (?P<kind>\S(?:.*?\S)??))?(?:\s{2,}(?P<words>\S.*))?$"
    )

    def __init__(self, text: str) -> None:
        self._parts = self._SECTION.split(inspect.cleandoc(text or "") + "\n")

    @property
    def prose(self) -> str:
        """All before the first section."""
        return self._parts[0].strip()

    @cached_property
    def sections(self) -> Mapping[str, str]:
        """Text of each section by its title."""
        return dict(zip(self._parts[1::2], self._parts[2::2], strict=True))

    def entries(self, title: str) -> list[Entry]:
        """Entries of a section."""
        found: list[Entry] = []
        for line in self.sections.get(title, "").splitlines():
            if line[:1].isspace() and found:
                last = found[-1]
                found[-1] = last._replace(words=f"{last.words} {line.strip()}".strip())
            elif line.strip():
                match = self._ENTRY.match(line.rstrip())
                if match is None:
                    raise ValueError(f"no entry of a docstring: {line}")
                found.append(Entry(match["name"], match["kind"] or "", match["words"] or ""))
        return found

    def markdown(self) -> str:
        """Prose and sections as Markdown."""
        parts = [_prose(self.prose)]
        for title, text in self.sections.items():
            if title in ("Parameters", "Returns", "Yields", "Raises", "Attributes"):
                items = "\n".join(f"- {_entry(each)}" for each in self.entries(title))
                parts.append(f"**{title}**\n\n{items}")
            else:
                parts.append(f"**{title}**\n\n{_prose(text.strip())}")
        return "\n\n".join(part for part in parts if part)


def _entry(one: Entry) -> str:
    kind = f" ({_escaped(one.kind)})" if one.kind else ""
    words = f": {_escaped(one.words)}" if one.words else ""
    return f"`{one.name}`{kind}{words}"


def _prose(text: str) -> str:
    """Paragraphs, with indented formulas and tables as they are."""
    parts = []
    for part in re.split(r"\n\s*\n", text):
        if part.lstrip().startswith("|") or part.startswith("    "):
            parts.append(part)
        else:
            parts.append("\n".join(_escaped(line.strip()) for line in part.splitlines()))
    return "\n\n".join(parts)


def api() -> dict[str, str]:
    """Pages of the Python reference by their path."""
    public = [(name, getattr(camwright, name)) for name in camwright.__all__]
    functions = [(name, one) for name, one in public if not inspect.isclass(one)]
    classes = [(name, one) for name, one in public if inspect.isclass(one)]
    lead = _prose(inspect.cleandoc(camwright.__doc__ or ""))
    returned = [(name, class_of(name)) for name in RETURNED]
    hidden = "```{toctree}\n:hidden:\n\nfunctions\nclasses\nreturned\n```"
    return {
        "api/index.md": f"# Python reference\n\n`import camwright as cw`\n\n{lead}\n\n"
        "Every object below is frozen, and its arrays are read-only.\n\n"
        "- [Functions](functions.md)\n- [Classes](classes.md)\n"
        "- [What functions return](returned.md)\n\n"
        f"{hidden}\n",
        "api/functions.md": _page("Functions", functions),
        "api/classes.md": _page("Classes", classes),
        "api/returned.md": _page(
            "What functions return", returned,
            "Classes that the public functions return or take. They are not names of `camwright`.",
        ),
    }  # fmt: skip


def class_of(name: str) -> Any:
    """The class of a name, wherever in the packages it is; no two have one name."""
    for folder in ("geometry", "meshes", "pipeline", "reports"):
        for file in sorted((_ROOT / folder).rglob("*.py")):
            if re.search(rf"^class {name}\b", file.read_text(encoding="utf-8"), re.MULTILINE):
                module = ".".join(file.relative_to(_ROOT).with_suffix("").parts)
                return getattr(import_module(f"camwright.{module}"), name)
    raise ValueError(f"no class {name}")


def _page(title: str, listed: Sequence[tuple[str, Any]], lead: str = "") -> str:
    parts = [f"# {title}", lead, *(_object(name, one) for name, one in listed)]
    return "\n\n".join(part for part in parts if part) + "\n"


def _object(name: str, one: Any) -> str:
    home = "camwright" if name in camwright.__all__ else one.__module__
    heading = f"## `{name}`"
    text = Docstring(inspect.getdoc(one) or "").markdown()
    if not inspect.isclass(one):
        return f"{heading}\n\n:::{{py:function}} {home}.{name}{_signature(one)}\n:::\n\n{text}"
    members = "\n".join(_members(one))
    listed = f"\n\n**Members**\n\n{members}" if members else ""
    return f"{heading}\n\n:::{{py:class}} {home}.{name}\n:::\n\n{text}{listed}"


def _signature(one: Any) -> str:
    """Parameters and simple defaults, without annotations."""
    words, starred = [], False
    for each in inspect.signature(one).parameters.values():
        if each.kind is each.KEYWORD_ONLY and not starred:
            words.append("*")
            starred = True
        mark = {each.VAR_POSITIONAL: "*", each.VAR_KEYWORD: "**"}.get(each.kind, "")
        simple = isinstance(each.default, str | int | float | tuple | type(None))
        default = "" if each.default is each.empty else f"={each.default!r}" if simple else "=..."
        if hasattr(each.default, "name") and hasattr(type(each.default), "__members__"):
            default = f"={type(each.default).__name__}.{each.default.name}"
        words.append(f"{mark}{each.name}{default}")
    return f"({', '.join(words)})"


def _members(one: Any) -> Iterator[str]:
    """Public members with a docstring, in the order of the class."""
    for name, value in list(vars(one).items()):
        inner = getattr(value, "func", None) or getattr(value, "fget", None) or value
        inner = getattr(inner, "__func__", inner)
        text = getattr(inner, "__doc__", None)
        if name.startswith("_") or not inspect.isfunction(inner) or not text:
            continue
        call = (
            "()"
            if inspect.isfunction(value) or isinstance(value, classmethod | staticmethod)
            else ""
        )
        words = Docstring(text).prose.split("\n\n")[0].split()
        yield f"- `{name}{call}`: {_escaped(' '.join(words))}"


class Split(NamedTuple):
    """A page whose generated part is laid out on pages of its own.

    text: the page with a list in place of the part; pages: by path; places: page of each anchor
    """

    text: str
    pages: Mapping[str, str]
    places: Mapping[str, str]


def slug(title: str) -> str:
    """Anchor of a heading, as on the forge."""
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def _generated(text: str, name: str) -> re.Match[str]:
    """The table of a name in a page."""
    match = re.search(rf"<!-- table: {name} -->\n(.*?)\n<!-- end -->", text, re.DOTALL)
    if match is None:
        raise ValueError(f"the page has no table {name}")
    return match


def split_checks(text: str) -> Split:
    """The page of the checks, with a page for each of their modules."""
    match = _generated(text, "checks")
    sections = re.split(r"^### ", match[1], flags=re.MULTILINE)[1:]
    pages, places, lists = {}, {}, []
    titles = {each.id: each.title.format(follower="follower") for each in CHECKS}
    for module, section in zip(MODULES, sections, strict=True):
        name = module.__name__.rpartition(".")[2]
        title, _, body = section.partition("\n")
        body = body.replace("\n#### ", "\n## ").replace("](", "](../")
        pages[f"checks/{name}.md"] = f"# {title}\n{body}\n"
        headings = re.findall(r"^## (.+)$", body, re.MULTILINE)
        places |= {slug(each): f"checks/{name}.md" for each in (title, *headings)}
        inside = [re.match(r"`(\w+)`", each)[1] for each in headings]  # type: ignore[index]
        rows = "\n".join(
            f"- [{titles[one]}](checks/{name}.md#{slug(heading)}) `{one}`"
            for one, heading in zip(inside, headings, strict=True)
        )
        lists.append(f"### [{title}](checks/{name}.md)\n\n{rows}")
    return Split(_replaced(text, match, lists, pages), pages, places)


def split_keys(text: str) -> Split:
    """The page of the case file, with a page for each of its first tables."""
    match = _generated(text, "keys")
    sections = re.split(r"^### ", match[1], flags=re.MULTILINE)[1:]
    pages, places, lists = {}, {}, []

    by_table: dict[str, list[str]] = {}
    for section in sections:
        table = re.match(r"`\[+(\w+)", section)
        by_table.setdefault(table[1] if table else "top", []).append(section)
    for name, tables in by_table.items():
        title = "Top of the file" if name == "top" else f"`[{name}]`"
        body = "\n".join(f"## {each.rstrip()}\n" for each in tables).replace("](", "](../")
        pages[f"keys/{name}.md"] = f"# {title}\n\n{body}"
        headings = [each.partition("\n")[0] for each in tables]
        places |= {slug(each): f"keys/{name}.md" for each in headings}
        inside = ", ".join(f"[{each}](keys/{name}.md#{slug(each)})" for each in headings)
        lists.append(f"- {inside}")
    return Split(_replaced(text, match, ["\n".join(lists)], pages), pages, places)


def _replaced(
    text: str, match: re.Match[str], lists: Sequence[str], pages: Mapping[str, str]
) -> str:
    tree = "\n".join(name.removesuffix(".md") for name in pages)
    hidden = f"```{{toctree}}\n:hidden:\n\n{tree}\n```"
    return text[: match.start()] + "\n\n".join([*lists, hidden]) + text[match.end() :]


def check_links(places: Mapping[str, str]) -> dict[str, str]:
    """Page and anchor of each check by its id."""
    links = {anchor.partition("-")[0]: f"{page}#{anchor}" for anchor, page in places.items()}
    return {each.id: links[each.id.lower()] for each in CHECKS}
