"""Arguments of a command: its words on the command line, read from the signature of its function.

Parameters before the ``*`` are arguments by place, the others options. One whose type is a
`TypedDict` or a dataclass stands for an option of each of its fields, with the docstring below it.
A command is read when it is called: the start of the program imports the one that runs.
"""

from __future__ import annotations

import difflib
import inspect
import re
import textwrap
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from itertools import takewhile
from pathlib import Path
from typing import (
    Annotated,
    Any,
    NamedTuple,
    NotRequired,
    get_args,
    get_origin,
    get_type_hints,
)

from camwright.geometry.errors import InputError

Command = Callable[..., int]
"""A command: its arguments -> exit code."""
WIDTH = 80
_COLUMN = 24  # of the words of an option
HELP = ("--help", "-h")
"""Options that print the help text of a command."""
_SHORT = re.compile(r"-[A-Za-z]")  # no option is short: none is taken for an argument
_KINDS = (bool, int, float, Path)
_METAVARS = {int: "N", float: "NUMBER", Path: "FILE"}


class Words(NamedTuple):
    """What is printed on an argument or option, beside its type.

    Parameters
    ----------
    help : str        a sentence
    metavar : str     its value; "": by the type
    typed : str       as typed, such as ``--json``; "": by the name of the parameter
    choices : tuple   accepted words, for help and completion; whoever reads them refuses others
    bounds : tuple    least and greatest number; None: any
    """

    help: str
    metavar: str = ""
    typed: str = ""
    choices: Sequence[str] = ()
    bounds: tuple[int, int] | None = None


@dataclass(frozen=True)
class Argument:
    """An argument by place, or an option.

    Parameters
    ----------
    parameter, group : str   field of a group and the parameter that holds it; "": no group
    typed : str              ``--out``, or the name of an argument by place, ``CASE``
    kind : type              bool: without a value
    many : bool              may be repeated
    required : bool
    """

    parameter: str
    group: str
    typed: str
    kind: type
    many: bool
    required: bool
    words: Words

    @property
    def is_option(self) -> bool:
        """Whether it is stated by its name."""
        return self.typed.startswith("--")

    @property
    def usage(self) -> str:
        """The argument as in a usage line: ``--out DIR``, ``CASE...``."""
        if not self.is_option:
            return f"{self.typed}..." if self.many else self.typed
        if self.kind is bool:
            return self.typed
        return f"{self.typed} {self.words.metavar or _METAVARS.get(self.kind, 'VALUE')}"

    def value(self, text: str) -> Any:
        """Value of a text of the command line in the type of the argument.

        Raises
        ------
        InputError
            If it is no number, or out of bounds.
        """
        if self.kind not in (int, float):
            return self.kind(text)
        try:
            number = self.kind(text)
        except ValueError:
            words = "a whole number" if self.kind is int else "a number"
            raise InputError(self.typed, text, words) from None
        if self.words.bounds is not None:
            least, most = self.words.bounds
            if not least <= number <= most:
                raise InputError(self.typed, text, f">= {least} and <= {most}")
        return number


def arguments_of(command: Command) -> tuple[Argument, ...]:
    """Arguments and options of a command, in the order of its parameters."""
    hints = get_type_hints(command, include_extras=True)
    listed: list[Argument] = []
    for name, parameter in inspect.signature(command).parameters.items():
        if _is_group(hints[name]):
            listed += _of_group(name, hints[name])
        else:
            by_place = parameter.kind is not parameter.KEYWORD_ONLY
            required = parameter.default is parameter.empty
            listed.append(_argument(name, "", hints[name], by_place=by_place, required=required))
    return tuple(listed)


def _is_group(hint: Any) -> bool:
    return isinstance(hint, type) and (is_dataclass(hint) or (issubclass(hint, dict)))


def _of_group(name: str, kind: type) -> Iterator[Argument]:
    """Arguments of the fields of a dataclass or ``TypedDict``, which the command takes as one
    parameter `name`.
    """
    from camwright.pipeline.base.field_texts import texts_below

    texts, needed = texts_below(kind), set[str]()
    if is_dataclass(kind):
        needed = {each.name for each in fields(kind) if each.default is each.default_factory}
    for field, hint in get_type_hints(kind, include_extras=True).items():
        if not _is_group(hint):
            words = Words(texts.get(field, ""))
            yield _argument(field, name, hint, required=field in needed, words=words)


def _argument(
    name: str, group: str, hint: Any, *, required: bool, by_place: bool = False,
    words: Words | None = None,
) -> Argument:  # fmt: skip
    """Argument of a command from a parameter or field by its type hint: ``Annotated[..., Words]``,
    a list for one that may be repeated, with or without None.

    Parameters
    ----------
    name : str        of the parameter or field
    group : str       parameter that takes the group of the field; "": no group
    hint : object     type annotation
    required : bool   whether it has no default
    by_place : bool   whether it is stated by its place, not as an option
    words : Words     what is printed on it, where the hint has no `Words`
    """
    if get_origin(hint) is NotRequired:
        (hint,) = get_args(hint)
    if get_origin(hint) is Annotated:
        hint, *notes = get_args(hint)
        words = next((each for each in notes if isinstance(each, Words)), words)
    inner = [each for each in get_args(hint) or (hint,) if each is not type(None)]
    many = any(get_origin(each) is list for each in (hint, *inner))
    if many:
        inner = [one for each in inner for one in get_args(each) or (each,)]
    kind = inner[0] if len(inner) == 1 and inner[0] in _KINDS else str
    words = words or Words("")
    typed = words.typed or (words.metavar if by_place else f"--{name.replace('_', '-')}")
    return Argument(name, group, typed, kind, many, required, words)


def read_arguments(command: Command, texts: Sequence[str]) -> dict[str, Any]:
    """Keyword arguments for a command, from its words.

    Parameters
    ----------
    texts : sequence   words of the command line after the command

    Raises
    ------
    InputError
        If an option is unknown or has no value, or an argument is missing or one too many.
    """
    accepted = arguments_of(command)
    stated = _stated(texts, accepted)
    for each in accepted:
        if each.required and each.typed not in stated:
            choices = ", ".join(each.words.choices)
            limit = f"one of: {choices}" if choices else f"stated: {_phrase(each.words.help)}"
            raise InputError(each.typed, "missing", limit)
    hints = get_type_hints(command)
    values: dict[str, Any] = {each.group: {} for each in accepted if each.group}
    for each in accepted:
        if each.typed in stated:
            converted = [each.value(text) for text in stated[each.typed]]
            target = values[each.group] if each.group else values
            target[each.parameter] = converted if each.many else converted[-1]
    for group in {each.group for each in accepted if each.group}:
        if is_dataclass(hints[group]):
            values[group] = hints[group](**values[group])
    return values


def _stated(texts: Sequence[str], accepted: Sequence[Argument]) -> dict[str, list[str]]:
    """Texts of each argument and option on a command line, by its name as typed; the name itself
    for a flag.

    Parameters
    ----------
    texts : sequence      words of the command line after the command
    accepted : sequence   arguments and options of the command

    Raises
    ------
    InputError
        For an unknown option, a value missing or too many, or an argument too many.
    """
    options = {each.typed: each for each in accepted if each.is_option}
    stated: dict[str, list[str]] = {}
    loose: list[str] = []
    rest = iter(texts)
    for word in rest:
        if word == "--":
            loose += rest
            break
        name, equals, value = word.partition("=")
        if not word.startswith("--") and not _SHORT.match(word):
            loose.append(word)
            continue
        if name not in options:
            raise InputError(name, "unknown", f"an option of the command{_closest(name, options)}")
        if options[name].kind is bool:
            if equals:
                raise InputError(name, value, "stated without a value")
            value = name
        elif not equals:
            following = next(rest, None)
            if following is None or following.partition("=")[0] in (*options, "--"):
                raise InputError(name, "missing", f"stated as {options[name].usage}")
            value = following
        stated.setdefault(name, []).append(value)
    for each in accepted:
        if not each.is_option and loose:
            count = len(loose) if each.many else 1
            stated[each.typed], loose = loose[:count], loose[count:]
    if loose:
        raise InputError(loose[0], "one argument too many", "left out")
    return stated


def asks_for_help(command: Command, texts: Sequence[str]) -> bool:
    """Whether the arguments of a command ask for its help; not as a value, nor after ``--``."""
    valued = {
        each.typed for each in arguments_of(command) if each.is_option and each.kind is not bool
    }
    words = [*takewhile(lambda text: text != "--", texts)]
    return any(
        word == HELP[0] or (word == HELP[1] and before not in valued)
        for before, word in zip(("", *words), words, strict=False)
    )


def _closest(name: str, accepted: Mapping[str, Argument]) -> str:
    alike = difflib.get_close_matches(name, accepted, n=3)
    return f"; did you mean {', '.join(alike)}?" if alike else ""


def _phrase(sentence: str) -> str:
    """A sentence within another one."""
    text = sentence.rstrip(".")
    return text[:1].lower() + text[1:] if text[1:2].islower() else text


def option_named(error: InputError, command: Command, texts: Sequence[str]) -> InputError:
    """Error in a field of an option group as one of the option with the text typed; any other error
    unchanged.

    Parameters
    ----------
    error : InputError   of the field
    command : Command    whose option it may be
    texts : sequence     words of the command line after the command
    """
    for each in arguments_of(command):
        if each.group and each.parameter == error.field:
            stated = _stated(texts, arguments_of(command)).get(each.typed, [str(error.value)])
            return InputError(each.typed, stated[-1], error.limit)
    return error


def help_of(path: str, command: Command) -> str:
    """Help text of a command: usage, purpose, options and an example, from its signature and
    docstring.

    Parameters
    ----------
    path : str          words of the command
    command : Command   its function
    """
    accepted = arguments_of(command)
    needed = [each.usage for each in accepted if each.required or not each.is_option]
    more = " [OPTIONS]" if any(each.is_option and not each.required for each in accepted) else ""
    parts = [f"usage: camwright {path} {' '.join(needed)}{more}"]
    for paragraph in inspect.cleandoc(command.__doc__ or "").split("\n\n"):
        text = " ".join(paragraph.split()).replace("``", "")
        is_example = text.startswith("Example: ")
        parts.append(text if is_example else textwrap.fill(text, WIDTH, break_on_hyphens=False))
    *parts, example = parts
    return "\n\n".join([*parts, "\n".join(map(_described, accepted)), example])


def _described(one: Argument) -> str:
    """Lines on an argument or option for the help, in two columns."""
    text = one.words.help
    if one.words.choices:
        text += f" One of: {', '.join(one.words.choices)}."
    if one.many and one.is_option:
        text += " May be repeated."
    head = f"  {one.usage}"
    lines = textwrap.wrap(text, WIDTH - _COLUMN, break_on_hyphens=False) or [""]
    if len(head) >= _COLUMN - 1:
        return "\n".join([head, *(" " * _COLUMN + line for line in lines)])
    return "\n".join([f"{head:<{_COLUMN}}{lines[0]}", *(" " * _COLUMN + x for x in lines[1:])])
