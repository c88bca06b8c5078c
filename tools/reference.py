# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the parts of the reference that follow from the code: run after changing a signature, a docstring or an option.

    python tools/reference.py

needs lsgp installed. In docs/, what stands between "<!-- reference: WHAT -->" and "<!-- end -->" is replaced: WHAT is
"python NAME ..." for public names of lsgp, "lsgp COMMAND" for the options of a command, or "exit codes".
"""

from __future__ import annotations

import argparse
import inspect
import re
from collections.abc import Iterator
from dataclasses import MISSING, fields, is_dataclass
from pathlib import Path
from typing import Any

import lsgp
from lsgp.cli.command import _parser
from lsgp.run.exit_codes import OF_A_BATCH, OF_A_RUN

DOCS = Path(__file__).resolve().parents[1] / "docs"
PART = re.compile(r"(<!-- reference: (.+?) -->\n).*?(<!-- end -->)", re.DOTALL)


def documents() -> dict[Path, str]:
    """The documents that have such parts, as they should be."""
    found = {path: path.read_text(encoding="utf-8") for path in sorted(DOCS.rglob("*.md"))}
    return {path: PART.sub(_filled, text) for path, text in found.items() if PART.search(text)}


def parts() -> Iterator[str]:
    """The generated parts of the documents."""
    for path in sorted(DOCS.rglob("*.md")):
        yield from (what for _, what, _ in PART.findall(path.read_text(encoding="utf-8")))


def commands() -> dict[str, argparse.ArgumentParser]:
    """The parsers by command line: "lsgp", "lsgp unwrap", ..."""
    parser = _parser()
    (subparsers,) = (action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    return {"lsgp": parser} | {f"lsgp {name}": subparser for name, subparser in subparsers.choices.items()}


def _filled(part: re.Match[str]) -> str:
    kind, *names = part[2].split()
    if kind == "python":
        text = "\n".join(map(_python, names))
    else:
        text = _exit_codes() if kind == "exit" else _command(commands()[part[2]])
    return f"{part[1]}\n{text}\n{part[3]}"


def _command(parser: argparse.ArgumentParser) -> str:
    """What the command does, and a table of its arguments."""
    lines = [parser.description or "", "", "| | |", "|---|---|"]
    for group in parser._action_groups:
        actions = [action for action in group._group_actions if not _is_obvious(action)]
        own_title = group.title not in ("positional arguments", "options")
        if actions and own_title:
            lines.append(f"| *{group.title}* | |")
        lines += [f"| `{_usage(action)}` | {_cell(action.help or '')} |" for action in actions]
    return "\n".join(lines) + "\n"


def _exit_codes() -> str:
    rows = [f"| {code} | {OF_A_RUN.get(code, '')} | {meaning} |" for code, meaning in OF_A_BATCH.items()]
    return "\n".join(["| | of a command | of `lsgp batch` |", "|--:|---|---|", *rows]) + "\n"


def _is_obvious(action: argparse.Action) -> bool:
    return isinstance(action, argparse._HelpAction | argparse._SubParsersAction)


def _usage(action: argparse.Action) -> str:
    value = action.metavar or ("{" + ",".join(map(str, action.choices)) + "}" if action.choices else "")
    if isinstance(value, tuple):
        value = " ".join(value)
    if action.nargs == 0:
        value = ""
    many = " ..." if action.nargs in ("+", "*") else ""
    return (" ".join(filter(None, [", ".join(action.option_strings), str(value)])) + many).replace("|", "\\|")


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("%%", "%").replace("|", "\\|")


def _python(name: str) -> str:
    """Name, signature or fields, and the docstring with its "name: ..." lines as a list."""
    obj = getattr(lsgp, name)
    lines = [f"### {name}", ""]
    if inspect.ismodule(obj):
        lines += _docstring(obj)
        for inner_name, inner in vars(obj).items():
            if inspect.isfunction(inner) and inner.__module__ == obj.__name__ and not inner_name.startswith("_"):
                lines += [_signature(f"lsgp.{name}.{inner_name}", inner), "", *_docstring(inner)]
    elif inspect.isfunction(obj):
        lines += [_signature(f"lsgp.{name}", obj), "", *_docstring(obj)]
    elif is_dataclass(obj):
        lines += [*_docstring(obj), *_fields(obj)]
    elif not issubclass(obj, Exception):
        lines += [_signature(f"lsgp.{name}", obj), "", *_docstring(obj)]
        for inner_name, inner in vars(obj).items():
            if inspect.isfunction(inner) and not inner_name.startswith("_"):
                lines += [_signature(f"lsgp.{name}.{inner_name}", inner), "", *_docstring(inner)]
    else:
        bases = ", ".join(f"`{base.__name__}`" for base in obj.__bases__)
        lines += [f"An exception, also {bases}.", "", *_docstring(obj)]
    return "\n".join(lines)


def _signature(name: str, function: Any) -> str:
    signature = inspect.signature(function)
    parameters = list(signature.parameters.values())
    shown = [_parameter(parameter) for parameter in parameters]
    keyword_only = [i for i, parameter in enumerate(parameters) if parameter.kind is parameter.KEYWORD_ONLY]
    if keyword_only:
        shown.insert(keyword_only[0], "*")
    result = "" if signature.return_annotation is signature.empty else f" -> {signature.return_annotation}"
    return f"`{name}({', '.join(shown)}){result}`"


def _parameter(parameter: inspect.Parameter) -> str:
    default = "" if parameter.default is parameter.empty else f" = {_value(parameter.default)}"
    kind = "" if parameter.annotation is parameter.empty else f": {parameter.annotation}"
    return f"{parameter.name}{kind}{default}"


def _value(default: Any) -> str:
    return f"{type(default).__name__}()" if is_dataclass(default) else repr(default)


def _docstring(obj: Any) -> list[str]:
    text, *examples = re.split(r"^(?=>>> )", inspect.getdoc(obj), maxsplit=1, flags=re.MULTILINE)
    lines = []
    in_list = False
    for line in text.splitlines():
        item = re.match(r"([a-z]\w*(?:, [a-z]\w*)*): (.*)", line)
        if item:
            if not in_list and lines and lines[-1]:
                lines.append("")
            in_list = True
            names = ", ".join(f"`{name}`" for name in item[1].split(", "))
            lines.append(f"- {names}: {item[2]}")
        elif in_list and re.match("    |[a-z]", line):
            lines.append(f"  {line.strip()}")
        else:
            if in_list and line:
                lines.append("")
            in_list = False
            lines.append(line)
    for example in examples:
        lines += ["```pycon", *example.splitlines(), "```"]
    return [*lines, ""]


def _fields(cls: type) -> list[str]:
    lines = ["| field | type | default |", "|---|---|---|"]
    for field in fields(cls):
        default = ""
        if field.default is not MISSING:
            default = f"`{_value(field.default)}`"
        elif field.default_factory is not MISSING:
            default = "empty"
        lines.append(f"| `{field.name}` | `{field.type}` | {default} |".replace(" | None`", " \\| None`"))
    return [*lines, ""]


def main() -> None:
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    for path, text in documents().items():
        path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
