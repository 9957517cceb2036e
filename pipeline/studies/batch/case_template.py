"""Base cases of a study as text with their files, sent once to each worker."""

from __future__ import annotations

import hashlib
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from camwright.geometry.errors import InputError
from camwright.pipeline.base.files import inside

# A worker of the cluster passes templates on: it reads no case.
if TYPE_CHECKING:
    from camwright.pipeline.case.case import Case
    from camwright.pipeline.case.toml_text import Tables

CASE_FILE = "case.toml"


@dataclass(frozen=True)
class Template:
    """Case file with the contents of the files it reads.

    Parameters
    ----------
    name : str        of the case
    files : mapping   contents by relative name; the case file is `CASE_FILE`
    """

    name: str
    files: Mapping[str, bytes]

    @property
    def sha256(self) -> str:
        """Hash of the names and contents of the files."""
        digest = hashlib.sha256()
        for name, content in sorted(self.files.items()):
            digest.update(f"{name}\0{len(content)}\0".encode())
            digest.update(content)
        return digest.hexdigest()

    def case(self, folder: Path) -> Case:
        """Case read from its files, which are first written into a folder of its name under
        `folder`.
        """
        from camwright.pipeline.case.case_file import parse_case

        home = folder / self.name
        for name, content in self.files.items():
            (home / name).parent.mkdir(parents=True, exist_ok=True)
            (home / name).write_bytes(content)
        return parse_case(self.files[CASE_FILE], home)


def read_templates(folder: Path, names: Sequence[str]) -> tuple[Template, ...]:
    """Templates, each a case file with the contents of the files it reads, of the cases of a study.

    Parameters
    ----------
    folder : Path      of the study file
    names : sequence   paths of the case files relative to it

    Raises
    ------
    InputError
        If a case cannot be read, or two have one name.
    """
    from camwright.pipeline.case.cards.card_filling import USER_FILE
    from camwright.pipeline.case.case_file import read_case
    from camwright.pipeline.studies.batch.study_file import case_path, read_study_tables

    made: dict[str, Template] = {}
    for name in names:
        path = case_path(folder, name)
        try:
            case = read_case(path)
        except InputError as error:
            raise InputError(f"{name}: {error.field}", error.value, error.limit) from None
        if case.name in made:
            raise InputError("case", f"{name} with name = {case.name}", "a name of its own")
        tables: Tables = read_study_tables(path)  # type: ignore[assignment]
        files = {each: inside(path.parent, each, each) for each in _files(case, tables)}
        user = path.parent / USER_FILE
        if user.is_file():
            files[USER_FILE] = user
        contents = {each: file.read_bytes() for each, file in files.items()}
        made[case.name] = Template(case.name, {CASE_FILE: path.read_bytes()} | contents)
    return tuple(made.values())


def _files(case: Case, tables: Tables) -> list[str]:
    """Names of the files that a case includes, its own spring catalogue among them."""
    from camwright.pipeline.case.cards.spring_selection import SHIPPED
    from camwright.pipeline.case.case import includes

    spring = tables.get("spring")
    catalogue = spring.get("catalogue") if isinstance(spring, dict) else None
    own = [catalogue] if isinstance(catalogue, str) and catalogue != SHIPPED else []
    return [*(name for _, name in includes(case)), *own]


class UnpackedTemplates:
    """Cases by name, unpacked into a temporary folder on first use."""

    def __init__(self, templates: Sequence[Template]) -> None:
        self._templates = {each.name: each for each in templates}
        self._folder = tempfile.TemporaryDirectory(prefix="camwright-study-")
        self._cases: dict[str, Case] = {}

    def __iter__(self) -> Iterator[Case]:
        return (self[name] for name in self._templates)

    def __getitem__(self, name: str) -> Case:
        if name not in self._cases:
            self._cases[name] = self._templates[name].case(Path(self._folder.name))
        return self._cases[name]
