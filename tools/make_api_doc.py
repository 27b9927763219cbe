# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write docs/api.md from the docstrings of pkm_post.api.

Run it in any Python with numpy, or by ``tools/freecad -M "$PWD" tools/run_script.py -- tools/make_api_doc.py``.
"""

import inspect
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TARGET = ROOT / "docs" / "api.md"
HEAD = """# The public API

For macros in FreeCAD and for scripts. Everything is in one module:

```python
import pkm_post as pkm
```

A post in one call is `pkm.post`; the other functions are its stages, on the types of the data:

    read -> Program -> compensate -> Program -> place -> Trajectory -> plan -> Plan
    write -> files -> certify -> Certificate

{preamble}

In an installed package, `pkm-post` is the command line, as `python3 -m pkm_post` is. The examples are tests: those
without FreeCAD run in a folder with `part.ngc` and `contour.ngc`, those marked "in FreeCAD" in a document with one job.

This page is made from `pkm_post/api` by `tools/make_api_doc.py`: do not edit it.
"""


def page(api):
    """The text of the page."""
    preamble = inspect.getdoc(api).split("\n\n", 1)[1].partition(". ")[2]
    sections = [_section(each) for each in vars(api).values() if inspect.isfunction(each)]
    return HEAD.format(preamble=_plain(preamble)) + "".join(sections)


def _section(function):
    """A function: its signature, what it does, and its example."""
    text, _, example = inspect.getdoc(function).partition("\n\nExample:\n")
    summary, *parts = text.split("\n\n")
    body = "".join(f"\n{_part(part)}\n" for part in parts)
    return (
        f"\n## {function.__name__}\n\n```text\n{_signature(function)}\n```\n\n{_plain(summary)}\n{body}"
        f"\n```text\n{textwrap.dedent(example).rstrip()}\n```\n"
    )


def _signature(function):
    """The parameters by name, with their defaults where these are short."""
    parameters = inspect.signature(function).parameters.values()
    return f"pkm.{function.__name__}({', '.join(map(_parameter, parameters))})"


def _parameter(parameter):
    if parameter.default is inspect.Parameter.empty:
        return parameter.name
    default = f'"{parameter.default}"' if isinstance(parameter.default, str) else repr(parameter.default)
    return f"{parameter.name}={default if len(default) < 24 and '<' not in default else '...'}"


def _part(part):
    """A paragraph, or a list of arguments, results or errors."""
    title, _, rest = part.partition("\n")
    if title not in ("Args:", "Returns:", "Raises:"):
        return _plain(part)
    items, lines = [], textwrap.dedent(rest).split("\n")
    for line in lines:
        if line.startswith(" ") and items:
            items[-1] += " " + line.strip()
        else:
            items.append(line)
    if title == "Returns:":
        return "Returns " + _plain(" ".join(items))[0].lower() + _plain(" ".join(items))[1:]
    return "\n".join(f"- `{name}`: {_plain(what.strip())}" for name, _, what in (item.partition(":") for item in items))


def _plain(text):
    return text.replace("``", "`")


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    from pkm_post import api

    TARGET.write_text(page(api), encoding="utf-8", newline="\n")
    print(TARGET)
